"""Mouth shapes from letters, of any alphabet."""

from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.graph.face.names import VISEMES
from metagraph.playback.life.alphabet import ALPHABET
from metagraph.playback.life.graphemes import PACE, SHORTEST, read_aloud, shapes, spelled


@pytest.mark.parametrize(
    ("word", "want"),
    [
        ("", []),
        ("map", ["PP", "aa", "PP"]),
        ("five", ["FF", "I", "FF"]),
        ("the", ["TH", "E"]),
        ("shoot", ["CH", "U", "DD"]),
        ("hello", ["kk", "E", "nn", "O"]),
        ("Größe", ["kk", "RR", "O", "SS"]),
        ("привет", ["PP", "RR", "I", "FF", "E", "DD"]),
        ("...", []),
    ],
)
def test_words_are_read_by_their_letters(word: str, want: list[str]) -> None:
    assert shapes(ALPHABET, word) == want


def test_writing_without_letters_gives_a_syllable_a_sign() -> None:
    assert len(shapes(ALPHABET, "日本語")) == 6 and len(shapes(ALPHABET, "2024")) == 8


@pytest.mark.parametrize(
    ("text", "least", "most"),
    [
        ("今天下雨我们在家里看书", 2.0, 3.0),
        ("きょうはあめがふります", 1.3, 2.2),
        ("오늘은 비가 와요", 1.2, 2.0),
    ],
)
def test_each_sign_that_is_a_syllable_takes_a_syllables_time(text: str, least: float, most: float) -> None:
    assert least < read_aloud(ALPHABET, text) < most


@pytest.mark.parametrize("text", ["", "   ", "?!", "…"])
def test_nothing_to_say_has_no_shapes_but_a_length(text: str) -> None:
    said = spelled(ALPHABET, text, 1.0)
    assert said.pieces == [] and said.peaks == [] and said.strengths == []
    assert read_aloud(ALPHABET, text) == SHORTEST


def test_text_takes_its_time_and_what_time_it_is_given() -> None:
    text = "It takes about as long as it takes to read."
    assert read_aloud(ALPHABET, text) == pytest.approx(len(text) / PACE)
    assert spelled(ALPHABET, text, 9.0).pieces[-1].end == pytest.approx(9.0 - 0.06 - 3.0 / 44 * 9.0, abs=0.3)
    assert spelled(ALPHABET, text, 0.0).pieces == []


def test_a_full_stop_is_a_pause() -> None:
    one, two = spelled(ALPHABET, "one two", 2.0).pieces, spelled(ALPHABET, "one. two", 2.0).pieces

    def widest(pieces: list[object]) -> float:
        return max(b.start - a.end for a, b in pairwise(pieces))  # type: ignore[attr-defined]

    assert widest(two) > 2 * widest(one)


@given(st.text(max_size=200), st.floats(0, 60))
def test_any_text_is_survived(text: str, length: float) -> None:
    said = spelled(ALPHABET, text, length)
    pieces, peaks, strengths = said.pieces, said.peaks, said.strengths
    assert len(peaks) == len(strengths) and all(0 < s <= 1 for s in strengths)
    assert peaks == sorted(peaks) and all(0 <= p <= length + 1e-6 for p in peaks)
    for a, b in pairwise(pieces):
        assert a.start < a.end <= b.start + 1e-9
    assert all(p.viseme in VISEMES and p.viseme != "sil" and 0 < p.strength <= 1 for p in pieces)
    assert not pieces or (pieces[0].start >= 0 and pieces[-1].end <= length + 1e-6)
