"""Numbers, choices and sliders that scrolling passes by, and whose holding and scrolling is one step: every
field of the window is one.

Qt's own take the wheel, and with it the focus, wherever the mouse happens to be; scrolling a panel changed
what stood under it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from PySide6.QtCore import Qt, QTimer
from PySide6.QtGui import QFocusEvent, QKeyEvent, QMouseEvent, QWheelEvent
from PySide6.QtWidgets import QComboBox, QDoubleSpinBox, QSlider, QSpinBox, QWidget

REST = 250  # milliseconds without a notch after which scrolling is over
_Base: Any = QWidget if TYPE_CHECKING else object


class OneStep(_Base):
    """Before a field of numbers: its value is reported once, when what changes it is over: a key or a button
    held down, a run of the wheel.

    Without the focus it lets the wheel pass.
    """

    def __init__(self, *arguments: Any, **properties: Any) -> None:
        super().__init__(*arguments, **properties)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)  # Qt's own are given the focus by the wheel
        self._held = False
        self._before: float | None = None  # its value when a run began that is not told yet
        self._rest = QTimer(self, singleShot=True, interval=REST)
        self._rest.timeout.connect(self.tell_value)

    def tell_value(self) -> None:
        """Report what the value is now, if that was held back."""
        self._rest.stop()
        self._held = False
        before, self._before = self._before, None
        if before is not None and self.value() != before:
            self.valueChanged.emit(self.value())

    def quietly(self, change: Any, *arguments: Any) -> None:
        """Let something change the value, which is reported later."""
        if self._before is None:
            self._before = self.value()
        blocked = self.blockSignals(True)
        try:
            change(*arguments)
        finally:
            self.blockSignals(blocked)

    def wheelEvent(self, event: QWheelEvent) -> None:
        if not self.hasFocus():
            event.ignore()
            return
        self.quietly(super().wheelEvent, event)
        self._rest.start()

    def keyReleaseEvent(self, event: QKeyEvent) -> None:
        super().keyReleaseEvent(event)
        if not event.isAutoRepeat():
            self.tell_value()

    def focusOutEvent(self, event: QFocusEvent) -> None:
        self.tell_value()
        super().focusOutEvent(event)


class Stepped(OneStep):
    """Before a spin box: what its arrows and arrow keys do while they are held is one step."""

    KEYS = (Qt.Key.Key_Up, Qt.Key.Key_Down, Qt.Key.Key_PageUp, Qt.Key.Key_PageDown)

    def __init__(self, *arguments: Any, **properties: Any) -> None:
        super().__init__(*arguments, **properties)
        self.lineEdit().setTextMargins(6, 0, 0, 0)  # a style sheet's padding does not reach it

    def stepBy(self, steps: int) -> None:
        if self._held:
            self.quietly(super().stepBy, steps)
        else:
            super().stepBy(steps)

    def step_to(self, value: float) -> None:
        """Step to a value of one's own choice."""
        if self._held:
            self.quietly(self.setValue, value)
        else:
            self.setValue(value)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        self._held = event.key() in self.KEYS
        super().keyPressEvent(event)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        self._held = True
        super().mousePressEvent(event)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        super().mouseReleaseEvent(event)
        self.tell_value()


class SpinBox(Stepped, QSpinBox):
    """A whole number."""


class DoubleSpinBox(Stepped, QDoubleSpinBox):
    """A number."""


class Slider(OneStep, QSlider):
    """A slider; what keys do while they are held is one step."""

    def keyPressEvent(self, event: QKeyEvent) -> None:
        self.quietly(super().keyPressEvent, event)


class Scrub(Slider):
    """A slider that is followed at once, by keys, too: what it moves is no edit."""

    def quietly(self, change: Any, *arguments: Any) -> None:
        change(*arguments)


class ComboBox(QComboBox):
    """A choice; scrolling never changes it."""

    def __init__(self, *arguments: Any, **properties: Any) -> None:
        super().__init__(*arguments, **properties)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)

    def choose(self, data: object) -> None:
        """Choose the row of some data, else the first. Qt knows a path or a pair only as the same object."""
        rows = [self.itemData(n) for n in range(self.count())]
        self.setCurrentIndex(rows.index(data) if data in rows else 0 if rows else -1)

    def wheelEvent(self, event: QWheelEvent) -> None:
        event.ignore()
