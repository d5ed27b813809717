"""The best path through a motion graph that goes with speech: dynamic programming over all states.

It finds a path whenever there is one, and no other costs less. Ways dearer than a bound are not followed,
which is exact: what is found within it is the cheapest. The bound is first somewhat less than what greedy
searches found.
"""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing, suppress
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.suggest.tracks import RATE
from metagraph.synthesis.constraints import EDGE, STRESS, HeardStates, WantedSegment
from metagraph.synthesis.frame_costs import FrameCosts, PaidAlong
from metagraph.synthesis.graph import MotionGraph
from metagraph.synthesis.greedy_search import greedy_once
from metagraph.synthesis.search_lookups import EVENTS, closes_at
from metagraph.synthesis.search_path import Cancelled, Path, go_on, jumps_of, stuck
from metagraph.synthesis.states import SynthesisError

Array = NDArray[Any]

MOST = 4_000_000_000  # bytes of way back that are kept at once
SEEDS = (1, 2, 3)  # of greedy searches that a first bound comes from
FIRST = 0.85  # of what the cheapest of their paths costs: within that there mostly is one
ROUND = 1 + 1e-5  # a bound is to hold what it was made of, in 32 bits
SHARED = 500  # states that are jumped from by one thread alone, at most: a second takes 30 us to start


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

    A jump and the frames after it are one step, so that how long ago the last one was need not be part of
    where one is.
    """
    states, frames = len(graph.states), len(wanted)
    if 8 * states * frames > MOST:
        raise SynthesisError(
            f"the best path over {states:,} states and {frames / RATE:.0f} s needs "
            f"{8e-9 * states * frames:.1f} GB: "
            "search shorter stretches, or with the greedy search"
        )
    with closing(ExactSearch(graph, heard, wanted, run, charged, cancelled)) as search:
        try:
            least = min(greedy_once(graph, heard, wanted, n, run=run, charged=charged).cost for n in SEEDS)
            bounds = [share * ROUND * least + 1e-6 for share in (FIRST, 1.0)]
        except SynthesisError:
            bounds = [share * graph.threshold.limit for share in (1.0, 4.0)]
        for bound in bounds:
            with suppress(SynthesisError):
                return search.within(bound)
            go_on(cancelled)
        return search.within(float("inf"))


class ExactSearch:
    """One search, which may be made within several bounds."""

    def __init__(
        self,
        graph: MotionGraph,
        heard: HeardStates,
        wanted: WantedSegment,
        run: int = 1,
        charged: FrameCosts | None = None,
        cancelled: Cancelled = None,
    ) -> None:
        from metagraph.synthesis.greedy_search_kernels import next_of

        self._graph, self._wanted, self._charged, self._cancelled = graph, wanted, charged, cancelled
        self._run = min(run, max(1, len(wanted) - 1))
        self._classes = StateClasses.of(graph, heard, wanted)
        self._first = np.zeros(len(graph.states), bool)
        self._first[graph.states.starts[:-1]] = True
        self._upcoming = np.stack([next_of(heard.happens(what)) for what in EVENTS])
        self._spans = _spans(wanted)
        self._other = ThreadPoolExecutor(1)
        self._leaps: Leaps | None = None

    @cached_property
    def _ahead(self) -> Array:
        """`[T, F]` for how many frames a state's take fits from a frame on, at most as long as a run is."""
        from metagraph.synthesis.exact_search_kernels import look_ahead

        frames, classes = len(self._wanted), self._classes
        out = np.empty(
            (frames, len(classes.of_state)), np.uint8 if self._run < 256 else np.min_scalar_type(self._run)
        )
        after = np.zeros_like(out[0])
        for t in range(frames - 1, -1, -1):
            only = self._wanted.only.get(t, np.zeros(0, bool))
            look_ahead(after, classes.fits[t], only, classes.of_state, self._first, self._run, out[t])
            after = out[t]
        return out

    @cached_property
    def _back(self) -> Array:
        """`[T, 2, F]` room for the way back."""
        return np.empty((len(self._wanted), 2, len(self._graph.states)), np.int32)

    def close(self) -> None:
        """End its threads."""
        self._other.shutdown()

    def within(self, bound: float) -> Path:
        """Return the cheapest path of those that cost no more than a bound. Raises SynthesisError
        when there is none.

        Where frames cost something ways are counted without what they paid along their take (`PaidAlong`),
        so that to follow a take, or to arrive from a jump, is what it is without.
        """

        frames, run, most = len(self._wanted), self._run, np.float32(bound)
        paid = PaidAlong(self._charged, self._first) if self._charged is not None else None
        cost = self._begun()
        runs = np.zeros(cost.shape, np.int32)
        alive = -1  # the last frame somebody was in a state at who was not on the way from a jump
        leaps = self._leaps_within(bound)
        for t in range(1, frames):
            go_on(self._cancelled)
            if paid is None:
                some = leaps.leap(cost, t)
            else:
                whole = cost + paid.now.astype(np.float32)
                cost[whole > most] = np.inf
                some = leaps.leap(whole, t)
                paid.go_on(t)
                leaps.landed[t % run] -= paid.before.astype(np.float32)
            if some:
                alive = t - 1
            elif t - 1 - alive >= run:  # nobody is on the way from a jump either
                break
            self._step(cost, runs, leaps, t, most)
        if not np.isfinite(cost).any():
            raise SynthesisError(stuck(alive + 1))
        if paid is not None:
            cost += paid.now.astype(np.float32)
            if not cost.min() <= most:  # runs that came along since they were looked at
                raise SynthesisError(stuck(frames - 1))
        return self._traced(cost, runs)

    def _leaps_within(self, bound: float) -> Leaps:
        """Return what jumps within a bound; transitions that were arranged for a higher one will do."""
        if self._leaps is None or bound > self._leaps.bound:
            self._leaps = Leaps(self._graph, self._classes, self._ahead, self._run, bound, self._other)
        self._leaps.most = np.float32(bound)
        return self._leaps

    def _begun(self) -> Array:
        """Return `[2, F]` what it costs to begin in a state, without and with an event met."""
        of, fits = self._classes.of_state, self._ahead[0] > 0
        met = fits & self._classes.meets[0][of]
        cost = np.full((2, len(of)), np.inf, np.float32)
        cost[0, fits & ~met] = 0
        cost[1, met] = 0
        _close(cost, self._wanted, 0)
        return cost

    def _step(self, cost: Array, runs: Array, leaps: Leaps, t: int, most: Any) -> None:
        """Bring what it costs to be where `[2, F]` from the frame before to frame t."""
        from metagraph.synthesis.exact_search_kernels import arrive, follow

        classes, back, run = self._classes, self._back[t], self._run
        follow(cost, back, self._ahead[t], classes.meets[t], classes.of_state, self._first, most)
        for ago in range(
            1 if t == len(self._wanted) - 1 else run, run + 1
        ):  # at the end a run may be cut short
            if ago <= t:
                place = (t - ago + 1) % run
                pieces = _pieces(self._spans, t - ago + 1, t)
                arrive(
                    leaps.landed[place], leaps.sources[place], ago, cost, back, runs, pieces, self._upcoming
                )
        _close(cost, self._wanted, t)

    def _traced(self, cost: Array, runs: Array) -> Path:
        """Return the way to where it costs least to end. runs `[2, F]`: how long the last one was."""
        frames, back = len(self._wanted), self._back
        met, state = np.unravel_index(int(cost.argmin()), cost.shape)
        way = np.empty(frames, np.int64)
        t, b, s = frames - 1, int(met), int(state)
        while True:
            if closes_at(self._wanted, t):
                b = 1  # at the end of its window its event was met
            before = int(back[t, b, s]) if t else 0
            length = 1 if before >= 0 else int(runs[b, s]) if t == frames - 1 else self._run
            way[t - length + 1 : t + 1] = np.arange(s - length + 1, s + 1)
            if t == 0:
                break
            before = before if before >= 0 else -1 - before
            t, b, s = t - length, before % 2, before // 2
        return Path(way, float(cost[met, state]), jumps_of(way))


