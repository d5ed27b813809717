"""Paints a machine: the still part, which is kept as a picture, and what changes under the mouse on top of
it.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from math import atan2, cos, sin

import numpy as np
from PySide6.QtCore import QLineF, QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFont, QFontMetricsF, QPainter, QPainterPath, QPen, QPixmap, QPolygonF

from app.features.manual.manual_scene import LOOP, ManualScene, ManualView
from app.look.theme import WindowTheme
from app.translation import format_number, tr, tr_plural
from metagraph.graph.manual.machine import ANY, Alias, Link, State
from metagraph.graph.model import Project

GRID = 24.0
TINY, SMALL = 0.24, 0.62  # scales below which nodes show no name, and only their name
HEADS = 0.16  # scale below which arrows have no heads
LABELS = 40  # arrows, up to which each tells what it waits for


@dataclass(frozen=True)
class ManualLook:
    """What is painted. pictures: clip id -> its picture, as large as it is shown. troubles: state or link id
    -> words.
    """

    theme: WindowTheme
    project: Project
    scene: ManualScene
    view: ManualView
    pictures: Mapping[str, QPixmap]
    font: QFont
    states: Collection[str] = ()
    links: Collection[str] = ()
    troubles: Mapping[str, str] = field(default_factory=dict)


def paint_still(
    painter: QPainter, look: ManualLook, rect: QRectF, without: Collection[str] = (), fast: bool = False
) -> None:
    """Paint ground, arrows and nodes as they are unselected. without: nodes left out, with their arrows.
    fast: lines without smoothing.
    """
    painter.fillRect(rect, QColor(look.theme.ground))
    _grid(painter, look, rect)
    gone = frozenset(look.scene.touching(without)) if without else frozenset()
    _arrows(painter, look, rect, gone, fast)
    shown = look.view.rect(rect.size()).adjusted(-40, -40, 40, 40)
    for ident, box in look.scene.nodes.items():
        if ident not in without and box.intersects(shown):
            paint_node(painter, look, ident, rough=fast and look.view.scale < SMALL)


@lru_cache(maxsize=256)
def mix_colors(a: str, b: str, part: float) -> QColor:
    """Return a colour on the way from one to another."""
    x, y = QColor(a), QColor(b)
    return QColor(
        *(
            round(m + (n - m) * part)
            for m, n in ((x.red(), y.red()), (x.green(), y.green()), (x.blue(), y.blue()))
        )
    )


def _grid(painter: QPainter, look: ManualLook, rect: QRectF) -> None:
    step = GRID * look.view.scale
    if step < 9:
        step *= 4
    if step < 9:
        return
    painter.setPen(QPen(mix_colors(look.theme.ground, look.theme.line, 0.28), 0))
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)
    origin = look.view.to(QPointF(0, 0))
    lines = [
        QLineF(x, rect.top(), x, rect.bottom()) for x in np.arange(origin.x() % step, rect.width(), step)
    ]
    lines += [
        QLineF(rect.left(), y, rect.right(), y) for y in np.arange(origin.y() % step, rect.height(), step)
    ]
    painter.drawLines(lines)


def _arrows(painter: QPainter, look: ManualLook, rect: QRectF, gone: Collection[str], fast: bool) -> None:
    scene, view = look.scene, look.view
    lines = (scene.lines - np.array([view.x, view.y, view.x, view.y])) * view.scale
    keep = np.array([x.id not in gone for x in scene.straight], bool) if gone else np.ones(len(lines), bool)
    low, high = np.minimum(lines[:, :2], lines[:, 2:]), np.maximum(lines[:, :2], lines[:, 2:])
    keep &= (high[:, 0] >= 0) & (low[:, 0] <= rect.width()) & (high[:, 1] >= 0) & (low[:, 1] <= rect.height())
    count = int(keep.sum())
    smooth = not fast or count < 300
    # Not see-through: lines that are mixed with what is under them take twenty times as long.
    color = mix_colors(look.theme.ground, look.theme.dim, max(0.36, min(0.92, 130 / max(1, count))))
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, smooth)
    for waits in (False, True):
        some = lines[keep & (scene.requests == waits)]
        pen = QPen(color, 0 if not smooth else 1.3 if count < 600 else 1)
        if waits and smooth and count < 600:
            pen.setDashPattern([5, 3])
        painter.setPen(pen)
        painter.drawLines([QLineF(*row) for row in some.tolist()])
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, True)
    for ident, circle in scene.loops.items():
        if ident not in gone:
            _loop(painter, view, circle, color, 1.3)
    if view.scale >= HEADS and not (fast and count > 300):
        color = mix_colors(look.theme.ground, look.theme.dim, max(0.5, min(0.92, 130 / max(1, count))))
        _heads(painter, lines[keep], color, min(1.0, max(0.55, view.scale)) * 9)
    if count <= LABELS and view.scale >= SMALL:
        for link, row in zip(scene.straight, lines, strict=True):
            if link.id not in gone and np.hypot(row[2] - row[0], row[3] - row[1]) > 90:
                _label(painter, look, link)


def _heads(painter: QPainter, lines: np.ndarray, color: QColor, size: float) -> None:
    """Draw a filled triangle at each line's end; all in one path."""
    if not len(lines):
        return
    along = lines[:, 2:] - lines[:, :2]
    length = np.maximum(np.hypot(along[:, 0], along[:, 1]), 1e-6)[:, None]
    unit = along / length
    side = np.stack([-unit[:, 1], unit[:, 0]], 1) * size * 0.42
    tip, back = lines[:, 2:], lines[:, 2:] - unit * size
    corners = np.stack([tip, back + side, back - side], 1)[length[:, 0] > size]
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(color)
    for a, b, c in corners.tolist():
        painter.drawConvexPolygon([QPointF(*a), QPointF(*b), QPointF(*c)])


