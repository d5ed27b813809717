"""Draws a clip as a card."""

from __future__ import annotations

from collections.abc import Iterable

from PySide6.QtCore import QRect, QSize, Qt
from PySide6.QtGui import QColor, QFont, QFontMetrics, QPainter, QPen
from PySide6.QtWidgets import QListView, QStyle, QStyledItemDelegate, QStyleOptionViewItem

from app.features.library.clip_model import ENTRY, Index
from app.features.library.clip_names import ClipNames
from app.look.shortening import fitted, fitting
from app.look.theme import KIND_MARKS, theme
from app.look.theme_choice import ThemeChoice
from app.project.document import Document
from app.stage.thumbnails import Thumbnails
from metagraph.graph.model import ClipEntry

PICTURE = 108


class CardDelegate(QStyledItemDelegate):
    """Draws a clip as a card: picture, name, length, a stripe and mark for each kind it serves as."""

    def __init__(
        self,
        document: Document,
        look: ThemeChoice,
        thumbnails: Thumbnails,
        names: ClipNames,
        parent: QListView,
    ) -> None:
        super().__init__(parent)
        self.document, self.look, self.thumbnails = document, look, thumbnails
        self.names, self.list = names, parent

    def sizeHint(self, option: QStyleOptionViewItem, index: Index) -> QSize:
        return self.list.gridSize()

    def paint(self, painter: QPainter, option: QStyleOptionViewItem, index: Index) -> None:
        entry: ClipEntry = index.data(ENTRY)
        if entry is None:
            return
        t = theme(self.look.name)
        project = self.document.project
        rect = option.rect.adjusted(4, 4, -4, -4)
        state = option.state
        selected, hover = (
            bool(state & QStyle.StateFlag.State_Selected),
            bool(state & QStyle.StateFlag.State_MouseOver),
        )
        painter.save()
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
        painter.setBrush(QColor(t.hover if hover or selected else t.field))
        painter.setPen(QPen(QColor(t.text if selected else t.line), 1.6 if selected else 1))
        painter.drawRoundedRect(rect, 6, 6)
        picture = self.thumbnails.picture(entry.id, bare=True)
        box = QRect(rect.left() + (rect.width() - PICTURE) // 2, rect.top() + 2, PICTURE, PICTURE)
        if picture is not None:
            painter.drawImage(box, picture)
        elif entry.motion is None:
            painter.setPen(QColor(t.warning))
            painter.drawText(box, Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap, "file\nmissing")
        kinds = list(dict.fromkeys(a.kind for a in project.uses.get(entry.id, ())))
        drawn = entry.id in project.drawn and not kinds  # a state of a machine is of no kind
        marks = [QColor(t.dim)] if drawn else [t.fill(kind) for kind in kinds]
        for place, mark in enumerate(marks):
            height = (rect.height() - 12) / len(marks)
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(mark)
            painter.drawRoundedRect(
                rect.left() + 3, round(rect.top() + 6 + place * height), 4, round(height - 1), 2, 2
            )
        font = QFont(option.font)
        font.setPixelSize(12)
        painter.setFont(font)
        painter.setPen(QColor(t.text))
        line = QRect(rect.left() + 11, rect.bottom() - 53, rect.width() - 16, 16)
        front, rest = self.names.of(entry)
        key, beside = font.toString(), self.names.beside(index.row())
        shown = (
            (
                fitted(front, line.width(), key, self.names.stances()),
                fitted(rest, line.width(), key, beside),
            )
            if front
            else two_lines(rest, painter.fontMetrics(), line.width(), beside)
        )
        for n, part in enumerate(shown):
            painter.setPen(QColor(t.dim if front and n == 0 else t.text))
            painter.drawText(line, Qt.AlignmentFlag.AlignVCenter, part)
            line.translate(0, 16)
        painter.setPen(QColor(t.dim))
        line.moveTop(rect.bottom() - 20)
        painter.drawText(line, Qt.AlignmentFlag.AlignVCenter, f"{entry.duration:.1f} s")
        right = line.right()
        for kind in reversed(kinds):
            painter.setPen(t.kind(kind))
            right -= 14
            painter.drawText(
                QRect(right, line.top(), 14, line.height()), Qt.AlignmentFlag.AlignCenter, KIND_MARKS[kind]
            )
        if project.base.clip == entry.id:
            painter.setPen(QColor(t.dim))
            painter.drawText(
                line.adjusted(0, 0, right - line.right() - 2, 0),
                Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter,
                "base",
            )
        painter.restore()


def two_lines(name: str, metrics: QFontMetrics, width: int, beside: Iterable[str] = ()) -> tuple[str, ...]:
    """Break a name over at most two lines, after a separator where there is one. beside: names of the cards
    round it, from which what is shown is to differ.
    """
    if metrics.horizontalAdvance(name) <= width:
        return (name,)
    measure = metrics.horizontalAdvance
    first, second = _broken(name, metrics, width)
    if measure(second) > width:
        rivals = [o[len(name) - len(second) :] for o in beside if o.startswith(first)]
        cut = fitting(second, width, measure, rivals, sure=True)
        if cut:
            return first, cut
        first, second = _broken(fitting(name, 2 * width - 16, measure, beside), metrics, width, hard=True)
    return first, fitting(second, width, measure)


def _broken(name: str, metrics: QFontMetrics, width: int, hard: bool = False) -> tuple[str, str]:
    """Break a name behind a separator, or where the line is full. hard: there if the rest needs it."""
    fits = max((n for n in range(1, len(name)) if metrics.horizontalAdvance(name[:n]) <= width), default=1)
    cuts = [n for n in range(fits, fits // 2, -1) if name[n - 1] in "_- .@"]
    cut = cuts[0] if cuts else fits
    if hard and metrics.horizontalAdvance(name[cut:]) > width:
        cut = fits
    return name[:cut].rstrip(), name[cut:]
