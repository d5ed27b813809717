"""The drag of the border below a lane."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QPointF, Qt

from app.features.timeline.drags.host import LanesHost
from app.widgets.gesture import PressDrag, Reason


class BorderDrag(PressDrag):
    """The border below a lane being dragged. keep: has the lanes' heights kept."""

    catch = 2.0
    cursor = Qt.CursorShape.SizeVerCursor

    def __init__(self, host: LanesHost, lane: str, keep: Callable[[], None]) -> None:
        super().__init__()
        self.host, self.lane, self.keep, self._was = host, lane, keep, host.sizes

    def update(self, at: QPointF, free: bool = False) -> None:
        if self.caught(QPointF(self.origin.x(), at.y())):
            self.host.set_sizes(self._was.resized(self.lane, at.y(), self.host.height()))

    def finish(self, at: QPointF) -> None:
        if self.begun:
            self.keep()

    def cancel(self, reason: Reason) -> None:
        self.host.set_sizes(self._was)
