"""What an import repaired, seen and left out one by one through the real window."""

from __future__ import annotations

from dataclasses import replace

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

pytestmark = [pytest.mark.usefixtures("numbered_ids"), pytest.mark.window, pytest.mark.gl]


@pytest.fixture
def folder(toy, tmp_path):
    """Two clips with a bind pose on their first frame, and a file with one of one frame beside a walk."""
    from metagraph.formats.gltf.writer import write_glb

    for name in ("a", "b"):
        clip = toy.clip(name, 1.0, 1.3)
        rotations = clip.rotations.copy()
        rotations[0] = toy.skeleton.rest_rotations
        write_glb(tmp_path / f"{name}.glb", [replace(clip, rotations=rotations)])
    walk = toy.clip("walk", 0.5)
    bind = replace(walk.trimmed(0, 1).renamed("Take 001"), rotations=toy.skeleton.rest_rotations[None])
    write_glb(tmp_path / "c.glb", [bind, walk])
    return tmp_path


def shown(drive):
    from app.features.repairs.repairs_dialog import RepairsDialog

    return [d for d in drive.window.findChildren(RepairsDialog) if d.isVisible()]


@pytest.fixture
def dialog(drive, folder):
    drive.importing.import_paths([str(folder)])
    notice = drive.notice
    drive.wait(notice.isVisible)
    assert not shown(drive), "nothing may stand in the way of who goes on working"
    assert "repaired" in notice.text()
    QTest.mouseClick(notice, Qt.MouseButton.LeftButton)
    (found,) = shown(drive)
    assert not notice.isVisible()
    return found


def tick(dialog, group, row):
    """Click the box of a row."""
    top = next(
        t
        for n in range(dialog.tree.topLevelItemCount())
        if (t := dialog.tree.topLevelItem(n)).text(0).startswith(group)
    )
    rect = dialog.tree.visualItemRect(top.child(row))
    QTest.mouseClick(
        dialog.tree.viewport(), Qt.MouseButton.LeftButton, pos=QPoint(rect.left() + 10, rect.center().y())
    )


def apply(drive, dialog):
    project = drive.document.project
    QTest.mouseClick(dialog.go, Qt.MouseButton.LeftButton)
    drive.wait(lambda: drive.document.project is not project)


@pytest.mark.nightly
def test_an_import_tells_each_repair_and_one_is_left_out_in_one_step(drive, folder, dialog):
    assert dialog.headline.text() == "Imported 3 clips"
    groups = [dialog.tree.topLevelItem(n).text(0) for n in range(dialog.tree.topLevelItemCount())]
    assert [words.split()[0] + words[-4:] for words in groups] == ["Remove (2)", "Skip (1)"]
    assert not dialog.go.isEnabled()
    before = drive.document.project.clips["c1"].frames
    tick(dialog, "Remove", 0)
    assert dialog.go.text() == "Apply 1 change"
    apply(drive, dialog)
    project = drive.document.project
    assert project.clips["c1"].frames == before + 1 and project.clips["c1"].as_is == ("bind_pose",)
    assert project.clips["c2"].as_is == ()
    assert not dialog.go.isEnabled()
    assert drive.document.undo_stack.undoText() == "Revert 1 repair"
    drive.actions["undo"].trigger()
    assert drive.document.project.clips["c1"].frames == before


@pytest.mark.nightly
@pytest.mark.parametrize("way", ["reject", "close"])
def test_what_was_applied_is_done_though_the_dialog_is_closed_at_once(drive, dialog, way):
    before = drive.document.project.clips["c1"].frames
    tick(dialog, "Remove", 0)
    dialog.go.click()
    getattr(dialog, way)()
    drive.wait(lambda: drive.document.project.clips["c1"].frames == before + 1)
    assert not shown(drive)


@pytest.mark.nightly
def test_a_skipped_pose_is_brought_in_and_skipped_again(drive, dialog):
    top = dialog.tree.topLevelItem(1)
    assert top.child(0).text(0) == "c.glb" and "skipped 'c'" in top.child(0).text(1)
    tick(dialog, "Skip", 0)
    apply(drive, dialog)
    assert [e.name for e in drive.document.project.clips.values()] == ["a", "b", "walk", "c"]
    tick(dialog, "Skip", 0)
    apply(drive, dialog)
    assert [e.name for e in drive.document.project.clips.values()] == ["a", "b", "walk"]


def test_a_click_on_a_group_is_a_click_on_all_of_it(drive, dialog):
    top = dialog.tree.topLevelItem(0)
    rect = dialog.tree.visualItemRect(top)
    QTest.mouseClick(
        dialog.tree.viewport(), Qt.MouseButton.LeftButton, pos=QPoint(rect.left() + 10, rect.center().y())
    )
    assert dialog.go.text() == "Apply 2 changes"
    apply(drive, dialog)
    assert [e.as_is for e in drive.document.project.clips.values()] == [("bind_pose",), ("bind_pose",), ()]


@pytest.mark.nightly
def test_the_dialog_opens_again_for_what_is_selected(drive, dialog):
    QTest.mouseClick(dialog.buttons.button(dialog.buttons.StandardButton.Close), Qt.MouseButton.LeftButton)
    drive.wait(lambda: not shown(drive))
    drive.session.selection.select_clips(("c2",))
    drive.actions["repairs"].trigger()
    (again,) = shown(drive)
    assert again.headline.text() == "Repairs of 1 clip" and len(again.found) == 1
    drive.session.selection.select_clips(("c3",))
    again.close()


def test_a_file_that_went_away_is_told_in_the_dialog(drive, folder, dialog):
    (folder / "a.glb").unlink()
    tick(dialog, "Remove", 0)
    project = drive.document.project
    QTest.mouseClick(dialog.go, Qt.MouseButton.LeftButton)
    drive.wait(lambda: dialog.trouble.isVisible())
    assert "is missing" in dialog.trouble.text() and drive.document.project is project


def test_a_file_that_could_not_be_read_is_told_in_the_same_dialog(drive, folder):
    (folder / "bad.bvh").write_text("noise")
    drive.importing.import_paths([str(folder)])
    drive.wait(drive.notice.isVisible)
    assert not shown(drive)
    QTest.mouseClick(drive.notice, Qt.MouseButton.LeftButton)
    (dialog,) = shown(drive)
    assert "bad.bvh" in dialog.lines.toPlainText()


def test_the_notice_goes_with_the_project_it_was_about(drive, folder):
    from metagraph.graph.model import Project

    drive.importing.import_paths([str(folder)])
    drive.wait(drive.notice.isVisible)
    drive.document.load(Project(), None)
    assert not drive.notice.isVisible()


def test_clips_without_repairs_say_so(drive, toy, tmp_path):
    from metagraph.formats.gltf.writer import write_glb

    write_glb(tmp_path / "n.glb", [toy.clip("n", 0.5)])
    drive.importing.import_paths([str(tmp_path)])
    drive.wait(lambda: len(drive.document.project.clips) == 1)
    assert not shown(drive) and not drive.notice.isVisible()
    drive.actions["repairs"].trigger()
    (dialog,) = shown(drive)
    assert "needed no repairs" in dialog.words.text()
    drive.pause(30)
    assert dialog.headline.y() < 60 and dialog.words.y() < 120, "they stand at the top, not in the middle"
