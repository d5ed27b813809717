"""A panel is made when its dock is first seen, or somebody asks for it; what is never seen costs nothing."""

from __future__ import annotations

import sys
from dataclasses import replace

import pytest
from PySide6.QtWidgets import QWidget

from metagraph.graph import edits
from metagraph.graph.model import Action

pytestmark = [pytest.mark.window, pytest.mark.gl, pytest.mark.fresh_window]


def made(drive) -> set[str]:
    return {ident for ident in drive.places.panels if drive.places.made(ident) is not None}


def gesture(drive) -> Action:
    return next(a for a in drive.document.project.actions() if a.kind == "gesture")


def choose(drive, workspace: str, *wanted: str) -> None:
    drive.workspaces.choose(workspace)
    drive.wait(lambda: made(drive) >= set(wanted))
    drive.pause(50)


@pytest.mark.nightly
def test_what_a_workspace_shows_is_made_when_it_is_chosen_and_what_stands_behind_when_it_comes_forward(toys):
    drive = toys
    choose(drive, "graph", "properties")
    assert made(drive) == {"library", "graph", "character", "properties"}
    choose(drive, "perform", "timeline", "life")
    assert made(drive) == {"library", "graph", "character", "properties", "timeline", "life"}
    lines = drive.docks["lines"]
    assert not lines.isHidden() and lines in drive.window.tabifiedDockWidgets(drive.docks["life"])
    lines.raise_()
    drive.wait(lambda: "lines" in made(drive))
    drive.pause(20)
    assert drive.lines.isVisible()


@pytest.mark.nightly
def test_a_dock_that_was_never_seen_is_filled_when_it_is_opened_from_its_menu(toys):
    drive = toys
    choose(drive, "graph", "properties")
    drive.docks["history"].toggleViewAction().trigger()
    drive.docks["history"].raise_()
    drive.wait(lambda: "history" in made(drive))
    assert drive.shell.panel("history").isVisible()


@pytest.mark.nightly
def test_a_command_and_a_service_find_a_panel_nobody_has_seen(toys):
    drive = toys
    assert "notes" not in made(drive)
    drive.do("note")
    assert drive.shell.panel("notes").isVisible()
    assert drive.places.made("machine") is None
    drive.do("machine")
    assert drive.machine.isVisible()


@pytest.mark.nightly
def test_each_mode_fills_the_same_dock_when_it_is_entered(toys):
    drive = toys
    drive.session.set_mode("manual")
    drive.pause(50)
    drive.workspaces.choose("graph")
    drive.pause(50)
    assert drive.editor.isVisible() and drive.shell.panel("inspector").isVisible()
    drive.session.set_mode("meta")
    drive.wait(lambda: "properties" in made(drive))
    assert drive.properties.isVisible() and not drive.shell.panel("inspector").isVisible()


@pytest.mark.nightly
def test_the_page_of_actions_comes_with_the_first_of_them(toys):
    drive = toys
    choose(drive, "graph", "properties")
    panel = drive.properties
    assert "ActionPage" not in {type(part).__name__ for part in panel.findChildren(QWidget)}
    action = gesture(drive)
    drive.session.selection.select_actions((action.id,))
    drive.wait(lambda: panel.pages.currentIndex() == 1)
    assert "pyqtgraph" in sys.modules and panel.action.name.text() == action.name
    drive.session.selection.clear()
    assert panel.pages.currentIndex() == 0


@pytest.mark.nightly
def test_a_panel_that_is_made_late_knows_what_was_selected_before_and_how_it_was_then(toys):
    drive = toys
    action = gesture(drive)
    drive.session.selection.select_actions((action.id,))
    drive.document.edit(
        "Change timing", lambda p: edits.update_actions(p, (action.id,), timing={"blend_in": 0.37})
    )
    assert drive.places.made("timing") is None
    choose(drive, "time", "timing")
    subject = drive.shell.panel("timing").subject
    assert subject.idents == (action.id,)
    subject.compare(True)
    assert subject.before is not None
    assert subject.before.action(action.id) == action
    assert drive.document.project.action(action.id) == replace(
        action, timing=replace(action.timing, blend_in=0.37)
    )
