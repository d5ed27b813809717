"""How loud a channel is (ITU-R BS.1770-4), so that every voice is heard at the same level."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

TARGET = -23.0  # LUFS
BLOCK, HOP = 0.4, 0.1  # seconds
ABSOLUTE, RELATIVE = -70.0, -10.0  # LUFS, and LU below the mean: what is softer does not count
LOUDEST = 60.0  # dB a channel is raised at most
_PIECE, _MARGIN = 30.0, 1.0  # seconds that are filtered at once, and what is thrown away on either side


def measure_integrated_loudness(samples: Array, rate: int) -> float:
    """Return the integrated loudness of one channel `[N]`, LUFS; -inf if nothing is louder than the gate.
    Shorter than a block, the whole is one.
    """
    samples = np.asarray(samples, np.float64)
    if not len(samples):
        return -np.inf
    hop, each = max(1, round(HOP * rate)), round(BLOCK / HOP)
    squares = _weighted(samples, rate) ** 2
    count = len(squares) // hop
    if count < each:
        power = np.array([squares.mean()])
    else:
        parts = squares[: count * hop].reshape(count, hop).mean(1)
        power = np.convolve(parts, np.ones(each) / each, "valid")
    power = power[_lufs(power) > ABSOLUTE]
    if not len(power):
        return -np.inf
    power = power[_lufs(power) > float(_lufs(power.mean())) + RELATIVE]
    return float(_lufs(power.mean()))


def compute_gain(samples: Array, rate: int) -> float:
    """Return the factor that brings a channel `[N]` to TARGET; 1 for silence."""
    level = measure_integrated_loudness(samples, rate)
    return 1.0 if not np.isfinite(level) else float(10 ** (min(TARGET - level, LOUDEST) / 20))


def _lufs(power: Any) -> Array:
    return np.asarray(-0.691 + 10 * np.log10(np.maximum(power, 1e-20)))


def _weighted(samples: Array, rate: int) -> Array:
    """Return samples through the K weighting: a shelf that raises what is high, and a high pass. The filters
    ring for much less than the margin, so pieces can go through the frequency domain.
    """
    size, margin = round(_PIECE * rate), round(_MARGIN * rate)
    out = np.empty_like(samples)
    for start in range(0, len(samples), size):
        first = max(0, start - margin)
        piece = samples[first : start + size]
        length = 1 << int(np.ceil(np.log2(len(piece) + margin)))
        heard = np.fft.irfft(np.fft.rfft(piece, length) * _response(length, rate), length)
        out[start : start + size] = heard[start - first : len(piece)]
    return out


@lru_cache(maxsize=8)
def _response(length: int, rate: int) -> Array:
    """Return the weighting at each frequency of a transform, complex: that of the standard's filters, which
    are given for 48 kHz.
    """
    hertz = np.minimum(np.arange(length // 2 + 1) * (rate / length), 24000.0)
    z = np.exp(-2j * np.pi * hertz / 48000)
    shelf = (1.53512485958697 - 2.69169618940638 * z + 1.19839281085285 * z * z) / (
        1 - 1.69065929318241 * z + 0.73248077421585 * z * z
    )
    high_pass = (1 - 2 * z + z * z) / (1 - 1.99004745483398 * z + 0.99007225036621 * z * z)
    response = np.asarray(shelf * high_pass)
    response.setflags(write=False)
    return response
