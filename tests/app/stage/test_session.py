"""The session follows the document, and remembers where the playhead was."""

from __future__ import annotations

import pytest

from app.project.document import Document
from app.stage.session import Session
from metagraph.graph import edits
from metagraph.graph.model import Project


@pytest.fixture
def session(qapp, toy):
    document = Document()
    document.load(toy.project(), None)
    session = Session(document)
    yield session
    document.close_journal()


def told(signal) -> list:
    seen: list = []
    signal.connect(lambda *a: seen.append(a))
    return seen


def test_nothing_is_selected_and_shown_of_an_empty_project(qapp):
    session = Session(Document())
    assert session.stance() is None
    assert session.other() is None
    assert session.selected_actions() == ()
    session.jump(layer="head", stance="gone", action="gone", clip="gone")
    assert session.layer == "head"


def test_the_current_stance_is_the_start_until_another_is_chosen(session, toy):
    project = session.document.project
    rest, up = toy.id(project, "rest"), toy.id(project, "up")
    assert session.stance() == rest
    assert session.other() == up
    session.set_stance(up)
    assert session.stance() == up
    assert session.other() == rest
    session.set_stance("gone")
    assert session.stance() == up


def test_a_removed_stance_is_no_longer_current(session, toy):
    up = toy.id(session.document.project, "up")
    session.set_stance(up)
    session.set_other(toy.id(session.document.project, "far"))
    seen = told(session.stance_changed)
    session.document.edit("Remove", lambda p: edits.remove_stance(p, up))
    assert session.stance() == toy.id(session.document.project, "rest")
    assert seen


def test_the_other_stance_is_never_the_current_one(session, toy):
    project = session.document.project
    rest, up, far = (toy.id(project, n) for n in ("rest", "up", "far"))
    session.set_other(far)
    assert session.other() == far
    session.set_stance(far)
    assert session.other() == rest
    session.set_stance(up)
    assert session.other() == far, "the choice is remembered"


def test_clips_and_actions_are_never_selected_together(session, toy):
    project = session.document.project
    beat, clip = toy.id(project, "rest beat lf"), next(iter(project.clips))
    session.select_actions((beat,))
    session.select_clips((clip,))
    assert session.actions == ()
    seen = told(session.selection_changed)
    session.select_clips((clip,))
    assert not seen, "the same again is no change"
    session.select_actions((beat,))
    assert session.clips == ()
    assert [a.id for a in session.selected_actions()] == [beat]


def test_the_selection_loses_what_is_removed_and_keeps_the_rest(session, toy):
    project = session.document.project
    beat, cough = toy.id(project, "rest beat lf"), toy.id(project, "rest cough")
    session.select_actions((beat, cough))
    seen = told(session.selection_changed)
    session.document.edit("Remove", lambda p: edits.remove_actions(p, [beat]))
    assert session.actions == (cough,)
    assert len(seen) == 1
    session.document.undo()
    assert session.actions == (cough,)
    session.select_clips(tuple(project.clips)[:2])
    session.document.edit("Remove", lambda p: edits.remove_clips(p, tuple(project.clips)[:1]))
    assert session.clips == tuple(project.clips)[1:2]


def test_looking_at_a_clip_keeps_the_performances_playhead(session, toy):
    clips = tuple(session.document.project.clips)
    session.seek(12.5)
    session.set_playing(False)
    session.show_clip(clips[0])
    assert (session.seconds, session.playing) == (0.0, True)
    session.seek(0.7)
    session.show_context(clips[1])
    assert session.seconds == 0.0
    session.show_plan()
    assert session.seconds == 12.5
    assert session.shown is None


def test_showing_the_same_again_starts_it_again(session):
    clip = next(iter(session.document.project.clips))
    session.show_clip(clip)
    session.seek(0.5)
    seen = told(session.show_changed)
    session.show_clip(clip)
    assert session.seconds == 0.0
    assert not seen


def test_what_is_shown_and_removed_gives_way_to_the_performance(session, toy):
    beat = toy.id(session.document.project, "rest beat lf")
    session.show_context(beat)
    session.document.edit("Remove", lambda p: edits.remove_actions(p, [beat]))
    assert session.show == "plan"


def test_jumping_to_an_action_goes_to_its_layer_and_stance(session, toy):
    project = session.document.project
    point = toy.id(project, "up point")
    session.set_layer("head")
    session.jump(action=point)
    assert (session.layer, session.stance(), session.actions) == ("arms", toy.id(project, "up"), (point,))
    session.jump(clip=next(iter(project.clips)))
    assert session.actions == ()


def test_the_playhead_never_goes_before_the_start(session):
    session.seek(-3)
    assert session.seconds == 0.0


def test_another_project_leaves_no_selection_behind(session, toy):
    session.select_actions((toy.id(session.document.project, "rest beat lf"),))
    session.document.load(Project(), None)
    assert session.actions == ()
    assert session.stance() is None
