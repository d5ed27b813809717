"""Put keys between a clip's own, on cubic curves through them, so that motion is smooth where keys are joined
by straight lines.

At 60 pictures a second, straight lines between 30 keys a second change a hand's acceleration four times as
fast as the motion itself does. What is played and exported therefore has at least `RATE` keys a second.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

RATE = 60.0  # keys a second
STEEPEST = (
    3.0  # a slope, as a multiple of the lines on its flatter side: Fritsch and Carlson (1980), section 3
)
CLOSED = 1e-3  # of a quaternion's component, or metres, between the first and the last key of a loop


def count_steps(fps: float) -> int:
    """Return the number of steps into which dense keys cut each step between keys; 1 for RATE and above."""
    return max(1, int(np.ceil(RATE / fps - 1e-6)))


def fill_between_keys(values: Array, steps: int, loop: bool) -> Array:
    """Return values `[(F - 1) * steps + 1, ..., n]` on cubic curves through the keys `values [F, ..., n]`.

    The slopes are those of Catmull and Rom (1974), at most STEEPEST times as long as the longer of the two
    lines on the flatter side of the key. So a pose that is held stays still, and a jump from one key to the
    next does not swing before or after. In a `loop` the first key follows the last but one.
    """
    if steps == 1:
        return values
    lines = np.diff(values, axis=0)
    slopes = _slopes(lines, loop)
    out = np.empty(((len(values) - 1) * steps + 1, *values.shape[1:]), values.dtype)
    out[::steps] = values
    for step in range(1, steps):
        x = values.dtype.type(step / steps)
        between = values[:-1] + lines * (x * x * (3 - 2 * x))  # Hermite's polynomials
        between += slopes[:-1] * (x * (1 - x) * (1 - x))
        between -= slopes[1:] * (x * x * (1 - x))
        out[step::steps] = between
    return out


def _slopes(lines: Array, loop: bool) -> Array:
    """Return the slope at each key, `[F, ..., n]` per key. lines `[F - 1, ..., n]`: from key to key."""
    ends = (lines[-1:], lines[:1]) if loop else (lines[:1], lines[-1:])
    slopes = (np.concatenate([ends[0], lines]) + np.concatenate([lines, ends[1]])) / 2
    length = np.sqrt(np.einsum("...i,...i->...", slopes, slopes))
    size = np.sqrt(np.einsum("...i,...i->...", lines, lines))
    size = np.pad(size, ((2, 2), *[(0, 0)] * (size.ndim - 1)), mode="wrap" if loop else "edge")
    size = np.maximum(size[:-1], size[1:])  # a single flat line may be the top of a wave
    slopes *= np.minimum(1, STEEPEST * np.minimum(size[:-2], size[2:]) / np.maximum(length, 1e-12))[..., None]
    return np.asarray(slopes)
