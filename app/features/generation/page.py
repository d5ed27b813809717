"""What both pages of the window are made of."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QLabel, QPushButton, QWidget


class Page(QWidget):
    """said: words for the foot of the window."""

    said = Signal(str)

    def heading(self, words: str) -> QLabel:
        out = QLabel(words, self)
        out.setProperty("heading", True)
        return out

    def button(self, words: str, tip: str, run: Callable[[], object]) -> QPushButton:
        out = QPushButton(words, self, autoDefault=False)
        out.setToolTip(tip)
        out.clicked.connect(lambda: run())
        return out
