"""The fewest rectangles that make a machine's connections: a rectangle is an alias and what it leads to.

Sets of states are bits. A state never leads to itself, so what a rectangle says of that does not count.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import dataclass

from metagraph.research.study.machines.normal_machine import Pair

MOST_CANDIDATES = 4000


@dataclass(frozen=True, slots=True)
class Rectangle:
    """Every state of `sources` leads to every other state of `targets`."""

    sources: int
    targets: int


@dataclass(frozen=True)
class Cover:
    """rectangles: that make just the connections wanted. least: no cover has fewer."""

    rectangles: tuple[Rectangle, ...]
    least: int


def list_bits(of: int) -> list[int]:
    """Return the numbers in a set, ascending."""
    out = []
    while of:
        low = of & -of
        out.append(low.bit_length() - 1)
        of ^= low
    return out


def as_set(numbers: Iterable[int]) -> int:
    out = 0
    for n in numbers:
        out |= 1 << n
    return out


def find_target_sets(keys: Collection[str], pairs: Collection[Pair]) -> list[int]:
    """Return for each state, in the order of `keys`, the set it leads to."""
    place = {key: n for n, key in enumerate(keys)}
    out = [0] * len(place)
    for a, b in pairs:
        if a != b:
            out[place[a]] |= 1 << place[b]
    return out


def cover_by_rectangles(rows: list[int]) -> Cover:
    """Cover what each state leads to by rectangles, greedily the one that makes most new connections, and say
    how few there must be.

    Tried are the largest rectangles round what each state leads to, and round what two states share.
    """
    count = len(rows)
    kinds = {row | own for n, row in enumerate(rows) if row for own in (0, 1 << n)}
    shared = sorted(kinds)
    for n, a in enumerate(shared):
        if len(kinds) > MOST_CANDIDATES:
            break
        kinds.update(a & b for b in shared[n + 1 :] if a & b)
    candidates: dict[Rectangle, None] = {}
    for targets in sorted(kinds):
        sources = as_set(n for n, row in enumerate(rows) if row and targets & ~(1 << n) & ~row == 0)
        if sources:
            candidates[Rectangle(sources, targets)] = None
    left = list(rows)
    chosen: list[Rectangle] = []
    while any(left):
        best = max(
            candidates, key=lambda r: sum((left[n] & r.targets).bit_count() for n in list_bits(r.sources))
        )
        chosen.append(best)
        for n in list_bits(best.sources):
            left[n] &= ~best.targets
    return Cover(tuple(chosen), _apart(rows, count))


def _apart(rows: list[int], count: int) -> int:
    """Return how many connections can be named of which no two fit into one rectangle: each needs its own.

    Found greedily, so that it may be too few, never too many.
    """
    named: list[tuple[int, int]] = []

    def leads(a: int, b: int) -> bool:
        return a == b or bool(rows[a] >> b & 1)

    for a in range(count):
        for b in list_bits(rows[a]):
            if all(not (leads(a, d) and leads(c, b)) for c, d in named):
                named.append((a, b))
                break
    return len(named)
