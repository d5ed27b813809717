"""What questions are answered with: numbers on a scale, a mark on a line, choices, words. Nothing is chosen
beforehand.
"""

from __future__ import annotations

from typing import Any

from PySide6.QtCore import QPointF, QSize, Qt, Signal
from PySide6.QtGui import QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import (
    QButtonGroup,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QPlainTextEdit,
    QRadioButton,
    QSizePolicy,
    QVBoxLayout,
    QWidget,
)

from app.translation import tr
from metagraph.research.study.questionnaires import BUTTONS, Item, Scale

_EDGE = 12  # pixels left and right of a line of marks


class MarkLine(QWidget):
    """A line with ticks on which a mark is put, by mouse or arrow keys; without one until then. Ends stand
    below.
    """

    changed = Signal(int)

    def __init__(self, scale: Scale, parent: QWidget) -> None:
        super().__init__(parent)
        self.scale, self.value = scale, None  # type: Scale, int | None
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setCursor(Qt.CursorShape.PointingHandCursor)

    def sizeHint(self) -> QSize:
        return QSize(560, 54)

    def set_value(self, value: int) -> None:
        points = self.scale.points
        value = min(points, key=lambda p: abs(p - value))
        if value != self.value:
            self.value = value
            self.update()
            self.changed.emit(value)

    def place(self, value: int) -> float:
        """Return where a value is, pixels from the left."""
        share = (value - self.scale.lowest) / (self.scale.highest - self.scale.lowest)
        return _EDGE + share * (self.width() - 2 * _EDGE)

    def _put(self, x: float) -> None:
        share = (x - _EDGE) / max(1, self.width() - 2 * _EDGE)
        self.set_value(round(self.scale.lowest + share * (self.scale.highest - self.scale.lowest)))

    def mousePressEvent(self, event: QMouseEvent) -> None:
        self._put(event.position().x())

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if event.buttons():
            self._put(event.position().x())

    def keyPressEvent(self, event: QKeyEvent) -> None:
        steps = {Qt.Key.Key_Left: -1, Qt.Key.Key_Down: -1, Qt.Key.Key_Right: 1, Qt.Key.Key_Up: 1}.get(
            Qt.Key(event.key())
        )
        ends = {Qt.Key.Key_Home: self.scale.lowest, Qt.Key.Key_End: self.scale.highest}.get(
            Qt.Key(event.key())
        )
        if ends is not None:
            self.set_value(ends)
        elif steps is None:
            super().keyPressEvent(event)
        elif self.value is None:
            self.set_value(self.scale.points[len(self.scale.points) // 2])
        else:
            self.set_value(self.value + steps * self.scale.step)

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        colors = self.palette()
        dim, text = colors.placeholderText().color(), colors.text().color()
        y = 18.0
        painter.setPen(QPen(text if self.hasFocus() else dim, 1.5 if self.hasFocus() else 1.0))
        painter.drawLine(QPointF(_EDGE, y), QPointF(self.width() - _EDGE, y))
        points = self.scale.points
        painter.setPen(QPen(dim, 1.0))
        for n, value in enumerate(points):
            x = self.place(value)
            high = 8 if n in (0, len(points) - 1) or 2 * n == len(points) - 1 else 5
            painter.drawLine(QPointF(x, y - high), QPointF(x, y + high))
        half = self.width() // 2
        painter.drawText(
            4, 34, half, 18, Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter, self.scale.left
        )
        painter.drawText(
            half - 4,
            34,
            half,
            18,
            Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter,
            self.scale.right,
        )
        if self.value is not None:
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(text)
            painter.drawEllipse(QPointF(self.place(self.value), y), 8, 8)


class Question(QWidget):
    """An item with what it is answered by. answered: (id, value)."""

    answered = Signal(str, object)

    def __init__(self, item: Item, number: int, parent: QWidget, value: Any = None) -> None:
        super().__init__(parent)
        self.item, self.value = item, value
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 6, 0, 14)
        column.setSpacing(8)
        head = QLabel(f"{number}.  {item.title or item.text}", self)
        head.setWordWrap(True)
        head.setProperty("title", True)
        column.addWidget(head)
        if item.title and item.text:
            more = QLabel(item.text, self)
            more.setWordWrap(True)
            more.setProperty("dim", True)
            column.addWidget(more)
        self.field = self._field(item, value)
        self.field.setAccessibleName(item.text)
        column.addWidget(self.field)
        self.missing = QLabel(tr("Please answer this question."), self)
        self.missing.setProperty("missing", True)
        self.missing.hide()
        column.addWidget(self.missing)

    @property
    def lacks(self) -> bool:
        """Whether an answer is needed and not there."""
        return self.item.needed and self.value is None

    def _answer(self, value: Any) -> None:
        self.value = value
        self.missing.hide()
        self.answered.emit(self.item.id, value)

    def _field(self, item: Item, value: Any) -> QWidget:
        if item.words:
            self.words = QPlainTextEdit(str(value or ""), self)
            self.words.setFixedHeight(88)
            self.words.setTabChangesFocus(True)
            self.words.textChanged.connect(self._words_changed)
            return self.words
        if item.scale is not None and len(item.scale.points) > BUTTONS:
            self.mark = MarkLine(item.scale, self)
            if value is not None:
                self.mark.set_value(int(value))
            self.mark.changed.connect(self._answer)
            return self.mark
        return self._buttons(item, value)

    def _words_changed(self) -> None:
        self.value = self.words.toPlainText()  # told when the page is left, not with every letter

    def _buttons(self, item: Item, value: Any) -> QWidget:
        box = QWidget(self)
        self.group = QButtonGroup(box)
        values: tuple[Any, ...] = item.scale.points if item.scale is not None else item.choices
        buttons = [QRadioButton(str(one), box) for one in values]
        for n, (one, button) in enumerate(zip(values, buttons, strict=True)):
            button.setAccessibleName(f"{item.text} {one}")
            button.setChecked(one == value)
            self.group.addButton(button, n)
        self.group.idClicked.connect(lambda n: self._answer(values[n]))
        if item.scale is None:
            column = QVBoxLayout(box)
            column.setContentsMargins(18, 0, 0, 0)
            for button in buttons:
                column.addWidget(button)
            return box
        grid = QGridLayout(box)
        grid.setContentsMargins(18, 0, 18, 0)
        grid.setHorizontalSpacing(20)
        left, right = QLabel(item.scale.left, box), QLabel(item.scale.right, box)
        for label, side in ((left, Qt.AlignmentFlag.AlignRight), (right, Qt.AlignmentFlag.AlignLeft)):
            label.setProperty("dim", True)
            label.setFixedWidth(150)
            label.setWordWrap(True)
            label.setAlignment(side | Qt.AlignmentFlag.AlignVCenter)
        row = QHBoxLayout()
        row.setSpacing(26)
        for button in buttons:
            row.addWidget(button)
        grid.addWidget(left, 0, 0)
        grid.addLayout(row, 0, 1)
        grid.addWidget(right, 0, 2)
        grid.setColumnStretch(3, 1)
        return box
