"""A lane of events in time, drawn one after another: arrays that are never changed, extended at the end,
forgotten at the front.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]


@dataclass(frozen=True, eq=False)
class Lane:
    """starts `[n]` ascending, seconds; values `[n, k]`, what each event is. first: number of the first event
    that is still kept.
    """

    starts: Array
    values: Array
    first: int = 0

    def __len__(self) -> int:
        return len(self.starts)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Lane):
            return NotImplemented
        return (
            self.first == other.first
            and np.array_equal(self.starts, other.starts)
            and np.array_equal(self.values, other.values)
        )

    def __hash__(self) -> int:
        return hash((self.first, self.starts.tobytes()))

    @cached_property
    def plain(self) -> tuple[list[float], list[list[float]]]:
        """Starts and values as plain numbers."""
        return self.starts.tolist(), self.values.tolist()

    @property
    def next(self) -> int:
        """The number of the event to be drawn next."""
        return self.first + len(self.starts)

    def until(self, seconds: float) -> Lane:
        """Return the lane with only what begins before a time."""
        count = int(np.searchsorted(self.starts, seconds, "left"))
        return (
            self if count == len(self.starts) else Lane(self.starts[:count], self.values[:count], self.first)
        )

    def plus(self, starts: Sequence[float], values: Sequence[Sequence[float]]) -> Lane:
        """Return the lane with later events."""
        if not starts:
            return self
        more = np.asarray(values, float).reshape(len(starts), self.values.shape[1])
        return Lane(
            np.concatenate([self.starts, np.asarray(starts, float)]),
            np.concatenate([self.values, more]),
            self.first,
        )

    def since(self, seconds: float, before: int = 1) -> Lane:
        """Return the lane without what neither goes on at `seconds` nor comes later; `before`: how many more
        are kept.
        """
        gone = max(0, int(np.searchsorted(self.starts, seconds, "right")) - 1 - before)
        return Lane(self.starts[gone:].copy(), self.values[gone:].copy(), self.first + gone) if gone else self


def lane(width: int) -> Lane:
    """Return an empty lane whose events have `width` values."""
    return Lane(np.zeros(0), np.zeros((0, width)))
