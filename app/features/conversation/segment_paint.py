"""Paint a conversation's lanes. All functions are pure and only treat what is visible."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFont, QImage, QPainter, QPen

from app.features.conversation.segment_hits import SegmentHit
from app.features.conversation.segment_lanes import (
    AXIS,
    SegmentLane,
    find_visible_segments,
    find_words_between,
    measure_pitch_y,
    measure_segment_rect,
    place_segment_lanes,
)
from app.features.conversation.sound_reading import SideSound
from app.look.shortening import shorten_middle
from app.look.theme import SOUND_MARKS, WindowTheme
from app.translation import tr
from app.widgets.act_strip import STEPS, format_clock
from app.widgets.lane_geometry import LEFT, RULER, LaneScale, elide_text, measure_text_width
from app.widgets.waveforms import Envelope, join_columns, paint_columns
from metagraph.graph.conversation.model import Conversation, Segment, get_side_name

INK = "#17181b"  # on the fills
MIDDLE = Qt.AlignmentFlag.AlignVCenter
LEGIBLE = 26.0  # pixels a second from which on words are shown
DOTS = 20.0  # pixels a second from which on peaks are shown
NARROW = 16.0  # pixels up to which a segment is a plain stroke without words
MOST = 300  # narrow ones that are outlined where all of them are selected
SMALL = 13  # pixels of what stands beside


@dataclass(frozen=True)
class SegmentScene:
    """Everything that is painted. heard: the sound of each side. ratio: screen pixels per window pixel.
    chosen: (side, index) of the selected segments. over: what is under the pointer.
    """

    conversation: Conversation
    heard: Sequence[SideSound | None]
    scale: LaneScale
    width: float
    height: float
    ratio: float
    chosen: Collection[tuple[int, int]]
    over: SegmentHit
    side: int = 0  # whose plan the timeline shows


def paint_segments(painter: QPainter, t: WindowTheme, scene: SegmentScene) -> None:
    """Paint everything but the playhead."""
    painter.fillRect(QRectF(0, 0, scene.width, scene.height), QColor(t.panel))
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    _ruler(painter, t, scene)
    for side, lane in enumerate(
        place_segment_lanes(scene.width, scene.height, len(scene.conversation.sides))
    ):
        _titles(painter, t, scene, side, lane)
        painter.save()
        painter.setClipRect(lane.whole.adjusted(0, 0, 0, 2))
        _wave(painter, t, scene, side, lane)
        if scene.scale.each >= DOTS:
            _peaks(painter, t, scene, side, lane)
        if scene.scale.each >= LEGIBLE:
            _words(painter, t, scene, side, lane)
        _segments(painter, t, scene, side, lane)
        painter.restore()
    x = scene.scale.x(scene.conversation.length)
    if x < scene.width:
        veil = QColor(t.panel)
        veil.setAlpha(190)
        painter.fillRect(QRectF(max(x, LEFT), RULER, scene.width, scene.height), veil)


def _ruler(painter: QPainter, t: WindowTheme, scene: SegmentScene) -> None:
    scale = scene.scale
    step = next((s for s in (0.1, 0.2, *STEPS) if s * scale.each >= 64), STEPS[-1])
    painter.setPen(QColor(t.dim))
    n = int(scale.first // step)
    while (x := scale.x(n * step)) < scene.width:
        words = format_clock(round(n * step, 3))
        if x >= LEFT - 1 and x + measure_text_width(words, painter.font().toString()) / 2 + 1 <= scene.width:
            painter.drawText(QRectF(x - 40, 0, 80, RULER), Qt.AlignmentFlag.AlignCenter, words)
        n += 1


def _titles(painter: QPainter, t: WindowTheme, scene: SegmentScene, side: int, lane: SegmentLane) -> None:
    """Who it is, the pitches' axis, and what the rows below are."""
    own, small, bold = painter.font(), QFont(painter.font()), QFont(painter.font())
    small.setPixelSize(SMALL)
    bold.setWeight(QFont.Weight.DemiBold)
    over, name = scene.over == SegmentHit("title", side), get_side_name(scene.conversation, side)
    if over:
        painter.fillRect(QRectF(0, lane.whole.top(), LEFT - 1, lane.whole.height()), QColor(t.hover))
    if side == scene.side:
        painter.fillRect(QRectF(3, lane.wave.top() + 3, 3, lane.whole.height() - 6), QColor(t.text))
    if measure_text_width(name, bold.toString()) > LEFT - 32:
        bold.setPixelSize(SMALL)
    painter.setFont(bold)
    painter.setPen(QColor(t.text if over or side == scene.side else t.dim))
    others = [get_side_name(scene.conversation, n) for n in range(len(scene.conversation.sides))]
    shown = shorten_middle(name, LEFT - 32, lambda x: measure_text_width(x, bold.toString()), others)
    painter.drawText(QRectF(12, lane.wave.top() + 2, LEFT - 30, 18), MIDDLE, shown)
    x, y = LEFT - 11.0, lane.wave.top() + 11.0  # what opens the menu of who it is
    painter.setPen(QPen(QColor(t.text if over else t.dim), 1.5))
    painter.drawPolyline([QPointF(x - 3.5, y - 2), QPointF(x, y + 2), QPointF(x + 3.5, y - 2)])
    painter.setFont(small)
    painter.setPen(QColor(t.dim))
    right = Qt.AlignmentFlag.AlignRight | MIDDLE
    for hertz in AXIS:
        y = float(measure_pitch_y(hertz, lane.wave))
        if y > lane.wave.top() + 26 and y < lane.wave.bottom() - 5:
            painter.drawText(QRectF(12, y - 8, LEFT - 18, 16), right, f"{hertz:.0f} Hz")
    if lane.wave.height() > 34:
        painter.drawText(QRectF(12, lane.words.top(), LEFT - 14, lane.words.height()), MIDDLE, tr("Words"))
        painter.drawText(
            QRectF(12, lane.segments.top(), LEFT - 14, lane.segments.height()), MIDDLE, tr("Segments")
        )
    painter.setFont(own)


