"""Scrolling passes fields by; what is held or scrolled is one step."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QWheelEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QStyle, QStyleOptionSpinBox, QVBoxLayout, QWidget

from app.widgets.form_fields import QuietChooser, Seconds
from app.widgets.quiet_fields import ComboBox, DoubleSpinBox, Slider, SpinBox

APP = Path(__file__).resolve().parents[3] / "app"


def scroll(widget: QWidget, notches: int) -> bool:
    """Turn the wheel over a widget as the system does, a notch at a time; return whether the last was
    taken.
    """
    at = QPointF(widget.rect().center())
    for _ in range(abs(notches)):
        event = QWheelEvent(
            at, QPointF(widget.mapToGlobal(at.toPoint())), QPoint(), QPoint(0, 120 if notches > 0 else -120),
            Qt.MouseButton.NoButton, Qt.KeyboardModifier.NoModifier, Qt.ScrollPhase.NoScrollPhase, False,
        )  # fmt: skip
        QApplication.sendEvent(widget, event)
    return event.isAccepted()


@pytest.fixture
def page(qtbot):
    window = QWidget()
    window.column = QVBoxLayout(window)
    qtbot.addWidget(window)

    def add(widget: QWidget) -> QWidget:
        window.column.addWidget(widget)
        return widget

    window.add = add
    return window


def shown(page, qtbot):
    page.other = page.add(QWidget())
    page.other.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
    page.show()
    qtbot.waitExposed(page)
    page.activateWindow()
    page.other.setFocus()
    qtbot.waitUntil(page.other.hasFocus)


@pytest.mark.parametrize("kind", [SpinBox, DoubleSpinBox, Seconds, Slider, ComboBox, QuietChooser])
def test_a_field_without_the_focus_lets_the_wheel_pass_and_stays_as_it_is(page, qtbot, kind):
    if kind in (Seconds, QuietChooser):
        field = page.add(kind(page, "tip"))
    else:
        field = page.add(kind(page))
    told = []
    if isinstance(field, ComboBox):
        field.addItems(["one", "two", "three"])
        field.activated.connect(told.append)
        before = field.currentIndex()
    else:
        field.setRange(0, 100)
        field.setValue(50)
        field.valueChanged.connect(told.append)
        before = field.value()
    shown(page, qtbot)
    for notches in (3, -5):
        assert not scroll(field, notches)
    qtbot.wait(300)
    assert told == [] and before == (field.currentIndex() if isinstance(field, ComboBox) else field.value())
    assert not field.hasFocus(), "the wheel gives no focus either"


@pytest.mark.parametrize("kind", [SpinBox, DoubleSpinBox, Slider])
def test_scrolling_a_field_that_has_the_focus_is_told_once(page, qtbot, kind):
    field = page.add(kind(page))
    field.setRange(0, 100)
    field.setValue(50)
    told = []
    field.valueChanged.connect(told.append)
    shown(page, qtbot)
    field.setFocus()
    assert scroll(field, 4)
    assert field.value() > 50 and told == []
    qtbot.waitUntil(lambda: bool(told), timeout=2000)
    assert told == [field.value()]


def test_a_run_of_the_wheel_that_comes_back_tells_nothing(page, qtbot):
    field = page.add(SpinBox(page))
    field.setValue(7)
    told = []
    field.valueChanged.connect(told.append)
    shown(page, qtbot)
    field.setFocus()
    scroll(field, 2)
    scroll(field, -2)
    qtbot.wait(350)
    assert field.value() == 7 and told == []


@pytest.mark.parametrize("kind", [SpinBox, DoubleSpinBox, Slider])
def test_a_key_that_is_held_is_one_step(page, qtbot, kind):
    field = page.add(kind(page))
    field.setValue(10)
    told = []
    field.valueChanged.connect(told.append)
    shown(page, qtbot)
    field.setFocus()
    for _ in range(5):
        QTest.keyPress(field, Qt.Key.Key_Up)
    assert told == []
    QTest.keyRelease(field, Qt.Key.Key_Up)
    assert told == [15]


def test_leaving_the_field_tells_what_was_held_back(page, qtbot):
    field = page.add(SpinBox(page))
    field.setValue(10)
    told = []
    field.valueChanged.connect(told.append)
    shown(page, qtbot)
    field.setFocus()
    scroll(field, 1)
    page.other.setFocus()
    assert told == [11]


def test_typing_a_number_is_told_as_ever(page, qtbot):
    field = page.add(Seconds(page, "tip"))
    told = []
    field.valueChanged.connect(told.append)
    shown(page, qtbot)
    field.setFocus()
    field.selectAll()
    QTest.keyClicks(field, "1.25")
    QTest.keyClick(field, Qt.Key.Key_Return)
    assert told == [1.25]


@pytest.fixture
def bare_style(qapp):
    """The application without the program's look, which has no arrows to hold."""
    sheet = qapp.styleSheet()
    qapp.setStyleSheet("")
    yield
    qapp.setStyleSheet(sheet)


@pytest.mark.nightly
def test_an_arrow_that_is_held_with_the_mouse_is_one_step(bare_style, page, qtbot):
    field = page.add(SpinBox(page))
    field.setValue(10)
    told = []
    field.valueChanged.connect(told.append)
    shown(page, qtbot)
    option = QStyleOptionSpinBox()
    field.initStyleOption(option)
    arrow = QStyle.SubControl.SC_SpinBoxUp
    at = field.style().subControlRect(QStyle.ComplexControl.CC_SpinBox, option, arrow, field).center()
    QTest.mousePress(field, Qt.MouseButton.LeftButton, pos=at)
    qtbot.waitUntil(lambda: field.value() >= 13)  # held, it goes on by itself
    assert told == []
    QTest.mouseRelease(field, Qt.MouseButton.LeftButton, pos=at)
    assert told == [field.value()]


def test_no_field_of_the_program_is_one_of_qts_own():
    made = re.compile(r"(?<![\w.])Q(ComboBox|SpinBox|DoubleSpinBox|Slider|Dial)\(")
    for file in APP.rglob("*.py"):
        if file.name != "quiet_fields.py":
            found = made.search(file.read_text(encoding="utf-8"))
            assert found is None, f"{file.relative_to(APP)} makes a {found[0]}): scrolling would change it"
