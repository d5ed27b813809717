"""Phones of any alphabet become mouth shapes; words do by their letters."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.graph.face.names import VISEMES
from metagraph.speech.phones import find_visemes, is_arpabet, list_mouth_pieces
from metagraph.speech.textgrid import GridInterval, GridTier, TextGrid


def tier(name: str, *labels: str, points: bool = False) -> GridTier:
    return GridTier(
        name, tuple(GridInterval(0.1 * n, 0.1 * (n + 1), text) for n, text in enumerate(labels)), points
    )


def shapes(*tiers: GridTier) -> list[str]:
    return [p.viseme for p in list_mouth_pieces(TextGrid(0, 10, tiers))]


@pytest.mark.parametrize(
    ("labels", "known"),
    [
        (["AA1", "B", "IY0"], True), (["aa", "b", "sil"], True), (["B", "PT", "AA1", "R", "IH1"], True),
        (["p", "t", "s"], False),
        (["eI", "m", "@", "n"], False), (["ə", "r", "i"], False), ([], False), (["", "sil"], False),
    ],
)  # fmt: skip
def test_arpabet_is_told_from_the_others(labels: list[str], known: bool) -> None:
    assert is_arpabet(labels) is known


@pytest.mark.parametrize(
    ("label", "arpabet", "want"),
    [
        ("AA1", True, ["aa"]), ("ah0", True, ["aa"]), ("AY2", True, ["aa", "I"]),
        ("PT", True, ["PP", "DD"]), ("sil", True, []),
        ("D", True, ["DD"]), ("D", False, ["TH"]), ("S", False, ["CH"]), ("S", True, ["SS"]),
        ("tʃ", False, ["CH"]), ("dʒ", False, ["CH"]),
        ("aɪ", False, ["aa", "I"]), ("@", False, ["E"]), ("ŋ", False, ["kk"]), ("uː", False, ["U"]),
        ("ã", False, ["aa"]),
        ("", False, []), ("<p:>", False, []), ("?!", False, ["kk"]),
    ],
)  # fmt: skip
def test_phones_are_the_shapes_they_are_made_with(label: str, arpabet: bool, want: list[str]) -> None:
    assert find_visemes(label, arpabet)[0] == want


def test_a_vowel_without_stress_is_hardly_made() -> None:
    assert find_visemes("AH0", True)[1] < find_visemes("AH1", True)[1] == 1
    assert find_visemes("ə", False)[1] < find_visemes("e", False)[1] == 1


def test_a_diphthong_is_two_shapes_the_first_longer() -> None:
    first, second = list_mouth_pieces(TextGrid(0, 1, (GridTier("phones", (GridInterval(0.0, 0.2, "AY1"),)),)))
    assert (first.viseme, second.viseme) == ("aa", "I") and first.end == second.start == pytest.approx(0.12)


def test_phones_are_found_by_name_and_go_before_words() -> None:
    words, phones = tier("words", "map", "pam"), tier("MAU", "m", "a", "p", "", "p", "a", "m")
    assert shapes(words, phones) == ["PP", "aa", "PP", "PP", "aa", "PP"]
    assert shapes(tier("anything", "m", "a", "p"), tier("something", "mapped", "sounds")) == [
        "PP",
        "aa",
        "PP",
    ]


def test_the_words_of_webmaus_are_not_read_as_phones() -> None:
    spoken = tier("MAU", "<p:>", "h", "aU", "s", "<usb>", "<nib>")
    names = tier("ORT-MAU", "", "Haus", "Haus", "Haus"), tier("KAN-MAU", "", "haUs", "haUs", "haUs")
    assert shapes(*names, spoken) == ["kk", "aa", "U", "SS"]
    assert shapes(*names) == shapes(names[0])


def test_digits_of_tones_are_no_vowels() -> None:
    assert shapes(tier("phones", "m", "a1", "m", "a5", "uo_2", "aa_T3")) == [
        "PP", "aa", "PP", "aa", "U", "O", "aa",
    ]  # fmt: skip
    assert shapes(tier("phones", "h", "i:6", "6", "E6")) == ["kk", "I", "aa", "aa", "E", "aa"]


def test_a_breath_after_a_sound_is_no_sound_of_its_own() -> None:
    assert find_visemes("t_h", False)[0] == ["DD"]


def test_words_alone_are_spelled() -> None:
    assert shapes(tier("Mary", "map", "", "five")) == ["PP", "aa", "PP", "FF", "I", "FF"]


def test_points_and_empty_tiers_are_not_speech() -> None:
    assert (
        shapes(tier("phones", "a", "b", points=True)) == []
        and shapes(tier("phones", "", "sil")) == []
        and shapes() == []
    )


@given(st.lists(st.tuples(st.text(max_size=8), st.lists(st.text(max_size=6), max_size=6)), max_size=4))
def test_any_labels_are_survived(tiers: list[tuple[str, list[str]]]) -> None:
    grid = TextGrid(0, 1, tuple(tier(name, *labels) for name, labels in tiers))
    for piece in list_mouth_pieces(grid):
        assert piece.viseme in VISEMES[1:] and piece.end >= piece.start and 0 < piece.strength <= 1
