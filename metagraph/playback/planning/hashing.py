"""Thirty-two bits from texts: FNV-1a over their UTF-8 bytes, and MurmurHash3's finaliser. Each engine has its
own of these few lines, since languages differ in their integers.
"""

from __future__ import annotations

from typing import TypeAlias

Bits: TypeAlias = int  # 32 of them, without a sign

_MASK = 0xFFFFFFFF
OFFSET, PRIME = 0x811C9DC5, 0x01000193  # FNV-1a's, 32 bits
MIX = (0x85EBCA6B, 0xC2B2AE35)  # MurmurHash3's finaliser
_MIX_1, _MIX_2 = MIX


def mix(value: Bits) -> Bits:
    """Scramble 32 bits: two rounds of shift-xor and odd multiplication."""
    value &= _MASK
    value = ((value ^ (value >> 16)) * _MIX_1) & _MASK
    value = ((value ^ (value >> 13)) * _MIX_2) & _MASK
    return value ^ (value >> 16)


def absorb(value: Bits, word: str) -> Bits:
    """Take a word and the zero byte that closes it into a hash."""
    for byte in word.encode():
        value = ((value ^ byte) * PRIME) & _MASK
    return (value * PRIME) & _MASK


def begun(seed: Bits) -> Bits:
    """Return the hash before any word: the seed, mixed, xored into FNV's offset basis."""
    return (OFFSET ^ mix(seed)) & _MASK
