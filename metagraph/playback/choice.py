"""Keyed randomness: every draw is a hash of (seed, key, purpose), in 32-bit integers that any language can
mix alike.

Nothing is remembered between draws, so changing one request leaves the draws of all others as they were.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

_MASK = 0xFFFFFFFF
OFFSET, PRIME = 0x811C9DC5, 0x01000193  # FNV-1a's, 32 bits
MIX = (0x85EBCA6B, 0xC2B2AE35)  # MurmurHash3's finaliser


def mix(value: int) -> int:
    """Scramble 32 bits: two rounds of shift-xor and odd multiplication (MurmurHash3's finaliser)."""
    value &= _MASK
    value ^= value >> 16
    value = (value * MIX[0]) & _MASK
    value ^= value >> 13
    value = (value * MIX[1]) & _MASK
    return value ^ (value >> 16)


def _absorb(value: int, word: str) -> int:
    for byte in word.encode():
        value = ((value ^ byte) * PRIME) & _MASK
    return (value * PRIME) & _MASK  # the closing zero byte


def _begin(seed: int, words: tuple[str, ...]) -> int:
    value = (OFFSET ^ mix(seed)) & _MASK
    for word in words:
        value = _absorb(value, word)
    return value


def key32(seed: int, *words: str) -> int:
    """Return the 32-bit hash of a seed and words: FNV-1a over their UTF-8 bytes, each word closed by a zero
    byte, then mixed.

    The seed, mixed, is xored into FNV's offset basis.
    """
    return mix(_begin(seed, words))


def uniform(seed: int, *words: str) -> float:
    """Return a number in the open interval (0, 1)."""
    return (key32(seed, *words) + 0.5) / 4294967296.0


def pick(seed: int, key: str, purpose: str, weights: Mapping[str, float]) -> str:
    """Return one of the ids, id k with probability weight_k / sum.

    Each id runs its own race, the shortest of exponential times -log(u_k) / weight_k wins; so adding or
    removing one candidate changes the choice only where that candidate wins. Raises ValueError when no weight
    is positive.
    """
    best, shortest = "", math.inf
    begun = _begin(seed, (key, purpose))
    for ident, weight in weights.items():
        if weight > 0:
            time = -math.log((mix(_absorb(begun, ident)) + 0.5) / 4294967296.0) / weight
            if time < shortest or (time == shortest and ident < best):
                best, shortest = ident, time
    if not best:
        raise ValueError("nothing to choose from")
    return best
