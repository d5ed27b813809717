"""The guide to a first character, gone through with the window's own commands, keys and drops."""

from __future__ import annotations

import pytest
from PySide6.QtWidgets import QDialog

from app.features.files.import_line import ImportLine
from app.features.guide.guide_line import GuideLine
from app.features.guide.guide_steps import CLIPS, STEPS, WORDS, Seen, find_step
from metagraph.graph import edits
from metagraph.graph.model import Project

pytestmark = [pytest.mark.window, pytest.mark.gl]


def line(drive):
    return drive.window.findChild(GuideLine)


def clip(drive, part):
    return next(i for i, e in drive.document.project.clips.items() if part in e.name)


def test_its_clips_are_there():
    assert all(path.is_file() for path in CLIPS)


def test_a_step_is_asked_for_until_it_is_done_and_never_again(toy):
    assert find_step(Seen(Project()), 0) == 0
    assert find_step(Seen(toy.project()), 0) == [s.ident for s in STEPS].index("watch")
    assert find_step(Seen(toy.project(), watched=10.0), 0) == len(STEPS) - 1
    assert find_step(Seen(Project()), 2) == 2, "what was done before stays done"
    assert find_step(Seen(toy.project(), 10.0, True), 0) == len(STEPS)
    assert set(WORDS) == {*(s.ident for s in STEPS), "end"}


@pytest.mark.nightly
def test_it_leads_from_an_empty_window_to_an_export(drive):
    drive.do("guide")
    guide = line(drive)
    assert guide.words.text() == WORDS["clips"] and guide.take.isVisible()
    guide.take.click()
    drive.wait(lambda: guide.words.text() == WORDS["stance"])
    assert len(drive.document.project.clips) == 3
    drive.wait(guide.frame.isVisible)
    assert not drive.window.findChild(ImportLine).isVisible(), "one line says what comes next"
    drive.session.selection.select_clips((clip(drive, "stance"),))
    drive.do("label_stance")
    drive.wait(lambda: guide.words.text() == WORDS["gesture"])
    drive.session.selection.select_clips((clip(drive, "wave"),))
    drive.do("label_gesture")
    drive.wait(lambda: guide.words.text() == WORDS["fidget"])
    drive.session.transport.set_playing(False)
    drive.session.selection.select_clips((clip(drive, "watch"),))
    drive.do("label_fidget")
    drive.wait(lambda: guide.words.text() == WORDS["watch"])
    assert drive.session.transport.playing and drive.session.transport.show == "plan", "it plays by itself"
    guide.seen = Seen(drive.document.project, watched=5.9)
    drive.wait(lambda: guide.words.text() == WORDS["export"])
    assert guide.frame.geometry().right() > drive.window.width() * 0.8, "round the button that exports"
    drive.do("export")
    assert guide.words.text() == WORDS["export"], "opening the dialog exports nothing"
    drive.window.findChild(QDialog).reject()
    drive.document.exported.emit()
    assert guide.words.text() == WORDS["end"] and guide.skip.text() == "Close"
    assert not guide.frame.isVisible()
    guide.skip.click()
    assert not guide.isVisible()


@pytest.mark.nightly
def test_a_step_can_be_skipped_and_the_guide_left_at_any_time(drive):
    drive.do("guide")
    guide = line(drive)
    guide.skip.click()
    assert guide.words.text() == WORDS["stance"]
    guide.close_button.click()
    assert not guide.isVisible() and not guide.frame.isVisible()
    drive.do("guide")
    assert guide.isVisible() and guide.words.text() == WORDS["clips"], "it can be called up again"
    guide.leave()


def test_undoing_a_step_does_not_ask_for_it_again(toys):
    guide = GuideLine(toys.document, toys.session, lambda panel: None, lambda: None, toys.shell.widget)
    guide.begin()
    step = guide.step
    toys.document.edit("Remove", lambda p: edits.remove_clips(p, list(p.clips)))
    assert guide.step == step
    guide.leave()
    guide.deleteLater()
