"""Which theme is shown."""

from __future__ import annotations

from typing import Literal

from PySide6.QtCore import QObject, Signal


class ThemeChoice(QObject):
    """The chosen theme. changed: signals a switch between dark and light."""

    changed = Signal()

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.name: Literal["dark", "light"] = "dark"

    def choose(self, name: Literal["dark", "light"]) -> None:
        if name != self.name:
            self.name = name
            self.changed.emit()
