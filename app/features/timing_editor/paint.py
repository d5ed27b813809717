"""Paints an action's rows: everything but the playhead and what is being dragged."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QBrush, QColor, QFont, QFontMetricsF, QPainter, QPen, QPolygonF

from app.features.timing_editor.axis import Axis
from app.features.timing_editor.numbers import place_numbers
from app.features.timing_editor.rows import GUTTER, RIGHT, RULER, TITLES, TrackRows
from app.features.timing_editor.track import Facts, describe_handle
from app.look.theme import KIND_MARKS, WindowTheme
from app.translation import format_number, tr
from app.widgets.vocabulary import get_vocabulary_word
from app.widgets.waveforms import join_columns, paint_columns

Array = NDArray[Any]

INK = "#17181b"  # on blocks, whose colours are the same in both themes
STILL = "#8b929c"  # of the hold
MIDDLE = Qt.AlignmentFlag.AlignVCenter
LINES = (Qt.PenStyle.SolidLine, Qt.PenStyle.DashLine)
MARGIN = 0.12  # of the greatest speed or distance left free above it
WRONG = 0.015  # of a clip about an end that shows, in which its bars are in the colour of mistakes
CHIP = 17.0  # pixels of a handle's number
ORDER = ("start", "end", "stroke", "in", "out", "exit")  # whose numbers find their place first


@dataclass(frozen=True)
class TimingLook:
    """t: the theme. small: the font of numbers and names of rows."""

    t: WindowTheme
    small: QFont

    def wide(self, words: str) -> float:
        return QFontMetricsF(self.small).horizontalAdvance(words)

    def elided(self, words: str, width: float, middle: bool = False) -> str:
        mode = Qt.TextElideMode.ElideMiddle if middle else Qt.TextElideMode.ElideRight
        return QFontMetricsF(self.small).elidedText(words, mode, width)


def lay_out_ruler(look: TimingLook, axis: Axis) -> list[tuple[float, str, QRectF]]:
    """Return where the ruler's marks are, what is written at them, and where that stands."""
    out = []
    for seconds in axis.marks():
        x = axis.x(seconds)
        words = format_number(seconds, "g") + (" s" if seconds == 0 or axis.each < 800 else "")
        half = look.wide(words) / 2
        left = min(max(x - half, GUTTER), axis.left + axis.width + RIGHT - 2 * half - 2)
        out.append((x, words, QRectF(left, 0, 2 * half + 2, RULER - 4)))
    return out


def paint_ruler(painter: QPainter, look: TimingLook, axis: Axis) -> None:
    """Paint seconds along the top."""
    painter.setFont(look.small)
    painter.setPen(QColor(look.t.dim))
    for x, words, place in lay_out_ruler(look, axis):
        painter.drawText(place, MIDDLE, words)
        painter.drawLine(QPointF(x, RULER - 4), QPointF(x, RULER - 1))


def paint_row_names(painter: QPainter, look: TimingLook, rows: TrackRows, facts: Facts) -> None:
    """Paint what the rows are, at the left."""
    painter.setFont(look.small)
    t, line = look.t, QFontMetricsF(look.small).height()
    if rows.title.height() > 0:
        painter.setPen(t.kind(facts.action.kind))
        words = f"{KIND_MARKS[facts.action.kind]} {facts.name}"
        painter.drawText(
            rows.title.adjusted(10, 2, -10, 0), MIDDLE, look.elided(words, rows.title.width() - 20, True)
        )
    painter.setPen(QColor(t.dim))
    for name, rect in rows.rows.items():
        if name in TITLES and name != "speed":
            painter.drawText(QRectF(10, rect.top(), GUTTER - 14, rect.height()), MIDDLE, TITLES[name])
    for n, hand in enumerate(facts.hands):
        rect = rows.rows[f"hand {n}"]
        words = look.elided(hand, GUTTER - 14, True)
        painter.drawText(QRectF(10, rect.top(), GUTTER - 14, rect.height()), MIDDLE, words)
    speed = rows.rows["speed"]
    y = speed.top() + 2
    painter.drawText(QRectF(10, y, GUTTER - 14, line), MIDDLE, f"{format_number(facts.top, '.1f')} m/s")
    y += line + 2
    for n, curve in enumerate(facts.curves):
        if y + line > speed.bottom():
            break
        painter.setPen(QPen(t.kind(facts.action.kind), 1.6, LINES[n % 2]))
        painter.drawLine(QPointF(10, y + line / 2), QPointF(22, y + line / 2))
        painter.setPen(QColor(t.dim))
        painter.drawText(
            QRectF(26, y, GUTTER - 28, line),
            MIDDLE,
            look.elided(get_vocabulary_word(curve.name), GUTTER - 28, True),
        )
        y += line


