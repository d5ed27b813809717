"""Choose which frames of a motion to keep as keys, so that everything between them is within a tolerance."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.motion import rotation

Array = NDArray[Any]

WORTH = 0.66  # of all frames: with more keys, a track keeps all frames and needs no times of its own
AT_ONCE = 1 << 18  # numbers processed together: alone, short clips mostly cost calls of NumPy

# Choosing frames takes most of the time of an export, and gives the same result the next time, or for another
# engine.
_KNOWN: dict[tuple[bytes, tuple[int, ...], float, bool], list[Array]] = {}
MOST = 1000  # tracks of clips that are kept, about 10 kB each


def find_kept_frames(many: Sequence[Array], tolerance: float, turning: bool) -> list[list[Array]]:
    """Return for each of `many`, values of tracks `[F, C, n]`, the frames to keep of each track, ascending.
    Everything between them on a straight line is within the tolerance, computed in 64 bits; if nothing moves,
    only the first frame is kept. With `turning`, values are quaternions, and the line is `rotation.slerp`'s.
    Results are remembered.
    """
    keys = [
        (hashlib.blake2b(np.ascontiguousarray(v).data, digest_size=16).digest(), v.shape, tolerance, turning)
        for v in many
    ]
    found = {key: _KNOWN.pop(key) for key in dict.fromkeys(keys) if key in _KNOWN}
    missing = {key: values for key, values in zip(keys, many, strict=True) if key not in found}
    for some in _batches(list(missing), missing):
        made = _thinned([missing[key] for key in some], tolerance, turning)
        found.update(zip(some, made, strict=True))
    _KNOWN.update(found)  # the last used ones come last
    while len(_KNOWN) > MOST:
        _KNOWN.pop(next(iter(_KNOWN)), None)
    return [found[key] for key in keys]


def _batches(keys: Sequence[Any], sized: Any) -> Iterator[list[Any]]:
    """Yield keys of values that are processed together."""
    some: list[Any] = []
    size = 0
    for key in keys:
        size += sized[key].size
        if some and size > AT_ONCE:
            yield some
            some, size = [], sized[key].size
        some.append(key)
    if some:
        yield some


def _thinned(many: Sequence[Array], tolerance: float, turning: bool) -> list[list[Array]]:
    """Return what `find_kept_frames` does.

    Every track starts with its ends and is split at its worst frame until none is too far off, all tracks at
    once. A stretch that is near enough is not checked again.
    """
    many = [v.astype(np.float64) for v in many]
    still = [np.abs(v - v[:1]).max((0, 2)) <= tolerance for v in many]
    begins = np.cumsum([0, *(v.shape[0] * v.shape[1] for v in many)])
    data = np.concatenate([v.transpose(1, 0, 2).reshape(-1, v.shape[2]) for v in many])
    kept = np.zeros(len(data), bool)
    # Stretches between kept frames, one track after another.
    thin = [len(v) > 2 and tolerance > 0 for v in many]
    firsts = [
        begin + np.flatnonzero(~s) * len(v) if t else np.zeros(0, int)
        for v, begin, s, t in zip(many, begins, still, thin, strict=False)
    ]
    low = np.concatenate(firsts)
    high = low + np.repeat([len(v) - 1 for v in many], [*map(len, firsts)])
    kept[low] = kept[high] = True
    while len(low):
        inner = high - low - 1
        starts = np.cumsum(inner) - inner
        of = np.repeat(np.arange(len(low)), inner)
        at = np.arange(len(of)) - starts[of] + low[of] + 1
        begin, end, own = data[low], data[high], data[at]
        part = ((at - low[of]) / (high - low)[of])[:, None]
        if turning:  # as `rotation.slerp` does
            way = rotation.log(rotation.multiply(rotation.conjugate(begin), end))
            guess = rotation.multiply(begin[of], rotation.exp(way[of] * part))
            guess = guess * np.sign(np.einsum("ni,ni->n", guess, own))[:, None]
        else:
            guess = begin[of] + (end - begin)[of] * part
        error = np.abs(guess - own).max(-1)
        worst = np.maximum.reduceat(error, starts)
        hits = at[(error > tolerance) & (error >= worst[of])]
        kept[hits] = True
        split = worst > tolerance
        low, high = (np.sort(np.concatenate([ends[split], hits])) for ends in (low, high))
        some = high - low > 1
        low, high = low[some], high[some]
    out = []
    for v, begin, s, t in zip(many, begins, still, thin, strict=False):
        frames, tracks = v.shape[:2]
        keep = kept[begin : begin + frames * tracks].reshape(tracks, frames)
        if not t:
            keep[:] = True
        keep[keep.sum(1) > WORTH * frames] = True
        out.append([np.array([0]) if alone else np.flatnonzero(k) for alone, k in zip(s, keep, strict=True)])
    return out
