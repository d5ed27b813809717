"""Words on plates over the picture of the character."""

from __future__ import annotations

from collections.abc import Iterable

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter

from app.look.theme import WindowTheme

ROUND = 4.0  # pixels, of corners and above the highest


def draw_plate(
    painter: QPainter, look: WindowTheme, at: QPointF, words: str, taken: Iterable[QRectF] = ()
) -> QRectF:
    """Draw words on a plate at a place, or lower if it would cover one of the `taken` rectangles. Return the
    plate's rectangle.
    """
    size = painter.fontMetrics().boundingRect(words)
    room = QRectF(0, 0, size.width() + 10, size.height() + 4)
    room.moveCenter(at)
    room.moveTop(max(ROUND, room.top()))
    others = [*taken]
    while any(room.intersects(other) for other in others):
        room.translate(0.0, room.height() + 2)
    back = QColor(look.card)
    back.setAlphaF(0.9)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(back)
    painter.drawRoundedRect(room, ROUND, ROUND)
    painter.setPen(QColor(look.text))
    painter.drawText(room, Qt.AlignmentFlag.AlignCenter, words)
    return room