def paint_row_ground(painter: QPainter, look: TimingLook, axis: Axis, rows: TrackRows, facts: Facts) -> None:
    """Paint what lies behind the rows: the part that plays is lighter than the rest of the clip."""
    t = look.t
    for name, rect in rows.rows.items():
        if name not in ("phases", "numbers"):
            left, right = max(axis.x(0), axis.left), min(axis.x(axis.length), axis.left + axis.width)
            painter.fillRect(QRectF(left, rect.top(), right - left, rect.height()), QColor(t.field))
    speed = rows.rows["speed"]
    start, end = (axis.x(s) for s in facts.span)
    painter.fillRect(QRectF(start, speed.top(), end - start, speed.height()), QColor(t.card))


def paint_blends(painter: QPainter, look: TimingLook, axis: Axis, rows: TrackRows, facts: Facts) -> None:
    """Paint the blends as ramps: how much of the action is seen."""
    rect, color = rows.rows["speed"], look.t.fill(facts.action.kind)
    color.setAlpha(52)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(color)
    for edge, inner in (("start", "in"), ("end", "out")):
        a, b = facts.handle(edge), facts.handle(inner)
        if a is not None and b is not None:
            x, y = axis.x(a.at), axis.x(b.at)
            painter.drawPolygon(
                QPolygonF([QPointF(x, rect.top()), QPointF(y, rect.top()), QPointF(x, rect.bottom())])
            )


def paint_speed_curves(
    painter: QPainter, look: TimingLook, axis: Axis, rows: TrackRows, facts: Facts
) -> None:
    """Paint how fast what is looked at goes."""
    rect, top = rows.rows["speed"], facts.top * (1 + MARGIN)
    painter.setBrush(Qt.BrushStyle.NoBrush)
    for n, curve in enumerate(facts.curves):
        painter.setPen(QPen(look.t.kind(facts.action.kind), 1.8, LINES[n % 2]))
        painter.drawPolyline(_line(axis, rect, curve.speeds / top, facts.entry.fps))


def paint_action_before(
    painter: QPainter, look: TimingLook, axis: Axis, rows: TrackRows, facts: Facts, top: float
) -> None:
    """Paint the same action as it was: its curve and its ends, dim."""
    rect = rows.rows["speed"]
    painter.setPen(QPen(QColor(look.t.dim), 1.2, Qt.PenStyle.DotLine))
    if len(facts.speeds):
        painter.drawPolyline(_line(axis, rect, facts.speeds / (top * (1 + MARGIN)), facts.entry.fps))
    painter.setPen(QPen(QColor(look.t.dim), 1.2, Qt.PenStyle.DashLine))
    for seconds in facts.span:
        painter.drawLine(QPointF(axis.x(seconds), rect.top()), QPointF(axis.x(seconds), rect.bottom()))


def _line(axis: Axis, rect: QRectF, part: Array, fps: float) -> QPolygonF:
    """Return a curve of parts of a row's height `[F]` as points; only what is in sight."""
    first = max(0, int(axis.first * fps) - 1)
    last = min(len(part), int(axis.last * fps) + 2)
    xs = axis.x(0) + np.arange(first, last) / fps * axis.each
    ys = rect.bottom() - np.minimum(part[first:last], 1.0) * rect.height()
    return QPolygonF([QPointF(x, y) for x, y in zip(xs.tolist(), ys.tolist(), strict=True)])


