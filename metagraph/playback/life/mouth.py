"""The mouth over time: from pieces of speech, each with one mouth shape, to smooth weights of all shapes.

Coarticulation after Cohen and Massaro (1993): every piece rules the mouth around its own time, begins before
it is heard and lingers after it; what the mouth shows is the mean of all pieces weighted by how much each
rules. Lips that must meet rule more than a tongue nobody sees.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph.face_names import VISEMES

Array = NDArray[Any]

PLACE = {name: i for i, name in enumerate(VISEMES)}

# How much a shape rules its neighbours: closed lips and teeth on the lip must be seen, tongue and palate need
# not.
RULE = {
    "sil": 0.8,
    "PP": 6.0,
    "FF": 4.0,
    "TH": 1.0,
    "DD": 0.7,
    "kk": 0.5,
    "CH": 1.6,
    "SS": 1.2,
    "nn": 0.7,
    "RR": 0.9,
    "aa": 1.5,
    "E": 1.3,
    "I": 1.2,
    "O": 1.7,
    "U": 1.9,
}
EARLY, LATE = 0.075, 0.065  # seconds over which a shape comes before its sound begins and goes after it ends
STEP = 1 / 50  # seconds between the keys of a track
_LEAST = 0.02  # how much rest rules everywhere


@dataclass(frozen=True, slots=True)
class MouthPiece:
    """A sound from `start` to `end` seconds: its mouth shape and how fully it is made, 0..1."""

    start: float
    end: float
    viseme: str
    strength: float = 1.0


def mouth_track(pieces: Sequence[MouthPiece], duration: float) -> tuple[Array, Array]:
    """Return times `[K]` and weights `[K, 15]` float32 of the shapes, summing to 1; shut at both ends."""
    count = max(2, int(np.ceil(duration / STEP)) + 1)
    times = np.linspace(0.0, max(duration, 1e-3), count)
    rule = np.zeros((count, len(VISEMES)))
    made = np.zeros(count)
    for piece in pieces:
        low, high = np.searchsorted(times, (piece.start - EARLY, piece.end + LATE))
        t = times[low:high]
        # Short sounds are not left out: their ramps overlap and still reach the top in the middle.
        rise = _ease((t - piece.start + EARLY) / (EARLY + min(0.5 * (piece.end - piece.start), 0.04)))
        fall = _ease((piece.end + LATE - t) / (LATE + min(0.5 * (piece.end - piece.start), 0.04)))
        here = np.minimum(rise, fall)
        made[low:high] += here
        here *= RULE[piece.viseme]
        rule[low:high, PLACE[piece.viseme]] += here * piece.strength
        rule[low:high, 0] += here * (1 - piece.strength)
    rule[:, 0] += _LEAST + RULE["sil"] * np.maximum(1 - made, 0)  # where no sound rules, rest does
    weights = rule / rule.sum(1, keepdims=True)
    weights[[0, -1]] = np.eye(len(VISEMES))[0]
    return times, weights.astype(np.float32)


def _ease(x: Array) -> Array:
    x = np.clip(x, 0.0, 1.0)
    return np.asarray(x * x * (3 - 2 * x))
