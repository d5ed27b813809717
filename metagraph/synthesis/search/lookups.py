"""What the searches look up: which states fit what is wanted at a frame, and, for the greedy one, its
transitions, speech and what frames cost, as compiled loops have them.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from metagraph.synthesis.constraints import EDGE, STRESS, HeardStates, WantedSegment
from metagraph.synthesis.graph import MotionGraph
from metagraph.synthesis.search.frame_costs import FrameCosts

if TYPE_CHECKING:
    from metagraph.synthesis.search.greedy_search_kernels import Charges, Links, WantedSpeech

Array = NDArray[Any]

CHEAPEST = 32  # transitions of a state that are always tried
EVENTS = (STRESS, EDGE)  # in the order of rows that are looked up

_LINKS: WeakKeyDictionary[MotionGraph, Links] = WeakKeyDictionary()


def find_cheapest_links(graph: MotionGraph) -> Links:
    """Return a graph's transitions, and the cheapest of each state; those are looked for once."""
    from metagraph.synthesis.search.greedy_search_kernels import Links, find_cheapest

    found = _LINKS.get(graph)
    if found is None:
        found = Links(
            graph.starts, graph.targets, graph.costs, *find_cheapest(graph.starts, graph.costs, CHEAPEST)
        )
        _LINKS[graph] = found
    return found


def look_up_speech(graph: MotionGraph, heard: HeardStates, wanted: WantedSegment) -> WantedSpeech:
    """Return what is wanted as the greedy search looks it up."""
    from metagraph.synthesis.search.greedy_search_kernels import (
        WantedSpeech,
        find_next_marked,
        find_next_until,
    )

    events = np.array([EVENTS.index(wanted.event(t)) for t in range(len(wanted))], np.int32)
    barred = np.array([wanted.bars(t) for t in range(len(wanted))], np.uint8)
    only = np.zeros(len(wanted), np.int64)  # frames that only some states may come at are each by itself
    only[[t for t in wanted.only if t < len(wanted)]] = [1 + t for t in wanted.only if t < len(wanted)]
    new = np.ones(len(wanted), bool)
    new[1:] = (np.diff(wanted.allowed) != 0) | (np.diff(wanted.window) != 0) | (np.diff(barred) != 0)
    new[1:] |= np.diff(only) != 0
    begins = np.flatnonzero(new)
    ends = np.append(begins[1:], len(wanted))
    alike = np.stack([wanted.allowed[begins], barred[begins], only[begins]], 1)
    _, firsts, rows = np.unique(alike, axis=0, return_index=True, return_inverse=True)
    last = graph.states.last
    until = np.stack(
        [find_next_until(find_fitting_states(graph, heard, wanted, int(t)), last) for t in begins[firsts]]
    )
    stresses, closes = wanted.window >= 0, np.array([is_due_at(wanted, t) for t in range(len(wanted))])
    stretch = (np.cumsum(new) - 1).astype(np.int32)
    return WantedSpeech(
        stretch,
        ends,
        rows.reshape(-1),
        until,
        stresses[begins],
        closes[ends - 1],
        stresses,
        closes,
        events[begins],
        np.stack([find_next_marked(heard.happens(what)) for what in EVENTS]),
        find_next_marked(last) + 1,
    )


def make_charges(charged: FrameCosts | None, frames: int) -> Charges:
    """Return what frames cost as the greedy search looks it up."""
    from metagraph.synthesis.search.greedy_search_kernels import Charges

    if charged is None:
        return Charges(np.full(frames, -1, np.int32), np.full(frames, frames), np.zeros((0, 1)))
    at, rows = charged.sums
    new = np.flatnonzero(np.diff(at)) + 1
    ends = np.repeat([*new.tolist(), frames], np.diff([0, *new.tolist(), frames]))
    return Charges(at, ends, np.pad(np.cumsum(rows, axis=1, dtype=np.float64), ((0, 0), (1, 0))))


def find_fitting_states(graph: MotionGraph, heard: HeardStates, wanted: WantedSegment, t: int) -> Array:
    """Return `[F]` which states may come at a frame, whatever events are waited for."""
    fits = graph.kept & ((heard.kinds & wanted.allowed[t]) != 0)
    if barred := wanted.bars(t):
        fits &= ~heard.happens(barred)
    if t in wanted.only:
        fits &= wanted.only[t]
    return np.asarray(fits)


def find_meeting_states(happening: Sequence[Array], wanted: WantedSegment, t: int) -> Array:
    """Return `[F]` which states are the event that the window of a frame waits for."""
    if wanted.window[t] < 0:
        return np.zeros(len(happening[0]), bool)
    return happening[EVENTS.index(wanted.event(t))]


def is_due_at(wanted: WantedSegment, t: int) -> bool:
    """Return whether an event has to have been met by now."""
    return bool(wanted.window[t] >= 0 and (t + 1 == len(wanted) or wanted.window[t + 1] != wanted.window[t]))
