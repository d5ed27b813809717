"""The frame round what would take the files that are being dragged over it."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, QRectF, Qt
from PySide6.QtGui import QColor, QDropEvent, QHideEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QWidget

from app.look.theme import get_theme
from app.look.theme_choice import ThemeChoice

WIDTH = 2.0  # pixels of the frame
ROUND = 6.0  # pixels of its corners
FILL = 0.10  # how much of the frame's colour lies over what it surrounds


class DropFrame(QWidget):
    """Lies over `target` while files that it takes are dragged over it, with words that say what a drop does.
    The target calls `follow` at the end of its drag events.
    """

    def __init__(self, target: QWidget, look: ThemeChoice, words: str) -> None:
        super().__init__(target)
        self.target, self.look, self.usual, self.words = target, look, words, words
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self._say(words)
        target.installEventFilter(self)
        self.hide()

    def follow(self, event: QDropEvent, words: str = "") -> None:
        """Show the frame if the target accepted the event of a drag, else hide it. words: for this drag, if
        not the usual ones.
        """
        if not event.isAccepted():
            self.hide()
            return
        self._say(words or self.usual)
        self.setGeometry(self.target.rect())
        self.show()
        self.raise_()

    def _say(self, words: str) -> None:
        self.words = words
        self.setAccessibleName(words)

    def hideEvent(self, event: QHideEvent) -> None:
        self._say(self.usual)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() in (QEvent.Type.DragLeave, QEvent.Type.Drop, QEvent.Type.Hide):
            self.hide()
        return False

    def paintEvent(self, event: QPaintEvent) -> None:
        look, half = get_theme(self.look.name), WIDTH / 2
        color = QColor(look.strong)
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(QPen(color, WIDTH))
        fill = QColor(color)
        fill.setAlphaF(FILL)
        painter.setBrush(fill)
        painter.drawRoundedRect(QRectF(self.rect()).adjusted(half, half, -half, -half), ROUND, ROUND)
        words = painter.fontMetrics().elidedText(self.words, Qt.TextElideMode.ElideRight, self.width() - 24)
        room = QRectF(painter.fontMetrics().boundingRect(words)).adjusted(-10, -5, 10, 5)
        room.moveCenter(QRectF(self.rect()).center())
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(color)
        painter.drawRoundedRect(room, ROUND, ROUND)
        painter.setPen(QColor(look.on_strong))
        painter.drawText(room, Qt.AlignmentFlag.AlignCenter, words)
        painter.end()
