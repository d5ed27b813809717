"""Compiled loops of the motion graph. Importing this imports numba.

Costs are sums of lengths, so a pair whose partial sum is over the limit is done with: exact, and most pairs
end after a few joints when those that differ most come first. Targets lie in blocks of 64, `[block, term,
xyz, 64]`, so that the inner loop compiles to vectors.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from metagraph.compiling import compiler

Array = Any

LANES = 64  # wide enough that the loops cost little, narrow enough that most blocks end early
EVERY = 4  # terms between looks at whether a block is done with

compiled = compiler(nogil=True, fastmath=True, error_model="numpy")
compiled_exactly = compiler(
    nogil=True, error_model="numpy"
)  # where infinite means out of reach: fast arithmetic takes it that nothing is


@compiled
def _add(x: Array, y: Array, z: Array, a: Any, b: Any, c: Any, total: Array) -> None:
    """Add how far points `[64]` are from one point to the totals `[64]`. Over whole rows of memory, else it
    is not made of vectors.
    """
    for n in range(len(total)):
        u, v, w = x[n] - a, y[n] - b, z[n] - c
        total[n] += np.sqrt(u * u + v * v + w * w)


@compiled
def _least(total: Array) -> Any:
    least = total[0]
    for n in range(len(total)):
        least = min(least, total[n])
    return least


@compiled
def near(
    rows: Array, blocks: Array, count: int, limit: Any, places: Array, costs: Array, found: Array
) -> None:
    """Find for rows `[R, T, 3]` the targets, of `count` in blocks `[B, T, 3, 64]`, that are at most `limit`
    away.

    Writes their numbers, ascending, to places `[R, count]`, what they cost to costs `[R, count]`, how many
    there are to found `[R]`. All rows are compared with a block while it is near at hand in memory.
    """
    terms = rows.shape[1]
    total = np.empty(LANES, np.float32)
    found[:] = 0
    for b in range(len(blocks)):
        block = blocks[b]
        first = b * LANES
        for r in range(len(rows)):
            for n in range(LANES):
                total[n] = 0
            over = False
            row = rows[r]
            for t in range(terms):
                _add(block[t, 0], block[t, 1], block[t, 2], row[t, 0], row[t, 1], row[t, 2], total)
                if t % EVERY == EVERY - 1 and _least(total) > limit:
                    over = True
                    break
            if over:
                continue
            at = found[r]
            for n in range(LANES):
                if total[n] <= limit and first + n < count:
                    places[r, at] = first + n
                    costs[r, at] = total[n]
                    at += 1
            found[r] = at


@compiled
def pack(
    places: Array, costs: Array, found: Array, into: Array, rows: Array, counts: Array
) -> tuple[Array, Array]:
    """Return the targets and costs of rows as `near` found them, one row after another, without the state
    that follows a row's own.

    into `[count]`: which states the numbers stand for. rows `[R]`: the rows' own states. counts `[R]` becomes
    how many each row has.
    """
    targets, packed = np.empty(found.sum(), np.int32), np.empty(found.sum(), np.float32)
    at = 0
    for r in range(len(rows)):
        first = at
        for n in range(found[r]):
            target = into[places[r, n]]
            if target != rows[r] + 1:
                targets[at] = target
                packed[at] = costs[r, n]
                at += 1
        counts[r] = at - first
    return targets[:at].copy(), packed[:at].copy()


@compiled
def thin(counts: Array, targets: Array, costs: Array, most: Any) -> tuple[Array, Array]:
    """Return the targets and costs of the cheapest transitions of each row, as `pack` returns them, of those
    that cost alike the first ones. counts `[R]`: how many a row has; becomes how many are left.
    """
    ends, price = np.empty(len(targets), np.int32), np.empty(len(costs), np.float32)
    at = first = 0
    for r in range(len(counts)):
        after = first + counts[r]
        if counts[r] <= most:
            dear, alike = np.float32(np.inf), 0
        else:
            dear = np.sort(costs[first:after])[most - 1]  # to part them would take longer to compile
            alike = most
            for place in range(first, after):
                alike -= costs[place] < dear
        for place in range(first, after):
            same = costs[place] == dear
            if costs[place] < dear or (same and alike > 0):
                ends[at] = targets[place]
                price[at] = costs[place]
                at += 1
                alike -= same
        first, counts[r] = after, min(counts[r], most)
    return ends[:at].copy(), price[:at].copy()


@compiled
def cut(starts: Array, targets: Array, costs: Array, kept: Array) -> tuple[Array, Array, Array]:
    """Return transitions, as `MotionGraph` has them, from and to states that are kept `[F]`."""
    states = len(starts) - 1
    begins = np.zeros(states + 1, np.int64)
    for state in range(states):
        count = 0
        if kept[state]:
            for place in range(starts[state], starts[state + 1]):
                count += kept[targets[place]]
        begins[state + 1] = begins[state] + count
    ends, price = np.empty(begins[-1], np.int32), np.empty(begins[-1], np.float32)
    for state in range(states):
        if kept[state]:
            at = begins[state]
            for place in range(starts[state], starts[state + 1]):
                if kept[targets[place]]:
                    ends[at] = targets[place]
                    price[at] = costs[place]
                    at += 1
    return begins, ends, price


@compiled
def components(starts: Array, targets: Array, follows: Array) -> tuple[Array, int]:
    """Return which strongly connected component each state is of, and how many there are (Tarjan, without
    recursion).

    starts `[F + 1]`: where each state's targets begin in `targets [E]`. follows `[F]`: whether a state is
    followed by the next one.
    """
    states = len(starts) - 1
    index = np.full(states, -1, np.int32)
    low = np.zeros(states, np.int32)
    on = np.zeros(states, np.bool_)
    component = np.full(states, -1, np.int32)
    stack = np.empty(states, np.int32)
    path = np.empty(states, np.int32)
    at = np.empty(
        states, np.int64
    )  # the next target to look at; starts - 1 stands for the state that follows
    high = depth = number = made = 0
    for root in range(states):
        if index[root] >= 0:
            continue
        path[0] = root
        depth = 1
        index[root] = low[root] = number
        number += 1
        stack[high] = root
        high += 1
        on[root] = True
        at[root] = starts[root] - 1
        while depth > 0:
            state = path[depth - 1]
            deeper = False
            while at[state] < starts[state + 1]:
                place = at[state]
                at[state] += 1
                if place < starts[state]:
                    if not follows[state]:
                        continue
                    target = state + 1
                else:
                    target = targets[place]
                if index[target] < 0:
                    path[depth] = target
                    depth += 1
                    index[target] = low[target] = number
                    number += 1
                    stack[high] = target
                    high += 1
                    on[target] = True
                    at[target] = starts[target] - 1
                    deeper = True
                    break
                if on[target] and index[target] < low[state]:
                    low[state] = index[target]
            if deeper:
                continue
            if low[state] == index[state]:
                while True:
                    high -= 1
                    other = stack[high]
                    on[other] = False
                    component[other] = made
                    if other == state:
                        break
                made += 1
            depth -= 1
            if depth > 0:
                above = path[depth - 1]
                if low[state] < low[above]:
                    low[above] = low[state]
    return component, made
