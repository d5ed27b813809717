"""Who moves each of the two, how far apart they stand, and what cannot be, in the dialog of sounds and
names.
"""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QFileDialog, QToolButton

from app.features.conversation.conversation_commands import ask_for_conversation
from app.features.conversation.conversation_dialog import ImportDialog
from app.features.conversation.sides_dialog import SidesDialog
from metagraph.formats.store import save_project
from metagraph.graph.conversation import edits as conversation_edits
from metagraph.graph.model import Project

pytestmark = [pytest.mark.window, pytest.mark.gl]


def opened(talk: Any) -> SidesDialog:
    talk.drive.actions["side_sounds"].trigger()
    return next(d for d in talk.drive.window.findChildren(SidesDialog) if d.isVisible())


def test_another_project_is_chosen_for_a_side_and_taken_away_again(
    talk: Any, tmp_path: Path, monkeypatch: Any
) -> None:
    other = tmp_path / "other.metagraph.yaml"
    save_project(Project("other"), other)
    talk.drive.document.save(tmp_path / "this.metagraph.yaml")
    dialog = opened(talk)
    assert [m.text() for m in dialog.movers] == ["", ""]
    assert dialog.movers[1].placeholderText() == "This project"
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_, **__: (str(other), ""))
    choose = [b for b in dialog.findChildren(QToolButton) if b.toolTip() == "Choose a project"]
    QTest.mouseClick(choose[1], Qt.MouseButton.LeftButton)
    assert dialog.movers[1].text() == "other.metagraph.yaml", (
        "beside this project: moved together, it is still found"
    )
    QTest.mouseClick(dialog.go, Qt.MouseButton.LeftButton)
    assert [s.project for s in talk.conversation.sides] == [None, "other.metagraph.yaml"]
    dialog = opened(talk)
    dialog.movers[1].clear()
    QTest.mouseClick(dialog.go, Qt.MouseButton.LeftButton)
    assert [s.project for s in talk.conversation.sides] == [None, None]


def test_a_character_of_its_own_is_chosen_for_a_side_and_taken_away_again(
    talk: Any, tmp_path: Path, monkeypatch: Any
) -> None:
    body = tmp_path / "guest.glb"
    shutil.copy(Path(__file__).parents[4] / "sample_clips" / "ben.glb", body)
    talk.drive.document.save(tmp_path / "this.metagraph.yaml")
    dialog = opened(talk)
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_, **__: (str(body), ""))
    choose = [b for b in dialog.findChildren(QToolButton) if b.toolTip() == "Choose a character"]
    QTest.mouseClick(choose[1], Qt.MouseButton.LeftButton)
    QTest.mouseClick(dialog.go, Qt.MouseButton.LeftButton)
    assert [s.character for s in talk.conversation.sides] == [None, "guest.glb"]
    dialog = opened(talk)
    dialog.bodies[1].setText("gone.glb")
    QTest.mouseClick(dialog.go, Qt.MouseButton.LeftButton)
    assert dialog.isVisible() and "gone.glb" in dialog.said.text() and "clear the field" in dialog.said.text()
    dialog.bodies[1].clear()
    QTest.mouseClick(dialog.go, Qt.MouseButton.LeftButton)
    assert [s.character for s in talk.conversation.sides] == [None, None]


def test_a_project_that_is_not_there_is_told_and_the_dialog_stays(talk: Any, tmp_path: Path) -> None:
    before = talk.drive.document.project
    dialog = opened(talk)
    QTest.keyClicks(dialog.movers[0], str(tmp_path / "gone.metagraph.yaml"))
    dialog.distance.setValue(2.0)
    QTest.mouseClick(dialog.go, Qt.MouseButton.LeftButton)
    assert dialog.isVisible()
    assert "gone.metagraph.yaml" in dialog.said.text()
    assert "clear the field" in dialog.said.text()
    assert talk.drive.document.project is before
    dialog.reject()


def test_a_project_that_moves_its_own_side_is_this_project(talk: Any, tmp_path: Path) -> None:
    talk.drive.document.save(tmp_path / "this.metagraph.yaml")
    dialog = opened(talk)
    QTest.keyClicks(dialog.movers[0], "this.metagraph.yaml")
    QTest.mouseClick(dialog.go, Qt.MouseButton.LeftButton)
    assert talk.conversation.sides[0].project is None


def test_a_dialog_goes_with_the_project_it_is_about(talk: Any) -> None:
    dialog = opened(talk)
    ask_for_conversation(talk.drive.shell, (talk.audio, talk.words))
    reading = next(d for d in talk.drive.window.findChildren(ImportDialog) if d.isVisible())
    talk.drive.document.load(Project("other"), None)
    assert not dialog.isVisible()
    assert not reading.isVisible()
    talk.drive.wait(lambda: not talk.drive.jobs.running, 60)
    assert not talk.drive.document.project.conversations


def test_how_far_apart_they_stand_is_set_with_all_the_rest_in_one_step(talk: Any) -> None:
    drive, steps = talk.drive, talk.drive.document.undo_stack.index()
    dialog = opened(talk)
    assert dialog.distance.value() == 1.3
    dialog.distance.setValue(2.5)
    dialog.names[0].setText("Eve")
    QTest.mouseClick(dialog.go, Qt.MouseButton.LeftButton)
    assert talk.conversation.distance == 2.5
    assert talk.conversation.sides[0].name == "Eve"
    assert drive.document.undo_stack.index() == steps + 1
    drive.actions["undo"].trigger()
    assert talk.conversation.distance == 1.3


def test_a_distance_that_is_finer_than_shown_is_kept(talk: Any) -> None:
    ident = talk.drive.session.onstage.conversation
    talk.drive.document.edit(
        "Stand", lambda p: conversation_edits.change_conversation(p, ident, distance=1.2345)
    )
    QTest.mouseClick(opened(talk).go, Qt.MouseButton.LeftButton)
    assert talk.conversation.distance == 1.2345
