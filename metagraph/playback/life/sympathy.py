"""How a listener takes up the mood of its partner and laughs along. The result is moods, which posture, face
and life show like any others.

What is known and followed here: faces take up others' expressions weakly, within about a second of seeing
them (Dimberg 1982), as far as they are friendly: happy and sad ones, hardly angry ones (Hess and Fischer
2013); laughter brings smiles and laughter, often but not always (Provine 1992). How much, how late and how
often is ours. Neutral moods are not taken up: a character with a mood of its own keeps it in front of a calm
face.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from metagraph.playback.planning.choice import uniform
from metagraph.playback.planning.hashing import Bits
from metagraph.playback.planning.mood import Mood, MoodFrom, Moods, mood_at, mood_edges

DELAY = 0.7  # seconds until a mood is taken up, at least; as much again by chance
SHORTEST = 0.5  # seconds: what passes sooner is not taken up
HOSTILE = 0.4  # of how much, for moods that are unpleasant and excited
# Laughing along.
LAUGH_DELAY = 0.25  # seconds, at least; as much again by chance
LAUGH_LASTS = 2.6  # seconds, at least
LAUGH_RINGS = 1.0  # seconds a smile stays after the other's laugh, at least; as much again by chance
LAUGH_VALENCE = 0.9
LAUGH_AROUSAL = 0.45


@dataclass(frozen=True, slots=True)
class Laugh:
    """A laugh of the other character, in seconds."""

    start: float
    end: float


def taken_up(own: Mood, other: Mood, share: float) -> Mood:
    """Return the mood of a character that sees another's: `share`, 0..1, of the way to it; its own mood if
    the other's is neutral.
    """
    if other.valence == 0 and other.arousal == 0:
        return own
    part = share * HOSTILE if other.valence < 0 and other.arousal > 0.3 else share
    return Mood(
        own.valence + part * (other.valence - own.valence),
        own.arousal + part * (other.arousal - own.arousal),
        own.intensity,
    )


def moods_taken_up(
    own: Moods, other: Moods, end: float, share: float, seed: Bits, who: str
) -> list[MoodFrom]:
    """Return the moods of a character that sees the other's, from 0 to `end` seconds, by start. own: its mood
    without the other; who: the key of the other, from which each delay is drawn.
    """
    edges = mood_edges(other, 0.0, end)
    for edge in mood_edges(own, 0.0, end):
        if edge not in edges:
            edges.append(edge)
    edges = sorted(edges)
    out: list[MoodFrom] = []
    for n, edge in enumerate(edges):
        until = edges[n + 1] if n + 1 < len(edges) else end
        mine = mood_at(own, edge)
        mood = taken_up(mine, mood_at(other, edge), share)
        if until - edge < SHORTEST or mood.like(mine):
            continue
        late = 0.0 if edge <= 0 else DELAY + DELAY * uniform(seed, who, str(n), "mood")
        start = min(edge + late, until)
        out.append(MoodFrom(f"{who} mood {n}", start, mood.valence, mood.arousal, None, until))
    return out


def laughs_along(own: Moods, laughs: Sequence[Laugh], share: float, seed: Bits, who: str) -> list[MoodFrom]:
    """Return the moods of a character that laughs along with `share`, 0..1, of the other's
    laughs, by start.
    """
    out: list[MoodFrom] = []
    for n, laugh in enumerate(laughs):
        if uniform(seed, who, str(n), "laugh") >= share:
            continue
        start = laugh.start + LAUGH_DELAY + LAUGH_DELAY * uniform(seed, who, str(n), "late")
        rings = LAUGH_RINGS + LAUGH_RINGS * uniform(seed, who, str(n), "rings")
        mine = mood_at(own, start)
        out.append(
            MoodFrom(
                f"{who} laugh {n}",
                start,
                max(mine.valence, LAUGH_VALENCE),
                max(mine.arousal, LAUGH_AROUSAL),
                None,
                max(start + LAUGH_LASTS, laugh.end + rings),
            )
        )
    return out
