"""Where the numbers of the handles stand: each under its line, and none over another."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

APART = 5.0  # pixels between two


@dataclass(frozen=True)
class Placed:
    """left: pixels. line: 0 the upper, 1 the lower."""

    left: float
    line: int


def place_numbers(
    wanted: Sequence[tuple[float, float]], low: float, high: float, lines: int = 2
) -> list[Placed]:
    """Return where words stand that are wanted (middle, width), pixels, between two edges: in the first line
    in which they are free to stand there, else moved aside as little as it takes. In order of importance.
    """
    taken: list[list[tuple[float, float]]] = [[] for _ in range(lines)]
    out = []
    for middle, width in wanted:
        ideal = min(max(middle - width / 2, low), max(low, high - width))
        choices = [
            (abs(left - ideal) + n * APART, n, left)
            for n in range(lines)
            if (left := _free(taken[n], ideal, width, low, high)) is not None
        ]
        if not choices:  # there is no room for all: the last stand over the edge, in the last line
            choices = [(0.0, lines - 1, ideal)]
        _, line, left = min(choices)
        taken[line].append((left, left + width))
        out.append(Placed(left, line))
    return out


def _free(
    taken: list[tuple[float, float]], ideal: float, width: float, low: float, high: float
) -> float | None:
    """Return the place nearest to the ideal one at which a width is free, None if none is."""
    places = [ideal, *(b + APART for _, b in taken), *(a - APART - width for a, _ in taken)]
    free = [
        p
        for p in places
        if p >= low - 1e-6
        and p + width <= high + 1e-6
        and all(p + width + APART <= a + 1e-6 or p >= b + APART - 1e-6 for a, b in taken)
    ]
    return min(free, key=lambda p: abs(p - ideal), default=None)
