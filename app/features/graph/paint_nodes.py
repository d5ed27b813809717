"""Draws the nodes of a stance and the rows in them."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFont, QFontMetricsF, QPainter, QPen

from app.features.graph.graph_frames import GRID
from app.features.graph.graph_layout import GraphRow, Layout, NodeLayout, measure_bar_part
from app.features.graph.graph_look import (
    GraphLook,
    crop_upper,
    draw_box,
    draw_offer,
    make_bold,
    shorten_between,
)
from app.look.names import make_readable_name
from app.look.theme import KIND_MARKS, KIND_TITLES
from app.translation import make_lazy_texts, tr
from metagraph.graph.model import Kind

TEACH = make_lazy_texts(
    lambda: {
        "gesture": tr("Drop clips that mean something\nor mark the beat: a shrug, a point."),
        "fidget": tr("Drop small habits:\na scratch, tapping fingers."),
        "transition": tr("Drop clips that lead to another stance."),
    }
)


def draw_node(
    painter: QPainter,
    node: NodeLayout,
    layout: Layout,
    look: GraphLook,
    font: QFont,
    wanted: Callable[[QRectF], bool] = lambda _: True,
) -> None:
    """Draw a node. wanted: whether a part of the canvas is to be drawn at all."""
    t = look.theme
    target = (
        look.drop is not None
        and look.drop_hit.kind == node.kind
        and look.drop_hit.area not in ("card", "loop", "chip", "add")
    )
    edge = t.fill(node.kind) if target and look.drop is not None and look.drop.possible else QColor(t.line)
    draw_box(painter, node.rect, QColor(t.card), edge, 1.5 if target else 1.0)
    head = node.header.adjusted(2 * GRID, 0, -2 * GRID, 0)
    painter.setFont(font)
    painter.setPen(t.kind(node.kind))
    painter.drawText(head, Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft, KIND_MARKS[node.kind])
    painter.setFont(make_bold(font))
    painter.setPen(QColor(t.text))
    painter.drawText(
        head.adjusted(20, 0, 0, 0),
        Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft,
        tr(KIND_TITLES[node.kind]),
    )
    painter.setFont(font)
    painter.setPen(QColor(t.dim))
    painter.drawText(head, Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignRight, str(node.count))
    if node.kind == "transition" and layout.stance is not None:
        _other(painter, node, look, font)
    beside = tuple(row.words for other in layout.nodes.values() for row in other.rows)
    for row in node.rows:
        if wanted(row.rect):
            _row(painter, row, node.kind, look, font, beside)
    if node.most > 0:
        track = QRectF(node.rect.right() - 6, node.body.top(), 3, node.body.height())
        share = len(node.rows) / max(1, node.count)
        top = track.top() + track.height() * (1 - share) * node.scroll / node.most
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(t.line))
        painter.drawRoundedRect(QRectF(track.left(), top, 3, max(16.0, track.height() * share)), 1.5, 1.5)
    if not node.count and not target:
        painter.setPen(QColor(t.dim))
        text = TEACH[node.kind] if layout.stance is not None else tr("Make a stance first.")
        flags = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignTop | Qt.TextFlag.TextWordWrap
        room = node.body.adjusted(2 * GRID, 2, -GRID, 0)
        while text and painter.boundingRect(room, flags, text).height() > room.height():
            text = text.rpartition("\n")[0].rstrip(":")
        painter.drawText(room, flags, text)
    if target and look.drop is not None and look.drop.reorder:
        _gap(painter, node, look)
    elif target:
        free = QRectF(node.rect.left() + 3, node.rect.bottom() - 60, node.rect.width() - 6, 56)
        if node.rect.height() < 130:
            free = QRectF(
                node.rect.left() + 3,
                node.header.bottom() - 2,
                node.rect.width() - 6,
                node.rect.height() - node.header.height(),
            )
        draw_offer(painter, free, look, node.kind, font)


def _gap(painter: QPainter, node: NodeLayout, look: GraphLook) -> None:
    """A line where actions would be listed: before or behind the row pointed at, or after the last."""
    hit, drop = look.drop_hit, look.drop
    row = next((r for r in node.rows if r.action.id == hit.ident), node.rows[-1] if node.rows else None)
    if row is None or drop is None or not drop.possible:
        return
    behind = hit.behind or hit.ident is None
    rect = row.rect
    painter.setPen(QPen(look.theme.kind(node.kind), 2.4))
    if node.columns > 1:
        x = rect.right() + 2 if behind else rect.left() - 2
        painter.drawLine(QPointF(x, rect.top() + 2), QPointF(x, rect.bottom() - 2))
    else:
        y = rect.bottom() if behind else rect.top()
        painter.drawLine(QPointF(rect.left(), y), QPointF(rect.right(), y))


def _other(painter: QPainter, node: NodeLayout, look: GraphLook, font: QFont) -> None:
    """The chooser of the stance that dropped transitions end in."""
    t, rect = look.theme, node.other
    found = look.project.stance(look.other)
    hover = look.hover.area == "other"
    draw_box(painter, rect, QColor(t.hover if hover else t.field), QColor(t.line))
    painter.setFont(font)
    painter.setPen(QColor(t.text if found is not None else t.warning))
    text, room = (
        tr("to {name}", name=make_readable_name(found.name)) if found is not None else tr("another stance?"),
        rect.width() - 26,
    )
    if found is not None and QFontMetricsF(font).horizontalAdvance(text) > room:
        text = make_readable_name(found.name)
    painter.drawText(
        rect.adjusted(8, 0, -18, 0), Qt.AlignmentFlag.AlignVCenter, shorten_between(font, text, room)
    )
    painter.setPen(QPen(QColor(t.dim), 1.4))
    c = QPointF(rect.right() - 12, rect.center().y())
    painter.drawPolyline([c + QPointF(-3.5, -2), c + QPointF(0, 2), c + QPointF(3.5, -2)])


def _row(
    painter: QPainter, row: GraphRow, kind: Kind, look: GraphLook, font: QFont, beside: tuple[str, ...]
) -> None:
    t, action, rect, bar = look.theme, row.action, row.rect, row.bar
    selected, hover = (
        action.id in look.selected,
        look.hover.ident == action.id and look.hover.area in ("row", "bar", "head"),
    )
    fresh = action.id in look.fresh
    if selected or hover or fresh:
        fill = QColor(t.hover)
        fill.setAlpha(255 if selected else 130)
        edge = t.kind(kind) if fresh else QColor(t.dim)
        ringed = fresh or (action.id == look.focus and selected)
        painter.setPen(QPen(edge, 1) if ringed else Qt.PenStyle.NoPen)
        painter.setBrush(fill)
        painter.drawRoundedRect(rect.adjusted(0, 1, 0, -1), 5, 5)
    left = rect.left() + 8
    if kind == "transition":
        if hover and look.hover.area == "head":
            draw_box(
                painter,
                QRectF(rect.left() + 3, rect.top() + 3, 22, rect.height() - 6),
                QColor(t.field),
                t.kind(kind),
            )
        painter.setFont(font)
        painter.setPen(t.kind(kind))
        painter.drawText(QRectF(left, rect.top(), 18, rect.height()), Qt.AlignmentFlag.AlignVCenter, "→")
        left += 17
    picture = look.row_pictures.get(action.clip)
    if not row.picture.isEmpty():
        left = row.picture.right() + 8
        if picture is not None:
            painter.drawImage(row.picture, picture, crop_upper(picture))
    if action.id in look.playing:
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(t.kind(kind))
        painter.drawRoundedRect(QRectF(rect.left() + 1, rect.top() + 5, 3, rect.height() - 10), 1.5, 1.5)
    room = bar.left() - left - 8
    if action.id in look.misfits:
        painter.setPen(QPen(QColor(t.warning), 1.4))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        c = QPointF(bar.left() - 12, rect.center().y())
        painter.drawPolygon([c + QPointF(0, -5), c + QPointF(5.5, 4.5), c + QPointF(-5.5, 4.5)])
        painter.drawLine(c + QPointF(0, -1.5), c + QPointF(0, 1.5))
        room -= 18
    painter.setFont(font)
    painter.setPen(QColor(t.text))
    painter.drawText(
        QRectF(left, rect.top(), room, rect.height()),
        Qt.AlignmentFlag.AlignVCenter,
        shorten_between(font, row.words, room, beside),
    )
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(QColor(t.line))
    painter.drawRoundedRect(bar, 1.5, 1.5)
    painter.setBrush(t.fill(kind))
    painter.drawRoundedRect(
        QRectF(
            bar.left(), bar.top(), max(3.0, bar.width() * measure_bar_part(action.likelihood)), bar.height()
        ),
        1.5,
        1.5,
    )
    if hover and look.hover.area == "bar":
        painter.drawEllipse(
            QPointF(bar.left() + bar.width() * measure_bar_part(action.likelihood), bar.center().y()),
            4.5,
            4.5,
        )
