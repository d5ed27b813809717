"""Thirty-two bits from texts: FNV-1a over their UTF-8 bytes, and MurmurHash3's finaliser. Each engine has its
own of these few lines, since languages differ in their integers.
"""

from __future__ import annotations

from array import array
from functools import lru_cache
from typing import TypeAlias

import numpy as np

Bits: TypeAlias = int  # 32 of them, without a sign

_MASK = 0xFFFFFFFF
OFFSET, PRIME = 0x811C9DC5, 0x01000193  # FNV-1a's, 32 bits
MIX = (0x85EBCA6B, 0xC2B2AE35)  # MurmurHash3's finaliser
_MIX_1, _MIX_2 = MIX
OFTEN = 32  # times from which on a word pays for what is remembered of it, 40 us and 1 kB
MOST = 1024  # words of which something is remembered
COUNTED = 4096  # words whose times are counted


def mix(value: Bits) -> Bits:
    """Scramble 32 bits: two rounds of shift-xor and odd multiplication."""
    value &= _MASK
    value = ((value ^ (value >> 16)) * _MIX_1) & _MASK
    value = ((value ^ (value >> 13)) * _MIX_2) & _MASK
    return value ^ (value >> 16)


def absorb(value: Bits, word: str) -> Bits:
    """Take a word and the zero byte that closes it into a hash."""
    # Only the last byte of a hash meets a word's bytes; what is above it is multiplied, whatever they are.
    known = _known.get(word)
    if known is not None:
        return (value * known[256] + known[value & 255]) & _MASK
    return _absorbed(value, word)


_known: dict[str, array[int]] = {}  # of a word what it adds to a hash of each last byte, then the factor
_times: dict[str, int] = {}


def _absorbed(value: Bits, word: str) -> Bits:
    """Take a word in byte by byte; remember of it what comes often."""
    times = _times.get(word, 0)
    if times < OFTEN:
        if len(_times) >= COUNTED:
            _times.clear()
        _times[word] = times + 1
    elif len(_known) < MOST:
        _known[word] = _remembered(word)
    for byte in word.encode():
        value = ((value ^ byte) * PRIME) & _MASK
    return (value * PRIME) & _MASK


def _remembered(word: str) -> array[int]:
    last = np.arange(256, dtype=np.uint64)
    value, factor = last, 1
    for byte in (*word.encode(), 0):
        value = (value ^ np.uint64(byte)) * np.uint64(PRIME) & np.uint64(_MASK)
        factor = factor * PRIME & _MASK
    added = value - last * np.uint64(factor) & np.uint64(_MASK)
    return array("I", [*added.tolist(), factor])


def begun(seed: Bits) -> Bits:
    """Return the hash before any word: the seed, mixed, xored into FNV's offset basis."""
    return _seeded(seed)


@lru_cache(maxsize=64)
def _seeded(seed: Bits) -> Bits:
    return (OFFSET ^ mix(seed)) & _MASK
