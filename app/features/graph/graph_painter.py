"""Draws a laid-out canvas. Takes values, draws them, knows nothing of widgets or events."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFont, QFontMetricsF, QImage, QPainter, QPainterPath, QPen, QRegion

from app.features.graph.graph_drops import Drop
from app.features.graph.graph_frames import GRID
from app.features.graph.graph_layout import Chip, GraphHit, GraphRow, Layout, Node, bar_part
from app.look.names import plain
from app.look.shortening import fitted
from app.look.theme import KIND_MARKS, KIND_TITLES, Theme
from metagraph.graph.model import Kind, Project

RADIUS = 8.0
NOWHERE = GraphHit("nothing")
TEACH = {
    "gesture": "Drop clips that mean something\nor beat time: a shrug, a point.",
    "fidget": "Drop small habits here:\na scratch, tapping fingers.",
    "transition": "Drop clips that lead to another stance.",
}


@dataclass(frozen=True)
class GraphLook:
    """Everything that is drawn besides the layout."""

    theme: Theme
    project: Project
    selected: Collection[str] = ()
    fresh: Collection[str] = ()  # just made
    hover: GraphHit = NOWHERE
    focus: str | None = None
    playing: Collection[str] = ()  # actions under the playhead
    misfits: dict[str, str] = field(default_factory=dict)  # action -> what is wrong with its ends
    picture: QImage | None = None
    chip_pictures: dict[str, QImage] = field(default_factory=dict)
    row_pictures: Mapping[str, QImage] = field(default_factory=dict)  # by clip
    other: str | None = None
    drop: Drop | None = None
    drop_hit: GraphHit = NOWHERE
    drop_at: QPointF | None = None  # where something is held: what a drop does stands beside it
    arrow: tuple[QPointF, QPointF] | None = None  # being dragged, from where to where
    sentence: str = ""


def paint(
    painter: QPainter, layout: Layout, look: GraphLook, font: QFont, stale: QRegion | None = None
) -> None:
    """Draw a canvas. stale: the part that is to be drawn anew, None for all; while the stance moves that is
    little.
    """

    def wanted(rect: QRectF) -> bool:
        return stale is None or stale.intersects(rect.toAlignedRect().adjusted(-2, -2, 2, 2))

    painter.setRenderHints(QPainter.RenderHint.Antialiasing | QPainter.RenderHint.SmoothPixmapTransform)
    painter.fillRect(QRectF(QPointF(0, 0), layout.size), QColor(look.theme.ground))
    painter.setFont(font)
    _curves(painter, layout, look)
    for chip in layout.chips:
        if wanted(chip.rect):
            _chip(painter, chip, layout, look, font)
    if wanted(layout.card):
        _card(painter, layout, look, font)
    for node in layout.nodes.values():
        if wanted(node.rect):
            _node(painter, node, layout, look, font)
    if not layout.foot.isEmpty():
        painter.setFont(font)
        painter.setPen(QColor(look.theme.dim))
        painter.drawText(
            layout.foot,
            Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft | Qt.TextFlag.TextWordWrap,
            look.sentence,
        )
    _verdict(painter, layout, look, font)
    if look.arrow is not None:
        draw_arrow(
            painter, *look.arrow, look.theme.kind("transition"), look.drop is not None and look.drop.possible
        )


def _bold(font: QFont) -> QFont:
    out = QFont(font)
    out.setWeight(QFont.Weight.DemiBold)
    return out


def _box(
    painter: QPainter,
    rect: QRectF,
    fill: QColor,
    edge: QColor | None,
    width: float = 1.0,
    dashed: bool = False,
) -> None:
    painter.setBrush(fill)
    if edge is None:
        painter.setPen(Qt.PenStyle.NoPen)
    else:
        pen = QPen(edge, width)
        if dashed:
            pen.setDashPattern([4, 3])
        painter.setPen(pen)
    painter.drawRoundedRect(rect.adjusted(width / 2, width / 2, -width / 2, -width / 2), RADIUS, RADIUS)


def _between(font: QFont, text: str, width: float, others: tuple[str, ...] = ()) -> str:
    """Return as much of a text as there is room for, with what tells it from those beside it."""
    return fitted(text, int(width), font.toString(), others)


def _upper(picture: QImage) -> QRectF:
    """Return the part of a picture in which arms and head are."""
    return QRectF(
        picture.width() * 0.24, picture.height() * 0.03, picture.width() * 0.52, picture.height() * 0.52
    )


def _curves(painter: QPainter, layout: Layout, look: GraphLook) -> None:
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


def _chip(painter: QPainter, chip: Chip, layout: Layout, look: GraphLook, font: QFont) -> None:
    t, beside = look.theme, tuple(plain(c.name) for c in layout.chips)
    target = look.drop is not None and (
        (look.drop_hit.area == "add" and chip.stance is None)
        or (look.drop_hit.area == "chip" and look.drop_hit.ident == chip.stance and chip.stance is not None)
    )
    current = chip.stance is not None and chip.stance == layout.stance
    hover = (look.hover.area == "add" and chip.stance is None) or (
        look.hover.area == "chip" and chip.stance is not None and look.hover.ident == chip.stance
    )
    edge = t.fill("stance") if current or target else QColor(t.line)
    _box(
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
        painter.drawLine(c - QPointF(5, 0), c + QPointF(5, 0))
        painter.drawLine(c - QPointF(0, 5), c + QPointF(0, 5))
        return
    inner = chip.rect.adjusted(10, 0, -10, 0)
    if chip.bare:
        painter.setFont(font)
        painter.setPen(QColor(t.text if current else t.dim))
        name = _between(font, plain(chip.name), inner.width(), beside)
        painter.drawText(inner, Qt.AlignmentFlag.AlignCenter, name)
        return
    picture = look.chip_pictures.get(chip.stance)
    if picture is not None:
        size = chip.rect.height() - 6
        painter.drawImage(
            QRectF(chip.rect.left() + 5, chip.rect.top() + 3, size, size), picture, _upper(picture)
        )
    else:
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(t.fill("stance"))
        painter.drawEllipse(QPointF(chip.rect.left() + 16, chip.rect.center().y()), 4, 4)
    inner.setLeft(chip.rect.left() + (chip.rect.height() + 8 if picture is not None else 28))
    metrics = QFontMetricsF(font)
    right = chip.words or ""
    count = str(chip.count)
    used = metrics.horizontalAdvance(count) + (metrics.horizontalAdvance(right) + 8 if right else 0) + 8
    painter.setFont(_bold(font) if current else font)
    painter.setPen(QColor(t.text))
    name = _between(painter.font(), plain(chip.name), inner.width() - used + 1, beside)
    painter.drawText(inner, Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft, name)
    painter.setFont(font)
    painter.setPen(QColor(t.dim))
    painter.drawText(inner, Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignRight, count)
    if right:
        painter.setPen(QColor(t.warning))
        painter.drawText(
            inner.adjusted(0, 0, -metrics.horizontalAdvance(count) - 8, 0),
            Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignRight,
            right,
        )


def _card(painter: QPainter, layout: Layout, look: GraphLook, font: QFont) -> None:
    t, card = look.theme, layout.card
    dragging = look.drop is not None
    stance = look.project.stance(layout.stance)
    edge = t.fill("stance") if stance is not None or dragging else QColor(t.line)
    loops = look.project.graphs[stance.layer].of(stance.id, "stance") if stance is not None else ()
    chosen = any(loop.id in look.selected for loop in loops)
    _box(
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
            "Drop a resting clip here\nto make the first stance\nof this layer:\nhands at the sides, say.",
        )  # fmt: skip
    else:
        bold = _bold(font)
        head = _card_name(painter, card, plain(stance.name), bold, look)
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
        words = f"{len(loops)} loop{'s' if len(loops) != 1 else ''}" if loops else "no loop yet"
        painter.setFont(font)
        painter.setPen(QColor(t.dim if loops else t.warning))
        foot = QRectF(card.left() + 12, card.bottom() - 26, card.width() - 24, 20)
        more = f"{words}  ·  starts here"
        if start and QFontMetricsF(font).horizontalAdvance(more) <= foot.width() - 1:
            words = more
        painter.drawText(foot, Qt.AlignmentFlag.AlignCenter, _between(font, words, foot.width()))
    return _card_drop(painter, layout, look, font)


def _card_name(painter: QPainter, card: QRectF, name: str, bold: QFont, look: GraphLook) -> QRectF:
    """Paint the stance's name on its card, in two lines where one is too short; return the room it takes."""
    t, measure = look.theme, QFontMetricsF(bold)
    room = card.width() - 24 - 16
    lines = [name]
    words = name.split()
    if measure.horizontalAdvance(name) > room and card.height() > 96 and len(words) > 1:
        cuts = ((" ".join(words[:n]), " ".join(words[n:])) for n in range(1, len(words)))
        lines = list(min(cuts, key=lambda two: max(map(measure.horizontalAdvance, two))))
    lines = [_between(bold, line, room) for line in lines]
    head = QRectF(card.left() + 12, card.top() + 8, card.width() - 24, 24.0 + 17 * (len(lines) - 1))
    wide = max(map(measure.horizontalAdvance, lines))
    left = head.center().x() - (wide + 16) / 2
    painter.setFont(bold)
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
        _offer(painter, zone, look, "stance", font)


