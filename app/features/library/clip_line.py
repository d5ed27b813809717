"""Draws a clip as a line: a picture and words beside it, or what stands in the columns."""

from __future__ import annotations

from PySide6.QtCore import QRect, Qt
from PySide6.QtGui import QColor, QPainter

from app.features.library.clip_badges import HEART, PENCIL, TAG, draw_label
from app.features.library.clip_card import ClipInk, draw_kinds, draw_picture, draw_stripe, list_clip_kinds
from app.features.library.clip_columns import COLUMNS
from app.features.library.clip_header import PLACES, ClipHeader
from app.features.library.clip_sizes import place_picture
from app.look.shortening import shorten_to_font
from app.look.theme import KIND_MARKS, WindowTheme
from app.translation import format_number
from metagraph.graph.model import ClipEntry

MIDDLE = Qt.AlignmentFlag.AlignVCenter
NAME = 84  # pixels that a name has at least in a line


def draw_back(painter: QPainter, rect: QRect, look: WindowTheme, lit: bool, chosen: bool) -> None:
    """Draw what is behind a line; a selected one has a frame, too."""
    if lit:
        painter.setPen(QColor(look.text) if chosen else Qt.PenStyle.NoPen)
        painter.setBrush(QColor(look.hover))
        painter.drawRoundedRect(rect.adjusted(1, 1, -2, -1), 4, 4)


def draw_line(painter: QPainter, rect: QRect, entry: ClipEntry, row: int, ink: ClipInk) -> None:
    """Draw a clip in a line: picture, name, and at its end what is on it, its length and its kinds."""
    facts, names, look = ink.facts, ink.names, ink.look
    box = place_picture("cards", ink.side, rect)
    draw_stripe(painter, rect.adjusted(0, -3, 0, 3), facts, entry, look)
    draw_picture(painter, box, ink.pictures, entry, look, small=True)
    mark = facts.mark(entry)
    line = QRect(box.right() + 8, rect.top(), rect.right() - box.right() - 16, rect.height())
    wide = painter.fontMetrics().horizontalAdvance
    front, rest = names.of(entry)
    right = draw_kinds(painter, line, list_clip_kinds(facts, entry), look)
    words = HEART * mark.favourite + PENCIL * bool(mark.note) + (f"★{mark.rating}" if mark.rating else "")
    for text, color in ((f"{format_number(entry.duration, '.1f')} s", look.dim), (words, look.text)):
        if text and right - wide(text) - 6 - line.left() > NAME:  # the name goes before them
            right -= wide(text) + 6
            painter.setPen(QColor(color))
            painter.drawText(QRect(right, line.top(), wide(text) + 2, line.height()), MIDDLE, text)
    if mark.color:
        right -= TAG + 5
        draw_label(painter, QRect(right, line.center().y() - TAG // 2, TAG, TAG), mark.color)
    room = right - line.left() - 4
    if room > 12:
        shown = f"{front} {rest}".strip()
        if wide(shown) > room:
            shown = shorten_to_font(rest, room, painter.font().toString(), names.beside(row))
        painter.setPen(QColor(look.text))
        painter.drawText(QRect(line.left(), line.top(), room, line.height()), MIDDLE, shown)


def draw_columns(painter: QPainter, rect: QRect, entry: ClipEntry, header: ClipHeader, ink: ClipInk) -> None:
    """Draw what stands in the columns of a clip, each cut where it has no room: at its end, names in their
    middle.
    """
    facts, look = ink.facts, ink.look
    metrics = painter.fontMetrics()
    name = PLACES["name"]
    for n, column in enumerate(COLUMNS):
        if header.isSectionHidden(n):
            continue
        left, width = header.sectionViewportPosition(n), header.sectionSize(n)
        cell = QRect(left + 6, rect.top(), width - 12, rect.height())
        if n == name:
            within = QRect(left, rect.top(), width, rect.height())
            draw_stripe(painter, within.adjusted(0, -3, 0, 3), facts, entry, look)
            box = place_picture("columns", ink.side, within)
            draw_picture(painter, box, ink.pictures, entry, look, small=True)
            cell.setLeft(box.right() + 8)
        if column.id == "color" and facts.mark(entry).color:
            draw_label(
                painter, QRect(cell.left(), cell.center().y() - TAG // 2, TAG, TAG), facts.mark(entry).color
            )
            cell.setLeft(cell.left() + TAG + 5)
        if column.id == "kind":
            kinds = list_clip_kinds(facts, entry)
            for kind in kinds:
                painter.setPen(look.kind(kind))
                painter.drawText(cell, MIDDLE, KIND_MARKS[kind])
                cell.setLeft(cell.left() + 16)
        words = " ".join(ink.names.of(entry)).strip() if n == name else column.words(facts, entry)
        if not words or cell.width() < 8:
            continue
        painter.setPen(QColor(look.text if column.id in ("name", "rating", "favourite") else look.dim))
        cut = Qt.TextElideMode.ElideMiddle if n == name else Qt.TextElideMode.ElideRight
        shown = metrics.elidedText(words, cut, cell.width())
        painter.drawText(
            cell,
            MIDDLE | (Qt.AlignmentFlag.AlignRight if column.right else Qt.AlignmentFlag.AlignLeft),
            shown,
        )
