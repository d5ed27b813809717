"""Keypoints of a person over time, whatever found them, and the layouts they come in.

Everywhere: x to the right of the picture, y up, z towards the camera, so that who faces the camera looks
along +z and has the left hand at larger x, as a character does. Units are the file's own.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

_PAIRS = ("eye", "ear", "shoulder", "elbow", "wrist", "hip", "knee", "ankle")
# What is looked at, in the order of COCO's 17 keypoints.
POINTS: tuple[str, ...] = ("nose", *(f"{side}_{part}" for part in _PAIRS for side in ("left", "right")))
PLACE: Mapping[str, int] = {name: n for n, name in enumerate(POINTS)}
_SWAPPED = [PLACE[n.replace("left_", "*").replace("right_", "left_").replace("*", "right_")] for n in POINTS]


def _named(text: str) -> tuple[str, ...]:
    long = {"l": "left", "r": "right"}
    return tuple(f"{long[w[0]]}_{w[2:]}" if w[1:2] == "." else w for w in text.split())


_HALPE = "head neck hips l.big_toe r.big_toe l.small_toe r.small_toe l.heel r.heel"  # after COCO's 17
_WHOLE_FEET = "l.big_toe l.small_toe l.heel r.big_toe r.small_toe r.heel"  # after COCO's 17
_H36M = (
    "hips r.hip r.knee r.ankle l.hip l.knee l.ankle spine neck nose head l.shoulder l.elbow l.wrist "
    "r.shoulder r.elbow r.wrist"
)
_FACE_AND_HANDS = (
    *(f"face_{n}" for n in range(68)),
    *(f"left_hand_{n}" for n in range(21)),
    *(f"right_hand_{n}" for n in range(21)),
)
# Layout -> what each of its points is called. OpenPose writes BODY_25, COCO (18 points) and MPI (15),
# MediaPipe 33; AlphaPose also Halpe's 26 and 136, MMPose Halpe's 26 and the 133 of a whole body.
LAYOUTS: Mapping[str, tuple[str, ...]] = {
    "coco": POINTS,
    "openpose coco": _named(
        "nose neck r.shoulder r.elbow r.wrist l.shoulder l.elbow l.wrist r.hip r.knee r.ankle l.hip l.knee "
        "l.ankle r.eye l.eye r.ear l.ear"
    ),
    "openpose body_25": _named(
        "nose neck r.shoulder r.elbow r.wrist l.shoulder l.elbow l.wrist hips r.hip r.knee r.ankle l.hip "
        "l.knee l.ankle"
        " r.eye l.eye r.ear l.ear l.big_toe l.small_toe l.heel r.big_toe r.small_toe r.heel"
    ),
    "openpose mpi": _named(
        "head neck r.shoulder r.elbow r.wrist l.shoulder l.elbow l.wrist r.hip r.knee r.ankle l.hip l.knee "
        "l.ankle chest"
    ),
    "halpe": (*POINTS, *_named(_HALPE)),
    "halpe whole body": (*POINTS, *_named(_HALPE), *_FACE_AND_HANDS),
    "coco whole body": (*POINTS, *_named(_WHOLE_FEET), *_FACE_AND_HANDS),
    "mediapipe": _named(
        "nose l.eye_inner l.eye l.eye_outer r.eye_inner r.eye r.eye_outer l.ear r.ear l.mouth r.mouth "
        "l.shoulder r.shoulder"
        " l.elbow r.elbow l.wrist r.wrist l.pinky r.pinky l.index r.index l.thumb r.thumb l.hip r.hip l.knee "
        "r.knee l.ankle r.ankle"
        " l.heel r.heel l.toes r.toes"
    ),
}
# Human3.6M's 17 points, which only a name in the file tells from COCO's.
H36M: tuple[str, ...] = _named(_H36M)
BY_COUNT: Mapping[int, str] = {len(names): layout for layout, names in LAYOUTS.items()}
_CHOSEN: Mapping[int, Array] = {
    len(names): np.array([names.index(p) if p in names else -1 for p in POINTS]) for names in LAYOUTS.values()
}


@dataclass(frozen=True, eq=False)
class KeypointTrack:
    """One person over time. times `[F]` seconds, ascending from 0 or later; points `[F, K, 3]`, z 0 where
    dims is 2; confidence `[F, K]` 0..1, 0 for what was not found; names of the K points. notes: what was left
    out, in words. flat: the same person in the picture, where depth was guessed from one picture; stances are
    seen better there.
    """

    times: Array
    points: Array
    confidence: Array
    names: tuple[str, ...]
    dims: int
    notes: tuple[str, ...] = ()
    flat: KeypointTrack | None = None

    def __len__(self) -> int:
        return len(self.times)

    @property
    def judged(self) -> KeypointTrack:
        """Return the points in which stances are looked for: those in the picture where depth was guessed."""
        return self.flat if self.flat is not None else self

    @property
    def seconds(self) -> float:
        """When the last frame is."""
        return float(self.times[-1]) if len(self) else 0.0

    @cached_property
    def canonical(self) -> tuple[Array, Array]:
        """Points `[F, 17, 3]` and confidence `[F, 17]` of the POINTS."""
        place = {name: n for n, name in enumerate(self.names)}
        order = [place.get(name, -1) for name in POINTS]
        missing = np.array(order) < 0
        points, confidence = self.points[:, order].copy(), self.confidence[:, order].copy()
        points[:, missing], confidence[:, missing] = 0.0, 0.0
        return points, confidence

    def mirrored(self) -> KeypointTrack:
        """Return the person as seen in a mirror: left and right changed over."""
        names = tuple(_other(name) for name in self.names)
        flat = self.flat.mirrored() if self.flat is not None else None
        return replace(self, points=self.points * np.array([-1.0, 1.0, 1.0]), names=names, flat=flat)


def _other(name: str) -> str:
    if name.startswith("left_"):
        return f"right_{name[5:]}"
    return f"left_{name[6:]}" if name.startswith("right_") else name


def choose_points(points: Array, confidence: Array) -> tuple[Array, Array]:
    """Return the POINTS `[17, D]` and their confidence `[17]` among `points [K, D]` of a layout, told by
    their number K.

    Raises ValueError for a number no layout has.
    """
    order = _CHOSEN.get(len(points))
    if order is None:
        raise ValueError(f"{len(points)} points are none of the layouts that are known: {describe_layouts()}")
    return points[order], np.where(order < 0, 0.0, confidence[order])  # what a layout has not is not seen


def swap(points: Array, confidence: Array) -> tuple[Array, Array]:
    """Return POINTS `[..., 17, D]` and their confidence `[..., 17]` as seen in a mirror."""
    out = points[..., _SWAPPED, :].copy()
    out[..., 0] *= -1
    return out, confidence[..., _SWAPPED]


def describe_layouts() -> str:
    return ", ".join(f"{len(names)} ({layout})" for layout, names in LAYOUTS.items())
