"""Stances and actions of another project are seen in a dialog before they are taken, in one step to undo."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QFileDialog

from metagraph.formats.gltf.reader import write_glb
from metagraph.formats.store import SUFFIX, save_project
from metagraph.graph import edits
from metagraph.graph.model import Project

pytestmark = [pytest.mark.window, pytest.mark.gl]


@pytest.fixture
def other(toy, tmp_path):
    """Another project's file: a stance with a loop and a gesture."""
    folder = tmp_path / "theirs"
    folder.mkdir()
    clips = [toy.clip(name, 1.0, 0.3) for name in ("their pose", "their wave")]
    for clip in clips:
        write_glb(folder / f"{clip.name}.glb", [clip])
    project = edits.add_clips(Project("theirs"), [(f"{c.name}.glb", 0, "", c) for c in clips])
    pose, wave = project.clips
    project = edits.add_stance(project, "arms", "their stance", [pose])
    project = edits.place_clips(
        project, [wave], "arms", "gesture", next(iter(project.graphs["arms"].stances))
    )
    save_project(project, folder / f"theirs{SUFFIX}")
    return folder / f"theirs{SUFFIX}"


def shown(drive):
    from app.features.taking.taking_dialog import TakingDialog

    return [d for d in drive.window.findChildren(TakingDialog) if d.isVisible()]


def names(drive):
    return {a.name for a in drive.document.project.actions()}


@pytest.mark.nightly
def test_a_project_is_looked_at_taken_and_taken_back(drive, toy, other, monkeypatch):
    drive.document.edit("Begin", lambda _: toy.project())
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_: (str(other), ""))
    drive.do("import_project")
    drive.wait(lambda: any(d.take.isEnabled() for d in shown(drive)))
    (dialog,) = shown(drive)
    assert [words.split()[0] for words in dialog.summary.text().split(", ")] == ["1", "2", "2"]
    wide = dialog.list.fontMetrics().horizontalAdvance("hands_at_sides__beat_small_rt_01")
    assert dialog.list.columnWidth(0) > wide + 40, (
        "names are not cut, however long the other column's words are"
    )
    before = names(drive)
    QTest.mouseClick(dialog.take, Qt.MouseButton.LeftButton)
    drive.wait(lambda: not shown(drive))
    assert names(drive) == before | {"their pose", "their wave"}
    assert drive.document.undo_stack.undoText() == "Import from theirs"
    drive.document.undo()
    assert names(drive) == before


@pytest.mark.nightly
def test_what_the_dialog_shows_follows_edits_and_cancel_takes_nothing(drive, toy, other, monkeypatch):
    drive.document.edit("Begin", lambda _: toy.project())
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_: (str(other), ""))
    drive.do("import_project")
    drive.wait(lambda: any(d.take.isEnabled() for d in shown(drive)))
    (dialog,) = shown(drive)
    drive.document.edit("A stance of that name", lambda p: edits.add_stance(p, "arms", "their stance"))
    drive.wait(lambda: dialog.summary.text() == "2 new actions, 2 new clips")
    count = drive.document.undo_stack.count()
    QTest.keyClick(dialog, Qt.Key.Key_Escape)
    drive.wait(lambda: not shown(drive))
    assert drive.document.undo_stack.count() == count and "their wave" not in names(drive)


def test_actions_copied_are_pasted_once_and_then_are_here_already(drive, toy):
    drive.document.edit("Begin", lambda _: toy.project())
    drive.session.selection.select_actions((toy.id(drive.document.project, "up point"),))
    drive.do("copy_over")
    assert '"metagraph_piece"' in QApplication.clipboard().text()
    drive.do("paste_over")
    drive.wait(lambda: any(d.summary.text().startswith("Nothing new") for d in shown(drive)))
    (dialog,) = shown(drive)
    assert not dialog.take.isEnabled() and "1 action is already here" in dialog.summary.text()
    dialog.reject()


def test_another_clipboard_is_answered_in_words(drive, toy):
    drive.document.edit("Begin", lambda _: toy.project())
    QApplication.clipboard().setText("hello")
    drive.do("paste_over")
    assert not shown(drive)
