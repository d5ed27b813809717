"""Of buttons side by side one is pressed, or none where values differ."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QWidget

from app.widgets.choice_row import ChoiceRow, LimbRow
from app.widgets.form_fields import Mixed
from metagraph.graph.model import LIMBS


def pressed(row: ChoiceRow) -> list[int]:
    return [n for n in range(len(row.group.buttons())) if row.button(n).isChecked()]


@pytest.fixture
def row(qtbot) -> Iterator[ChoiceRow]:
    page = QWidget()
    qtbot.addWidget(page)
    yield ChoiceRow(page, [("One", "first"), ("Two", "second"), ("Three", "third")])


def test_showing_a_choice_presses_it_alone_and_tells_nothing(row):
    told: list[int] = []
    row.chosen.connect(told.append)
    assert pressed(row) == []
    for place in (0, 2, None, 1):
        row.show_choice(place)
        assert pressed(row) == ([] if place is None else [place])
    assert told == []


def test_a_click_is_told_and_presses_that_button_alone_also_where_none_was(row):
    told: list[int] = []
    row.chosen.connect(told.append)
    row.show_choice(0)
    QTest.mouseClick(row.button(2), Qt.MouseButton.LeftButton)
    assert told == [2] and pressed(row) == [2]
    row.show_choice(None)
    QTest.mouseClick(row.button(1), Qt.MouseButton.LeftButton)
    assert told == [2, 1] and row.button(1).isChecked()


def test_limbs_that_differ_press_none(qtbot):
    page = QWidget()
    qtbot.addWidget(page)
    row = LimbRow(page, "stance")
    for limb in LIMBS:
        row.show_limb(limb)
        assert pressed(row) == [LIMBS.index(limb)]
    row.show_limb(Mixed)
    assert pressed(row) == []
    assert "right arm; the other arm follows the stance" in " ".join(b.toolTip() for b in row.group.buttons())
