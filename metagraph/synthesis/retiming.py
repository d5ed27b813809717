"""Motion of a path played a little faster or slower, so that what it was made with comes when it is heard
(the future work of Yang et al., section 9).

Speed is changed within runs alone, and only where it shows least: not in strokes of a hand, not while a
foot steps, not where one take fades into another. It rises and falls by a cosine. The sound stays as it is:
the motion is fitted to it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.wording import phrase
from metagraph.motion.clip import Clip
from metagraph.suggest.tracks import RATE, sample_clip_poses, track_seconds
from metagraph.synthesis.constraints import EDGE, STRESS, HeardStates, WantedSegment
from metagraph.synthesis.cooccurrence import find_activation_speed, measure_part_speeds
from metagraph.synthesis.graph import BLEND
from metagraph.synthesis.search.frame_costs import FrameCost
from metagraph.synthesis.standing_feet import find_standing
from metagraph.synthesis.states import SynthesisError

Array = NDArray[Any]

MOST = 0.15  # share by which speed may change, unless another is asked for
HIGHEST = 0.5  # and may be asked for
RAMP = 5  # frames in which speed rises or falls
STROKE = 0.5  # of the fastest moment of a movement of a hand: what is faster is its stroke
SLOW = 0.1  # metres a second: a hand that is slower, seen from its shoulder, does nothing that shows
STEP = 0.1  # frames: how exactly events are moved
NEARER = 0.1  # of the graph's threshold: what an event costs that is as far off as it may be
FARTHER = 3.0  # the same if more is allowed than was asked for: what is retimed into it has to be near
EASY = 0.01  # what moving by a frame costs beside being off by one


@dataclass(frozen=True, eq=False)
class Retiming:
    """moments `[T]`: the frame of a path, with its fraction, that is shown at each frame. off, was: how far
    events are from where they are wanted, seconds (root mean square), after and before. events: how many.
    moved: seconds by which the one that was moved most was. changed: seconds of motion at another speed.
    """

    moments: Array
    off: float
    was: float
    events: int
    moved: float
    changed: float

    @property
    def frames(self) -> Array:
        """`[T]` int64: the nearest frame of the path at each frame."""
        return np.rint(self.moments).astype(np.int64)

    @property
    def shown(self) -> Array:
        """`[T]`: at which frame, with its fraction, each frame of the path is shown."""
        count = np.arange(len(self.moments))
        return np.interp(count, self.moments, count)

    def words(self) -> str:
        """Return in words how much was retimed, and what that gains."""
        return phrase(
            "{changed:.1f} s at another speed: {events} starts, ends and stresses are {off:.0f} ms off (root "
            "mean square), not {was:.0f} ms",
            changed=self.changed,
            events=self.events,
            off=1000 * self.off,
            was=1000 * self.was,
        )


def check_share(most: float) -> float:
    """Return a share by which speed may change. Raises SynthesisError if it is none."""
    if not 0 <= most <= HIGHEST:
        raise SynthesisError(f"speed may change by 0 to {HIGHEST:.0%}, not by {most:.0%}")
    return most


def find_retimable(takes: Sequence[Clip]) -> Array:
    """Return `[F]` at which states of takes speed may change: no hand is in its stroke, and no foot
    steps.

    A hand's stroke is what is faster than STROKE of the fastest moment of a movement, which is what is faster
    than the take's own threshold (equation 1) and than SLOW.
    """
    out = []
    for clip in (c for c in takes if c.frames >= 2):
        times, poses = track_seconds(clip), sample_clip_poses(clip)
        free = np.ones(len(times), bool)
        own = np.arange(clip.frames) / clip.fps
        for part, speed in measure_part_speeds(clip).items():
            if part != "head":
                free &= ~_strokes(np.interp(times, own, speed))
        for stands in find_standing(clip.skeleton, poses).values():
            free &= stands
        out.append(free)
    return np.concatenate(out)


def _strokes(speed: Array) -> Array:
    moving = speed > max(find_activation_speed(speed), SLOW)
    out = np.zeros(len(speed), bool)
    for a, b in _stretches(moving):
        out[a:b] = speed[a:b] > STROKE * speed[a:b].max()
    return out


def _stretches(there: Array) -> list[tuple[int, int]]:
    """Return the first and the one after the last of each row of what is there."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], there, [False]]).astype(np.int8)))
    return [(int(a), int(b)) for a, b in edges.reshape(-1, 2)]


