"""Small pictures of ways to begin, drawn in the colours of the theme."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPen

from app.look.theme import WindowTheme
from metagraph.graph.model import KINDS

Draw = Callable[[QPainter, WindowTheme, QRectF], None]
HIGH = 64.0  # pixels of a picture, before it is scaled into its room


def _begin(painter: QPainter, room: QRectF, wide: float) -> None:
    """Let what is drawn in `wide` x HIGH fill a room, its middle in the room's."""
    scale = min(room.width() / wide, room.height() / HIGH)
    painter.save()
    painter.translate(room.center())
    painter.scale(scale, scale)
    painter.translate(-wide / 2, -HIGH / 2)


def _figure(painter: QPainter, ink: QColor, at: QPointF, high: float, lean: float = 0.0) -> None:
    """A person in five strokes. lean: how far the hands are out."""
    painter.setPen(QPen(ink, high / 14, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap))
    painter.setBrush(Qt.BrushStyle.NoBrush)
    u = high / 10
    neck, hip = at + QPointF(0, 2.6 * u), at + QPointF(0, 6 * u)
    painter.drawEllipse(at + QPointF(0, 1.2 * u), 1.1 * u, 1.1 * u)
    painter.drawLine(neck, hip)
    for side in (-1, 1):
        painter.drawLine(neck, neck + QPointF(side * (1.4 + 1.6 * lean) * u, (2.6 - 2.2 * lean) * u))
        painter.drawLine(hip, hip + QPointF(side * 1.1 * u, 3.8 * u))


def _card(painter: QPainter, t: WindowTheme, box: QRectF, edge: QColor, lean: float) -> None:
    painter.setPen(QPen(edge, 1.4))
    painter.setBrush(QColor(t.field))
    painter.drawRoundedRect(box, 3, 3)
    _figure(painter, QColor(t.dim), QPointF(box.center().x(), box.top() + 4), box.height() - 9, lean)


def _import(painter: QPainter, t: WindowTheme, room: QRectF) -> None:
    _begin(painter, room, 150)
    painter.setPen(QPen(QColor(t.dim), 1.4))
    painter.setBrush(QColor(t.hover))
    painter.drawRoundedRect(QRectF(10, 10, 24, 14), 3, 3)
    painter.drawRoundedRect(QRectF(10, 16, 50, 40), 4, 4)
    painter.setPen(QPen(QColor(t.text), 2.0, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap))
    painter.drawLine(QPointF(68, 36), QPointF(86, 36))
    painter.drawPolyline([QPointF(80, 30), QPointF(86, 36), QPointF(80, 42)])
    for n, lean in enumerate((0.0, 0.9)):
        _card(painter, t, QRectF(96 + 27 * n, 14, 23, 40), QColor(t.line), lean)
    painter.restore()


def _practice(painter: QPainter, t: WindowTheme, room: QRectF) -> None:
    _begin(painter, room, 170)
    for n, (kind, lean) in enumerate(zip(KINDS, (0.0, 1.0, 0.5, 0.2), strict=True)):
        box = QRectF(6 + 42 * n, 6, 30, 40)
        _card(painter, t, box, t.fill(kind), lean)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(t.fill(kind))
        painter.drawRoundedRect(QRectF(box.left(), 52, box.width(), 5), 2.5, 2.5)
    painter.restore()


def _sample(painter: QPainter, t: WindowTheme, room: QRectF) -> None:
    _begin(painter, room, 170)
    painter.setBrush(Qt.BrushStyle.NoBrush)
    for left, kind in ((8.0, "gesture"), (118.0, "fidget")):
        painter.setPen(QPen(t.fill(kind), 1.4))
        edge = left + 44 if left < 80 else left
        painter.drawLine(QPointF(edge, 28), QPointF(67 if left < 80 else 103, 28))
        painter.setPen(QPen(QColor(t.line), 1.2))
        painter.setBrush(QColor(t.field))
        painter.drawRoundedRect(QRectF(left, 8, 44, 44), 4, 4)
        painter.setPen(QPen(t.fill(kind), 3, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap))
        for n, long in enumerate((26, 18, 30, 22)):
            painter.drawLine(QPointF(left + 7, 17 + 9 * n), QPointF(left + 7 + long, 17 + 9 * n))
    painter.setPen(QPen(t.fill("stance"), 1.8))
    painter.setBrush(QColor(t.field))
    painter.drawRoundedRect(QRectF(67, 4, 36, 56), 5, 5)
    _figure(painter, QColor(t.text), QPointF(85, 9), 46, 0.8)
    painter.restore()


def _recent(painter: QPainter, t: WindowTheme, room: QRectF) -> None:
    _begin(painter, room, 130)
    for n in (2, 1, 0):
        painter.setPen(QPen(QColor(t.line), 1.2))
        painter.setBrush(QColor(t.field if n else t.hover))
        painter.drawRoundedRect(QRectF(38 + 9 * n, 18 - 7 * n, 42, 44), 4, 4)
    painter.setPen(QPen(QColor(t.dim), 2, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap))
    centre = QPointF(59, 40)
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.drawEllipse(centre, 12, 12)
    painter.drawLine(centre, centre - QPointF(0, 7))
    painter.drawLine(centre, centre + QPointF(5, 3))
    painter.restore()


PICTURES: Mapping[str, Draw] = {
    "import": _import,
    "practice": _practice,
    "sample": _sample,
    "recent": _recent,
}
