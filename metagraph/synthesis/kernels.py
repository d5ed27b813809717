"""Compiled loops of the motion graph. Importing this imports numba.

Costs are sums of lengths, so a pair whose partial sum is over the limit is done with: exact, and most pairs
end after a few joints when those that differ most come first. Targets lie in blocks of 64, `[block, term,
xyz, 64]`, so that the inner loop compiles to vectors.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from metagraph.common.compiling import find_compiler

Array = Any

LANES = 64  # wide enough that the loops cost little, narrow enough that most blocks end early
EVERY = 8  # terms between looks at whether a block is done with

compiled = find_compiler(nogil=True, fastmath=True, error_model="numpy")
compiled_exactly = find_compiler(
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
def _apart(one: Array, other: Array) -> Any:
    """Return how far terms `[3, T]` are from others."""
    total = np.float32(0)
    for t in range(one.shape[1]):
        u, v, w = one[0, t] - other[0, t], one[1, t] - other[1, t], one[2, t] - other[2, t]
        total += np.sqrt(u * u + v * v + w * w)
    return total


@compiled
def _spread(every: Array, middle: Array) -> Any:
    """Write the mean of terms `[N, 3, T]` to middle `[3, T]`; return how far the farthest is from it."""
    middle[:] = 0
    for n in range(len(every)):
        middle += every[n]
    middle /= np.float32(len(every))
    farthest = np.float32(0)
    for n in range(len(every)):
        farthest = max(farthest, _apart(every[n], middle))
    return farthest


@compiled
def lay(terms: Array, far: Any, blocks: Array, middles: Array, spread: Array) -> None:
    """Lay terms `[N, 3, T]` into blocks `[B, T, 3, 64]`, filled up with what is far, their means into middles
    `[B, 3, T]`, and how far the farthest of a block is from its own to spread `[B]`.
    """
    blocks[-1] = far
    for b in range(len(blocks)):
        some = terms[b * LANES : (b + 1) * LANES]
        for t in range(terms.shape[2]):
            for c in range(3):
                for n in range(len(some)):
                    blocks[b, t, c, n] = some[n, c, t]
        spread[b] = _spread(some, middles[b])


@compiled
def find_near(
    rows: Array,
    blocks: Array,
    middles: Array,
    reach: Array,
    count: int,
    limit: Any,
    places: Array,
    costs: Array,
    found: Array,
) -> None:
    """Find for rows `[R, 3, T]` the targets, of `count` in blocks `[B, T, 3, 64]`, that are at most `limit`
    away.

    Writes their numbers, ascending, to places `[R, count]`, what they cost to costs `[R, count]`, how many
    there are to found `[R]`. All rows are compared with a block while it is near at hand in memory, but those
    that are farther than its reach `[B]` from its middle, of middles `[B, 3, T]`: first all rows at once.
    """
    terms = rows.shape[2]
    total = np.empty(LANES, np.float32)
    middle = np.empty((3, terms), np.float32)
    spread = _spread(rows, middle)
    found[:] = 0
    for b in range(len(blocks)):
        if _apart(middle, middles[b]) > reach[b] + spread:
            continue
        block = blocks[b]
        first = b * LANES
        for r in range(len(rows)):
            row = rows[r]
            if _apart(row, middles[b]) > reach[b]:
                continue
            for n in range(LANES):
                total[n] = 0
            over = False
            for t in range(terms):
                _add(block[t, 0], block[t, 1], block[t, 2], row[0, t], row[1, t], row[2, t], total)
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
def pack_rows(
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
    """Return the targets and costs of the cheapest transitions of each row, as `pack_rows` returns them, of
    those that cost alike the first ones. counts `[R]`: how many a row has; becomes how many are left.
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
def cut_transitions(starts: Array, targets: Array, costs: Array, kept: Array) -> Array:
    """Leave of transitions, as `MotionGraph` has them, those from and to states that are kept `[F]`, in the
    memory where they are, and return where those of each state begin then `[F + 1]`.
    """
    states = len(starts) - 1
    begins = np.empty(states + 1, np.int64)
    at = 0
    for state in range(states):
        begins[state] = at
        if kept[state]:
            for place in range(starts[state], starts[state + 1]):
                target = targets[place]
                targets[at] = target
                costs[at] = costs[place]
                at += kept[target]
    begins[states] = at
    return begins


@compiled
def find_components(starts: Array, targets: Array, follows: Array) -> tuple[Array, int]:
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