def retime(
    way: Array,
    jumps: Array,
    heard: HeardStates,
    wanted: WantedSegment,
    free: Array,
    most: float = MOST,
    reach: float | None = None,
) -> Retiming | None:
    """Return how a path is retimed so that its events come nearer to where they are wanted, None if nothing
    can be or need be moved.

    way `[T]`: its states; jumps: frames that come by a transition. free `[F]`: `find_retimable`. most: share
    by which speed may change at most. reach: frames within which an event of the path is the one that is
    wanted, else up to half way to the next. The path's beginning and end stay where they are.

    Between two events there is so much time to be won or lost, by speed at its highest in all that is free
    there. How far each is moved is the best by that (dynamic programming): squares of what they are then off
    are least, and none is farther off than it was by more than a frame's rounding.
    """
    check_share(most)
    pairs = _pairs(way, heard, wanted.places, reach)
    frames = len(way)
    if not pairs or most == 0:
        return None
    steady = ~free[way]
    for jump in jumps.tolist():
        steady[max(0, jump - BLEND) : jump + BLEND] = True
    knots = np.array([0, *(e for e, _ in pairs), frames - 1])
    goal = np.array([0.0, *(g - e for e, g in pairs), 0.0])
    share = most / (1 + most)  # of time: so neither faster nor slower than asked for
    shapes = [_changeable(steady, a, b) for a, b in zip(knots[:-1].tolist(), knots[1:].tolist(), strict=True)]
    room = share * np.array([shape.sum() for shape in shapes])
    moved = _moved(goal, room)
    if not np.abs(moved).max() > STEP / 2:
        return None
    slowness = 1 + np.concatenate(  # frames shown for each of the path's
        [by / max(s.sum(), 1e-9) * s for s, by in zip(shapes, np.diff(moved).tolist(), strict=True)]
    )
    shown = np.concatenate([[0.0], np.cumsum(slowness)])
    shown *= (frames - 1) / shown[-1]
    moments = np.interp(np.arange(frames), shown, np.arange(frames))
    events = np.array([e for e, _ in pairs])
    off = np.abs(shown[events] - [g for _, g in pairs]) / RATE
    was = np.abs([e - g for e, g in pairs]) / RATE
    return Retiming(
        moments,
        float(np.sqrt(np.mean(off**2))),
        float(np.sqrt(np.mean(was**2))),
        len(pairs),
        float(np.abs(shown[events] - events).max()) / RATE,
        float((np.abs(slowness - 1) > 0.01).sum()) / RATE,
    )


def _pairs(
    way: Array, heard: HeardStates, places: Mapping[int, int], reach: float | None
) -> list[tuple[int, int]]:
    """Return which frames of a path are the events that are wanted at which, in the order of the path; one
    that lies at the beginning or the end, or before the one found last, is left out.
    """
    out: list[tuple[int, int]] = []
    at = {what: np.flatnonzero(heard.happens(what)[way]) for what in (STRESS, EDGE)}
    order = [p for p in places if 0 < p < len(way) - 1]
    for number, place in enumerate(order):
        near = at[places[place]]
        before = order[number - 1] if number else -place
        after = order[number + 1] if number + 1 < len(order) else 2 * len(way)
        most = min(place - before, after - place) / 2 if reach is None else reach
        if not len(near):
            continue
        found = int(near[np.abs(near - place).argmin()])
        if abs(found - place) <= most and 0 < found < len(way) - 1 and (not out or found > out[-1][0]):
            out.append((found, place))
    return out


