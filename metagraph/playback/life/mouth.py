"""The mouth over time: from pieces of speech, each with one mouth shape, to smooth weights of all shapes.

Coarticulation after Cohen and Massaro (1993): every piece rules the mouth around its own time, begins before
it is heard and lingers after it; what the mouth shows is the mean of all pieces weighted by how much each
rules. Lips that must meet rule more than a tongue nobody sees.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil

from metagraph.graph.face_names import VISEMES

# How much each of VISEMES rules its neighbours: closed lips and teeth on the lip must be seen, tongue and
# palate need not.
RULE: tuple[float, ...] = (0.8, 6.0, 4.0, 1.0, 0.7, 0.5, 1.6, 1.2, 0.7, 0.9, 1.5, 1.3, 1.2, 1.7, 1.9)
EARLY = 0.075  # seconds over which a shape comes before its sound begins
LATE = 0.065  # and goes after it ends
STEP = 0.02  # seconds between the rows of a track
LEAST = 0.02  # how much rest rules everywhere
ACCENT = 2.0  # seconds round a stressed syllable without another: blinks come as often as people's


@dataclass(frozen=True, slots=True)
class MouthPiece:
    """A sound from `start` to `end` seconds: its mouth shape and how fully it is made, 0..1."""

    start: float
    end: float
    viseme: str
    strength: float = 1.0


def mouth_track(pieces: Sequence[MouthPiece], duration: float) -> list[list[float]]:
    """Return rows `[K][15]` of the shapes' weights, summing to 1; shut at both ends. Their times are evenly
    spaced from 0 to the duration, at least 1 ms.
    """
    count = max(2, ceil(duration / STEP - 1e-6) + 1)  # as many for 0.88 s as languages that divide otherwise
    step = max(duration, 1e-3) / (count - 1)
    rows = [[0.0 for shape in range(len(VISEMES))] for row in range(count)]
    made = [0.0 for row in range(count)]
    for piece in pieces:
        place = VISEMES.index(piece.viseme)
        # Short sounds are not left out: their ramps overlap and still reach the top in the middle.
        inside = min(0.5 * (piece.end - piece.start), 0.04)
        first = max(0, ceil((piece.start - EARLY) / step))
        for k in range(first, min(count, ceil((piece.end + LATE) / step))):
            rise = _ease((k * step - piece.start + EARLY) / (EARLY + inside))
            fall = _ease((piece.end + LATE - k * step) / (LATE + inside))
            here = min(rise, fall)
            made[k] += here
            rows[k][place] += here * RULE[place] * piece.strength
            rows[k][0] += here * RULE[place] * (1 - piece.strength)
    out = [rest()]
    for k in range(1, count - 1):
        rows[k][0] += LEAST + RULE[0] * max(1 - made[k], 0.0)  # where no sound rules, rest does
        whole = sum(rows[k])
        out.append([weight / whole for weight in rows[k]])
    out.append(rest())
    return out


def rest() -> list[float]:
    """Return the weights of a shut mouth."""
    return [1.0 if n == 0 else 0.0 for n in range(len(VISEMES))]


def accents_of(peaks: Sequence[float], strengths: Sequence[float]) -> list[float]:
    """Return the times of stressed syllables: the first peak, then the strongest that have no stronger one
    within `ACCENT` seconds. People blink and gesture on these, not on every syllable.
    """
    taken: list[float] = []
    for i in sorted(range(len(peaks)), key=lambda i: (0 if i == 0 else 1, -strengths[i], peaks[i])):
        if all(abs(peaks[i] - t) >= ACCENT for t in taken):
            taken.append(peaks[i])
    return sorted(taken)


def _ease(x: float) -> float:
    if x <= 0:
        return 0.0
    return 1.0 if x >= 1 else x * x * (3 - 2 * x)