class Leaps:
    """Jumps from all states at once, frame by frame. landed `[run, 2, F]`: what the cheapest way to jump into
    a state costs, without and with the event met that was waited for, of the last frames, frame t at t % run;
    sources `[run, 2, F]`: where it comes from, 2 state + met. most: what no way may cost more than.
    """

    def __init__(
        self,
        graph: MotionGraph,
        classes: StateClasses,
        ahead: Array,
        run: int,
        bound: float,
        other: ThreadPoolExecutor,
    ) -> None:
        """ahead `[T, F]`: for how many frames a take goes on to fit; a run has to. bound: what no way is
        going to cost more than. other: where the second thread comes from.
        """
        from metagraph.synthesis.exact_search_kernels import STEPS, arranged

        self.bound, self.most = bound, np.float32(bound)
        self._width = np.float32(1.01 * bound / STEPS)
        self._links = arranged(
            graph.starts, graph.targets, graph.costs, classes.of_state, classes.count, self.most
        )
        self._classes, self._ahead, self._run, self._other = classes, ahead, run, other
        shape = (2, len(graph.states))
        self.landed, self.sources = np.empty((run, *shape), np.float32), np.empty((run, *shape), np.int32)
        self._others, self._theirs = np.empty(shape, np.float32), np.empty(shape, np.int32)
        self._alive = np.empty(2 * shape[1], np.int64)

    def leap(self, cost: Array, t: int) -> bool:
        """Jump to arrive at frame t; return whether there is anybody. cost `[2, F]`: a frame before."""
        from metagraph.synthesis.exact_search_kernels import leap, living, merge

        count = self._classes.count
        number, half = living(cost, self._links[0], count, self.most, self._alive)
        asked = (
            *self._links,
            self._classes.fitting[t],
            count,
            self._ahead[t],
            min(self._run, len(self._ahead) - t),
            self.most,
            self._width,
        )
        place = t % self._run
        if number < SHARED:
            leap(cost, self._alive[:number], self.landed[place], self.sources[place], *asked)
            return bool(number)
        second = self._other.submit(leap, cost, self._alive[half:number], self._others, self._theirs, *asked)
        leap(cost, self._alive[:half], self.landed[place], self.sources[place], *asked)
        second.result()
        merge(self.landed[place], self.sources[place], self._others, self._theirs)
        return True


