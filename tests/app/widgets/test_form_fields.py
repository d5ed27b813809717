"""Fields that show many values at once, and hand keys back."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QWidget

from app.widgets.form_fields import MIXED, Field, Mixed, QuietChooser, Seconds, find_common_value


def test_common_is_the_value_all_share_or_mixed():
    assert find_common_value([1]) == 1
    assert find_common_value([None, None]) is None
    assert find_common_value([1, 1.0]) == 1
    assert find_common_value([1, 2]) is Mixed
    assert find_common_value([None, 0]) is Mixed
    assert repr(Mixed) == "mixed"


@pytest.fixture
def seconds(qtbot):
    page = QWidget()
    qtbot.addWidget(page)
    yield Seconds(page, "Blend in")


def test_mixed_is_shown_in_words_and_stepping_sets_all(seconds):
    told = []
    seconds.valueChanged.connect(told.append)
    seconds.show_value(Mixed)
    assert seconds.text() == MIXED
    assert told == [], "showing is not setting"
    seconds.stepBy(1)
    assert told == [0.0]


def test_showing_the_same_number_again_takes_back_what_is_being_typed(seconds):
    seconds.show_value(0.25)
    seconds.lineEdit().setText("0.9")
    seconds.lineEdit().setModified(True)
    seconds.show_value(0.25)
    assert seconds.text() == "0.25 s"


def test_stepping_down_stops_at_nothing_rather_than_at_mixed(seconds):
    seconds.show_value(0.03)
    seconds.stepBy(-1)
    seconds.stepBy(-5)
    assert seconds.value() == 0.0
    assert seconds.text() == "0.00 s"


def test_typing_counts_when_it_is_finished_and_escape_takes_it_back(seconds):
    told = []
    seconds.valueChanged.connect(told.append)
    seconds.show_value(0.5)
    seconds.selectAll()
    QTest.keyClicks(seconds, "1.25")
    assert told == []
    QTest.keyClick(seconds, Qt.Key.Key_Escape)
    assert seconds.text() == "0.50 s"
    seconds.selectAll()
    QTest.keyClicks(seconds, "1.25")
    QTest.keyClick(seconds, Qt.Key.Key_Return)
    assert told == [1.25]


def test_a_name_being_typed_stays_until_something_else_is_selected(qtbot, monkeypatch):
    field = Field(None, "Name of the action", "Name")
    qtbot.addWidget(field)
    field.show_text("wave", of="a1")
    monkeypatch.setattr(field, "hasFocus", lambda: True)
    QTest.keyClicks(field, "!")
    field.show_text("wave", of="a1")
    assert field.text() == "wave!"
    field.show_text("nod", of="a2")
    assert field.text() == "nod", "or the new one would get the old one's name"


def test_a_chooser_shows_what_is_set_and_says_nothing_itself(qtbot):
    page = QWidget()
    qtbot.addWidget(page)
    chooser, told = QuietChooser(page, toolTip="Stance"), []
    chooser.currentIndexChanged.connect(told.append)
    chooser.show_entries([("rest", "s1"), ("up", "s2")], "s2")
    assert chooser.currentData() == "s2"
    chooser.show_entries([("rest", "s1"), ("up", "s2")], "gone", "choose a stance")
    assert chooser.currentIndex() == -1
    assert chooser.placeholderText() == "choose a stance"
    chooser.show_entries([("rest", "s1"), ("same", "s2"), ("same", "s3")], "s3")
    assert chooser.currentIndex() == 2, "names need not differ"
    assert told == []
