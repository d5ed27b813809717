"""A path through a motion graph, and what both searches for one say."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.suggest.tracks import RATE
from metagraph.synthesis.states import SynthesisError

Array = NDArray[Any]
Cancelled = Callable[[], bool] | None


@dataclass(frozen=True, eq=False)
class Path:
    """states `[T]`: one after another, a frame each. cost: of its transitions together, with what its frames
    cost where they do. jumps `[n]`: the frames that come by a transition instead of following. price: what
    the search made least, where jumps have prices beside what they look like.
    """

    states: Array
    cost: float
    jumps: Array
    price: float = 0.0


def check_cancelled(cancelled: Cancelled) -> None:
    """Raise SynthesisError when it was cancelled."""
    if cancelled is not None and cancelled():
        raise SynthesisError("the search was cancelled")


def find_way_jumps(way: Array) -> Array:
    """Return the places of a way `[T]` of states that come by a transition, ascending."""
    return np.flatnonzero(np.diff(way) != 1) + 1


def describe_stuck(t: int) -> str:
    """Return in words that no motion goes on at frame t, and what helps."""
    return (
        f"no motion goes with this speech beyond {t / RATE:.1f} s: allow more tolerance, leave a kind of "
        "constraint out, "
        "or add takes with such speech"
    )
