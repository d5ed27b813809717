"""What a new motion has to go with: segments of speech, and the states of a motion graph that went with such
(Yang et al., section 7.2).
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph.conversation import SOUNDS, Segment, Sound
from metagraph.suggest.tracks import RATE
from metagraph.synthesis.states import States, SynthesisError

Array = NDArray[Any]

TOLERANCE = 0.1  # seconds, in the paper
ALL = (1 << len(SOUNDS)) - 1


@dataclass(frozen=True, eq=False)
class HeardStates:
    """What was heard at the states of a graph. kinds `[F]` uint8: bits of SOUNDS. peaks `[F]`: whether a
    clause's stress is there.
    """

    kinds: Array
    peaks: Array


@dataclass(frozen=True, eq=False)
class WantedSegment:
    """What is to be heard, frame by frame. allowed `[T]` uint8: bits of the SOUNDS a state may have gone
    with. window `[T]` int32: number of the stress that has to lie in this frame's window, -1 outside of all.
    """

    allowed: Array
    window: Array

    def __len__(self) -> int:
        return len(self.allowed)


def heard(states: States, takes: Sequence[Sequence[Segment]]) -> HeardStates:
    """Return what was heard at states, from each take's segments; where segments of a take overlap the later
    one counts, and where there is none it was idle. Raises SynthesisError when there are not as many takes,
    or a segment ends before it starts.
    """
    if len(takes) != len(states.starts) - 1:
        raise SynthesisError(f"{len(states.starts) - 1} takes have states, but {len(takes)} have speech")
    kinds = np.ones(len(states), np.uint8)
    peaks = np.zeros(len(states), bool)
    for number, segments in enumerate(takes):
        first, after = int(states.starts[number]), int(states.starts[number + 1])
        for s in _checked(segments):
            a, b = first + round(s.start * RATE), first + round(s.end * RATE)
            kinds[max(first, a) : min(after, b)] = 1 << SOUNDS.index(s.kind)
            if s.peak is not None and first <= (p := first + round(s.peak * RATE)) < after:
                peaks[p] = True
    return HeardStates(kinds, peaks)


def changes(states: States, takes: Sequence[Sequence[Segment]]) -> list[int]:
    """Return the states at which what is heard changes: key states, whatever moves there."""
    out: set[int] = set()
    for number, segments in enumerate(takes):
        first, after = int(states.starts[number]), int(states.starts[number + 1])
        for s in segments:
            places = (first + round(x * RATE) for x in (s.start, s.end, s.peak) if x is not None)
            out.update(p for p in places if first <= p < after)
    return sorted(out)


def wanted(
    segments: Sequence[Segment],
    seconds: float,
    tolerance: float = TOLERANCE,
    use: Collection[Sound] = SOUNDS,
    peaks: bool = True,
) -> WantedSegment:
    """Return what is to be heard in so many seconds. tolerance: how far starts, ends and stresses may be from
    where they should be. use: the kinds that constrain; during others anything goes. peaks: whether clauses'
    stresses have to be met.
    """
    frames = max(1, round(seconds * RATE))
    slack = round(tolerance * RATE)
    kinds = np.ones(frames, np.uint8) if "idle" in use else np.full(frames, ALL, np.uint8)
    window = np.full(frames, -1, np.int32)
    for number, s in enumerate(_checked(segments)):
        a, b = max(0, round(s.start * RATE)), min(frames, round(s.end * RATE))
        kinds[a:b] = 1 << SOUNDS.index(s.kind) if s.kind in use else ALL
        if peaks and s.kind == "clause" and s.peak is not None and s.kind in use:
            p = round(s.peak * RATE)
            window[max(0, p - slack) : max(0, min(frames, p + slack + 1))] = number
    allowed = kinds.copy()
    for edge in np.flatnonzero(np.diff(kinds)) + 1:  # at a boundary either side's will do
        allowed[max(0, edge - slack) : edge + slack] |= kinds[edge - 1] | kinds[edge]
    return WantedSegment(allowed, window)


def _checked(segments: Sequence[Segment]) -> list[Segment]:
    for s in segments:
        if not s.end > s.start:
            raise SynthesisError(
                f"a {s.kind} from {s.start:g} s ends at {s.end:g} s: a segment has to end after it starts"
            )
        if s.kind not in SOUNDS:
            raise SynthesisError(f"'{s.kind}' is no kind of segment; there are {', '.join(SOUNDS)}")
    return sorted(segments, key=lambda s: s.start)
