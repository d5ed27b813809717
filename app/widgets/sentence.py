"""Sentences that give way if there is no room for them."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QLabel, QSizePolicy, QWidget

from app.look.shortening import shorten_middle


class OneLine(QLabel):
    """A line whose middle gives way if there is no room for it; a tooltip then tells all of it. more: what
    the tooltip says besides.
    """

    def __init__(self, parent: QWidget, more: str = "") -> None:
        super().__init__(parent)
        self.words, self.more = "", more
        self.setTextFormat(Qt.TextFormat.PlainText)
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)

    def say(self, words: str) -> None:
        """Show words."""
        if words != self.words:
            self.words = words
            self._fit()

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._fit()

    def _fit(self) -> None:
        shown = shorten_middle(self.words, max(1, self.width() - 2), self.fontMetrics().horizontalAdvance)
        self.setText(shown)
        self.setToolTip("\n".join(x for x in (self.words if shown != self.words else "", self.more) if x))
        self.setAccessibleName(self.words)


class Sentence(QLabel):
    """A line, or two where it is narrow, that gives way if there is no room for it, and then tells all of it
    in a tooltip.
    """

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.words = ""
        self.setTextFormat(Qt.TextFormat.PlainText)
        self.setWordWrap(True)
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Ignored)
        self.setMinimumWidth(40)

    def say(self, words: str, strong: bool = False) -> None:
        """Show words; strong: they are about what is selected."""
        if strong == bool(self.property("dim")):
            self.setProperty("dim", not strong)
            self.style().polish(self)
        self.words = " ".join(words.split())
        self._fit()

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._fit()

    def _fit(self) -> None:
        measure, width = self.fontMetrics(), max(20, self.width() - 2)
        two = self.height() >= 2 * measure.height() - 2 and measure.horizontalAdvance(self.words) > width
        room = 2 * width - 60 if two else width  # the first line ends with a whole word
        shown = measure.elidedText(self.words, Qt.TextElideMode.ElideRight, max(20, room))
        if shown != self.text():
            self.setText(shown)
            self.setToolTip(self.words if shown != self.words else "")
            self.setAccessibleName(self.words)
