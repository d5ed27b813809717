"""Drag the length of a hold."""

from __future__ import annotations

from PySide6.QtCore import QPointF

from app.features.timing_editor.drags.host import Host
from app.features.timing_editor.drags.rows import RowsDrag
from app.features.timing_editor.track import Facts, Stay
from app.translation import tr
from metagraph.graph.editing.retiming import set_hold
from metagraph.motion.retime import LONGEST, SHORTEST


class StayDrag(RowsDrag):
    """Makes a hold longer or shorter. The clip is made again when the mouse is released."""

    def __init__(self, host: Host, facts: Facts, stay: Stay) -> None:
        super().__init__(host, facts)
        self.stay = stay
        self.seconds = stay.hold.seconds

    def update(self, at: QPointF, free: bool = False) -> None:
        if not self.caught(at):
            return
        longer = (at.x() - self.origin.x()) / self.host.axis.each
        self.seconds = round(min(max(0.0, self.stay.hold.seconds + longer), LONGEST), 2)
        self.host.held = (
            tr("hold of {seconds:.2f} s", seconds=self.seconds) if self.seconds >= SHORTEST else tr("no hold")
        )
        self.host.update()

    def finish(self, at: QPointF) -> None:
        self.over()
        if self.begun and self.seconds != self.stay.hold.seconds:
            clip, moment, seconds = self.facts.action.clip, self.stay.hold.at, self.seconds
            self.host.document.edit(tr("Change hold"), lambda p: set_hold(p, clip, moment, seconds))
