"""YIN: the fundamental frequency of short frames of sound (de Cheveigné and Kawahara 2002), in NumPy.

A frame is compared with itself shifted by every period in question, by FFT. What lies behind a frame's end
counts as silence, so that longer periods need to repeat a little better. Values are those of `librosa.yin` to
rounding; tests hold this.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

THRESHOLD = 0.1  # of the mean difference: the shortest period that differs less is taken


def measure_f0_by_yin(frames: Array, rate: float, lowest: float, highest: float) -> Array:
    """Return the F0 `[K]`, Hz, of frames `[K, N]`, each on its own: of one without any period, that of the
    period after which it differs least, and of silence about `highest`.

    rate: samples a second. lowest, highest: Hz; periods of whole samples that hold them are tried, and the
    best is refined between samples. Raises ValueError unless 2 <= shortest period < longest period - 1 < N -
    1.
    """
    shortest, longest = int(rate / highest), min(int(np.ceil(rate / lowest)), frames.shape[1] - 1)
    if not 2 <= shortest < longest - 1:
        raise ValueError(
            f"frames of {frames.shape[1]} samples at {rate:g} Hz tell no pitch from {lowest:g} to "
            f"{highest:g} Hz"
        )
    apart = measure_yin_differences(np.asarray(frames, np.float64), longest)[:, shortest - 1 :]
    trough = apart < THRESHOLD
    trough[:, 1:] &= apart[:, 1:] < apart[:, :-1]
    trough[:, :-1] &= apart[:, :-1] <= apart[:, 1:]
    trough[:, 0] &= apart[:, 0] < apart[:, 1]
    rows = np.arange(len(apart))
    best = np.where(trough.any(1), trough.argmax(1), apart.argmin(1))
    # The lowest point of the parabola through the best and its neighbours, where there is one within a
    # sample.
    inner = np.clip(best, 1, apart.shape[1] - 2)
    left, middle, right = (apart[rows, inner + n] for n in (-1, 0, 1))
    curve, slope = left + right - 2 * middle, (right - left) / 2
    fits = (np.abs(slope) < np.abs(curve)) & (inner == best)
    return np.asarray(rate / (shortest + best - np.divide(slope, curve, out=np.zeros(len(best)), where=fits)))


def measure_yin_differences(frames: Array, longest: int) -> Array:
    """Return the cumulative mean normalised difference `[K, longest]` (the paper's equation 8) of frames `[K,
    N]` float64 to themselves 1 to `longest` samples later: 0 where all repeats, about 1 if nothing does.
    """
    size = _fast(frames.shape[1] + longest)
    spectrum = np.fft.rfft(frames, size)
    alike = np.fft.irfft(spectrum.real**2 + spectrum.imag**2, size)[:, : longest + 1]
    gone = np.cumsum(frames[:, :longest] ** 2, axis=1)
    apart = 2 * (alike[:, :1] - alike[:, 1:]) - gone
    mean = np.cumsum(apart, axis=1) / np.arange(1, longest + 1)
    return np.asarray(np.divide(apart, mean, out=np.ones_like(apart), where=mean > 0))


def _fast(least: int) -> int:
    """Return the least length from `least` on without prime factors above 5, which is transformed quickly."""
    size = least
    while True:
        rest = size
        for factor in (2, 3, 5):
            while rest % factor == 0:
                rest //= factor
        if rest == 1:
            return size
        size += 1
