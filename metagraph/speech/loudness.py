"""How loud a sound is, as people hear it: ITU-R BS.1770-4, one channel, and sounds made as loud as each
other.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import log10, pi, tan
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]
BLOCK, STEP = 0.4, 0.1  # seconds
SILENT = -70.0  # LUFS, below which a block is not heard
BELOW = 10.0  # LU under the loudest parts' mean, below which a block does not count
OFFSET = -0.691  # of the standard


def measure_loudness(samples: Array, rate: int) -> float | None:
    """Return the integrated loudness of samples `[N]`, -1..1, in LUFS; None for silence, and for sounds
    shorter than a block.
    """
    size, hop = round(BLOCK * rate), round(STEP * rate)
    if len(samples) < size:
        return None
    power = np.concatenate([[0.0], np.cumsum(_weighted(samples, rate) ** 2)])
    starts = np.arange(0, len(samples) - size + 1, hop)
    blocks = np.maximum((power[starts + size] - power[starts]) / size, 1e-30)
    heard = blocks[OFFSET + 10 * np.log10(blocks) > SILENT]
    if not len(heard):
        return None
    gate = OFFSET + 10 * log10(float(heard.mean())) - BELOW
    loud = heard[OFFSET + 10 * np.log10(heard) > gate]
    return OFFSET + 10 * log10(float(loud.mean()))


def measure_loudness_within(samples: Array, rate: int, spans: Sequence[tuple[float, float]]) -> Array:
    """Return how loud each span of seconds is, `[n]` LUFS: the mean of all of it, without gates; NaN where it
    is silent, or beyond the samples `[N]`.
    """
    power = np.concatenate([[0.0], np.cumsum(_weighted(samples, rate) ** 2)])
    edges = np.clip(np.round(np.reshape(np.asarray(spans, float), (-1, 2)) * rate), 0, len(samples)).astype(
        int
    )
    count = edges[:, 1] - edges[:, 0]
    mean = np.maximum(power[edges[:, 1]] - power[edges[:, 0]], 0.0) / np.maximum(count, 1)
    out = OFFSET + 10 * np.log10(np.maximum(mean, 1e-30))
    return np.where((count > 0) & (out > SILENT), out, np.nan)


def _weighted(samples: Array, rate: int) -> Array:
    """Return samples through the standard's two filters: the head's shelf, then what cuts low tones."""
    count = 1 << (len(samples) + rate // 4).bit_length()  # what rings on must not come round to the beginning
    z = np.exp(-2j * pi * np.arange(count // 2 + 1) / count)
    spectrum = np.fft.rfft(np.asarray(samples, np.float64), count)
    for b, a in (_shelf(rate), _high_pass(rate)):
        spectrum *= (b[0] + b[1] * z + b[2] * z * z) / (a[0] + a[1] * z + a[2] * z * z)
    return np.asarray(np.fft.irfft(spectrum, count)[: len(samples)])


Filter = tuple[tuple[float, float, float], tuple[float, float, float]]


def _shelf(rate: int) -> Filter:
    """Return the shelf for any rate; at 48 kHz it has the standard's coefficients."""
    k, q, high = tan(pi * 1681.974450955533 / rate), 0.7071752369554196, 10 ** (3.999843853973347 / 20)
    middle = high**0.4996667741545416
    a0 = 1 + k / q + k * k
    b = (high + middle * k / q + k * k, 2 * (k * k - high), high - middle * k / q + k * k)
    return (b[0] / a0, b[1] / a0, b[2] / a0), (1.0, 2 * (k * k - 1) / a0, (1 - k / q + k * k) / a0)


def _high_pass(rate: int) -> Filter:
    k, q = tan(pi * 38.13547087602444 / rate), 0.5003270373238773
    a0 = 1 + k / q + k * k
    return (1.0, -2.0, 1.0), (1.0, 2 * (k * k - 1) / a0, (1 - k / q + k * k) / a0)


def level_sounds(sounds: dict[str, Array], rate: int, wanted: float, peak: float = 0.95) -> dict[str, Array]:
    """Return sounds as loud as each other: `wanted` LUFS, or as much less as keeps all within `peak`. Silence
    stays silent.
    """
    out: dict[str, Array] = {}
    for name, samples in sounds.items():
        found = measure_loudness(samples, rate)
        out[name] = samples if found is None else samples * np.float32(10 ** ((wanted - found) / 20))
    most = max((float(np.abs(s).max(initial=0)) for s in out.values()), default=0.0)
    return out if most <= peak else {n: s * np.float32(peak / most) for n, s in out.items()}
