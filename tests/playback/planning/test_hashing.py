"""Hashes of words are those that FNV-1a and MurmurHash3 publish."""

from __future__ import annotations

import pytest

from metagraph.playback.planning.hashing import OFFSET, PRIME, absorb, begun, mix


@pytest.mark.parametrize(
    ("word", "published"), [("", 0x811C9DC5), ("a", 0xE40C292C), ("foobar", 0xBF9CF968)], ids=repr
)
def test_a_word_is_hashed_as_fnv_1a_does_and_closed_by_a_zero_byte(word: str, published: int) -> None:
    assert absorb(OFFSET, word) == published * PRIME % 2**32


def test_letters_of_any_writing_count_by_their_bytes() -> None:
    assert absorb(7, "ü") == absorb(7, b"\xc3\xbc".decode())
    assert absorb(7, "ü") != absorb(7, "u")


def test_bits_are_mixed_as_murmurhash3_ends() -> None:
    assert [mix(n) for n in (0, 1, 2**32 - 1)] == [0, 0x514E28B7, 0x81F16F39]
    assert begun(1) == OFFSET ^ 0x514E28B7
