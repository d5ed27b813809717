"""The drag of the playhead."""

from __future__ import annotations

from PySide6.QtCore import QPointF

from app.features.conversation.drags.host import SegmentHost
from app.widgets.gesture import PressDrag, Reason


class SegmentScrub(PressDrag):
    """Moves the playhead with the mouse."""

    def __init__(self, view: SegmentHost) -> None:
        super().__init__()
        self.view, self.before = view, view.session.transport.seconds

    def begin(self, at: QPointF) -> None:
        super().begin(at)
        self.view.session.transport.set_playing(False)
        self.update(at)

    def update(self, at: QPointF, free: bool = False) -> None:
        self.view.session.transport.seek(
            self.view.scale().seconds(max(at.x(), self.view.scale().x(self.view.first)))
        )

    def finish(self, at: QPointF) -> None:
        """The playhead is where it is."""

    def cancel(self, reason: Reason) -> None:
        self.view.session.transport.seek(self.before)
