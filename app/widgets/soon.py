"""Doing something once for all that asks for it in one go."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QObject, Qt, Signal


class Soon(QObject):
    """Calls a function once after it was asked to, however often: when the event loop goes on, and before
    it lets anything be painted.
    """

    _asked = Signal()

    def __init__(self, call: Callable[[], object], parent: QObject) -> None:
        super().__init__(parent)
        self.call, self._waiting = call, False
        self._asked.connect(self.now, Qt.ConnectionType.QueuedConnection)

    def ask(self) -> None:
        """Let it be called before long."""
        if not self._waiting:
            self._waiting = True
            self._asked.emit()

    def now(self) -> None:
        """Call it at once if it was asked to and has not been called since."""
        if self._waiting:
            self._waiting = False
            self.call()

    def done(self) -> None:
        """Forget that it was asked to: it has been done."""
        self._waiting = False
