"""Many actions edited together through the real window: names, pasted properties, another clip; each one step
to undo.
"""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

pytestmark = [pytest.mark.window, pytest.mark.gl]


def dialog_of(drive, kind):
    drive.pause(60)
    return drive.window.findChildren(kind)[-1]


def click(drive, box):
    QTest.mouseClick(box, Qt.MouseButton.LeftButton, pos=QPoint(8, box.height() // 2))


def select(drive, *names: str) -> tuple[str, ...]:
    ids = tuple(drive.id(name) for name in names)
    drive.session.selection.select_actions(ids)
    drive.pause(30)
    return ids


def test_f2_on_many_renames_by_a_pattern_that_is_seen_before(toys):
    from app.features.editing.batch_dialogs import RenameDialog

    drive = toys
    ids = select(drive, "rest short", "rest long")
    drive.actions["rename"].trigger()
    dialog = dialog_of(drive, RenameDialog)
    dialog.pattern.selectAll()
    QTest.keyClicks(dialog.pattern, "beat {n:02}")
    assert [dialog.preview.topLevelItem(n).text(1) for n in range(2)] == ["beat 01", "beat 02"]
    QTest.mouseClick(dialog.go, Qt.MouseButton.LeftButton)
    assert [drive.document.project.action(i).name for i in ids] == ["beat 01", "beat 02"]
    drive.actions["undo"].trigger()
    assert [drive.document.project.action(i).name for i in ids] == ["rest short", "rest long"]


def test_a_pattern_that_cannot_be_read_is_told_and_not_done(toys):
    from app.features.editing.batch_dialogs import RenameDialog

    drive = toys
    select(drive, "rest short", "rest long")
    drive.actions["rename"].trigger()
    dialog = dialog_of(drive, RenameDialog)
    dialog.pattern.setText("{colour}")
    assert (
        "'{colour}'" in dialog.trouble.text()
        and "{name}" in dialog.trouble.text()
        and not dialog.go.isEnabled()
    )
    dialog.tabs.setCurrentIndex(1)
    assert not dialog.trouble.text() and not dialog.go.isEnabled()
    QTest.keyClicks(dialog.sought, "rest ")
    assert dialog.go.isEnabled()
    QTest.mouseClick(dialog.go, Qt.MouseButton.LeftButton)
    assert {a.name for a in drive.document.project.actions()} >= {"short", "long"}


@pytest.mark.nightly
def test_copied_properties_are_pasted_in_the_chosen_groups(toys):
    from app.features.editing.batch_dialogs import PasteDialog
    from metagraph.graph import edits

    drive = toys
    source = drive.id("rest short")
    drive.document.edit("Tags", lambda p: edits.update_actions(p, [source], tags=("loud",), likelihood=2.5))
    assert not drive.actions["paste"].isEnabled()
    select(drive, "rest short")
    drive.actions["copy"].trigger()
    ids = select(drive, "rest long", "rest wave rt")
    drive.actions["paste"].trigger()
    dialog = dialog_of(drive, PasteDialog)
    assert dialog.boxes["tags"].isChecked() and not dialog.boxes["likelihood"].isChecked()
    click(drive, dialog.boxes["blends"])
    QTest.mouseClick(dialog.go, Qt.MouseButton.LeftButton)
    for ident in ids:
        assert drive.document.project.action(ident).tags == ("loud",)
        assert drive.document.project.action(ident).likelihood == 1.0
    drive.actions["undo"].trigger()
    assert drive.document.project.action(ids[0]).tags == ()


def test_a_clip_is_replaced_and_settings_stay(toys):
    from app.features.editing.batch_dialogs import ReplaceDialog

    drive = toys
    (ident,) = select(drive, "rest long")
    drive.actions["replace_clip"].trigger()
    dialog = dialog_of(drive, ReplaceDialog)
    dialog.clips.setEditText("no such clip")
    QTest.mouseClick(dialog.go, Qt.MouseButton.LeftButton)
    assert "'no such clip'" in dialog.trouble.text()
    dialog.clips.setEditText("up point")
    QTest.mouseClick(dialog.go, Qt.MouseButton.LeftButton)
    action = drive.document.project.action(ident)
    assert drive.document.project.clips[action.clip].name == "up point" and action.name == "rest long"


def test_the_menu_of_an_action_offers_them(toys):
    drive = toys
    assert [a.objectName() for a in drive.canvas.row_actions] == [
        "rename",
        "copy",
        "paste",
        "replace_clip",
        "twins",
        "copy_over",
        "note",
        "list_earlier",
        "list_later",
    ]
