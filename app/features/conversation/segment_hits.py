"""What is under the pointer on a conversation's lanes, and what a dragged time snaps to. Functions of
values.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from PySide6.QtCore import QPointF

from app.features.conversation.segment_lanes import find_visible_segments, place_segment_lanes
from app.widgets.lane_geometry import LEFT, LaneScale
from metagraph.graph.conversation.model import Conversation, Word

Part = Literal["nothing", "title", "ruler", "wave", "start", "end", "body", "gap", "peak"]
EDGE, DOT = 5.0, 7.0  # pixels either side of an edge, and round a dot, that take hold of it
NARROW = (
    14.0  # pixels up to which a segment's edges are taken hold of from outside only, so that its body can be
)
ARROW = 22.0  # pixels of the arrow behind a name
SNAP = 6.0  # pixels within which a dragged time is caught


@dataclass(frozen=True)
class SegmentHit:
    """part: of what; side: whose, from 0; at: the place of the segment among its side's."""

    part: Part
    side: int = 0
    at: int = -1


NOTHING = SegmentHit("nothing")


def is_on_arrow(
    point: QPointF, size: tuple[float, float], conversation: Conversation | None, side: int
) -> bool:
    """Return whether a point of a side's title is on the arrow behind its name, which opens its menu."""
    if conversation is None:
        return False
    lane = place_segment_lanes(*size, len(conversation.sides))[side]
    return point.x() >= LEFT - ARROW and point.y() <= lane.wave.top() + ARROW


def find_segment_hit(
    conversation: Conversation, scale: LaneScale, size: tuple[float, float], point: QPointF
) -> SegmentHit:
    """Return what is under a point. size: width and height of all lanes, pixels."""
    for side, lane in enumerate(place_segment_lanes(*size, len(conversation.sides))):
        if not lane.whole.top() <= point.y() <= lane.whole.bottom() + 2:
            continue
        if point.x() < LEFT:
            return SegmentHit("title", side)
        if point.y() < lane.segments.top():
            found = _peak(conversation, side, scale, point.x())
            return SegmentHit("peak", side, found) if found is not None else SegmentHit("wave", side)
        return _segment(conversation, side, scale, point.x())
    return NOTHING if point.x() < LEFT else SegmentHit("ruler")


def _peak(conversation: Conversation, side: int, scale: LaneScale, x: float) -> int | None:
    """Return the clause whose stress is nearest, if one is near enough."""
    segments = conversation.sides[side].segments
    reach = DOT / scale.each
    near = find_visible_segments(segments, scale.seconds(x) - reach, scale.seconds(x) + reach)
    found = [
        (abs(scale.x(p) - x), n)
        for n in near
        if segments[n].kind == "clause" and (p := segments[n].peak) is not None
    ]
    return min(found)[1] if found and min(found)[0] <= DOT else None


def _segment(conversation: Conversation, side: int, scale: LaneScale, x: float) -> SegmentHit:
    segments, seconds, reach = conversation.sides[side].segments, scale.seconds(x), EDGE / scale.each
    edges: list[tuple[float, bool, SegmentHit]] = []  # how far off, whether it is held from outside, and what
    for n in find_visible_segments(segments, seconds - reach, seconds + reach):
        left, right = scale.x(segments[n].start), scale.x(segments[n].end)
        inner = EDGE if right - left > NARROW else 0.0
        if left <= x <= right and (inner == 0.0 or left + inner < x < right - inner):
            return SegmentHit("body", side, n)
        ends: dict[Part, float] = {"start": x - left, "end": right - x}
        for part, inside in ends.items():
            if -EDGE <= inside <= inner:
                edges.append((round(abs(inside), 3), inside < 0, SegmentHit(part, side, n)))
    return min(edges, key=lambda e: e[:2])[2] if edges else SegmentHit("gap", side)


# --- snapping


def find_word_edges(words: Sequence[Word], around: float, within: float = 30.0) -> list[float]:
    """Return where words begin and end, some seconds either side of a time."""
    first = bisect_left(words, around - within, key=lambda w: w.start)
    last = bisect_left(words, around + within, key=lambda w: w.start)
    return [t for w in words[first:last] for t in (w.start, w.end)]


def find_pitch_maxima(times: Any, hertz: Any) -> Any:
    """Return when F0 `[K]` is higher than at the voiced moments beside it; of an even top, its middle."""
    with np.errstate(invalid="ignore"):
        filled = np.where(np.isnan(hertz), -np.inf, hertz)
        padded = np.concatenate([[-np.inf], filled, [-np.inf]])
        rises = np.flatnonzero(padded[1:] != padded[:-1])  # where an even stretch of `padded` ends
    tops = [
        (a, b)
        for a, b in zip(rises[:-1] + 1, rises[1:], strict=True)
        if padded[a] > padded[a - 1] and padded[b] > padded[b + 1]
    ]
    return np.array([(times[a - 1] + times[b - 1]) / 2 for a, b in tops])


def snap_time(seconds: float, marks: Iterable[float], scale: LaneScale, on: bool = True) -> float:
    """Return the nearest of some times if it is near on the screen, else the time itself. on: snapping is
    wanted.
    """
    if on:
        near = min(marks, key=lambda m: abs(m - seconds), default=None)
        if near is not None and abs(near - seconds) * scale.each <= SNAP:
            return float(near)
    return seconds
