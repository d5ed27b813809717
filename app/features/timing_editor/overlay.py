"""What moves over the rows: the playhead, the part that is played again and again, and what a drag says."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPen

from app.features.timing_editor import kept_rows
from app.features.timing_editor.axis import Axis
from app.features.timing_editor.hits import Hit
from app.features.timing_editor.paint import TimingLook, lay_out_ruler
from app.features.timing_editor.rows import RULER, TrackRows
from app.features.timing_editor.track import Facts, KeptHand
from app.translation import format_number, make_lazy_texts, tr, tr_phrase
from app.widgets.vocabulary import get_vocabulary_word
from metagraph.playback.timing.handles import WORDS
from metagraph.suggest.jumps.snapping import Snap

HINTS = make_lazy_texts(
    lambda: {
        "start": tr("where the action starts in the clip"),
        "end": tr("where the action ends in the clip"),
        "in": tr("end of the blend in from its stance"),
        "out": tr("start of the blend out to its stance"),
        "exit": tr("from here on, the next action can start"),
        "stroke": tr("its most expressive moment, which is aligned with a stressed word"),
        "ready": tr("end of the preparation"),
        "hold": tr("start of the hold"),
        "relax": tr("start of the retraction"),
    }
)


def paint_timing_playhead(
    painter: QPainter,
    look: TimingLook,
    axis: Axis,
    tracks: Sequence[TrackRows],
    facts: Mapping[str, Facts],
    seconds: float,
) -> None:
    """Paint the playhead; in the ruler, over whose words it is, the moment and the speed of the first."""
    x = axis.x(seconds)
    if not tracks or not axis.left - 1 <= x <= axis.left + axis.width + 1:
        return
    color = QColor(look.t.text)
    painter.setPen(QPen(color, 1.2))
    paint_upright(painter, tracks, x, RULER - 2)
    painter.setFont(look.small)
    shown = facts[tracks[0].ident]
    words = f"{format_number(seconds, '.2f')} s"
    if len(shown.speeds) and seconds <= shown.entry.duration:
        words += f"  {format_number(shown.speed_at(seconds), '.1f')} m/s"
    box = paint_chip(painter, look, axis, words, x)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(color)
    painter.drawPolygon(
        [QPointF(x - 4, box.bottom()), QPointF(x + 4, box.bottom()), QPointF(x, box.bottom() + 5)]
    )


def paint_upright(painter: QPainter, tracks: Sequence[TrackRows], x: float, top: float) -> None:
    """Paint a line through all rows but those in which numbers stand."""
    for rows in tracks:
        numbers = rows.rows["numbers"]
        painter.drawLine(QPointF(x, top), QPointF(x, numbers.top() - 2))
        painter.drawLine(QPointF(x, numbers.bottom()), QPointF(x, rows.bottom))
        top = rows.bottom


def paint_chip(painter: QPainter, look: TimingLook, axis: Axis, words: str, middle: float) -> QRectF:
    """Paint words in the ruler about a point, instead of what is written there; return where."""
    wide = look.wide(words) + 12
    left = min(max(axis.left, middle - wide / 2), axis.left + axis.width - wide)
    box = QRectF(left, 0, wide, RULER - 6)
    for _, _, place in lay_out_ruler(look, axis):
        if place.adjusted(-4, 0, 4, 0).intersects(box):
            painter.fillRect(place.adjusted(-1, 0, 1, 0), QColor(look.t.panel))
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(QColor(look.t.hover))
    painter.drawRoundedRect(box, 4, 4)
    painter.setPen(QColor(look.t.text))
    painter.drawText(box, Qt.AlignmentFlag.AlignCenter, words)
    return box


def paint_looped_part(
    painter: QPainter,
    look: TimingLook,
    axis: Axis,
    loop: tuple[str, float, float] | None,
    facts: Mapping[str, Facts],
) -> None:
    """Paint the part that is played again and again, in the ruler."""
    if loop is None or all(f.action.clip != loop[0] for f in facts.values()):
        return
    left, right = max(axis.x(loop[1]), axis.left), min(axis.x(loop[2]), axis.left + axis.width)
    if right > left:
        color = QColor(look.t.text)
        color.setAlpha(46)
        painter.fillRect(QRectF(left, 0, right - left, RULER - 2), color)
        painter.setPen(QPen(QColor(look.t.text), 2))
        for x in (left, right):
            painter.drawLine(QPointF(x, 1), QPointF(x, RULER - 3))


def paint_held(
    painter: QPainter,
    look: TimingLook,
    axis: Axis,
    width: float,
    tracks: Sequence[TrackRows],
    snaps: Sequence[Snap],
    snapped: Snap | None,
    words: str,
) -> None:
    """Paint what is dragged in words, where it may come to rest, and why it did."""
    if not tracks:
        return
    for rows in tracks:
        y = rows.rows["speed"].bottom()
        painter.setPen(QPen(QColor(look.t.text), 1.4))
        for snap in snaps:
            painter.drawLine(QPointF(axis.x(snap.at), y - 6), QPointF(axis.x(snap.at), y))
    if snapped is not None:
        x = axis.x(snapped.at)
        painter.setPen(QPen(QColor(look.t.warning), 1.6))
        paint_upright(painter, tracks, x, RULER - 4)
        words = f"{words} — {tr_phrase(snapped.why)}"
    wide = min(look.wide(words) + 18, width - axis.left)
    middle = axis.x(snapped.at) if snapped is not None else axis.left + axis.width / 2
    box = QRectF(min(max(axis.left, middle - wide / 2), max(axis.left, width - wide - 4)), 1, wide, RULER - 3)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(QColor(look.t.strong))
    painter.drawRoundedRect(box, 4, 4)
    painter.setFont(look.small)
    painter.setPen(QColor(look.t.on_strong))
    painter.drawText(box, Qt.AlignmentFlag.AlignCenter, look.elided(words, wide - 10))


def paint_stretched_hand(
    painter: QPainter,
    look: TimingLook,
    axis: Axis,
    tracks: Sequence[TrackRows],
    facts: Mapping[str, Facts],
    ident: str,
    kept: KeptHand,
) -> None:
    """Paint a kept hand as it would be if it were let go now."""
    rows = next((r for r in tracks if r.ident == ident), None)
    if rows is not None and kept.hand in facts[ident].hands:
        painter.setPen(QPen(QColor(look.t.text), 1.4, Qt.PenStyle.DashLine))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawRoundedRect(kept_rows.place_kept_bar(axis, rows, facts[ident], kept), 3, 3)


def describe_timing_hit(facts: Facts, hit: Hit, seconds: float) -> str:
    """Say what is under the pointer, and what can be done with it."""
    if hit.what == "kept":
        return kept_rows.describe_kept_hit(facts, hit)
    if hit.what == "handle":
        found = facts.handle(hit.name)
        own = "" if found is None or found.own else tr(", detected from the motion")
        number = f" {format_number(found.number, '.3f')} s" if found is not None else ""
        return tr(
            "{handle}{number}{own}: {hint}.\nDrag to move it, with Alt to avoid snapping. "
            "Double-click its number to type it.",
            handle=get_vocabulary_word(WORDS[hit.name]),
            number=number,
            own=own,
            hint=HINTS[hit.name],
        )
    if hit.what == "block":
        return tr(
            "{name}: drag to move it. Drag with Shift to slip it: the same length plays another "
            "part of the clip.",
            name=get_vocabulary_word(hit.name),
        )
    if hit.what == "stay":
        return tr(
            "The clip holds this pose. Drag to lengthen or shorten the hold. Shrink it to nothing "
            "to remove it."
        )
    if hit.what == "ruler":
        return tr("Drag to scrub. Drag with Shift to set a loop range, double-click to clear it.")
    if not 0 <= seconds <= facts.entry.duration:
        return ""
    far = tr_phrase(facts.distance.words(seconds))
    return f"{format_number(seconds, '.2f')} s: {format_number(facts.speed_at(seconds), '.2f')} m/s" + (
        f", {far}" if far else ""
    )
