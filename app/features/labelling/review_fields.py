"""What a clip is taken for, field by field, with the values it may have as numbered chips: one key or one
click corrects.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from PySide6.QtCore import QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QFont, QFontMetricsF, QMouseEvent, QPainter, QPaintEvent, QPen, QResizeEvent
from PySide6.QtWidgets import QSizePolicy, QWidget

from app.look.theme import KIND_MARKS, WindowTheme, get_theme
from app.stage.session import StageSession
from app.translation import tr
from metagraph.suggest.review import Field

TITLE, PAD, CHIP, GAP = (
    78,
    12,
    28,
    6,
)  # pixels: the title's column, the card's inside, a chip's height, between chips
LINE = 17  # pixels a line of small text takes


@dataclass(frozen=True)
class ReviewRow:
    """name: the field. choices: (value, words). value: the one that holds. sure: 0..1. reason: why, in
    words.
    """

    name: Field
    title: str
    choices: Sequence[tuple[Any, str]]
    value: Any
    sure: float
    reason: str
    kind: str = ""  # of the clip, which gives the colour


@dataclass
class _Placed:
    row: ReviewRow
    card: QRectF
    chips: list[QRectF] = field(default_factory=list)
    reason: QRectF = field(default_factory=QRectF)


class ReviewFields(QWidget):
    """chosen: (field, value) of a clicked chip. picked: a field was clicked beside its chips."""

    chosen = Signal(str, object)
    picked = Signal(str)

    def __init__(self, session: StageSession, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.session = session
        self.rows: tuple[ReviewRow, ...] = ()
        self.current = ""
        self._placed: list[_Placed] = []
        self._high = 0.0
        self.setMouseTracking(True)
        self.setAccessibleName(tr("Proposed label"))
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        session.look.changed.connect(self.update)

    def show_rows(self, rows: Sequence[ReviewRow], current: str) -> None:
        self.rows, self.current = tuple(rows), current
        self.setAccessibleDescription(
            "; ".join(
                tr(
                    "{title}: {words}, {sure:.0f} % certain",
                    title=r.title,
                    words=self._words(r),
                    sure=100 * r.sure,
                )
                for r in rows
            )
        )
        self._arrange()
        self.update()

    @staticmethod
    def _words(row: ReviewRow) -> str:
        return next((words for value, words in row.choices if value == row.value), tr("unknown"))

    def chip(self, name: str, value: Any) -> QPointF:
        """Return the middle of a chip, in pixels of this widget. Raises KeyError when there is none."""
        for each in self._placed:
            for box, (other, _) in zip(each.chips, each.row.choices, strict=True):
                if (each.row.name, other) == (name, value):
                    return box.center()
        raise KeyError((name, value))

    # --- where things are

    def _small(self) -> QFont:
        font = QFont(self.font())
        font.setPixelSize(14)
        return font

    def _arrange(self) -> None:
        """Lay the rows out one below the other, their chips in as many lines as they need."""
        bold = QFont(self.font())
        bold.setBold(True)
        metrics, small = QFontMetricsF(bold), QFontMetricsF(self._small())
        wide = max(240.0, float(self.width()))
        self._placed, y = [], 0.0
        for row in self.rows:
            placed = _Placed(row, QRectF())
            x, top = float(PAD + TITLE), y + PAD
            numbered = row.name == self.current
            for number, (_, words) in enumerate(row.choices):
                mark = 18.0 if numbered and number < 9 else 0.0
                width = min(
                    metrics.horizontalAdvance(self._chip_words(row, number, words)) + 22 + mark,
                    wide - TITLE - 2 * PAD,
                )
                if x + width > wide - PAD and x > PAD + TITLE:
                    x, top = float(PAD + TITLE), top + CHIP + GAP
                placed.chips.append(QRectF(x, top, width, CHIP))
                x += width + GAP
            below = top + CHIP + 4
            lines = small.boundingRect(
                QRectF(0, 0, wide - TITLE - 2 * PAD, 5000), int(Qt.TextFlag.TextWordWrap), row.reason
            ).height() if row.reason else 0.0  # fmt: skip
            placed.reason = QRectF(
                PAD + TITLE,
                below,
                wide - TITLE - 2 * PAD,
                max(LINE, lines) if row.reason else 0,
            )
            placed.card = QRectF(0, y, wide, placed.reason.bottom() + PAD - 2 - y)
            self._placed.append(placed)
            y = placed.card.bottom() + 4
        self._high = y
        self.setFixedHeight(max(1, round(y)))

    @staticmethod
    def _chip_words(row: ReviewRow, number: int, words: str) -> str:
        return f"{KIND_MARKS[str(row.choices[number][0])]} {words}" if row.name == "kind" else words

    def sizeHint(self) -> QSize:
        return QSize(380, round(self._high))

    def resizeEvent(self, event: QResizeEvent) -> None:
        self._arrange()

    # --- drawing

    def paintEvent(self, event: QPaintEvent) -> None:
        look = get_theme(self.session.look.name)
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        for placed in self._placed:
            self._paint(painter, look, placed)
        painter.end()

    def _paint(self, painter: QPainter, look: WindowTheme, placed: _Placed) -> None:
        row, here = placed.row, placed.row.name == self.current
        if here:
            painter.setPen(QPen(QColor(look.line), 1))
            painter.setBrush(QColor(look.card))
            painter.drawRoundedRect(placed.card.adjusted(0.5, 0.5, -0.5, -0.5), 6, 6)
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(QColor(look.text))
            painter.drawRoundedRect(
                QRectF(0.5, placed.card.top() + 8, 3, placed.card.height() - 16), 1.5, 1.5
            )
        painter.setFont(self.font())
        painter.setPen(QColor(look.text if here else look.dim))
        title = QRectF(PAD, placed.card.top() + PAD, TITLE - 8, CHIP)
        painter.drawText(title, Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft, row.title)
        for number, (box, (value, words)) in enumerate(zip(placed.chips, row.choices, strict=True)):
            self._chip(painter, look, row, box, number, words, value == row.value, here)
        painter.setFont(self._small())
        doubt = row.sure < 0.7
        painter.setPen(QColor(look.warning if doubt else look.dim))
        painter.drawText(
            QRectF(PAD, placed.reason.top(), TITLE - 8, LINE),
            Qt.AlignmentFlag.AlignTop | Qt.AlignmentFlag.AlignLeft,
            f"{100 * row.sure:.0f} %",
        )
        painter.setPen(QColor(look.dim))
        painter.drawText(
            placed.reason, int(Qt.AlignmentFlag.AlignTop) | int(Qt.TextFlag.TextWordWrap), row.reason
        )

    def _chip(
        self,
        painter: QPainter,
        look: WindowTheme,
        row: ReviewRow,
        box: QRectF,
        number: int,
        words: str,
        on: bool,
        here: bool,
    ) -> None:
        color = QColor(look.kinds.get(row.kind, look.text)) if on else QColor(look.line)
        ground = QColor(look.fills.get(row.kind, look.text)) if on else QColor(look.field)
        if on:
            ground.setAlpha(46)
        painter.setPen(QPen(color, 1.5 if on else 1))
        painter.setBrush(ground)
        painter.drawRoundedRect(box.adjusted(0.75, 0.75, -0.75, -0.75), 6, 6)
        inner = box.adjusted(10, 0, -10, 0)
        if here and number < 9:
            painter.setFont(self._small())
            painter.setPen(QColor(look.dim))
            painter.drawText(
                inner, Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft, str(number + 1)
            )
            inner = inner.adjusted(18, 0, 0, 0)
        font = QFont(self.font())
        font.setBold(on)
        painter.setFont(font)
        painter.setPen(QColor(look.text if on else look.dim))
        shown = QFontMetricsF(font).elidedText(
            self._chip_words(row, number, words), Qt.TextElideMode.ElideRight, inner.width() + 6
        )
        painter.drawText(
            inner.adjusted(0, 0, 8, 0), Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft, shown
        )

    # --- the mouse

    def mousePressEvent(self, event: QMouseEvent) -> None:
        for placed in self._placed:
            for box, (value, _) in zip(placed.chips, placed.row.choices, strict=True):
                if box.contains(event.position()):
                    self.chosen.emit(placed.row.name, value)
                    return
            if placed.card.contains(event.position()):
                self.picked.emit(placed.row.name)
                return

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        over = any(box.contains(event.position()) for placed in self._placed for box in placed.chips)
        self.setCursor(Qt.CursorShape.PointingHandCursor if over else Qt.CursorShape.ArrowCursor)
