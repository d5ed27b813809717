"""Numbers of an LSL stream as keypoints of a person: which of its channels are which points."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.lab_streaming import StreamChannel
from metagraph.mimicry.keypoint_layouts import LAYOUTS, PLACE, POINTS, choose_points
from metagraph.motion.joint_names import HELPERS, guess_joint_kind, split_joint_name

Array = NDArray[Any]

# Kinds of joints, by their names, at which COCO's points are.
KINDS = {
    "upper_arm": "shoulder", "lower_arm": "elbow", "hand": "wrist", "upper_leg": "hip", "lower_leg": "knee",
    "foot": "ankle",
}  # fmt: skip
COUNTS = tuple(sorted({len(names) for names in LAYOUTS.values() if 17 <= len(names) <= 33}))
NEEDED = ("left_shoulder", "right_shoulder", "left_hip", "right_hip")  # without them nobody can be seen
KNOWN = ("x", "y", "z", "confidence")
_ENDS = re.compile(
    r"(?:[\s._-]+(?:(?i:pos|position)[\s._-]*)?((?i:[xyzcp]|conf|confidence|visibility|score))"
    r"|(?<=[a-z0-9])([XYZ]))$"
)
_OTHERS = HELPERS | frozenset(
    ["thumb", "index", "middle", "ring", "pinky", "little", "finger", "fingers", "toe", "toes", "heel"]
)


@dataclass(frozen=True)
class PointChannels:
    """Where the 17 POINTS are among a stream's channels. places `[17, 4]`: the channels of x, y, z and
    confidence, -1 for what is not there. dims: 2 or 3.
    """

    places: Array
    dims: int

    def read(self, sample: Sequence[float]) -> tuple[Array, Array]:
        """Return points `[17, dims]` and confidence `[17]` of one sample; numbers that are none make a point
        of confidence 0.
        """
        numbers = np.append(np.asarray(sample, float), np.nan)  # -1 is what is not there
        points = numbers[self.places[:, : self.dims]]
        sure = np.where(self.places[:, 3] < 0, 1.0, numbers[self.places[:, 3]])
        seen = np.isfinite(points).all(1) & np.isfinite(sure)
        return np.where(seen[:, None], points, 0.0), np.where(seen, np.clip(sure, 0.0, 1.0), 0.0)


def find_point_channels(channels: Sequence[StreamChannel], count: int) -> PointChannels:
    """Return where a stream of `count` channels has its points: by the names of its channels, where they name
    joints or points of a body; else by how many there are. Raises ValueError with what is wrong.
    """
    if len(channels) == count:
        named = _find_by_names(channels)
        if named is not None:
            return named
    for points in COUNTS:
        for dims in (2, 3, 4):  # x, y; x, y, z; x, y, z, confidence
            if points * dims == count:
                return _find_by_count(points, dims)
    known = ", ".join(map(str, COUNTS))
    raise ValueError(
        f"its {count} channels are no keypoints: name them after joints, or send {known} points with 2, 3 or "
        "4 numbers each"
    )


def _find_by_count(points: int, dims: int) -> PointChannels:
    order, sure = choose_points(np.arange(points)[:, None], np.ones(points))
    places = np.full((len(POINTS), 4), -1)
    for axis in range(dims):
        places[:, axis] = np.where(sure > 0, order[:, 0] * dims + axis, -1)
    return PointChannels(places, min(dims, 3))


def _find_by_names(channels: Sequence[StreamChannel]) -> PointChannels | None:
    """Return the channels whose names say which point they are of; None if too little of a body is named."""
    places = np.full((len(POINTS), 4), -1)
    for certain in (True, False):  # an upper arm begins where a shoulder is meant; a skeleton has both
        for n, channel in enumerate(channels):
            joint, part = split_label(channel)
            point, sure = name_point(joint)
            if part and point and sure == certain and places[PLACE[point], KNOWN.index(part)] < 0:
                places[PLACE[point], KNOWN.index(part)] = n
    flat = places[[PLACE[name] for name in NEEDED]]
    if (flat[:, :2] < 0).any():
        return None
    dims = 3 if (flat[:, 2] >= 0).all() else 2
    places[(places[:, :dims] < 0).any(1)] = -1
    return PointChannels(places, dims)


def split_label(channel: StreamChannel) -> tuple[str, str]:
    """Return the joint that a channel is about, and which of its numbers it is: "x", "y", "z" or
    "confidence", "" for another.
    """
    ends = _ENDS.search(channel.label)
    joint = channel.object or (channel.label[: ends.start()] if ends else channel.label)
    kind = channel.kind.lower().removeprefix("position")
    if kind in KNOWN or kind.startswith("orientation"):
        return joint, kind if kind in KNOWN else ""
    part = "" if ends is None else (ends[1] or ends[2]).lower()
    return joint, part if part in ("", *KNOWN[:3]) else "confidence"


def name_point(joint: str) -> tuple[str, bool]:
    """Return which of the POINTS a joint or a point is, by its name, "" if it is none; and whether the name
    is that of a limb's joint.
    """
    words = split_joint_name(joint)
    if words.joined == "nose":
        return "nose", True
    if _OTHERS & set(words.words):
        return "", False
    kind = guess_joint_kind(words)
    name = f"{words.side}_{KINDS.get(kind, words.joined)}"
    return name if name in PLACE else "", kind in KINDS


class Upright:
    """Turns points so that y is up and z comes towards who looks, whichever axis of a stream is up. The first
    frame in which the body is seen decides.
    """

    def __init__(self) -> None:
        self._turn: Array | None = None

    def turn(self, points: Array, confidence: Array) -> Array:
        """Return points `[17, D]`, of which y goes down and z away, as a camera's do."""
        body = [PLACE[name] for name in NEEDED]
        if self._turn is None and points.shape[1] == 2:
            down = (points[body[2:]] - points[body[:2]]).mean(0)
            if confidence[body].min() > 0 and abs(down[1]) > 0:
                self._turn = np.diag([1.0, float(np.sign(down[1]))])
        elif self._turn is None and confidence[body].min() > 0:
            up = (points[body[:2]] - points[body[2:]]).mean(0)
            axis = 2 if abs(up[2]) > abs(up[1]) else 1
            sign = float(np.sign(up[axis])) or 1.0
            # Rows: right, down, away; each choice keeps hands what they are.
            y, z = np.eye(3)[1], np.eye(3)[2]
            rows = (-sign * y, -sign * z) if axis == 1 else (-sign * z, sign * y)
            self._turn = np.array([np.eye(3)[0], *rows])
        return points if self._turn is None else points @ self._turn.T
