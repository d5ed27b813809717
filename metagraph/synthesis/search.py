"""Paths through a motion graph that go with speech: the paper's stochastic greedy search, and the best path
there is.

The greedy search keeps the cheapest few hundred of what it came upon, and may come to an end where nothing
fits. The exact one is dynamic programming over all states: it finds a path whenever there is one, and no
other costs less. Both count what transitions cost.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.suggest.tracks import RATE
from metagraph.synthesis.constraints import HeardStates, WantedSegment
from metagraph.synthesis.frame_costs import FrameCosts, PaidAlong
from metagraph.synthesis.graph import MotionGraph
from metagraph.synthesis.search_lookups import (
    EVENTS,
    charges_of,
    closes_at,
    fits_of,
    links_of,
    meets_of,
    speech_of,
)
from metagraph.synthesis.states import SynthesisError

Array = NDArray[Any]
Cancelled = Callable[[], bool] | None

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
LOOK = 90  # frames beyond a stretch: who goes on that long by itself is not held to be dear
AHEAD = 0.05  # of the threshold: what a second less of that counts as
APART = 3  # frames: ends of kept candidates
MOST = 4_000_000_000  # bytes of way back that are kept at once


@dataclass(frozen=True, eq=False)
class Path:
    """states `[T]`: one after another, a frame each. cost: of its transitions together, with what its frames
    cost where they do. jumps `[n]`: the frames that come by a transition instead of following. price: what
    the search made least, where jumps have prices beside what they look like.
    """

    states: Array
    cost: float
    jumps: Array
    price: float = 0.0


def best(
    graph: MotionGraph,
    heard: HeardStates,
    wanted: WantedSegment,
    cancelled: Cancelled = None,
    run: int = 1,
    charged: FrameCosts | None = None,
) -> Path:
    """Return the cheapest path that has what is wanted. run: frames between two transitions, at least.
    charged: what frames cost beside transitions; the least of both together is found, as exactly. Raises
    SynthesisError when there is none, saying at what time all end, or when it was cancelled.

    Ways dearer than a bound are not followed, which is exact: what is found within it is the cheapest. The
    bound grows until there is one, up to what the greedy search found. A jump and the frames after it are one
    step, so that how long ago the last one was need not be part of where one is.
    """
    states, frames = len(graph.states), len(wanted)
    if 8 * states * frames > MOST:
        raise SynthesisError(
            f"the best path over {states:,} states and {frames / RATE:.0f} s needs "
            f"{8e-9 * states * frames:.1f} GB: "
            "search shorter stretches, or with the greedy search"
        )
    try:
        deepest, more = DEEPER[0]
        dear = _greedy(graph, heard, wanted, 1, SAVED, BRANCHES + more, deepest, cancelled, run, charged).cost
        # Where jumps have prices, or frames, all are nearer to each other.
        shares = (0.4, 0.7) if run == 1 and charged is None else (0.75,)
        bounds = [share * dear + 1e-6 for share in shares] + [dear * (1 + 1e-5) + 1e-6]
    except SynthesisError:
        bounds = [share * graph.threshold.limit for share in (1.0, 4.0)]
    back = np.empty((frames, 2, states), np.int32)
    for bound in (*bounds, float("inf")):
        try:
            return _best_within(graph, heard, wanted, back, bound, cancelled, run, charged)
        except SynthesisError:
            if bound == float("inf") or (cancelled is not None and cancelled()):
                raise
    raise AssertionError("a search without a bound finds a path or says that there is none")


def _go_on(cancelled: Cancelled) -> None:
    """Raise SynthesisError when it was cancelled."""
    if cancelled is not None and cancelled():
        raise SynthesisError("the search was cancelled")


def _best_within(
    graph: MotionGraph,
    heard: HeardStates,
    wanted: WantedSegment,
    back: Array,
    bound: float,
    cancelled: Cancelled = None,
    run: int = 1,
    charged: FrameCosts | None = None,
) -> Path:
    """Return the cheapest path of those that cost no more than a bound. back: room for the way back `[T, 2,
    F]`. charged: what frames cost; then ways are counted without what they paid along their take
    (`PaidAlong`), so that to follow a take, or to arrive from a jump, is what it is without. Raises
    SynthesisError when there is none.
    """
    from metagraph.synthesis.greedy_search_kernels import next_of
    from metagraph.synthesis.kernels import arrive, cheap, follow, leap

    states, frames, most = len(graph.states), len(wanted), np.float32(bound)
    run = min(run, max(1, frames - 1))
    links = (
        cheap(graph.starts, graph.targets, graph.costs, most)
        if np.isfinite(bound)
        else (graph.starts, graph.targets, graph.costs)
    )
    follows = ~graph.states.last
    first = np.zeros(states, bool)
    first[graph.states.starts[:-1]] = True
    paid = PaidAlong(charged, first) if charged is not None else None
    happening = [heard.happens(what) for what in EVENTS]
    upcoming = np.stack([next_of(marked) for marked in happening])
    spans = _spans(wanted)
    landed = np.empty((run, 2, states), np.float32)
    sources, runs = np.empty((run, 2, states), np.int32), np.zeros((2, states), np.int32)
    cost = np.full((2, states), np.inf, np.float32)
    fits = fits_of(graph, heard, wanted, 0)
    met = fits & meets_of(happening, wanted, 0)
    cost[0, fits & ~met] = 0
    cost[1, met] = 0
    good = fits.astype(np.int32)
    _close(cost, wanted, 0)
    alive = 0 if np.isfinite(cost).any() else -1
    for t in range(1, frames):
        _go_on(cancelled)
        new = np.full((2, states), np.inf, np.float32)
        fits = fits_of(graph, heard, wanted, t)
        place = t % run
        if paid is None:
            leap(cost, landed[place], sources[place], *links, fits, most)
        else:
            whole = cost + paid.now.astype(np.float32)
            cost[whole > most] = np.inf
            leap(whole, landed[place], sources[place], *links, fits, most)
            paid.go_on(t)
            landed[place] -= paid.before.astype(np.float32)
        good[1:], good[0] = np.where(first[1:], 0, good[:-1]), 0
        good = np.where(fits, good + 1, 0).astype(np.int32)
        follow(cost, new, back[t], follows, fits, meets_of(happening, wanted, t), most)
        for ago in range(1 if t == frames - 1 else run, run + 1):  # at the end a run may be cut short
            if ago <= t:
                place = (t - ago + 1) % run
                pieces = _pieces(spans, t - ago + 1, t)
                arrive(landed[place], sources[place], ago, new, back[t], runs, good, pieces, upcoming)
        cost = new
        _close(cost, wanted, t)
        if np.isfinite(cost).any():
            alive = t
        elif t - alive >= run or t == frames - 1:  # nobody is on the way from a jump either
            break
    if alive < frames - 1:
        raise SynthesisError(_stuck(alive + 1))
    if paid is not None:
        cost += paid.now.astype(np.float32)
        if not cost.min() <= most:  # runs that came along since they were looked at
            raise SynthesisError(_stuck(frames - 1))
    met_at, state = np.unravel_index(int(cost.argmin()), cost.shape)
    total = float(cost[met_at, state])
    way = np.empty(frames, np.int64)
    t, b, s = frames - 1, int(met_at), int(state)
    while True:
        if closes_at(wanted, t):
            b = 1  # at the end of its window its stress was met
        before = int(back[t, b, s]) if t else 0
        length = 1 if before >= 0 else int(runs[b, s]) if t == frames - 1 else run
        way[t - length + 1 : t + 1] = np.arange(s - length + 1, s + 1)
        if t == 0:
            break
        before = before if before >= 0 else -1 - before
        t, b, s = t - length, before % 2, before // 2
    return Path(way, total, _jumps(way))


def _spans(wanted: WantedSegment) -> list[tuple[int, int, int]]:
    """Return the first and last frame of each window, and which of EVENTS it waits for."""
    edges = np.flatnonzero(np.diff(wanted.window)) + 1
    begins = [0, *edges.tolist()]
    return [
        (a, b - 1, EVENTS.index(wanted.event(a)))
        for a, b in zip(begins, [*begins[1:], len(wanted)], strict=True)
        if wanted.window[a] >= 0
    ]


def _pieces(spans: Sequence[tuple[int, int, int]], first: int, last: int) -> Array:
    """Return, as `arrive` has them, the windows among the frames first .. last."""
    rows = [
        (max(a, first) - first, min(b, last) - first, row, a < first)
        for a, b, row in spans
        if a <= last and b >= first
    ]
    return np.array(rows, np.int64).reshape(-1, 4)


def greedy(
    graph: MotionGraph,
    heard: HeardStates,
    wanted: WantedSegment,
    seed: int = 1,
    saved: int = SAVED,
    branches: int = BRANCHES,
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
    again, deeper. saved: how many are kept; branches: how many are gone deeper into of a run; run: frames
    between two transitions, at least; charged: what frames cost beside transitions, which counts as those do.
    Raises SynthesisError when it comes to an end before the speech does,
    though there may be a path, or when it was cancelled.
    """
    *first, last = ((branches + more, deepest) for deepest, more in DEEPER)
    for wide, deep in first:
        with suppress(SynthesisError):
            return _greedy(graph, heard, wanted, seed, saved, wide, deep, cancelled, run, charged)
        _go_on(cancelled)
    return _greedy(graph, heard, wanted, seed, saved, *last, cancelled, run, charged)


