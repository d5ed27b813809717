"""The joints of the default body as it is sculpted: 1.75 m tall, facing +Z, its left at +X, arms half down.

Lengths are shares of the height after Drillis and Contini, "Body Segment Parameters" (1966), as Winter prints
them in "Biomechanics and Motor Control of Human Movement" (2009, figure 4.1): shoulder 0.818, hip 0.530, knee
0.285, ankle 0.039. Joints are named by their roles. Places of fingers and of the spine's joints are our own.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.motion.joint_map import FINGERS, SIDES
from metagraph.motion.skeleton import Skeleton

Array = NDArray[Any]

HEIGHT = 1.75
ARM = np.array([0.7071, -0.7071, 0.0])  # from shoulder to elbow
FOREARM = np.array([0.692, -0.702, 0.165])  # from elbow to wrist: bent by ten degrees, as arms rest
FOREARM = FOREARM / np.linalg.norm(FOREARM)
THUMB_SIDE = np.array([-0.13, 0.10, 1.0])  # across the hand, towards the thumb
THUMB_SIDE = THUMB_SIDE - FOREARM * (THUMB_SIDE @ FOREARM)
THUMB_SIDE = THUMB_SIDE / np.linalg.norm(THUMB_SIDE)
BACK_OF_HAND = np.cross(THUMB_SIDE, FOREARM)
HAND = np.stack([FOREARM, THUMB_SIDE, BACK_OF_HAND])  # rows: along, across, out of its back
# Knuckles along, across and out of the hand from the wrist, metres; lengths of the three bones; how far each
# is bent and how far the finger is spread towards the thumb, degrees; radii at its beginning and its end.
KNUCKLES: dict[str, tuple[float, float, float]] = {
    "index": (0.0900, 0.0270, 0.0010),
    "middle": (0.0935, 0.0055, 0.0035),
    "ring": (0.0885, -0.0155, 0.0020),
    "little": (0.0795, -0.0345, -0.0020),
}
BONES: dict[str, tuple[float, float, float]] = {
    "index": (0.0415, 0.0245, 0.0190),
    "middle": (0.0455, 0.0280, 0.0200),
    "ring": (0.0420, 0.0260, 0.0195),
    "little": (0.0330, 0.0195, 0.0170),
    "thumb": (0.0440, 0.0330, 0.0270),
}
BENT = {"index": (9, 14, 8), "middle": (13, 16, 9), "ring": (16, 18, 10), "little": (18, 19, 10)}
SPREAD = {"index": 5.5, "middle": 0.5, "ring": -4.5, "little": -10.0}
THUMB = ((0.0230, 0.0240, -0.0090), (0.66, 0.66, -0.36), (0.80, 0.52, -0.30), (0.88, 0.40, -0.26))

_CENTRE = {
    "hips": (None, (0.0, 0.965, -0.006)),
    "spine": ("hips", (0.0, 1.060, -0.006)),
    "chest": ("spine", (0.0, 1.180, -0.012)),
    "upper_chest": ("chest", (0.0, 1.310, -0.026)),
    "neck": ("upper_chest", (0.0, 1.485, -0.036)),
    "head": ("neck", (0.0, 1.578, -0.010)),
}
SHOULDER = np.array([0.183, 1.432, -0.030])
ELBOW = SHOULDER + 0.292 * ARM
WRIST = ELBOW + 0.252 * FOREARM
_LEFT = {
    "shoulder": ("upper_chest", (0.028, 1.440, -0.004)),
    "upper_arm": ("shoulder", SHOULDER),
    "lower_arm": ("upper_arm", ELBOW),
    "hand": ("lower_arm", WRIST),
    "upper_leg": ("hips", (0.088, 0.927, 0.000)),
    "lower_leg": ("upper_leg", (0.094, 0.499, 0.004)),
    "foot": ("lower_leg", (0.096, 0.078, -0.026)),
    "toes": ("foot", (0.107, 0.022, 0.108)),
}


def finger_points(finger: str) -> Array:
    """Return where a finger of the left hand has its joints and its tip, `[4, 3]`."""
    if finger == "thumb":
        at = [np.array(THUMB[0])]
        for way, length in zip(THUMB[1:], BONES[finger], strict=True):
            at.append(at[-1] + length * np.array(way) / np.linalg.norm(way))
    else:
        at, pitch, yaw = [np.array(KNUCKLES[finger])], 0.0, np.radians(SPREAD[finger])
        for bent, length in zip(BENT[finger], BONES[finger], strict=True):
            pitch += np.radians(bent)
            way = np.array([np.cos(pitch) * np.cos(yaw), np.cos(pitch) * np.sin(yaw), -np.sin(pitch)])
            at.append(at[-1] + length * way)
    return np.asarray(WRIST + np.array(at) @ HAND)


def default_skeleton() -> Skeleton:
    """Return the skeleton; every joint is turned as the character is."""
    at: dict[str, tuple[str | None, Array]] = {n: (p, np.array(x)) for n, (p, x) in _CENTRE.items()}
    for side, mirror in zip(SIDES, (np.ones(3), np.array([-1.0, 1, 1])), strict=True):
        for name, (parent, place) in _LEFT.items():
            on = parent if parent in _CENTRE else f"{side}_{parent}"
            at[f"{side}_{name}"] = (on, np.array(place) * mirror)
        for finger in FINGERS:
            for n, place in enumerate(finger_points(finger)[:3], 1):
                on = f"{side}_{finger}_{n - 1}" if n > 1 else f"{side}_hand"
                at[f"{side}_{finger}_{n}"] = (on, place * mirror)
    names = tuple(at)
    parents = np.array([names.index(p) if p is not None else -1 for p, _ in at.values()])
    places = np.array([x for _, x in at.values()])
    local = places - np.where(parents[:, None] >= 0, places[parents], 0)
    return Skeleton(names, parents, np.tile([0.0, 0, 0, 1], (len(names), 1)), local)
