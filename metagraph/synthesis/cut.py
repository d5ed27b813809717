"""Where a long take can be cut into clips that leave and come back without a jump: at rests that look alike.

A clip between two moments is safe when somebody can go from its end to its beginning, and from the end of any
other such clip to it, for no more than a transition of a motion graph may cost. So its ends lie near one
pose, the stance, in which the take often rests.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.motion.clip import Clip
from metagraph.suggest.tracks import RATE, times_of
from metagraph.synthesis.graph import threshold
from metagraph.synthesis.states import States, SynthesisError, states_of, terms_of

Array = NDArray[Any]
Candidate = tuple[
    float, float, float
]  # start, end: seconds; score: 0..1, 1 when it leaves and comes back without any difference

LEAST, MOST = 1.0, 8.0  # seconds
APART = 8  # frames between moments that may be cut at
STILL = 0.25  # of the median speed of a take's frames; what is slower rests
POSES = 2000  # moments that are compared with each other at most


def candidates(
    clip: Clip,
    limit: float | None = None,
    least: float = LEAST,
    most: float = MOST,
    states: States | None = None,
) -> tuple[Candidate, ...]:
    """Return clips to cut from a take, by start, none overlapping: from one rest in the stance to the next
    that is far enough.

    limit: what frames at which they begin and end may differ by, metres, half of it from the stance each,
    else `threshold` of the take. least, most: seconds a clip lasts. What moves less than the limit on the
    way, rest alone, is left out. states: the take's, where they are known. Raises SynthesisError for takes
    too short to tell, and lengths that cannot be.
    """
    if not 0 < least <= most:
        raise SynthesisError(
            f"clips of {least:g} to {most:g} s cannot be: the longest lasts at least as long as the "
            "shortest, more than 0"
        )
    states = states_of([clip]) if states is None else states
    limit = threshold(states).limit if limit is None else limit
    places = moments(states)
    if not len(places):
        return ()
    terms = terms_of(states, places)
    middle = _stance(terms, limit)
    away = np.linalg.norm(terms - terms[middle], axis=-1).sum(-1)
    near = places[away <= limit / 2]  # any two of them differ by no more than the limit
    apart = away[away <= limit / 2]
    times = times_of(clip)
    out: list[Candidate] = []
    n = 0
    while n < len(near) - 1:
        after = next((m for m in range(n + 1, len(near)) if near[m] - near[n] >= least * RATE - 1e-6), None)
        if after is None:
            break
        # It goes on from the next rest when that is too far, or nothing happened until then.
        moved = _moved(states, int(near[n]), int(near[after]))
        if near[after] - near[n] > most * RATE + 1e-6 or moved <= limit:
            n += 1
            continue
        score = 1.0 - float(apart[n] + apart[after]) / max(limit, 1e-9)
        out.append((float(times[near[n]]), float(times[near[after]]), round(max(0.0, score), 4)))
        n = after
    return tuple(out)


def moments(states: States) -> Array:
    """Return `[n]` the states at which a take rests: where it is slowest, for a while around, and slow by
    itself; ascending.
    """
    speed = np.linalg.norm(states.velocities, axis=-1).max(-1)
    if len(speed) < 3:
        return np.zeros(0, int)
    smooth = np.convolve(np.pad(speed, 2, "edge"), np.ones(5) / 5, "valid")
    slow = smooth <= STILL * max(float(np.median(smooth)), float(smooth.max()) / 10)
    out: list[int] = []
    for at in np.argsort(smooth, kind="stable"):
        if not slow[at]:
            continue
        if all(abs(int(at) - other) >= APART for other in out):
            out.append(int(at))
        if len(out) >= POSES:
            break
    return np.array(sorted(out), int)


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
