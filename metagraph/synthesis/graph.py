"""The motion graph: transitions no worse than what the takes themselves show, of which nobody can get stuck
(Yang et al., section 6).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.suggest.jumps.johnson import JohnsonSB, fit_johnson
from metagraph.synthesis.blocks import THIS_MACHINE, BlockMakers, compute_transitions, prepare_blocks
from metagraph.synthesis.states import LEVEL, STEP, States, SynthesisError, compute_costs_apart, key_states

Array = NDArray[Any]

BLEND = 5  # frames before and after a transition that are blended
MARGIN = 1e-3  # of the range: bounds of the distribution lie that far outside what was seen


@dataclass(frozen=True, eq=False)
class Threshold:
    """What a transition may cost. costs `[n]`: c_(i, i+k) of the takes. distribution: fitted to them, None if
    all are alike. limit: its LEVEL; observed: the costs' own.
    """

    k: int
    level: float
    costs: Array
    distribution: JohnsonSB | None
    limit: float
    observed: float


@dataclass(frozen=True, eq=False)
class MotionGraph:
    """starts `[F + 1]`, targets `[E]` int32, costs `[E]` float32: transitions from state f go to
    targets[starts[f]:starts[f + 1]], ascending, beside the one to the frame that follows, which costs
    nothing. keys `[K]`. kept `[F]`: the states of the largest strongly connected component, all where none
    was cut away.
    """

    states: States
    threshold: Threshold
    keys: Array
    starts: Array
    targets: Array
    costs: Array
    kept: Array

    @property
    def size(self) -> tuple[int, int]:
        """How many states are kept, and how many transitions there are, those to following frames not
        counted.
        """
        return int(self.kept.sum()), len(self.targets)


def find_threshold(states: States, k: int = STEP, level: float = LEVEL) -> Threshold:
    """Return what a transition may cost: the level of the Johnson S_B distribution of c_(i, i+k), or what was
    observed where none fits.

    Raises SynthesisError when no take is longer than k frames.
    """
    costs = compute_costs_apart(states, k)
    if not len(costs):
        raise SynthesisError(
            f"no take has more than {k} frames, so nothing tells what a jump is: give longer takes"
        )
    observed = float(np.quantile(costs, level))
    low, high = float(costs.min()), float(costs.max())
    if high - low < 1e-9:
        return Threshold(k, level, costs, None, high, observed)
    margin = MARGIN * (high - low)
    distribution = fit_johnson(costs, max(0.0, low - margin), high + margin)
    return Threshold(k, level, costs, distribution, distribution.quantile(level), observed)


def build_graph(
    states: States,
    limit: Threshold | None = None,
    keys: Array | None = None,
    most: int | None = None,
    connected: bool = True,
    progress: Callable[[int, int], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
    makers: BlockMakers = THIS_MACHINE,
) -> MotionGraph:
    """Return the motion graph of takes.

    limit: what transitions may cost, else `find_threshold(states)`. keys: the states they may leave and
    enter, else `key_states(states)`. most: how many of the cheapest are kept of each state, all when None;
    bounds the memory of large sets. connected: keep only the largest strongly connected component. makers:
    who makes the blocks of transitions, and where they are kept. Raises SynthesisError when it was cancelled,
    or when nothing is connected.
    """
    limit = find_threshold(states) if limit is None else limit
    keys = key_states(states) if keys is None else np.asarray(keys)
    work = prepare_blocks(states, keys, limit.limit, most)
    rows, targets, costs = compute_transitions(work, makers, progress, cancelled)
    del work
    starts = np.zeros(len(states) + 1, np.int64)
    starts[keys + 1] = rows
    starts = np.cumsum(starts)
    graph = MotionGraph(states, limit, keys, starts, targets, costs, np.ones(len(states), bool))
    return find_largest_component(graph, spent=True) if connected else graph


def find_largest_component(graph: MotionGraph, spent: bool = False) -> MotionGraph:
    """Return what is left of a graph in its largest strongly connected component: from every state there is a
    way to every other. spent: nobody needs the graph any more; what is left takes its memory. Raises
    SynthesisError when no two states are connected.
    """
    from metagraph.synthesis.kernels import cut_transitions, find_components

    component, count = find_components(graph.starts, graph.targets, ~graph.states.last)
    sizes = np.bincount(component, minlength=count)
    if sizes.max() < 2:
        raise SynthesisError(
            f"no two states are connected both ways: at {graph.threshold.limit:.3g} m the threshold is too "
            "low for these takes; "
            "raise k or the level, or add takes that come back to the same poses"
        )
    kept = component == int(sizes.argmax())
    if kept.all():
        return graph
    targets, costs = (graph.targets, graph.costs) if spent else (graph.targets.copy(), graph.costs.copy())
    starts = cut_transitions(graph.starts, targets, costs, kept)
    targets, costs = targets[: starts[-1]], costs[: starts[-1]]
    if 2 * len(targets) < len(graph.targets):  # else the memory of all of them stays
        targets, costs = targets.copy(), costs.copy()
    return replace(graph, starts=starts, targets=targets, costs=costs, kept=kept)
