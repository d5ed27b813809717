"""Where the gaze goes at a time: eased moves from target to target, with aversions and saccades on top.

The eyes jump (a saccade of A degrees takes 21 + 2.2 A milliseconds: Bahill, Clark and Stark 1975), the head
follows a moment later and settles like a critically damped spring. What is looked at is the sum of all moves
so far, each from the target before, so a target may change at any time, or every frame, and nothing jumps:

    angle(t) = sum over targets i of angle_i (S_i(t) - S_{i+1}(t)),  S_i: how far the move to target i has
    come, 0..1

This and `solve` are plain arithmetic on numbers, one time after the other: for one pose that is several times
faster than arrays of one, and any language can say the same.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Mapping
from dataclasses import dataclass
from math import acos, degrees, exp, hypot, inf, radians, sqrt

from metagraph.graph.life import Life
from metagraph.graph.requests import Point
from metagraph.playback.life.body import Body
from metagraph.playback.life.lane import Lane
from metagraph.playback.life.schedule import Schedule
from metagraph.playback.life.wanted import AHEAD, PARTNER, GazeTarget

EYE_TIME, EYE_TIME_PER_DEGREE = 0.021, 0.0022  # seconds
HEAD_LAG = 0.04  # seconds the head sets off after the eyes
HEAD_TIME, HEAD_TIME_PER_DEGREE = (
    0.55,
    0.006,
)  # seconds until it has settled; at most 1.7, see `schedule.RECALL`
ENDING = 0.12  # seconds in which a new look ends an aversion
SPRING = 8.0  # how many of the spring's own times a move takes; then all but 0.3 % is done
_SETTLED = 1 - (1 + SPRING) * exp(-SPRING)


def ease_gaze(x: float) -> float:
    """3x^2 - 2x^3 of x clamped to 0..1."""
    return 0.0 if x <= 0 else 1.0 if x >= 1 else x * x * (3 - 2 * x)


def settle_gaze(x: float) -> float:
    """A critically damped spring's way from 0 to 1, for x from 0 to 1: 1 - (1 + z) e^-z with z = 8 x, scaled
    to end at 1.
    """
    if x <= 0:
        return 0.0
    return 1.0 if x >= 1 else (1 - (1 + SPRING * x) * exp(-SPRING * x)) / _SETTLED


def compute_eye_time(angle: float) -> float:
    """Return seconds the eyes take for a turn, degrees."""
    return EYE_TIME + EYE_TIME_PER_DEGREE * angle


def compute_head_time(angle: float) -> float:
    """Return seconds the head takes for a turn, degrees, from when it sets off."""
    return HEAD_TIME + HEAD_TIME_PER_DEGREE * angle


@dataclass(frozen=True, slots=True)
class Aim:
    """A target as the gaze meets it. at: metres. amount: 0..1. eyes, head: seconds their moves to it take."""

    start: float
    at: tuple[float, ...]
    amount: float
    asked: bool
    strict: bool
    eyes: float
    head: float


@dataclass(frozen=True, slots=True)
class Moves:
    """The gaze at a time. parts: targets with the eyes' and the head's share of each, together 1. eyes, head:
    what aversions and saccades add, radians to the left and up.
    """

    parts: tuple[tuple[Aim, float, float], ...]
    eyes: tuple[float, float]
    head: tuple[float, float]


class BodyGaze:
    """A schedule's gaze on a body."""

    def __init__(self, schedule: Schedule, life: Life, body: Body, points: Mapping[str, Point]) -> None:
        self.targets, self.body, self.points = schedule.targets, body, points
        self._aims: dict[int, Aim] = {}
        self.calm = 1 - life.stillness
        self.averts = _Events(schedule.aversions, radians(life.aversion_angle) * self.calm * life.gaze)
        self.darts = _Events(schedule.saccades, radians(life.saccades) * self.calm)
        self.angle = life.aversion_angle

    def at(self, time: float) -> Moves:
        """Return what the gaze does at a time."""
        last = place = max(0, bisect_right(self.targets, time, key=_start) - 1) if self.targets else -1
        parts: list[tuple[Aim, float, float]] = []
        came = turned = strict = 0.0
        while place >= 0 and (came < 1 or turned < 1):
            aim = self._aims.get(place) or self._aim(place)
            gone = time - aim.start
            now, head = ease_gaze(gone / aim.eyes), settle_gaze((gone - HEAD_LAG) / aim.head)
            parts.append((aim, now - came, head - turned))
            strict += (now - came) * aim.strict
            came, turned, place = now, head, place - 1
        eyes_x = eyes_y = head_x = head_y = 0.0
        n = bisect_right(self.averts.starts, time) - 1
        if n >= 0 and self.averts.scale > 0:
            start = self.averts.starts[n]
            end, x, y = self.averts.values[n]
            size = hypot(x, y) * self.angle
            scale = self.averts.scale * (1 - strict)
            if last >= 0 and self.targets[last].since > start:  # a new look ends it
                scale *= 1 - ease_gaze((time - self.targets[last].since) / ENDING)
            went, gone, slow = time - start, time - end, compute_head_time(size)
            if gone < HEAD_LAG + slow:
                fast = compute_eye_time(size)
                now = scale * (ease_gaze(went / fast) - ease_gaze(gone / fast))
                head = scale * (settle_gaze((went - HEAD_LAG) / slow) - settle_gaze((gone - HEAD_LAG) / slow))
                eyes_x, eyes_y, head_x, head_y = x * now, y * now, x * head, y * head
        n = bisect_right(self.darts.starts, time) - 1
        if n >= 0 and self.darts.scale > 0:
            x, y = self.darts.values[n]
            from_x, from_y = self.darts.values[n - 1] if n else (0.0, 0.0)
            way = ease_gaze((time - self.darts.starts[n]) / compute_eye_time(hypot(x - from_x, y - from_y)))
            eyes_x += self.darts.scale * (from_x + (x - from_x) * way)
            eyes_y += self.darts.scale * (from_y + (y - from_y) * way)
        return Moves(tuple(parts), (eyes_x, eyes_y), (head_x, head_y))

    def _aim(self, place: int) -> Aim:
        """Return a target as it is met; how long the move to it takes depends on how far it is from the
        one before.
        """
        target = self.targets[place]
        at, seen = self._seen(target)
        angle = _between(seen, self._seen(self.targets[place - 1])[1]) if place else 0.0
        start = target.start if place else -inf  # the first has always been looked at
        amount = 0.0 if seen is self.body.ahead else target.amount
        found = self._aims[place] = Aim(
            start, at, amount, target.asked, target.strict, compute_eye_time(angle), compute_head_time(angle)
        )
        return found

    def _seen(self, target: GazeTarget) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Return where a target is, and its direction from where the eyes are at rest; ahead for what is
        nowhere.
        """
        named = self.points.get(target.to) if isinstance(target.to, str) else target.to
        if target.to == AHEAD or (named is None and target.to != PARTNER):
            return self.body.partner, self.body.ahead
        at = self.body.partner if named is None else named
        return at, tuple(a - b for a, b in zip(at, self.body.eyes_at_rest, strict=True))


class _Events:
    """A lane as plain numbers, and what its values are multiplied with."""

    def __init__(self, lane: Lane, scale: float) -> None:
        self.starts, self.values = lane.times, lane.rows
        self.scale = scale


def _start(target: GazeTarget) -> float:
    return target.start


def _between(a: tuple[float, ...], b: tuple[float, ...]) -> float:
    """Return the angle between two directions, degrees."""
    size = sqrt(sum(x * x for x in a) * sum(x * x for x in b))
    cosine = sum(x * y for x, y in zip(a, b, strict=True)) / max(size, 1e-12)
    return degrees(acos(min(1.0, max(-1.0, cosine))))
