"""Hands that are kept on the body: a row for each, a bar while it is kept, its ends to be dragged."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter

from app.features.timing_editor.axis import Axis
from app.features.timing_editor.drags.host import Host
from app.features.timing_editor.hits import Hit
from app.features.timing_editor.paint import MIDDLE, TimingLook
from app.features.timing_editor.rows import TrackRows
from app.features.timing_editor.track import Facts, KeptHand
from app.translation import format_number, tr
from metagraph.graph.clip_source import get_clip_course
from metagraph.graph.editing.retiming import set_kept

REACH = 5.0  # pixels from an end at which it is taken
GRIP = 4.0  # pixels of an end
ENDS = ("first", "last")


@dataclass(frozen=True)
class KeptPart:
    """What of a kept hand is meant: one of its ends, or "" for all of it. place: among the clip's."""

    place: int
    end: str

    @property
    def name(self) -> str:
        return f"kept {self.place} {self.end}"

    @staticmethod
    def of(name: str) -> KeptPart | None:
        """Return the part that a name stands for, None for a name of something else."""
        words = name.split(" ")
        return KeptPart(int(words[1]), words[2]) if words[0] == "kept" else None


def find_kept_seconds(facts: Facts, name: str) -> float | None:
    """Return where an end of a kept hand is, seconds of the clip; None for what is none, or is gone."""
    part = KeptPart.of(name)
    kept = next((k for k in facts.kept if part is not None and k.place == part.place), None)
    return float(getattr(kept, part.end)) if kept is not None and part is not None and part.end else None


def place_kept_bar(axis: Axis, rows: TrackRows, facts: Facts, kept: KeptHand) -> QRectF:
    """Return where a kept hand stands."""
    row = rows.rows[f"hand {facts.hands.index(kept.hand)}"]
    left, right = axis.x(kept.first), axis.x(kept.last)
    return QRectF(left, row.top() + 1, max(2.0, right - left), row.height() - 2)


def paint_kept(
    painter: QPainter, look: TimingLook, axis: Axis, rows: TrackRows, facts: Facts
) -> Iterator[tuple[str, QRectF]]:
    """Paint the rows of kept hands; yield where the numbers of their ends stand."""
    t = look.t
    painter.setFont(look.small)
    for kept in facts.kept:
        box = place_kept_bar(axis, rows, facts, kept)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(t.hover))
        painter.drawRoundedRect(box, 3, 3)
        painter.setBrush(QColor(t.dim))
        for left in (box.left(), max(box.left(), box.right() - GRIP)):
            painter.drawRoundedRect(QRectF(left, box.top(), GRIP, box.height()), 2, 2)
        inner = box.adjusted(GRIP + 4, 0, -GRIP - 4, 0)
        numbers = [f"{format_number(kept.first, '.2f')} s", f"{format_number(kept.last, '.2f')} s"]
        wide = [look.wide(words) for words in numbers]
        within = sum(wide) + 12 <= inner.width()
        lefts = [inner.left(), inner.right() - wide[1]]
        if not within:  # beside it: what others keep of this hand is not that near, or gives way
            lefts = [box.left() - wide[0] - 5, box.right() + 5]
        painter.setPen(QColor(t.text))
        for end, words, left, width in zip(ENDS, numbers, lefts, wide, strict=True):
            place = QRectF(left, box.top(), width + 1, box.height())
            if _free(rows, axis, facts, kept, place):
                painter.drawText(place, MIDDLE, words)
                yield KeptPart(kept.place, end).name, place
        middle = inner.adjusted(wide[0] + 8, 0, -wide[1] - 8, 0) if within else inner
        words = look.elided(tr("at {place}", place=kept.to), middle.width(), True)
        if len(words) > 3:
            painter.setPen(QColor(t.dim))
            painter.drawText(middle, Qt.AlignmentFlag.AlignCenter, words)


def _free(rows: TrackRows, axis: Axis, facts: Facts, kept: KeptHand, place: QRectF) -> bool:
    """Return whether a number is in sight and lies on no other bar of its hand, nor if that has its
    number.
    """
    if not axis.left <= place.left() <= place.right() <= axis.left + axis.width + 1:
        return False
    room = place.width() + 8
    others = (k for k in facts.kept if k.hand == kept.hand and k.place != kept.place)
    return not any(
        place_kept_bar(axis, rows, facts, k).adjusted(-room, 0, room, 0).intersects(place) for k in others
    )


def hit_kept(
    rows: TrackRows, facts: Facts, axis: Axis, numbers: Mapping[str, QRectF], at: QPointF
) -> Hit | None:
    """Return which part of a kept hand is under a point: an end, by its number too, or all of it."""
    for name, box in numbers.items():
        if KeptPart.of(name) is not None and box.contains(at):
            return Hit("kept", rows.ident, name)
    for kept in facts.kept:
        box = place_kept_bar(axis, rows, facts, kept)
        if not box.adjusted(-REACH, 0, REACH, 0).contains(at):
            continue
        gaps = {end: abs(x - at.x()) for end, x in zip(ENDS, (box.left(), box.right()), strict=True)}
        end = min(ENDS, key=lambda e: gaps[e])
        return Hit("kept", rows.ident, KeptPart(kept.place, end if gaps[end] <= REACH else "").name)
    return None


def describe_kept_hit(facts: Facts, hit: Hit) -> str:
    """Say what a kept hand does, and what can be done with it."""
    part = KeptPart.of(hit.name)
    kept = next((k for k in facts.kept if part is not None and k.place == part.place), None)
    if kept is None:
        return ""
    return tr(
        "The {hand} stays at {to} from {first:.2f} to {last:.2f} s.\nDrag the bar or its ends. "
        "Double-click a number to type it. Shrink the bar to nothing to release the hand.",
        hand=kept.hand,
        to=kept.to,
        first=kept.first,
        last=kept.last,
    )


def change(host: Host, facts: Facts, kept: KeptHand) -> None:
    """Keep a hand from and until other seconds of the clip as it plays, in one step. Raises EditError."""
    course = get_clip_course(facts.entry)
    if course is None:
        return
    first, last = (round(s, 3) for s in course.moments(np.array([kept.first, kept.last])).tolist())
    clip, old = facts.action.clip, facts.entry.retime.contacts[kept.place]
    was = next(k for k in facts.kept if k.place == kept.place)
    # An end that was not moved stays to the bit: within a hold many seconds are one moment of the file.
    first = old.first if kept.first == was.first else first
    last = old.last if kept.last == was.last else last
    host.document.edit(tr("Pin hand"), lambda p: set_kept(p, clip, kept.place, first, last))


def set_number(host: Host, facts: Facts, name: str, seconds: float) -> None:
    """Move an end of a kept hand to a moment of the clip as it plays. Raises EditError."""
    part = KeptPart.of(name)
    kept = next((k for k in facts.kept if part is not None and k.place == part.place), None)
    if kept is not None and part is not None and part.end:
        change(host, facts, kept.with_end(part.end, min(max(0.0, seconds), facts.entry.duration)))
