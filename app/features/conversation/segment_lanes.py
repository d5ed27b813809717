"""Where things stand on the lanes of a conversation: for each who talks a waveform with its pitch, the
words, and the segments.

Functions of values. Seconds and pixels are the timeline's.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from PySide6.QtCore import QRectF

from app.translation import make_lazy_texts, tr
from app.widgets.lane_geometry import LEFT, RULER, LaneScale
from metagraph.graph.conversation.model import Segment, Word

# what the window calls the kinds of segments
KINDS = make_lazy_texts(
    lambda: {"clause": tr("clause"), "response": tr("response"), "hesitation": tr("hesitation")}
)
PLURALS = make_lazy_texts(
    lambda: {"clause": tr("clauses"), "response": tr("responses"), "hesitation": tr("hesitations")}
)
GAP = 8.0  # pixels between two
WORDS, SEGMENTS, TALLEST = 17.0, 26.0, 190.0  # pixels of the words, of the segments, of a side at most
LEGIBLE = 18.0  # pixels segments need for their words
LOW, LOWER = 78.0, 58.0  # pixels of a side at least: of two, and of more
HERTZ = (60.0, 500.0)  # from the bottom to the top of a waveform; an octave is as high everywhere
AXIS = (100.0, 200.0, 400.0)
NEAREST = 400.0  # pixels a second at most


@dataclass(frozen=True)
class SegmentLane:
    """Where a side is. The title stands left of it."""

    wave: QRectF
    words: QRectF
    segments: QRectF

    @property
    def whole(self) -> QRectF:
        return self.wave.united(self.segments)


def measure_least_lane_height(sides: int) -> int:
    """Return how many pixels the lanes of so many need."""
    return round(sides * _low(sides) + (sides - 1) * GAP + 4 + RULER)


def _low(sides: int) -> float:
    return LOW if sides == 2 else LOWER


def place_segment_lanes(width: float, height: float, sides: int = 2) -> tuple[SegmentLane, ...]:
    """Return the lanes of all who talk, one under the other."""
    each = min(TALLEST, max(_low(sides), (height - RULER - (sides - 1) * GAP - 4) / sides))
    segments = min(SEGMENTS, max(LEGIBLE, each * 0.28))
    out = []
    for side in range(sides):
        top, wide = RULER + side * (each + GAP), max(1.0, width - LEFT)
        tall = each - WORDS - segments
        out.append(
            SegmentLane(
                QRectF(LEFT, top, wide, tall),
                QRectF(LEFT, top + tall, wide, WORDS),
                QRectF(LEFT, top + tall + WORDS, wide, segments - 2),
            )
        )
    return tuple(out)


def find_least_scale(width: float, length: float) -> float:
    """Return the fewest pixels a second: at which all of it is in sight."""
    return min(2.0, max(40.0, width - LEFT - 8) / max(length, 1e-3))


def measure_pitch_y(hertz: Any, wave: QRectF) -> Any:
    """Return how high a pitch stands in its waveform's lane; hertz: a number or an array."""
    low, high = np.log2(HERTZ[0]), np.log2(HERTZ[1])
    part = (np.log2(np.clip(hertz, *HERTZ)) - low) / (high - low)
    return wave.bottom() - 4 - part * (wave.height() - 8)


def find_visible_segments(segments: Sequence[Segment], begin: float, end: float) -> range:
    """Return the places of the segments that are in sight, one that only touches it, too."""
    first = bisect_left(segments, begin, key=lambda s: s.end)
    return range(first, max(first, bisect_right(segments, end, key=lambda s: s.start)))


def find_words_between(words: Sequence[Word], begin: float, end: float) -> Sequence[Word]:
    """Return the words that start in a stretch, and the one before."""
    first = bisect_left(words, begin, key=lambda w: w.start)
    return words[max(0, first - 1) : bisect_right(words, end, key=lambda w: w.start)]


def measure_segment_rect(segment: Segment, scale: LaneScale, lane: SegmentLane) -> QRectF:
    left = scale.x(segment.start)
    return QRectF(left, lane.segments.top(), max(1.5, scale.x(segment.end) - left), lane.segments.height())


def describe_segment(segment: Segment) -> str:
    """Return a segment in words: what is said, what it is, from when to when, and its stress."""
    what = {
        "clause": tr("Clause"),
        "response": tr("Listener response"),
        "hesitation": tr("Hesitation pause"),
    }[segment.kind]
    lines = [f"“{segment.text}”"] if segment.text else []
    lines.append(tr("{what}, {start:.2f} to {end:.2f} s", what=what, start=segment.start, end=segment.end))
    if segment.kind == "clause":
        lines.append(
            tr("Stress at {peak:.2f} s", peak=segment.peak)
            if segment.peak is not None
            else tr("No stress. Drag in the waveform above to set one.")
        )
    return "\n".join(lines)
