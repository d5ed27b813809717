"""Paths through a motion graph that go with speech: the paper's stochastic greedy search, and the best path there is.

The greedy search keeps the cheapest few hundred of what it came upon, and may come to an end where nothing fits. The exact one is dynamic
programming over all states: it finds a path whenever there is one, and no other costs less. Both count what transitions cost.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.suggest.tracks import RATE
from metagraph.synthesis.constraints import Heard, Wanted
from metagraph.synthesis.graph import MotionGraph
from metagraph.synthesis.states import SynthesisError

Array = NDArray[Any]

SAVED = 200  # n_save: candidates that are kept
BRANCHES = 20  # transitions of a state that are tried
MOST = 4_000_000_000  # bytes of way back that are kept at once


@dataclass(frozen=True, eq=False)
class Path:
    """states `[T]`: one after another, a frame each. cost: of its transitions together. jumps `[n]`: the frames that come by a transition
    instead of following."""

    states: Array
    cost: float
    jumps: Array


def best(graph: MotionGraph, heard: Heard, wanted: Wanted) -> Path:
    """Return the cheapest path that has what is wanted. Raises SynthesisError when there is none, saying at what time all end."""
    from metagraph.synthesis.kernels import relax

    states, frames = len(graph.states), len(wanted)
    if 8 * states * frames > MOST:
        raise SynthesisError(
            f"the best path over {states:,} states and {frames / RATE:.0f} s needs {8e-9 * states * frames:.1f} GB: "
            "search shorter stretches, or with the greedy search"
        )
    follows = ~graph.states.last
    cost = np.full((2, states), np.inf, np.float32)
    back = np.full((frames, 2, states), -1, np.int32)
    fits = _fits(graph, heard, wanted, 0)
    met = fits & heard.peaks & (wanted.window[0] >= 0)
    cost[0, fits & ~met] = 0
    cost[1, met] = 0
    _close(cost, wanted, 0)
    for t in range(1, frames):
        new = np.full((2, states), np.inf, np.float32)
        fits = _fits(graph, heard, wanted, t)
        relax(cost, new, back[t], graph.starts, graph.targets, graph.costs, follows, fits, heard.peaks & (wanted.window[t] >= 0))
        cost = new
        _close(cost, wanted, t)
    met_at, state = np.unravel_index(int(cost.argmin()), cost.shape)
    total = float(cost[met_at, state])
    way = np.empty(frames, np.int64)
    b, s = int(met_at), int(state)
    for t in range(frames - 1, -1, -1):
        if _closes(wanted, t):
            b = 1  # at the end of its window its stress was met
        way[t] = s
        before = int(back[t, b, s])
        b, s = before % 2, before // 2
    return Path(way, total, _jumps(way))


def greedy(graph: MotionGraph, heard: Heard, wanted: Wanted, seed: int = 1, saved: int = SAVED, branches: int = BRANCHES) -> Path:
    """Return a path that has what is wanted, as the paper's search finds it: from random states on, of all that fits the cheapest are
    kept. Raises SynthesisError when it comes to an end before the speech does."""
    from metagraph.synthesis.kernels import wander

    frames = len(wanted)
    chance = np.random.default_rng(seed)
    fits = np.flatnonzero(_fits(graph, heard, wanted, 0))
    if not len(fits):
        raise SynthesisError(_stuck(0))
    now = np.sort(chance.choice(fits, min(saved, len(fits)), replace=False)).astype(np.int32)
    cost = np.zeros(len(now), np.float32)
    met = heard.peaks[now] & (wanted.window[0] >= 0)
    states, parents = [now], [np.full(len(now), -1, np.int32)]
    follows = ~graph.states.last
    for t in range(1, frames):
        if _closes(wanted, t - 1):
            keep = met
            now, cost, ids = now[keep], cost[keep], np.flatnonzero(keep)
            met = np.zeros(len(now), bool)
        else:
            ids = np.arange(len(now))
        fits = _fits(graph, heard, wanted, t)
        tried = chance.random((len(now), branches), np.float32)
        found, parent, total = wander(now, cost, graph.starts, graph.targets, graph.costs, follows, fits, tried)
        if not len(found):
            raise SynthesisError(_stuck(t))
        order = np.lexsort((chance.random(len(found)), total))
        order = order[np.sort(np.unique(found[order], return_index=True)[1])][:saved]  # the cheapest way to each state
        done = met[parent[order]] | (heard.peaks[found[order]] & (wanted.window[t] >= 0))
        states.append(found[order])
        parents.append(ids[parent[order]].astype(np.int32))
        now, cost, met = found[order], total[order], done if wanted.window[t] >= 0 else np.zeros(len(order), bool)
    if _closes(wanted, frames - 1):
        if not met.any():
            raise SynthesisError(_stuck(frames - 1))
        cost = np.where(met, cost, np.inf).astype(np.float32)
    place = int(cost.argmin())
    total_cost = float(cost[place])
    way = np.empty(frames, np.int64)
    for t in range(frames - 1, -1, -1):
        way[t] = states[t][place]
        place = int(parents[t][place])
    return Path(way, total_cost, _jumps(way))


def _fits(graph: MotionGraph, heard: Heard, wanted: Wanted, t: int) -> Array:
    return np.asarray(graph.kept & ((heard.kinds & wanted.allowed[t]) != 0))


def _closes(wanted: Wanted, t: int) -> bool:
    """Return whether a stress has to have been met by now."""
    return bool(wanted.window[t] >= 0 and (t + 1 == len(wanted) or wanted.window[t + 1] != wanted.window[t]))


def _close(cost: Array, wanted: Wanted, t: int) -> None:
    """Forget ways on which a stress was not met whose window ends; the others begin anew. Raises SynthesisError when none is left."""
    if _closes(wanted, t):
        cost[0] = cost[1]
        cost[1] = np.inf
    if not np.isfinite(cost).any():
        raise SynthesisError(_stuck(t))


def _jumps(way: Array) -> Array:
    return np.flatnonzero(np.diff(way) != 1) + 1


def _stuck(t: int) -> str:
    return (
        f"no motion goes with this speech beyond {t / RATE:.1f} s: allow more tolerance, leave a kind of constraint out, "
        "or add takes with such speech"
    )
