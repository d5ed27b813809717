"""What is on clips, drawn: a label's colour with its letter in it, a heart, stars, a pencil for a note."""

from __future__ import annotations

from PySide6.QtCore import QRect, Qt
from PySide6.QtGui import QColor, QFont, QIcon, QPainter, QPixmap

from app.look.theme import WindowTheme
from metagraph.graph.clip_mark import ClipMark, Color

# Areas behind a dark letter, contrast of at least 7:1; the letter tells what the colour does.
FILLS: dict[Color, str] = {
    "red": "#ff8a80",
    "orange": "#ffb15c",
    "yellow": "#f2d94e",
    "green": "#7ed492",
    "blue": "#82b6ff",
    "purple": "#c9a4ff",
}
INK = "#17181b"
TAG = 16  # pixels of a label's side
HEART, PENCIL = "♥", "✎"


def draw_label(painter: QPainter, box: QRect, color: Color) -> None:
    """Draw a label: its colour, and the first letter of its name."""
    painter.save()
    painter.setPen(QColor(INK))
    painter.setBrush(QColor(FILLS[color]))
    painter.drawRoundedRect(box, 4, 4)
    font = QFont(painter.font())
    font.setPixelSize(max(9, box.height() - 5))
    font.setBold(True)
    painter.setFont(font)
    painter.drawText(box, Qt.AlignmentFlag.AlignCenter, color[0].upper())
    painter.restore()


def label_icon(color: Color) -> QIcon:
    """Return a label as menus show it."""
    out = QIcon()
    for scale in (1, 2):
        picture = QPixmap(TAG * scale, TAG * scale)
        picture.setDevicePixelRatio(scale)
        picture.fill(Qt.GlobalColor.transparent)
        painter = QPainter(picture)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        draw_label(painter, QRect(1, 1, TAG - 2, TAG - 2), color)
        painter.end()
        out.addPixmap(picture)
    return out


def draw_badges(painter: QPainter, box: QRect, mark: ClipMark, look: WindowTheme) -> None:
    """Draw what is on a clip over its picture: the label left, heart and pencil right."""
    if mark.color:
        draw_label(painter, QRect(box.left(), box.top(), TAG, TAG), mark.color)
    words = HEART * mark.favourite + PENCIL * bool(mark.note)
    if words:
        painter.setPen(QColor(look.text))
        painter.drawText(
            QRect(box.left(), box.top() - 2, box.width(), 20),
            Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter,
            words,
        )
