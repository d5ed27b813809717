"""The drag of the part that plays again and again."""

from __future__ import annotations

from PySide6.QtCore import QPointF
from PySide6.QtGui import QMouseEvent

from app.features.timing_editor.drags.host import Host
from app.features.timing_editor.track import Facts
from app.widgets.gesture import PressDrag, Reason


class LoopDrag(PressDrag):
    """A part of the clip is marked that plays again and again; a click marks none."""

    catch = 3.0

    def __init__(self, host: Host, facts: Facts) -> None:
        super().__init__()
        self.host, self.facts = host, facts
        self.before = host.transport.part

    def update(self, at: QPointF, free: bool = False) -> None:
        if not self.caught(at):
            return
        last = self.facts.entry.duration
        ends = sorted(min(max(0.0, self.host.axis.seconds(x)), last) for x in (self.origin.x(), at.x()))
        if ends[1] - ends[0] >= 1 / self.facts.entry.fps:
            self.host.transport.set_part((self.facts.action.clip, round(ends[0], 3), round(ends[1], 3)))

    def finish(self, at: QPointF) -> None:
        self.update(at)

    def click(self, event: QMouseEvent) -> None:
        self.host.transport.set_part(None)

    def cancel(self, reason: Reason) -> None:
        self.host.transport.set_part(self.before)
