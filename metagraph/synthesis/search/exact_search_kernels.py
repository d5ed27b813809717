"""Compiled loops of the exact search of a motion graph. Importing this imports numba.

States fall into classes: what a frame asks of a state, beside which one it is, is the same for a whole class.
Somewhere is a state, with or without the event met that is waited for: a number, state + F where it was met.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from metagraph.synthesis.kernels import compiled_exactly

Array = Any


@compiled_exactly
def foresee(codes: Array, costs: Array, crossing: Any, otherwise: Any, ahead: Array) -> Any:
    """Write to ahead `[2 F]` what it costs at least to go on from where one lands, found backwards for where
    codes say: `otherwise` is what it costs elsewhere. Return the least. crossing: whether the event that is
    waited for before is waited for after, too.
    """
    states, least = len(ahead) // 2, otherwise
    for n in range(len(codes)):
        met = codes[n] >= states
        state = 2 * states - 1 - codes[n] if met else states - 1 - codes[n]
        ahead[state + states] = min(ahead[state + states], costs[n])
        if met or not crossing:
            ahead[state] = min(ahead[state], costs[n])
        least = min(least, costs[n])
    return least


@compiled_exactly
def undo_foresight(codes: Array, otherwise: Any, ahead: Array) -> None:
    """Undo what `foresee` wrote."""
    states = len(ahead) // 2
    for n in range(len(codes)):
        state = (2 * states - 1 - codes[n]) % states
        ahead[state] = ahead[state + states] = otherwise


@compiled_exactly
def with_paid(cost: Array, alive: Array, paid: Array, bound: Any, whole: Array) -> Any:
    """Write to whole `[2 F]` what ways cost with what they paid along their takes `[F]`, and leave only those
    alive that are within the bound; return how many.
    """
    states, number = len(paid), 0
    for n in range(len(alive)):
        code = alive[n]
        total = cost[code] + np.float32(paid[code % states])
        if total <= bound:
            whole[code] = total
            alive[number] = code
            number += 1
        else:
            cost[code] = np.inf
    return number


@compiled_exactly
def weigh(cost: Array, alive: Array, starts: Array, reach: Any, width: Any) -> Any:
    """Return how many transitions leave those who cost no more than `reach`, and how many of these have
    transitions and cost hardly more than the cheapest of them: less than `width`.
    """
    states = len(starts) - 1
    total, low, least = 0, 0, np.float32(np.inf)
    for n in range(len(alive)):
        code = alive[n]
        state = code - states if code >= states else code
        some = starts[state + 1] - starts[state]
        if some > 0 and cost[code] <= reach:
            total += some
            least = min(least, cost[code])
    for n in range(len(alive)):
        code = alive[n]
        state = code - states if code >= states else code
        low += cost[code] <= least + width and starts[state + 1] > starts[state]
    return total, low


@compiled_exactly
def find_least(cost: Array, alive: Array, classes: Array, count: Any) -> Array:
    """Return `[2, C]` what the cheapest of each class costs, without and with the event met; infinite if
    nobody is. classes `[F]`: of states.
    """
    states = len(classes)
    out = np.full((2, count), np.inf, np.float32)
    for n in range(len(alive)):
        met = 1 if alive[n] >= states else 0
        kind = classes[alive[n] - met * states]
        out[met, kind] = min(out[met, kind], cost[alive[n]])
    return out


@compiled_exactly
def leap(
    cost: Array,
    alive: Array,
    landed: Array,
    sources: Array,
    reached: Array,
    firsts: Array,
    targets: Array,
    costs: Array,
    fitting: Array,
    count: Any,
    fits: Array,
    least: Any,
    ahead: Array,
    foreseen: Any,
    reach: Any,
    bound: Any,
    width: Any,
) -> Any:
    """Jump from where somebody is: landed `[2 F]` what the cheapest way to jump there costs, sources `[2 F]`
    where it comes from. Where nobody landed before it is infinite; reached gets those that are not any more.
    Return how many there are, and what the cheapest way all through costs that was seen to go on from one.

    firsts, targets, costs: as `arranged` writes them, of so many classes, in steps of such a width; fitting:
    those of which states fit. fits `[F]`, least: for how many frames a take goes on to fit, and has to. ahead
    `[2 F + 1]`: what going on costs at least, known where it is below its last one; foreseen: whether any is.
    reach: what nobody may cost more than by then, with the jump; bound: with what is ahead.
    """
    states, number, through = len(fits), 0, np.float32(np.inf)
    unknown = ahead[2 * states]
    for n in range(len(alive)):
        code = alive[n]
        so_far = cost[code]
        left = reach - so_far
        if not left >= 0:
            continue
        side = states if code >= states else 0
        own = (code - side) * (count + 1)
        for kind in fitting:
            for place in range(firsts[own + kind], firsts[own + kind + 1]):
                price = costs[place]
                if price > left:
                    if price > left + width:
                        break
                    continue
                target = side + targets[place]
                total = so_far + price
                if total > landed[target] or fits[target - side] < least:
                    continue
                if foreseen:
                    rest = ahead[target]
                    if rest < unknown:
                        through = min(through, total + rest)
                    if total + rest > bound:
                        continue
                if total < landed[target]:
                    if landed[target] == np.inf:
                        reached[number] = target
                        number += 1
                    landed[target], sources[target] = total, code
                elif code < sources[target]:
                    sources[target] = code
    return number, through


@compiled_exactly
def draw_leap(
    cost: Array,
    lowest: Any,
    landed: Array,
    sources: Array,
    reached: Array,
    entered: Array,
    firsts: Array,
    targets: Array,
    costs: Array,
    leaving: Array,
    count: Any,
    fits: Array,
    first: Array,
    least: Any,
    ahead: Array,
    bound: Any,
    width: Any,
    cheapest: Any,
) -> Any:
    """Return and write what `leap` does, looking from where one may land for the cheapest way there: sooner
    where many cost the least.

    cost `[2 F]`: infinite if nobody is. lowest `[2, C]`: what nobody of a class is below, without and with
    the event met. entered: states that jumps lead to. firsts, targets, costs: as `arranged` writes the
    transitions turned round; leaving: the classes of states that fitted a frame before. first `[F]`: whether
    a state is the first of its take. cheapest: what a transition costs at least. Whoever comes along the take
    no dearer needs no jump.
    """
    states, number, through = len(fits), 0, np.float32(np.inf)
    unknown = ahead[2 * states]
    floors, order = np.full(2, np.inf, np.float32), np.empty((2, len(leaving)), np.int64)
    for met in range(2):
        own = lowest[met][leaving]
        order[met] = leaving[np.argsort(own)]  # the class with the cheapest first: it cuts the others short
        for n in range(len(own)):
            floors[met] = min(floors[met], own[n])
    for state in entered:
        if fits[state] < least:
            continue
        own = (states - 1 - state) * (count + 1)
        for met in range(2):
            floor = floors[met]
            target = state + met * states
            rest = ahead[target]
            follows = np.float32(np.inf) if first[state] else cost[target - 1]
            if floor + cheapest >= follows or not floor + cheapest + rest <= bound:
                continue
            best, source = min(follows, bound - rest), -1
            for kind in order[met]:
                floor = lowest[met, kind]
                for place in range(firsts[own + kind], firsts[own + kind + 1]):
                    price = costs[place]
                    if floor + price > best:
                        if floor + price > best + width:
                            break
                        continue
                    code = target - state + states - 1 - targets[place]
                    total = cost[code] + price
                    if total < best or (total == best and total < follows and (source < 0 or code < source)):
                        best, source = total, code
            if source >= 0:
                landed[target], sources[target] = best, source
                reached[number] = target
                number += 1
                if rest < unknown:
                    through = min(through, best + rest)
    return number, through


@compiled_exactly
def land(landed: Array, reached: Array, before: Array) -> None:
    """Take off what was paid before by who came along the take `[F]`."""
    for n in range(len(reached)):
        landed[reached[n]] -= np.float32(before[reached[n] % len(before)])


@compiled_exactly
def follow_takes(
    cost: Array,
    alive: Array,
    then: Array,
    living: Array,
    back: Array,
    fits: Array,
    meets: Array,
    classes: Array,
    first: Array,
    bound: Any,
) -> Any:
    """Go one frame on along the takes: cost `[2 F]`, what the cheapest way costs to where somebody is, goes
    to then `[2 F]` and is infinite again, as then is before; who is alive to living. Return how many are.

    back `[2 F]`: where a way comes from. fits `[F]`: 0 where a state does not. meets `[C]`: which classes
    are the event of the open window. bound: what no way may cost more than.
    """
    states, number = len(fits), 0
    for n in range(len(alive)):
        code = alive[n]
        total, met = cost[code], code >= states
        cost[code] = np.inf
        state = code % states + 1
        if state == states or first[state] or fits[state] == 0 or not total <= bound:
            continue
        into = state + states if met or meets[classes[state]] else state
        if total < then[into] or (total == then[into] and not met):
            if then[into] == np.inf:
                living[number] = into
                number += 1
            then[into], back[into] = total, code
    return number


@compiled_exactly
def arrive(
    landed: Array,
    sources: Array,
    reached: Array,
    frames: Any,
    cost: Array,
    alive: Array,
    number: Any,
    back: Array,
    runs: Array,
    pieces: Array,
    upcoming: Array,
) -> Any:
    """Bring those who jumped `frames` frames ago to where they are now: they may jump again. Return how many
    are alive.

    landed, sources, reached: as `leap` writes them; cost, alive, back as `follow` does, back here -1 - where
    the jump came from, and runs `[2 F]` how many frames ago it landed there. pieces `[n, 4]`: of each window
    among these frames the first and the last, counted from the landing, its row of upcoming `[2, F]` (the
    next state that is such an event, from each on), and whether it was open before.
    """
    states = len(cost) // 2
    for before in range(2):  # in this order: the first of those that cost the same counts
        for n in range(len(reached)):
            code = reached[n]
            state = code % states
            end = state + frames - 1
            if (code >= states) != before or end >= states:
                continue
            met, dead = before == 1, False
            for m in range(len(pieces)):
                hit = upcoming[pieces[m, 2], state + pieces[m, 0]] <= state + pieces[m, 1]
                met = hit or (met and pieces[m, 3] == 1)
                if pieces[m, 1] < frames - 1:  # it closes on the way
                    dead = dead or not met
                    met = False
            into = end + states if met and len(pieces) > 0 else end
            total = landed[code]
            if not dead and total < cost[into]:
                if cost[into] == np.inf:
                    alive[number] = into
                    number += 1
                cost[into], back[into], runs[into] = total, -1 - sources[code], frames
    return number


@compiled_exactly
def close(cost: Array, alive: Array, back: Array, runs: Array) -> Any:
    """Forget ways on which the event was not met whose window ends; the others begin again. Return how many
    are alive.
    """
    states, number = len(cost) // 2, 0
    for n in range(len(alive)):
        if alive[n] < states:
            cost[alive[n]] = np.inf
    for n in range(len(alive)):
        code = alive[n]
        if code >= states:
            into = code - states
            cost[into], cost[code] = cost[code], np.inf
            back[into], runs[into] = back[code], runs[code]
            alive[number] = into
            number += 1
    return number