def _loop(painter: QPainter, view: ManualView, circle: QRectF, color: QColor, width: float) -> None:
    box = QRectF(view.to(circle.topLeft()), view.to(circle.bottomRight()))
    painter.setPen(QPen(color, width))
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.drawArc(box, -40 * 16, 280 * 16)
    if view.scale >= HEADS:
        angle = -0.70
        tip = box.center() + QPointF(cos(angle), -sin(angle)) * (LOOP * view.scale)
        _heads(
            painter,
            np.array([[tip.x() + 9, tip.y() - 14, tip.x(), tip.y()]]),
            color,
            8 * min(1.0, view.scale),
        )


def paint_link(
    painter: QPainter, look: ManualLook, link: Link, color: QColor, width: float, told: bool = True
) -> None:
    """Paint one arrow on top of all. told: with what it waits for."""
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, True)
    if link.id in look.scene.loops:
        _loop(painter, look.view, look.scene.loops[link.id], color, width)
    elif link.id in look.scene.places:
        x1, y1, x2, y2 = look.scene.lines[look.scene.places[link.id]]
        paint_arrow(
            painter,
            look.view.to(QPointF(x1, y1)),
            look.view.to(QPointF(x2, y2)),
            color,
            width,
            look.view.scale,
        )
    if told and look.view.scale >= 0.35:
        _label(painter, look, link, color)


def paint_arrow(painter: QPainter, a: QPointF, b: QPointF, color: QColor, width: float, scale: float) -> None:
    """Paint an arrow between two points of the widget."""
    painter.setPen(QPen(color, width))
    painter.drawLine(a, b)
    _heads(painter, np.array([[a.x(), a.y(), b.x(), b.y()]]), color, min(1.0, max(0.7, scale)) * 11)


def describe_link(link: Link) -> str:
    """Say in a few words when a link is taken."""
    at = f"{format_number(link.exit_time, 'g')} s" if link.exit_time is not None else ""
    if not at and link.exit_part is not None and (link.exit_part < 1 or link.condition.when == "request"):
        at = tr("at the end") if link.exit_part >= 1 else tr("at {part:g} %", part=link.exit_part * 100)
    return f"{link.condition.trigger}  {at}".strip() if link.condition.when == "request" else at


