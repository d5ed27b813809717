"""Two widgets below each other, or side by side where it is wide and low; then the second scrolls alone."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, QSize, Qt, Signal
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QBoxLayout, QFrame, QScrollArea, QSizePolicy, QWidget

WIDE = 760  # pixels from which two halves can stand side by side
RATIO = 1.5  # of width to height from which they do


class Halves(QWidget):
    """turned: they stand side by side now, or below each other again."""

    turned = Signal(bool)

    def __init__(self, first: QWidget, second: QWidget, parent: QWidget) -> None:
        super().__init__(parent)
        self.beside = False
        self._room = QSize()
        self._first_is_low = False
        self._second = _Half(second, self)
        self._box = QBoxLayout(QBoxLayout.Direction.TopToBottom, self)
        self._box.setContentsMargins(14, 10, 14, 14)
        self._box.setSpacing(8)
        self._box.addWidget(first)
        self._box.addWidget(self._second, 1)

    def fit(self, room: QSize) -> None:
        """Stand as suits a room in which they are seen, which may be lower than they are."""
        self._room = room
        wide = room.width() >= WIDE and room.width() > RATIO * room.height()
        beside = wide and not self._first_is_low
        if beside == self.beside:
            return
        self.beside = beside
        directions = QBoxLayout.Direction
        self._box.setDirection(directions.LeftToRight if beside else directions.TopToBottom)
        self._box.setStretch(0, 3 if beside else 0)
        self._box.setStretch(1, 2 if beside else 1)
        self._box.setContentsMargins(14, 6 if beside else 10, 8 if beside else 14, 4 if beside else 14)
        self._second.whole = not beside
        self._second.updateGeometry()
        self.turned.emit(beside)

    def set_first_low(self, low: bool) -> None:
        """Say whether the first is only a line or two: that stands above the second in any room."""
        if low != self._first_is_low:
            self._first_is_low = low
            self.fit(self._room)


class _Half(QScrollArea):
    """whole: it is as high as what is in it; else that is scrolled."""

    def __init__(self, content: QWidget, parent: QWidget) -> None:
        super().__init__(parent)
        self.whole = True
        self.setWidgetResizable(True)
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setWidget(content)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.LayoutRequest:
            self.updateGeometry()
        return super().eventFilter(watched, event)

    def minimumSizeHint(self) -> QSize:
        content = self.widget()
        if content is None:
            return QSize(0, 0)
        least = content.minimumSizeHint()
        return QSize(least.width() + (0 if self.whole else 20), least.height() if self.whole else 40)

    def sizeHint(self) -> QSize:
        content = self.widget()
        return content.sizeHint() if self.whole and content is not None else self.minimumSizeHint()

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        policy = Qt.ScrollBarPolicy
        self.setVerticalScrollBarPolicy(policy.ScrollBarAlwaysOff if self.whole else policy.ScrollBarAsNeeded)