def _changeable(steady: Array, a: int, b: int) -> Array:
    """Return `[b - a]` how much speed may change between the frames a and b, 0..1: all that it may in each
    stretch that is not steady, except for its ends, where it rises and falls by a cosine. Stretches too short
    to rise and fall in have none.
    """
    out = np.zeros(b - a)
    for first, after in _stretches(~steady[a:b]):
        if after - first >= 2 * RAMP:
            within = np.arange(after - first) + 0.5
            end = np.minimum(within, within[::-1])
            out[first:after] = 0.5 - 0.5 * np.cos(np.pi * np.minimum(end / RAMP, 1))
    return out


def _moved(goal: Array, room: Array) -> Array:
    """Return by how many frames each knot is moved, the first and the last by none: two neighbours by no more
    than `room` apart, none farther off than it was, or than a frame, and squares of what is then missing
    least.
    """
    most = float(np.abs(goal).max())
    steps = np.arange(-round(most / STEP), round(most / STEP) + 1) * STEP
    apart = np.abs(steps[:, None] - steps)
    nothing = np.abs(steps) < STEP / 2
    cost = np.where(nothing, 0.0, np.inf)
    back = []
    for number in range(1, len(goal)):
        ways = cost[:, None] + np.where(apart <= room[number - 1] + 1e-9, EASY * apart**2, np.inf)
        back.append(ways.argmin(0))
        missing = np.abs(steps - goal[number])
        worse = missing > max(abs(goal[number]), 1.0) + 1e-9
        cost = np.where(worse, np.inf, ways.min(0) + missing**2)
        if number == len(goal) - 1:
            cost = np.where(nothing, cost, np.inf)
    at = int(cost.argmin())
    out = [at]
    for before in reversed(back):
        at = int(before[at])
        out.append(at)
    return np.asarray(steps[out[::-1]])


def make_timing_cost(
    heard: HeardStates, wanted: WantedSegment, limit: float, price: float = NEARER
) -> FrameCost | None:
    """Return what frames cost in which an event comes early or late, so that there is less to retime: none
    where it is in time, as much as `price` of the graph's threshold (limit, metres) where it is off by as
    much as it may be, its square between. None if no event is wanted.
    """
    frames, order = len(wanted), list(wanted.places.items())
    inside = np.flatnonzero(wanted.window >= 0)
    if not len(inside):
        return None
    place, what = np.array(order).T
    number = wanted.window[inside]
    away = np.abs(inside - place[number])
    most = int(away.max())
    if not most:
        return None
    kinds = (STRESS, EDGE)
    rows = np.concatenate(
        [(np.arange(most + 1)[:, None] / most) ** 2 * heard.happens(kind) for kind in kinds]
    )
    at = np.full(frames, -1, np.int32)
    at[inside] = away + (what[number] == EDGE) * (most + 1)
    return FrameCost("timing", at, (price * limit * rows).astype(np.float32))


def keeps_constraints(way: Array, moments: Array, heard: HeardStates, wanted: WantedSegment) -> bool:
    """Return whether a path that is shown so, moments `[T]` of its states, has what is wanted: kinds, events
    in their windows and no others, words. What is between frames counts as at the nearest.
    """
    frames = len(way)
    shown = way[np.clip(np.rint(moments).astype(np.int64), 0, frames - 1)]
    if not ((heard.kinds[shown] & wanted.allowed) != 0).all():
        return False
    if not all(near[shown[t]] for t, near in wanted.only.items() if t < frames):
        return False
    times = np.rint(np.interp(np.arange(frames), moments, np.arange(frames))).astype(np.int64)
    met = set()
    for what in (STRESS, EDGE):
        for t in times[heard.happens(what)[way]].tolist():
            if wanted.bars(t) & what:
                return False
            if wanted.window[t] >= 0 and wanted.event(t) == what:
                met.add(int(wanted.window[t]))
    return met >= set(wanted.window[wanted.window >= 0].tolist())
