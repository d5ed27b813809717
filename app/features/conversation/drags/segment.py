"""What drags of segments share."""

from __future__ import annotations

from PySide6.QtCore import QPointF
from PySide6.QtGui import QMouseEvent

from app.features.conversation.drags.host import SegmentHost
from app.features.conversation.segment_hits import SegmentHit, find_word_edges, snap_time
from app.project.document import Edit
from app.translation import tr
from app.widgets.gesture import PressDrag, Reason


class SegmentDrag(PressDrag):
    """It shows what it would make while it lasts, and makes it at its end, in one step. A click without keys
    selects the segment alone. words: beside the pointer.
    """

    text = ""
    catch = 3.0

    def __init__(self, view: SegmentHost, hit: SegmentHit) -> None:
        super().__init__()
        self.view, self.hit = view, hit
        self.words = ""
        self.seconds = 0.0  # where the words stand
        self.made: Edit | None = None

    def update(self, at: QPointF, free: bool = False) -> None:
        if not self.caught(QPointF(at.x(), self.origin.y())):
            return
        self.made = self.edit(at, free)
        self.view.hold(self.made)

    def finish(self, at: QPointF) -> None:
        self.view.hold(None)
        if self.begun and self.made is not None:
            self.view.editing.edit(tr(self.text), self.made)

    def cancel(self, reason: Reason) -> None:
        self.view.hold(None)

    def click(self, event: QMouseEvent) -> None:
        if not event.modifiers() and self.hit.at >= 0:
            self.view.editing.select({(self.hit.side, self.hit.at)})

    def edit(self, at: QPointF, free: bool) -> Edit | None:
        """Return what releasing the button now would do."""
        raise NotImplementedError

    def snapped(self, seconds: float, free: bool) -> float:
        """Return a time, caught by where a word begins or ends."""
        of = self.view.editing.conversation
        words = of.sides[self.hit.side].words if of is not None else ()
        return snap_time(seconds, find_word_edges(words, seconds), self.view.scale(), not free)