def _label(painter: QPainter, look: ManualLook, link: Link, color: QColor | None = None) -> None:
    words = describe_link(link)
    trouble = link.id in look.troubles
    if not words and not trouble:
        return
    if trouble:
        words = f"⚠ {words}".strip()
    font = _font(look.font.toString(), 11.0, False)
    painter.setFont(font)
    at = look.view.to(look.scene.middle(link.id))
    text = _elided(words, font.toString(), 120)
    wide = QFontMetricsF(font).horizontalAdvance(text) + 12
    box = QRectF(at.x() - wide / 2, at.y() - 9, wide, 18)
    painter.setPen(QPen(color or QColor(look.theme.line), 1))
    painter.setBrush(QColor(look.theme.panel))
    painter.drawRoundedRect(box, 9, 9)
    painter.setPen(
        QColor(look.theme.warning if trouble else look.theme.text if color is not None else look.theme.dim)
    )
    painter.drawText(box, Qt.AlignmentFlag.AlignCenter, text)


# --- nodes


def paint_node(
    painter: QPainter,
    look: ManualLook,
    ident: str,
    selected: bool = False,
    hover: bool = False,
    target: bool = False,
    rough: bool = False,
) -> None:
    """Paint a node. target: a link would end here if it were let go now. rough: only its box, while all
    moves.
    """
    t, view = look.theme, look.view
    box = look.scene.nodes[ident]
    rect = QRectF(view.to(box.topLeft()), view.to(box.bottomRight()))
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, not rough)
    radius = 9 * view.scale if not rough else 0.0
    painter.setBrush(QColor(t.hover if hover or target else t.card))
    border = (
        QColor(t.kinds["stance"]) if target else QColor(t.text if selected else t.dim if hover else t.line)
    )
    painter.setPen(QPen(border, 2.2 if selected or target else 1.2))
    if ident == ANY:
        painter.drawRoundedRect(rect, rect.height() / 2, rect.height() / 2)
        if view.scale >= TINY:
            painter.setFont(_font(look.font.toString(), max(9.5, 13 * view.scale), True))
            painter.setPen(QColor(t.dim))
            painter.drawText(
                rect, Qt.AlignmentFlag.AlignCenter, tr("Any state") if view.scale > 0.5 else tr("Any")
            )
        return
    if ident in look.scene.manual.aliases:
        paint_alias(painter, look, look.scene.manual.aliases[ident], rect)
        return
    state = look.scene.manual.states[ident]
    if rough:
        painter.drawRect(rect)
    else:
        painter.drawRoundedRect(rect, radius, radius)
    if ident == look.scene.manual.start:
        _start(painter, look, rect)
    if view.scale < TINY:
        return
    if view.scale < SMALL:
        _small(painter, look, state, rect.adjusted(3, 0, -3, 0))
    else:
        _whole(painter, look, state, rect)
    if ident in look.troubles and view.scale < SMALL:
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(t.warning))
        painter.drawEllipse(rect.topRight() + QPointF(-2, 2), 3.2, 3.2)
    elif ident in look.troubles:
        c = QPointF(rect.right() - 11, rect.top() + 11)
        painter.setPen(QPen(QColor(t.warning), 1.4))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawPolygon(QPolygonF([c + QPointF(0, -5), c + QPointF(5.5, 4.5), c + QPointF(-5.5, 4.5)]))
        painter.drawLine(c + QPointF(0, -1.5), c + QPointF(0, 1.5))


def paint_alias(painter: QPainter, look: ManualLook, alias: Alias, rect: QRectF) -> None:
    """Paint an alias: a shape of two layers, its name, and how many states it stands for."""
    t, scale, count = look.theme, look.view.scale, len(look.scene.manual.members(alias))
    painter.drawRoundedRect(rect.translated(4 * scale, -4 * scale), rect.height() / 2, rect.height() / 2)
    painter.drawRoundedRect(rect, rect.height() / 2, rect.height() / 2)
    if scale < TINY:
        return
    room = 14 * scale if scale >= SMALL else 3
    inner = rect.adjusted(room, 0, -room, 0)
    words = tr("every state") if alias.every else tr_plural("{count:,} state", "{count:,} states", count)
    if alias.entry is not None:
        words += tr(", entry state {name}", name=look.scene.manual.states[alias.entry].name)
    lines = [(alias.name, max(9.5, 12 * scale), True, t.text)]
    if scale >= SMALL:
        lines.append((words, max(9.0, 11 * scale), False, t.dim))
    high = inner.height() / (len(lines) + 0.6)
    for n, (text, pixels, bold, color) in enumerate(lines):
        font = _font(look.font.toString(), pixels, bold)
        painter.setFont(font)
        painter.setPen(QColor(color))
        place = QRectF(inner.left(), inner.top() + high * (n + 0.3), inner.width(), high)
        painter.drawText(
            place, Qt.AlignmentFlag.AlignCenter, _elided(text, font.toString(), int(place.width()))
        )


