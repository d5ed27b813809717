"""Two-bone limbs that reach a target, for any number of frames at once; and the twist of a forearm.

Everything about an arm is worked out for the left one in the space of the upper chest; the right one is its
mirror image (see `rig.mirrored`).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from metagraph.motion import rotation
from sample_clips.make.mannequin_rig import ARM_AXIS, PALM, REST, SKELETON, Array, about, at

FOREARM_SHARE = 0.65  # of a hand's turning is done by the forearm, the rest shows at the wrist
FULL_REACH = 0.9985  # of a limb's length: a limb that is quite straight snaps
SOFT_REACH = 0.002  # metres
_COLLAR = SKELETON.rest_translations[at("LeftShoulder")]
_SHOULDER = SKELETON.rest_translations[at("LeftUpperArm")]
_UPPER = float(np.linalg.norm(SKELETON.rest_translations[at("LeftLowerArm")]))
_LOWER = float(np.linalg.norm(SKELETON.rest_translations[at("LeftHand")]))


def unit(v: Any) -> Array:
    """Return vectors `[..., 3]` at length one."""
    v = np.asarray(v, float)
    return v / np.maximum(np.linalg.norm(v, axis=-1, keepdims=True), 1e-9)


def frame(along: Any, side: Any) -> Array:
    """Return the rotation `[..., 4]` whose x axis is `along` and whose y axis leans to `side`."""
    x = unit(along)
    side = np.broadcast_to(side, x.shape)
    y = unit(side - np.sum(side * x, -1, keepdims=True) * x)
    return rotation.from_matrix(np.stack([x, y, np.cross(x, y)], -1))


_ARM_REST = rotation.conjugate(frame(ARM_AXIS, PALM))


def two_bones(
    root: Array, target: Array, pole: Array, upper: float, lower: float
) -> tuple[Array, Array, Array]:
    """Return the directions of both bones and the axis the middle joint bends about, each `[..., 3]`.

    root, target: where the limb begins and should end. pole: the direction in which the middle joint sticks
    out. A target out of reach is reached for.
    """
    to = np.asarray(target, float) - root
    distance = np.linalg.norm(to, axis=-1, keepdims=True)
    along = unit(to)
    distance = np.clip(distance, abs(upper - lower) + 0.02, (upper + lower) * FULL_REACH)
    pole = np.broadcast_to(pole, along.shape)
    out = unit(pole - np.sum(pole * along, -1, keepdims=True) * along)
    cosine = (upper**2 + distance**2 - lower**2) / (2 * upper * distance)
    sine = np.sqrt(np.maximum(0, 1 - cosine**2))
    first = along * cosine + out * sine
    second = unit(along * distance - first * upper)
    return first, second, np.cross(out, along)


def arm(wrist: Any, pole: Any, collar: Any) -> tuple[Array, Array, Array]:
    """Return local rotations of the left upper arm and forearm, and the forearm's in the chest's space, each
    `[..., 4]`.

    wrist: its place from the upper chest's joint, metres. pole: where the elbow points. collar: the
    collarbone's rotation.
    """
    root = _COLLAR + rotation.rotate_vectors(collar, _SHOULDER)
    first, second, hinge = two_bones(root, np.asarray(wrist, float), np.asarray(pole, float), _UPPER, _LOWER)
    upper = rotation.multiply(frame(first, hinge), _ARM_REST)
    lower = rotation.multiply(frame(second, hinge), _ARM_REST)
    return (
        rotation.multiply(rotation.conjugate(collar), upper),
        rotation.multiply(rotation.conjugate(upper), lower),
        lower,
    )


def raised(lift: Any, forwards: Any) -> Array:
    """Return the left collarbone's rotation `[..., 4]` that raises the shoulder and brings it forwards by
    degrees.
    """
    return rotation.multiply(about((0, 1, 0), -np.asarray(forwards, float)), about((0, 0, 1), lift))


def collarbone(upper: Any, collar: Any, shrug: float = 0.0, reach: float = 0.0) -> Array:
    """Return how the left collarbone follows an upper arm: it rises with it and comes forwards when it
    reaches across.
    """
    direction = rotation.rotate_vectors(rotation.multiply(collar, upper), ARM_AXIS)
    angle = np.degrees(np.arccos(np.clip(-direction[..., 1], -1, 1)))  # of the upper arm from hanging
    lift = shrug + 0.16 * np.maximum(0, angle - 32)
    forwards = reach + 5.0 * np.maximum(0, direction[..., 2]) - 9.0 * np.minimum(0, direction[..., 0] - 0.1)
    return raised(lift, forwards)


def twist_of(q: Any, axis: Any) -> Array:
    """Return the part `[..., 4]` of a rotation that turns about the axis."""
    q = np.asarray(q)
    part = np.sum(q[..., :3] * axis, -1, keepdims=True)
    return rotation.normalize(np.concatenate([part * axis, q[..., 3:]], -1))


def share_twist(lower: Any, hand: Any) -> tuple[Array, Array]:
    """Move most of the hand's turning about the forearm into the forearm; both are left local rotations
    `[..., 4]`.
    """
    twist = rotation.scale_rotation(twist_of(hand, ARM_AXIS), FOREARM_SHARE)
    return rotation.multiply(lower, twist), rotation.multiply(rotation.conjugate(twist), hand)


def leg(
    side: str, hips: Array, hips_place: Array, ankle: Array, knee: Array, foot: Array
) -> tuple[Array, Array, Array]:
    """Return local rotations of thigh, shin and foot, each `[..., 4]`.

    hips, hips_place: the pelvis in model space. ankle: where it should be. knee: where the knee points.
    foot: the foot's rotation in model space.
    """
    offsets = [SKELETON.rest_translations[at(side + joint)] for joint in ("UpperLeg", "LowerLeg", "Foot")]
    root = hips_place + rotation.rotate_vectors(hips, offsets[0])
    upper, lower = float(np.linalg.norm(offsets[1])), float(np.linalg.norm(offsets[2]))
    first, second, hinge = two_bones(root, ankle, knee, upper, lower)
    x_axis = np.array([1.0, 0, 0])
    thigh = rotation.multiply(frame(first, hinge), rotation.conjugate(frame(offsets[1], x_axis)))
    shin = rotation.multiply(frame(second, hinge), rotation.conjugate(frame(offsets[2], x_axis)))
    inverse = rotation.conjugate
    return (
        rotation.multiply(inverse(hips), thigh),
        rotation.multiply(inverse(thigh), shin),
        rotation.multiply(inverse(shin), foot),
    )


def out_of_reach(side: str, hips: Array, hips_place: Array, ankle: Array) -> Array:
    """Return by how many metres `[...]` the pelvis has to sink for an ankle to be within the leg's reach;
    from `SOFT_REACH` before that on, so that it sets in gently.
    """
    offsets = [SKELETON.rest_translations[at(side + joint)] for joint in ("UpperLeg", "LowerLeg", "Foot")]
    way = hips_place + rotation.rotate_vectors(hips, offsets[0]) - ankle
    most = FULL_REACH * float(np.linalg.norm(offsets[1]) + np.linalg.norm(offsets[2]))
    aside = way[..., 0] ** 2 + way[..., 2] ** 2
    over = way[..., 1] - np.sqrt(np.maximum(1e-6, most**2 - aside))
    gently = (over + SOFT_REACH) ** 2 / (4 * SOFT_REACH)
    return np.asarray(
        np.where(over >= SOFT_REACH, over, np.where(over <= -SOFT_REACH, 0.0, gently)), np.float64
    )


BALL = {side: REST[at(side + "Toes")] for side in ("Left", "Right")}
ANKLE = {side: REST[at(side + "Foot")] for side in ("Left", "Right")}
