"""What was asked of the life layers, as segments in time: which mode the character is in, and what it looks
at.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from metagraph.graph.requests import Point
from metagraph.graph.words import MODES, Mode
from metagraph.playback.life.track import LookAt, Track

PARTNER = "user"  # whom the character talks with, and looks at when nothing else is asked for
AHEAD = "ahead"  # nothing in particular: eyes and head as the layers have them


@dataclass(frozen=True, slots=True)
class GazeTarget:
    """What is looked at from `start` on: a point, or a name whose place the project knows. since: when the
    look at it began; its place may have changed meanwhile. asked: not of its own accord.
    """

    start: float
    to: str | Point
    since: float = 0.0
    amount: float = 1.0
    strict: bool = False
    asked: bool = False

    def like(self, other: GazeTarget) -> bool:
        """Whether it is the same but for its times."""
        return (self.to, self.amount, self.strict, self.asked) == (
            other.to,
            other.amount,
            other.strict,
            other.asked,
        )


def mode_at(track: Track, seconds: float) -> Mode:
    """Return the mode asked for; where none is, talking while something is said and idle otherwise."""
    return track.told_mode(seconds) or "idle"


def modes_between(track: Track, start: float, end: float) -> Iterator[tuple[float, int]]:
    """Yield (start, place among MODES) of each mode from `start` to before `end`; the first begins at
    `start`.
    """
    edges = {
        start,
        *(m.start for m in track.modes),
        *(s.start for s in track.speeches),
        *(s.end for s in track.speeches),
    }
    last = -1
    for edge in sorted(e for e in edges if start <= e < end):
        mode = MODES.index(mode_at(track, edge))
        if mode != last:
            yield edge, mode
        last = mode


def targets_between(track: Track, start: float, end: float) -> Iterator[GazeTarget]:
    """Yield what is looked at from `start` to before `end`; the first begins at `start`.

    The latest look holds until it ends or another of its importance or more begins; a lesser one waits
    beneath.
    """
    changes: list[tuple[float, int, Any]] = [(x.start, 1, x) for x in track.looks]
    changes += (
        [(x.end, 0, x) for x in track.looks] + [(p.start, 2, p) for p in track.places] + [(start, 3, None)]
    )
    looks: list[LookAt] = []  # the most important first; those beneath are older or lesser
    places: dict[str, Point] = {}
    last: GazeTarget | None = None
    chosen: LookAt | None = None
    since = 0.0
    changes.sort(key=lambda c: (c[0], c[1]))
    for n, (at, kind, what) in enumerate(changes):
        if at >= end:
            break
        if kind == 1:
            looks = [x for x in looks if x.priority > what.priority]
            if what.end > what.start:
                looks.append(what)
        elif kind == 0:
            looks = [x for x in looks if x is not what]
        elif kind == 2:
            places[what.name] = what.point
        if chosen is not (looks[0] if looks else None):
            chosen, since = looks[0] if looks else None, at
        if at < start or (n + 1 < len(changes) and changes[n + 1][0] == at):
            continue
        new = _target(at, since, chosen, places)
        if last is None or not new.like(last):
            yield new
            last = new


def _target(at: float, since: float, look: LookAt | None, places: dict[str, Point]) -> GazeTarget:
    if look is None:
        return GazeTarget(at, places.get(PARTNER, PARTNER), since)
    to = places.get(look.to, look.to) if isinstance(look.to, str) else look.to
    return GazeTarget(at, to, since, look.amount, look.strict, True)


def _start(item: Any) -> float:
    return float(item.start)
