"""Draws a laid-out canvas. Takes values, draws them, knows nothing of widgets or events."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFont, QPainter, QPainterPath, QPen, QRegion

from app.features.graph.graph_layout import Layout
from app.features.graph.graph_look import GraphLook, draw_box
from app.features.graph.paint_nodes import draw_node
from app.features.graph.paint_stances import draw_chip, draw_stance_card


def paint_graph(
    painter: QPainter, layout: Layout, look: GraphLook, font: QFont, stale: QRegion | None = None
) -> None:
    """Draw a canvas. stale: the part that is to be drawn again, None for all; while the stance moves that is
    little.
    """

    def wanted(rect: QRectF) -> bool:
        return stale is None or stale.intersects(rect.toAlignedRect().adjusted(-4, -4, 4, 4))

    painter.setRenderHints(QPainter.RenderHint.Antialiasing | QPainter.RenderHint.SmoothPixmapTransform)
    painter.fillRect(QRectF(QPointF(0, 0), layout.size), QColor(look.theme.ground))
    painter.setFont(font)
    draw_curves(painter, layout, look)
    for chip in layout.chips:
        if wanted(chip.rect):
            draw_chip(painter, chip, layout, look, font)
    if wanted(layout.card):
        draw_stance_card(painter, layout, look, font)
    for node in layout.nodes.values():
        if wanted(node.rect):
            draw_node(painter, node, layout, look, font, wanted)
    if not layout.foot.isEmpty():
        painter.setFont(font)
        painter.setPen(QColor(look.theme.dim))
        painter.drawText(
            layout.foot,
            Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft | Qt.TextFlag.TextWordWrap,
            look.sentence,
        )
    draw_verdict(painter, layout, look, font)
    if look.mark is not None:
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(look.theme.fill("stance"))
        painter.drawRoundedRect(look.mark, 1.5, 1.5)
    if look.arrow is not None:
        draw_arrow(
            painter, *look.arrow, look.theme.kind("transition"), look.drop is not None and look.drop.possible
        )


def draw_curves(painter: QPainter, layout: Layout, look: GraphLook) -> None:
    """Join the stance to its nodes: thicker with more actions, dashed when there are none."""
    card = layout.card
    for kind, node in layout.nodes.items():
        color = look.theme.fill(kind)
        color.setAlpha(150 if node.count else 70)
        pen = QPen(color, 1.6)
        if not node.count:
            pen.setDashPattern([3, 4])
        painter.setPen(pen)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        path = QPainterPath()
        if node.rect.top() >= card.bottom():
            path.moveTo(card.center().x(), card.bottom())
            path.lineTo(card.center().x(), node.rect.top())
        else:
            sign = -1 if node.rect.right() <= card.left() else 1
            start = QPointF(card.left() if sign < 0 else card.right(), card.top() + card.height() * 0.42)
            reach = node.rect.right() if sign < 0 else node.rect.left()
            end = QPointF(reach, min(node.rect.center().y(), card.bottom()))
            bend = max(20.0, abs(end.x() - start.x()) * 0.5)
            path.moveTo(start)
            path.cubicTo(start + QPointF(sign * bend, 0), end - QPointF(sign * bend, 0), end)
        painter.drawPath(path)


def draw_verdict(painter: QPainter, layout: Layout, look: GraphLook, font: QFont) -> None:
    """Say above what is held what letting it go would do, in a mark or a warning's colour."""
    if look.drop is None or look.drop_at is None or not look.drop.words:
        return
    t, words = look.theme, look.drop.words.replace("*", "")
    words = words[:1].upper() + words[1:]
    flags = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignTop | Qt.TextFlag.TextWordWrap
    painter.setFont(font)
    room = QRectF(0, 0, min(300.0, layout.size.width() - 40), 200)
    box = painter.boundingRect(room, flags, words).adjusted(-10, -6, 10, 6)
    at = look.drop_at + QPointF(14, -8 - box.height())
    x = min(max(4.0, at.x()), layout.size.width() - box.width() - 4)
    y = at.y() if at.y() >= 4 else look.drop_at.y() + 134  # beneath what is held
    box.moveTo(x, min(y, layout.size.height() - box.height() - 4))
    color = QColor(t.kinds[look.drop_hit.kind]) if look.drop_hit.kind else QColor(t.text)
    draw_box(painter, box, QColor(t.panel), color if look.drop.possible else QColor(t.warning), 1.4)
    painter.setPen(QColor(t.text) if look.drop.possible else QColor(t.warning))
    painter.drawText(box.adjusted(10, 6, -10, -6), flags, words)


TIP = 9.0  # pixels of an arrow's head


def draw_arrow(painter: QPainter, start: QPointF, end: QPointF, color: QColor, sure: bool) -> None:
    """Draw an arrow in a curve that leaves and arrives upright."""
    pen = QPen(color, 2.0)
    if not sure:
        pen.setDashPattern([4, 3])
    bend = min(120.0, max(24.0, abs(end.y() - start.y()) * 0.4))
    up = 1.0 if end.y() <= start.y() else -1.0
    path = QPainterPath(start)
    foot = end + QPointF(0, up * TIP)
    path.cubicTo(start - QPointF(0, up * bend), foot + QPointF(0, up * bend), foot)
    painter.save()
    painter.setPen(pen)
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.drawPath(path)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(color)
    painter.drawPolygon([end, foot + QPointF(TIP * 0.55, 0), foot - QPointF(TIP * 0.55, 0)])
    painter.drawEllipse(QRectF(start - QPointF(3, 3), start + QPointF(3, 3)))
    painter.restore()
