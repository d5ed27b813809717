"""Compiled loops of the exact search of a motion graph. Importing this imports numba.

States fall into classes: what a frame asks of a state, beside which one it is, is the same for a whole class.
Transitions lie by their targets' classes and nearly by their costs, so that those nobody may take at a frame
are never looked at.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from metagraph.synthesis.kernels import compiled, compiled_exactly

Array = Any

STEPS = 4  # of costs


@compiled
def arranged(starts: Array, targets: Array, costs: Array, classes: Array, count: Any, bound: Any) -> Any:
    """Return the transitions that cost no more than `bound`, by source, class of target and step of cost:
    firsts `[F count + 1]`, where those of each source and class begin; targets; costs.

    classes `[F]`: of each state, -1 for one nobody may be in.
    """
    states = len(starts) - 1
    per = STEPS / bound if bound > 0 else 0.0
    firsts = np.zeros(states * count + 1, np.int64)
    total = 0
    for state in range(states):
        for place in range(starts[state], starts[state + 1]):
            total += costs[place] <= bound and classes[targets[place]] >= 0
    out, prices = np.empty(total, np.int32), np.empty(total, np.float32)
    sizes = np.zeros(count * STEPS + 1, np.int64)
    at = 0
    for state in range(states):
        sizes[:] = 0
        for place in range(starts[state], starts[state + 1]):
            kind = classes[targets[place]]
            if costs[place] <= bound and kind >= 0:
                sizes[kind * STEPS + min(STEPS - 1, int(costs[place] * per)) + 1] += 1
        sizes[0] = at
        for n in range(count * STEPS):
            sizes[n + 1] += sizes[n]
        for kind in range(count):
            firsts[state * count + kind] = sizes[kind * STEPS]
        at = sizes[count * STEPS]
        for place in range(starts[state], starts[state + 1]):
            kind = classes[targets[place]]
            if costs[place] <= bound and kind >= 0:
                row = kind * STEPS + min(STEPS - 1, int(costs[place] * per))
                out[sizes[row]], prices[sizes[row]] = targets[place], costs[place]
                sizes[row] += 1
    firsts[states * count] = at
    return firsts, out, prices


@compiled
def look_ahead(
    after: Array, fits: Array, only: Array, classes: Array, first: Array, most: Any, out: Array
) -> None:
    """Write for how many frames, at most so many, a state's take fits from a frame on, to out `[F]`. after
    `[F]`: the same a frame later. fits `[C]`: which classes fit at the frame. only `[F]`: the states that
    alone do, empty for all. first `[F]`: whether a state is the first of its take.
    """
    states = len(classes)
    for state in range(states):
        ahead = 0
        if classes[state] >= 0 and fits[classes[state]] and (len(only) == 0 or only[state]):
            ahead = 1
            if state + 1 < states and not first[state + 1]:
                ahead += after[state + 1]
        out[state] = min(ahead, most)


@compiled_exactly
def follow(
    cost: Array, back: Array, ahead: Array, meets: Array, classes: Array, first: Array, bound: Any
) -> None:
    """Go one frame on along the takes. cost `[2, F]`: what the cheapest way to a state costs, without and
    with the event of the open window met; afterwards that of the next frame. back `[2, F]`: where it comes
    from, 2 state + met. ahead `[F]`: 0 where a state does not fit. meets `[C]`: which classes are that event.
    bound: what no way may cost more than.
    """
    for state in range(cost.shape[1] - 1, -1, -1):
        none = ahead[state] == 0 or first[state]
        without = np.float32(np.inf) if none else cost[0, state - 1]
        having = np.float32(np.inf) if none else cost[1, state - 1]
        if not without <= bound:
            without = np.float32(np.inf)
        if not having <= bound:
            having = np.float32(np.inf)
        cost[0, state] = cost[1, state] = np.inf
        if without < np.inf or having < np.inf:
            if meets[classes[state]]:
                cost[1, state] = min(without, having)
                back[1, state] = 2 * (state - 1) + (0 if without <= having else 1)
            else:
                cost[0, state], cost[1, state] = without, having
                back[0, state], back[1, state] = 2 * (state - 1), 2 * (state - 1) + 1


@compiled_exactly
def living(cost: Array, firsts: Array, count: Any, bound: Any, out: Array) -> Any:
    """Write who costs no more than the bound to out `[2 F]`, state + met F; return how many there are, and
    after how many of them half of their transitions have come.
    """
    states, number, total = cost.shape[1], 0, 0
    for met in range(2):
        for state in range(states):
            if cost[met, state] <= bound and cost[met, state] < np.inf:
                out[number] = state + met * states
                number += 1
                total += firsts[(state + 1) * count] - firsts[state * count]
    half, some = 0, 0
    while half < number and 2 * some < total:
        state = out[half] % states
        some += firsts[(state + 1) * count] - firsts[state * count]
        half += 1
    return number, half


@compiled_exactly
def leap(
    cost: Array,
    alive: Array,
    landed: Array,
    sources: Array,
    firsts: Array,
    targets: Array,
    costs: Array,
    fitting: Array,
    count: Any,
    ahead: Array,
    least: Any,
    bound: Any,
    width: Any,
) -> None:
    """Jump from states that are alive: landed `[2, F]` what the cheapest way to jump into a state costs,
    without and with the event met that was waited for before; sources `[2, F]`: where it comes from, 2 state
    + met. firsts, targets, costs: as `arranged` returns them, of so many classes; fitting: those of which
    states fit. ahead, least: for how many frames a take goes on to fit, and has to. width: of a step of
    costs.
    """
    landed[:] = np.inf
    states = cost.shape[1]
    for n in range(len(alive)):
        met, state = alive[n] // states, alive[n] % states
        so_far = cost[met, state]
        left = bound - so_far
        for kind in fitting:
            for place in range(firsts[state * count + kind], firsts[state * count + kind + 1]):
                if costs[place] > left:
                    if costs[place] > left + width:
                        break
                    continue
                target = targets[place]
                total = so_far + costs[place]
                if ahead[target] >= least and total < landed[met, target]:
                    landed[met, target] = total
                    sources[met, target] = 2 * state + met


@compiled_exactly
def merge(landed: Array, sources: Array, others: Array, theirs: Array) -> None:
    """Take what others `[2, F]` reached more cheaply."""
    for met in range(2):
        for state in range(landed.shape[1]):
            if others[met, state] < landed[met, state]:
                landed[met, state] = others[met, state]
                sources[met, state] = theirs[met, state]


@compiled_exactly
def arrive(
    landed: Array,
    sources: Array,
    frames: Any,
    cost: Array,
    back: Array,
    runs: Array,
    pieces: Array,
    upcoming: Array,
) -> None:
    """Bring those who jumped `frames` frames ago to where they are now: they may jump again.

    cost, back `[2, F]` as `follow` has them, back here -1 - (2 state + met) of where the jump came from, and
    runs `[2, F]` how many frames ago it landed there. pieces `[n, 4]`: of each window among these frames the
    first and the last, counted from the landing, its row of upcoming `[2, F]` (the next state that is such an
    event, from each on), and whether it was open before.
    """
    for state in range(landed.shape[1] - frames + 1):
        if not (landed[0, state] < np.inf or landed[1, state] < np.inf):
            continue
        end = state + frames - 1
        for before in range(2):
            total = landed[before, state]
            if not total < np.inf:
                continue
            met, dead = before == 1, False
            for n in range(len(pieces)):
                hit = upcoming[pieces[n, 2], state + pieces[n, 0]] <= state + pieces[n, 1]
                met = hit or (met and pieces[n, 3] == 1)
                if pieces[n, 1] < frames - 1:  # it closes on the way
                    dead = dead or not met
                    met = False
            if len(pieces) == 0:
                met = False
            into = 1 if met else 0
            if not dead and total < cost[into, end]:
                cost[into, end] = total
                back[into, end] = -1 - sources[before, state]
                runs[into, end] = frames
