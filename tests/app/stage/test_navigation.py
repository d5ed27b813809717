"""The mouse moves the camera as in the program that the user chose."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QWheelEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from app.stage.navigation import NAVIGATIONS, choose_navigation, get_navigation

LEFT, MIDDLE, RIGHT = Qt.MouseButton.LeftButton, Qt.MouseButton.MiddleButton, Qt.MouseButton.RightButton
NONE, SHIFT = Qt.KeyboardModifier.NoModifier, Qt.KeyboardModifier.ShiftModifier
CTRL, ALT = Qt.KeyboardModifier.ControlModifier, Qt.KeyboardModifier.AltModifier


@pytest.mark.parametrize(
    ("program", "button", "held", "move"),
    [
        ("usual", LEFT, NONE, "orbit"),
        ("usual", LEFT, SHIFT, "pan"),
        ("usual", MIDDLE, NONE, "pan"),
        ("blender", MIDDLE, NONE, "orbit"),
        ("blender", MIDDLE, SHIFT, "pan"),
        ("blender", MIDDLE, CTRL, "zoom"),
        ("maya", LEFT, ALT, "orbit"),
        ("maya", MIDDLE, ALT, "pan"),
        ("maya", RIGHT, ALT, "zoom"),
        ("maya", RIGHT, NONE, None),
        ("unreal", RIGHT, NONE, "orbit"),
        ("unreal", MIDDLE, NONE, "pan"),
        ("unreal", RIGHT, ALT, "zoom"),
        ("touchpad", LEFT, NONE, "orbit"),
        ("pen", LEFT, NONE, "orbit"),
        ("pen", RIGHT, NONE, "pan"),
    ],
)
def test_each_program_has_its_own_drags(program, button, held, move):
    assert NAVIGATIONS[program].move_of(button, held) == move
    assert NAVIGATIONS[program].move_of(button, held | Qt.KeyboardModifier.KeypadModifier) == move


def test_what_is_kept_and_no_longer_there_is_the_usual_one(qapp):
    with pytest.raises(KeyError):
        choose_navigation("softimage")
    assert get_navigation().id == "usual"


def drag(view, button, held=NONE):
    start = view.rect().center()
    QTest.mousePress(view, button, held, start)
    before = view.camera
    moved = QPointF(start + QPoint(40, 25))
    from PySide6.QtCore import QEvent
    from PySide6.QtGui import QMouseEvent

    event = QMouseEvent(QEvent.Type.MouseMove, moved, view.mapToGlobal(moved), button, button, held)
    QApplication.sendEvent(view, event)
    QTest.mouseRelease(view, button, held, start)
    return before, view.camera


@pytest.mark.nightly
@pytest.mark.window
@pytest.mark.gl
def test_a_drag_with_the_middle_button_orbits_as_in_blender_once_it_is_chosen(toys):
    view = toys.preview.view
    before, after = drag(view, MIDDLE)
    assert after.target != before.target and after.yaw == before.yaw, "it pans"
    try:
        menu = toys.actions["navigation"].menu()
        menu.aboutToShow.emit()
        next(a for a in menu.actions() if a.text() == "Blender").trigger()
        assert "middle button" in view.toolTip()
        before, after = drag(view, MIDDLE)
        assert after.target == before.target and after.yaw != before.yaw, "it orbits"
        before, after = drag(view, MIDDLE, CTRL)
        assert after.distance != before.distance
        choose_navigation("touchpad")
        before = view.camera
        at = QPointF(view.rect().center())
        scroll = QWheelEvent(
            at, view.mapToGlobal(at), QPoint(30, 10), QPoint(), Qt.MouseButton.NoButton, NONE,
            Qt.ScrollPhase.ScrollUpdate, False,
        )  # fmt: skip
        QApplication.sendEvent(view, scroll)
        assert view.camera.yaw != before.yaw and view.camera.distance == before.distance
    finally:
        choose_navigation("usual")
