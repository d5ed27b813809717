"""Show a text in the status bar that stays until it is clicked: something is worth reading, and blocks
nobody.
"""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtWidgets import QToolButton, QWidget


class Notice(QToolButton):
    """Hidden while there is nothing to read. A click shows it, and removes the notice."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self._show: Callable[[], object] | None = None
        self.clicked.connect(self._read)
        self.hide()

    def tell(self, words: str, tip: str, show: Callable[[], object]) -> None:
        self.setText(words)
        self.setToolTip(tip)
        self.setAccessibleName(words)
        self._show = show
        self.show()

    def clear(self) -> None:
        self._show = None
        self.hide()

    def _read(self) -> None:
        show = self._show
        self.clear()
        if show is not None:
            show()
