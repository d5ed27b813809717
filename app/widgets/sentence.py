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
        shown = self.words
        if measure.horizontalAdvance(shown) > width:
            first = self._first_line(width) if self.height() >= 2 * measure.height() - 2 else 0
            rest = measure.elidedText(self.words[first:].strip(), Qt.TextElideMode.ElideRight, width)
            shown = f"{self.words[:first]}\n{rest}" if first else rest
        if shown != self.text():
            self.setText(shown)
            self.setToolTip(self.words if " ".join(shown.split()) != self.words else "")
            self.setAccessibleName(self.words)

    def _first_line(self, width: int) -> int:
        """Return how many letters of whole words a line has room for."""
        measure, end = self.fontMetrics(), 0
        for at in (n for n, letter in enumerate(self.words) if letter == " "):
            if measure.horizontalAdvance(self.words[:at]) > width:
                break
            end = at
        return end