@dataclass(frozen=True, eq=False)
class StateClasses:
    """States of which frames ask the same. of_state `[F]` int32: which class a state is of, -1 for one of no
    path. fits `[T, C]`: which classes may come at a frame, but for which states alone may; meets `[T, C]`:
    which are the event its window waits for.
    """

    of_state: Array
    fits: Array
    meets: Array

    @classmethod
    def of(cls, graph: MotionGraph, heard: HeardStates, wanted: WantedSegment) -> StateClasses:
        events = heard.happens(STRESS) * STRESS + heard.happens(EDGE) * EDGE
        each, of = np.unique(heard.kinds.astype(np.int32) << 2 | events, return_inverse=True)
        kinds, happening = each >> 2, each & 3
        barred = np.array([wanted.bars(t) for t in range(len(wanted))])
        awaited = np.array([wanted.event(t) if wanted.window[t] >= 0 else 0 for t in range(len(wanted))])
        fits = ((wanted.allowed[:, None] & kinds) != 0) & ((barred[:, None] & happening) == 0)
        meets = (awaited[:, None] & happening) != 0
        return cls(np.where(graph.kept, of.reshape(-1), -1).astype(np.int32), fits, meets)

    @property
    def count(self) -> int:
        return int(self.fits.shape[1])

    @cached_property
    def fitting(self) -> list[Array]:
        """Of each frame the numbers of the classes that fit."""
        return [np.flatnonzero(row) for row in self.fits]


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


def _close(cost: Array, wanted: WantedSegment, t: int) -> None:
    """Forget ways on which the event was not met whose window ends; the others begin anew."""
    if closes_at(wanted, t):
        cost[0] = cost[1]
        cost[1] = np.inf
