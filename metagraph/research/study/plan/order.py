"""Who does what in which order: counterbalanced by Latin squares, the same for a participant's number and
seed for ever.

Williams, E. J. (1949), "Experimental designs balanced for the estimation of residual effects of treatments",
Australian Journal of Scientific Research 2: in his squares each treatment is as often in each place, and as
often right after each other one.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeVar

T = TypeVar("T")
_MASK = 0xFFFFFFFF


def make_williams_design(count: int) -> tuple[tuple[int, ...], ...]:
    """Return a Williams design for `count` treatments 0..count-1: `count` rows, twice as many where `count`
    is odd (and above 1).

    Raises ValueError for fewer than one.
    """
    if count < 1:
        raise ValueError("an order needs at least one treatment")
    first = [0]
    for step in range(1, count):
        first.append((step + 1) // 2 if step % 2 else count - step // 2)
    rows = [tuple((x + row) % count for x in first) for row in range(count)]
    return tuple(rows if count % 2 == 0 or count == 1 else [*rows, *(row[::-1] for row in rows)])


def order_conditions(
    conditions: Sequence[T], tasks: Sequence[T], number: int, seed: int
) -> tuple[tuple[T, tuple[T, ...]], ...]:
    """Return a participant's conditions in order, each with its tasks in order. number: 0, 1, 2 ... of the
    participant.

    Within a participant the order of the tasks goes on from one condition to the next, so that two
    participants in a row already have each of two tasks as often first in each condition.
    """
    tried = tuple(shuffle_by_seed(conditions, seed))
    worked = tuple(shuffle_by_seed(tasks, seed ^ 0x5BD1E995))
    rows, orders = make_williams_design(len(tried)), make_williams_design(len(worked))
    blocks = [tried[x] for x in rows[number % len(rows)]]
    turn = number // len(rows)
    return tuple(
        (condition, tuple(worked[x] for x in orders[(turn + place) % len(orders)]))
        for place, condition in enumerate(blocks)
    )


def shuffle_by_seed(items: Sequence[T], seed: int) -> list[T]:
    """Return the items in an order that depends on the seed alone, by 32-bit integers: the same on every
    machine and version.
    """
    out = list(items)
    state = seed & _MASK
    for last in range(len(out) - 1, 0, -1):
        state = (state + 0x9E3779B9) & _MASK
        mixed = state
        for shift, factor in ((16, 0x85EBCA6B), (13, 0xC2B2AE35)):
            mixed = ((mixed ^ (mixed >> shift)) * factor) & _MASK
        mixed ^= mixed >> 16
        other = mixed % (last + 1)
        out[last], out[other] = out[other], out[last]
    return out