def _greedy(
    graph: MotionGraph,
    heard: HeardStates,
    wanted: WantedSegment,
    seed: int,
    saved: int,
    branches: int,
    deepest: int,
    cancelled: Cancelled,
    least: int = 1,
    charged: FrameCosts | None = None,
) -> Path:
    from metagraph.synthesis.greedy_search_kernels import segment

    frames, chance = len(wanted), np.random.default_rng(seed)
    fits = np.flatnonzero(fits_of(graph, heard, wanted, 0))
    if not len(fits):
        raise SynthesisError(_stuck(0))
    own = np.sort(chance.choice(fits, min(STARTS * saved, len(fits)), replace=False)).astype(np.int32)
    at, cost, met = np.zeros(len(own), np.int32), np.zeros(len(own), np.float32), np.zeros(len(own), bool)
    links, speech, charges = links_of(graph), speech_of(graph, heard, wanted), charges_of(charged, frames)
    best_at = np.full(2 * len(graph.states), -1, np.int32)
    ahead = AHEAD * graph.threshold.limit / RATE
    random = np.uint64(chance.integers(1 << 62))
    ids, count = np.arange(len(own)), len(own)  # of runs among all that were ever made
    tree = [(np.full(count, -1), at, own)]
    t0 = 0
    for t1 in _stretches(wanted):
        _go_on(cancelled)
        off, ats, owns, _, found, paid, random = segment(
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
            saved,
            branches,
            TRIES,
            deepest,
            least,
            np.uint64(random),
        )
        if not len(found):
            raise SynthesisError(_stuck(t0))
        keep = _kept(paid + ahead * np.maximum(0, t1 + LOOK - found[:, 3]), found[:, 4], saved, chance)
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
    way, run, end = np.empty(frames, np.int64), int(ids[place]), frames
    while run >= 0:
        first = int(since[run])
        way[first:end] = state[run] + np.arange(end - first)
        run, end = int(off[run]), first
    return Path(way, float(cost[place]), _jumps(way))


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


def _close(cost: Array, wanted: WantedSegment, t: int) -> None:
    """Forget ways on which the event was not met whose window ends; the others begin anew."""
    if closes_at(wanted, t):
        cost[0] = cost[1]
        cost[1] = np.inf


def _jumps(way: Array) -> Array:
    return np.flatnonzero(np.diff(way) != 1) + 1


def _stuck(t: int) -> str:
    return (
        f"no motion goes with this speech beyond {t / RATE:.1f} s: allow more tolerance, leave a kind of "
        "constraint out, "
        "or add takes with such speech"
    )
