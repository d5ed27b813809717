"""Numbers that tell whether a clip could be a person's: speeds, jumps, sliding feet, hands inside the body,
wrists past their limits.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from sample_clips.make import ik
from sample_clips.make.mannequin_rig import ARM_AXIS, FPS, PALM, SIDES, SKELETON, Array, at, mirrored
from sample_clips.make.mannequin_skeleton import FINGERS

# Torso: joint, height above it, half width, half depth, forward shift; metres.
TORSO = (
    ("Hips", -0.06, 0.150, 0.10, 0.0),
    ("Hips", 0.0, 0.165, 0.11, 0.0),
    ("Hips", 0.06, 0.150, 0.105, 0.0),
    ("Spine", 0.03, 0.130, 0.10, 0.005),
    ("Spine", 0.08, 0.125, 0.10, 0.008),
    ("Chest", 0.03, 0.132, 0.105, 0.012),
    ("Chest", 0.09, 0.142, 0.110, 0.015),
    ("UpperChest", 0.01, 0.150, 0.112, 0.02),
    ("UpperChest", 0.07, 0.150, 0.10, 0.02),
    ("UpperChest", 0.12, 0.110, 0.07, 0.0),
)


@dataclass(frozen=True)
class Measures:
    """hand_speed: m/s, peak of either wrist. turn_speed, turn_jerkiness: deg/s peak of any joint, and the
    largest change of it between two frames. slide: metres a planted foot's ball moves. inside: metres a hand,
    wrist or forearm is inside the torso (negative: its nearest distance). together: the nearest the two
    forearms come, metres. wrist: degrees (most bent to the palm, most bent back, most to the thumb, most to
    the little finger). turned: degrees the palm is turned up and down. elbow: degrees (least, most) bent.
    """

    hand_speed: float
    turn_speed: float
    turn_change: float
    slide: float
    inside: float
    together: float
    wrist: tuple[float, float, float, float]
    turned: tuple[float, float]
    elbow: tuple[float, float]


def _inside_torso(points: Array, turns: Array, places: Array) -> Array:
    """Return how deep points `[F, N, 3]` are in the torso `[F, N]`, metres; negative outside."""
    local, rows = [], []
    for name, up, wide, deep, forwards in TORSO:
        joint = at(name)
        back = rotation.conjugate(turns[:, None, joint])
        p = rotation.rotate_vectors(back, points - places[:, None, joint])
        local.append(p - np.array([0, up, forwards]))
        rows.append((wide, deep))
    q = np.stack(local)  # [S, F, N, 3]
    wide, deep = np.array(rows).T[..., None, None]
    across = np.hypot(q[..., 0] / wide, q[..., 2] / deep)
    depth = (1 - across) * np.minimum(wide, deep)
    near = np.abs(q[..., 1]) < 0.04
    return np.where(near, depth, -1.0).max(0)


def _segments(a: Array, b: Array, c: Array, d: Array) -> Array:
    """Return the least distance `[F]` between segments ab and cd `[F, 3]`, to about a millimetre."""
    f = np.linspace(0, 1, 25)[:, None]
    p = a[:, None] + (b - a)[:, None] * f
    q = c[:, None] + (d - c)[:, None] * f
    return np.linalg.norm(p[:, :, None] - q[:, None], axis=-1).min((1, 2))


def measure(clip: Clip) -> Measures:
    """Return the clip's measures."""
    poses = clip.poses()
    r, p = SKELETON.globals(poses)
    r, p = np.asarray(r, float), np.asarray(p, float)
    local = np.asarray(clip.rotations, float)
    speed = np.linalg.norm(np.diff(p[:, [at("LeftHand"), at("RightHand")]], axis=0), axis=-1) * FPS
    turning = rotation.log(rotation.multiply(rotation.conjugate(local[:-1]), local[1:])) * (180 / np.pi) * FPS
    inside, wrist, turned, elbow = [], [], [], []
    for side in SIDES:
        points = [
            p[:, at(side + "LowerArm")] * (1 - f) + p[:, at(side + "Hand")] * f
            for f in (0.0, 0.33, 0.67, 1.0)
        ]
        points += [p[:, at(f"{side}{finger}{bone}")] for finger in FINGERS for bone in (1, 3)]
        radii = np.array([0.036, 0.034, 0.030, 0.022] + [0.010] * 10)
        inside.append((_inside_torso(np.stack(points, 1), r, p) + radii).max())
        lower, hand = (local[:, at(side + j)] for j in ("LowerArm", "Hand"))
        if side == "Right":
            lower, hand = mirrored(lower), mirrored(hand)
        lower_twist = ik.twist_of(lower, ARM_AXIS)
        hinge = rotation.multiply(lower, rotation.conjugate(lower_twist))
        elbow.append(np.degrees(rotation.log(hinge) @ PALM))
        twist = ik.twist_of(hand, ARM_AXIS)
        swing = np.degrees(rotation.log(rotation.multiply(rotation.conjugate(twist), hand)))
        turned.append(-np.degrees((rotation.log(lower_twist) + rotation.log(twist)) @ ARM_AXIS))
        wrist.append((swing @ np.cross(ARM_AXIS, PALM), swing @ PALM))
    feet = p[:, [at("LeftToes"), at("RightToes")]]
    planted = (feet[..., 1] < feet[..., 1].min() + 0.0015)[:-1] & (
        feet[..., 1] < feet[..., 1].min() + 0.0015
    )[1:]
    slide = np.where(planted, np.linalg.norm(np.diff(feet[..., [0, 2]], axis=0), axis=-1), 0).max(initial=0)
    bend, sideways = (np.stack([w[i] for w in wrist]) for i in (0, 1))
    together = _segments(
        p[:, at("LeftLowerArm")], p[:, at("LeftHand")], p[:, at("RightLowerArm")], p[:, at("RightHand")]
    )
    return Measures(
        hand_speed=float(speed.max(initial=0)),
        turn_speed=float(np.linalg.norm(turning, axis=-1).max(initial=0)),
        turn_change=float(np.linalg.norm(np.diff(turning, axis=0), axis=-1).max(initial=0)),
        slide=float(slide),
        inside=float(max(inside)),
        together=float(together.min()),
        wrist=(float(bend.max()), float(-bend.min()), float(sideways.max()), float(-sideways.min())),
        turned=(float(np.max(turned)), float(-np.min(turned))),
        elbow=(float(np.min(elbow)), float(np.max(elbow))),
    )


