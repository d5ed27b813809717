"""Compiled loops of the greedy search. Importing this imports numba.

A way through the graph is a row of runs: frames of a take, one after another, until a transition. How far a
run goes along with the speech is looked up, not walked, so that a great many transitions can be tried.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from metagraph.synthesis.kernels import compiled, compiled_exactly

Array = Any


class WantedSpeech(NamedTuple):
    """What is wanted, as runs look it up. Stretches `[S]` are frames that want the same.

    stretch `[T]`: which one a frame is in. ends `[S]`: the frame after each. rows `[S]`: its row of until
    `[M, F]`: the first state from each on, itself included, that does not go with it, or is past the take.
    stressed, closing `[S]`: whether an event is to be met in it, and by its end. stresses `[T]`, closes
    `[T]`: the same of frames. events `[S]`: which one, a row of peak_at `[2, F]`: the first state with such
    an event from each on. stops `[F]`: the end of its take.
    """

    stretch: Array
    ends: Array
    rows: Array
    until: Array
    stressed: Array
    closing: Array
    stresses: Array
    closes: Array
    events: Array
    peak_at: Array
    stops: Array


class Links(NamedTuple):
    """The transitions of a graph, and of each state its few cheapest: places `cheap[firsts[f]:firsts[f +
    1]]`, cheapest first.
    """

    starts: Array
    targets: Array
    costs: Array
    firsts: Array
    cheap: Array


class Charges(NamedTuple):
    """What frames cost beside transitions. rows `[T]` int32: which row a frame is charged by, -1 for none;
    ends `[T]`: the first frame after it that is charged by another. sums `[R, F + 1]`: what the states before
    each cost together. Where nothing is charged there is no row.
    """

    rows: Array
    ends: Array
    sums: Array


@compiled
def charge_frames(t: Any, after: Any, state: Any, charges: Any) -> Any:
    """Return what the frames t .. after - 1 cost of a run that is in a state at frame t."""
    total = 0.0
    while t < after:
        count = min(after, charges.ends[t]) - t
        row = charges.rows[t]
        if row >= 0:
            total += charges.sums[row, state + count] - charges.sums[row, state]
        t += count
        state += count
    return np.float32(total)


@compiled
def find_next_until(fits: Array, last: Array) -> Array:
    """Return `[F]` the first state from each on, itself included, that does not fit, or is past the take."""
    out = np.empty(len(fits), np.int32)
    end = len(fits)
    for state in range(len(fits) - 1, -1, -1):
        if last[state]:
            end = state + 1
        if not fits[state]:
            end = state
        out[state] = end
    return out


@compiled
def find_next_marked(marked: Array) -> Array:
    """Return `[F]` the first marked state from each on, itself included; F if there is none."""
    out = np.empty(len(marked), np.int32)
    at = len(marked)
    for state in range(len(marked) - 1, -1, -1):
        if marked[state]:
            at = state
        out[state] = at
    return out


@compiled
def find_cheapest(starts: Array, costs: Array, most: Any) -> Any:
    """Return firsts and cheap, as `Links` has them, of at most so many transitions a state."""
    firsts = np.zeros(len(starts), np.int64)
    for state in range(len(starts) - 1):
        firsts[state + 1] = firsts[state] + min(most, starts[state + 1] - starts[state])
    places = np.empty(firsts[-1], np.int64)
    for state in range(len(starts) - 1):
        first, count = firsts[state], 0
        for place in range(starts[state], starts[state + 1]):
            if count == most and costs[place] >= costs[places[first + most - 1]]:
                continue
            at = count if count < most else most - 1
            while at > 0 and costs[places[first + at - 1]] > costs[place]:
                places[first + at] = places[first + at - 1]
                at -= 1
            places[first + at] = place
            if count < most:
                count += 1
    return firsts, places


@compiled
def reach(t: Any, state: Any, met: Any, speech: Any) -> Any:
    """Return the frame up to which a run goes along with the speech that is in a state at frame t: by then it
    has to be left.
    """
    stop = speech.stops[state]
    for k in range(speech.stretch[t], len(speech.ends)):
        whole = speech.ends[k] - t
        length = min(whole, speech.until[speech.rows[k], state] - state)
        if speech.stressed[k]:
            met = met or speech.peak_at[speech.events[k], state] < state + length
            if length == whole and speech.closing[k]:
                if not met:
                    return speech.ends[k] - 1
                met = False
        t += length
        state += length
        if length < whole or state >= stop:
            return t
    return t


@compiled
def _met(t: Any, after: Any, state: Any, met: Any, speech: Any) -> Any:
    """Return whether, before frame `after`, a run that is in a state at frame t has met a stress whose window
    is still open.
    """
    if not speech.stresses[after - 1] or speech.closes[after - 1]:
        return False
    for frame in range(t, after):
        if speech.stresses[frame]:
            x = state + frame - t
            row = speech.events[speech.stretch[frame]]
            met = not speech.closes[frame] and (met or speech.peak_at[row, x] == x)
    return met


@compiled
def _more(values: Array) -> Array:
    """Return an array with room for twice as many. By hand: a slice that is set takes seconds to compile."""
    out = np.empty(2 * len(values), values.dtype)
    for n in range(len(values)):
        out[n] = values[n]
    return out


@compiled
def _more_rows(rows: Array) -> Array:
    out = np.empty((2 * len(rows), rows.shape[1]), rows.dtype)
    for n in range(len(rows)):
        for k in range(rows.shape[1]):
            out[n, k] = rows[n, k]
    return out


@compiled
def _next(random: Any) -> Any:
    return random * np.uint64(6364136223846793005) + np.uint64(1442695040888963407)


@compiled_exactly
def _note(
    run: Any,
    cost: Any,
    t: Any,
    state: Any,
    far: Any,
    end: Any,
    met: Any,
    count: Any,
    found: Array,
    price: Array,
    best: Any,
) -> Any:
    """Write down what came through, if it is the cheapest that ends in its state; return how many there
    are.
    """
    key = 2 * end + met
    place = best[key]
    if place < 0:
        place = best[key] = count
        count += 1
    elif price[place] <= cost:
        return count
    price[place] = cost
    found[place, 0], found[place, 1], found[place, 2], found[place, 3], found[place, 4] = (
        run,
        t,
        state,
        far,
        key,
    )
    return count


@compiled_exactly
def search_segment(
    t0: Any, t1: Any, at: Array, own: Array, price: Array, mets: Array, links: Any, speech: Any, charges: Any,
    best: Array, saved: Any, branches: Any, tries: Any, deepest: Any, least: Any, random: Any,
) -> Any:  # fmt: skip
    """Find ways through the frames t0 .. t1 - 1 of one segment from runs that are kept, depth first.

    Runs `[N]`: since when (at), in which state (own), at what cost before t0, or before they came (price),
    and whether an open event was met by t0 (mets). best `[2 F]`: all -1, and left so. least: frames between
    two transitions. Returns all runs, given ones first: what each branches off, at, own, price; and what came
    through: `[C, 5]` int32 the run it branches off at a frame in a state (frame -1: it is that run itself),
    how far it goes, 2 x its last state + met; its cost `[C]`; and the next random number.
    """
    made = given = len(at)
    paying = len(charges.sums) > 0
    off = np.full(given, -1, np.int32)
    level = np.zeros(given, np.int32)
    found, paid, count = np.empty((1024, 5), np.int32), np.empty(1024, np.float32), 0
    bound, check = np.float32(np.inf), 4 * saved
    stack = np.empty((deepest + 1) * branches + 2, np.int32)
    pick, pick_price, score = (
        np.empty((branches, 3), np.int32),
        np.empty(branches, np.float32),
        np.empty(branches, np.float32),
    )
    for kept in range(given):
        stack[0] = kept
        high = 1
        while high > 0:
            high -= 1
            run = stack[high]
            so_far = price[run]
            if so_far >= bound:
                continue
            met = mets[run]
            begin = max(at[run], t0)  # the first frame in which it is to be looked at
            state = own[run] + begin - at[run]
            end = begin
            if begin == at[run] or state < speech.stops[state - 1]:
                end = reach(begin, state, met, speech)
            if end >= t1:
                through = _met(begin, t1, state, met, speech)
                all_of_it = so_far
                if paying:
                    all_of_it += charge_frames(begin, t1, state, charges)
                count = _note(
                    run, all_of_it, -1, state, end, state + t1 - 1 - begin, through, count, found, paid, best
                )
                if count + 1 >= len(paid):
                    found, paid = _more_rows(found), _more(paid)
            if level[run] >= deepest:
                continue
            picks = 0
            for t in range(begin - (at[run] < t0), min(end, t1 - 1)):
                x = own[run] + t - at[run]
                if t >= begin and speech.stresses[t]:
                    row = speech.events[speech.stretch[t]]
                    met = not speech.closes[t] and (met or speech.peak_at[row, x] == x)
                if paying and t >= begin:
                    so_far += charge_frames(t, t + 1, x, charges)
                if at[run] > 0 and t - at[run] + 1 < least:  # it came here a moment ago
                    continue
                first, after = links.starts[x], links.starts[x + 1]
                if after == first:
                    continue
                step = max(1, (after - first + tries - 1) // tries)  # of all every so many, from anywhere on
                random = _next(random)
                first += np.int64((random >> np.uint64(33)) % np.uint64(step))
                easy = links.firsts[x + 1] - links.firsts[x]
                while count + easy + tries + 2 >= len(paid):
                    found, paid = _more_rows(found), _more(paid)
                until = speech.until[speech.rows[speech.stretch[t + 1]]]
                for number in range(easy + (after - first + step - 1) // step):
                    place = (
                        links.cheap[links.firsts[x] + number]
                        if number < easy
                        else first + (number - easy) * step
                    )
                    total = so_far + links.costs[place]
                    target = links.targets[place]
                    if total >= bound or until[target] <= target:
                        continue
                    far = reach(t + 1, target, met, speech)
                    if far < min(t + 1 + least, len(speech.stretch)):
                        continue
                    if far >= t1:
                        through = _met(t + 1, t1, target, met, speech)
                        if paying:
                            total += charge_frames(t + 1, t1, target, charges)
                        count = _note(
                            run,
                            total,
                            t + 1,
                            target,
                            far,
                            target + t1 - 2 - t,
                            through,
                            count,
                            found,
                            paid,
                            best,
                        )
                    elif far > end:  # what leads on cheapest, and chance, tell where to go deeper
                        random = _next(random)
                        chance = np.float32(random >> np.uint64(40)) / np.float32(1 << 24)
                        dear = links.costs[place]
                        if paying:
                            dear += charge_frames(t + 1, min(far, t1), target, charges)
                        worth = dear / (far - end) * (np.float32(0.5) + chance)
                        spot = picks
                        if picks == branches:
                            spot = int(np.argmax(score))
                            if score[spot] <= worth:
                                continue
                        else:
                            picks += 1
                        pick[spot, 0], pick[spot, 1], pick[spot, 2] = t + 1, target, met
                        pick_price[spot], score[spot] = total, worth
            for n in range(picks):
                if made == len(at):
                    off, at, own, price, mets, level = (
                        _more(off),
                        _more(at),
                        _more(own),
                        _more(price),
                        _more(mets),
                        _more(level),
                    )
                off[made], at[made], own[made], mets[made] = run, pick[n, 0], pick[n, 1], pick[n, 2] == 1
                price[made], level[made] = pick_price[n], level[run] + 1
                stack[high] = made
                high += 1
                made += 1
            if count >= check:
                bound = np.sort(paid[:count])[
                    2 * saved
                ]  # to part them would take five seconds more to compile
                check = 2 * count
    for n in range(count):
        best[found[n, 4]] = -1
    return off[:made], at[:made], own[:made], price[:made], found[:count], paid[:count], random
