"""What was seen beside what a model makes of it: how often, what after what, how long; with which seed alone
explains.

A model of n draws visits its states not quite as often as its matrix says. How far off is to be expected
follows from the matrix itself: rows are drawn independently, so the transitions from a state are multinomial;
visits are not independent, so their variance is the chain's own, from its fundamental matrix (Kemeny and
Snell, Finite Markov Chains, section 4.6).
"""

from __future__ import annotations

from collections.abc import Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph.model import Kind, Markov
from metagraph.playback.learning.learn import (
    Act,
    State,
    get_act_state,
    list_model_states,
    measure_rests,
    read_acts_of_metas,
)
from metagraph.playback.planning.markov import write

Array = NDArray[Any]

LEVELS = (0.1, 0.25, 0.5, 0.75, 0.9)  # the quantiles of lengths that are compared
SURE = 3.0  # deviations beyond which chance is no explanation


@dataclass(frozen=True)
class Tally:
    """Counts of a layer's acts. states [n], visits [n], moves [n, n] (row: now, column: next), lengths:
    seconds of each state's acts, rests: seconds between acts, seconds: from the first act's start to the last
    one's end.
    """

    states: tuple[State, ...]
    visits: Array
    moves: Array
    lengths: tuple[Array, ...]
    rests: Array
    seconds: float

    @property
    def count(self) -> int:
        return int(self.visits.sum())

    @property
    def rate(self) -> float:
        """Acts a minute."""
        return 60.0 * self.count / self.seconds if self.seconds > 0 else 0.0

    def shares(self) -> Array:
        """How large a part of all acts each state is, `[n]`."""
        return self.visits / max(1, self.count)


def count_act_sequences(observed: Sequence[Sequence[Act]], states: Sequence[State], tagged: bool) -> Tally:
    """Count sequences of acts. Acts in none of the states are passed over."""
    place = {state: n for n, state in enumerate(states)}
    visits, moves = np.zeros(len(states)), np.zeros((len(states), len(states)))
    lengths: list[list[float]] = [[] for _ in states]
    for sequence in observed:
        found = [(place.get(get_act_state(act, tagged)), act) for act in sequence]
        for n, act in found:
            if n is not None:
                visits[n] += 1
                lengths[n].append(act.length)
        for (a, _), (b, _) in pairwise(found):
            if a is not None and b is not None:
                moves[a, b] += 1
    seconds = sum(max(a.end for a in s) - s[0].start for s in observed if s)
    return Tally(
        tuple(states),
        visits,
        moves,
        tuple(np.sort(x) for x in lengths),
        np.sort(measure_rests(observed)),
        seconds,
    )


@dataclass(frozen=True)
class ModelComparison:
    """observed: None if nothing was; the matrix alone is compared with then. generated: by the model.
    expected [n]: how often each state comes in the long run; deviation [n]: how far the generated shares may
    be off by chance alone, one standard deviation.
    """

    model: Markov
    observed: Tally | None
    generated: Tally
    expected: Array
    deviation: Array

    def surprises(self) -> Array:
        """By how many standard deviations each state's generated share is off what the model expects,
        `[n]`.
        """
        off = self.generated.shares() - self.expected
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(np.abs(off) < 1e-9, 0.0, off / self.deviation)

    def apart(self) -> Array:
        """By how many standard deviations what was seen is off what the model does in the long run, `[n]`; 0
        if nothing was seen.
        """
        if self.observed is None or not self.observed.count:
            return np.zeros(len(self.expected))
        off = self.observed.shares() - self.expected
        chance = compute_share_deviation(self.model.matrix, self.expected, self.observed.count)
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(np.abs(off) < 1e-9, 0.0, off / chance)

    def move_surprises(self) -> Array:
        """The same for each transition, given how often its state was left, `[n, n]`."""
        matrix, left = np.array(self.model.matrix), self.generated.moves.sum(axis=1, keepdims=True)
        with np.errstate(divide="ignore", invalid="ignore"):
            off = self.generated.moves / left - matrix
            return np.where(
                (left == 0) | (np.abs(off) < 1e-9), 0.0, off / np.sqrt(matrix * (1 - matrix) / left)
            )


def compare_model(
    model: Markov, observed: Sequence[Sequence[Act]] | None, seconds: float = 3600.0, seed: int = 1
) -> ModelComparison:
    """Let a model write for some seconds, and put that beside what was observed."""
    states, tagged = list_model_states(model), bool(model.tags)
    generated = count_act_sequences([generate(model, seconds, seed)], states, tagged)
    expected = compute_stationary_shares(model.matrix)
    seen = count_act_sequences(observed, states, tagged) if observed is not None else None
    return ModelComparison(
        model,
        seen,
        generated,
        expected,
        compute_share_deviation(model.matrix, expected, max(1, generated.count)),
    )


def generate(
    model: Markov, seconds: float, seed: int = 1, kinds: AbstractSet[Kind] | None = None
) -> tuple[Act, ...]:
    """Return what a model does in some seconds when nobody asks for anything."""
    return read_acts_of_metas(write(model, seed, seconds, kinds)[0])


def compute_quantiles(lengths: Array) -> Array:
    """Return the `LEVELS` of lengths `[5]`, NaN if there are none."""
    return np.quantile(lengths, LEVELS) if len(lengths) else np.full(len(LEVELS), np.nan)


def compute_stationary_shares(matrix: Sequence[Sequence[float]]) -> Array:
    """Return how large a part of its time a chain spends in each state in the long run, `[n]`, begun in any
    state alike.

    The mean over time, so that chains that go in circles, or never leave some states, have one as well.
    """
    p = _filled(matrix)
    n = len(p)
    lazy = (p + np.eye(n)) / 2  # the same long run without the circles
    for _ in range(40):  # 2^40 steps
        lazy = lazy @ lazy
        lazy /= lazy.sum(axis=1, keepdims=True)
    out: Array = np.full(n, 1 / n) @ lazy
    return out


def compute_share_deviation(matrix: Sequence[Sequence[float]], expected: Array, count: int) -> Array:
    """Return the standard deviation of each state's share among `count` acts of a chain, `[n]`."""
    p = _filled(matrix)
    n = len(p)
    fundamental = np.linalg.pinv(np.eye(n) - p + np.tile(expected, (n, 1)))
    variance = 2 * expected * np.diag(fundamental) - expected - expected**2
    out: Array = np.sqrt(np.clip(variance, 0.0, None) / count)
    return out


def _filled(matrix: Sequence[Sequence[float]]) -> Array:
    """Return the matrix as it is drawn from: rows of zeros lead to every state alike, all others sum to 1."""
    p = np.array(matrix, float)
    p[p.sum(axis=1) <= 0] = 1.0
    out: Array = p / p.sum(axis=1, keepdims=True)
    return out
