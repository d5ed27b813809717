"""What drops on a layer's lane do, and say."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint

from app.features.timeline.lane_drops import GAP, ask_for_drop, plan_lane_drop
from app.project.load import Load
from app.widgets.lane_geometry import place_lanes as places
from metagraph.graph import edits


@pytest.fixture
def project(toy):
    return edits.add_clips(toy.project(), [("n/x.bvh", 0, "", toy.clip("x"))])


def test_actions_are_asked_for_one_after_the_other(toy, project):
    beat, cough = toy.id(project, "rest beat lf"), toy.id(project, "rest cough")
    load = Load(actions=(beat, cough))
    drop = plan_lane_drop(project, "arms", project.action(beat).stance, 2.0, load)
    assert drop.possible and "2 actions" in drop.words and "2.00 s" in drop.words
    same, asked = ask_for_drop(project, drop, load)
    start, end = project.span(project.action(beat))
    assert same is project and [a.action for a in asked] == [beat, cough]
    assert [a.at for a in asked] == [2.0, round(2.0 + end - start + GAP, 2)]


def test_a_clip_that_nothing_plays_is_placed_first(toy, project):
    clip = next(i for i, e in project.clips.items() if e.name == "x")
    stance = project.action(toy.id(project, "rest cough")).stance
    drop = plan_lane_drop(project, "arms", stance, 1.5, Load(clips=(clip,)))
    assert drop.possible and "as a gesture of" in drop.words and drop.words.endswith("at 1.50 s")
    after, (ask,) = ask_for_drop(project, drop, Load(clips=(clip,)))
    made = after.action(ask.action)
    assert (made.clip, made.kind, made.stance, ask.at) == (clip, "gesture", stance, 1.5)
    again = plan_lane_drop(after, "arms", stance, 1.5, Load(clips=(clip,)))
    assert (
        again.words.endswith(" x at 1.50 s")
        and "gesture" not in again.words
        and ask_for_drop(after, again, Load(clips=(clip,)))[0] is after
    )


def test_what_cannot_be_is_said(toy, project):
    loop = next(a.id for a in project.actions() if a.kind == "stance")
    clip = next(i for i, e in project.clips.items() if e.name == "x")
    for layer, stance, load in (
        (None, None, Load(clips=(clip,))),
        ("arms", None, Load(clips=(clip,))),
        ("arms", None, Load(files=("a.glb",))),
        ("arms", "s1", Load(actions=(loop,))),
        ("arms", "s1", Load()),
    ):
        drop = plan_lane_drop(project, layer, stance, 0.0, load)
        assert not drop.possible and drop.words


@pytest.mark.nightly
@pytest.mark.gl
def test_a_row_of_the_graph_is_dragged_onto_its_lane(toys):
    toys.session.transport.show_plan()
    toys.session.transport.set_playing(False)
    toys.pause(50)
    lanes = toys.timeline.lanes
    beat = toys.id("rest beat lf")
    toys.session.place.set_stance(toys.action("rest beat lf").stance)
    at = QPoint(round(lanes.scale().x(3.0)), round(places(lanes.height())["arms"].center().y()))
    asks = lambda: [x for p in toys.document.project.performances.values() for x in p.asks]  # noqa: E731
    toys.drag(toys.row(beat), (lanes, at), lambda: bool(asks()))
    assert asks()[0].action == beat and asks()[0].at == pytest.approx(3.0, abs=0.1)