def _wave(painter: QPainter, t: WindowTheme, scene: SegmentScene, side: int, lane: SegmentLane) -> None:
    """The waveform with what is segmented behind it, its pitch over it; where it is not there, why."""
    area, heard = lane.wave, scene.heard[side]
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(QColor(t.field))
    painter.drawRoundedRect(area, 4, 4)
    segments = scene.conversation.sides[side].segments
    chosen = {n for of, n in scene.chosen if of == side}
    behind = QRectF(area.left(), area.top(), area.width(), area.height() + lane.words.height())
    _strokes(painter, t, scene, segments, behind, (26, 70), chosen)
    painter.setPen(QPen(QColor(t.line), 1, Qt.PenStyle.DotLine))
    for hertz in AXIS:
        y = round(float(measure_pitch_y(hertz, area))) + 0.5
        painter.drawLine(QPointF(area.left(), y), QPointF(area.right(), y))
    if heard is not None and heard.wave is not None:
        middle, half = area.height() / 2, area.height() / 2 - 3
        grow = half / max(heard.loudest, 1e-3)
        color = QColor(t.dim)
        color.setAlphaF(0.62)
        _curve(painter, heard.wave, scene, area, color, lambda v: middle - v * grow, 1.0)
    if heard is not None and heard.pitch is not None:
        _curve(
            painter,
            heard.pitch,
            scene,
            area,
            QColor(t.text),
            lambda v: measure_pitch_y(v, area) - area.top(),
            1.7,
        )
    listens = heard is None and any(other is not None for other in scene.heard)
    _told(painter, t, heard, area, listens)


def _curve(
    painter: QPainter,
    of: Envelope,
    scene: SegmentScene,
    area: QRectF,
    color: QColor,
    y: Callable[[np.ndarray], np.ndarray],
    thick: float,
) -> None:
    """Paint an envelope, pixel for pixel of the screen. y: from a value to pixels below the top of the
    area.
    """
    ratio, wide = scene.ratio, int(area.width() * scene.ratio)
    low, high = of.columns(scene.scale.first, scene.scale.each * ratio, wide)
    there = high >= low
    top, bottom = (y(np.where(there, v, 1.0)) * ratio for v in (high, low))
    top, bottom = np.where(there, top, np.inf), np.where(there, bottom, -np.inf)
    top, bottom = join_columns(top, bottom, thick * ratio)
    picture = paint_columns(top, bottom, int(area.height() * ratio), color)
    picture.setDevicePixelRatio(ratio)
    painter.drawImage(area.topLeft(), picture)


