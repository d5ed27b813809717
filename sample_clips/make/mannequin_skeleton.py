"""The mannequin's skeleton: 61 joints, 1.72 m, facing +Z with its left at +X, arms 42 degrees below the
horizontal.

Every rest rotation is the identity, so a local rotation turns about the character's own axes: +X raises the
front of a forward-pointing joint downwards, +Y turns to its left, +Z tilts its head to its right shoulder.
"""

from __future__ import annotations

import numpy as np

from metagraph.motion.skeleton import Skeleton

ARM_DOWN = np.radians(42.0)  # the rest pose's arms: half way, so that shoulders deform well both ways
ARM = np.array([np.cos(ARM_DOWN), -np.sin(ARM_DOWN), 0.0])  # the left arm's direction
FINGERS = ("Thumb", "Index", "Middle", "Ring", "Little")
# Where each finger leaves the hand: along the arm, forwards (+Z), and the lengths of its three bones; metres.
_FINGER = {
    "Thumb": (0.028, 0.030, (0.038, 0.030, 0.024)),
    "Index": (0.088, 0.027, (0.040, 0.024, 0.020)),
    "Middle": (0.091, 0.007, (0.044, 0.027, 0.021)),
    "Ring": (0.087, -0.013, (0.040, 0.025, 0.020)),
    "Little": (0.079, -0.031, (0.031, 0.020, 0.018)),
}


def _joints() -> list[tuple[str, str | None, np.ndarray]]:
    """Return (name, parent, world position) from the ground up; the right side mirrors the left."""
    centre: list[tuple[str, str | None, tuple[float, float, float]]] = [
        ("Hips", None, (0, 0.955, 0)),
        ("Spine", "Hips", (0, 1.045, -0.004)),
        ("Chest", "Spine", (0, 1.165, -0.014)),
        ("UpperChest", "Chest", (0, 1.285, -0.022)),
        ("Neck", "UpperChest", (0, 1.425, -0.026)),
        ("Head", "Neck", (0, 1.515, -0.006)),
        ("Jaw", "Head", (0, 1.545, 0.022)),
    ]
    out = [(n, p, np.array(x, float)) for n, p, x in centre]
    for side, s in (("Left", 1.0), ("Right", -1.0)):
        mirror = np.array([s, 1, 1])

        def add(
            name: str, parent: str, at: np.ndarray, side: str = side, mirror: np.ndarray = mirror
        ) -> None:
            out.append((side + name, parent, at * mirror))

        eye = np.array([0.0315, 1.603, 0.068])
        add("Eye", "Head", eye)
        add("UpperLid", "Head", eye)
        add("LowerLid", "Head", eye)
        add("Brow", "Head", np.array([0.033, 1.632, 0.086]))
        shoulder, upper = np.array([0.025, 1.392, -0.018]), np.array([0.172, 1.392, -0.030])
        elbow = upper + ARM * 0.272
        wrist = elbow + ARM * 0.246
        add("Shoulder", "UpperChest", shoulder)
        add("UpperArm", side + "Shoulder", upper)
        add("LowerArm", side + "UpperArm", elbow)
        add("Hand", side + "LowerArm", wrist)
        for finger in FINGERS:
            along, forward, bones = _FINGER[finger]
            at = wrist + ARM * along + np.array([0, 0, forward])
            direction = ARM if finger != "Thumb" else (ARM * 0.72 + np.array([0, 0, 0.69]))
            parent = side + "Hand"
            for i, length in enumerate(bones, 1):
                add(f"{finger}{i}", parent, at)
                parent, at = f"{side}{finger}{i}", at + direction * length
        hip, knee, ankle = (
            np.array([0.092, 0.915, 0.0]),
            np.array([0.098, 0.500, 0.004]),
            np.array([0.102, 0.082, -0.024]),
        )
        add("UpperLeg", "Hips", hip)
        add("LowerLeg", side + "UpperLeg", knee)
        add("Foot", side + "LowerLeg", ankle)
        add("Toes", side + "Foot", np.array([0.106, 0.022, 0.098]))
    return out


def mannequin_skeleton() -> Skeleton:
    """Return the skeleton; translations are local, metres."""
    joints = _joints()
    places = {name: i for i, (name, _, _) in enumerate(joints)}
    parents = np.array([-1 if p is None else places[p] for _, p, _ in joints])
    positions = np.array([x for _, _, x in joints])
    local = positions - np.where(parents[:, None] >= 0, positions[parents], 0)
    return Skeleton(tuple(n for n, _, _ in joints), parents, np.tile([0.0, 0, 0, 1], (len(joints), 1)), local)
