"""Paths through a motion graph that go with speech: the paper's stochastic greedy search.

It keeps the cheapest few hundred of what it came upon, and may come to an end if nothing fits.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.suggest.tracks import RATE
from metagraph.synthesis.constraints import HeardStates, WantedSegment
from metagraph.synthesis.graph import MotionGraph
from metagraph.synthesis.search.frame_costs import FrameCosts
from metagraph.synthesis.search.lookups import (
    find_cheapest_links,
    find_fitting_states,
    look_up_speech,
    make_charges,
)
from metagraph.synthesis.search.path import Cancelled, Path, check_cancelled, describe_stuck, find_way_jumps
from metagraph.synthesis.states import SynthesisError

Array = NDArray[Any]

SAVED = 200  # n_save: candidates that are kept
STARTS = 3  # so many times SAVED are the states it begins with
BRANCHES = 1  # transitions of a run that are gone deeper into
DEEPER = (
    (3, 0),
    (6, 1),
    (6, 2),
)  # transitions one after another in a stretch, branches more: when a search comes to an end
TRIES = 16  # and at most so many by chance
LONGEST = 60  # frames of a stretch that is searched at once
LOOK = 90  # frames beyond a stretch: who goes on that long by itself is not held to be expensive
AHEAD = 0.05  # of the threshold: what a second less of that counts as
APART = 3  # frames: ends of kept candidates


@dataclass(frozen=True)
class Width:
    """How widely is searched. saved: candidates that are kept of a stretch. branches: transitions of a run
    that are gone deeper into. deepest: transitions one after another in a stretch, in the first try.
    """

    saved: int = SAVED
    branches: int = BRANCHES
    deepest: int = DEEPER[0][0]

    def deeper(self) -> Iterator[Width]:
        """Yield the widths of one try after another."""
        for deepest, more in DEEPER:
            yield replace(self, branches=self.branches + more, deepest=deepest)


USUAL = Width()


def search_greedily(
    graph: MotionGraph,
    heard: HeardStates,
    wanted: WantedSegment,
    seed: int = 1,
    width: Width = USUAL,
    cancelled: Cancelled = None,
    run: int = 1,
    charged: FrameCosts | None = None,
) -> Path:
    """Return a path that has what is wanted, found as the paper's search finds it, a stretch of speech after
    the other.

    From random states on, depth first: a run goes along with its take, and branches off by transitions, some
    by chance and some the cheapest; those that lead on cheapest are gone deeper into. Of what comes through a
    stretch only cheap ones are kept. Beyond the paper: a run that goes on longer with what is said next
    counts as a little cheaper, no two kept ones end within a few frames of each other while there are others,
    what is dearer than more than enough others is not followed, and a search that comes to an end is tried
    again, deeper. run: frames between two transitions, at least; charged: what frames cost beside
    transitions, which counts as those do. Raises SynthesisError when it comes to an end before the speech
    does, though there may be a path, or when it was cancelled.
    """
    *first, last = width.deeper()
    for wide in first:
        with suppress(SynthesisError):
            return search_greedily_once(graph, heard, wanted, seed, wide, cancelled, run, charged)
        check_cancelled(cancelled)
    return search_greedily_once(graph, heard, wanted, seed, last, cancelled, run, charged)


def search_greedily_once(
    graph: MotionGraph,
    heard: HeardStates,
    wanted: WantedSegment,
    seed: int = 1,
    width: Width = USUAL,
    cancelled: Cancelled = None,
    run: int = 1,
    charged: FrameCosts | None = None,
) -> Path:
    """Return what `search_greedily` does, in one try of this width. Raises SynthesisError when it comes to an
    end before the speech does.
    """
    from metagraph.synthesis.search.greedy_search_kernels import search_segment

    frames, chance = len(wanted), np.random.default_rng(seed)
    fits = np.flatnonzero(find_fitting_states(graph, heard, wanted, 0))
    if not len(fits):
        raise SynthesisError(describe_stuck(0))
    own = np.sort(chance.choice(fits, min(STARTS * width.saved, len(fits)), replace=False)).astype(np.int32)
    at, cost, met = np.zeros(len(own), np.int32), np.zeros(len(own), np.float32), np.zeros(len(own), bool)
    links, speech, charges = (
        find_cheapest_links(graph),
        look_up_speech(graph, heard, wanted),
        make_charges(charged, frames),
    )
    best_at = np.full(2 * len(graph.states), -1, np.int32)
    ahead = AHEAD * graph.threshold.limit / RATE
    random = np.uint64(chance.integers(1 << 62))
    ids, count = np.arange(len(own)), len(own)  # of runs among all that were ever made
    tree = [(np.full(count, -1), at, own)]
    t0 = 0
    for t1 in _stretches(wanted):
        check_cancelled(cancelled)
        off, ats, owns, _, found, paid, random = search_segment(
            t0,
            t1,
            at,
            own,
            cost,
            met,
            links,
            speech,
            charges,
            best_at,
            width.saved,
            width.branches,
            TRIES,
            width.deepest,
            run,
            np.uint64(random),
        )
        if not len(found):
            raise SynthesisError(describe_stuck(t0))
        keep = _kept(paid + ahead * np.maximum(0, t1 + LOOK - found[:, 3]), found[:, 4], width.saved, chance)
        which, since, state, _, key = found[keep].T
        names = np.concatenate([ids, count + np.arange(len(off) - len(ids))])
        tree.append((names[off[len(ids) :]], ats[len(ids) :], owns[len(ids) :]))
        count += len(off) - len(ids)
        new = since >= 0
        tree.append((names[which[new]], since[new], state[new]))
        ids = names[which]
        ids[new] = count + np.arange(int(new.sum()))
        count += int(new.sum())
        at, own = (
            np.where(new, since, ats[which]).astype(np.int32),
            np.where(new, state, owns[which]).astype(np.int32),
        )
        cost, met, t0 = paid[keep], key % 2 == 1, t1
    off, since, state = (np.concatenate(parts) for parts in zip(*tree, strict=True))
    place = int(cost.argmin())
    way, at_run, end = np.empty(frames, np.int64), int(ids[place]), frames
    while at_run >= 0:
        first = int(since[at_run])
        way[first:end] = state[at_run] + np.arange(end - first)
        at_run, end = int(off[at_run]), first
    return Path(way, float(cost[place]), find_way_jumps(way))


def _kept(score: Array, keys: Array, saved: int, chance: np.random.Generator) -> Array:
    """Return which candidates are kept: the best, and of those that end within a few frames of each other one
    before the others.
    """
    order = np.lexsort((chance.random(len(score)), score))
    if len(order) > saved:
        alone = np.zeros(len(order), bool)
        alone[np.unique(keys[order] // (2 * APART), return_index=True)[1]] = True
        order = np.concatenate([order[alone], order[~alone]])
    return order[:saved]


def _stretches(wanted: WantedSegment) -> list[int]:
    """Return the frames after the stretches that are searched one by one: up to where a boundary's tolerance
    has passed, of at most LONGEST frames.
    """
    narrow = np.flatnonzero(wanted.allowed[:-1] & ~wanted.allowed[1:]) + 1
    out, begin = [], 0
    for end in [*narrow.tolist(), len(wanted)]:
        parts = -(-(end - begin) // LONGEST)
        out += [begin + round((end - begin) * (n + 1) / parts) for n in range(parts)]
        begin = end
    return out
