"""Which joints each point of the default body follows, by role."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.motion.joint_map import FINGERS
from sample_clips.make.default_body import forms
from sample_clips.make.default_body.joints import ARM, FOREARM, default_skeleton, finger_points
from sample_clips.make.sculpt import Field, union

Array = NDArray[Any]
Weights = dict[str, Array]

SKELETON = default_skeleton()
AT: dict[str, Array] = dict(zip(SKELETON.names, SKELETON.globals(SKELETON.rest)[1], strict=True))
UP, DOWN = np.array([0.0, 1, 0]), np.array([0.0, -1, 0])
SOFT = 0.012  # metres by which another part's form may be farther and still have a say
ROUNDS = 3  # of evening weights out over neighbours


def step(low: float, high: float, x: Array) -> Array:
    """0 below `low`, 1 above `high`, smooth between."""
    t = np.clip((x - low) / (high - low), 0, 1)
    return np.asarray(t * t * (3 - 2 * t))


def chain(p: Array, joints: tuple[str, ...], reaches: tuple[float, ...], axes: tuple[Array, ...]) -> Weights:
    """Return weights along a chain: each joint takes over from the one before across a plane through it."""
    out: Weights = {}
    left = np.ones(len(p))
    for before, joint, reach, axis in zip(joints, joints[1:], reaches, axes, strict=False):
        passed = step(-reach, reach, (p - AT[joint]) @ (axis / np.linalg.norm(axis)))
        out[before] = left * (1 - passed)
        left = left * passed
    out[joints[-1]] = left
    return out


def trunk_weights(p: Array) -> Weights:
    """The spine, and the shoulders beside it."""
    ahead = np.array([0.0, 1, -0.35])
    out = chain(
        p,
        ("hips", "spine", "chest", "upper_chest", "neck", "head"),
        (0.06, 0.07, 0.07, 0.04, 0.034),
        (UP, UP, UP, np.array([0, 1.0, 0.2]), ahead),
    )
    face = step(0.030, 0.055, p[:, 2]) * step(1.50, 1.52, p[:, 1])  # the neck has no say in the chin
    out = {n: w * (1 - face) for n, w in out.items()}
    out["head"] = out["head"] + face
    shoulder = (
        0.85 * step(0.040, 0.150, p[:, 0]) * step(1.29, 1.40, p[:, 1]) * (out["upper_chest"] + out["chest"])
    )
    total = np.maximum(out["upper_chest"] + out["chest"], 1e-9)
    for name in ("chest", "upper_chest"):
        out[name] = out[name] * (1 - shoulder / total)
    out["left_shoulder"] = shoulder
    return out


def arm_weights(p: Array) -> Weights:
    return chain(
        p,
        ("left_shoulder", "left_upper_arm", "left_lower_arm", "left_hand"),
        (0.075, 0.055, 0.024),
        (np.array([0.55, -0.25, 0.0]), ARM + FOREARM, FOREARM),
    )


def hand_weights(p: Array) -> Weights:
    groups = [(forms.palm()(p), chain(p, ("left_lower_arm", "left_hand"), (0.024,), (FOREARM,)))]
    for name in FINGERS:
        points = finger_points(name)
        axis = points[1] - points[0] if name == "thumb" else points[2] - points[0]
        reaches = (0.016, 0.009, 0.008) if name == "thumb" else (0.011, 0.008, 0.007)
        bones = chain(
            p,
            ("left_hand", *(f"left_{name}_{n}" for n in (1, 2, 3))),
            reaches,
            tuple(np.diff(points, axis=0)),
        )
        # A finger begins at its knuckle: beyond it the palm has no say, however near it is.
        behind = np.maximum(0, -(p - points[0]) @ (axis / np.linalg.norm(axis)) - 0.004)
        groups.append((np.maximum(forms.finger(name)(p), 0) + 0.7 * behind, bones))
    return _mixed(groups, 0.0022)


def leg_weights(p: Array) -> Weights:
    return chain(
        p,
        ("hips", "left_upper_leg", "left_lower_leg", "left_foot"),
        (0.085, 0.065, 0.034),
        (np.array([0.30, -1.0, 0.10]), DOWN, np.array([0.0, -1, 0.35])),
    )


def foot_weights(p: Array) -> Weights:
    return chain(
        p,
        ("left_lower_leg", "left_foot", "left_toes"),
        (0.034, 0.034),
        (np.array([0.0, -1, 0.35]), np.array([0.0, 0, 1])),
    )


def _mixed(groups: list[tuple[Array, Weights]], soft: float) -> Weights:
    """Return groups of weights, each by how near its own form is: `(distances [V], weights)`."""
    distance = np.stack([d for d, _ in groups])
    share = np.exp(-(distance - distance.min(0)) / soft)
    share /= share.sum(0)
    out: Weights = {}
    for part, (_, weights) in zip(share, groups, strict=True):
        for name, w in weights.items():
            out[name] = out.get(name, 0) + part * w
    return out


def skin(positions: Array, triangles: Array) -> Array:
    """Return how much each point follows each joint of the skeleton, `[V, J]`, summing to 1.

    The points are those of the whole body; right ones follow what their mirror images do.
    """
    p = positions * np.where(positions[:, :1] < 0, [-1, 1, 1], 1)
    middle: Field = union([forms.trunk(), forms.neck(), forms.head()], 0.02)
    leg = forms.leg()(p) + np.maximum(0, (p[:, 1] - 0.93) * 0.9)
    made = _mixed(
        [
            (middle(p), trunk_weights(p)),
            (forms.arm()(p), arm_weights(p)),
            (forms.hand()(p), hand_weights(p)),
            (leg, leg_weights(p)),
            (forms.foot()(p), foot_weights(p)),
        ],
        SOFT,
    )
    dense = np.zeros((len(p), len(SKELETON)))
    right = positions[:, 0] < 0
    for name, w in made.items():
        other = name.replace("left_", "right_")
        dense[:, SKELETON.index(name)] += np.where(right, 0, w)
        dense[:, SKELETON.index(other)] += np.where(right, w, 0)
    middle_row = np.abs(positions[:, 0]) < 1e-9  # follows both sides alike
    for name in made:
        if name.startswith("left_"):
            a, b = SKELETON.index(name), SKELETON.index(name.replace("left_", "right_"))
            dense[middle_row, b] = dense[middle_row, a] = dense[middle_row, a] / 2
    return _evened(dense, triangles)


def _evened(dense: Array, triangles: Array) -> Array:
    """Return weights spread over neighbours, fingers' less."""
    ends = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    ends = np.concatenate([ends, ends[:, ::-1]])
    count = np.maximum(np.bincount(ends[:, 0], minlength=len(dense)), 1)[:, None]
    fine = np.array([name.endswith(("_1", "_2", "_3")) or "hand" in name for name in SKELETON.names])
    keep = 0.4 + 0.5 * dense[:, fine].sum(1, keepdims=True).clip(0, 1)
    for _ in range(ROUNDS):
        around = np.zeros_like(dense)
        np.add.at(around, ends[:, 0], dense[ends[:, 1]])
        dense = keep * dense + (1 - keep) * around / count
    return np.asarray(dense / dense.sum(1, keepdims=True))
