"""Which joints each point of the mannequin follows, by part."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sample_clips.make import shapes
from sample_clips.make.mannequin_skeleton import ARM, FINGERS
from sample_clips.make.shapes import JOINT, MOUTH_HALF, mouth_line, step

Array = NDArray[Any]
Weights = dict[str, Array]


def chain(p: Array, joints: tuple[str, ...], reach: tuple[float, ...], axes: tuple[Array, ...]) -> Weights:
    """Weights along a chain: each joint takes over from the one before across its plane, within `reach`
    metres.
    """
    out: Weights = {}
    left = np.ones(len(p))
    passed = []
    for joint, half, axis in zip(joints[1:], reach, axes, strict=True):
        passed.append(step(-half, half, (p - JOINT[joint]) @ (axis / np.linalg.norm(axis))))
    for i, joint in enumerate(joints):
        here = left * (1 - passed[i]) if i < len(passed) else left
        out[joint] = here
        left = left * passed[i] if i < len(passed) else left
    return out


def spine(p: Array) -> Weights:
    up = np.array([0.0, 1, 0])
    return chain(
        p,
        ("Hips", "Spine", "Chest", "UpperChest", "Neck"),
        (0.06, 0.07, 0.07, 0.035),
        (up, up, up, np.array([0, 1.0, 0.2])),
    )


def arm(p: Array) -> Weights:
    shoulder = np.array([1.0, 0.0, 0.0]) + ARM
    return chain(
        p,
        ("LeftShoulder", "LeftUpperArm", "LeftLowerArm", "LeftHand"),
        (0.055, 0.050, 0.020),
        (shoulder, ARM, ARM),
    )


def _mixed(groups: list[tuple[Array, Weights]], softness: float) -> Weights:
    """Blend groups of weights by how near each one's own form is: `(distances [V], weights)`."""
    distance = np.stack([d for d, _ in groups])
    share = np.exp(-(distance - distance.min(0)) / softness)
    share /= share.sum(0)
    out: Weights = {}
    for part, (_, weights) in zip(share, groups, strict=True):
        for name, w in weights.items():
            out[name] = out.get(name, 0) + part * w
    return out


def _other_side(f: Callable[[Array], Weights], p: Array) -> Weights:
    return {("Right" + n[4:] if n.startswith("Left") else n): w for n, w in f(p * [-1, 1, 1]).items()}


def sweater_weights(p: Array) -> Weights:
    flip = np.array([-1, 1, 1])
    sleeve = shapes.sleeve()
    trunk = spine(p)
    # The shoulder joint carries the top of the torso beside it.
    for s, name in ((1, "LeftShoulder"), (-1, "RightShoulder")):
        w = 0.75 * step(0.045, 0.150, s * p[:, 0]) * step(1.27, 1.385, p[:, 1])
        trunk = {n: v * (1 - w) for n, v in trunk.items()}
        trunk[name] = w
    groups = [(shapes.torso()(p), trunk), (sleeve(p), arm(p)), (sleeve(p * flip), _other_side(arm, p))]
    return _mixed(groups, 0.013)


def _leg(p: Array) -> Weights:
    down = np.array([0.0, -1, 0])
    return chain(p, ("LeftUpperLeg", "LeftLowerLeg", "LeftFoot"), (0.060, 0.030), (down, down))


def trouser_weights(p: Array) -> Weights:
    leg = shapes.leg()
    hips = {"Hips": np.ones(len(p))}
    # The leg takes over from the hips below the joint; a soft field keeps the crease of the hip round when
    # sitting.
    above = np.maximum(0, (p[:, 1] - 0.930) * 0.9)
    groups = [
        (shapes.pelvis()(p), hips),
        (leg(p) + above, _leg(p)),
        (leg(p * [-1, 1, 1]) + above, _other_side(_leg, p)),
    ]
    return _mixed(groups, 0.011)


def shoe_weights(p: Array) -> Weights:
    return chain(
        p,
        ("LeftLowerLeg", "LeftFoot", "LeftToes"),
        (0.030, 0.035),
        (np.array([0.0, -1, 0.3]), np.array([0.0, 0, 1])),
    )


def hand_weights(p: Array, fingers: tuple[str, ...] = FINGERS) -> Weights:
    groups = [(shapes.palm()(p), chain(p, ("LeftLowerArm", "LeftHand"), (0.022,), (ARM,)))]
    for name in fingers:
        points = shapes.finger_points(name)
        axis = points[2] - points[1]
        half = (0.010, 0.0065, 0.006)
        bones = chain(p, ("LeftHand", *(f"Left{name}{i}" for i in (1, 2, 3))), half, (axis, axis, axis))
        # A finger begins at its knuckle: beyond it the palm has no say, however near it is.
        behind = np.maximum(0, -(p - points[0]) @ (axis / np.linalg.norm(axis)) - 0.004)
        groups.append((np.maximum(shapes.finger(name)(p), 0) + behind * 0.7, bones))
    return _mixed(groups, 0.0022)


def head_weights(p: Array, lower: Array | None = None, across: Array | None = None) -> Weights:
    """lower: whether points `[V]` are of the lower lip, else of the upper; across `[V]`: where between the
    corners of the mouth they belong. By default both follow from where the points are.
    """
    out = chain(
        p,
        ("UpperChest", "Neck", "Head"),
        (0.030, 0.034),
        (np.array([0.0, 1, 0.15]), np.array([0.0, 1, -0.35])),
    )
    x, y, z = np.abs(p[:, 0]), p[:, 1], p[:, 2]
    face = step(0.022, 0.050, z)  # the neck has no say in the face: else a nod would part the lips
    out = {n: w * (1 - face) for n, w in out.items()}
    out["Head"] = out["Head"] + face
    below = mouth_line(x) - y
    soft = step(-0.016, 0.012, below)
    sharp = (below > 0).astype(float) if lower is None else lower
    # Where the two lips part: fully in the middle, less towards the corners, so that the open mouth is round.
    between = np.abs(p[:, 0] if across is None else across)
    lips = np.sqrt(np.clip(1 - (between / MOUTH_HALF) ** 2, 0, 1)) * step(0.040, 0.055, z)
    reach = 1.0 if lower is None else step(0.019, 0.004, np.abs(below))  # the skin about lips goes softly
    lips = lips * reach
    jaw = (
        (soft * (1 - lips) + sharp * lips)
        * step(-0.010, 0.040, z + 0.35 * (1.545 - y))
        * step(1.478, 1.500, y + 0.35 * (z - 0.03))
    )
    jaw *= 1 - 0.5 * step(0.035, 0.060, x)
    out = {n: w * (1 - jaw) for n, w in out.items()}
    return {**out, "Jaw": jaw}
