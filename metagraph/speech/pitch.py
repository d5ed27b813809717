"""How high a voice is, moment by moment: its fundamental frequency, F0, by YIN (de Cheveigné and Kawahara
2002).

YIN finds a period in anything. A moment counts as voiced where it is audible, where the sound does repeat
after that period, where its pitch lies in this voice's own range (two-pass quantiles, De Looze and Hirst
2008) and near its neighbours', not an octave off.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.speech.sound import HOP
from metagraph.speech.yin import measure_f0_by_yin

Array = NDArray[Any]

LOWEST, HIGHEST = 60.0, 600.0  # Hz
RATE = 8000  # samples a second at least; periods are found between samples
REPEATS = 0.55  # how well a period correlates with the next, 0..1, in a voiced moment
FLOOR = 34.0  # dB below the loudest moments that still counts as voice
JUMP = 6.0  # semitones away from the neighbours' median that a moment may be
NEAR = 9  # moments either side that count as neighbours
_SHORTEST = 3  # moments a voiced stretch has at least
_BLOCK = 1000  # moments at a time
_MARGIN = 128  # samples at the lower rate that resampling looks ahead and back
_PIECE, _TRIED = 500, 12000  # moments in a piece; and in all those that tell a voice's range
PROMINENT = 0.25  # semitones a peak stands out by at least


@dataclass(frozen=True, eq=False)
class Pitch:
    """times `[K]`: seconds, every 10 ms. hertz `[K]`: F0, nan where the voice is silent or voiceless."""

    times: Array
    hertz: Array


def measure_pitch(samples: Array, rate: int) -> Pitch:
    """Return the pitch of a voice. samples: `[N]`, about -1..1; rate: samples a second. Hours take memory for
    the samples alone.
    """
    count = int(len(samples) / rate / HOP) + 1
    times = np.arange(count) * HOP
    unvoiced = Pitch(times, np.full(count, np.nan))
    some = max(1, -(-count // _TRIED))  # of pieces of `_PIECE` moments, every so many tell this voice's range
    parts = [slice(n, min(n + _PIECE, count)) for n in range(0, count, _PIECE * some)]
    hertz, repeats, level = _blocks(samples, rate, [times[p] for p in parts], (LOWEST, HIGHEST))
    voiced = _voiced(repeats, level)
    if voiced.sum() < _SHORTEST:
        if some == 1:
            return unvoiced
        low, high = LOWEST, HIGHEST
    else:
        low, high = np.percentile(hertz[voiced], (15, 65)) * (0.83, 1.92)
        low, high = float(np.clip(low, LOWEST, HIGHEST / 3)), float(np.clip(high, 2.5 * LOWEST, HIGHEST))
        low = min(low, high / 2.5)
    parts = [slice(n, min(n + _BLOCK, count)) for n in range(0, count, _BLOCK)]
    audible = float(np.percentile(level, 98)) - FLOOR - 6.0
    hertz, repeats, level = _blocks(samples, rate, [times[p] for p in parts], (low, high), audible)
    voiced = _voiced(repeats, level)
    voiced &= _near(hertz, voiced)
    for start, end in list_runs(voiced):
        if end - start < _SHORTEST:
            voiced[start:end] = False
    return Pitch(times, np.where(voiced, hertz, np.nan))


def _voiced(repeats: Array, level: Array) -> Array:
    return np.asarray((repeats > REPEATS) & (level > max(float(np.percentile(level, 98)) - FLOOR, -80.0)))


def _blocks(
    samples: Array, rate: int, times: list[Array], bounds: tuple[float, float], audible: float = -120.0
) -> tuple[Array, Array, Array]:
    found = [_block(samples, rate, t, bounds, audible) for t in times]
    hertz, repeats, level = (np.concatenate([f[n] for f in found]) for n in range(3))
    return hertz, repeats, level


def _block(
    samples: Array, rate: int, times: Array, bounds: tuple[float, float], audible: float
) -> tuple[Array, Array, Array]:
    """Return F0 within bounds (Hz), how well the sound repeats after its period (0..1) and its level (dB) at
    times `HOP` apart. Moments softer than `audible` dB are passed over: nan, 0.
    """
    every = max(1, rate // RATE)
    own = rate / every
    size = int(
        2 ** np.ceil(np.log2(2.5 * own / LOWEST))
    )  # of a frame, samples: two of the longest periods, and some
    starts = np.round(times * own).astype(int) - size // 2
    frames = np.lib.stride_tricks.sliding_window_view(
        _thinned(samples, every, int(starts[0]), int(starts[-1]) + size), size
    )
    frames = frames[starts - starts[0]]
    frames = frames - frames.mean(1, keepdims=True)
    level = 10 * np.log10((frames * frames).mean(1) + 1e-12)
    hertz, repeats = np.full(len(times), np.nan), np.zeros(len(times))
    some = level > audible
    if not some.any():
        return hertz, repeats, level
    frames = frames[some]
    found = measure_f0_by_yin(frames, own, *bounds)
    period = np.clip(np.round(own / found).astype(int), 2, size // 2)
    one = frames[:, : size - size // 2]
    two = np.take_along_axis(frames, np.arange(size - size // 2)[None, :] + period[:, None], 1)
    power = np.einsum("nk,nk->n", one, one) * np.einsum("nk,nk->n", two, two)
    alike = np.einsum("nk,nk->n", one, two) / np.sqrt(np.maximum(power, 1e-20))
    alike[(found >= 0.98 * bounds[1]) | (found <= 1.005 * bounds[0])] = (
        0.0  # at the edge of what was tried: none was found
    )
    hertz[some], repeats[some] = found, alike
    return hertz, repeats, level


def _thinned(samples: Array, every: int, first: int, last: int) -> Array:
    """Return samples `first` to `last`, float64, of the sound `[N]` at an `every`th of its rate, silence
    before and after it: to 1e-6 the same in whichever pieces they are asked for.
    """
    margin = _MARGIN if every > 1 else 0
    start, end = (first - margin) * every, (last + margin) * every
    piece = np.asarray(samples[max(start, 0) : max(end, 0)], np.float64)
    piece = np.pad(piece, (max(-start, 0), max(0, end - start - len(piece) - max(-start, 0))))
    if every == 1:
        return piece
    import soxr

    return np.asarray(soxr.resample(piece, every, 1)[margin : margin + last - first])


def _near(hertz: Array, voiced: Array) -> Array:
    """Return which moments are about as high as the voiced ones around them."""
    tones = np.where(voiced, 12 * np.log2(np.maximum(hertz, 1.0)), np.nan)
    around = np.lib.stride_tricks.sliding_window_view(
        np.pad(tones, NEAR, constant_values=np.nan), 2 * NEAR + 1
    )
    with warnings.catch_warnings():  # of moments without any neighbour
        warnings.simplefilter("ignore", RuntimeWarning)
        return np.asarray(np.abs(tones - np.nanmedian(around, 1)) <= JUMP)


def list_runs(some: Array) -> list[tuple[int, int]]:
    """Return the runs of true moments in `[K]`, each from its first to behind its last."""
    edges = np.flatnonzero(
        np.diff(np.concatenate([[False], np.asarray(some, bool), [False]]).astype(np.int8))
    )
    return [(int(a), int(b)) for a, b in edges.reshape(-1, 2)]


def smooth(found: Pitch) -> Array:
    """Return the pitch in semitones over 1 Hz `[K]`, smoothed over 50 ms, short voiceless moments (up to 60
    ms) bridged; nan elsewhere.
    """
    tones = 12 * np.log2(found.hertz)
    known = ~np.isnan(tones)
    if not known.any():
        return np.asarray(tones)
    for start, end in list_runs(~known):
        if start > 0 and end < len(tones) and end - start <= 6:
            tones[start:end] = np.linspace(tones[start - 1], tones[end], end - start + 2)[1:-1]
    bell = np.exp(-0.5 * (np.arange(-5, 6) / 2.5) ** 2)
    weight = np.convolve(~np.isnan(tones), bell, "same")
    total = np.convolve(np.nan_to_num(tones), bell, "same")
    return np.where(np.isnan(tones), np.nan, total / np.maximum(weight, 1e-9))


def find_pitch_peaks(found: Pitch, start: float, end: float, tones: Array | None = None) -> tuple[float, ...]:
    """Return when F0 has its local maxima between two times, seconds, the most prominent first: those that
    are followed and preceded by the deepest falls, and, among equals, the highest. Where it only rises or
    falls, its highest moment. () if there is no voice. tones: `smooth(found)`, if that is at hand.
    """
    tones = smooth(found) if tones is None else tones
    first, last = int(np.searchsorted(found.times, start)), int(np.searchsorted(found.times, end, "right"))
    known = first + np.flatnonzero(~np.isnan(tones[first:last]))
    if not len(known):
        return ()
    high = tones[known]
    # Where it goes on falling from what is before, or rising to what comes after, is no peak.
    inner = np.nan_to_num(
        tones[[max(known[0] - 1, 0), *known, min(known[-1] + 1, len(tones) - 1)]], nan=-np.inf
    )
    tops = np.flatnonzero((high > inner[:-2]) & (high >= inner[2:]))
    if not len(tops):
        return (float(found.times[known[int(high.argmax())]]),)
    least = high.min()
    tall: list[tuple[float, float, float]] = []
    for top in tops.tolist():
        higher = np.flatnonzero(high > high[top])
        left, right = higher[higher < top], higher[higher > top]
        before = high[left[-1] : top].min() if len(left) else least
        after = high[top : right[0]].min() if len(right) else least
        stands = float(high[top] - max(before, after))
        tall.append((stands, float(high[top]), float(found.times[known[top]])))
    tall.sort(key=lambda x: (-x[0], -x[1], x[2]))
    kept = [x for x in tall if x[0] >= PROMINENT] or tall[:1]
    return tuple(t for _, _, t in kept)
