"""Feet that stand where they stood: motion put together of pieces lets them slide wherever the pieces meet.

Where a foot stands the takes tell, whose frames the motion is of. From when it stands it is held where it was
put down, as long as that is not too far from where the motion has it; the leg bends to it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.contact_hold import bring_limb
from metagraph.motion.roles import find_roles
from metagraph.motion.skeleton import Pose, Skeleton
from metagraph.suggest.tracks import RATE

Array = NDArray[Any]

SLOW = 0.15  # metres a second, of a person 1.75 m high: a foot that is slower, and low, stands
LOW = 0.05  # metres above the floor, in the same way
TALL = 1.75
LEG = ("upper_leg", "lower_leg", "foot")
LEAST = 0.2  # seconds a foot stands at least
FADE = 0.2  # seconds in which it is let go, and taken
FARTHEST = 0.1  # metres it is held back at most, in the same way; beyond it goes along


def find_standing(skeleton: Skeleton, poses: Pose) -> dict[str, Array]:
    """Return when each foot stands in a take of RATE frames a second, left and right `[F]`; nothing of what
    has no legs.
    """
    roles = find_roles(skeleton)
    size = max(skeleton.height, 1e-3) / TALL
    places = skeleton.globals(poses)[1]
    out = {}
    for side in ("left", "right"):
        if not {f"{side}_{role}" for role in LEG} <= roles.keys():
            continue
        foot = places[:, roles[f"{side}_foot"]]
        speed = np.linalg.norm(np.gradient(foot, 1 / RATE, axis=0), axis=-1)
        low = foot[:, 1] < np.percentile(foot[:, 1], 5) + LOW * size
        out[side] = _long((speed < SLOW * size) & low, round(LEAST * RATE))
    return out


def _long(there: Array, least: int) -> Array:
    """Return where a thing holds that holds so many frames at least; shorter gaps within it are closed."""
    out = there.copy()
    for value in (False, True):
        edges = np.flatnonzero(
            np.diff(np.concatenate([[not value], out == value, [not value]]).astype(np.int8))
        )
        for a, b in edges.reshape(-1, 2):
            inside = value or (a > 0 and b < len(out))
            if inside and b - a < (least if value else least // 2):
                out[a:b] = not value
    return out


def keep_feet_still(clip: Clip, when: Mapping[str, Array]) -> Clip:
    """Return a clip whose feet do not slide while they stand. when: each foot does, `[F]`."""
    roles = find_roles(clip.skeleton)
    size = max(clip.skeleton.height, 1e-3) / TALL
    for side, there in when.items():
        limb = tuple(roles[f"{side}_{role}"] for role in LEG)
        turns, places = (np.asarray(a, np.float64) for a in clip.skeleton.globals(clip.poses()))
        foot = places[:, limb[2]]
        goal = foot + _back(foot, there, FARTHEST * size, max(1, round(FADE * clip.fps)))
        made = bring_limb(clip, turns, places, (limb[0], limb[1], limb[2]), goal, turns[:, limb[2]])
        rotations = np.array(clip.rotations, np.float64)
        moved = np.linalg.norm(goal - foot, axis=-1) > 1e-6
        for joint in limb:
            rotations[moved, joint] = made[moved, joint]
        clip = replace(
            clip, rotations=rotation.make_continuous(rotation.normalize(rotations)).astype(np.float32)
        )
    return clip


def _back(foot: Array, there: Array, most: float, fade: int) -> Array:
    """Return by how much a foot is held back `[F, 3]`: from where it is to where it was put down."""
    out = np.zeros_like(foot)
    anchor: Array | None = None
    for t in range(len(foot)):
        if not there[t]:
            anchor = None
            continue
        if anchor is None:
            anchor = foot[t].copy()
        away = anchor - foot[t]
        away[1] = 0.0  # the ground is where the motion has it
        far = float(np.linalg.norm(away))
        if far > most:
            anchor = anchor - away * (1 - most / far)
            away *= most / far
        out[t] = away
    # What is left when a foot is let go fades, and does not come at once.
    ends = np.flatnonzero(there & ~np.append(there[1:], False))
    for end in ends.tolist():
        left = out[end]
        for n in range(1, fade + 1):
            if end + n >= len(foot) or there[end + n]:
                break
            out[end + n] += left * (0.5 + 0.5 * np.cos(np.pi * n / (fade + 1)))
    return out
