"""Words that come often are taken into a hash at once, to the same bits."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.playback.planning import hashing
from metagraph.playback.planning.hashing import absorb


def byte_by_byte(value: int, word: str) -> int:
    for byte in (*word.encode(), 0):
        value = ((value ^ byte) * hashing.PRIME) % 2**32
    return value


@given(st.lists(st.tuples(st.integers(0, 2**32 - 1), st.text(max_size=12)), max_size=20), st.integers(1, 3))
def test_a_word_gives_the_same_however_often_it_comes(
    drawn: list[tuple[int, str]], times_of_often: int
) -> None:
    for _ in range(times_of_often * hashing.OFTEN):
        for value, word in drawn:
            assert absorb(value, word) == byte_by_byte(value, word)


def test_every_last_byte_of_a_word_that_comes_often_is_right() -> None:
    for _ in range(hashing.OFTEN + 1):
        absorb(7, "gap")
    for value in (*range(256), 0x12345600, 0xFFFFFFFF, 2**32 - 256):
        assert absorb(value, "gap") == byte_by_byte(value, "gap")


def test_no_more_is_remembered_than_it_says(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(hashing, "_known", {})
    monkeypatch.setattr(hashing, "_times", {})
    monkeypatch.setattr(hashing, "MOST", 3)
    monkeypatch.setattr(hashing, "COUNTED", 8)
    for n in range(100):
        for _ in range(hashing.OFTEN + 1):
            assert absorb(n, str(n)) == byte_by_byte(n, str(n))
        assert len(hashing._times) <= 8
    assert list(hashing._known) == ["0", "1", "2"]
