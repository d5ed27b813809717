"""Limbs of two bones: where they bend when their end is brought to a place, and how far they reach."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.motion import rotation

Array = NDArray[Any]

STRAIGHT = 0.02  # of the upper bone: a joint less than this beside the line of its limb that has to bend
# further bends to its pole


def solve_limb(
    goal: Array, one: float, two: float, start: Array, source: tuple[Array, Array, Array], pole: Array
) -> tuple[Array, Array]:
    """Return where the middle joint and the end come to, `[F, 3]` from the limb's root.

    goal: `[F, 3]`, from the root. one, two: lengths of the bones. start: `[F, 3]` directions from which turns
    about the limb are computed, by the shortest way, so that they are the same there and back. source: places
    of the limb that is followed, each `[F, 3]`. pole: `[F, 3]` where a straight limb bends to.
    """
    goal = clamp_to_reach(goal, abs(one - two) + 1e-3 * (one + two), one + two)
    far = np.linalg.norm(goal, axis=-1, keepdims=True)
    ahead = goal / far
    root, middle, end = (p.astype(np.float64) for p in source)
    way, knee = normalize_directions(end - root), normalize_directions(middle - root)
    aside = knee - way * np.einsum("fi,fi->f", knee, way)[:, None]
    aside = rotation.rotate_vectors(rotation.conjugate(rotation.find_rotation_between(start, way)), aside)
    aside = rotation.rotate_vectors(rotation.find_rotation_between(start, ahead), aside)
    pole = pole - ahead * np.einsum("fi,fi->f", pole, ahead)[:, None]
    along = (one**2 + far**2 - two**2) / (2 * far)
    out = np.sqrt(np.maximum(0, one**2 - along**2))
    # Where it bends more than the source, a hardly bent source's side is no guide.
    size = np.linalg.norm(aside, axis=-1, keepdims=True)
    more = np.clip((out / one - size) / STRAIGHT, 0, 1)
    aside = normalize_directions(aside + np.maximum(0, STRAIGHT - size) * more * pole)
    return ahead * along + aside * out, goal


def normalize_directions(v: Array) -> Array:
    """Return directions `[..., 3]`."""
    return np.asarray(v / np.maximum(np.linalg.norm(v, axis=-1, keepdims=True), 1e-9))


def ease_reach(reach: Array, free: Array) -> Array:
    """Return `reach [F]`, of a limb's length, slowed down from `free` on so that it never quite gets to 1: no
    elbow snaps straight.
    """
    left = np.maximum(1 - free, 1e-6)
    return np.where(reach > free, free + left * (1 - np.exp(-np.maximum(0, reach - free) / left)), reach)


def fade_above_half(amount: Array) -> Array:
    """Return 1 for `amount` up to 0.5, 0 from 1 on, smoothly less between."""
    x = np.clip(2 - 2 * amount, 0, 1)
    return np.asarray(x * x * (3 - 2 * x))


def clamp_to_reach(goal: Array, least: float, most: float) -> Array:
    """Return `[F, 3]` moved into reach sideways, so that the height stays."""
    goal = goal.copy()
    goal[:, 1] = np.clip(goal[:, 1], -most, most)
    flat = np.linalg.norm(goal[:, [0, 2]], axis=-1)
    room = np.sqrt(np.maximum(0, most**2 - goal[:, 1] ** 2))
    goal[:, [0, 2]] *= np.minimum(1, room / np.maximum(flat, 1e-9))[:, None]
    flat = np.linalg.norm(goal[:, [0, 2]], axis=-1)
    goal[flat < 1e-6, 2] = flat[flat < 1e-6] = 1e-6  # straight above or below: out to the front
    out = np.sqrt(np.maximum(0, least**2 - goal[:, 1] ** 2))
    goal[:, [0, 2]] *= np.maximum(1, out / flat)[:, None]
    return goal
