"""What keeps a performance from repeating itself and from being restless: how soon an action is done again,
how long a posture is kept, how far apart acts are that stand out.

Only what the Markov model writes is held back. Requests always play; of the actions that fit a request, those
that have not played for long enough are likelier. `Settings.variety` multiplies every time here; 0 turns all
of it off, as in Borer et al. The times are ours, chosen by what an hour of the sample then does
(`docs/researchers/behaviour.md`).
"""

from __future__ import annotations

import math

from metagraph.graph.model import Kind, Layer

STANDS_OUT = 0.65  # prominence from which on an act is one that a viewer remembers
APART = 30.0  # seconds between two of those on one layer
LONG_REST = 30.0  # seconds of rest after which actions need to have rested only `SHORTER` as long
SHORTER = 0.3
STALE = 0.05  # least factor of the likelihood of what has just been played
LEAVES_HOME = 0.2  # share of the written tilts of the head that leave the stance it begins in
GOES_HOME = 0.7  # share of the written moves of a tilted head that go back there


def repeat_interval(kind: Kind, prominence: float) -> float:
    """Return after how many seconds an action may be done again.

    That is 18 s for a beat that hardly shows, six minutes for a gesture that stands out, and 4 to 10 minutes
    for fidgets, which only time calls for. prominence: 0..1.
    """
    if kind == "gesture":
        return 18.0 * math.exp(math.log(20.0) * prominence)
    return 240.0 * math.exp(math.log(2.5) * prominence)


def posture(layer: Layer) -> float:
    """Return how many seconds a stance is kept at least before the model changes it."""
    if layer == "body":
        return 15.0
    return 10.0 if layer == "arms" else 8.0


def freshness(since: float, needed: float) -> float:
    """Return the factor of an action's likelihood. since: seconds since it ended; needed: its interval."""
    if since >= needed:
        return 1.0
    return max(STALE, since / needed)
