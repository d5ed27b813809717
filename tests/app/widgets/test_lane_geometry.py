"""The timeline's geometry: seconds and pixels, lanes, the cue and the request under a point, and what is said
about them.
"""

from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st
from PySide6.QtCore import QPointF
from PySide6.QtGui import QFont

from app.stage.playback_source import ShownPlayback
from app.widgets.lane_geometry import (
    LEFT,
    RULER,
    LaneScale,
    describe_mark,
    find_cue_at,
    find_lane_at,
    mark_at,
    measure_text_width,
    place_lanes,
    place_marks,
    split_lane,
)
from app.widgets.request_menu import STAGE
from metagraph.graph import requests as a
from metagraph.graph.model import LAYERS
from metagraph.playback.planner import make_plan
from metagraph.playback.planning.extend_performance import answer_ask
from metagraph.playback.planning.running_plan import plan_performance


@given(first=st.floats(0, 1e4), each=st.floats(2, 400), seconds=st.floats(0, 1e4))
def test_pixels_and_seconds_are_inverse(first, each, seconds):
    scale = LaneScale(first, each)
    assert scale.seconds(scale.x(seconds)) == pytest.approx(seconds, abs=1e-6)
    assert scale.x(first) == LEFT


@given(each=st.floats(2, 400))
def test_marks_of_the_ruler_have_room_for_their_words(each):
    assert LaneScale(0, each).step() * each >= 64


@pytest.mark.parametrize("height", [10, 120, 200, 226, 900])
def test_lanes_follow_each_other_from_the_ruler_down(height):
    found = place_lanes(height)
    assert list(found) == [STAGE, *LAYERS]
    bottoms = [RULER, *(lane.bottom() for lane in found.values())]
    assert [lane.top() for lane in found.values()] == pytest.approx(bottoms[:-1])
    if height >= 160:
        assert bottoms[-1] <= height


def test_the_cue_under_a_point_is_the_one_that_plays_then(toy):
    project = toy.project()
    shown = ShownPlayback(project, make_plan(project, 60.0), 60.0)
    scale, height = LaneScale(5.0, 30.0), 200
    cues = [c for c in shown.plan.layers["arms"].cues if c.start > 6]
    assert cues
    lane = split_lane(place_lanes(height)["arms"])[1]
    for cue in cues:
        middle = QPointF(scale.x((cue.start + cue.end) / 2), lane.center().y())
        assert find_cue_at(shown, scale, height, middle) == ("arms", cue)
    cue = cues[0]
    assert (
        find_cue_at(
            shown,
            scale,
            height,
            QPointF(scale.x(cue.start + 0.1), split_lane(place_lanes(height)["body"])[1].center().y()),
        )
        is None
    )
    assert find_cue_at(shown, scale, height, QPointF(LEFT - 5, lane.center().y())) is None, (
        "the lane's name is no cue"
    )
    assert find_cue_at(shown, scale, height, QPointF(scale.x(cue.start + 0.1), 3)) is None


@pytest.mark.parametrize("height", [160, 232, 900])
def test_a_lane_has_what_was_asked_above_what_plays(height):
    for lane in place_lanes(height).values():
        upper, lower = split_lane(lane)
        assert lane.top() <= upper.top() < upper.bottom() <= lower.top() < lower.bottom() <= lane.bottom()
        assert upper.height() > 8 and lower.height() > 12


# --- requests


def shown_asks(project, *asks, shift=None, each=40.0):
    plan = plan_performance(project, asks, 60.0)
    answers = {ask.id: answer_ask(plan, ask.id) for ask in asks}
    return place_marks(asks, answers, project, LaneScale(0.0, each), 232.0, QFont(), shift)


def test_requests_stand_in_their_lane_at_their_time(qapp, toy):
    project = toy.project()
    asks = (
        a.Gesture(id="g", at=2.0),
        a.Go(id="s", stance="far", at=5.0),
        a.Look(id="l", at=1.0),
        a.Say(id="w", text="hello", at=3.0),
        a.Play(id="p", action="up point", at=9.0),
        a.Gesture(id="stroke", stroke=14.0),
    )
    found = {m.ask.id: m for m in shown_asks(project, *asks)}
    for ident, seconds, lane in (
        ("g", 2, "arms"),
        ("s", 5, "arms"),
        ("l", 1, STAGE),
        ("w", 3, STAGE),
        ("p", 9, "arms"),
        ("stroke", 14, "arms"),
    ):
        assert found[ident].rect.left() == pytest.approx(LEFT + 40 * seconds)
        assert find_lane_at(232.0, found[ident].rect.center()) == lane
    assert [found[i].kind for i in ("g", "s", "l")] == ["gesture", "transition", None]


def test_requests_close_together_stay_apart_and_the_one_under_the_mouse_is_found(qapp, toy):
    found = shown_asks(
        toy.project(), *[a.Gesture(id=f"g{n}", at=2.0 + n, tags=("a very long tag",)) for n in range(4)]
    )
    for one, following in pairwise(found):
        assert one.rect.right() <= following.rect.left()
    for mark in found:
        assert mark_at(found, mark.rect.center()) is mark
    assert mark_at(found, QPointF(LEFT + 20, found[0].rect.center().y())) is None


def test_where_there_is_height_requests_close_together_stand_below_each_other_with_their_words(qapp, toy):
    project, words = toy.project(), ("a very long tag",)
    asks = [a.Gesture(id=f"g{n}", at=2.0 + n, tags=words) for n in range(3)]
    plan = plan_performance(project, asks, 60.0)
    answers = {ask.id: answer_ask(plan, ask.id) for ask in asks}
    tall = place_marks(asks, answers, project, LaneScale(0.0, 40.0), 460.0, QFont())
    assert len({m.rect.top() for m in tall}) == 3
    assert len({round(m.rect.width(), 3) for m in tall}) == 1
    lane = place_lanes(460.0)["arms"]
    assert all(split_lane(lane)[0].contains(m.rect) for m in tall)
    flat = shown_asks(project, *asks)
    assert len({m.rect.top() for m in flat}) == 1 and flat[0].rect.width() < tall[0].rect.width()


@pytest.mark.parametrize(("height", "used"), [(180, 0.95), (250, 0.95), (430, 0.95)])
def test_lanes_use_the_height_there_is(height, used):
    assert list(place_lanes(height).values())[-1].bottom() >= used * height


def test_a_dragged_request_is_drawn_where_it_is_held(qapp, toy):
    still, moved = a.Gesture(id="still", at=2.0), a.Gesture(id="moved", at=8.0)
    found = {m.ask.id: m.at for m in shown_asks(toy.project(), still, moved, shift={"moved": 1.5})}
    assert found == {"still": 2.0, "moved": 9.5}


def test_what_does_not_play_says_why(qapp, toy):
    project = toy.project()
    lost = shown_asks(project, a.Gesture(id="g", at=2.0, tags=("nonsense",), priority=3))[0]
    assert lost.lost
    assert lost.rect.width() >= measure_text_width(f"⚠ {lost.words}", QFont().toString()) + 10, (
        "its sign and its words have room"
    )
    words = describe_mark(lost)
    assert "Does not play" in words and "nonsense" in words and "priority 3" in words
    late = {
        m.ask.id: m
        for m in shown_asks(project, a.Play(id="a", action="rest long", at=1.0), a.Gesture(id="b", at=2.8))
    }["b"]
    assert late.late == pytest.approx(0.6) and "from 3.40 to 4.30 s" in describe_mark(late)
    there = shown_asks(project, a.Go(id="s", stance="rest", at=1.0))[0]
    assert not there.lost and "already" in describe_mark(there)
