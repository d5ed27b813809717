"""Draws the stances: a chip for each, and the card of the one that is shown."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFont, QFontMetricsF, QPainter, QPen

from app.features.graph.graph_layout import Chip, Layout
from app.features.graph.graph_look import (
    GraphLook,
    crop_upper,
    draw_box,
    draw_offer,
    make_bold,
    shorten_between,
)
from app.look.names import make_readable_name
from app.translation import tr, tr_plural


def draw_chip(painter: QPainter, chip: Chip, layout: Layout, look: GraphLook, font: QFont) -> None:
    t, beside = look.theme, tuple(make_readable_name(c.name) for c in layout.chips)
    target = look.drop is not None and (
        (look.drop_hit.area == "add" and chip.stance is None and not chip.finds)
        or (look.drop_hit.area == "chip" and look.drop_hit.ident == chip.stance and chip.stance is not None)
    )
    current = chip.stance is not None and chip.stance == layout.stance
    hover = (look.hover.area == ("find" if chip.finds else "add") and chip.stance is None) or (
        look.hover.area == "chip" and chip.stance is not None and look.hover.ident == chip.stance
    )
    edge = t.fill("stance") if current or target else QColor(t.line)
    draw_box(
        painter,
        chip.rect,
        QColor(t.hover if hover or target else t.panel),
        edge,
        1.5 if current else 1.0,
        dashed=bool(chip.words) and not current,
    )
    if chip.stance is None:
        painter.setPen(QPen(QColor(t.text), 1.6))
        c = chip.rect.center()
        if chip.finds:  # a magnifying glass
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawEllipse(c - QPointF(1.5, 1.5), 4.5, 4.5)
            painter.drawLine(c + QPointF(2, 2), c + QPointF(6, 6))
            return
        painter.drawLine(c - QPointF(5, 0), c + QPointF(5, 0))
        painter.drawLine(c - QPointF(0, 5), c + QPointF(0, 5))
        return
    inner = chip.rect.adjusted(10, 0, -10, 0)
    if chip.bare:
        painter.setFont(font)
        painter.setPen(QColor(t.text if current else t.dim))
        name = shorten_between(font, make_readable_name(chip.name), inner.width(), beside)
        painter.drawText(inner, Qt.AlignmentFlag.AlignCenter, name)
        return
    picture = look.chip_pictures.get(chip.stance)
    if picture is not None:
        size = chip.rect.height() - 6
        painter.drawImage(
            QRectF(chip.rect.left() + 5, chip.rect.top() + 3, size, size), picture, crop_upper(picture)
        )
    else:
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(t.fill("stance"))
        painter.drawEllipse(QPointF(chip.rect.left() + 16, chip.rect.center().y()), 4, 4)
    inner.setLeft(chip.rect.left() + (chip.rect.height() + 8 if picture is not None else 28))
    metrics = QFontMetricsF(font)
    right, tone = chip.words or "", t.warning
    if chip.same:
        right, tone = (f"{right}  {chip.same}", t.warning) if right else (chip.same, t.dim)
    count = str(chip.count)
    used = metrics.horizontalAdvance(count) + (metrics.horizontalAdvance(right) + 8 if right else 0) + 8
    painter.setFont(make_bold(font) if current else font)
    painter.setPen(QColor(t.text))
    name = shorten_between(painter.font(), make_readable_name(chip.name), inner.width() - used + 1, beside)
    painter.drawText(inner, Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft, name)
    painter.setFont(font)
    painter.setPen(QColor(t.dim))
    painter.drawText(inner, Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignRight, count)
    if right:
        painter.setPen(QColor(tone))
        painter.drawText(
            inner.adjusted(0, 0, -metrics.horizontalAdvance(count) - 8, 0),
            Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignRight,
            right,
        )


def draw_stance_card(painter: QPainter, layout: Layout, look: GraphLook, font: QFont) -> None:
    t, card = look.theme, layout.card
    dragging = look.drop is not None
    stance = look.project.stance(layout.stance)
    edge = t.fill("stance") if stance is not None or dragging else QColor(t.line)
    loops = look.project.graphs[stance.layer].of(stance.id, "stance") if stance is not None else ()
    chosen = any(loop.id in look.selected for loop in loops)
    draw_box(
        painter,
        card,
        QColor(t.hover if chosen else t.card),
        edge,
        2.0 if stance is not None else 1.2,
        dashed=stance is None,
    )
    if stance is None:
        painter.setPen(QColor(t.dim))
        painter.setFont(font)
        painter.drawText(
            card.adjusted(14, 14, -14, -14), Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap,
            tr("Drop a resting clip here, for example with the hands at the sides. It makes the first "
               "stance of this layer."),
        )  # fmt: skip
    else:
        head = _card_name(painter, card, make_readable_name(stance.name), make_bold(font), look)
        area = QRectF(
            card.left() + 4, head.bottom() + 2, card.width() - 8, card.height() - 24 - head.height() - 14
        )
        if look.picture is not None and area.height() >= 20:
            size = min(area.width(), area.height())
            painter.drawImage(
                QRectF(area.center().x() - size / 2, area.center().y() - size / 2, size, size), look.picture
            )
        if area.height() < 20:
            painter.setFont(font)
            return _card_drop(painter, layout, look, font)
        start = look.project.graphs[stance.layer].start == stance.id
        words = tr_plural("{count:,} loop", "{count:,} loops", len(loops)) if loops else tr("no loop yet")
        painter.setFont(font)
        painter.setPen(QColor(t.dim if loops else t.warning))
        foot = QRectF(card.left() + 12, card.bottom() - 26, card.width() - 24, 20)
        more = tr("{words}  ·  start stance", words=words)
        if start and QFontMetricsF(font).horizontalAdvance(more) <= foot.width() - 1:
            words = more
        painter.drawText(foot, Qt.AlignmentFlag.AlignCenter, shorten_between(font, words, foot.width()))
    return _card_drop(painter, layout, look, font)


def _card_name(painter: QPainter, card: QRectF, name: str, heavy: QFont, look: GraphLook) -> QRectF:
    """Paint the stance's name on its card, in two lines where one is too short; return the room it takes."""
    t, measure = look.theme, QFontMetricsF(heavy)
    room = card.width() - 24 - 16
    lines = [name]
    words = name.split()
    if measure.horizontalAdvance(name) > room and card.height() > 96 and len(words) > 1:
        cuts = ((" ".join(words[:n]), " ".join(words[n:])) for n in range(1, len(words)))
        lines = list(min(cuts, key=lambda two: max(map(measure.horizontalAdvance, two))))
    lines = [shorten_between(heavy, line, room) for line in lines]
    head = QRectF(card.left() + 12, card.top() + 8, card.width() - 24, 24.0 + 17 * (len(lines) - 1))
    wide = max(map(measure.horizontalAdvance, lines))
    left = head.center().x() - (wide + 16) / 2
    painter.setFont(heavy)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(t.fill("stance"))
    painter.drawEllipse(QPointF(left + 4, head.center().y()), 4.5, 4.5)
    painter.setPen(QColor(t.text))
    for n, line in enumerate(lines):
        box = QRectF(left + 16, head.top() + 17 * n, wide + 4, 24)
        painter.drawText(box, Qt.AlignmentFlag.AlignVCenter, line)
    return head


def _card_drop(painter: QPainter, layout: Layout, look: GraphLook, font: QFont) -> None:
    """Say what a drop on the card will do, while something is dragged there."""
    card, stance = layout.card, look.project.stance(layout.stance)
    if look.drop is not None and look.drop_hit.area in ("card", "loop"):
        zone = (
            layout.loops
            if look.drop_hit.area == "loop"
            else QRectF(card.topLeft(), QPointF(card.right(), layout.loops.top()))
        )
        if stance is None:
            zone = card
        draw_offer(painter, zone, look, "stance", font)
