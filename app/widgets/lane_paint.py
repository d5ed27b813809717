"""Paints the timeline: ruler, lanes, what plays, what was asked for, the playhead. Only what is in sight is
gone through.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Collection, Sequence
from dataclasses import dataclass

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFont, QFontMetricsF, QPainter, QPen

from app.look.names import make_readable_name, name_node_rows
from app.look.shortening import shorten_to_font, shorten_to_lines_in_font
from app.look.theme import KIND_MARKS, WindowTheme
from app.stage.playback_source import ShownPlayback
from app.translation import format_number
from app.widgets.lane_geometry import (
    EVEN,
    LEFT,
    NUMBERS,
    RULER,
    TITLES,
    LaneScale,
    RequestMark,
    Sizes,
    elide_text,
    place_lanes,
    split_lane,
)
from app.widgets.request_menu import STAGE
from metagraph.graph.model import LAYERS, Action, Layer, Project

INK = "#17181b"  # on the kinds' fills
PLAIN = 5.0  # pixels up to which a bar is a plain stroke without words
NARROW = 12.0  # the same of a request
SMALL = 0.85  # of the font's size, in which words are written that have no room otherwise
MIDDLE = Qt.AlignmentFlag.AlignVCenter


@dataclass(frozen=True)
class LaneScene:
    """All that is painted. ends: seconds at which a kept performance ends. actions, asks: ids of what is
    selected. locked: lanes whose requests are not to be moved.
    """

    shown: ShownPlayback
    marks: Sequence[RequestMark]
    scale: LaneScale
    width: float
    height: float
    layer: str
    ends: float | None
    actions: Collection[str]
    asks: Collection[str]
    sizes: Sizes = EVEN
    locked: Collection[str] = ()

    def lanes(self) -> dict[str, QRectF]:
        return place_lanes(self.height, self.sizes)


def paint_lane_scene(painter: QPainter, t: WindowTheme, scene: LaneScene) -> None:
    """Paint everything but the playhead."""
    painter.fillRect(QRectF(0, 0, scene.width, scene.height), QColor(t.panel))
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    _ruler(painter, t, scene)
    for name, lane in scene.lanes().items():
        painter.setPen(QColor(t.line))
        painter.drawLine(QPointF(0, lane.bottom()), QPointF(scene.width, lane.bottom()))
        muted = name in scene.shown.muted
        painter.setPen(QColor(t.text if name == scene.layer and not muted else t.dim))
        font = painter.font()
        font.setStrikeOut(muted)
        painter.setFont(font)
        painter.drawText(
            QRectF(14, lane.top(), LEFT - 16, lane.height()),
            MIDDLE,
            TITLES.get(name, name.replace("ghost", "Seed")),
        )
        font.setStrikeOut(False)
        painter.setFont(font)
    painter.setClipRect(QRectF(LEFT, 0, scene.width - LEFT, scene.height))
    if scene.shown.clip is None:
        _stage(painter, t, scene)
        for layer in LAYERS:
            painter.setOpacity(0.3 if layer in scene.shown.muted else 1.0)
            _layer(painter, t, scene, layer)
        painter.setOpacity(1.0)
        _ties(painter, t, scene)
        for mark in scene.marks:
            if mark.rect.right() >= LEFT and mark.rect.left() <= scene.width:
                _mark(painter, t, mark, mark.ask.id in scene.asks, scene.width)
    else:
        entry = scene.shown.project.clips[scene.shown.clip]
        area = split_lane(scene.lanes()["body"])[1]
        rect = QRectF(
            scene.scale.x(0), area.top(), max(2.0, entry.duration * scene.scale.each), area.height()
        )
        inner = _bar(painter, t, rect, QColor(t.line), False, scene.width)
        _chip(painter, t.text, inner, "", make_readable_name(entry.name))
    if scene.ends is not None and (x := scene.scale.x(scene.ends)) < scene.width:
        veil = QColor(t.ground)
        veil.setAlpha(150)
        painter.fillRect(QRectF(max(x, LEFT), RULER, scene.width, scene.height), veil)
    painter.setClipping(False)


def paint_playhead(painter: QPainter, t: WindowTheme, x: float, height: float) -> None:
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.setPen(QPen(QColor(t.text), 1.6))
    painter.drawLine(QPointF(x, 4), QPointF(x, height))
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(QColor(t.text))
    painter.drawPolygon([QPointF(x - 5, 4), QPointF(x + 5, 4), QPointF(x, 11)])


def paint_badge(painter: QPainter, t: WindowTheme, at: QPointF, words: str, width: float) -> None:
    """Paint words at the ruler while something is dragged, its middle at `at`, always in sight."""
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    wide = painter.fontMetrics().horizontalAdvance(words) + 14
    rect = QRectF(min(max(LEFT, at.x() - wide / 2), width - wide - 2), 1, wide, NUMBERS)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(QColor(t.strong))
    painter.drawRoundedRect(rect, 4, 4)
    painter.setPen(QColor(t.on_strong))
    painter.drawText(rect, Qt.AlignmentFlag.AlignCenter, words)


def _ruler(painter: QPainter, t: WindowTheme, scene: LaneScene) -> None:
    scale = scene.scale
    step = scale.step()
    mark = max(0.0, (scale.first // step) * step)
    painter.setPen(QColor(t.dim))
    while scale.x(mark) < scene.width:
        x = scale.x(mark)
        words = f"{format_number(mark, 'g')} s" if step < 60 else f"{format_number(mark / 60, 'g')} min"
        if x >= LEFT - 1 and x + painter.fontMetrics().horizontalAdvance(words) / 2 + 1 <= scene.width:
            painter.drawText(QRectF(x - 40, 0, 80, NUMBERS), Qt.AlignmentFlag.AlignCenter, words)
        mark = round(mark + step, 3)


def _stage(painter: QPainter, t: WindowTheme, scene: LaneScene) -> None:
    """Speech as bars with its words, looks as lines under them."""
    scale, shown = scene.scale, scene.shown
    area, track = split_lane(scene.lanes()[STAGE])[1], shown.plan.track
    for look, following in zip(track.looks, (*track.looks[1:], None), strict=False):
        until = min(look.end, following.start if following else look.end, max(shown.length, look.start))
        left, right = scale.x(look.start), scale.x(until)
        if right > LEFT and left < scene.width:
            painter.setPen(QPen(QColor(t.dim), 1.4, Qt.PenStyle.DotLine))
            painter.drawLine(
                QPointF(max(left, LEFT), area.bottom()), QPointF(min(right, scene.width), area.bottom())
            )
    for speech in track.speeches:
        left, right = scale.x(speech.start), scale.x(speech.end)
        if right > LEFT and left < scene.width:
            rect = QRectF(left, area.top(), max(3.0, right - left - 1), area.height() - 3)
            inner = _bar(painter, t, rect, QColor(t.hover), False, scene.width)
            if inner.width() > 10:
                painter.setPen(QColor(t.text))
                painter.drawText(inner, MIDDLE, _fitting(painter, speech.text, inner.width()))


def _layer(painter: QPainter, t: WindowTheme, scene: LaneScene, layer: Layer) -> None:
    """Stances as a quiet band, cues on it in their kind's colour."""
    scale, shown = scene.scale, scene.shown
    plan, area = shown.plan.layers[layer], split_lane(scene.lanes()[layer])[1]
    begin, end = scale.first, scale.seconds(scene.width)
    edges = [
        plan.past.free,
        *(cue.end for cue in plan.cues if cue.then != cue.stance),
        max(shown.length, end),
    ]
    first = plan.stance_at(-1.0) if plan.rests else None
    stances = [first or "", *(cue.then for cue in plan.cues if cue.then != cue.stance)] if plan.rests else []
    fill = t.fill("stance")
    fill.setAlpha(70 if t.name == "dark" else 90)
    first_cue = bisect_left(plan.cues, begin, key=lambda c: c.end)
    cues = [c for c in plan.cues[first_cue:] if c.start <= end]
    spans = [(scale.x(c.start), max(scale.x(c.start) + 3.0, scale.x(c.end) - 1)) for c in cues]
    for stance, a, b in zip(stances, edges, edges[1:], strict=False):
        if b < begin or a > end:
            continue
        found = shown.project.stance(stance)
        left, right = max(scale.x(a), LEFT - 8.0), min(scale.x(b), scene.width + 8.0)
        rect = QRectF(left, area.top(), right - left - 1, area.height())
        _bar(painter, t, rect, fill, False)
        if found is not None:
            _in_the_clear(painter, t, rect, found.name, scene.width, spans)
    names = [describe_cue(shown.project, c.action) for c in cues]
    beside = tuple(sorted(set(names)))
    for cue, name, (left, right) in zip(cues, names, spans, strict=True):
        rect = QRectF(left, area.top(), right - left, area.height())
        fill = t.fill(cue.action.kind)
        inner = _bar(painter, t, rect, fill, cue.action.id in scene.actions, scene.width)
        _chip(painter, INK, inner, KIND_MARKS[cue.action.kind], name, beside)


