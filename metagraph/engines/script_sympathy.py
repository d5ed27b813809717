"""Moods and laughs of another, and what is taken up of them: what vectors have beside characters."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from metagraph.playback.life.sympathy import Laugh, laughs_along, moods_taken_up
from metagraph.playback.planning.hashing import Bits
from metagraph.playback.planning.mood import Mood, MoodFrom, Moods

# Start, valence, arousal, end: pleasant, unpleasant and excited, unpleasant and calm, too short, neutral.
_MOODS = (
    (0.0, 0.25, 0.125, 2.0),
    (3.0, 0.75, 0.125, 9.5),
    (9.5, 0.0, 0.5, 11.0),
    (12.0, -0.125, 0.75, 20.0),
    (20.25, -0.75, -0.375, 20.625),
    (23.0, -0.5, 0.3, 24.0),
    (26.0, 0.0, 0.0, 28.0),
    (28.0, -0.5, 0.25, 28.5),
    (30.0, 0.5, 0.625, 50.0),
)
_OWN = ((15.0, 0.5, 0.0, 18.0), (31.0, 0.95, 0.6, 39.0))
_LAUGHS = tuple((2.0 * n, 2.0 * n + 0.5 + 0.25 * n) for n in range(20))


def list_taken_moods() -> list[dict[str, Any]]:
    """Return moods and laughs with what is taken up of them, as plain data. base: the own mood where no other
    holds.
    """
    out: list[dict[str, Any]] = []
    for n, (base, share) in enumerate(
        (((-0.25, 0.125, 1.0), 0.35), ((0.0, 0.0, 1.0), 0.75), ((0.5, 0.5, 1.5), 0.0))
    ):
        row: dict[str, Any] = {"base": list(base), "own": [list(one) for one in _OWN[n:]]}
        row |= {"others": [list(one) for one in _MOODS], "laughs": [list(one) for one in _LAUGHS]}
        row |= {"end": 60.0, "share": share, "seed": 7 + n, "who": f"side {n + 1}"}
        out.append({**row, **find_sympathies(row)})
    return out


def find_sympathies(row: Mapping[str, Any]) -> dict[str, Any]:
    """Return the moods that are taken up, and those of who laughs along: id, start, valence, arousal, end."""
    own = Moods(Mood(*row["base"]), _told("own", row["own"]))
    others = Moods(Mood(), _told("other", row["others"]))
    share, seed, who = row["share"], Bits(row["seed"]), row["who"]
    moods = moods_taken_up(own, others, row["end"], share, seed, who)
    laughs = laughs_along(own, [Laugh(*one) for one in row["laughs"]], share, seed, who)
    return {"taken": _rows(moods), "along": _rows(laughs)}


def _told(ident: str, rows: Sequence[Sequence[float]]) -> list[MoodFrom]:
    return [MoodFrom(ident, start, valence, arousal, None, end) for start, valence, arousal, end in rows]


def _rows(moods: Sequence[MoodFrom]) -> list[list[Any]]:
    return [[m.id, m.start, m.valence, m.arousal, m.end] for m in moods]
