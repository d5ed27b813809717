"""Where rows and numbers stand: none over another, all of them in the room there is."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.features.timing_editor.numbers import place_numbers
from app.features.timing_editor.rows import RULER, TrackWants, lay_out_rows, measure_least_rows_height

ALL = ("poses", "line", "phases", "speed", "numbers", "stance")
FEW = ("phases", "speed", "numbers", "stance")


@pytest.mark.parametrize("names", [ALL, FEW])
@pytest.mark.parametrize("count", [1, 3])
@pytest.mark.parametrize("more", [0, 40, 900])
def test_rows_follow_one_another_in_the_height_there_is(names, count, more):
    wants = [TrackWants(f"a{n}", names, 2) for n in range(count)]
    height = measure_least_rows_height(wants) + more
    y = RULER
    for rows in lay_out_rows(wants, 800, height):
        for box in (rows.title, *rows.rows.values(), rows.dope):
            assert box.top() >= y - 1e-6
            y = box.bottom()
    assert y <= height + 1e-6


def test_curves_grow_most_where_it_is_high():
    low, high = (lay_out_rows([TrackWants("a", ALL)], 800, h)[0].rows for h in (260, 700))
    grown = {n: high[n].height() - low[n].height() for n in ALL}
    assert max(grown, key=grown.get) == "speed" and grown["phases"] <= 4


@given(st.lists(st.tuples(st.floats(0, 600), st.floats(20, 90)), max_size=6))
def test_numbers_never_lie_on_one_another_while_there_is_room(wanted):
    found = place_numbers(wanted, 0, 600)
    spans = [(p.line, p.left, p.left + w) for p, (_, w) in zip(found, wanted, strict=True)]
    assert all(a >= 0 and b <= 600 + 1e-6 for _, a, b in spans)
    for n, (line, a, b) in enumerate(spans):
        for other, c, d in spans[n + 1 :]:
            assert line != other or b <= c + 1e-6 or d <= a + 1e-6


def test_a_number_stands_under_its_line_where_that_is_free():
    assert place_numbers([(100, 40)], 0, 600)[0].left == 80
    first, second = place_numbers([(100, 40), (100, 40)], 0, 600)
    assert (first.left, second.left, second.line) == (80, 80, 1)
