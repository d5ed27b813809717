"""What a chip shows of a name: all, or what tells it apart in whole words, or nothing."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.look.shortening import GAP, shorten_middle, shorten_to_lines

NODS = ["nod single", "nod small", "nod double 01", "nod double 02", "nod emphatic"]


def letters(text: str) -> float:
    return float(len(text))


def test_what_tells_neighbours_apart_is_kept():
    row = [f"a very long name {x} that ends alike" for x in ("left", "right", "both")]
    shown = [shorten_middle(name, 20, letters, row) for name in row]
    assert len(set(shown)) == 3 and all(len(s) <= 20 and GAP in s for s in shown)
    assert shorten_middle(row[0], 20, letters) == "a very lo…ends alike"
    assert shorten_middle("hands at sides", 30, letters) == "hands at sides"
    assert shorten_middle("abc", 0.5, letters) == ""
    assert shorten_middle("abc", 1, letters) == GAP


@given(st.text(max_size=40), st.integers(0, 45), st.lists(st.text(max_size=40), max_size=4))
def test_what_is_shown_always_fits_and_is_of_the_text(text, width, others):
    shown = shorten_middle(text, width, letters, others)
    assert len(shown) <= width or shown == text == ""
    if shown not in (text, ""):
        head, _, tail = shown.partition(GAP) if GAP not in text else ("", GAP, "")
        assert text.startswith(head) and text.endswith(tail)


def test_where_there_is_no_room_nothing_is_shown():
    assert shorten_to_lines("nod", 0, 1, letters) == shorten_to_lines("", 0, 2, letters)[1:] == ()
    assert shorten_to_lines("___", 1, 1, letters) == ()


def test_what_fits_is_shown_whole_and_broken_between_words_where_it_is_high_enough():
    assert shorten_to_lines("nod small", 9, 1, letters, NODS) == ("nod small",)
    assert shorten_to_lines("nod small", 6, 2, letters, NODS) == ("nod", "small")
    assert shorten_to_lines("IdleBackShrug", 8, 2, letters) == ("IdleBack", "Shrug")
    assert shorten_to_lines("one two three", 5, 3, letters) == ("one", "two", "three")


@pytest.mark.parametrize(
    ("name", "width", "shown"),
    [
        ("nod single", 7, ("…single",)),
        ("nod small", 8, ("…small",)),
        ("nod double 02", 9, ("…02",)),
        ("nod double 02", 2, ("02",)),  # the number, even where dots have no room
        ("nod emphatic", 7, ("…empha…",)),
        ("nod emphatic", 4, ()),
        ("nod single", 4, ()),
    ],
)
def test_a_low_chip_shows_the_words_that_none_of_its_neighbours_has(name, width, shown):
    assert shorten_to_lines(name, width, 1, letters, NODS) == shown


def test_names_alike_but_for_what_has_no_room_show_nothing():
    assert shorten_to_lines("wave slowly", 5, 1, letters, ["wave slowed"]) == ()
    assert shorten_to_lines("wave 1", 1, 1, letters, ["wave 12"]) == ("1",)


def test_words_of_other_scripts_and_of_camels_are_words():
    assert shorten_to_lines("お辞儀 深い 02", 4, 1, letters, ["お辞儀 浅い 02"]) == ("…深い…",)
    assert shorten_to_lines("HeroGrußLinks", 6, 1, letters, ["HeroWinkLinks"]) == ("…Gruß…",)


@given(
    st.text(max_size=30), st.integers(0, 30), st.integers(1, 3), st.lists(st.text(max_size=30), max_size=4)
)
def test_what_is_shown_fits_and_is_of_the_name(text, width, lines, others):
    shown = shorten_to_lines(text, width, lines, letters, others)
    assert len(shown) <= lines and all(len(line) <= width for line in shown)
    at = 0
    for line in shown:
        piece = line if line in text else line.strip(GAP)
        assert text.find(piece, at) >= 0
        at = text.find(piece, at) + len(piece)
    if shown and GAP not in text and any(line.strip(GAP) != line for line in shown):
        assert any(line.strip(GAP).strip() for line in shown)
