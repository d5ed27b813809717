"""Axes of a study's plots: where a value lies, and which values are marked."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import ceil, floor, isfinite, log10

Place = Callable[[float], float]
MOST_TICKS = 9

_MINUTE, _HOUR = 60.0, 3600.0
_SMALL = tuple(m * b for b in (0.01, 0.1) for m in (1, 2, 5))
TIMES = (
    (*_SMALL, *(1, 1.5, 2, 3, 4, 5, 6, 8, 10, 12, 15, 20, 25, 30, 40, 50, 60, 75, 90),
     *(m * _MINUTE for m in (2, 2.5, 3, 4, 5, 6, 8, 10, 12, 15, 20, 25, 30, 40, 50, 60, 75)),
     *(m * _HOUR for m in (1.5, 2, 2.5, 3, 4, 5, 6, 8, 10, 12, 15, 20, 30, 40, 50, 75, 100, 150, 200))),
    (*_SMALL, 1, 2, 5, 10, 15, 20, 30, 45, 60, 90, *(m * _MINUTE for m in (2, 3, 5, 7, 10, 15, 20, 30, 45,
    60)), *(m * _HOUR for m in (1.5, 2, 3, 5, 10, 15, 20, 30, 50, 100, 200))),
    (*_SMALL, 1, 2, 5, 10, 30, 60, *(m * _MINUTE for m in (2, 5, 10, 30, 60)),
     *(m * _HOUR for m in (2, 5, 10, 20, 50, 100, 200))),
    (0.01, 0.1, 1, 10, 60, 600, 3600, 36000, 360000, 3600000),
)  # fmt: skip
RATIOS = tuple(
    tuple(m * 10.0**b for b in range(-6, 8) for m in steps)
    for steps in (
        (1, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.8, 2, 2.2, 2.5, 3, 3.5, 4, 4.5, 5, 6, 7, 8, 9),
        (1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8),
        (1, 1.5, 2, 3, 5, 7),
        (1, 2, 5),
        (1,),
    )
)
COUNTS = (
    (1, 2, 3, 4, 5, 6, 8, 10, 12, 15, 20, 25, 30, 40, 50, 75, 100, 150, 200, 300, 500, 1000, 2000, 5000),
    (1, 2, 3, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000),
    (1, 10, 100, 1000, 10000),
)


def log_axis(
    low: float, high: float, start: float, end: float, nice: Sequence[Sequence[float]]
) -> tuple[Place, list[float]]:
    """Return where a value lies between start and end, and the values to mark: the finest of some sets that
    has not too many, from at or below the lowest to at or above the highest.
    """
    ticks = _enclosing(low, high, nice)
    a, b = log10(min(low, ticks[0])) - 0.01, log10(max(high, ticks[-1])) + 0.01
    if b - a < 0.2:
        a, b = a - 0.1, b + 0.1

    def place(value: float) -> float:
        return start + (end - start) * (min(max(log10(value), a), b) - a) / (b - a)

    return place, ticks


def _enclosing(low: float, high: float, nice: Sequence[Sequence[float]]) -> list[float]:
    best: list[float] = []
    for values in nice:
        below = [v for v in values if v <= low * (1 + 1e-9)]
        above = [v for v in values if v >= high * (1 - 1e-9)]
        first, last = below[-1] if below else values[0], above[0] if above else values[-1]
        found = [float(v) for v in values if first <= v <= last]
        if 2 <= len(found) <= MOST_TICKS:
            return found
        if len(found) >= 2:
            best = found
    if not best:
        a, b = floor(log10(low)), max(ceil(log10(high)), floor(log10(low)) + 1)
        best = [10.0**k for k in range(a, b + 1)]
    every = ceil(len(best) / MOST_TICKS)
    return best[::every] if best[::every][-1] >= high else [*best[::every], best[-1]]


def make_plain_axis(
    low: float, high: float, start: float, end: float, nice: Sequence[float] = (25.0,)
) -> tuple[Place, list[float]]:
    """Return where a value lies between start and end on a plain axis, and the values to mark: in the finest
    of some steps that gives not too many, to the first that is not below the highest.
    """
    step = next((v for v in nice if (high - low) / v <= 6), nice[-1])
    ticks = [low + step * k for k in range(max(1, ceil((high - low) / step - 1e-9)) + 1)]

    def place(value: float) -> float:
        return start + (end - start) * (min(max(value, low), ticks[-1]) - low) / (ticks[-1] - low)

    return place, ticks


PLAIN_TIMES = (
    1.0,
    2.0,
    5.0,
    10.0,
    20.0,
    30.0,
    *(m * _MINUTE for m in (1, 2, 5, 10, 20, 30, 60, 120, 300, 600, 3000)),
)


def list_finite(values: Sequence[float | None]) -> list[float]:
    """Return those that a logarithmic axis can show."""
    return [v for v in values if v is not None and isfinite(v) and v > 0]