def paint_stays(painter: QPainter, look: TimingLook, axis: Axis, rows: TrackRows, facts: Facts) -> None:
    """Paint where the clip is held: hatched, with for how long."""
    rect = rows.rows["speed"]
    painter.setFont(look.small)
    for stay in facts.stays:
        box = QRectF(axis.x(stay.first), rect.top(), axis.each * (stay.last - stay.first), rect.height())
        hatched = QColor(look.t.dim)
        hatched.setAlpha(120)
        painter.fillRect(box, QBrush(hatched, Qt.BrushStyle.BDiagPattern))
        painter.setPen(QPen(QColor(look.t.text), 1.2))
        painter.drawLine(box.topRight(), box.bottomRight())
        words = tr("hold +{seconds:.2f} s", seconds=stay.hold.seconds)
        if look.wide(words) + 8 <= box.width():
            label = QRectF(box.center().x() - look.wide(words) / 2 - 4, box.center().y() - 8, 0, 16)
            label.setWidth(look.wide(words) + 8)
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(QColor(look.t.card))
            painter.drawRoundedRect(label, 3, 3)
            painter.setPen(QColor(look.t.text))
            painter.drawText(label, Qt.AlignmentFlag.AlignCenter, words)


def paint_phase_blocks(
    painter: QPainter, look: TimingLook, axis: Axis, rows: TrackRows, facts: Facts
) -> None:
    """Paint the phases, or for what has none the part that plays."""
    rect = rows.rows["phases"].adjusted(0, 1, 0, -1)
    painter.setFont(look.small)
    found = [(b.name, b.first, b.last) for b in facts.blocks] or [(facts.action.kind, *facts.span)]
    for name, first, last in found:
        left, right = axis.x(first), axis.x(last)
        box = QRectF(left + 0.5, rect.top(), max(1.0, right - left - 1), rect.height())
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(choose_block_color(look.t, facts.action.kind, name))
        painter.drawRoundedRect(box, 3, 3)
        inner = QRectF(max(left, axis.left) + 6, rect.top(), 0, rect.height())
        inner.setRight(min(right, axis.left + axis.width) - 4)
        full = f"{get_vocabulary_word(name)} {format_number(last - first, '.2f')} s"
        words = next((w for w in (full, get_vocabulary_word(name)) if look.wide(w) <= inner.width()), "")
        painter.setPen(QColor(INK))
        painter.drawText(inner, MIDDLE, words)


def choose_block_color(t: WindowTheme, kind: str, name: str) -> QColor:
    if name == "hold":
        return QColor(STILL)
    fill = t.fill(kind)
    return fill.darker(122) if name in ("preparation", "retraction") else fill


def paint_stance_distance(
    painter: QPainter, look: TimingLook, axis: Axis, rows: TrackRows, facts: Facts
) -> None:
    """Paint how far the clip is from its stances, brighter where it may begin and end, in the colour of
    mistakes where it does and that shows; and where beginning and ending is proposed.
    """
    rect, far, t = rows.rows["stance"], facts.distance, look.t
    known = np.isfinite(far.metres)
    if not known.any():
        return
    top = max(float(far.metres[known].max()) * (1 + MARGIN), 1.5 * max(far.limits), 1e-3)
    step = 4.0
    xs = np.arange(max(axis.x(0), axis.left), min(axis.x(axis.length), axis.left + axis.width), step)
    if not len(xs):
        return
    seconds = axis.first + (xs + step / 2 - axis.left) / axis.each
    at = np.clip(np.searchsorted(far.times, seconds), 0, len(far.times) - 1)
    painter.setPen(Qt.PenStyle.NoPen)
    faint, bright, wrong = QColor(t.dim), t.kind(facts.action.kind), QColor(t.error)
    faint.setAlpha(110)
    ends = np.searchsorted(far.times, np.array(facts.span) - 1e-6).tolist()
    bad = [i for i in ends if i < len(far.times) and far.shows[i] and facts.action.kind != "stance"]
    for x, i in zip(xs.tolist(), at.tolist(), strict=True):
        if known[i]:
            high = max(1.0, float(far.metres[i]) / top * rect.height())
            near = any(abs(int(i) - n) <= WRONG * len(far.times) + 1 for n in bad)
            color = bright if not far.shows[i] else wrong if near else faint
            painter.fillRect(QRectF(x, rect.bottom() - high, step - 1, high), color)
    painter.setPen(QPen(QColor(t.text), 1, Qt.PenStyle.DashLine))
    start, end = facts.span
    for limit, first, last in (
        (far.limits[0], start, far.times[min(far.pivot, len(far.times) - 1)]),
        (far.limits[1], far.times[min(far.pivot, len(far.times) - 1)], end),
    ):
        y = rect.bottom() - limit / top * rect.height()
        painter.drawLine(QPointF(axis.x(first), y), QPointF(axis.x(float(last)), y))
    if facts.seen is not None:
        p = facts.seen.proposed
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(t.text))
        for seconds_at in (p.end,) if facts.seen.loops else (p.start, p.end):
            x, y = axis.x(seconds_at), rect.top() + 1
            painter.drawPolygon(QPolygonF([QPointF(x - 4, y), QPointF(x + 4, y), QPointF(x, y + 6)]))


