"""Moods in the real window: of a request, of all of a performance, and in the menu of what can be asked for."""

from __future__ import annotations

from typing import Any

import pytest

from app import translation
from app.features.timeline.request_editor import RequestEditor
from app.widgets.request_menu import describe_mood, make_request_menu
from metagraph.formats.store import save_project
from metagraph.graph import requests as a

pytestmark = [pytest.mark.window, pytest.mark.gl]


def chosen(box: Any, words: str) -> None:
    """Choose an entry as a click does."""
    box.setCurrentIndex(box.findText(words))
    box.activated.emit(box.currentIndex())


def test_a_request_and_its_performance_are_given_moods_and_taken_back(drive: Any) -> None:
    drive.timeline.new()
    drive.performance.requests.ask(a.Gesture(at=2.0), "Ask for a gesture")
    ident = drive.performance.asks[-1].id
    editor = RequestEditor(drive.performance, ident, drive.timeline.lanes)
    editor.open()
    chosen(editor.fields["mood"], "Excited")
    editor.fields["intensity"].setValue(1.5)
    asked = next(x for x in drive.performance.asks if x.id == ident)
    assert (asked.mood, asked.intensity) == ("excited", 1.5)
    drive.document.undo()
    assert next(x for x in drive.performance.asks if x.id == ident).intensity is None
    editor.accept()
    drive.timeline.more_menu.aboutToShow.emit()
    moods = next(x.menu() for x in drive.timeline.more_menu.actions() if x.text() == "Mood")
    next(x for x in moods.actions() if x.text() == "Sad").trigger()
    assert drive.performance.requests.kept.mood == "sad"
    drive.document.undo()
    assert drive.performance.requests.kept.mood is None


def test_moods_can_be_asked_for_and_are_told_in_words(drive: Any) -> None:
    menu = make_request_menu(drive.timeline, drive.performance, 1.0, "stage")
    if not menu.isEmpty() and menu.actions()[0].isEnabled():
        names = [x.text() for x in menu.actions() if x.menu() is not None]
        assert "Mood" in names
    menu.close()
    assert describe_mood("sad", 1.5) == "sad × 1.5" and describe_mood((0.3, -0.5), None) == "mood 0.3, -0.5"


def test_in_german_a_first_request_makes_a_performance_that_can_be_saved(drive: Any, tmp_path: Any) -> None:
    translation.choose("de")
    try:
        drive.timeline.new()
        drive.performance.requests.ask(a.Gesture(at=2.0))
        drive.performance.requests.to_clipboard(tuple(x.id for x in drive.performance.asks))
        drive.session.onstage.set_performance(None)
        drive.performance.requests.ask(a.Gesture(at=1.0))
        drive.session.onstage.set_performance(None)
        drive.performance.requests.paste()
        drive.lines.add_words()
    finally:
        translation.choose("en")
    project = drive.document.project
    assert {type(p.name) for p in project.performances.values()} == {str}
    assert {type(x.text) for x in project.lines.values()} == {str}
    save_project(project, tmp_path / "de.metagraph.yaml")
