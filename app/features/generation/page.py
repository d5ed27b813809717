"""What both pages of the window are made of."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QHBoxLayout, QLabel, QPushButton, QWidget

from app.translation import tr


class GenerationPage(QWidget):
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

    def row(self, *fields: tuple[str, QWidget]) -> QHBoxLayout:
        """Return fields beside each other, each with words in front of it, or none."""
        row = QHBoxLayout()
        for n, (words, field) in enumerate(fields):
            if words:
                label = QLabel(words, self)
                if n == 0:  # what rows begin with stands below each other
                    label.setFixedWidth(label.fontMetrics().horizontalAdvance(tr("Model")) + 4)
                row.addWidget(label)
            row.addWidget(field)
            row.addSpacing(6)
        row.addStretch(1)
        return row