def _told(
    painter: QPainter, t: WindowTheme, heard: SideSound | None, area: QRectF, listens: bool = False
) -> None:
    """Say why there is no sound, or how far it is. listens: another speaker has one, as in a monologue."""
    inner = area.adjusted(14, 2, -14, -2)
    if listens:
        painter.setPen(QColor(t.dim))
        words = tr("Listens. To let this speaker talk too, choose a sound in the menu “…” above.")
        painter.drawText(inner, MIDDLE | Qt.TextFlag.TextWordWrap, words)
    elif heard is None or heard.missing:
        words = (
            heard.missing
            if heard is not None
            else tr("This speaker has no sound. Choose one in the menu “…” above.")
        )
        painter.setPen(QColor(t.warning))
        painter.drawText(inner, MIDDLE | Qt.TextFlag.TextWordWrap, f"⚠  {words}")
    elif heard.told:
        painter.setPen(QColor(t.dim))
        if heard.wave is not None:  # then it stands over the waveform
            wide = measure_text_width(heard.told, painter.font().toString()) + 12
            inner = QRectF(area.right() - wide - 6, area.top() + 3, wide, 18)
            painter.fillRect(inner, QColor(t.panel))
        painter.drawText(inner, MIDDLE if heard.wave is None else Qt.AlignmentFlag.AlignCenter, heard.told)
        painter.fillRect(QRectF(area.left(), area.bottom() - 2, area.width() * heard.part, 2), QColor(t.dim))


def _words(painter: QPainter, t: WindowTheme, scene: SegmentScene, side: int, lane: SegmentLane) -> None:
    """The words where they are said, as far as there is room before the next."""
    scale, font = scene.scale, QFont(painter.font())
    own = painter.font()
    font.setPixelSize(14)
    painter.setFont(font)
    key = font.toString()
    painter.setPen(QColor(t.text))
    some = find_words_between(scene.conversation.sides[side].words, scale.first, scale.seconds(scene.width))
    for n, word in enumerate(some):
        left = scale.x(word.start)
        until = min(scale.x(some[n + 1].start) if n + 1 < len(some) else left + 300.0, scene.width)
        words = (
            word.text
            if measure_text_width(word.text, key) <= until - left - 4
            else elide_text(word.text, key, int(until - left - 4))
        )
        if len(words) > 3 or words == word.text:
            painter.drawText(QRectF(left + 1, lane.words.top(), 400, lane.words.height()), MIDDLE, words)
    painter.setFont(own)


def _segments(painter: QPainter, t: WindowTheme, scene: SegmentScene, side: int, lane: SegmentLane) -> None:
    scale, segments = scene.scale, scene.conversation.sides[side].segments
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(QColor(t.field))
    painter.drawRoundedRect(lane.segments, 4, 4)
    key, seen = (
        painter.font().toString(),
        find_visible_segments(segments, scale.first, scale.seconds(scene.width)),
    )
    wide = [n for n in seen if segments[n].end - segments[n].start > NARROW / scale.each]
    if len(wide) < len(seen):
        few = set(wide)
        narrow = [segments[n] for n in seen if n not in few]
        _strokes(painter, t, scene, narrow, lane.segments.adjusted(0, 1, 0, -1), (255, 255), ())
        wide += [n for n in seen if n not in few and (side, n) in scene.chosen][:MOST]
    for n in wide:
        segment = segments[n]
        rect, fill, chosen = (
            measure_segment_rect(segment, scale, lane),
            QColor(t.sounds[segment.kind]),
            (side, n) in scene.chosen,
        )
        rect = rect.adjusted(0.5, 1, -0.5, -1)
        if scene.over.side == side and scene.over.at == n and scene.over.part in ("start", "end", "body"):
            fill = fill.lighter(112)
        painter.setPen(QPen(QColor(t.text), 2) if chosen else Qt.PenStyle.NoPen)
        painter.setBrush(fill)
        painter.drawRoundedRect(rect, 4, 4)
        left = max(rect.left(), LEFT)
        room = min(rect.right(), scene.width) - left - 10
        mark = SOUND_MARKS[segment.kind]
        if room < measure_text_width(mark, key) - 2:
            continue
        painter.setPen(QColor(INK))
        words = f"{mark} {segment.text}".strip() if segment.text else f"{mark} {segment.kind}"
        out = elide_text(words, key, int(room))
        out = out if len(out) > 4 or out == words else mark
        painter.drawText(QRectF(left + 6, rect.top(), room + 4, rect.height()), MIDDLE, out)


def _peaks(painter: QPainter, t: WindowTheme, scene: SegmentScene, side: int, lane: SegmentLane) -> None:
    """The stress of every clause: a dot on its pitch, and a line down to its segment."""
    scale, segments, heard = scene.scale, scene.conversation.sides[side].segments, scene.heard[side]
    fill, stem = QColor(t.sounds["clause"]), QColor(t.sounds["clause"])
    stem.setAlpha(130)
    for n in find_visible_segments(segments, scale.first, scale.seconds(scene.width)):
        segment = segments[n]
        if segment.kind != "clause" or segment.peak is None:
            continue
        at = QPointF(scale.x(segment.peak), measure_peak_y(segment.peak, heard, lane))
        held = scene.over.part == "peak" and (scene.over.side, scene.over.at) == (side, n)
        painter.setPen(QPen(stem, 1.4))
        painter.drawLine(at, QPointF(at.x(), lane.segments.top()))
        painter.setPen(QPen(QColor(t.field), 1.5))
        painter.setBrush(QColor(t.text) if held else fill)
        painter.drawEllipse(at, 5.5 if held else 4.5, 5.5 if held else 4.5)


