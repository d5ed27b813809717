"""Paint a window once after much of it changes."""

from __future__ import annotations

from PySide6.QtCore import QCoreApplication, QEvent, QObject
from PySide6.QtWidgets import QWidget


class PaintingHold(QObject):
    """Keeps a window from painting from `begin` until `end`; then it paints what changed meanwhile.

    `QWidget.setUpdatesEnabled` would paint every widget at the end, and each of them twice.
    """

    def __init__(self, window: QWidget) -> None:
        super().__init__(window)
        self._window = window

    def begin(self) -> None:
        self._window.installEventFilter(self)

    def end(self) -> None:
        """Let the window paint as soon as the event loop continues."""
        self._window.removeEventFilter(self)
        # Qt asks a window once, and does not know that this was refused.
        QCoreApplication.postEvent(self._window, QEvent(QEvent.Type.UpdateRequest))

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        return event.type() == QEvent.Type.UpdateRequest
