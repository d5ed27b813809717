"""What keeps a performance from repeating itself and from being restless: how soon an action is done again,
how long a posture is kept, how far apart acts are that stand out.

Only what the Markov model writes is held back. Requests always play; of the actions that fit a request, those
that have not played for long enough are likelier. `Settings.variety` multiplies every time here; 0 turns all
of it off, as in Borer et al. The times are ours, chosen by what an hour of the sample then does
(`docs/researchers/behaviour.md`).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from metagraph.graph.model import Kind, Layer, Stance
from metagraph.playback.planning.choice import log_normal, uniform
from metagraph.playback.planning.hashing import Bits

STANDS_OUT = 0.65  # prominence from which on an act is one that a viewer remembers
APART = 30.0  # seconds between two of those on one layer
LONG_REST = 30.0  # seconds of rest after which actions need to have rested only `SHORTER` as long
SHORTER = 0.3
LEAST_BEATS = 18.0  # seconds after which a gesture that hardly shows is done again, at least
MOST_BEATS = 180.0  # and at most
EACH = 7.0  # seconds of those for each gesture of the arms that the character has
STALE = 0.05  # least factor of the likelihood of what has just been played
ENDS_BURST = 0.25  # share of the acts of one who talks that end a burst: some 2.5 acts, then a rest
LEAST_LULL = 5.0  # seconds of that rest at least
MOST_LULL = 30.0  # and at most
LULL = 8.0  # its mean before it is clamped
LULL_SPREAD = 14.0  # and its standard deviation
LEAVES_HOME = 0.2  # share of the written tilts of the head that leave the stance it begins in
GOES_HOME = 0.7  # share of the written moves of a tilted head that go back there
MUSES = 2.0  # seconds that a thought goes on at least for which a hand goes to the chin
MUSED = 10.0  # seconds after a thought in which anything that is written takes the hand away again
THOUGHTFUL: Sequence[str] = ("chin", "thinking", "pondering", "musing")  # words of such a stance's name


def musing(stances: Mapping[str, Stance]) -> str:
    """Return the first stance of the arms whose name says that one thinks in it; "" for none."""
    for ident, stance in stances.items():
        for word in stance.name.lower().split():
            if word in THOUGHTFUL or word.rpartition("_")[2] in THOUGHTFUL:
                return ident
    return ""


def beat_interval(layer: Layer, gestures: int) -> float:
    """Return after how many seconds a gesture that hardly shows may be done again: with many gestures of the
    arms, not for minutes; with few, soon. gestures: how many the layer has.
    """
    if layer != "arms":
        return LEAST_BEATS
    return min(MOST_BEATS, max(LEAST_BEATS, EACH * gestures))


def repeat_interval(kind: Kind, prominence: float, beats: float) -> float:
    """Return after how many seconds an action may be done again.

    That is from `beats` (`beat_interval`) to six minutes for gestures, the longer the more they stand out,
    and 5 to 10 minutes for fidgets, which only time calls for. prominence: 0..1.
    """
    if kind == "gesture":
        return beats * math.exp(math.log(360.0 / beats) * prominence)
    return 300.0 * math.exp(math.log(2.0) * prominence)


def posture(layer: Layer) -> float:
    """Return how many seconds a stance is kept at least before the model changes it."""
    if layer == "body":
        return 25.0
    return 10.0 if layer == "arms" else 8.0


def find_lull(seed: Bits, key: str, talks: bool, variety: float) -> float:
    """Return how many seconds the arms rest at least after an act of theirs: nothing within a burst of one
    who talks, else from `LEAST_LULL` to `MOST_LULL`. key: of the act's meta action.
    """
    if talks and uniform(seed, key, "burst") >= ENDS_BURST:
        return 0.0
    drawn = log_normal(LULL, LULL_SPREAD, uniform(seed, key, "lull"), uniform(seed, key, "lull2"))
    return min(MOST_LULL, max(LEAST_LULL, drawn) * variety)


def freshness(since: float, needed: float) -> float:
    """Return the factor of an action's likelihood. since: seconds since it ended; needed: its interval."""
    if since >= needed:
        return 1.0
    return max(STALE, since / needed)
