"""Compiled loops of the search that goes on while its motion plays. Importing this imports numba.

A way is a row of runs, frames of a take one after another. Any run is an answer by itself: it is followed to
where it has to end, and what it leaves out is counted. So there is an answer at every moment, and work that
is left makes it better.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from metagraph.synthesis.kernels import compiled_exactly

Array = Any


class KnownStates(NamedTuple):
    """What is known of states. kinds `[F]` uint8: bits of what was heard there. events `[F]` uint8: STRESS
    and EDGE. stops `[F]`: the first state behind a run that goes through each. recent `[F]` float32: 1 where
    it was shown a moment ago, less if that is longer ago.
    """

    kinds: Array
    events: Array
    stops: Array
    recent: Array


class Prices(NamedTuple):
    """What is to be shown, frame by frame `[n]`, and what it costs where it is not: of the graph's costs.

    allowed: bits of kinds; wrong: the price of others. window: which event is waited for, -1 for none;
    waits: its bit; unmet: the price of a frame in which it has not come yet. barred: bits of events that
    should not come; bar: their price.
    """

    allowed: Array
    wrong: Array
    window: Array
    waits: Array
    unmet: Array
    barred: Array
    bar: Array


@compiled_exactly
def _frame(t: Any, x: Any, met: Any, shown: Any, prices: Any, again: Any) -> Any:
    """Return what it costs to show a state in a frame, and whether the event of its window has come."""
    total = np.float32(0)
    if shown.kinds[x] & prices.allowed[t] == 0:
        total += prices.wrong[t]
    if shown.events[x] & prices.barred[t] != 0:
        total += prices.bar[t]
    total += again * shown.recent[x]
    if prices.window[t] >= 0:
        if t > 0 and prices.window[t] != prices.window[t - 1]:
            met = False
        if shown.events[x] & prices.waits[t] != 0:
            met = True
        if not met:
            total += prices.unmet[t]
    return total, met


@compiled_exactly
def _total(t: Any, x: Any, price: Any, met: Any, shown: Any, prices: Any, rules: Array) -> Any:
    """Return the price of a run that lands in a state at frame t and is not left again, and the frames it
    takes. rules: as `extend` has them.
    """
    frames = len(prices.allowed)
    after = min(frames, t + shown.stops[x] - x)
    for u in range(t, after):
        more, met = _frame(u, x + u - t, met, shown, prices, rules[0])
        price += more
    left = shown.stops[x] - (x + after - t)
    price += rules[1] * (frames - after) + rules[2] * max(0, np.int64(rules[3]) - left)
    return price, after - t


@compiled_exactly
def _noise(random: Any, number: Any) -> Any:
    """Return a number 0..1 that is almost drawn."""
    mixed = (random ^ np.uint64(number)) * np.uint64(0x9E3779B97F4A7C15)
    mixed ^= mixed >> np.uint64(29)
    mixed *= np.uint64(0xBF58476D1CE4E5B9)
    return np.float32(mixed >> np.uint64(40)) / np.float32(1 << 24)


@compiled_exactly
def extend_path(
    state: Any, since: Any, met: Any, links: Any, shown: Any, prices: Any, rules: Array, least: Any,
    tries: Any, work: Any, random: Any, lines: Array, nodes: Any,
) -> Any:  # fmt: skip
    """Go on from a state that is shown, cheaply: best first, until so much work is done.

    since: frames that its run lasts already. met: whether the event of the first frame's window has come.
    rules: prices of a frame shown again, of a frame left out, of a frame less than the next number that the
    last run could go on by itself, that number, and of chance. least: frames between two transitions, where
    a run does not end before. tries: transitions of a state by chance, beside its cheapest. work, nodes:
    frames and runs that are looked at, at most. lines `[F + n + 1]`: all infinite, and left so. Returns the
    states `[<= n]`, at least one where any follows, the price, the work done, and whether nothing was left
    to try.
    """
    frames = len(prices.allowed)
    parent, at = np.full(nodes, -1, np.int32), np.zeros(nodes, np.int32)
    own, price = np.zeros(nodes, np.int32), np.zeros(nodes, np.float32)
    mets, total = np.zeros(nodes, np.bool_), np.full(nodes, np.inf, np.float32)
    lengths, open_ = np.zeros(nodes, np.int32), np.zeros(nodes, np.bool_)
    touched = np.empty(nodes, np.int64)
    # The run that is shown: its last frame is the one before the first.
    at[0], own[0], mets[0], open_[0] = -1, state, met, True
    if state + 1 < shown.stops[state]:
        total[0], length = _total(0, state + 1, np.float32(0), met, shown, prices, rules)
        lengths[0] = length + 1
    else:
        total[0], lengths[0] = np.float32(1e30), 1
    made, done, best = 1, 0, 0
    touched[0] = state + 1 + frames
    lines[touched[0]] = total[0]
    while True:
        node, cheapest = -1, np.float32(np.inf)
        for n in range(made):
            if open_[n] and total[n] < cheapest:
                node, cheapest = n, total[n]
        if node < 0 or done >= work or made >= nodes:
            break
        open_[node] = False
        so_far, has = price[node], mets[node]
        for n in range(lengths[node]):
            u, x = at[node] + n, own[node] + n
            if u >= frames - 1:
                break
            if u >= 0:
                more, has = _frame(u, x, has, shown, prices, rules[0])
                so_far += more
                done += 1
            if so_far >= total[best] or done >= work:
                break
            ends = x + 1 >= shown.stops[x]
            lasted = n + 1 + (since - 1 if node == 0 else 0)
            if lasted < least and not ends:
                continue
            first, after = links.starts[x], links.starts[x + 1]
            step = max(1, (after - first + tries - 1) // tries)
            easy = links.firsts[x + 1] - links.firsts[x]
            first += np.int64(_noise(random, x) * step)
            for number in range(easy + max(0, (after - first + step - 1) // step)):
                place = (
                    links.cheap[links.firsts[x] + number] if number < easy else first + (number - easy) * step
                )
                target = links.targets[place]
                paid = so_far + links.costs[place] + rules[4] * _noise(random, target)
                if paid >= total[best] or made >= nodes:
                    continue
                whole, length = _total(u + 1, target, paid, has, shown, prices, rules)
                done += length
                line = target - u - 1 + frames
                if whole >= lines[line]:
                    continue
                touched[made] = line if lines[line] == np.inf else -1
                lines[line] = whole
                parent[made], at[made], own[made] = node, u + 1, target
                price[made], mets[made], total[made] = paid, has, whole
                lengths[made], open_[made] = length, length > 0
                if whole < total[best]:
                    best = made
                made += 1
    for n in range(made):
        if touched[n] >= 0:
            lines[touched[n]] = np.inf
    left = False
    for n in range(made):
        left = left or (open_[n] and total[n] < np.inf and price[n] < total[best])
    end = min(frames, at[best] + lengths[best])
    way = np.empty(max(0, end), np.int32)
    run = best
    while run >= 0:
        for u in range(max(0, at[run]), end):
            way[u] = own[run] + u - at[run]
        end = max(0, at[run])
        run = parent[run]
    return way, total[best], done, not left
