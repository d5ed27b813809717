"""Compiled loops that arrange a graph's transitions for the exact search. Importing this imports numba.

They lie by their targets' classes and nearly by their costs, so that those nobody may take at a frame are
never looked at.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from metagraph.synthesis.kernels import compiled

Array = Any

STEPS = 64  # of costs


@compiled
def count_transitions(targets: Array, states: Any) -> Array:
    """Return `[F + 1]` where each state's transitions begin once they are turned round: states are numbered
    from the last one then.
    """
    out = np.zeros(states + 1, np.int64)
    for place in range(len(targets)):
        out[states - targets[place]] += 1
    for state in range(states):
        out[state + 1] += out[state]
    return out


@compiled
def turn_round(starts: Array, targets: Array, costs: Array, at: Array, out: Array, prices: Array) -> None:
    """Write the transitions turned round to out and prices `[E]`. at `[F]`: where each state's begin;
    changed.
    """
    states = len(starts) - 1
    for state in range(states):
        for place in range(starts[state], starts[state + 1]):
            row = states - 1 - targets[place]
            out[at[row]], prices[at[row]] = states - 1 - state, costs[place]
            at[row] += 1


@compiled
def arrange_by_class(
    starts: Array,
    targets: Array,
    costs: Array,
    classes: Array,
    count: Any,
    width: Any,
    out: Array,
    prices: Array,
    firsts: Array,
) -> None:
    """Write the transitions, each state's by class of target and step of cost, to out and prices `[E]`, which
    may be targets and costs themselves, and to firsts `[F (count + 1)]` where those of each source and class
    begin, and where the last end.

    classes `[F]`: of each state, -1 for one nobody may be in. width: of a step.
    """
    per, longest, states = np.float32(1 / width), 0, len(starts) - 1
    for state in range(states):
        longest = max(longest, starts[state + 1] - starts[state])
    rows = np.empty(longest, np.uint16)
    ends, paid = np.empty(longest, np.int32), np.empty(longest, np.float32)
    sizes = np.zeros((count + 1) * STEPS + 1, np.int32)
    begins = np.empty(len(classes), np.uint16)  # of a state's class; those nobody may be in come last
    for state in range(len(classes)):
        begins[state] = STEPS * (classes[state] if classes[state] >= 0 else count)
    for state in range(states):
        begin = starts[state]
        many = starts[state + 1] - begin
        own = state * (count + 1)
        if many == 0:
            for kind in range(count + 1):
                firsts[own + kind] = begin
            continue
        sizes[:] = 0
        for n in range(many):
            target, price = targets[begin + n], costs[begin + n]
            row = begins[target] + min(np.int32(STEPS - 1), np.int32(price * per))
            rows[n], ends[n], paid[n] = row, target, price
            sizes[row + 1] += 1
        for row in range(count * STEPS):
            sizes[row + 1] += sizes[row]
        for kind in range(count + 1):
            firsts[own + kind] = begin + sizes[kind * STEPS]
        for n in range(many):
            place = begin + sizes[rows[n]]
            out[place], prices[place] = ends[n], paid[n]
            sizes[rows[n]] += 1
