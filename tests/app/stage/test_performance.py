"""What plays: a clip alone, an action in context, the plan; made again after edits, on a thread."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app.project.document import Document
from app.project.jobs import Jobs
from app.stage.performance import StagePerformance
from app.stage.playback_source import LEAD, play_clip_alone, play_in_context
from app.stage.playhead import Playhead
from app.stage.session import StageSession
from metagraph.graph import edits
from metagraph.graph import requests as a
from metagraph.graph.editing import performances as performance_edits
from metagraph.graph.model import LAYERS, Project
from tests.posing import pose_at


@pytest.fixture(scope="module")
def project(toy):
    """Arms with three stances, a head with one and a fidget, and a clip nobody placed."""
    project = edits.add_clips(toy.project(), [("loose.glb", 0, "", toy.clip("loose", 0.9))])
    clip = {e.name: e.id for e in project.clips.values()}
    project = edits.add_stance(project, "head", "still", [clip["rest loop"]])
    return edits.place_clips(project, [clip["rest cough"]], "head", "fidget", toy.id(project, "still"))


def stances(project: Project) -> dict:
    return {layer: g.start for layer, g in project.graphs.items() if g.start}


def test_a_clip_alone_lasts_as_long_as_it_is(toy, project):
    clip = next(e for e in project.clips.values() if e.name == "rest wave rt")
    shown = play_clip_alone(project, clip.id)
    assert shown.length == pytest.approx(1.2)
    assert shown.clip == clip.id
    empty = replace(project, clips={**project.clips, clip.id: replace(clip, frames=1)})
    assert play_clip_alone(empty, clip.id).length > 0


def test_an_action_in_context_is_stance_action_and_stance_again(toy, project):
    beat = toy.id(project, "rest beat lf")
    shown = play_in_context(project, beat, "arms", stances(project))
    cues = shown.plan.layers["arms"].cues
    assert [c.action.id for c in cues] == [beat]
    assert cues[0].start == pytest.approx(LEAD)
    assert shown.length == pytest.approx(cues[0].end + LEAD)
    assert cues[0].then == toy.id(project, "rest")
    assert shown.plan.layers["head"].cues == (), "the other layers rest"
    assert shown.clip is None


def test_an_action_of_another_stance_is_shown_in_its_own(toy, project):
    point = toy.id(project, "up point")
    cues = play_in_context(project, point, "arms", stances(project)).plan.layers["arms"].cues
    assert [c.action.id for c in cues] == [point], "no transition is needed to get there"
    assert cues[0].stance == toy.id(project, "up")


def test_a_transition_ends_in_the_other_stance(toy, project):
    shown = play_in_context(project, toy.id(project, "rest to up"), "arms", stances(project))
    cue = shown.plan.layers["arms"].cues[0]
    assert (cue.stance, cue.then) == (toy.id(project, "rest"), toy.id(project, "up"))
    low, high = (
        pose_at(shown.plan, shown.project, 0.0),
        pose_at(shown.plan, shown.project, shown.length),
    )
    assert not np.allclose(low.rotations, high.rotations, atol=0.1)


def test_a_stances_loop_plays_from_its_start_to_its_end(toy, project):
    loop = next(
        a.id for a in project.actions() if a.kind == "stance" and a.layer == "arms" and a.name == "up loop"
    )
    shown = play_in_context(project, loop, "arms", stances(project))
    assert shown.plan.layers["arms"].cues == ()
    assert shown.length == pytest.approx(2.0)
    assert pose_at(shown.plan, shown.project, 0.5) is not None


def test_a_clip_that_was_placed_is_shown_as_what_it_is(toy, project):
    clip = project.action(toy.id(project, "rest cough")).clip
    shown = play_in_context(project, clip, "arms", stances(project))
    assert shown.plan.layers["arms"].cues[0].action.kind == "fidget"
    up_only = play_in_context(
        project, project.action(toy.id(project, "up yawn")).clip, "arms", stances(project)
    )
    assert up_only.plan.layers["arms"].cues[0].stance == toy.id(project, "up"), (
        "where it is, when it is not on the current stance"
    )


def test_a_clip_that_was_not_placed_is_tried_as_a_gesture(toy, project):
    shown = play_in_context(project, toy.id(project, "loose"), "arms", stances(project))
    cue = shown.plan.layers["arms"].cues[0]
    assert (cue.action.kind, cue.stance) == ("gesture", toy.id(project, "rest"))
    assert toy.id(project, "loose") not in project.uses, "trying places nothing"


def test_without_a_stance_a_clip_in_context_is_shown_alone(toy, project):
    loose = toy.id(project, "loose")
    assert play_in_context(project, loose, "body", {}).clip == loose


def test_what_is_gone_does_not_break_the_preview(toy, project):
    bare = edits.add_clips(Project(), [("a.glb", 0, "", toy.clip("a"))])
    clip = next(iter(bare.clips))
    assert play_in_context(bare, clip, "arms", {}).clip == clip


@pytest.mark.parametrize("name", ["rest beat lf", "up loop", "rest to up"])
def test_a_clip_whose_file_is_missing_still_has_a_pose(toy, project, name):
    action = project.action(next(a.id for a in project.actions() if a.name == name and a.layer == "arms"))
    clips = {**project.clips, action.clip: replace(project.clips[action.clip], motion=None)}
    missing = replace(project, clips=clips)
    for ident in (action.id, action.clip):
        shown = play_in_context(missing, ident, "arms", stances(project))
        for seconds in (0.0, 0.9, shown.length):
            assert np.isfinite(pose_at(shown.plan, shown.project, seconds).rotations).all()


# --- as the window has it


@pytest.fixture
def stage(qapp, project):
    document = Document()
    jobs = Jobs()
    session = StageSession(document)
    performance = StagePerformance(document, session, jobs)
    document.load(project, None)
    yield performance
    jobs.stop()
    document.close_journal()


def planned(stage) -> bool:
    return stage.shown.project is stage.document.project and any(
        stage.shown.plan.layers[x].cues for x in LAYERS
    )


def test_the_plan_follows_edits_and_the_seed(stage, qtbot):
    qtbot.waitUntil(lambda: planned(stage))
    before = stage.shown.plan
    stage.document.edit("Change seed", lambda p: edits.set_settings(p, seed=77))
    qtbot.waitUntil(lambda: planned(stage))
    assert [c.action.id for c in stage.shown.plan.layers["arms"].cues] != [
        c.action.id for c in before.layers["arms"].cues
    ]
    stage.document.undo()
    qtbot.waitUntil(lambda: planned(stage))
    assert stage.shown.plan.layers["arms"].cues == before.layers["arms"].cues


def test_a_request_appears_in_the_plan_and_can_be_withdrawn(stage, qtbot, toy):
    qtbot.waitUntil(lambda: planned(stage))
    unasked = stage.shown.plan.layers["arms"].cues
    far = toy.id(stage.document.project, "far")
    stage.requests.ask(a.Go(stance=far, at=3.0))
    qtbot.waitUntil(lambda: any(c.then == far and c.start < 6 for c in stage.shown.plan.layers["arms"].cues))
    stage.requests.withdraw(stage.asks[0].id)
    qtbot.waitUntil(lambda: stage.shown.plan.layers["arms"].cues == unasked)
    assert stage.asks == ()


def test_asks_are_kept_with_the_project_and_undone_like_any_edit(stage, qtbot):
    stage.requests.ask(a.Gesture(at=3.0), "Ask for a gesture")
    project = stage.document.project
    assert [p.name for p in project.performances.values()] == [
        "Performance"
    ] and stage.requests.kept is not None
    stage.requests.ask(a.Nod(at=4.0))
    assert len(stage.asks) == 2, "the second joins the first"
    first = stage.asks[0].id
    stage.requests.move((first,), 1.25)
    assert stage.asks[0].at == 4.25
    stage.requests.change(first, priority=5)
    assert stage.asks[0].priority == 5
    for _ in range(4):
        stage.document.undo()
    assert stage.requests.kept is None and stage.asks == () and stage.session.onstage.performance is None


def test_an_ask_for_now_gets_a_time_just_after_the_playhead(stage, qtbot):
    stage.session.transport.seek(7.0)
    stage.requests.ask(a.Gesture())
    assert stage.asks[0].at == pytest.approx(7.15)
    assert stage.session.onstage.requests == (stage.asks[0].id,)


def test_a_kept_performance_has_its_own_length_and_seed(stage, qtbot):
    qtbot.waitUntil(lambda: planned(stage))
    other = stage.shown.plan.layers["arms"].cues
    made = []

    def edit(project):
        project, ident = performance_edits.add_performance(
            project, a.Performance(name="talk", length=12.0, seed=99)
        )
        made.append(ident)
        return project

    stage.document.edit("Keep", edit)
    stage.session.onstage.set_performance(made[-1])
    qtbot.waitUntil(lambda: stage.shown.length == 12.0)
    assert stage.shown.plan.layers["arms"].cues != tuple(c for c in other if c.start < 12)
    assert stage.shown.plan.seed == 99
    stage.session.onstage.set_performance(None)
    qtbot.waitUntil(lambda: stage.shown.length == 60.0 and stage.shown.plan.layers["arms"].cues == other)


def test_answers_are_about_the_plan_that_is_shown(stage, qtbot):
    stage.requests.ask(a.Gesture(at=3.0, tags=("nonsense",)))
    qtbot.waitUntil(lambda: bool(stage.answers()) and stage.answers()[stage.asks[0].id].state == "refused")


def test_another_project_forgets_requests_and_length(stage, qtbot, toy):
    stage.requests.ask(a.Gesture(at=3.0))
    stage.length = 600.0
    stage.document.load(toy.project(), None)
    qtbot.waitUntil(lambda: planned(stage))
    assert stage.asks == () and stage.session.onstage.performance is None
    assert stage.shown.length == 60.0


def test_a_plan_that_cannot_be_made_is_told_and_the_next_edit_plans_again(stage, qtbot, monkeypatch):
    qtbot.waitUntil(lambda: planned(stage))
    told = []
    stage.document.failed.connect(told.append)

    def broken(*args, **kwargs):
        raise RuntimeError("out of ideas")

    with monkeypatch.context() as patch:
        patch.setattr("app.stage.performance.improvise", broken)
        stage.replan()
        qtbot.waitUntil(lambda: bool(told))
    assert "out of ideas" in told[0]
    stage.document.edit("Change seed", lambda p: edits.set_settings(p, seed=78))
    qtbot.waitUntil(lambda: planned(stage))


def test_playing_loops_or_goes_on_for_ever(stage, qtbot):
    qtbot.waitUntil(lambda: planned(stage))
    session = stage.session
    session.transport.seek(59.9)
    Playhead(stage.session, stage).advance(0.2)
    assert session.transport.seconds == pytest.approx(0.1, abs=1e-6)
    session.transport.loop = False
    session.transport.seek(50.0)
    Playhead(stage.session, stage).advance(0.1)
    qtbot.waitUntil(lambda: stage.shown.length == 120.0)
    assert session.transport.playing
    session.transport.show_clip(next(iter(session.document.project.clips)))
    qtbot.waitUntil(lambda: stage.shown.clip is not None)
    session.transport.seek(1.99)
    Playhead(stage.session, stage).advance(0.2)
    assert not session.transport.playing, "a clip alone ends"
    assert session.transport.seconds == pytest.approx(2.0)
    session.transport.set_playing(False)
    Playhead(stage.session, stage).advance(1.0)
    assert session.transport.seconds == pytest.approx(2.0)
