"""One of several people: who is followed from frame to frame."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

REACH = 0.6  # of their size, by which people move between two frames at most
PATIENCE = 1.0  # seconds somebody may be lost before somebody else is followed
GROWTH = 1.6  # ratio of sizes up to which it may be the same person


@dataclass(frozen=True, eq=False)
class SeenPerson:
    """Somebody in a frame. points `[K, 3]` in the file's own axes; confidence `[K]`; ident: the file's own
    number for them, if any.
    """

    points: Array
    confidence: Array
    ident: int | None = None

    def place(self) -> tuple[Array, float] | None:
        """Return the middle `[2]` of what was found, and its size; None if it is hardly anything."""
        found = self.points[self.confidence > 0, :2]
        if len(found) < 3:
            return None
        low, high = found.min(0), found.max(0)
        size = float(np.hypot(*(high - low)))
        return ((low + high) / 2, size) if size > 0 else None


def follow_person(
    times: Sequence[float], frames: Sequence[Sequence[SeenPerson]], middle: float | None = None
) -> Iterator[SeenPerson | None]:
    """Yield for each frame the person who is followed, None if they are not there.

    The largest is followed, those in the picture's middle (x, where it is known) before those at its edge;
    then whoever is nearest to where they were, or has their number. After PATIENCE seconds without them
    somebody is chosen again.
    """
    last: tuple[Array, float] | None = None
    ident, lost = None, 0.0
    for time, people in zip(times, frames, strict=True):
        known = [(p, place) for p in people if (place := p.place()) is not None]
        if last is not None and time - lost > PATIENCE:
            last = None
        if last is None:
            chosen = max(known, key=lambda item: _presence(item[1], middle), default=None)
        else:
            chosen = _again(known, last, ident)
        if chosen is None:
            yield None
            continue
        person, last = chosen
        ident, lost = person.ident, time
        yield person


def _presence(place: tuple[Array, float], middle: float | None) -> float:
    where, size = place
    return (
        size
        if middle is None or middle <= 0
        else size * (1.0 - 0.5 * min(1.0, abs(float(where[0]) - middle) / middle))
    )


def _again(
    known: Sequence[tuple[SeenPerson, tuple[Array, float]]], last: tuple[Array, float], ident: int | None
) -> tuple[SeenPerson, tuple[Array, float]] | None:
    """Return who of those in a frame was followed in the last."""
    where, size = last
    named = next((item for item in known if ident is not None and item[0].ident == ident), None)
    if named is not None:
        return named
    near = [
        (float(np.hypot(*(place[0] - where))), n)
        for n, (_, place) in enumerate(known)
        if 1 / GROWTH < place[1] / size < GROWTH
    ]
    best = min(near, default=None)
    return known[best[1]] if best is not None and best[0] < REACH * size else None
