"""The best path through a motion graph that goes with speech: dynamic programming over all states.

It finds a path whenever there is one, and no other costs less. Ways dearer than a bound are not followed,
which is exact: what is found within it is the cheapest. The bound is what a path costs that is found first,
where at each frame only the cheapest jump.

Ways meet in the middle of what they cost: backwards from the last frame it is found what it costs to go on,
up to about half of the bound, and forwards nobody lands where more than is left of it is ahead. The dearer
ways may be the more there are, far more than twice as many for twice the cost: two halves are less than one
whole.
"""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import closing, suppress
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.suggest.tracks import RATE
from metagraph.synthesis.constraints import HeardStates, WantedSegment
from metagraph.synthesis.graph import MotionGraph
from metagraph.synthesis.search.exact_search_links import SearchLinks, arrange_both_ways
from metagraph.synthesis.search.exact_search_problem import SearchProblem
from metagraph.synthesis.search.exact_search_sweep import Foresight, Sweep
from metagraph.synthesis.search.frame_costs import FrameCosts
from metagraph.synthesis.search.path import Cancelled, Path, check_cancelled, find_way_jumps
from metagraph.synthesis.states import SynthesisError

Array = NDArray[Any]

MOST = 4_000_000_000  # bytes of ways that are kept at once
NARROW = 500  # of those that are somewhere at a frame, the cheapest, jump where a first bound is looked for
ROUND = 1 + 1e-5  # a bound is to hold what it was made of, in 32 bits
HALF = 0.45  # of a bound is what is looked back for
REUSED = 0.3  # of a bound, at least, that what was foreseen for a lower one does for
EACH = 2.0**-22  # of a bound: sums of 32 bits that are made forwards and backwards differ by less, a frame


def find_best_path(
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
    """
    states, frames = len(graph.states), len(wanted)
    if 8 * states * frames > MOST:
        raise SynthesisError(
            f"the best path over {states:,} states and {frames / RATE:.0f} s needs "
            f"{8e-9 * states * frames:.1f} GB: "
            "search shorter stretches, or with the greedy search"
        )
    with closing(ExactSearch(graph, heard, wanted, run, charged, cancelled)) as search:
        bounds = [search.guessed()]
        if not np.isfinite(bounds[0]):
            bounds = [share * graph.threshold.limit for share in (1.0, 4.0)]
        for bound in bounds:
            with suppress(SynthesisError):
                return search.within(min(bound, search.through) * ROUND + 1e-6)
            check_cancelled(cancelled)
        return search.within(float("inf"))


class ExactSearch:
    """One search, which may be made within several bounds. through: what some path costs that was come upon,
    infinite without.
    """

    def __init__(
        self,
        graph: MotionGraph,
        heard: HeardStates,
        wanted: WantedSegment,
        run: int = 1,
        charged: FrameCosts | None = None,
        cancelled: Cancelled = None,
    ) -> None:
        self._cancelled = cancelled
        self._graph = graph
        self._problem = SearchProblem.of(graph, heard, wanted, run, charged)
        self._other = ThreadPoolExecutor(1)
        self._foresight: Foresight | None = None
        self._looking: Sweep | None = None  # back, on the other thread
        self._looked: Future[Foresight] | None = None
        self._exact: Sweep | None = None  # the beginning of a sweep that left nobody out
        self.through = float("inf")

    def close(self) -> None:
        """End its threads."""
        if self._looking is not None:
            self._looking.limit(-1.0)
        self._other.shutdown()

    @cached_property
    def _arranged(self) -> tuple[SearchLinks, SearchLinks]:
        """The transitions, there and back."""
        return arrange_both_ways(self._graph, self._problem.classes, self._other)

    def guessed(self) -> float:
        """Return what some path costs, infinite where none was come upon: where many are at a frame, the
        cheapest alone jump. Meanwhile the search begins to look back.
        """
        sweep = Sweep(self._problem, *self._arranged, np.inf, 1.0, narrow=NARROW, cancelled=self._cancelled)
        if self._foreseeable:
            self._looking = self._backwards(np.inf)
            self._looked = self._other.submit(self._looking.backwards)
        with suppress(SynthesisError):
            sweep.forwards()
            self.through = float(sweep.cost.min())
        self._exact = sweep.exact
        check_cancelled(self._cancelled)
        return self.through

    def within(self, bound: float) -> Path:
        """Return the cheapest path of those that cost no more than a bound. Raises SynthesisError
        when there is none.
        """
        foresight = self._foreseen(bound)
        if self._exact is not None:
            sweep = self._exact.within(bound, self._slack, foresight)
        else:
            there, back = self._arranged
            sweep = Sweep(
                self._problem, there, back, bound, self._slack, foresight, cancelled=self._cancelled
            )
        try:
            ways = sweep.forwards()
        finally:
            self.through = min(self.through, float(sweep.through))
        return self._traced(sweep, ways)

    @property
    def _slack(self) -> float:
        return 1 + EACH * (len(self._problem.wanted) + 8)

    @property
    def _foreseeable(self) -> bool:
        """Whether there is room for what is foreseen."""
        return 24 * len(self._problem.first) * len(self._problem.wanted) <= MOST

    def _backwards(self, bound: float) -> Sweep:
        there, back = self._arranged
        return Sweep(self._problem.turned(), back, there, bound, self._slack, cancelled=self._cancelled)

    def _foreseen(self, bound: float) -> Foresight | None:
        if not np.isfinite(bound) or not self._foreseeable:
            return None
        if self._looking is not None and self._looked is not None:
            self._looking.limit(HALF * bound)
            self._foresight = self._looked.result()
            self._looking = self._looked = None
        if self._foresight is None or self._foresight.within < REUSED * bound:
            self._foresight = self._backwards(HALF * bound).backwards()
        return self._foresight

    def _traced(self, sweep: Sweep, ways: Sequence[tuple[Array, Array]]) -> Path:
        """Return the way to where it costs least to end. ways: as `Sweep.forwards` returns them."""
        frames, run, states = len(self._problem.wanted), self._problem.run, len(self._problem.first)
        way = np.empty(frames, np.int64)
        t, code = frames - 1, int(sweep.cost.argmin())
        cost = float(sweep.cost[code])
        while True:
            codes, back = ways[t]
            before = int(back[codes == code][0]) if t else 0
            length = 1 if before >= 0 else int(sweep.runs[code]) if t == frames - 1 else run
            state = code % states
            way[t - length + 1 : t + 1] = np.arange(state - length + 1, state + 1)
            if t == 0:
                break
            t, code = t - length, before if before >= 0 else -1 - before
        return Path(way, cost, find_way_jumps(way))
