"""Noise that is a function of seed, take and frame: a seek, or a second run, finds the same numbers."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]


def noise(seed: int, take: int, frame: int, count: int) -> Array:
    """Return standard normal numbers `[count]` float32. seed, take, frame: 0..2^64 - 1.

    Philox (4x64, 10 rounds) with key (seed, take) from counter (0, frame, 0, 0) on; pairs of its 64 bits,
    the top 53 of each as a number in 0..1, by Box and Muller: NumPy's own normal numbers may change between
    versions.
    """
    pairs = (count + 1) // 2
    source = np.random.Philox(
        key=np.array([seed, take], np.uint64), counter=np.array([0, frame, 0, 0], np.uint64)
    )
    raw = np.asarray(source.random_raw(2 * pairs), np.uint64) >> np.uint64(11)
    uniform = (raw.astype(np.float64) + 0.5) * 2.0**-53
    radius = np.sqrt(-2 * np.log(uniform[:pairs]))
    angle = 2 * np.pi * uniform[pairs:]
    out = np.concatenate([radius * np.cos(angle), radius * np.sin(angle)])[:count]
    return out.astype(np.float32)
