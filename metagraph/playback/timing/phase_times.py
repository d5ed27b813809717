"""When a gesture prepares, strikes, holds and retracts (Kendon; BML's ready, stroke-end and relax)."""

from __future__ import annotations

from dataclasses import dataclass

LEAST_BLEND = 0.25  # seconds in which a gesture that skips its preparation comes in


@dataclass(frozen=True, slots=True)
class Phases:
    """Clip seconds, ascending: start, ready (preparation ends), stroke (its peak), stroke_end (the hold
    begins), relax (the hold ends), end.
    """

    start: float
    ready: float
    stroke: float
    stroke_end: float
    relax: float
    end: float

    def skip(self, blend_in: float) -> float:
        """Return where a gesture begins if it skips its preparation: as late as it can blend in
        and be ready.
        """
        return max(self.start, self.ready - max(blend_in, LEAST_BLEND))
