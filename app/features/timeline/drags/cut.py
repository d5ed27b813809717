"""The drag of a cut between pictures of the cameras."""

from __future__ import annotations

from PySide6.QtCore import QPointF

from app.features.timeline.drags.host import LanesHost
from app.features.timeline.drags.lane import LaneDrag


class CutDrag(LaneDrag):
    """A cut moved in time, between its neighbours. at: seconds where it will be."""

    catch = 2.0

    def __init__(self, host: LanesHost, number: int) -> None:
        super().__init__(host)
        self.number = number
        self.cuts = host.performance.timeline.now.cuts
        self.at = self.cuts[number].at

    def update(self, at: QPointF, free: bool = False) -> None:
        if self.caught(at):
            host, was = self.host, self.cuts[self.number].at
            wanted = host.magnet.snap(max(0.0, was + (at.x() - self.origin.x()) / host.each), host.each)
            low = self.cuts[self.number - 1].at + 0.1 if self.number else 0.0
            high = self.cuts[self.number + 1].at - 0.1 if self.number + 1 < len(self.cuts) else wanted
            self.at = min(max(wanted, low), high)

    def finish(self, at: QPointF) -> None:
        if self.begun and self.at != self.cuts[self.number].at:
            self.host.performance.timeline.move_cut(self.number, self.at)
