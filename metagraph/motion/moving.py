"""Which parts of the body a clip moves: by how far their joints turn, and how far it travels."""

from __future__ import annotations

from functools import lru_cache
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from metagraph.motion.clip import Clip
from metagraph.motion.roles import assign_body_parts
from metagraph.motion.skeleton import Skeleton

Array = NDArray[Any]
Moved = Literal["place", "legs", "spine", "arms", "head", "face"]

LOOK_AT = 48  # frames of a clip that are compared
# Degrees that a joint has to turn for its part to count as moved, and how far a clip has to travel, as a part
# of the character's height. The numbers are ours: above what breathing and swaying in an idle loop come to.
TURNS: dict[Moved, float] = {"legs": 10.0, "spine": 4.0, "arms": 10.0, "head": 3.5, "face": 3.0}
TRAVELS = 0.12
PARTS: tuple[Moved, ...] = ("place", *TURNS)


def find_moved_parts(clip: Clip) -> tuple[Moved, ...]:
    """Return the parts that a clip moves, "place" first where it travels; nothing for one that stands still.

    A joint moves with its part where it turns farther against its parent, from its mean pose, than `TURNS`.
    """
    frames = np.unique(np.linspace(0, clip.frames - 1, min(clip.frames, LOOK_AT)).round().astype(int))
    turned = _turned(clip.rotations[frames])
    parts = _parts(clip.skeleton)
    out: list[Moved] = []
    root = clip.translations[frames, 0]
    if len(frames) > 1 and np.ptp(root, axis=0).max() > TRAVELS * _height(clip.skeleton):
        out.append("place")
    for part, least in TURNS.items():
        joints = np.array([i for i, p in enumerate(parts) if p == part and i > 0], int)
        if len(joints) and np.degrees(turned[joints].max()) > least:
            out.append(part)
    return tuple(out)


def _turned(rotations: Array) -> Array:
    """Return `[J]` the largest angle, radians, between a joint's rotations `[F, J, 4]` and their mean."""
    mean = rotations.astype(np.float64).mean(0)
    mean /= np.maximum(np.linalg.norm(mean, axis=-1, keepdims=True), 1e-9)
    near = np.abs(np.einsum("fjk,jk->fj", rotations, mean)).min(0)
    return np.asarray(2 * np.arccos(np.clip(near, 0.0, 1.0)))


@lru_cache(maxsize=32)
def _parts(skeleton: Skeleton) -> tuple[str, ...]:
    return assign_body_parts(skeleton)


@lru_cache(maxsize=32)
def _height(skeleton: Skeleton) -> float:
    """How high the rest pose is, metres."""
    positions = skeleton.globals(skeleton.rest)[1]
    return float(max(np.ptp(positions[:, 1]), 1e-3))
