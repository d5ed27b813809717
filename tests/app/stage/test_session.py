"""The session follows the document, and remembers where the playhead was."""

from __future__ import annotations

import pytest

from app.project.document import Document
from app.stage.session import StageSession
from metagraph.graph import edits
from metagraph.graph.model import Project


@pytest.fixture
def session(qapp, toy):
    document = Document()
    document.load(toy.project(), None)
    session = StageSession(document)
    yield session
    document.close_journal()


def told(signal) -> list:
    seen: list = []
    signal.connect(lambda *a: seen.append(a))
    return seen


def test_nothing_is_selected_and_shown_of_an_empty_project(qapp):
    session = StageSession(Document())
    assert session.place.stance() is None
    assert session.place.other() is None
    assert session.selection.selected_actions() == ()
    session.jump(layer="head", stance="gone", action="gone", clip="gone")
    assert session.place.layer == "head"


def test_the_current_stance_is_the_start_until_another_is_chosen(session, toy):
    project = session.document.project
    rest, up = toy.id(project, "rest"), toy.id(project, "up")
    assert session.place.stance() == rest
    assert session.place.other() == up
    session.place.set_stance(up)
    assert session.place.stance() == up
    assert session.place.other() == rest
    session.place.set_stance("gone")
    assert session.place.stance() == up


def test_a_removed_stance_is_no_longer_current(session, toy):
    up = toy.id(session.document.project, "up")
    session.place.set_stance(up)
    session.place.set_other(toy.id(session.document.project, "far"))
    seen = told(session.place.stance_changed)
    session.document.edit("Remove", lambda p: edits.remove_stance(p, up))
    assert session.place.stance() == toy.id(session.document.project, "rest")
    assert seen


def test_the_other_stance_is_never_the_current_one(session, toy):
    project = session.document.project
    rest, up, far = (toy.id(project, n) for n in ("rest", "up", "far"))
    session.place.set_other(far)
    assert session.place.other() == far
    session.place.set_stance(far)
    assert session.place.other() == rest
    session.place.set_stance(up)
    assert session.place.other() == far, "the choice is remembered"


def test_clips_and_actions_are_never_selected_together(session, toy):
    project = session.document.project
    beat, clip = toy.id(project, "rest beat lf"), next(iter(project.clips))
    session.selection.select_actions((beat,))
    session.selection.select_clips((clip,))
    assert session.selection.actions == ()
    seen = told(session.selection.changed)
    session.selection.select_clips((clip,))
    assert not seen, "the same again is no change"
    session.selection.select_actions((beat,))
    assert session.selection.clips == ()
    assert [a.id for a in session.selection.selected_actions()] == [beat]


def test_the_selection_loses_what_is_removed_and_keeps_the_rest(session, toy):
    project = session.document.project
    beat, cough = toy.id(project, "rest beat lf"), toy.id(project, "rest cough")
    session.selection.select_actions((beat, cough))
    seen = told(session.selection.changed)
    session.document.edit("Remove", lambda p: edits.remove_actions(p, [beat]))
    assert session.selection.actions == (cough,)
    assert len(seen) == 1
    session.document.undo()
    assert session.selection.actions == (cough,)
    session.selection.select_clips(tuple(project.clips)[:2])
    session.document.edit("Remove", lambda p: edits.remove_clips(p, tuple(project.clips)[:1]))
    assert session.selection.clips == tuple(project.clips)[1:2]


def test_looking_at_a_clip_keeps_the_performances_playhead(session, toy):
    clips = tuple(session.document.project.clips)
    session.transport.seek(12.5)
    session.transport.set_playing(False)
    session.transport.show_clip(clips[0])
    assert (session.transport.seconds, session.transport.playing) == (0.0, True)
    session.transport.seek(0.7)
    session.show_context(clips[1])
    assert session.transport.seconds == 0.0
    session.transport.show_plan()
    assert session.transport.seconds == 12.5
    assert session.transport.shown is None


def test_showing_the_same_again_starts_it_again(session):
    clip = next(iter(session.document.project.clips))
    session.transport.show_clip(clip)
    session.transport.seek(0.5)
    seen = told(session.transport.show_changed)
    session.transport.show_clip(clip)
    assert session.transport.seconds == 0.0
    assert not seen


def test_what_is_shown_and_removed_gives_way_to_the_performance(session, toy):
    beat = toy.id(session.document.project, "rest beat lf")
    session.show_context(beat)
    session.document.edit("Remove", lambda p: edits.remove_actions(p, [beat]))
    assert session.transport.show == "plan"


def test_jumping_to_an_action_goes_to_its_layer_and_stance(session, toy):
    project = session.document.project
    point = toy.id(project, "up point")
    session.place.set_layer("head")
    session.jump(action=point)
    assert (session.place.layer, session.place.stance(), session.selection.actions) == (
        "arms",
        toy.id(project, "up"),
        (point,),
    )
    session.jump(clip=next(iter(project.clips)))
    assert session.selection.actions == ()


def test_the_playhead_never_goes_before_the_start(session):
    session.transport.seek(-3)
    assert session.transport.seconds == 0.0


def test_another_project_leaves_no_selection_behind(session, toy):
    session.selection.select_actions((toy.id(session.document.project, "rest beat lf"),))
    session.document.load(Project(), None)
    assert session.selection.actions == ()
    assert session.place.stance() is None
