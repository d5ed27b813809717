"""File > Compare versions: an earlier version and a colleague's copy beside what is open."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.features.files.compare_dialog import CompareDialog
from app.widgets.tree_items import list_items_below, list_top_items
from metagraph.formats.gltf.writer import write_glb
from metagraph.formats.store import SUFFIX, save_project
from metagraph.graph import edits
from metagraph.graph.model import Project

pytestmark = [pytest.mark.window, pytest.mark.gl]


@pytest.fixture
def dialog(drive, toy, tmp_path: Path) -> CompareDialog:
    """The dialog on a project that was saved, then got a stance."""
    (tmp_path / "clips").mkdir()
    write_glb(tmp_path / "clips" / "wave.glb", [toy.clip("wave", 1.0)])
    path = tmp_path / f"mine{SUFFIX}"
    save_project(Project("mine"), path)
    drive.files.open(path)
    drive.wait(lambda: drive.document.path == path)
    drive.importing.import_paths([str(tmp_path / "clips")])
    drive.wait(lambda: bool(drive.document.project.clips))
    drive.files.save()
    assert drive.files.saver.wait()
    clip = next(iter(drive.document.project.clips))
    drive.document.edit("Place", lambda p: edits.add_stance(p, "arms", "waving", [clip]))
    drive.do("compare")
    drive.wait(lambda: any(d.isVisible() for d in drive.window.findChildren(CompareDialog)))
    dialog = next(d for d in drive.window.findChildren(CompareDialog) if d.isVisible())
    drive.wait(lambda: dialog.found is not None)
    return dialog


def listed(dialog: CompareDialog) -> dict[str, list[str]]:
    return {t.text(0): [i.text(0) for i in list_items_below(t)] for t in list_top_items(dialog.tree)}


def test_what_is_new_since_a_version_is_listed_and_moves_on_its_side_alone(dialog: CompareDialog) -> None:
    assert dialog.choice.currentText().startswith("Version 1")
    new = next(iter(listed(dialog).values()))
    assert "Clip 'wave' added" in new and "Stance 'waving' (arms) added" in new
    assert dialog.figures.left is None and dialog.figures.right is not None
    assert dialog.figures.words == ("Not there then", "Now")
    QTest.keyClick(dialog.tree, Qt.Key.Key_Down)
    assert dialog.words.text() == new[1], "the arrows go through them"
    dialog.reject()


def test_another_file_is_compared_too(drive, dialog: CompareDialog, tmp_path: Path) -> None:
    copy = tmp_path / f"theirs{SUFFIX}"
    theirs = edits.rename_stance(
        drive.document.project, next(iter(drive.document.project.graphs["arms"].stances)), "greeting"
    )
    save_project(theirs, copy)
    dialog.add_file(copy)
    drive.wait(lambda: dialog.found is not None)
    assert listed(dialog) == {"Changed: 1": ["Stance 'waving' (arms) changed: name 'greeting' → 'waving'"]}
    assert dialog.figures.left is not None and dialog.figures.right is not None
    assert dialog.summary.text() == "0 new, 0 gone, 1 changed"
    dialog.reject()


def test_a_file_that_cannot_be_read_is_told(drive, dialog: CompareDialog, tmp_path: Path) -> None:
    broken = tmp_path / f"broken{SUFFIX}"
    broken.write_text("clips: 3\n", encoding="utf-8")
    dialog.add_file(broken)
    drive.wait(lambda: f"broken{SUFFIX}" in dialog.summary.text())
    assert not listed(dialog)
    dialog.reject()
