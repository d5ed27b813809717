"""The mouth over time: turn pieces of speech, each with one mouth shape, into smooth weights of all shapes.

Coarticulation after Cohen and Massaro (1993): every piece dominates the mouth around its own time, begins
before it is heard and lingers after it. The mouth shows the mean of all pieces, weighted by their dominance.
A mean never closes a mouth. So lips that meet (p, b, m) and teeth on the lip (f, v) are added on top
(`_closed`): in their middle nothing else shows, however quick the speech is. Lips round for a rounded vowel
as soon as the consonants before it begin (look-ahead, Henke 1966), at most a quarter of a second before it
(Bell-Berti and Harris 1981 found it begin at about a fixed time before the vowel). The numbers are ours.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil

from metagraph.graph.face.names import VISEMES

# How much each of VISEMES rules its neighbours: tongue and palate need not be seen. What closes the mouth
# does not take part in the mean.
RULE: tuple[float, ...] = (0.8, 0.0, 0.0, 1.0, 0.7, 0.5, 1.6, 1.2, 0.7, 0.9, 1.5, 1.3, 1.2, 1.7, 1.9)
CLOSURES: tuple[str, ...] = ("PP", "FF")
VOWELS: tuple[str, ...] = ("aa", "E", "I", "O", "U")
ROUNDED: tuple[str, ...] = ("O", "U")
EARLY = 0.075  # seconds over which a shape comes before its sound begins
LATE = 0.065  # and goes after it ends
STEP = 0.02  # seconds between the rows of a track
LOOK_AHEAD = 0.25  # seconds by which a rounded vowel may come before its sound
PAUSE = 0.03  # seconds without a sound that end a run of consonants
HELD = 0.02  # seconds before and after its middle that a closure lasts at least: a row on each side
SHUTTING = 0.09  # seconds it takes to close and to open again
PARTING = 0.03  # seconds one closure takes to make way for the other
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
    """Return rows `[K][15]` of the shapes' weights, which sum to 1; the mouth is shut at both ends. Their
    times are evenly spaced from 0 to the duration, at least 1 ms.
    """
    count = max(2, ceil(duration / STEP - 1e-6) + 1)  # as many for 0.88 s as languages that divide otherwise
    step = max(duration, 1e-3) / (count - 1)
    rows = [[0.0 for shape in range(len(VISEMES))] for row in range(count)]
    made = [0.0 for row in range(count)]
    begun, last = 0.0, -1.0  # of a run of consonants; where the sound before ended
    for piece in pieces:
        place = VISEMES.index(piece.viseme)
        if piece.start - last > PAUSE:
            begun = piece.start
        early = EARLY
        if piece.viseme in ROUNDED:
            early = min(max(piece.start - begun, EARLY), LOOK_AHEAD)
        last = piece.end
        if piece.viseme in VOWELS:
            begun = piece.end
        # Short sounds are not left out: their ramps overlap and still reach the top in the middle.
        inside = min(0.5 * (piece.end - piece.start), 0.04)
        first = max(0, ceil((piece.start - early) / step))
        for k in range(first, min(count, ceil((piece.end + LATE) / step))):
            rise = _ease((k * step - piece.start + early) / (early + inside))
            fall = _ease((piece.end + LATE - k * step) / (LATE + inside))
            here = min(rise, fall)
            made[k] += here
            rows[k][place] += here * RULE[place] * piece.strength
            rows[k][0] += here * RULE[place] * (1 - piece.strength)
    shut = [_gates(pieces, name, count, step) for name in CLOSURES]
    out = [rest()]
    for k in range(1, count - 1):
        rows[k][0] += LEAST + RULE[0] * max(1 - made[k], 0.0)  # where no sound rules, rest does
        whole = sum(rows[k])
        out.append(_closed([weight / whole for weight in rows[k]], shut[0][k], shut[1][k]))
    out.append(rest())
    return out


def _gates(pieces: Sequence[MouthPiece], viseme: str, count: int, step: float) -> list[tuple[float, float]]:
    """Return rows (how far a closure has progressed, how far it suppresses the other one), 0..1."""
    out = [(0.0, 0.0) for row in range(count)]
    for piece in pieces:
        if piece.viseme != viseme:
            continue
        middle = 0.5 * (piece.start + piece.end)
        held = max(HELD, 0.5 * (piece.end - piece.start) - 0.01)
        first = max(0, ceil((middle - held - SHUTTING) / step))
        for k in range(first, min(count, ceil((middle + held + SHUTTING) / step))):
            away = max(0.0, abs(k * step - middle) - held)
            wide = piece.strength * _ease(1 - away / SHUTTING)
            narrow = piece.strength * _ease(1 - away / PARTING)
            out[k] = (max(out[k][0], wide), max(out[k][1], narrow))
    return out


def _closed(row: list[float], lips: tuple[float, float], teeth: tuple[float, float]) -> list[float]:
    """Return a row with the closures on top: they suppress the rest as far as they are closed."""
    most = max(lips[0], teeth[0])
    if most <= 0:
        return row
    one, other = lips[0] * (1 - teeth[1]), teeth[0] * (1 - lips[1])
    if one + other <= 0:
        one, other = lips[0], teeth[0]
    out = [(1 - most) * weight for weight in row]
    out[1] += most * one / (one + other)
    out[2] += most * other / (one + other)
    return out


def soften(out: list[float], before: Sequence[float], now: Sequence[float], after: Sequence[float]) -> None:
    """Write the shapes without silence `[14]`, smoothed over three moments. Shapes that close the mouth keep
    their present weights, and the others share what is left: smoothing must not part lips that meet.
    """
    for n in range(len(out)):
        out[n] = 0.25 * before[n] + 0.5 * now[n] + 0.25 * after[n]
    open_ = 1 - out[0] - out[1]
    out[0] = now[0]
    out[1] = now[1]
    left = max(0.0, 1 - out[0] - out[1]) / open_ if open_ > 1e-9 else 0.0
    for n in range(2, len(out)):
        out[n] *= min(1.0, left)


def rest() -> list[float]:
    """Return the weights of a shut mouth."""
    return [1.0 if n == 0 else 0.0 for n in range(len(VISEMES))]


def accents_of(peaks: Sequence[float], strengths: Sequence[float]) -> list[float]:
    """Return the times of stressed syllables: the first peak, then those with no stronger one within `ACCENT`
    seconds. People blink and gesture on these, not on every syllable.
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
