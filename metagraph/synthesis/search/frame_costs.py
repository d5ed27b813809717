"""What frames of a path cost beside its transitions: soft constraints, which no path fails by.

A frame's cost depends on the moment and the state alone, so the exact search stays exact with it: it is
dynamic programming over moments and states still, and what a run along a take costs is a difference of sums
along the take.
"""

from __future__ import annotations

import copy
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.synthesis.states import SynthesisError

Array = NDArray[Any]

MOST = 1_000_000_000  # bytes of what frames cost that are held at once


@dataclass(frozen=True, eq=False)
class FrameCost:
    """One kind of cost. name: what it is about. at `[T]` int32: which row a moment is charged by, -1 if
    nothing is charged. rows `[R, F]` float32: what each state costs then, metres, as transitions do; 0 or
    more, finite.
    """

    name: str
    at: Array
    rows: Array

    def paid(self, way: Array) -> float:
        """Return what the states `[T]` of a path cost together."""
        charged = np.flatnonzero(self.at[: len(way)] >= 0)
        return float(self.rows[self.at[charged], way[charged]].sum(dtype=np.float64))


@dataclass(frozen=True, eq=False)
class FrameCosts:
    """All kinds together."""

    kinds: tuple[FrameCost, ...]

    @cached_property
    def sums(self) -> tuple[Array, Array]:
        """`[T]` the row a moment is charged by, -1 for none; `[R, F]` float32 rows, the kinds added up."""
        together = np.stack([kind.at for kind in self.kinds])
        each, at = np.unique(together, axis=1, return_inverse=True)
        rows = np.zeros((each.shape[1], self.kinds[0].rows.shape[1]), np.float32)
        for number, chosen in enumerate(each.T):
            for kind, row in zip(self.kinds, chosen.tolist(), strict=True):
                if row >= 0:
                    rows[number] += kind.rows[row]
        at = at.reshape(-1).astype(np.int32)
        at[(together < 0).all(0)] = -1
        return at, rows

    def row(self, t: int) -> Array | None:
        """Return `[F]` what each state costs at a moment, None if nothing does."""
        at, rows = self.sums
        return rows[at[t]] if at[t] >= 0 else None

    def paid(self, way: Array) -> dict[str, float]:
        """Return what the states `[T]` of a path cost, each kind under its name, metres."""
        return {kind.name: kind.paid(np.asarray(way)) for kind in self.kinds}


def join_costs(kinds: Iterable[FrameCost | None]) -> FrameCosts | None:
    """Return kinds of costs as one, None if nothing is charged. Raises SynthesisError if they would not fit
    into memory.
    """
    some = tuple(kind for kind in kinds if kind is not None and (kind.at >= 0).any())
    if not some:
        return None
    size = 16 * sum(kind.rows.size for kind in some)
    if size > MOST:
        raise SynthesisError(
            f"what is compared frame by frame would take {size / 1e9:.1f} GB: ask for less at a time"
        )
    return FrameCosts(some)


class PaidAlong:
    """What frames have cost along takes, as the exact search counts it: the sum of what a state costs now,
    what the one before it in its take cost a frame ago, and so on, `[F]` float64.

    With what a way cost less this sum, a run along a take costs nothing, and a jump into a state costs what
    the sum there was before it came: so runs need not be walked.
    """

    def __init__(self, costs: FrameCosts, first: Array) -> None:
        """first `[F]`: whether a state is the first of its take."""
        self._costs, self._first = costs, first
        self.now = np.zeros(len(first))
        self.before = np.zeros(len(first))
        row = costs.row(0)
        if row is not None:
            self.now += row

    def copied(self) -> PaidAlong:
        """Return another one that is as far, and goes on by itself."""
        out = copy.copy(self)
        out.before = self.before.copy()  # the other array is made again for each frame
        return out

    def go_on(self, t: int) -> None:
        """Come to frame t. before: what was paid up to the frame before t by who is in a state at t."""
        self.before[1:], self.before[0] = np.where(self._first[1:], 0.0, self.now[:-1]), 0.0
        row = self._costs.row(t)
        self.now = self.before.copy() if row is None else self.before + row
