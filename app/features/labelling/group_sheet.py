"""A sheet of moving pictures: clips side by side, each chosen or left out by a click."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from PySide6.QtCore import QEvent, QPoint, QRect, QSize, Qt, QTimer, Signal
from PySide6.QtGui import QColor, QHelpEvent, QImage, QMouseEvent, QPainter, QPaintEvent, QPen, QResizeEvent
from PySide6.QtWidgets import QToolTip, QWidget

from app.look.comfort import get_comfort
from app.look.shortening import shorten_to_lines_in_font
from app.look.theme import get_theme
from app.stage.session import StageSession
from app.stage.thumbnails import Thumbnails
from app.translation import tr

CARD, GAP, TEXT = 124, 8, 38  # pixels: width of a card, between cards, height of the words under a picture
BEAT = 120  # milliseconds from picture to picture


@dataclass(frozen=True)
class SheetCard:
    """`name` is shown under the picture, `words` in the tooltip. `certainty` is 0..1, `doubtful` marks it."""

    clip: str
    name: str
    words: str
    certainty: float
    doubtful: bool


class GroupSheet(QWidget):
    """`left_out` has the clips that were clicked away. `changed`: the clips or `left_out` have changed.
    `opened`: a clip was double-clicked.
    """

    changed = Signal()
    opened = Signal(str)

    def __init__(self, session: StageSession, thumbnails: Thumbnails, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.session, self.thumbnails = session, thumbnails
        self.cards: tuple[SheetCard, ...] = ()
        self.left_out: set[str] = set()
        self.current = 0
        self._beat = 0
        self._timer = QTimer(self, interval=BEAT)
        self._timer.timeout.connect(self._next)
        if not get_comfort().still:
            self._timer.start()
        self.setAccessibleName(tr("Clips of the group"))
        self.setMouseTracking(True)
        thumbnails.ready.connect(self._picture_came)

    @property
    def chosen(self) -> list[str]:
        """Return the clips that were not left out, in order."""
        return [card.clip for card in self.cards if card.clip not in self.left_out]

    def show_cards(self, cards: Sequence[SheetCard]) -> None:
        """Show other clips. What was left out stays so; the current clip stays the current one if it is still
        there.
        """
        was = self.cards[self.current].clip if self.cards else None
        self.current = next((n for n, card in enumerate(cards) if card.clip == was), 0)
        self.cards = tuple(cards)
        self._fit()
        self.changed.emit()
        self.update()

    def toggle(self, clip: str) -> None:
        """Leave a clip out, or take it in again."""
        self.left_out ^= {clip}
        self.changed.emit()
        self.update()

    def step(self, step: int) -> None:
        """Make a card the current one, `step` cards further."""
        if self.cards:
            self.current = min(max(0, self.current + step), len(self.cards) - 1)
            self.update()

    @property
    def columns(self) -> int:
        """Return how many cards have room side by side."""
        return max(1, (self.width() - GAP) // (CARD + GAP))

    def card_rect(self, number: int) -> QRect:
        """Return where a card is."""
        row, column = divmod(number, self.columns)
        return QRect(GAP + column * (CARD + GAP), GAP + row * (CARD + TEXT + GAP), CARD, CARD + TEXT)

    def card_at(self, place: QPoint) -> int | None:
        """Return the number of the card at a place, None between cards."""
        return next((n for n in range(len(self.cards)) if self.card_rect(n).contains(place)), None)

    def _fit(self) -> None:
        rows = -(-len(self.cards) // self.columns)
        self.setMinimumHeight(GAP + rows * (CARD + TEXT + GAP))

    def _picture_came(self, _: str) -> None:
        self.update()

    def _next(self) -> None:
        if self.isVisible() and self.cards:
            self._beat += 1
            self.update()

    def sizeHint(self) -> QSize:
        return QSize(4 * (CARD + GAP) + GAP, 3 * (CARD + TEXT + GAP))

    def resizeEvent(self, event: QResizeEvent) -> None:
        self._fit()
        super().resizeEvent(event)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        number = self.card_at(event.position().toPoint())
        if number is not None and event.button() == Qt.MouseButton.LeftButton:
            self.current = number
            self.toggle(self.cards[number].clip)

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        number = self.card_at(event.position().toPoint())
        if number is not None:
            self.opened.emit(self.cards[number].clip)

    def event(self, event: QEvent) -> bool:
        if isinstance(event, QHelpEvent) and event.type() == QEvent.Type.ToolTip:
            number = self.card_at(event.pos())
            QToolTip.showText(event.globalPos(), self.cards[number].words if number is not None else "", self)
            return True
        return super().event(event)

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
        names = tuple(card.name for card in self.cards)
        for number, card in enumerate(self.cards):
            rect = self.card_rect(number)
            if rect.intersects(event.rect()):
                self._paint_card(painter, rect, card, number == self.current, names)

    def _picture(self, clip: str) -> QImage | None:
        frames = self.thumbnails.scrub(clip)
        return frames[self._beat % len(frames)] if frames else self.thumbnails.picture(clip, bare=True)

    def _paint_card(
        self, painter: QPainter, rect: QRect, card: SheetCard, current: bool, names: tuple[str, ...]
    ) -> None:
        look, out = get_theme(self.session.look.name), card.clip in self.left_out
        painter.setOpacity(1.0)
        painter.setBrush(QColor(look.field))
        painter.setPen(QPen(QColor(look.text if current else look.line), 1.6 if current else 1))
        painter.drawRoundedRect(rect, 6, 6)
        painter.setOpacity(0.25 if out else 1.0)
        picture = self._picture(card.clip)
        if picture is not None:
            painter.drawImage(QRect(rect.left() + 4, rect.top() + 4, CARD - 8, CARD - 8), picture)
        painter.setOpacity(1.0)
        font = self.font()
        font.setPixelSize(14)
        painter.setFont(font)
        line = QRect(rect.left() + 8, rect.top() + CARD - 2, rect.width() - 16, 16)
        painter.setPen(QColor(look.dim if out else look.text))
        for part in shorten_to_lines_in_font(card.name, line.width(), 2, font.toString(), names):
            painter.drawText(line, Qt.AlignmentFlag.AlignVCenter, part)
            line.translate(0, 16)
        painter.setPen(QColor(look.warning if card.doubtful and not out else look.dim))
        words = tr("left out") if out else f"{100 * card.certainty:.0f} %"
        corner = rect.adjusted(0, 6, -8, 0)
        painter.drawText(corner, Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignTop, words)
