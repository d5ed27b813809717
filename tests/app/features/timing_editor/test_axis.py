"""Seconds to pixels: zooming keeps what is under the pointer, nothing goes out of sight."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.features.timing_editor.axis import CLOSEST, Axis


def test_everything_is_in_sight_at_first():
    axis = Axis.whole(80, 500, 2.0)
    assert axis.x(0) > 80 and axis.x(2.0) < 580 and axis.is_whole


@given(x=st.floats(80, 580), factor=st.floats(1.01, 30))
def test_what_is_under_the_pointer_stays_there_where_it_is_zoomed_in(x, factor):
    axis = Axis.whole(80, 500, 2.0)
    assert axis.zoomed(x, factor).x(axis.seconds(x)) == pytest.approx(x, abs=0.01)


@given(
    steps=st.lists(st.tuples(st.floats(-2000, 2000), st.floats(0.05, 20)), max_size=6),
    length=st.floats(0.001, 600),
)
def test_however_it_is_zoomed_and_moved_the_clip_fills_the_room(steps, length):
    axis = Axis.whole(80, 500, length)
    whole = axis.each
    for pixels, factor in steps:
        axis = axis.zoomed(300 + pixels, factor).moved(pixels)
        assert whole * 0.999 <= axis.each <= max(CLOSEST, whole) * 1.001
        assert axis.first >= -0.021 * length and axis.last <= 1.021 * length
    marks = list(axis.marks())
    assert marks == sorted(marks) and all(-1e-6 <= m <= length + 1e-6 for m in marks)


def test_another_width_shows_the_same_part_and_all_of_it_where_all_was_seen():
    whole = Axis.whole(80, 500, 2.0)
    assert whole.fitted(80, 900, 2.0).is_whole
    near = whole.zoomed(300, 4)
    assert near.fitted(80, 900, 2.0).each == near.each
    assert near.fitted(80, 900, 3.0).is_whole, "another clip begins with all of it"


def test_a_clip_of_one_frame_and_a_room_of_nothing_are_no_error():
    axis = Axis.whole(80, 0, 0.0)
    assert axis.each > 0 and list(axis.marks()) == [0.0]
