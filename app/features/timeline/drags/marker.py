"""The drag of a marker."""

from __future__ import annotations

from PySide6.QtCore import QPointF

from app.features.timeline.drags.host import LanesHost
from app.features.timeline.drags.lane import LaneDrag
from metagraph.graph.timeline import Marker


class MarkerDrag(LaneDrag):
    """at: where the marker will be, seconds."""

    def __init__(self, host: LanesHost, marker: Marker) -> None:
        super().__init__(host)
        self.marker, self.at = marker, marker.at

    def update(self, at: QPointF, free: bool = False) -> None:
        if self.caught(at):
            scale = self.host.scale()
            by = (at.x() - self.origin.x()) / scale.each
            self.at = self.host.magnet.snap(max(0.0, self.marker.at + by), scale.each)

    def finish(self, at: QPointF) -> None:
        if self.begun and self.at != self.marker.at:
            self.host.performance.timeline.move_marker(self.marker.id, self.at)