def _strokes(
    painter: QPainter,
    t: WindowTheme,
    scene: SegmentScene,
    segments: Sequence[Segment],
    area: QRectF,
    alphas: tuple[int, int],
    chosen: Collection[int],
) -> None:
    """Paint segments as plain strokes in one picture a pixel high, however many there are. alphas: 0..255, of
    a stroke, of a chosen one.
    """
    seen = find_visible_segments(segments, scene.scale.first, scene.scale.seconds(scene.width))
    if not seen:
        return
    some = segments[seen.start : seen.stop]
    wide = max(1, int(area.width() * scene.ratio))
    starts, ends = np.array([s.start for s in some]), np.array([s.end for s in some])
    kinds = list(t.sounds)
    ink = np.array([kinds.index(s.kind) + len(kinds) * (n in chosen) for n, s in enumerate(some, seen.start)])
    inks = np.array(
        [_premultiplied(QColor(color), alpha) for alpha in alphas for color in t.sounds.values()], np.uint8
    )
    columns = scene.scale.first + (np.arange(wide) + 0.5) / (
        scene.scale.each * scene.ratio
    )  # seconds of their middles
    at = np.clip(np.searchsorted(starts, columns, "right") - 1, 0, len(some) - 1)
    inside = (columns >= starts[at]) & (columns < ends[at])
    row = np.ascontiguousarray(np.where(inside[:, None], inks[ink[at]], 0).astype(np.uint8)[None])
    image = QImage(row.data, wide, 1, row.strides[0], QImage.Format.Format_ARGB32_Premultiplied)
    painter.drawImage(area, image)


def _premultiplied(color: QColor, alpha: int) -> tuple[int, int, int, int]:
    part = alpha / 255
    return round(color.blue() * part), round(color.green() * part), round(color.red() * part), alpha


def measure_peak_y(seconds: float, heard: SideSound | None, lane: SegmentLane) -> float:
    """Return the height of a peak's dot: on the pitch curve, or below it if there is no pitch."""
    if heard is not None and heard.pitch is not None:
        values, at = heard.pitch.lows[0], round(seconds * heard.pitch.rate)
        near = values[max(0, at - 5) : at + 6]
        near = near[np.isfinite(near)]
        if len(near):
            return float(measure_pitch_y(float(near.max()), lane.wave))
    return lane.wave.bottom() - 8


def paint_empty_conversation(painter: QPainter, t: WindowTheme, area: QRectF, lines: Sequence[str]) -> None:
    """Paint the empty panel: two speakers, and how to add them."""
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    middle, top = area.center().x(), area.center().y() - 62
    for side, (shift, kind, high) in enumerate(((-58.0, "clause", 0.0), (4.0, "response", 12.0))):
        rect = QRectF(middle + shift, top + high, 54, 30)
        tail, out = rect.left() + (12 if side == 0 else 42), -6 if side == 0 else 6
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(t.sounds[kind]))
        painter.drawRoundedRect(rect, 9, 9)
        painter.drawPolygon(
            [
                QPointF(tail - 5, rect.bottom() - 2),
                QPointF(tail + out, rect.bottom() + 9),
                QPointF(tail + 5, rect.bottom() - 2),
            ]
        )
        painter.setPen(QPen(QColor(INK), 2, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap))
        for n, tall in enumerate((4, 8, 5, 10, 6, 3) if side == 0 else (3, 6, 4, 3, 5, 2)):
            x = rect.left() + 12 + n * 6
            painter.drawLine(QPointF(x, rect.center().y() - tall), QPointF(x, rect.center().y() + tall))
    painter.setPen(QColor(t.text))
    flags = Qt.AlignmentFlag.AlignHCenter | Qt.AlignmentFlag.AlignTop | Qt.TextFlag.TextWordWrap
    room = area.adjusted(16, 0, -16, 0)
    room.setTop(top + 62)
    for line in lines:
        words = painter.boundingRect(room, flags, line)
        painter.drawText(words, flags, line)
        room.setTop(words.bottom() + 4)
        painter.setPen(QColor(t.dim))
