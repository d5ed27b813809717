"""Make clips of markers: motion of a skeleton that is as large as who wore them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.files import guard_reader
from metagraph.common.wording import phrase
from metagraph.errors import FileError
from metagraph.formats.markers.joint_centres import find_joint_centres
from metagraph.formats.markers.marker_reading import read_markers
from metagraph.formats.markers.marker_take import AGAIN
from metagraph.mimicry.keypoint_layouts import PLACE, KeypointTrack
from metagraph.mimicry.keypoint_take import KeypointTakeError, make_clip_from_keypoints
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Skeleton

Array = NDArray[Any]

MOST_RATE = 120.0  # frames a second of a clip; markers come up to 1,000 times, which no motion needs
SMOOTH = 0.015  # seconds: markers tremble less than what pose estimators see
# Of the trunk's length, from the hips to between the shoulders: where joints are that markers do not show.
SPINE, CHEST, HEAD = 0.25, 0.6, 0.32
FOOT, TOES = 0.09, 0.17  # of the leg's length: how high an ankle is, how far ahead the toes


@guard_reader
def read_marker_track(path: str | Path) -> KeypointTrack:
    """Return the centres of joints of a TRC or C3D file, metres. Raises FileError."""
    path = Path(path)
    return find_joint_centres(path, read_markers(path))


@guard_reader
def read_marker_clip(path: str | Path) -> Clip:
    """Return the motion of a TRC or C3D file as a clip, metres, Y up, of a skeleton measured on the markers.
    Hands, feet and fingers keep their rest pose but for what the limbs do. Raises FileError.
    """
    path = Path(path)
    track = read_marker_track(path)
    rate = (len(track) - 1) / track.seconds if track.seconds > 0 else MOST_RATE
    try:
        clip = make_clip_from_keypoints(
            track, measure_skeleton(track), path.stem, min(rate, MOST_RATE), SMOOTH
        )
    except KeypointTakeError as error:
        raise FileError(path, str(error).partition(": ")[0], "", AGAIN) from None
    return replace(clip, notes=(*track.notes, phrase("its skeleton was measured on the markers")))


def measure_skeleton(track: KeypointTrack) -> Skeleton:
    """Return a skeleton in a T-pose with the lengths that a person's points show, medians over time."""
    points, sure = track.canonical

    def apart(one: str, other: str) -> float:
        a, b = PLACE[one], PLACE[other]
        seen = (sure[:, a] > 0) & (sure[:, b] > 0)
        far = np.linalg.norm(points[seen, a] - points[seen, b], axis=-1)
        return max(float(np.median(far)) if len(far) else 0.0, 1e-3)

    def limb(begin: str, end: str) -> float:
        return (apart(f"left_{begin}", f"left_{end}") + apart(f"right_{begin}", f"right_{end}")) / 2

    trunk = float(np.mean([apart(f"{s}_shoulder", f"{s}_hip") for s in ("left", "right")]))
    leg = limb("hip", "knee") + limb("knee", "ankle")
    hip, shoulder = apart("left_hip", "right_hip") / 2, apart("left_shoulder", "right_shoulder") / 2
    joints: list[tuple[str, int, tuple[float, float, float]]] = [
        ("Hips", -1, (0.0, leg * (1 + FOOT), 0.0)),
        ("Spine", 0, (0.0, SPINE * trunk, 0.0)),
        ("Chest", 1, (0.0, (CHEST - SPINE) * trunk, 0.0)),
        ("Neck", 2, (0.0, (1 - CHEST) * trunk, 0.0)),
        ("Head", 3, (0.0, HEAD * trunk, 0.0)),
    ]
    for side, sign in (("Left", 1.0), ("Right", -1.0)):
        first = len(joints)
        joints += [
            (f"{side}UpperArm", 2, (sign * shoulder, (1 - CHEST) * trunk, 0.0)),
            (f"{side}LowerArm", first, (sign * limb("shoulder", "elbow"), 0.0, 0.0)),
            (f"{side}Hand", first + 1, (sign * limb("elbow", "wrist"), 0.0, 0.0)),
            (f"{side}UpperLeg", 0, (sign * hip, 0.0, 0.0)),
            (f"{side}LowerLeg", first + 3, (0.0, -limb("hip", "knee"), 0.0)),
            (f"{side}Foot", first + 4, (0.0, -limb("knee", "ankle"), 0.0)),
            (f"{side}Toes", first + 5, (0.0, -0.6 * FOOT * leg, TOES * leg)),
        ]
    names, parents, places = zip(*joints, strict=True)
    return Skeleton(
        names, np.array(parents), rotation.make_identity_rotations((len(names),)), np.array(places)
    )