def _start(painter: QPainter, look: ManualLook, rect: QRectF) -> None:
    """Mark the state in which the layer begins: an arrow that comes from nowhere."""
    size = max(10.0, 26 * look.view.scale)
    color, y = QColor(look.theme.text), rect.center().y()
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(color)
    painter.drawEllipse(QPointF(rect.left() - size, y), size * 0.17, size * 0.17)
    paint_arrow(
        painter, QPointF(rect.left() - size, y), QPointF(rect.left() - 1, y), color, 1.6, look.view.scale
    )


def _whole(painter: QPainter, look: ManualLook, state: State, rect: QRectF) -> None:
    t, scale = look.theme, look.view.scale
    side = rect.height() - 12 * scale
    place = QRectF(rect.left() + 6 * scale, rect.top() + 6 * scale, side, side)
    picture = look.pictures.get(state.clip)
    clip = QPainterPath()
    clip.addRoundedRect(place, 6 * scale, 6 * scale)
    painter.fillPath(clip, QColor(t.field))
    if picture is not None:
        painter.save()
        painter.setClipPath(clip)
        painter.drawPixmap(place, picture, QRectF(picture.rect()))
        painter.restore()
    left = place.right() + 9 * scale
    room = rect.right() - left - (20 if state.id in look.troubles else 8) * scale
    bold, plain = (
        _font(look.font.toString(), 12 * scale, True),
        _font(look.font.toString(), 11 * scale, False),
    )
    lines = name_lines(state.name, bold.toString(), int(room))
    step = 15 * scale
    y = rect.center().y() - (len(lines) + 1) * step / 2
    flags = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter
    painter.setFont(bold)
    painter.setPen(QColor(t.text))
    for line in lines:
        painter.drawText(QRectF(left, y, room + 4, step), flags, line)
        y += step
    painter.setFont(plain)
    painter.setPen(QColor(t.dim))
    words = _elided(describe_state_facts(look.project, state), plain.toString(), int(room))
    painter.drawText(QRectF(left, y, room + 4, step), flags, words)


@lru_cache(maxsize=8192)
def name_lines(name: str, font: str, width: int) -> tuple[str, ...]:
    """Return a name in the one or two lines it needs, broken where its words meet, and shortened if that is
    not enough.
    """
    made = QFont()
    made.fromString(font)
    metrics = QFontMetricsF(made)
    if metrics.horizontalAdvance(name) <= width:
        return (name,)
    places = [n + 1 for n, c in enumerate(name[:-1]) if c in "_ -." and name[n + 1] not in "_ -."] or [
        len(name) // 2
    ]
    best = min(
        places, key=lambda n: max(metrics.horizontalAdvance(name[:n]), metrics.horizontalAdvance(name[n:]))
    )
    return _elided(name[:best].rstrip(), font, width), _elided(name[best:], font, width)


def describe_state_facts(project: Project, state: State) -> str:
    """Say how long a state plays, whether it repeats, and which arm it moves."""
    entry = project.clips.get(state.clip)
    length = entry.duration if entry is not None else 0.0
    end = length if state.end is None else min(state.end, length)
    words = [f"{format_number(max(0.0, end - state.start), '.2f')} s"]
    if state.loop:
        words.insert(0, "↻")
    if state.limb != "both":
        words.append(tr(state.limb))
    if state.joints:
        words.append(tr_plural("{count:,} joint", "{count:,} joints", len(state.joints)))
    if state.joint_weights:
        words.append(tr("{soft} partly", soft=len(state.joint_weights)))
    return "  ".join(words)


