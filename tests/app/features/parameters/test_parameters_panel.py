"""The panel of parameters: they are declared, tried in the preview and exported, with mouse and keys."""

from __future__ import annotations

import json
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QDialog, QDialogButtonBox

from metagraph.engines.targets import registry
from metagraph.formats.store import open_project
from metagraph.graph import edits
from metagraph.graph.check import check_project
from metagraph.graph.editing.parameters import list_offered_parameters

pytestmark = [pytest.mark.window, pytest.mark.gl]


@pytest.fixture
def panel(toys):
    toys.shell.show("parameters")
    out = toys.shell.panel("parameters")
    yield out
    toys.docks["parameters"].close()


def choose(panel, group: str, words: str) -> None:
    """Choose what to add in the menu, as a user does."""
    panel.add_menu.aboutToShow.emit()
    (menu,) = (a.menu() for a in panel.add_menu.actions() if a.text() == group)
    next(a for a in menu.actions() if a.text().startswith(words)).trigger()


def directed(panel) -> list[str]:
    return [str(type(ask).__struct_config__.tag) for ask in panel.performance.directed]


def test_a_parameter_is_added_renamed_and_removed_each_as_one_step(toys, panel, monkeypatch):
    assert panel.empty.isVisibleTo(panel)
    choose(panel, "What lasts", "Mood")
    choose(panel, "What lasts", "Energy")
    document = panel.document
    assert list(document.project.parameters) == ["mood", "energy"]
    assert document.undo_stack.undoText() == "Add parameter" and not panel.empty.isVisibleTo(panel)

    def fill(dialog) -> QDialog.DialogCode:
        dialog.name.setText("vigour")
        dialog.about.setText("How large gestures are")
        dialog.most.setValue(1.5)
        QTest.mouseClick(dialog.findChild(QDialogButtonBox).buttons()[0], Qt.MouseButton.LeftButton)
        return QDialog.DialogCode(dialog.result())

    monkeypatch.setattr(QDialog, "exec", fill)
    panel.menus["energy"].actions()[0].trigger()
    assert list(document.project.parameters) == ["mood", "vigour"]
    assert document.project.parameters["vigour"].most == 1.5
    assert panel.controls["vigour"].toolTip() == "How large gestures are"
    document.undo()
    assert list(document.project.parameters) == ["mood", "energy"]
    panel.menus["energy"].actions()[-1].trigger()
    assert list(document.project.parameters) == ["mood"]
    assert document.undo_stack.undoText() == "Remove parameter"


def test_a_name_that_code_cannot_have_is_said_in_the_dialog(toys, panel, monkeypatch):
    choose(panel, "What lasts", "Mood")
    seen = []

    def fill(dialog) -> QDialog.DialogCode:
        dialog.name.setText("Walk Speed")
        QTest.mouseClick(dialog.findChild(QDialogButtonBox).buttons()[0], Qt.MouseButton.LeftButton)
        seen.append((dialog.wrong.text(), dialog.wrong.isVisibleTo(dialog)))
        dialog.choices.selectRow(0)
        QTest.mouseClick(dialog.remove_button, Qt.MouseButton.LeftButton)
        dialog.name.setText("mood")
        dialog.choices.item(0, 0).setText("quiet")
        dialog.accept()
        return QDialog.DialogCode(dialog.result())

    monkeypatch.setattr(QDialog, "exec", fill)
    panel.menus["mood"].actions()[0].trigger()
    assert seen == [(seen[0][0], True)] and "walk_speed" in seen[0][0]
    choices = panel.document.project.parameters["mood"].choices
    assert len(choices) == 11 and (choices[0].name, choices[0].value) == ("quiet", "calm")


def test_controls_change_the_character_at_once_and_nothing_is_saved(toys, panel):
    for words in ("Mood", "Energy", "What it looks at", "Whether it speaks", "Where its partner is"):
        choose(panel, "What lasts", words)
    choose(panel, "Gestures", "Blink")
    choose(panel, "Gestures", "Any gesture")
    project, steps = panel.document.project, panel.document.undo_stack.count()
    mood = panel.controls["mood"]
    mood.setCurrentIndex(mood.findData("happy"))
    mood.activated.emit(mood.currentIndex())
    toys.wait(lambda: directed(panel) == ["mood"])
    assert panel.session.transport.playing and panel.session.transport.show == "plan"
    slider = panel.controls["energy"].slider
    slider.triggerAction(slider.SliderAction.SliderToMinimum)
    toys.wait(lambda: directed(panel) == ["mood", "mood"])
    assert panel.controls["energy"].number.value() == 0 and panel.performance.directed[-1].intensity == 0
    assert panel.performance.directed[-1].mood == "happy", "the mood stays as it was set"
    panel.controls["speaking"].click()
    toys.wait(lambda: directed(panel)[-1] == "mode")
    panel.controls["partner"].numbers[0].setValue(2.0)
    toys.wait(lambda: directed(panel)[-1] == "place")
    QTest.mouseClick(panel.controls["blink"], Qt.MouseButton.LeftButton)
    toys.wait(lambda: directed(panel)[-1] == "blink")
    plan = panel.performance.shown
    QTest.mouseClick(panel.controls["gesture"], Qt.MouseButton.LeftButton)
    toys.wait(lambda: directed(panel)[-1] == "gesture")
    toys.wait(lambda: panel.performance.shown is not plan)
    assert panel.document.project is project and panel.document.undo_stack.count() == steps
    assert not project.performances, "what is tried is not kept"


