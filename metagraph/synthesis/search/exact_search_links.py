"""A graph's transitions as the exact search goes through them, there and back."""

from __future__ import annotations

from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from functools import cached_property
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from metagraph.synthesis.graph import MotionGraph
from metagraph.synthesis.search.exact_search_problem import StateClasses

Array = NDArray[Any]

Made = tuple[Array, Array, Array]  # firsts, targets, costs
KEPT = 500_000_000  # bytes of a graph's transitions that are kept for the next search


@dataclass(frozen=True, eq=False)
class SearchLinks:
    """starts `[F + 1]`: where each state's transitions begin. making: firsts, targets and costs as the loop
    `arranged` writes them, perhaps on another thread. width: of a step of costs; cheapest: what one costs at
    least. entered: states that transitions lead to.
    """

    starts: Array
    making: Future[Made]
    width: Any
    cheapest: Any
    entered: Array

    @property
    def arranged(self) -> Made:
        """firsts, targets and costs, once they are made."""
        return self.making.result()

    @cached_property
    def leaving(self) -> Array:
        """The states that transitions leave."""
        return np.flatnonzero(np.diff(self.starts))


_KNOWN: WeakKeyDictionary[MotionGraph, tuple[int, Array, SearchLinks, SearchLinks]] = WeakKeyDictionary()


def arrange_both_ways(
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
    from metagraph.synthesis.search.exact_links_kernels import (
        STEPS,
        arrange_by_class,
        count_transitions,
        turn_round,
    )

    states, count = len(graph.states), classes.count
    cheapest, dearest = graph.costs.min(initial=np.inf), float(graph.costs.max(initial=0.0))
    width = np.float32(1.001 * dearest / STEPS or 1.0)

    def made(starts: Array, links: tuple[Array, Array], of: Array, room: tuple[Array, Array]) -> Made:
        firsts = np.empty(states * (count + 1), np.int64)
        arrange_by_class(starts, *links, of, count, width, *room, firsts)
        return firsts, *room

    links = graph.targets, graph.costs
    there = other.submit(made, graph.starts, links, classes.of_state, _room(len(graph.targets)))
    starts = count_transitions(graph.targets, states)
    turning = _room(len(graph.targets))
    turn_round(graph.starts, *links, starts[:-1].copy(), *turning)
    back: Future[Made] = Future()
    back.set_result(made(starts, turning, np.ascontiguousarray(classes.of_state[::-1]), turning))
    leaving, entered = (
        np.flatnonzero(np.diff(graph.starts)),
        states - 1 - np.flatnonzero(np.diff(starts))[::-1],
    )
    return (
        SearchLinks(graph.starts, there, width, cheapest, entered),
        SearchLinks(starts, back, width, cheapest, states - 1 - leaving[::-1]),
    )


def _room(transitions: int) -> tuple[Array, Array]:
    """Return room for targets and costs, side by side: they are looked at together."""
    both = np.empty((transitions, 2), np.int32)
    return both[:, 0], both.view(np.float32)[:, 1]