def _small(painter: QPainter, look: ManualLook, state: State, rect: QRectF) -> None:
    """Write a name if there is no room for more: in two lines, or in one what it ends with, which tells it
    from its like.
    """
    font = _font(look.font.toString(), 10.0, False)
    painter.setFont(font)
    painter.setPen(QColor(look.theme.text))
    key = font.toString()
    if rect.height() > 26:
        flags = Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap
        painter.drawText(
            rect, int(flags), _elided(state.name.replace("_", " "), key, int(rect.width() * 1.7))
        )
    else:
        words = state.name.rsplit("__", 1)[-1].replace("_", " ")
        painter.drawText(
            rect,
            Qt.AlignmentFlag.AlignCenter,
            _elided(words, key, int(rect.width()), Qt.TextElideMode.ElideRight),
        )


def paint_playing(painter: QPainter, look: ManualLook, ident: str, part: float) -> None:
    """Show that a state plays, and how far it is, 0..1: a line along its bottom."""
    box = look.scene.nodes.get(ident)
    if box is None:
        return
    rect = QRectF(look.view.to(box.bottomLeft()), look.view.to(box.bottomRight()))
    wide, y = rect.width() - 16 * look.view.scale, rect.top() - max(2.0, 3 * look.view.scale)
    left = rect.left() + 8 * look.view.scale
    color = QColor(look.theme.kinds["stance"])
    painter.setPen(QPen(color, max(2.0, 3 * look.view.scale), Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap))
    painter.drawLine(QPointF(left, y), QPointF(left + wide * min(1.0, max(0.0, part)), y))


def paint_port(painter: QPainter, look: ManualLook, ident: str, at: QPointF) -> None:
    """Show on a node's border that a link can be drawn from here. at: a point of the widget."""
    box = look.scene.nodes[ident]
    rect = QRectF(look.view.to(box.topLeft()), look.view.to(box.bottomRight()))
    angle = atan2(at.y() - rect.center().y(), at.x() - rect.center().x())
    far = max(rect.width(), rect.height())
    line = QLineF(rect.center(), rect.center() + QPointF(cos(angle), sin(angle)) * far)
    for side in (
        QLineF(rect.topLeft(), rect.topRight()), QLineF(rect.topRight(), rect.bottomRight()),
        QLineF(rect.bottomRight(), rect.bottomLeft()), QLineF(rect.bottomLeft(), rect.topLeft()),
    ):  # fmt: skip
        kind, point = side.intersects(line)
        if kind == QLineF.IntersectionType.BoundedIntersection:
            painter.setPen(QPen(QColor(look.theme.card), 1.5))
            painter.setBrush(QColor(look.theme.kinds["stance"]))
            painter.drawEllipse(point, 5.5, 5.5)
            return


def paint_map(painter: QPainter, look: ManualLook, place: QRectF, size: QRectF) -> None:
    """Paint all nodes small, and which part is shown. place: where; size: the widget."""
    t, bounds = look.theme, look.scene.bounds.united(look.view.rect(size.size()))
    scale = min(place.width() / max(1, bounds.width()), place.height() / max(1, bounds.height()))
    ground = QColor(t.panel)
    ground.setAlpha(225)
    painter.setPen(QPen(QColor(t.line), 1))
    painter.setBrush(ground)
    painter.drawRoundedRect(place.adjusted(-6, -6, 6, 6), 6, 6)
    origin = place.center() - (bounds.center() * scale)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(QColor(t.dim))
    for ident, box in look.scene.nodes.items():
        if ident != ANY:
            painter.drawRect(QRectF(box.topLeft() * scale + origin, box.size() * scale))
    shown = look.view.rect(size.size())
    painter.setPen(QPen(QColor(t.text), 1))
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.drawRect(QRectF(shown.topLeft() * scale + origin, shown.size() * scale))


@lru_cache(maxsize=64)
def _font(base: str, pixels: float, bold: bool) -> QFont:
    font = QFont()
    font.fromString(base)
    font.setPixelSize(max(1, round(pixels)))
    font.setWeight(QFont.Weight.DemiBold if bold else QFont.Weight.Normal)
    return font


@lru_cache(maxsize=8192)
def _elided(text: str, font: str, width: int, mode: Qt.TextElideMode = Qt.TextElideMode.ElideMiddle) -> str:
    made = QFont()
    made.fromString(font)
    return QFontMetricsF(made).elidedText(text, mode, max(8, width))
