"""Paths through a motion graph that jump only where it is worth it.

A jump that costs what it looks like costs nothing if a pose resembles itself: the cheapest path then leads
from a frame to itself, again and again, and stands still. A jump costs something by itself here, more where
it shows again what was just seen; it goes away from where it would go on anyway, and the next is some time
off.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Literal
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from metagraph.suggest.tracks import RATE
from metagraph.synthesis.constraints import HeardStates, WantedSegment
from metagraph.synthesis.graph import MotionGraph
from metagraph.synthesis.search.exact_search import find_best_path
from metagraph.synthesis.search.frame_costs import FrameCosts
from metagraph.synthesis.search.greedy_search import search_greedily
from metagraph.synthesis.search.path import Path
from metagraph.synthesis.states import SynthesisError

Array = NDArray[Any]
Search = Literal["greedy", "exact"]


@dataclass(frozen=True)
class JumpRules:
    """run: seconds between two transitions, at least. apart: seconds of a take between where a transition
    leads and where it would go on by itself, at least. price: what a transition costs beside what it looks
    like, of the graph's threshold. recent, again: what leads back in a take by less than so many seconds
    costs more, up to that share of the threshold for the nearest.
    """

    run: float = 0.5
    apart: float = 1.0
    price: float = 0.25
    recent: float = 3.0
    again: float = 1.0

    @property
    def frames(self) -> int:
        """Frames between two transitions, at least."""
        return max(1, round(self.run * RATE))


JUMP_RULES = JumpRules()
FREE = JumpRules(run=0.0, apart=0.0, price=0.0, recent=0.0, again=0.0)  # the paper's: what it looks like


def apply_rules(graph: MotionGraph, rules: JumpRules) -> MotionGraph:
    """Return a graph with the transitions that rules leave, at their prices. How long a run is is left to the
    search.
    """
    if rules == FREE:
        return graph
    starts = graph.states.starts
    take = np.repeat(np.arange(len(starts) - 1, dtype=np.int32), np.diff(starts))
    sources = np.repeat(np.arange(len(graph.states), dtype=np.int32), np.diff(graph.starts))
    ahead = graph.targets - (sources + 1)  # frames of a take that are left out; those shown again, negative
    same = take[sources] == take[graph.targets]
    keep = ~(same & (np.abs(ahead) < rules.apart * RATE))
    costs = graph.costs + np.float32(rules.price * graph.threshold.limit)
    if rules.recent > 0:
        near = np.clip(1 + ahead / (rules.recent * RATE), 0, 1) * (same & (ahead < 0))
        costs += (rules.again * graph.threshold.limit * near).astype(np.float32)
    counts = np.add.reduceat(np.append(keep, False), np.minimum(graph.starts[:-1], len(keep)))
    counts = np.where(np.diff(graph.starts) > 0, counts, 0)
    return replace(
        graph,
        starts=np.concatenate([[0], np.cumsum(counts)]),
        targets=graph.targets[keep],
        costs=costs[keep].astype(np.float32),
    )


_RULED: WeakKeyDictionary[MotionGraph, tuple[JumpRules, MotionGraph]] = WeakKeyDictionary()


def find_path(
    graph: MotionGraph,
    heard: HeardStates,
    wanted: WantedSegment,
    search: Search = "exact",
    rules: JumpRules = JUMP_RULES,
    seed: int = 1,
    cancelled: Callable[[], bool] | None = None,
    charged: FrameCosts | None = None,
) -> Path:
    """Return a path that has what is wanted, by rules for its jumps: the one of the lowest price, which is of
    all that keep to them ("exact"), or a cheap one, other with other seeds ("greedy"). charged: what frames
    cost, which both searches count. Raises SynthesisError if there is none.
    """
    allowed = _allowed(graph, rules)
    try:
        if search == "exact":
            path = find_best_path(allowed, heard, wanted, cancelled, rules.frames, charged)
        else:
            path = search_greedily(
                allowed, heard, wanted, seed, cancelled=cancelled, run=rules.frames, charged=charged
            )
    except SynthesisError as error:
        if rules == FREE or (cancelled is not None and cancelled()):
            raise
        raise SynthesisError(f"{error}, or let it jump as often as it likes") from error
    return replace(path, cost=_looks(graph, path), price=path.cost)


def _allowed(graph: MotionGraph, rules: JumpRules) -> MotionGraph:
    """Return `ruled`, made once a graph. Without rules that is the graph: kept, it would keep itself."""
    if rules == FREE:
        return graph
    known = _RULED.get(graph)
    if known is None or known[0] != rules:
        known = _RULED[graph] = rules, apply_rules(graph, rules)
    return known[1]


def _looks(graph: MotionGraph, path: Path) -> float:
    """Return what the transitions of a path look like, metres, without what rules put on them."""
    total = 0.0
    for frame in path.jumps.tolist():
        first, after = graph.starts[path.states[frame - 1]], graph.starts[path.states[frame - 1] + 1]
        place = first + int(np.searchsorted(graph.targets[first:after], path.states[frame]))
        total += float(graph.costs[place])
    return total
