"""What the mouse holds: drags, clicks, and gestures that go on until the mouse is pressed again."""

import pytest
from PySide6.QtCore import QEvent, QPointF, Qt
from PySide6.QtGui import QMouseEvent

from app.widgets.gesture import PointerHand, PressDrag, Reason

LEFT, RIGHT = Qt.MouseButton.LeftButton, Qt.MouseButton.RightButton


class Noted(PressDrag):
    """Notes what it is reported."""

    catch = 3.0

    def __init__(self, sticky: bool = False) -> None:
        super().__init__()
        self.begun = self.sticky = sticky
        self.told: list[str] = []

    def update(self, at: QPointF, free: bool = False) -> None:
        self.caught(at)

    def finish(self, at: QPointF) -> None:
        self.told.append("finish")

    def cancel(self, reason: Reason) -> None:
        self.told.append(reason)

    def click(self, event: QMouseEvent) -> None:
        self.told.append("click")


def of_mouse(kind: QEvent.Type, button: Qt.MouseButton = LEFT) -> QMouseEvent:
    at = QPointF(5, 5)
    return QMouseEvent(kind, at, at, button, button, Qt.KeyboardModifier.NoModifier)


@pytest.mark.parametrize(("far", "told"), [(2, ["finish", "click"]), (3, ["finish"])])
def test_what_is_let_go_before_it_has_begun_is_a_click(far: int, told: list[str]) -> None:
    hand, gesture = PointerHand(), Noted()
    hand.take(gesture, QPointF(5, 5))
    assert not hand.press(of_mouse(QEvent.Type.MouseButtonPress)), "only what is sticky ends by a press"
    hand.move(QPointF(5 + far, 5))
    assert hand.release(of_mouse(QEvent.Type.MouseButtonRelease))
    assert gesture.told == told and hand.gesture is None


@pytest.mark.parametrize(("button", "told"), [(LEFT, ["finish"]), (RIGHT, ["replaced"])])
def test_a_sticky_gesture_goes_on_until_a_button_is_pressed(button: Qt.MouseButton, told: list[str]) -> None:
    hand, gesture = PointerHand(), Noted(sticky=True)
    hand.take(gesture, QPointF(5, 5))
    assert not hand.release(of_mouse(QEvent.Type.MouseButtonRelease)) and hand.gesture is gesture
    assert hand.press(of_mouse(QEvent.Type.MouseButtonPress, button))
    assert gesture.told == told and hand.gesture is None


def test_an_empty_hand_takes_no_press_and_finishes_nothing() -> None:
    hand = PointerHand()
    assert not hand.press(of_mouse(QEvent.Type.MouseButtonPress))
    assert not hand.release(of_mouse(QEvent.Type.MouseButtonRelease))
    assert hand.cursor is None
