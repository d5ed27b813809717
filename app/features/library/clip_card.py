"""Draws a clip as a card: picture, name, length, a stripe and mark for each kind it serves as, and what was
put on it.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from PySide6.QtCore import QRect, Qt
from PySide6.QtGui import QColor, QFont, QFontMetrics, QPainter, QPen

from app.features.library.clip_badges import draw_badges
from app.features.library.clip_facts import ClipFacts
from app.features.library.clip_names import ClipNames
from app.features.library.clip_pictures import ClipPictures
from app.features.library.clip_sizes import place_picture
from app.look.shortening import shorten_middle, shorten_to_font
from app.look.theme import KIND_MARKS, WindowTheme
from app.translation import tr
from metagraph.graph.editing.half_labels import find_half_label
from metagraph.graph.model import ClipEntry, Kind


@dataclass(frozen=True)
class ClipInk:
    """What all clips of a list are drawn with. side: pixels of a picture."""

    facts: ClipFacts
    pictures: ClipPictures
    names: ClipNames
    side: int
    look: WindowTheme


def list_clip_kinds(facts: ClipFacts, entry: ClipEntry) -> list[Kind]:
    """Return what a clip serves as, each once, or will serve as once the rest of its label is known."""
    known = find_half_label(facts.project, entry.id).kind
    return list(dict.fromkeys(a.kind for a in facts.uses(entry))) or ([known] if known else [])


def draw_stripe(
    painter: QPainter, rect: QRect, facts: ClipFacts, entry: ClipEntry, look: WindowTheme
) -> None:
    """Draw a stripe at the left edge, a part for each kind a clip serves as."""
    kinds = list_clip_kinds(facts, entry)
    drawn = entry.id in facts.project.drawn and not kinds  # a state of a machine is of no kind
    marks = [QColor(look.dim)] if drawn else [look.fill(kind) for kind in kinds]
    high = (rect.height() - 12) / max(1, len(marks))
    painter.setPen(Qt.PenStyle.NoPen)
    for place, mark in enumerate(marks):
        painter.setBrush(mark)
        top = round(rect.top() + 6 + place * high)
        painter.drawRoundedRect(rect.left() + 3, top, 4, round(high - 1), 2, 2)


def draw_kinds(painter: QPainter, line: QRect, kinds: list[Kind], look: WindowTheme) -> int:
    """Draw the marks of kinds at the right end of a line; return where they begin."""
    right = line.right()
    for kind in reversed(kinds):
        painter.setPen(look.kind(kind))
        right -= 14
        painter.drawText(
            QRect(right, line.top(), 14, line.height()), Qt.AlignmentFlag.AlignCenter, KIND_MARKS[kind]
        )
    return right


def draw_picture(
    painter: QPainter,
    box: QRect,
    pictures: ClipPictures,
    entry: ClipEntry,
    look: WindowTheme,
    small: bool = False,
) -> None:
    """Draw a clip's picture, or say that its file is missing."""
    if not pictures.draw(painter, entry.id, box, QColor(look.text)) and entry.motion is None:
        painter.setPen(QColor(look.warning))
        words = "?" if small else tr("file\nmissing")
        painter.drawText(box, Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap, words)


def draw_clip_card(
    painter: QPainter, place: QRect, entry: ClipEntry, row: int, ink: ClipInk, lit: bool, chosen: bool
) -> None:
    """Draw a clip in its place. lit: selected or pointed at. chosen: selected."""
    facts, names, look = ink.facts, ink.names, ink.look
    rect = place.adjusted(4, 4, -4, -4)
    painter.setBrush(QColor(look.hover if lit else look.field))
    painter.setPen(QPen(QColor(look.text if chosen else look.line), 1.6 if chosen else 1))
    painter.drawRoundedRect(rect, 6, 6)
    draw_picture(painter, place_picture("cards", ink.side, place), ink.pictures, entry, look)
    draw_stripe(painter, rect, facts, entry, look)
    font = QFont(painter.font())
    font.setPixelSize(14)
    painter.setFont(font)
    line = QRect(rect.left() + 11, rect.bottom() - 53, rect.width() - 16, 16)
    front, rest = names.of(entry)
    key, beside = font.toString(), names.beside(row)
    shown = (
        (
            shorten_to_font(front, line.width(), key, names.stances()),
            shorten_to_font(rest, line.width(), key, beside),
        )
        if front
        else break_in_two_lines(rest, painter.fontMetrics(), line.width(), beside)
    )
    for n, part in enumerate(shown):
        painter.setPen(QColor(look.dim if front and n == 0 else look.text))
        painter.drawText(line, Qt.AlignmentFlag.AlignVCenter, part)
        line.translate(0, 16)
    mark = facts.mark(entry)
    draw_badges(painter, rect.adjusted(10, 5, -6, 0), mark, look)
    line.moveTop(rect.bottom() - 20)
    right = draw_kinds(painter, line, list_clip_kinds(facts, entry), look)
    base = tr("base") if facts.project.base.clip == entry.id else facts.missing(entry)
    length = tr("{seconds:.1f} s", seconds=entry.duration)
    stars = f"★{mark.rating}" if mark.rating else ""
    painter.setPen(QColor(look.dim))
    end = QRect(line.left(), line.top(), right - line.left() - 2, line.height())
    room = painter.fontMetrics().horizontalAdvance
    words = "  ".join(w for w in (length, stars) if w)
    if base and room(f"{words}  {base}") > end.width():  # what is on it goes before what it serves as
        base = "" if stars else base
    if room(words) > end.width():
        words = stars or length
    painter.drawText(end, Qt.AlignmentFlag.AlignVCenter, words)
    painter.drawText(end, Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter, base)


def break_in_two_lines(
    name: str, metrics: QFontMetrics, width: int, beside: Iterable[str] = ()
) -> tuple[str, ...]:
    """Break a name over at most two lines, after a separator where there is one. beside: names of the cards
    round it, from which what is shown is to differ.
    """
    if metrics.horizontalAdvance(name) <= width:
        return (name,)
    measure = metrics.horizontalAdvance
    first, second = _broken(name, metrics, width)
    if measure(second) > width:
        rivals = [o[len(name) - len(second) :] for o in beside if o.startswith(first)]
        cut = shorten_middle(second, width, measure, rivals, sure=True)
        if cut:
            return first, cut
        first, second = _broken(
            shorten_middle(name, 2 * width - 16, measure, beside), metrics, width, hard=True
        )
    return first, shorten_middle(second, width, measure)


def _broken(name: str, metrics: QFontMetrics, width: int, hard: bool = False) -> tuple[str, str]:
    """Break a name behind a separator, or where the line is full. hard: there if the rest needs it."""
    fits = max((n for n in range(1, len(name)) if metrics.horizontalAdvance(name[:n]) <= width), default=1)
    cuts = [n for n in range(fits, fits // 2, -1) if name[n - 1] in "_- .@"]
    cut = cuts[0] if cuts else fits
    if hard and metrics.horizontalAdvance(name[cut:]) > width:
        cut = fits
    return name[:cut].rstrip(), name[cut:]
