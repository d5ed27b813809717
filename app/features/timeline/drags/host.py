"""What drags on the timeline need of it."""

from __future__ import annotations

from typing import Protocol

from app.features.timeline.snapping import Magnet
from app.stage.performance import StagePerformance
from app.stage.session import StageSession
from app.widgets.lane_geometry import LaneScale, Sizes


class LanesHost(Protocol):
    """The timeline as its drags see it. each: pixels a second."""

    session: StageSession
    performance: StagePerformance
    magnet: Magnet
    sizes: Sizes
    each: float

    def scale(self) -> LaneScale: ...
    def scrub(self, x: float) -> None: ...
    def height(self) -> int: ...
    def set_sizes(self, sizes: Sizes) -> None: ...
