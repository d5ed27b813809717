"""Thirty-two bits from texts: FNV-1a over their UTF-8 bytes, and MurmurHash3's finaliser. Each engine has its
own of these few lines, since languages differ in their integers.
"""

from __future__ import annotations

from functools import lru_cache
from typing import TypeAlias

Bits: TypeAlias = int  # 32 of them, without a sign

_MASK = 0xFFFFFFFF
OFFSET, PRIME = 0x811C9DC5, 0x01000193  # FNV-1a's, 32 bits
LONG = 6  # characters of a word from which on remembering pays
MIX = (0x85EBCA6B, 0xC2B2AE35)  # MurmurHash3's finaliser


def mix(value: Bits) -> Bits:
    """Scramble 32 bits: two rounds of shift-xor and odd multiplication."""
    value &= _MASK
    value ^= value >> 16
    value = (value * MIX[0]) & _MASK
    value ^= value >> 13
    value = (value * MIX[1]) & _MASK
    return value ^ (value >> 16)


def absorb(value: Bits, word: str) -> Bits:
    """Take a word and the zero byte that closes it into a hash."""
    return _kept(value, word) if len(word) >= LONG else _absorbed(value, word)


def _absorbed(value: Bits, word: str) -> Bits:
    for byte in word.encode():
        value = ((value ^ byte) * PRIME) & _MASK
    return (value * PRIME) & _MASK


# A key is drawn from for several purposes, one after the other.
_kept = lru_cache(maxsize=512)(_absorbed)


def begun(seed: Bits) -> Bits:
    """Return the hash before any word: the seed, mixed, xored into FNV's offset basis."""
    return _seeded(seed)


@lru_cache(maxsize=64)
def _seeded(seed: Bits) -> Bits:
    return (OFFSET ^ mix(seed)) & _MASK
