"""The drag of what is seen of the rows."""

from __future__ import annotations

from PySide6.QtCore import QPointF

from app.features.timing_editor.drags.host import Host
from app.widgets.gesture import PointerDrag, Reason


class Panning(PointerDrag):
    """The rows follow the pointer."""

    begun = True

    def __init__(self, host: Host) -> None:
        self.host, self.x = host, 0.0

    def begin(self, at: QPointF) -> None:
        self.x = at.x()

    def update(self, at: QPointF, free: bool = False) -> None:
        self.host.axis = self.host.axis.moved(self.x - at.x())
        self.x = at.x()
        self.host.update()

    def finish(self, at: QPointF) -> None:
        self.update(at)

    def cancel(self, reason: Reason) -> None:
        """Where it stands is where it stays."""
