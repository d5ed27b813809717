"""The table whose last column is chosen from a menu."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from app.features.models.meaning_choices import ChoiceTable, MeaningRow
from app.project.document import Document
from app.stage.session import StageSession

ENTRIES = [("Left arm", "left", "tells more"), ("Body", "body", ""), ("Ignore", None, "")]


@pytest.fixture
def table(qtbot):
    widget = ChoiceTable(
        StageSession(Document()), "Tiers", ("Tier", "Times", "Read as"), 120, lambda row: ENTRIES, None
    )
    qtbot.addWidget(widget)
    widget.resize(420, 300)
    widget.show_rows(
        [MeaningRow(("LH", "3"), "Left arm", tip="three"), MeaningRow(("words", "9"), "Ignore", dim=True)]
    )
    widget.show()
    qtbot.waitExposed(widget)
    widget.told = []
    widget.chosen.connect(lambda row, value: widget.told.append((row, value)))
    yield widget


def field(table, row: int) -> QPoint:
    return table.visualRect(table.model().index(row, 2)).center()


def popup(qtbot):
    qtbot.waitUntil(lambda: QApplication.activePopupWidget() is not None)
    return QApplication.activePopupWidget()


def test_a_click_on_the_field_opens_the_menu_and_what_is_chosen_is_told(table, qtbot):
    QTest.mouseClick(
        table.viewport(), Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, field(table, 1)
    )
    menu = popup(qtbot)
    assert [(a.text(), a.isChecked()) for a in menu.actions()] == [
        ("Left arm", False),
        ("Body", False),
        ("Ignore", True),
    ]
    assert menu.actions()[0].toolTip() == "tells more"
    menu.actions()[1].trigger()
    assert table.told == [(1, "body")]
    menu.close()


def test_a_click_beside_the_field_opens_nothing(table, qtbot):
    QTest.mouseClick(
        table.viewport(),
        Qt.MouseButton.LeftButton,
        Qt.KeyboardModifier.NoModifier,
        QPoint(30, field(table, 0).y()),
    )
    qtbot.wait(30)
    assert QApplication.activePopupWidget() is None


@pytest.mark.parametrize("key", [Qt.Key.Key_Return, Qt.Key.Key_Space, Qt.Key.Key_F4])
def test_keys_open_it_too_and_arrows_choose(table, qtbot, key):
    table.setFocus()
    table.setCurrentItem(table.topLevelItem(0))
    QTest.keyClick(table, Qt.Key.Key_Down)
    QTest.keyClick(table, key)
    menu = popup(qtbot)
    QTest.keyClick(menu, Qt.Key.Key_Down)
    QTest.keyClick(menu, Qt.Key.Key_Return)
    assert table.told == [(1, "left")]


def test_the_current_row_stays_when_rows_are_shown_anew_and_no_rows_are_said_in_words(table):
    table.setCurrentItem(table.topLevelItem(1))
    table.show_rows(list(table.rows))
    assert table.currentIndex().row() == 1
    table.show_rows([], "Nothing here.")
    assert table.topLevelItem(0).text(0) == "Nothing here."
    table.open_menu(0)
    assert QApplication.activePopupWidget() is None
    assert not table.grab().isNull()
