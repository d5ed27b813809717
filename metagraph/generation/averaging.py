"""Poses averaged over frames. Pieces of motion join with a small step, and small numbers tremble: both show
where somebody rests, and hardly where somebody moves. So each joint is averaged over more frames while it
rests.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.generation.poses import NUMBERS

Array = NDArray[Any]

MOVING, RESTING = 1.0, 2.1  # frames: deviations of Gaussians
TOKENS_RESTING = 3.0  # of joints that rest, where motion is made of tokens
SLOW, FAST = 0.015, 0.04  # standardised, a frame: how fast a joint's numbers change that rests, that moves


def make_gaussian(deviation: float) -> Array:
    """Return the weights of a Gaussian over frames, an odd count, sum 1. deviation: frames; 0 gives one."""
    reach = int(np.ceil(3 * deviation)) if deviation > 0 else 0
    at = np.arange(-reach, reach + 1)
    out = np.exp(-0.5 * (at / max(deviation, 1e-9)) ** 2)
    return np.asarray(out / out.sum())


class Averaging:
    """moving, resting: frames, deviations of Gaussians over numbers of joints that move, and that rest; the
    same for both where `resting` is None. reach: frames beside each that it takes.
    """

    def __init__(self, moving: float = MOVING, resting: float | None = RESTING) -> None:
        self._moving = make_gaussian(moving).astype(np.float32)
        self._resting = None if resting is None else make_gaussian(resting).astype(np.float32)
        self.reach = len(self._moving) // 2
        if self._resting is not None:
            self.reach = max(self.reach, len(self._resting) // 2 + 1)  # and one, to see how fast it is

    def of(self, poses: Array) -> Array:
        """Return poses `[n, X]` of `[n + 2 reach, X]`, standardised."""
        count = max(0, len(poses) - 2 * self.reach)
        moving = _mean(poses, self._moving, self.reach, count)
        if self._resting is None or not count:
            return moving
        around = _mean(poses, self._resting, self.reach - 1, count + 2)
        steps = np.abs(around[2:] - around[:-2]).reshape(count, -1, NUMBERS)
        fast = steps.sum(-1) / (2 * NUMBERS)
        rests = np.repeat(np.clip((FAST - fast) / (FAST - SLOW), 0, 1), NUMBERS, 1)
        return np.asarray(moving + rests * (around[1:-1] - moving), poses.dtype)

    def whole(self, poses: Array) -> Array:
        """Return poses `[T, X]` averaged; the ends repeat."""
        return self.of(np.pad(poses, ((self.reach, self.reach), (0, 0)), "edge"))


def _mean(poses: Array, weights: Array, first: int, count: int) -> Array:
    """Return the weighted mean about `count` frames from number `first` on."""
    out = np.zeros((count, poses.shape[1]), poses.dtype)
    first -= len(weights) // 2
    for n, weight in enumerate(weights):
        out += weight * poses[first + n : first + n + count]
    return out
