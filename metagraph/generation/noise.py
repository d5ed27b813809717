"""Noise that is a function of seed, take and frame: a seek, or a second run, finds the same numbers."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

BLOCK = 16  # frames whose noise is made at once, from multiples of it on


def draw_noise(seed: int, take: int, frame: int, count: int) -> Array:
    """Return standard normal numbers `[count]` float32. seed, take, frame: 0..2^64 - 1."""
    return np.asarray(draw_noise_rows(seed, take, frame, 1, count)[0])


def draw_noise_rows(seed: int, take: int, frame: int, frames: int, count: int) -> Array:
    """Return standard normal numbers `[frames, count]` float32, those of `frame` first.

    Philox (4x64, 10 rounds) with key (seed, take) from counter (0, frame, 0, 0) on; pairs of its 64 bits,
    the top 53 of each as a number in 0..1, by Box and Muller: NumPy's own normal numbers may change between
    versions.
    """
    pairs = (count + 1) // 2
    source = np.random.Philox(
        key=np.array([seed, take], np.uint64), counter=np.array([0, frame, 0, 0], np.uint64)
    )
    raw = np.empty((frames, 2 * pairs), np.uint64)
    for row in raw:
        row[:] = source.random_raw(2 * pairs)
        source.advance(2**64 - -(-2 * pairs // 4))  # four numbers a count, then to the next frame's
    uniform = ((raw >> np.uint64(11)).astype(np.float64) + 0.5) * 2.0**-53
    radius = np.sqrt(-2 * np.log(uniform[:, :pairs]))
    angle = 2 * np.pi * uniform[:, pairs:]
    out = np.concatenate([radius * np.cos(angle), radius * np.sin(angle)], 1)[:, :count]
    return out.astype(np.float32)


class Noise:
    """The noise of frame after frame. count: numbers a frame."""

    def __init__(self, count: int) -> None:
        self.count = count
        self._have: tuple[int, int, int] | None = None
        self._rows = np.zeros((0, count), np.float32)

    def of(self, seed: int, take: int, frame: int) -> Array:
        """Return standard normal numbers `[count]` float32: to a bit those of any other way to this frame."""
        block = (seed, take, frame - frame % BLOCK)
        if block != self._have:
            self._have, self._rows = block, draw_noise_rows(*block, BLOCK, self.count)
        return np.asarray(self._rows[frame % BLOCK])
