"""The drag of the range under the ruler's numbers, of either of its ends, or of a new one."""

from __future__ import annotations

from typing import Literal

from PySide6.QtCore import QPointF
from PySide6.QtGui import QMouseEvent

from app.features.timeline.drags.host import LanesHost
from app.features.timeline.drags.lane import LaneDrag
from metagraph.graph.timeline import SHORTEST_RANGE

Grip = Literal["new", "in", "out", "whole"]


class RangeDrag(LaneDrag):
    """grip: what of the range is held. range: as it will be, seconds."""

    def __init__(self, host: LanesHost, grip: Grip) -> None:
        super().__init__(host)
        self.grip = grip
        self.range = host.performance.timeline.range
        self._was = self.range

    def update(self, at: QPointF, free: bool = False) -> None:
        if not self.caught(at):
            return
        scale, magnet = self.host.scale(), self.host.magnet
        if self.grip == "new" or self._was is None:
            start = scale.seconds(self.origin.x())
            end = magnet.snap(max(0.0, scale.seconds(at.x())), scale.each)
            self.range = (min(start, end), max(start, end))
            return
        start, end = self._was
        by = (at.x() - self.origin.x()) / scale.each
        if self.grip == "in":
            self.range = (min(magnet.snap(max(0.0, start + by), scale.each), end - SHORTEST_RANGE), end)
        elif self.grip == "out":
            self.range = (start, max(magnet.snap(end + by, scale.each), start + SHORTEST_RANGE))
        else:
            first = magnet.snap(max(0.0, start + by), scale.each)
            self.range = (first, first + end - start)

    def finish(self, at: QPointF) -> None:
        timeline = self.host.performance.timeline
        if self.begun and self.range is not None and self.range != self._was:
            timeline.set_range(*self.range)

    def click(self, event: QMouseEvent) -> None:
        if self.grip == "new":
            self.host.scrub(event.position().x())