def paint_handles(
    painter: QPainter, look: TimingLook, axis: Axis, rows: TrackRows, facts: Facts
) -> dict[str, QRectF]:
    """Paint the handles with their numbers; return where those stand, by the handle's name."""
    area, t = rows.handles, look.t
    speed = rows.rows["speed"]
    color = t.kind(facts.action.kind)
    for handle in facts.handles:
        if handle.name not in ORDER:
            continue
        x = axis.x(handle.at)
        strong = handle.name in ("start", "end")
        style = (
            Qt.PenStyle.SolidLine if strong else Qt.PenStyle.DashLine if handle.own else Qt.PenStyle.DotLine
        )
        painter.setPen(QPen(QColor(t.text) if strong else color, 2.0 if strong else 1.4, style))
        painter.drawLine(QPointF(x, area.top() if strong else speed.top()), QPointF(x, speed.bottom()))
    return _numbers(painter, look, axis, rows, facts)


def _numbers(
    painter: QPainter, look: TimingLook, axis: Axis, rows: TrackRows, facts: Facts
) -> dict[str, QRectF]:
    rect, t = rows.rows["numbers"], look.t
    painter.setFont(look.small)
    chosen = [h for n in ORDER if (h := facts.handle(n)) is not None]
    shown = [(h, _words(describe_handle(h), h.name, facts, h.at)) for h in chosen if _in_sight(axis, h.at)]
    widths = [look.wide(words) + 10 for _, words in shown]
    places = place_numbers(
        [(axis.x(h.at), w) for (h, _), w in zip(shown, widths, strict=True)],
        axis.left,
        axis.left + axis.width,
    )
    out = {}
    painter.setPen(QPen(QColor(t.dim), 1))
    for (handle, _), width, place in zip(
        shown, widths, places, strict=True
    ):  # all lines first: beneath words
        top = rect.top() + 1 + place.line * (CHIP + 1)
        x = min(max(axis.x(handle.at), place.left + 3), place.left + width - 3)
        painter.drawLine(QPointF(axis.x(handle.at), rows.rows["speed"].bottom()), QPointF(x, top + 2))
    for (handle, words), width, place in zip(shown, widths, places, strict=True):
        box = QRectF(place.left, rect.top() + 1 + place.line * (CHIP + 1), width, CHIP)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(t.hover))
        painter.drawRoundedRect(box, 4, 4)
        painter.setPen(QColor(t.text if handle.own else t.dim))
        painter.drawText(box, Qt.AlignmentFlag.AlignCenter, words)
        out[handle.name] = box
    return out


def _words(words: str, name: str, facts: Facts, at: float) -> str:
    return f"{words} · {format_number(facts.speed_at(at), '.1f')} m/s" if name == "stroke" else f"{words} s"


def _in_sight(axis: Axis, seconds: float) -> bool:
    return axis.left - 1 <= axis.x(seconds) <= axis.left + axis.width + 1


def paint_wave(
    painter: QPainter, look: TimingLook, rect: QRectF, axis: Axis, low: Array, high: Array
) -> None:
    """Paint a sound. low, high `[W]`: its least and greatest in columns of pixels, -1..1; low greater if
    there is none.
    """
    half = rect.height() / 2
    there = high >= low
    top = np.where(there, half - np.where(there, high, 0.0) * (half - 1), 1.0)
    bottom = np.where(there, half - np.where(there, low, 0.0) * (half - 1), 0.0)
    image = paint_columns(*join_columns(top, bottom, 1.2), max(1, round(rect.height())), QColor(look.t.dim))
    painter.drawImage(QPointF(axis.left, rect.top()), image)
