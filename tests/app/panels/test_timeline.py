"""The timeline's geometry: seconds and pixels, lanes, and the cue under a point."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from PySide6.QtCore import QPointF

from app.panels.timeline import LEFT, RULER, Scale, cue_at, lanes
from app.performance import Shown
from metagraph.graph.model import LAYERS
from metagraph.playback.planner import make_plan


@given(first=st.floats(0, 1e4), each=st.floats(2, 400), seconds=st.floats(0, 1e4))
def test_pixels_and_seconds_are_inverse(first, each, seconds):
    scale = Scale(first, each)
    assert scale.seconds(scale.x(seconds)) == pytest.approx(seconds, abs=1e-6)
    assert scale.x(first) == LEFT


@given(each=st.floats(2, 400))
def test_marks_of_the_ruler_have_room_for_their_words(each):
    assert Scale(0, each).step() * each >= 64


@pytest.mark.parametrize("height", [10, 120, 200, 226, 900])
def test_lanes_follow_each_other_from_the_ruler_down(height):
    found = lanes(height)
    assert list(found) == ["requests", *LAYERS]
    bottoms = [RULER, *(lane.bottom() for lane in found.values())]
    assert [lane.top() for lane in found.values()] == pytest.approx(bottoms[:-1])
    if height >= 120:
        assert bottoms[-1] <= height


def test_the_cue_under_a_point_is_the_one_that_plays_then(toy):
    project = toy.project()
    shown = Shown(project, make_plan(project, 60.0), 60.0)
    scale, height = Scale(5.0, 30.0), 200
    cues = [c for c in shown.plan.layers["arms"].cues if c.start > 6]
    assert cues
    lane = lanes(height)["arms"]
    for cue in cues:
        middle = QPointF(scale.x((cue.start + cue.end) / 2), lane.center().y())
        assert cue_at(shown, scale, height, middle) == ("arms", cue)
    cue = cues[0]
    assert cue_at(shown, scale, height, QPointF(scale.x(cue.start + 0.1), lanes(height)["body"].center().y())) is None
    assert cue_at(shown, scale, height, QPointF(LEFT - 5, lane.center().y())) is None, "the lane's name is no cue"
    assert cue_at(shown, scale, height, QPointF(scale.x(cue.start + 0.1), 3)) is None
