"""A graph's transitions as the exact search goes through them, there and back."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cached_property
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from metagraph.synthesis.exact_search_problem import StateClasses
from metagraph.synthesis.graph import MotionGraph

Array = NDArray[Any]

KEPT = 500_000_000  # bytes of a graph's transitions that are kept for the next search


@dataclass(frozen=True, eq=False)
class SearchLinks:
    """starts `[F + 1]`: where each state's transitions begin. arranged: firsts, targets and costs as the loop
    `arranged` writes them. width: of a step of costs; cheapest: what one costs at least.
    entered: states that transitions lead to.
    """

    starts: Array
    arranged: tuple[Array, Array, Array]
    width: Any
    cheapest: Any
    entered: Array

    @cached_property
    def leaving(self) -> Array:
        """The states that transitions leave."""
        return np.flatnonzero(np.diff(self.starts))


_KNOWN: WeakKeyDictionary[MotionGraph, tuple[int, Array, SearchLinks, SearchLinks]] = WeakKeyDictionary()


def both_ways(
    graph: MotionGraph, classes: StateClasses, other: ThreadPoolExecutor
) -> tuple[SearchLinks, SearchLinks]:
    """Return a graph's transitions, and those turned round, states numbered from the last on; as they were
    arranged for the last search, where classes are the same. other: where the second thread comes from.
    """
    known = _KNOWN.get(graph)
    if known is None or known[0] != classes.count or not np.array_equal(known[1], classes.of_state):
        known = (classes.count, classes.of_state, *_arranged(graph, classes, other))
        if 16 * len(graph.targets) <= KEPT:
            _KNOWN[graph] = known
    return known[2:]


def _arranged(
    graph: MotionGraph, classes: StateClasses, other: ThreadPoolExecutor
) -> tuple[SearchLinks, SearchLinks]:
    from metagraph.synthesis.exact_links_kernels import STEPS, arranged, counted, turned

    states, count = len(graph.states), classes.count
    cheapest, dearest = graph.costs.min(initial=np.inf), float(graph.costs.max(initial=0.0))
    width = np.float32(1.001 * dearest / STEPS or 1.0)
    onto, back = _room(len(graph.targets)), _room(len(graph.targets))
    firsts = [np.empty(states * (count + 1), np.int64) for _ in range(2)]
    begun = other.submit(counted, graph.targets, states)
    halves = _halves(graph.starts)
    _both(
        other,
        arranged,
        [
            (
                graph.starts,
                *half,
                graph.targets,
                graph.costs,
                classes.of_state,
                count,
                width,
                *onto,
                firsts[0],
            )
            for half in halves
        ],
    )
    starts = begun.result()
    halves = _halves(starts)
    at = starts[:-1].copy()
    _both(
        other,
        turned,
        [
            (graph.starts, graph.targets, graph.costs, states - after, states - first, at, *back)
            for first, after in halves
        ],
    )
    of = np.ascontiguousarray(classes.of_state[::-1])
    _both(other, arranged, [(starts, *half, *back, of, count, width, *back, firsts[1]) for half in halves])
    leaving, entered = (
        np.flatnonzero(np.diff(graph.starts)),
        states - 1 - np.flatnonzero(np.diff(starts))[::-1],
    )
    return (
        SearchLinks(graph.starts, (firsts[0], *onto), width, cheapest, entered),
        SearchLinks(starts, (firsts[1], *back), width, cheapest, states - 1 - leaving[::-1]),
    )


def _halves(starts: Array) -> list[tuple[int, int]]:
    """Return the first state and the one after the last of either half of all transitions."""
    middle = int(np.searchsorted(starts, starts[-1] // 2))
    return [(0, middle), (middle, len(starts) - 1)]


def _both(other: ThreadPoolExecutor, work: Callable[..., Any], parts: Sequence[tuple[Any, ...]]) -> None:
    """Do two parts of a work at a time."""
    second = other.submit(work, *parts[1])
    work(*parts[0])
    second.result()


def _room(transitions: int) -> tuple[Array, Array]:
    """Return room for targets and costs, side by side: they are looked at together."""
    both = np.empty((transitions, 2), np.int32)
    return both[:, 0], both.view(np.float32)[:, 1]
