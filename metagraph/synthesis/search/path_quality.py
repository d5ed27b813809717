"""What a path looks like, beside what it costs: whether it stands still, shows again what was just seen, and
how often it jumps.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.wording import phrase
from metagraph.suggest.tracks import RATE
from metagraph.synthesis.search.path import Path
from metagraph.synthesis.states import States

Array = NDArray[Any]

STILL = 0.02  # metres a second: slower than that no joint seems to move
RECENT = 3.0  # seconds in which a frame that was shown is shown again
LONGER = 1.5  # times the longest rest of the takes: longer than that a path stands still
LEAST = 1.0  # seconds: a rest as short as that is never too long


@dataclass(frozen=True)
class PathQuality:
    """What a path looks like. jumps: number a second. distinct: share of frames that show something new.
    repeated: share of frames that show what was shown in the last RECENT seconds. frozen: seconds of the
    longest rest, in which no joint moves faster than STILL. source: the same for the takes.
    """

    jumps: float
    distinct: float
    repeated: float
    frozen: float
    source: float

    @property
    def stands_still(self) -> bool:
        """Whether it rests longer than its takes do."""
        return self.frozen > max(LEAST, LONGER * self.source)

    def words(self) -> str:
        """Return it in words."""
        again = f"{self.repeated:.0%} repeats within {RECENT:g} s"
        return f"{self.jumps:.2f} transitions a second, {again}, {self.rest_words()}"

    def rest_words(self) -> str:
        """Return in words how long it rests."""
        if self.stands_still:
            return phrase(
                "stands still for up to {rest:.1f} s (its takes for up to {source:.1f} s)",
                rest=self.frozen,
                source=self.source,
            )
        return phrase(
            "rests for up to {rest:.1f} s (its takes for up to {source:.1f} s)",
            rest=self.frozen,
            source=self.source,
        )


def measure_quality(states: States, path: Path) -> PathQuality:
    """Return what a path of these states looks like."""
    shown = np.asarray(path.states)
    frames, window = len(shown), round(RECENT * RATE)
    last: dict[int, int] = {}
    again = 0
    for t, state in enumerate(shown.tolist()):
        again += state in last and t - last[state] <= window
        last[state] = t
    still = _still(states)
    jumped = np.zeros(frames, bool)
    jumped[path.jumps] = True
    at_rest = still[shown].copy()
    for t in np.flatnonzero(jumped).tolist():  # how far a jump goes, not what would have followed
        step = np.linalg.norm(states.places[shown[t]] - states.places[shown[t - 1]], axis=-1).max()
        at_rest[t - 1] = step * RATE < STILL
    takes = np.unique(np.searchsorted(states.starts, shown, "right") - 1)
    rests = [_longest(still[states.starts[n] : states.starts[n + 1]]) for n in takes.tolist()]
    return PathQuality(
        len(path.jumps) / max(frames / RATE, 1e-9),
        len(last) / max(1, frames),
        again / max(1, frames),
        _longest(at_rest) / RATE,
        max(rests, default=0) / RATE,
    )


def _still(states: States) -> Array:
    """Return `[F]` whether no joint moves between a state and the next of its take."""
    out = np.zeros(len(states), bool)
    for a in range(0, len(states) - 1, 1 << 15):
        b = min(len(states) - 1, a + (1 << 15))
        step = np.linalg.norm(states.places[a + 1 : b + 1] - states.places[a:b], axis=-1)
        out[a:b] = step.max(-1) * RATE < STILL
    out[states.last] = False
    return out


def _longest(rest: Array) -> int:
    """Return how many frames the longest run of True has."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], rest.astype(np.int8), [0]])))
    return int((edges[1::2] - edges[::2]).max(initial=0))
