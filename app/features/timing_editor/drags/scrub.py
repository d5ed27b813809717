"""The drag of the playhead."""

from __future__ import annotations

from PySide6.QtCore import QPointF

from app.features.timing_editor.drags.host import Host
from app.features.timing_editor.track import Facts
from app.widgets.gesture import PointerDrag, Reason


class Scrubbing(PointerDrag):
    """The character follows the pointer."""

    begun = True

    def __init__(self, host: Host, facts: Facts) -> None:
        self.host, self.facts = host, facts

    def begin(self, at: QPointF) -> None:
        self.update(at)

    def update(self, at: QPointF, free: bool = False) -> None:
        seconds = min(max(0.0, self.host.axis.seconds(at.x())), self.facts.entry.duration)
        self.host.transport.scrub(self.facts.action.clip, seconds)

    def finish(self, at: QPointF) -> None:
        self.update(at)

    def cancel(self, reason: Reason) -> None:
        """Nothing was changed."""