def _offer(painter: QPainter, rect: QRectF, look: GraphLook, kind: Kind, font: QFont) -> None:
    """Say in a dashed box what a drop will do, or why it will not."""
    assert look.drop is not None
    t = look.theme
    color = QColor(t.kinds[kind]) if look.drop.possible else QColor(t.warning)
    fill = QColor(t.ground)
    fill.setAlpha(225)
    _box(painter, rect.adjusted(5, 5, -5, -5), fill, color, 1.4, dashed=True)
    if look.drop_at is not None:
        return  # it stands beside what is held
    painter.setPen(color)
    painter.setFont(font)
    painter.drawText(
        rect.adjusted(14, 8, -14, -8),
        Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap,
        look.drop.words.replace("*", ""),
    )


def _verdict(painter: QPainter, layout: Layout, look: GraphLook, font: QFont) -> None:
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
    _box(painter, box, QColor(t.panel), color if look.drop.possible else QColor(t.warning), 1.4)
    painter.setPen(QColor(t.text) if look.drop.possible else QColor(t.warning))
    painter.drawText(box.adjusted(10, 6, -10, -6), flags, words)


def _node(painter: QPainter, node: Node, layout: Layout, look: GraphLook, font: QFont) -> None:
    t = look.theme
    target = (
        look.drop is not None
        and look.drop_hit.kind == node.kind
        and look.drop_hit.area not in ("card", "loop", "chip", "add")
    )
    edge = t.fill(node.kind) if target and look.drop is not None and look.drop.possible else QColor(t.line)
    _box(painter, node.rect, QColor(t.card), edge, 1.5 if target else 1.0)
    head = node.header.adjusted(2 * GRID, 0, -2 * GRID, 0)
    painter.setFont(font)
    painter.setPen(t.kind(node.kind))
    painter.drawText(head, Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft, KIND_MARKS[node.kind])
    painter.setFont(_bold(font))
    painter.setPen(QColor(t.text))
    painter.drawText(
        head.adjusted(20, 0, 0, 0),
        Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft,
        KIND_TITLES[node.kind],
    )
    painter.setFont(font)
    painter.setPen(QColor(t.dim))
    painter.drawText(head, Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignRight, str(node.count))
    if node.kind == "transition" and layout.stance is not None:
        _other(painter, node, look, font)
    beside = tuple(row.words for other in layout.nodes.values() for row in other.rows)
    for row in node.rows:
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
        text = TEACH[node.kind] if layout.stance is not None else "Make a stance first."
        flags = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignTop | Qt.TextFlag.TextWordWrap
        room = node.body.adjusted(2 * GRID, 2, -GRID, 0)
        while text and painter.boundingRect(room, flags, text).height() > room.height():
            text = text.rpartition("\n")[0]
        painter.drawText(room, flags, text)
    if target:
        free = QRectF(node.rect.left() + 3, node.rect.bottom() - 60, node.rect.width() - 6, 56)
        if node.rect.height() < 130:
            free = QRectF(
                node.rect.left() + 3,
                node.header.bottom() - 2,
                node.rect.width() - 6,
                node.rect.height() - node.header.height(),
            )
        _offer(painter, free, look, node.kind, font)


