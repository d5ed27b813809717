"""Requests of the life layers as segments in time: the mode of the character, and what it looks at."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from metagraph.graph.life import Life, Manner, scaled
from metagraph.graph.requests import Point
from metagraph.graph.words import MODES, Mode
from metagraph.playback.life.items import LookAt
from metagraph.playback.life.spots import Spot, is_same_spot, named, placed
from metagraph.playback.life.track import Track
from metagraph.playback.planning.mood import Mood, Moods, life_of, mood_at, mood_edges

PARTNER = "user"  # whom the character talks with, and looks at when nothing else is asked for
AHEAD = "ahead"  # nothing in particular: eyes and head as the layers have them
# What changes what is looked at; of one time in this order.
OVER = 0
LOOK = 1
PLACE = 2
BEGIN = 3


@dataclass(frozen=True, slots=True)
class GazeTarget:
    """The target of the gaze from `start` on: a point, or a name whose place the project knows. since: when
    the look at it began; its place may have changed meanwhile. asked: whether a request set it.
    """

    start: float
    to: Spot
    since: float = 0.0
    amount: float = 1.0
    strict: bool = False
    asked: bool = False

    def like(self, other: GazeTarget) -> bool:
        """Return whether it is the same apart from its times."""
        if self.amount != other.amount or self.strict != other.strict or self.asked != other.asked:
            return False
        return is_same_spot(self.to, other.to)


def mode_at(track: Track, seconds: float) -> Mode:
    """Return the requested mode; without one, talking while something is said and idle otherwise."""
    told = track.told_mode(seconds)
    return "idle" if told is None else told


def modes_between(track: Track, start: float, end: float) -> list[tuple[float, int]]:
    """Return (start, place among MODES) of each mode from `start` to before `end`; the first begins at
    `start`.
    """
    edges = [start]
    edges += [m.start for m in track.modes]
    edges += [s.start for s in track.speeches]
    edges += [s.end for s in track.speeches]
    out: list[tuple[float, int]] = []
    last = -1
    for edge in sorted([e for e in edges if start <= e < end]):
        mode = MODES.index(mode_at(track, edge))
        if mode != last:
            out.append((edge, mode))
        last = mode
    return out


def moods_of(life: Life, track: Track) -> Moods:
    """Return the moods of a character: the one set in its life layers, and those requested over time."""
    return Moods(Mood(life.valence, life.arousal, life.intensity), track.moods)


def moods_between(moods: Moods, start: float, end: float) -> list[tuple[float, Mood]]:
    """Return (start, mood) of each mood from `start` to before `end`; the first begins at `start`."""
    out: list[tuple[float, Mood]] = []
    for edge in mood_edges(moods, start, end):
        mood = mood_at(moods, edge)
        if len(out) == 0 or not mood.like(out[-1][1]):
            out.append((edge, mood))
    return out


def ways_in(ways: Manner, mood: Mood) -> Manner:
    """Return the factors of the amounts for a mode and a mood."""
    if mood.neutral:
        return ways
    of = life_of(mood)
    return scaled(ways, of.breathing, of.breath_rate, of.aversion_rate, of.saccade_rate, of.blinks)


def targets_between(track: Track, start: float, end: float) -> list[GazeTarget]:
    """Return the targets of the gaze from `start` to before `end`; the first begins at `start`.

    The latest look holds until it ends or another of at least the same importance begins; a less important
    one waits.
    """
    changes = [(x.start, LOOK, n) for n, x in enumerate(track.looks)]
    changes += [(x.end, OVER, n) for n, x in enumerate(track.looks)]
    changes += [(p.start, PLACE, n) for n, p in enumerate(track.places) if p.start >= start]
    changes.append((start, BEGIN, 0))
    changes = sorted(changes, key=lambda c: (c[0], c[1]))
    looks: list[
        int
    ] = []  # indices of looks, the most important first; the others are older or less important
    places: dict[str, Point] = {}
    for place in track.places:  # a point that is sent again and again has thousands
        if place.start < start:
            places[place.name] = place.point
    chosen = -1
    since = 0.0
    out: list[GazeTarget] = []
    for n in range(len(changes)):
        at, kind, which = changes[n]
        if at >= end:
            break
        if kind == LOOK:
            look = track.looks[which]
            looks = [x for x in looks if track.looks[x].priority > look.priority]
            if look.end > look.start:
                looks.append(which)
        elif kind == OVER:
            looks = [x for x in looks if x != which]
        elif kind == PLACE:
            places[track.places[which].name] = track.places[which].point
        first = looks[0] if len(looks) > 0 else -1
        if chosen != first:
            chosen = first
            since = at
        if at < start or (n + 1 < len(changes) and changes[n + 1][0] == at):
            continue
        target = _target(at, since, None if chosen < 0 else track.looks[chosen], places)
        if len(out) == 0 or not target.like(out[-1]):
            out.append(target)
    return out


def _target(at: float, since: float, look: LookAt | None, places: Mapping[str, Point]) -> GazeTarget:
    if look is None:
        return GazeTarget(at, placed(places, named(PARTNER)), since)
    return GazeTarget(at, placed(places, look.to), since, look.amount, look.strict, True)