LATEST = 0.2  # seconds one hand may come after the other


def likeness(clip: Clip) -> float:
    """Return how alike the speeds of both hands are, -1..1: their correlation, one shifted to where it is
    largest. Two hands that one program moves have 0.99 and more; recorded two-handed gestures have 0.97 on
    average and 0.87 or less in one of ten (SmartBody's, of two actors).
    """
    _, places = SKELETON.globals(clip.poses())
    hands = np.asarray(places, float)[:, [at("LeftHand"), at("RightHand")]]
    left, right = (np.linalg.norm(np.diff(hands, axis=0), axis=-1) * FPS).T
    found = []
    for k in range(-round(LATEST * FPS), round(LATEST * FPS) + 1):
        a = left[max(0, k) : len(left) + min(0, k)]
        b = right[max(0, -k) : len(right) - max(0, k)]
        found.append(float(np.corrcoef(a, b)[0, 1]))
    return max(found)


def head_ways(clip: Clip) -> tuple[float, float]:
    """Return how far a clip turns the head to the sides and up or down, degrees from end to end."""
    turns, _ = SKELETON.globals(clip.poses())
    head = np.asarray(turns, float)[:, at("Head")]
    ahead = rotation.rotate_vectors(head, np.broadcast_to(np.array([0.0, 0.0, 1.0]), (len(head), 3)))
    sideways = np.degrees(np.arctan2(ahead[:, 0], ahead[:, 2]))
    return float(np.ptp(sideways)), float(np.ptp(np.degrees(np.arcsin(ahead[:, 1]))))


def way_of(clip: Clip, joint: str) -> Array:
    """Return how far a joint gets about, (left, up, ahead) metres from end to end."""
    _, places = SKELETON.globals(clip.poses())
    return np.asarray(np.ptp(np.asarray(places, float)[:, at(joint)], axis=0))