def _other(painter: QPainter, node: Node, look: GraphLook, font: QFont) -> None:
    """The chooser of the stance that dropped transitions end in."""
    t, rect = look.theme, node.other
    found = look.project.stance(look.other)
    hover = look.hover.area == "other"
    _box(painter, rect, QColor(t.hover if hover else t.field), QColor(t.line))
    painter.setFont(font)
    painter.setPen(QColor(t.text if found is not None else t.warning))
    text, room = f"to {plain(found.name)}" if found is not None else "another stance?", rect.width() - 26
    if found is not None and QFontMetricsF(font).horizontalAdvance(text) > room:
        text = plain(found.name)
    painter.drawText(rect.adjusted(8, 0, -18, 0), Qt.AlignmentFlag.AlignVCenter, _between(font, text, room))
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
            _box(
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
            painter.drawImage(row.picture, picture, _upper(picture))
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
        _between(font, row.words, room, beside),
    )
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(QColor(t.line))
    painter.drawRoundedRect(bar, 1.5, 1.5)
    painter.setBrush(t.fill(kind))
    painter.drawRoundedRect(
        QRectF(bar.left(), bar.top(), max(3.0, bar.width() * bar_part(action.likelihood)), bar.height()),
        1.5,
        1.5,
    )
    if hover and look.hover.area == "bar":
        painter.drawEllipse(
            QPointF(bar.left() + bar.width() * bar_part(action.likelihood), bar.center().y()), 4.5, 4.5
        )


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
