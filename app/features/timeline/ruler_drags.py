"""Drags on the strip under the ruler's numbers: a marker, the range, either of its ends, or a new range."""

from __future__ import annotations

from typing import Literal, Protocol

from PySide6.QtCore import QPointF

from app.features.timeline.snapping import Magnet
from app.stage.performance import Performance
from app.widgets.gesture import PressDrag
from app.widgets.lane_geometry import Scale
from metagraph.graph.timeline import SHORTEST_RANGE, Marker

Grip = Literal["new", "in", "out", "whole"]


class RulerHost(Protocol):
    """The timeline as drags on its ruler see it."""

    performance: Performance
    magnet: Magnet

    def scale(self) -> Scale: ...

    def scrub(self, x: float) -> None: ...


class RangeDrag(PressDrag):
    """grip: what of the range is held. range: as it will be, seconds."""

    catch = 3.0

    def __init__(self, host: RulerHost, grip: Grip) -> None:
        super().__init__()
        self.host, self.grip = host, grip
        self.range = host.performance.timeline.range
        self._was = self.range

    def update(self, at: QPointF, free: bool = False) -> None:
        if not self.caught(QPointF(at.x(), self.origin.y())):
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
        elif not self.begun and self.grip == "new":
            self.host.scrub(at.x())


class MarkerDrag(PressDrag):
    """at: where the marker will be, seconds."""

    catch = 3.0

    def __init__(self, host: RulerHost, marker: Marker) -> None:
        super().__init__()
        self.host, self.marker, self.at = host, marker, marker.at

    def update(self, at: QPointF, free: bool = False) -> None:
        if self.caught(QPointF(at.x(), self.origin.y())):
            scale = self.host.scale()
            by = (at.x() - self.origin.x()) / scale.each
            self.at = self.host.magnet.snap(max(0.0, self.marker.at + by), scale.each)

    def finish(self, at: QPointF) -> None:
        if self.begun and self.at != self.marker.at:
            self.host.performance.timeline.move_marker(self.marker.id, self.at)
