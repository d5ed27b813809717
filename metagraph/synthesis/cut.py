"""Where a long take can be cut into clips that leave and come back without a jump: at rests that look alike.

A clip between two moments is safe when somebody can go from its end to its beginning, and from the end of any
other such clip to it, for no more than a transition of a motion graph may cost. So its ends lie near one
pose, the stance, in which the take often rests. What rest is, and what moves, is given by the take's own
speeds: they are of two kinds where somebody rests between movements, also where resting trembles a little.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.motion.clip import Clip
from metagraph.suggest.tracks import RATE, track_seconds
from metagraph.synthesis.graph import find_threshold
from metagraph.synthesis.states import States, SynthesisError, compute_cost_terms, read_states

Array = NDArray[Any]
Candidate = tuple[
    float, float, float
]  # start, end: seconds; score: 0..1, 1 when it leaves and comes back without any difference

LEAST, MOST = 1.0, 8.0  # seconds
APART = 8  # frames between moments that may be cut at
STILL = 0.25  # of the median speed of a take's frames; what is slower rests
SLOWEST = 1e-3  # metres a second; below that all is alike
TWO_KINDS = (
    0.75  # share of the variance that two kinds of speeds explain; 0.64 of one bell, 0.75 of an even spread
)
POSES = 2000  # moments that are compared with each other at most


def find_candidates(
    clip: Clip,
    limit: float | None = None,
    least: float = LEAST,
    most: float = MOST,
    states: States | None = None,
) -> tuple[Candidate, ...]:
    """Return clips to cut from a take, by start, none overlapping: from one rest in the stance to the next
    that is far enough.

    limit: what frames at which they begin and end may differ by, metres, half of it from the stance each,
    else `find_threshold` of the take. least, most: seconds a clip lasts. What moves less than the limit on
    the way, rest alone, is left out. states: the take's, where they are known. Raises SynthesisError for
    takes too short to tell, and lengths that cannot be.
    """
    if not 0 < least <= most:
        raise SynthesisError(
            f"clips of {least:g} to {most:g} s cannot be: the longest lasts at least as long as the "
            "shortest, more than 0"
        )
    states = read_states([clip]) if states is None else states
    limit = find_threshold(states).limit if limit is None else limit
    near, apart = _rests(states, limit)
    speeds = smooth_speed(states)
    least_speed = measure_pace(speeds).moves
    times = track_seconds(clip)
    out: list[Candidate] = []
    n = 0
    while n < len(near) - 1:
        after = next((m for m in range(n + 1, len(near)) if near[m] - near[n] >= least * RATE - 1e-6), None)
        if after is None:
            break
        # It goes on from the next rest when that is too far, or nothing happened until then.
        moved = _moved(states, int(near[n]), int(near[after]))
        happens = moved > limit and speeds[near[n] : near[after] + 1].max() >= least_speed
        if near[after] - near[n] > most * RATE + 1e-6 or not happens:
            n += 1
            continue
        score = 1.0 - float(apart[n] + apart[after]) / max(limit, 1e-9)
        out.append((float(times[near[n]]), float(times[near[after]]), round(max(0.0, score), 4)))
        n = after
    return tuple(out)


@dataclass(frozen=True)
class TakePace:
    """How fast a take moves, metres a second. rests: what is no faster rests; moves: what gets as fast moves,
    0 where speeds are of one kind. middle: median.
    """

    rests: float
    moves: float
    middle: float


def smooth_speed(states: States) -> Array:
    """Return `[F]` how fast a take's fastest joint is, metres a second, over a sixth of a second."""
    speed = np.linalg.norm(states.velocities, axis=-1).max(-1)
    return np.convolve(np.pad(speed, 2, "edge"), np.ones(5) / 5, "valid")


def measure_pace(speeds: Array) -> TakePace:
    """Return what rest is and what moves by a take's own speeds `[F]`: where their logarithms are of two
    kinds (Otsu), the middle of each; else a share of the median.
    """
    middle = float(np.median(speeds))
    still = STILL * max(middle, float(speeds.max()) / 10)
    ordered = np.sort(np.log(np.maximum(speeds, SLOWEST)))
    variance, count = float(ordered.var()), len(ordered)
    if variance < 1e-9:
        return TakePace(still, 0.0, middle)
    sums, below = np.cumsum(ordered), np.arange(1, count)
    slow, fast = sums[:-1] / below, (sums[-1] - sums[:-1]) / (count - below)
    between = below * (count - below) * (slow - fast) ** 2
    best = int(between.argmax())
    if between[best] / (count**2 * variance) < TWO_KINDS:
        return TakePace(still, 0.0, middle)
    return TakePace(max(still, float(np.exp(slow[best]))), float(np.exp(fast[best])), middle)


def explain_uncut(clip: Clip, limit: float | None = None, least: float = LEAST, most: float = MOST) -> str:
    """Return why `find_candidates` finds nothing in a take, in words. Arguments and errors as there."""
    states = read_states([clip])
    limit = find_threshold(states).limit if limit is None else limit
    speeds = smooth_speed(states)
    found, places = measure_pace(speeds), find_rest_moments(states)
    if len(places) < 2:
        slow = 100 * float(np.quantile(speeds, 0.05))
        return (
            f"it never rests: half of the time it moves at {100 * found.middle:.0f} cm/s or more, and hardly "
            f"ever below {slow:.0f}"
        )
    near, _ = _rests(states, limit)
    if len(near) < 2:
        return (
            f"it rests {len(places)} times, never twice in one pose: all joints together may be "
            f"{50 * limit:.0f} cm from it"
        )
    return (
        f"it rests {len(near)} times in one pose, but never moves and comes back to it within {least:g} to "
        f"{most:g} s"
    )


def find_rest_moments(states: States) -> Array:
    """Return `[n]` the states at which a take rests: where it is slowest, for a while around, and slow by
    itself; ascending.
    """
    if len(states.velocities) < 3:
        return np.zeros(0, int)
    smooth = smooth_speed(states)
    slow = smooth <= measure_pace(smooth).rests
    out: list[int] = []
    for at in np.argsort(smooth, kind="stable"):
        if not slow[at]:
            continue
        if all(abs(int(at) - other) >= APART for other in out):
            out.append(int(at))
        if len(out) >= POSES:
            break
    return np.array(sorted(out), int)


def _rests(states: States, limit: float) -> tuple[Array, Array]:
    """Return `[n]` the moments at which a take rests in its stance, any two of which differ by no more than
    the limit, and `[n]` by how much each differs from the stance.
    """
    places = find_rest_moments(states)
    if not len(places):
        return places, np.zeros(0)
    terms = compute_cost_terms(states, places)
    away = np.linalg.norm(terms - terms[_stance(terms, limit)], axis=-1).sum(-1)
    near = away <= limit / 2
    return places[near], away[near]


def _stance(terms: Array, limit: float) -> int:
    """Return the moment that most others are near to, half the limit away; of several the one they are
    nearest to.
    """
    best, found = (-1, 0.0), 0
    for n in range(len(terms)):
        away = np.linalg.norm(terms - terms[n], axis=-1).sum(-1)
        near = away <= limit / 2
        score = (int(near.sum()), -float(away[near].mean()))
        if score > best:
            best, found = score, n
    return found


def _moved(states: States, a: int, b: int) -> float:
    """Return how far joints are, together, from where they were at the beginning, at the most."""
    way = states.places[a : b + 1]
    return float((np.linalg.norm(way - way[:1], axis=-1) @ states.weights).max())
