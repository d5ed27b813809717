"""A lane of events in time, drawn one after another. It never changes: it is extended at the end and
forgotten at the front.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]


@dataclass(frozen=True, eq=False)
class Lane:
    """times: when events begin, ascending, seconds. rows: the values of each event. first: number of the
    first event that is still kept. width: how many numbers a row has.
    """

    times: Sequence[float] = ()
    rows: Sequence[Sequence[float]] = ()
    first: int = 0
    width: int = 1

    def __len__(self) -> int:
        return len(self.times)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Lane):
            return NotImplemented
        return (
            self.first == other.first
            and np.array_equal(self.starts, other.starts)
            and np.array_equal(self.values, other.values)
        )

    def __hash__(self) -> int:
        return hash((self.first, tuple(self.times)))

    @cached_property
    def starts(self) -> Array:
        """The times as an array `[n]`."""
        return np.array(self.times, float)

    @cached_property
    def values(self) -> Array:
        """The rows as an array `[n, width]`."""
        return np.array(self.rows, float).reshape(len(self.times), self.width)

    @property
    def next(self) -> int:
        """The number of the event to be drawn next."""
        return self.first + len(self.times)

    def until(self, seconds: float) -> Lane:
        """Return the lane with only the events that begin before a time."""
        count = bisect_left(self.times, seconds)
        if count == len(self.times):
            return self
        return Lane(self.times[:count], self.rows[:count], self.first, self.width)

    def plus(self, times: Sequence[float], rows: Sequence[Sequence[float]]) -> Lane:
        """Return the lane with later events."""
        if len(times) == 0:
            return self
        return Lane([*self.times, *times], [*self.rows, *rows], self.first, self.width)

    def since(self, seconds: float, before: int = 1) -> Lane:
        """Return the lane without events that are over at `seconds`; `before`: how many of those to keep."""
        gone = max(0, bisect_right(self.times, seconds) - 1 - before)
        if gone == 0:
            return self
        return Lane(self.times[gone:], self.rows[gone:], self.first + gone, self.width)


def lane(width: int) -> Lane:
    """Return an empty lane whose events have `width` values."""
    return Lane(width=width)
