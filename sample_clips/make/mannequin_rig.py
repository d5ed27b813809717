"""The mannequin's joints by name, its measures, and the few rotation helpers every module here shares.

Angles are degrees throughout `sample_clips.make`, in the order (pitch, turn, lean): pitch bends forwards,
turn goes to the character's left, lean tips to its right.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.motion import rotation
from sample_clips.make.mannequin_skeleton import ARM, FINGERS, mannequin_skeleton

Array = NDArray[Any]
Angles = tuple[float, float, float]

FPS = 30.0
SKELETON = mannequin_skeleton()
JOINTS = len(SKELETON)
SIDES = ("Left", "Right")
SPINE = ("Spine", "Chest", "UpperChest")
NECK = ("Neck", "Head")
LEGS = ("UpperLeg", "LowerLeg", "Foot", "Toes")
REST_ROTATIONS, REST = SKELETON.globals(SKELETON.rest)  # model space, metres


def at(name: str) -> int:
    """Return the joint's place."""
    return SKELETON.index(name)


def arm_joints(side: str) -> tuple[str, ...]:
    """Return the names of one arm's joints from the collarbone to the finger tips."""
    fingers = tuple(f"{side}{finger}{i}" for finger in FINGERS for i in (1, 2, 3))
    return (side + "Shoulder", side + "UpperArm", side + "LowerArm", side + "Hand", *fingers)


FACE = tuple(n for n in SKELETON.names if n == "Jaw" or n.endswith(("Eye", "Lid", "Brow")))
REACH = {
    "body": ("Hips", *SPINE, *NECK, *(s + joint for s in SIDES for joint in LEGS)),
    "arms": (*SPINE, *NECK, *arm_joints("Left"), *arm_joints("Right")),
    "head": (*SPINE, *NECK, *FACE),
}
"""The joints each layer may move; every other joint stays in the base pose."""

ARM_AXIS = np.array(ARM)  # along the left arm at rest
PALM = np.array([ARM[1], -ARM[0], 0.0])  # out of the left palm at rest; also the axis the elbow bends about
THUMB_SIDE = np.array([0.0, 0.0, 1.0])


def turned(angles: Any) -> Array:
    """Return rotations `[..., 4]` of (pitch, turn, lean) degrees `[..., 3]`."""
    pitch, turn, lean = np.moveaxis(np.radians(np.asarray(angles, float)), -1, 0)
    return rotation.from_euler(np.stack([turn, pitch, lean], -1), "YXZ")


def about(axis: Any, degrees: Any) -> Array:
    """Return rotations `[..., 4]` about an axis `[3]` by degrees `[...]`."""
    degrees = np.asarray(degrees, float)
    return rotation.from_axis_angle(np.broadcast_to(axis, (*degrees.shape, 3)), np.radians(degrees))


def mirrored(q: Any) -> Array:
    """Return the rotation `[..., 4]` that the other side of the body makes."""
    return np.asarray(q) * np.array([1.0, -1.0, -1.0, 1.0])


def flipped(v: Any) -> Array:
    """Return the vector `[..., 3]` on the other side of the body."""
    return np.asarray(v) * np.array([-1.0, 1.0, 1.0])
