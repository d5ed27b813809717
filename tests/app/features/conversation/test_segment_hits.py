"""What is under the pointer on a conversation's lanes, and what a dragged time snaps to."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PySide6.QtCore import QPointF

from app.features.conversation.segment_hits import (
    SegmentHit,
    find_pitch_maxima,
    find_segment_hit,
    find_word_edges,
    snap_time,
)
from app.features.conversation.segment_lanes import (
    find_least_scale,
    find_visible_segments,
    find_words_between,
    measure_least_lane_height,
    measure_pitch_y,
    place_segment_lanes,
)
from app.widgets.lane_geometry import LEFT, RULER, LaneScale
from metagraph.graph.conversation.model import Conversation, Segment, Side, Word

SIZE = (1000.0, 240.0)
SCALE = LaneScale(0.0, 100.0)
TALK = Conversation(
    name="talk",
    length=20.0,
    sides=(
        Side(
            segments=(
                Segment("clause", 1.0, 2.0, 1.5),
                Segment("clause", 2.0, 3.0),
                Segment("hesitation", 4.0, 4.05),
            )
        ),
        Side(segments=(Segment("response", 1.0, 2.0, 1.2),)),
    ),
)


def at(seconds: float, side: int = 0, row: str = "segments") -> SegmentHit:
    lane = getattr(place_segment_lanes(*SIZE)[side], row)
    return find_segment_hit(TALK, SCALE, SIZE, QPointF(SCALE.x(seconds), lane.center().y()))


@pytest.mark.parametrize("height", [measure_least_lane_height(2), 240, 500, 1200])
def test_lanes_follow_each_other_and_fit(height: float) -> None:
    first, second = place_segment_lanes(1000, height)
    rows = [r for lane in (first, second) for r in (lane.wave, lane.words, lane.segments)]
    assert rows[0].top() == RULER
    assert all(a.bottom() <= b.top() + 0.01 for a, b in pairwise(rows))
    assert rows[-1].bottom() <= height
    assert all(r.height() > 10 for r in rows)


@pytest.mark.parametrize("sides", range(2, 9))
def test_lanes_of_all_who_talk_lie_under_each_other_in_the_height_they_need(sides: int) -> None:
    places = place_segment_lanes(1000, measure_least_lane_height(sides), sides)
    assert len(places) == sides and places[-1].whole.bottom() <= measure_least_lane_height(sides)
    for above, below in pairwise(places):
        assert above.whole.bottom() < below.whole.top()
    assert all(lane.segments.height() >= 15 and lane.wave.height() >= 15 for lane in places)


def test_a_segment_is_held_by_its_ends_or_its_body() -> None:
    assert at(1.5) == SegmentHit("body", 0, 0)
    assert at(1.02) == SegmentHit("start", 0, 0)
    assert at(0.97) == SegmentHit("start", 0, 0)
    assert at(2.97) == SegmentHit("end", 0, 1)
    assert at(1.5, 1) == SegmentHit("body", 1, 0)
    assert at(3.5) == SegmentHit("gap", 0)


def test_where_two_touch_each_is_held_from_its_own_side() -> None:
    assert at(1.98) == SegmentHit("end", 0, 0)
    assert at(2.02) == SegmentHit("start", 0, 1)


def test_a_narrow_segment_can_still_be_taken_by_its_body_and_by_its_ends() -> None:
    assert at(4.025) == SegmentHit("body", 0, 2)
    assert at(3.97) == SegmentHit("start", 0, 2)
    assert at(4.09) == SegmentHit("end", 0, 2)


def test_only_clauses_have_a_stress_to_take_hold_of() -> None:
    assert at(1.52, row="wave") == SegmentHit("peak", 0, 0)
    assert at(1.7, row="wave") == SegmentHit("wave", 0)
    assert at(1.2, 1, "wave") == SegmentHit("wave", 1)


def test_names_and_the_ruler_are_no_segments() -> None:
    lane = place_segment_lanes(*SIZE)[1]
    assert find_segment_hit(TALK, SCALE, SIZE, QPointF(LEFT - 5, lane.segments.center().y())) == SegmentHit(
        "title", 1
    )
    assert find_segment_hit(TALK, SCALE, SIZE, QPointF(LEFT + 50, 4)).part == "ruler"
    assert find_segment_hit(TALK, SCALE, SIZE, QPointF(3, 4)).part == "nothing"


@given(st.floats(-5, 25), st.floats(0, 25))
def test_what_is_in_sight_is_what_a_look_at_all_finds(begin: float, length: float) -> None:
    segments = TALK.sides[0].segments
    wanted = [n for n, s in enumerate(segments) if s.end >= begin and s.start <= begin + length]
    assert list(find_visible_segments(segments, begin, begin + length)) == wanted


def test_the_word_that_reaches_into_sight_is_there() -> None:
    words = (
        Word(text="a", start=0.0, end=2.0),
        Word(text="b", start=2.0, end=3.0),
        Word(text="c", start=9.0, end=9.5),
    )
    assert [w.text for w in find_words_between(words, 1.0, 2.5)] == ["a", "b"]
    assert find_words_between((), 0.0, 1.0) == ()


def test_pitch_stands_higher_the_higher_it_is_and_stays_in_its_lane() -> None:
    wave = place_segment_lanes(*SIZE)[0].wave
    ys = [float(measure_pitch_y(h, wave)) for h in (10, 80, 160, 320, 5000)]
    assert ys == sorted(ys, reverse=True)
    assert wave.top() <= ys[-1] <= ys[0] <= wave.bottom()
    assert ys[1] - ys[2] == pytest.approx(ys[2] - ys[3]), "an octave is as high everywhere"


def test_all_of_it_can_be_seen_at_once() -> None:
    each = find_least_scale(1000, 1800.0)
    assert LaneScale(0, each).x(1800.0) <= 1000
    assert find_least_scale(1000, 10.0) == 2.0


def test_a_time_is_caught_only_near_and_only_when_wanted() -> None:
    words = (Word(text="a", start=1.0, end=1.4), Word(text="b", start=1.4, end=2.0))
    marks = find_word_edges(words, 1.5)
    assert snap_time(1.44, marks, SCALE) == 1.4
    assert snap_time(1.44, marks, SCALE, on=False) == 1.44
    assert snap_time(1.7, marks, SCALE) == 1.7
    assert snap_time(1.7, [], SCALE) == 1.7


def test_the_tops_of_a_pitch_are_found_with_gaps_ends_and_even_stretches() -> None:
    nan = np.nan
    hertz = np.array([nan, 100, 120, 110, nan, 200, 200, 200, 150, 160, nan])
    times = np.arange(len(hertz)) / 100
    assert find_pitch_maxima(times, hertz) == pytest.approx([0.02, 0.06, 0.09])
    assert len(find_pitch_maxima(times, np.full(len(hertz), nan))) == 0
    assert len(find_pitch_maxima(times[:0], hertz[:0])) == 0
