"""Call a function once for several requests in one pass of the event loop."""

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
        """Request a call soon."""
        if not self._waiting:
            self._waiting = True
            self._asked.emit()

    def now(self) -> None:
        """Call the function now, if a call was requested."""
        if self._waiting:
            self._waiting = False
            self.call()

    def done(self) -> None:
        """Drop the request for a call."""
        self._waiting = False
