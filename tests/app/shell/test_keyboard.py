"""Commands have their keys whatever has the focus, and dialogs give it back."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QAbstractSpinBox, QApplication, QComboBox, QDialog, QLineEdit, QVBoxLayout

from metagraph.graph import edits

pytestmark = [pytest.mark.window, pytest.mark.gl]
CTRL = Qt.KeyboardModifier.ControlModifier


def fields(drive):
    drive.session.selection.select_actions((next(drive.document.project.actions().__iter__()).id,))
    panel = drive.properties.action
    return (drive.library.search, drive.canvas, panel.name, panel.start, panel.stance, drive.library.list)


@pytest.mark.nightly
def test_a_commands_key_is_its_own_wherever_the_focus_is(toys):
    drive = toys
    done = []
    for ident in ("export", "compatibility", "workspace_2", "page_of_panel"):
        drive.actions[ident].triggered.disconnect()
        drive.actions[ident].triggered.connect(lambda *_, i=ident: done.append(i))
    try:
        drive.actions.refresh()
        for field in fields(drive):
            done.clear()
            field.setFocus()
            drive.wait(lambda f=field: QApplication.focusWidget() in (f, f.focusProxy()))
            focus = QApplication.focusWidget()
            QTest.keyClick(focus, Qt.Key.Key_E, CTRL)
            QTest.keyClick(focus, Qt.Key.Key_K, CTRL)
            QTest.keyClick(focus, Qt.Key.Key_2, CTRL | Qt.KeyboardModifier.AltModifier)
            QTest.keyClick(focus, Qt.Key.Key_F1)
            assert done == ["export", "compatibility", "workspace_2", "page_of_panel"], type(field).__name__
    finally:
        for command in drive.actions.commands:
            if command.id in ("export", "compatibility", "workspace_2", "page_of_panel"):
                action = drive.actions[command.id]
                action.triggered.disconnect()
                action.triggered.connect(lambda _=False, run=command.run: run())


@pytest.mark.nightly
def test_what_a_field_does_with_its_own_text_stays_the_fields(toys):
    field = toys.library.search
    field.setFocus()
    toys.wait(field.hasFocus)
    QTest.keyClicks(field, "a 1 b")
    assert field.text() == "a 1 b", "letters and numbers are typed"
    QTest.keyClick(field, Qt.Key.Key_A, CTRL)
    assert field.selectedText() == "a 1 b"
    QTest.keyClick(field, Qt.Key.Key_Z, CTRL)
    assert field.text() != "a 1 b"


@pytest.mark.nightly
def test_a_key_that_comes_in_one_go_with_an_edit_can_take_it_back(toys):
    drive = toys
    before = drive.document.project
    drive.window.setFocus()
    drive.canvas.setFocus()  # the window is listened to still
    drive.document.edit("Add a stance", lambda p: edits.add_stance(p, "arms", "new"))
    QTest.keyClick(drive.window, Qt.Key.Key_Z, CTRL)
    assert drive.document.project is before


@pytest.mark.nightly
@pytest.mark.parametrize("modal", [False, True])
def test_a_dialog_gives_the_focus_back(toys, modal):
    drive = toys
    drive.canvas.setFocus()
    drive.wait(drive.canvas.hasFocus)
    dialog = QDialog(drive.window)
    dialog.setModal(modal)
    inner = QLineEdit(dialog)
    QVBoxLayout(dialog).addWidget(inner)
    dialog.show()
    dialog.activateWindow()
    inner.setFocus()
    drive.wait(inner.hasFocus)
    dialog.accept()
    drive.wait(drive.canvas.hasFocus)
    dialog.deleteLater()


@pytest.mark.nightly
@pytest.mark.parametrize("where", ["clips", "canvas"])
def test_the_number_pad_turns_the_view_and_labels_nothing(toys, where):
    drive = toys
    field = drive.library.list if where == "clips" else drive.canvas
    drive.session.selection.select_clips((next(iter(drive.document.project.clips)),))
    field.setFocus()
    drive.wait(field.hasFocus)
    before, done = drive.document.project, []
    action = drive.actions["see_front"]
    action.triggered.connect(lambda: done.append("front"))
    QTest.keyClick(field, Qt.Key.Key_1, Qt.KeyboardModifier.KeypadModifier)
    assert done == ["front"]
    assert drive.document.project is before


@pytest.mark.nightly
def test_the_number_pad_types_numbers_in_a_field(toys):
    field = toys.library.search
    field.setFocus()
    toys.wait(field.hasFocus)
    QTest.keyClick(field, Qt.Key.Key_1, Qt.KeyboardModifier.KeypadModifier)
    assert field.text() == "1"


def test_the_space_bar_plays_after_something_was_chosen_from_a_list(toys):
    drive = toys
    drive.session.selection.select_actions((next(iter(drive.document.project.actions())).id,))
    chooser = drive.properties.action.stance
    chooser.setFocus()
    drive.wait(chooser.hasFocus)
    playing = drive.session.transport.playing
    QTest.keyClick(chooser, Qt.Key.Key_Space)
    assert drive.session.transport.playing is not playing
    assert not chooser.view().isVisible()


@pytest.mark.nightly
@pytest.mark.fresh_window
def test_no_field_has_the_focus_when_the_window_opens(toys):
    focus = toys.window.focusWidget()
    assert focus is None or not isinstance(focus, QLineEdit | QAbstractSpinBox | QComboBox)