def _in_the_clear(
    painter: QPainter,
    t: WindowTheme,
    rect: QRectF,
    words: str,
    width: float,
    spans: Sequence[tuple[float, float]],
) -> None:
    """Write a stance's name on its band if nothing plays over it: where it first has room, else where it has
    most.
    """
    at, gaps = max(rect.left(), LEFT), []
    end = min(rect.right(), width)
    for left, right in spans:
        if right > at and left < end:
            gaps.append((at, left))
            at = max(at, right)
    gaps.append((at, end))
    wanted = painter.fontMetrics().horizontalAdvance(words) + 12
    found = next((g for g in gaps if g[1] - g[0] >= wanted), max(gaps, key=lambda g: g[1] - g[0]))
    inner = QRectF(found[0] + 7, rect.top(), found[1] - found[0] - 10, rect.height())
    if inner.width() > 10:
        painter.setPen(QColor(t.text))
        out = shorten_to_font(words, int(inner.width()), painter.font().toString())
        if len(out) > 4 or out == words:
            painter.drawText(inner, MIDDLE, out)


def describe_cue(project: Project, action: Action) -> str:
    """Return what tells an action from the others of its node; its stance stands on the band behind it."""
    names = name_node_rows(project, action.layer, action.stance, action.kind)
    return names.get(action.id) or make_readable_name(action.name)