def test_the_pose_follows_a_control(toys, panel):
    """A point that is moved to one side turns the head."""
    choose(panel, "What lasts", "Where its partner is")
    choose(panel, "What lasts", "What it looks at")
    performance, transport = panel.performance, panel.session.transport
    transport.set_playing(False)
    transport.seek(0.0)
    before = performance.shown.pose(3.0).rotations.copy()
    look = panel.controls["looks_at"]
    look.activated.emit(0)
    panel.controls["partner"].numbers[0].setValue(3.0)
    toys.wait(lambda: len(performance.directed) == 2)
    transport.set_playing(False)
    toys.wait(lambda: not np.allclose(performance.shown.pose(3.0).rotations, before, atol=1e-3))


def test_dragging_a_slider_makes_few_requests(toys, panel):
    choose(panel, "What lasts", "Energy")
    slider = panel.controls["energy"].slider
    for at in range(0, 90, 3):
        slider.setValue(at)
    toys.wait(lambda: bool(directed(panel)))
    assert len(directed(panel)) <= 3


def test_what_was_removed_is_an_error_that_names_the_remedy(toys, panel):
    choose(panel, "What lasts", "Stance of the arms")
    (stance, *_) = (c.value for c in panel.document.project.parameters["arms_stance"].choices)
    project = panel.document.project
    broken = edits.remove_stance(project, stance)
    (problem,) = (p for p in check_project(broken) if p.code == "parameter")
    assert problem.severity == "error" and "arms_stance" in problem.message
    assert "Remove the choice in the panel 'Parameters'" in problem.remedy


def test_a_project_with_parameters_is_saved_opened_and_exported(toys, panel, tmp_path: Path):
    for offered in list_offered_parameters(panel.document.project):
        if offered.group == "state":
            panel.add(offered)
    path = tmp_path / "toy.metagraph.yaml"
    panel.document.save(path)
    again = open_project(path).project
    assert again.parameters == panel.document.project.parameters
    assert list(again.parameters) == list(panel.document.project.parameters)
    registry.write_for_target(panel.document.project, "javascript", tmp_path / "game")
    document = json.loads((tmp_path / "game" / "toy.json").read_bytes())
    assert list(document["parameters"]) == list(again.parameters)
    assert "get mood()" in (tmp_path / "game" / "toy.parameters.js").read_text()


def test_in_a_live_session_it_is_requested_as_by_a_client(toys, panel, monkeypatch):
    choose(panel, "What lasts", "Mood")
    asked = []
    panel.controls["mood"].activated.emit(0)
    with monkeypatch.context() as patched:  # for a moment: the window plays on
        patched.setattr(panel.performance.live, "stage", SimpleNamespace(ask=asked.append))
        panel.send()
    assert asked[0].mood == "neutral" and directed(panel) == []


def test_what_was_tried_is_over_once_something_else_is_on_stage(toys, panel):
    choose(panel, "Gestures", "Blink")
    QTest.mouseClick(panel.controls["blink"], Qt.MouseButton.LeftButton)
    toys.wait(lambda: directed(panel) == ["blink"])
    panel.session.onstage.improvise("listening")
    assert directed(panel) == []
    panel.session.onstage.improvise("talking")


def test_one_action_is_found_under_its_stance(toys, panel):
    panel.add_menu.aboutToShow.emit()
    (menu,) = (a.menu() for a in panel.add_menu.actions() if a.text() == "One action")
    inside = next(a.menu() for a in menu.actions() if a.text().startswith("arms: "))
    assert inside.isEmpty()
    inside.aboutToShow.emit()
    entry = inside.actions()[0]
    entry.trigger()
    ((name, parameter),) = panel.document.project.parameters.items()
    action = panel.document.project.action(parameter.request.action)
    assert action.name == entry.text() and action.layer == "arms" and name in panel.controls


def test_a_panel_that_is_chosen_in_the_menu_comes_in_front(toys):
    docks = toys.places.docks
    for name in ("problems", "parameters"):
        dock = docks[name]
        if not dock.isHidden():
            dock.toggleViewAction().trigger()
        dock.toggleViewAction().trigger()
    toys.wait(lambda: not docks["parameters"].visibleRegion().isEmpty())
