"""The motion graph: transitions no worse than what the takes themselves show, of which nobody can get stuck (Yang et al., section 6)."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.suggest.johnson import JohnsonSB, fit
from metagraph.synthesis.states import LEVEL, STEP, States, SynthesisError, costs_apart, key_states

Array = NDArray[Any]

ROWS = 64  # key states compared with all others at once
MARGIN = 1e-3  # of the range: bounds of the distribution lie that far outside what was seen


@dataclass(frozen=True, eq=False)
class Threshold:
    """What a transition may cost. costs `[n]`: c_(i, i+k) of the takes. distribution: fitted to them, None where all are alike. limit:
    its LEVEL; observed: the costs' own."""

    k: int
    level: float
    costs: Array
    distribution: JohnsonSB | None
    limit: float
    observed: float


@dataclass(frozen=True, eq=False)
class MotionGraph:
    """starts `[F + 1]`, targets `[E]` int32, costs `[E]` float32: transitions from state f go to targets[starts[f]:starts[f + 1]],
    ascending, beside the one to the frame that follows, which costs nothing. keys `[K]`. kept `[F]`: the states of the largest strongly
    connected component, all where none was cut away."""

    states: States
    threshold: Threshold
    keys: Array
    starts: Array
    targets: Array
    costs: Array
    kept: Array

    @property
    def size(self) -> tuple[int, int]:
        """How many states are kept, and how many transitions there are, those to following frames not counted."""
        return int(self.kept.sum()), len(self.targets)


def threshold(states: States, k: int = STEP, level: float = LEVEL) -> Threshold:
    """Return what a transition may cost: the level of the Johnson S_B distribution of c_(i, i+k), or what was observed where none fits.

    Raises SynthesisError when no take is longer than k frames.
    """
    costs = costs_apart(states, k)
    if not len(costs):
        raise SynthesisError(f"no take has more than {k} frames, so nothing tells what a jump is: give longer takes")
    observed = float(np.quantile(costs, level))
    low, high = float(costs.min()), float(costs.max())
    if high - low < 1e-9:
        return Threshold(k, level, costs, None, high, observed)
    margin = MARGIN * (high - low)
    distribution = fit(costs, max(0.0, low - margin), high + margin)
    return Threshold(k, level, costs, distribution, distribution.quantile(level), observed)


def build(
    states: States,
    limit: Threshold | None = None,
    keys: Array | None = None,
    most: int | None = None,
    connected: bool = True,
    progress: Callable[[int, int], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
    threads: int | None = None,
) -> MotionGraph:
    """Return the motion graph of takes.

    limit: what transitions may cost, else `threshold(states)`. keys: the states they may leave and enter, else `key_states(states)`.
    most: how many of the cheapest are kept of each state, all when None; bounds the memory of large sets. connected: keep only the largest
    strongly connected component. Raises SynthesisError when it was cancelled, or when nothing is connected.
    """
    from metagraph.synthesis.kernels import components, cut

    limit = threshold(states) if limit is None else limit
    keys = key_states(states) if keys is None else np.asarray(keys)
    rows, targets, costs = _transitions(states, keys, limit.limit, most, progress, cancelled, threads)
    starts = np.zeros(len(states) + 1, np.int64)
    starts[keys + 1] = rows
    starts = np.cumsum(starts)
    kept = np.ones(len(states), bool)
    if connected:
        component, count = components(starts, targets, ~states.last)
        sizes = np.bincount(component, minlength=count)
        if sizes.max() < 2:
            raise SynthesisError(
                f"no two states are connected both ways: at {limit.limit:.3g} m the threshold is too low for these takes; "
                "raise k or the level, or add takes that come back to the same poses"
            )
        kept = component == int(sizes.argmax())
        if not kept.all():
            starts, targets, costs = cut(starts, targets, costs, kept)
    return MotionGraph(states, limit, keys, starts, targets, costs, kept)


def _transitions(
    states: States,
    keys: Array,
    limit: float,
    most: int | None,
    progress: Callable[[int, int], None] | None,
    cancelled: Callable[[], bool] | None,
    threads: int | None,
) -> tuple[Array, Array, Array]:
    """Return how many transitions each key state has `[K]`, where they go `[E]`, and what they cost `[E]`.

    To go from i to j costs as much as i differs from j - 1. So j is a key state with a frame before it in its take; j = i + 1 is no
    transition, it is what follows anyway.
    """
    from metagraph.synthesis.kernels import LANES, near, pack

    first = np.zeros(len(states), bool)
    first[states.starts[:-1]] = True
    into = keys[~first[keys]]
    terms = states.terms
    order = _order(terms)
    terms = np.ascontiguousarray(terms[:, order])
    blocks = np.full((-(-len(into) // LANES) * LANES, terms.shape[1], 3), np.float32(1e18), np.float32)
    blocks[: len(into)] = terms[into - 1]
    blocks = np.ascontiguousarray(blocks.reshape(-1, LANES, terms.shape[1], 3).transpose(0, 2, 3, 1))
    chunks = [keys[n : n + ROWS] for n in range(0, len(keys), ROWS)]
    done = 0

    def work(chunk: Array) -> tuple[Array, Array, Array]:
        if cancelled is not None and cancelled():
            return np.zeros(len(chunk), np.int64), np.zeros(0, np.int32), np.zeros(0, np.float32)
        places, costs = np.empty((len(chunk), len(into)), np.int32), np.empty((len(chunk), len(into)), np.float32)
        counts = np.empty(len(chunk), np.int64)
        near(terms[chunk], blocks, len(into), np.float32(limit), places, costs, counts)
        found = counts.copy()
        targets, costs = pack(places, costs, found, into, chunk, counts)
        if most is not None:
            keep = _cheapest(costs, np.repeat(chunk, counts), counts, most)
            targets, costs = targets[keep], costs[keep]
            counts = np.minimum(counts, most)
        return counts, targets, costs

    rows, targets, costs = [], [], []
    with ThreadPoolExecutor(threads or os.cpu_count() or 1) as pool:
        for counts, some, cost in pool.map(work, chunks):
            rows.append(counts)
            targets.append(some)
            costs.append(cost)
            done += len(counts)
            if progress is not None:
                progress(done, len(keys))
    if cancelled is not None and cancelled():
        raise SynthesisError("the motion graph was cancelled")
    return np.concatenate(rows), np.concatenate(targets), np.concatenate(costs)


def _order(terms: Array) -> Array:
    """Return terms with those that differ most first, so that most pairs are over the limit after a few."""
    return np.argsort(-np.linalg.norm(terms - terms.mean(0), axis=-1).mean(0), kind="stable")


def _cheapest(costs: Array, source: Array, counts: Array, most: int) -> Array:
    """Return `[n]` whether a transition is among the cheapest of its source."""
    order = np.lexsort((costs, source))
    firsts = np.repeat(np.cumsum(counts) - counts, counts)
    rank = np.empty(len(costs), np.int64)
    rank[order] = np.arange(len(costs)) - firsts
    return np.asarray(rank < most)
