"""What a new motion has to go with: segments of speech, and the states of a motion graph that went with such
(Yang et al., section 7.2).
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph.conversation.model import SOUNDS, Segment, Sound
from metagraph.suggest.tracks import RATE
from metagraph.synthesis.states import States, SynthesisError

Array = NDArray[Any]

TOLERANCE = 0.1  # seconds, in the paper
ALL = (1 << len(SOUNDS)) - 1


STRESS, EDGE = 1, 2  # what happens at a state: bits


@dataclass(frozen=True, eq=False)
class HeardStates:
    """What was heard at the states of a graph. kinds `[F]` uint8: bits of SOUNDS. peaks `[F]`: whether a
    clause's stress is there. edges `[F]`: whether a segment begins there, or the silence after one; None if
    nothing is known of that.
    """

    kinds: Array
    peaks: Array
    edges: Array | None = None

    def happens(self, what: int) -> Array:
        """Return `[F]` whether any of these events (STRESS, EDGE) is at a state."""
        out = self.peaks & bool(what & STRESS)
        return out | self.edges if what & EDGE and self.edges is not None else out


@dataclass(frozen=True, eq=False)
class WantedSegment:
    """What is to be heard, frame by frame. allowed `[T]` uint8: bits of the SOUNDS a state may have gone
    with. window `[T]` int32: number of the event that has to lie in this frame's window, -1 outside of all.
    events `[T]` uint8: which kind of event that is, STRESS or EDGE. barred `[T]` uint8: bits of the events
    that must not lie there. only: frames -> the states `[F]` bool that alone may come then, beside all that;
    nothing if that is of no account. places: the frames at which events are wanted, each with its kind, in
    the order of the windows' numbers.
    """

    allowed: Array
    window: Array
    events: Array | None = None
    barred: Array | None = None
    only: Mapping[int, Array] = field(default_factory=dict)
    places: Mapping[int, int] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.allowed)

    def event(self, t: int) -> int:
        """Return the kind of event the window of a frame is for."""
        return STRESS if self.events is None else int(self.events[t])

    def bars(self, t: int) -> int:
        """Return bits of the events that must not lie in a frame."""
        return 0 if self.barred is None else int(self.barred[t])


def find_heard_at(states: States, takes: Sequence[Sequence[Segment]]) -> HeardStates:
    """Return what was heard at states, from each take's segments; where segments of a take overlap the later
    one counts, and if there is none it was idle. Raises SynthesisError when there are not as many takes, or a
    segment ends before it starts.
    """
    if len(takes) != len(states.starts) - 1:
        raise SynthesisError(f"{len(states.starts) - 1} takes have states, but {len(takes)} have speech")
    kinds = np.ones(len(states), np.uint8)
    peaks, edges = np.zeros(len(states), bool), np.zeros(len(states), bool)
    for number, segments in enumerate(takes):
        first, after = int(states.starts[number]), int(states.starts[number + 1])
        for s in _checked(segments):
            a, b = first + round(s.start * RATE), first + round(s.end * RATE)
            kinds[max(first, a) : min(after, b)] = 1 << SOUNDS.index(s.kind)
            edges[[x for x in (a, b) if first < x < after]] = True
            if s.peak is not None and first <= (p := first + round(s.peak * RATE)) < after:
                peaks[p] = True
    return HeardStates(kinds, peaks, edges)


def find_change_states(states: States, takes: Sequence[Sequence[Segment]]) -> list[int]:
    """Return the states at which what is heard changes: key states, whatever moves there."""
    out: set[int] = set()
    for number, segments in enumerate(takes):
        first, after = int(states.starts[number]), int(states.starts[number + 1])
        for s in segments:
            places = (first + round(x * RATE) for x in (s.start, s.end, s.peak) if x is not None)
            out.update(p for p in places if first <= p < after)
    return sorted(out)


def list_wanted(
    segments: Sequence[Segment],
    seconds: float,
    tolerance: float = TOLERANCE,
    use: Collection[Sound] = SOUNDS,
    peaks: bool = True,
    edges: bool = True,
) -> WantedSegment:
    """Return what is to be heard in so many seconds. tolerance: how far starts, ends and stresses may be from
    where they should be. use: the kinds that constrain; during others anything goes. peaks: whether clauses'
    stresses have to be met, and no others. edges: whether segments have to begin and end with what began and
    ended there, and nowhere else (the paper, section 7.2); without, only the kind of what is heard counts,
    and two clauses pass as one.

    Each frame waits for one event: where windows overlap, each ends half way to the next.
    """
    frames = max(1, round(seconds * RATE))
    slack = round(tolerance * RATE)
    kinds = np.ones(frames, np.uint8) if "idle" in use else np.full(frames, ALL, np.uint8)
    bounds: list[int] = []
    stresses: list[int] = []
    anywhere = np.zeros(frames, bool)  # if nobody knows a clause's stress
    for s in _checked(segments):
        a, b = max(0, round(s.start * RATE)), min(frames, round(s.end * RATE))
        kinds[a:b] = 1 << SOUNDS.index(s.kind) if s.kind in use else ALL
        if s.kind not in use:
            continue
        bounds += [x for x in (round(s.start * RATE), round(s.end * RATE)) if edges and 0 < x < frames]
        if s.kind == "clause" and s.peak is None:
            anywhere[a:b] = True
        elif s.kind == "clause" and peaks and s.peak is not None:
            stresses.append(round(s.peak * RATE))
    allowed = kinds.copy()
    for edge in np.flatnonzero(np.diff(kinds)) + 1:  # at a boundary either side's will do
        allowed[max(0, edge - slack) : edge + slack] |= kinds[edge - 1] | kinds[edge]
    barred = np.zeros(frames, np.uint8)
    if edges:
        some = allowed != ALL  # what nothing constrains may hold anything
        barred[some & ~_near(bounds, frames, slack)] |= EDGE
        if peaks:
            barred[some & ~anywhere & ~_near(stresses, frames, slack)] |= STRESS
    places = dict(sorted((dict.fromkeys(bounds, EDGE) | dict.fromkeys(stresses, STRESS)).items()))
    window, kind = _windows(places, frames, slack)
    return WantedSegment(allowed, window, kind, barred, places=places)


def _near(places: Sequence[int], frames: int, slack: int) -> Array:
    """Return `[T]` which frames are within so many of any of these."""
    out = np.zeros(frames, bool)
    for place in places:
        out[max(0, place - slack) : max(0, place + slack + 1)] = True
    return out


def _windows(events: dict[int, int], frames: int, slack: int) -> tuple[Array, Array]:
    """Return `window` and `events` of WantedSegment. events: kinds by the frames they are wanted at, in
    order.
    """
    window, kind = np.full(frames, -1, np.int32), np.full(frames, STRESS, np.uint8)
    places = list(events)
    for number, place in enumerate(places):
        first, after = place - slack, place + slack + 1
        if number:
            first = max(first, (places[number - 1] + place) // 2 + 1)
        if number + 1 < len(places):
            after = min(after, (place + places[number + 1]) // 2 + 1)
        first, after = max(0, first), max(0, min(frames, after))
        window[first:after] = number
        kind[first:after] = events[place]
    return window, kind


def _checked(segments: Sequence[Segment]) -> list[Segment]:
    for s in segments:
        if not s.end > s.start:
            raise SynthesisError(
                f"a {s.kind} from {s.start:g} s ends at {s.end:g} s: a segment has to end after it starts"
            )
        if s.kind not in SOUNDS:
            raise SynthesisError(f"'{s.kind}' is no kind of segment; there are {', '.join(SOUNDS)}")
    return sorted(segments, key=lambda s: s.start)
