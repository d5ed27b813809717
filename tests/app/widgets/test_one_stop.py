"""Buttons that Tab comes to once, and among which arrows go."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QHBoxLayout, QLineEdit, QToolButton, QWidget

from app.widgets.one_stop import OneStop

pytestmark = pytest.mark.window
TAB, LEFT, RIGHT = Qt.Key.Key_Tab, Qt.Key.Key_Left, Qt.Key.Key_Right


@pytest.fixture
def row(qtbot):
    page = QWidget()
    qtbot.addWidget(page)
    box = QHBoxLayout(page)
    page.before = QLineEdit(page)
    page.buttons = [QToolButton(page) for _ in range(3)]
    page.after = QLineEdit(page)
    for widget in (page.before, *page.buttons, page.after):
        box.addWidget(widget)
    page.stop = OneStop(page.buttons, page, page.buttons[1])
    page.show()
    qtbot.waitExposed(page)
    page.activateWindow()
    page.before.setFocus()
    qtbot.waitUntil(page.before.hasFocus)
    return page


def press(key) -> QWidget:
    QTest.keyClick(QApplication.focusWidget(), key)
    return QApplication.focusWidget()


def test_tab_comes_once_and_arrows_go_round(row):
    first, middle, last = row.buttons
    assert press(TAB) is middle and press(TAB) is row.after
    middle.setFocus()
    assert press(RIGHT) is last and press(RIGHT) is first and press(LEFT) is last
    assert press(TAB) is row.after
    row.before.setFocus()
    assert press(TAB) is last, "it comes back to where it was"


def test_what_cannot_be_pressed_is_passed_over(row):
    first, middle, last = row.buttons
    last.setEnabled(False)
    middle.setFocus()
    assert press(RIGHT) is first
    first.hide()
    middle.setFocus()
    assert press(LEFT) is middle


def test_other_buttons_take_over(row):
    first, _, last = row.buttons
    row.stop.show((first, last))
    row.before.setFocus()
    assert press(TAB) is first
    row.stop.show(())
    assert row.stop.buttons == []


def test_the_space_bar_presses_the_one_that_has_the_keyboard(row):
    pressed = []
    for n, button in enumerate(row.buttons):
        button.clicked.connect(lambda _=False, n=n: pressed.append(n))
    row.buttons[1].setFocus()
    press(RIGHT)
    press(Qt.Key.Key_Space)
    assert pressed == [2]
