"""The drag of what is in sight."""

from __future__ import annotations

from PySide6.QtCore import QPointF, Qt

from app.features.conversation.drags.host import SegmentHost
from app.widgets.gesture import PressDrag, Reason


class SegmentPan(PressDrag):
    """Moves along in time with the mouse."""

    cursor = Qt.CursorShape.ClosedHandCursor

    def __init__(self, view: SegmentHost) -> None:
        super().__init__()
        self.view, self.before = view, view.first

    def update(self, at: QPointF, free: bool = False) -> None:
        self.view.look_at(self.before - (at.x() - self.origin.x()) / self.view.each)

    def finish(self, at: QPointF) -> None:
        """What is in sight is."""

    def cancel(self, reason: Reason) -> None:
        self.view.look_at(self.before)
