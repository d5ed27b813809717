"""Draws clips in the list: as cards, as lines, in columns, and the titles of their groups."""

from __future__ import annotations

from PySide6.QtCore import QRect, Qt
from PySide6.QtGui import QColor, QPainter, QPen
from PySide6.QtWidgets import QStyle, QStyledItemDelegate, QStyleOptionViewItem

from app.features.library.clip_card import ClipInk, draw_clip_card
from app.features.library.clip_facts import ClipFacts
from app.features.library.clip_header import ClipHeader
from app.features.library.clip_layout import Section
from app.features.library.clip_line import draw_back, draw_columns, draw_line
from app.features.library.clip_names import ClipNames
from app.features.library.clip_pictures import ClipPictures
from app.features.library.clip_rows import ENTRY, Index
from app.features.library.clip_sizes import USUAL, Style, is_in_lines
from app.look.theme import WindowTheme, get_theme
from app.look.theme_choice import ThemeChoice
from metagraph.graph.model import ClipEntry


class ClipDelegate(QStyledItemDelegate):
    """Draws what a list of clips shows. `show_as` says how."""

    def __init__(self, look: ThemeChoice, facts: ClipFacts, pictures: ClipPictures, names: ClipNames) -> None:
        super().__init__()
        self.look, self.facts, self.pictures, self.names = look, facts, pictures, names
        self.style_of: Style = "cards"
        self.side = USUAL["cards"]
        self._header: ClipHeader | None = None

    def show_as(self, style: Style, side: int, header: ClipHeader) -> None:
        """Draw cards, lines or columns with pictures of so many pixels."""
        self.style_of, self.side, self._header = style, side, header

    @property
    def _theme(self) -> WindowTheme:
        return get_theme(self.look.name)

    def paint(self, painter: QPainter, option: QStyleOptionViewItem, index: Index) -> None:
        entry: ClipEntry = index.data(ENTRY)
        if entry is None:
            return
        look, state = self._theme, option.state
        chosen = bool(state & QStyle.StateFlag.State_Selected)
        lit = chosen or bool(state & QStyle.StateFlag.State_MouseOver)
        painter.save()
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
        painter.setFont(option.font)
        ink = ClipInk(self.facts, self.pictures, self.names, self.side, look)
        if not is_in_lines(self.style_of, self.side):
            draw_clip_card(painter, option.rect, entry, index.row(), ink, lit, chosen)
        else:
            draw_back(painter, option.rect, look, lit, chosen)
            if self.style_of == "columns" and self._header is not None:
                draw_columns(painter, option.rect, entry, self._header, ink)
            else:
                draw_line(painter, option.rect, entry, index.row(), ink)
        if state & QStyle.StateFlag.State_HasFocus:
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.setPen(QPen(QColor(look.dim), 1, Qt.PenStyle.DashLine))
            painter.drawRoundedRect(option.rect.adjusted(2, 2, -3, -3), 6, 6)
        painter.restore()

    def paint_ground(self, painter: QPainter, area: QRect) -> None:
        painter.fillRect(area, QColor(self._theme.panel))

    def paint_head(self, painter: QPainter, rect: QRect, section: Section) -> None:
        """Draw the title of a group: an arrow that tells whether it is open, and how many are in it."""
        look = self._theme
        painter.fillRect(rect, QColor(look.panel))
        font = painter.font()
        font.setBold(True)
        painter.setFont(font)
        painter.setPen(QColor(look.text))
        line = rect.adjusted(8, 0, -8, 0)
        middle = Qt.AlignmentFlag.AlignVCenter
        painter.drawText(line, middle, "▸" if section.closed else "▾")
        count = str(section.count)
        wide = painter.fontMetrics().horizontalAdvance
        room = line.width() - 18 - wide(count) - 10
        words = painter.fontMetrics().elidedText(section.title, Qt.TextElideMode.ElideMiddle, room)
        painter.drawText(line.adjusted(18, 0, 0, 0), middle, words)
        font.setBold(False)
        painter.setFont(font)
        painter.setPen(QColor(look.dim))
        painter.drawText(line.adjusted(18 + wide(words) + 16, 0, 0, 0), middle, count)
        painter.setPen(QColor(look.line))
        painter.drawLine(rect.bottomLeft(), rect.bottomRight())

    def paint_band(self, painter: QPainter, rect: QRect) -> None:
        """Draw the rectangle in which clips are selected."""
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(QPen(QColor(self._theme.dim), 1))
        painter.drawRect(rect.normalized())