def _bar(
    painter: QPainter, t: WindowTheme, rect: QRectF, fill: QColor, selected: bool, width: float = 1e6
) -> QRectF:
    """Paint a bar; return where in it words have room, empty if they have none."""
    if rect.width() <= PLAIN and not selected:
        painter.fillRect(rect, fill)
        return QRectF()
    painter.setPen(QPen(QColor(t.text), 2) if selected else Qt.PenStyle.NoPen)
    painter.setBrush(fill)
    painter.drawRoundedRect(rect, 4, 4)
    left = max(rect.left(), LEFT)
    return QRectF(left + 7, rect.top(), min(rect.right(), width) - left - 10, rect.height())


def _chip(
    painter: QPainter, ink: str, inner: QRectF, sign: str, words: str, beside: tuple[str, ...] = ()
) -> None:
    """Write a sign and, as far as they have room, words that are distinguished from those `beside`: in a
    line, else in the small font in as many as the bar is high, else what tells them apart; else the sign
    alone.
    """
    painter.setPen(QColor(ink))
    lead = painter.fontMetrics().horizontalAdvance(f"{sign} ") if sign else 0
    room = inner.adjusted(lead, 0, 0, 0)
    normal, small = painter.font(), QFont(painter.font())
    small.setPixelSize(max(9, round(painter.fontInfo().pixelSize() * SMALL)))
    tall = QFontMetricsF(small).height() - 1
    for font, lines in ((normal, 1), (small, max(1, int(room.height() / tall)))):
        others = beside if font is small else ()
        shown = (
            shorten_to_lines_in_font(words, int(room.width()), lines, font.toString(), others)
            if room.width() > 0
            else ()
        )
        if shown and (font is small or shown == (words,)):
            break
    if sign and inner.width() >= lead - 4:
        painter.drawText(inner, MIDDLE, sign)
    painter.setFont(font)
    line = painter.fontMetrics().height() if font is normal else tall
    top = room.center().y() - len(shown) * line / 2
    for n, text in enumerate(shown):
        painter.drawText(QRectF(room.left(), top + n * line, room.width() + 2, line), MIDDLE, text)
    painter.setFont(normal)


def _fitting(painter: QPainter, words: str, width: float) -> str:
    """Return as much of the words as there is room for; hardly any, the sign in front of them alone."""
    out = elide_text(words, painter.font().toString(), int(width))
    return out if len(out) > 3 or out == words else words[:1]


def _ties(painter: QPainter, t: WindowTheme, scene: LaneScene) -> None:
    """Lead from each request down to what plays for it."""
    painter.setPen(QPen(QColor(t.dim), 1.2))
    places = scene.lanes()
    for mark in scene.marks:
        if mark.answer is None or mark.answer.at is None or mark.kind is None or mark.late <= 0.02:
            continue
        x, to = mark.rect.left() + 1, scene.scale.x(mark.answer.at)
        if to < LEFT or x > scene.width:
            continue
        lane = next(r for r in places.values() if r.contains(QPointF(1, mark.rect.center().y())))
        painter.drawLine(QPointF(x, mark.rect.bottom()), QPointF(to, split_lane(lane)[1].top()))


def _mark(painter: QPainter, t: WindowTheme, mark: RequestMark, selected: bool, width: float) -> None:
    color = QColor(t.warning) if mark.lost else t.kind(mark.kind) if mark.kind else QColor(t.dim)
    if mark.rect.width() <= NARROW and not selected:
        painter.fillRect(mark.rect.adjusted(0, 1, -1, -1), color)
        return
    painter.setPen(
        QPen(color, 2.0 if selected else 1.2, Qt.PenStyle.DashLine if mark.lost else Qt.PenStyle.SolidLine)
    )
    painter.setBrush(QColor(t.hover if selected else t.card))
    painter.drawRoundedRect(mark.rect.adjusted(0, 0.5, 0, -0.5), 4, 4)
    inner = mark.rect.adjusted(6, 0, -4, 0)
    inner.setRight(min(inner.right(), width - 2))
    painter.setPen(QColor(t.warning if mark.lost else t.text))
    words = f"⚠ {mark.words}" if mark.lost else mark.words
    painter.drawText(inner, MIDDLE, _fitting(painter, words, inner.width()))
