"""Drags of the mouse as objects, from the press to the release or to an interruption."""

from __future__ import annotations

from typing import Literal, Protocol

from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QMouseEvent
from PySide6.QtWidgets import QApplication

Reason = Literal["escape", "replaced", "taken over", "lost"]


class PointerDrag(Protocol):
    """One drag. Points are the widget's, in pixels. Only `finish` changes the project for good, in one step.

    begun: the mouse has moved far enough for it to be a drag and no click. sticky: it goes on when the button
    is let go, until one is pressed. free: nothing is to snap, or the key for another way is held. reason, of
    being broken off: "escape" was pressed, another gesture "replaced" it, a drag of the system has "taken
    over", or what it was about was "lost".
    """

    begun: bool
    sticky: bool = False

    @property
    def cursor(self) -> Qt.CursorShape | None:
        """The mouse's shape while it lasts; None if it has none of its own."""
        return None

    def begin(self, at: QPointF) -> None: ...
    def update(self, at: QPointF, free: bool = False) -> None: ...
    def finish(self, at: QPointF) -> None: ...
    def cancel(self, reason: Reason) -> None: ...

    def click(self, event: QMouseEvent) -> None:
        """Do what a click does: the button was let go before it had begun."""
        return


class PressDrag(PointerDrag):
    """What drags share that begin once the mouse has moved far enough. catch: pixels; None for the system's
    own distance.
    """

    catch: float | None = None

    def __init__(self) -> None:
        self.origin = QPointF()
        self.begun = False

    def begin(self, at: QPointF) -> None:
        self.origin = at

    def caught(self, at: QPointF) -> bool:
        """Return whether it is a drag by now."""
        far = QApplication.startDragDistance() if self.catch is None else self.catch
        self.begun = self.begun or (at - self.origin).manhattanLength() >= far
        return self.begun

    def cancel(self, reason: Reason) -> None:
        """Nothing was shown that would have to be taken back."""


class PointerHand:
    """What the mouse holds in a widget: one gesture, or nothing."""

    def __init__(self) -> None:
        self.gesture: PointerDrag | None = None

    @property
    def cursor(self) -> Qt.CursorShape | None:
        """The mouse's shape that the gesture wants; None if there is none, or it wants none."""
        return self.gesture.cursor if self.gesture is not None else None

    def take(self, gesture: PointerDrag, at: QPointF) -> None:
        """Begin a gesture; one that still goes on is broken off."""
        self.drop("replaced")
        self.gesture = gesture
        gesture.begin(at)

    def move(self, at: QPointF, free: bool = False) -> bool:
        """Let the gesture follow the mouse; return whether there is one."""
        if self.gesture is not None:
            self.gesture.update(at, free)
        return self.gesture is not None

    def press(self, event: QMouseEvent) -> bool:
        """Finish a sticky gesture, or break it off by another button than the left; return whether there was
        one.
        """
        if self.gesture is None or not self.gesture.sticky:
            return False
        if event.button() != Qt.MouseButton.LeftButton:
            return self.drop("replaced")
        gesture, self.gesture = self.gesture, None
        gesture.finish(event.position())
        return True

    def release(self, event: QMouseEvent) -> bool:
        """Finish the gesture, unless it is sticky; return whether it was."""
        if self.gesture is None or self.gesture.sticky:
            return False
        gesture, self.gesture = self.gesture, None
        gesture.finish(event.position())
        if not gesture.begun:
            gesture.click(event)
        return True

    def drop(self, reason: Reason) -> bool:
        """Break the gesture off; return whether there was one."""
        gesture, self.gesture = self.gesture, None
        if gesture is not None:
            gesture.cancel(reason)
        return gesture is not None
