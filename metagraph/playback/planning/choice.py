"""Keyed randomness: every draw is a hash of (seed, key, purpose), in 32-bit integers that any language mixes
in the same way.

Draws remember nothing, so a change of one request does not change the draws of the others.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

from metagraph.playback.planning.hashing import Bits, absorb, begun, mix

ALL = 4294967296.0  # numbers of 32 bits


def key32(seed: Bits, *words: str) -> Bits:
    """Return the 32-bit hash of a seed and words: FNV-1a over their UTF-8 bytes, each word closed by a zero
    byte, then mixed.

    The mixed seed is xored into FNV's offset basis.
    """
    return mix(keyed(seed, *words))


def keyed(seed: Bits, *words: str) -> Bits:
    """Return the hash of a seed and words before it is mixed, which all draws of one key share."""
    value = begun(seed)
    for word in words:
        value = absorb(value, word)
    return value


def uniform(seed: Bits, *words: str) -> float:
    """Return a number in the open interval (0, 1)."""
    return (mix(keyed(seed, *words)) + 0.5) / ALL


def chance_of(key: Bits, purpose: str) -> float:
    """Return the number that `uniform` returns for a key and one more word."""
    return (mix(absorb(key, purpose)) + 0.5) / ALL


def log_normal(mean: float, deviation: float, u: float, v: float) -> float:
    """Return a log-normal number from two uniform ones in (0, 1) by Box and Muller, in a way that any
    language can compute: `a = ln(1 + (s / m)^2)`, `z = sqrt(-2 ln u) cos(2 pi v)`, `m exp(sqrt(a) z - a /
    2)`.
    """
    share = deviation / mean
    spread = math.log1p(share * share)
    z = math.sqrt(-2.0 * math.log(u)) * math.cos(2.0 * math.pi * v)
    return mean * math.exp(math.sqrt(spread) * z - spread / 2.0)


def pick(seed: Bits, key: str, purpose: str, weights: Mapping[str, float]) -> str:
    """Return one of the ids, chosen as by `picked`."""
    return picked(keyed(seed, key), purpose, weights)


def picked(key: Bits, purpose: str, weights: Mapping[str, float]) -> str:
    """Return one of the ids, id k with probability weight_k / sum.

    Each id draws its own exponential time, -log(u_k) / weight_k, and the shortest wins. So adding or removing
    a candidate changes the choice only if that candidate wins. Raises ValueError when no weight is positive.
    """
    best, shortest = "", math.inf
    start = absorb(key, purpose)
    for ident, weight in weights.items():
        if weight > 0:
            time = -math.log((mix(absorb(start, ident)) + 0.5) / ALL) / weight
            if time < shortest or (time == shortest and ident < best):
                best, shortest = ident, time
    if best == "":
        raise ValueError("nothing to choose from")
    return best
