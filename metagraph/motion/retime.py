"""A clip played faster or slower, and held for a while at moments of it: as many frames a second, with other
poses in them. The clip itself stays as it was read.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.motion.clip import Clip
from metagraph.motion.contact_hold import MOST as HANDS
from metagraph.motion.contact_hold import Contact, hold_hands

Array = NDArray[Any]

SPEEDS = (0.1, 4.0)  # least and greatest
LONGEST = 20.0  # seconds of a hold
SHORTEST = 0.02  # seconds of a hold worth the name
MOST = 16  # holds of a clip
RAMP = 0.16  # seconds in which a hold is come to and left, so that nothing stops dead
FINE = 480.0  # moments a second at which a clip's course is computed


@dataclass(frozen=True, slots=True)
class Hold:
    """at: seconds of the clip as it was read. seconds: how much longer it stays there."""

    at: float
    seconds: float


@dataclass(frozen=True, slots=True)
class Retime:
    """speed: of all of it, 1 as it was read. holds: by time. contacts: hands that stay where they are."""

    speed: float = 1.0
    holds: tuple[Hold, ...] = ()
    contacts: tuple[Contact, ...] = ()

    @property
    def plain(self) -> bool:
        """Whether the clip is as it was read."""
        return self == Retime()

    def kept(self, duration: float) -> Retime:
        """Return it with everything in range, for a clip of some seconds: a speed of `SPEEDS`, at most `MOST`
        holds of at most `LONGEST` seconds at different moments within the clip.
        """
        holds: dict[float, float] = {}
        for hold in sorted(self.holds, key=lambda h: h.at):
            seconds = round(min(hold.seconds, LONGEST), 3)
            if seconds >= SHORTEST:
                holds[round(min(max(0.0, hold.at), duration), 3)] = seconds
        speed = round(min(max(self.speed, SPEEDS[0]), SPEEDS[1]), 3)
        contacts = tuple(
            replace(c, first=round(max(0.0, c.first), 3), last=round(min(c.last, duration), 3))
            for c in self.contacts
            if c.first < min(c.last, duration)
        )
        return Retime(speed, tuple(Hold(at, s) for at, s in list(holds.items())[:MOST]), contacts[:HANDS])


class Course:
    """Which moment of a clip plays when. duration: seconds of the clip as it was read; frames, fps: of the
    clip that comes of it. stays: for each hold when it begins and ends, seconds of what comes of it.
    """

    def __init__(self, retime: Retime, duration: float, fps: float) -> None:
        self.retime = retime
        pieces = list(_pieces(retime, duration))
        whole = sum(seconds for seconds, *_ in pieces)
        self.frames = max(1, round(whole * fps) + 1)
        self.fps = fps
        stretch = ((self.frames - 1) / fps / whole) if whole > 0 else 1.0  # it ends on a frame
        times, moments, stays = [np.zeros(1)], [np.zeros(1)], []
        now = 0.0
        for seconds, first, speed, shape in pieces:
            count = max(2, int(seconds * FINE) + 1)
            part = np.linspace(0, 1, count)[1:]
            times.append(now + part * seconds)
            moments.append(first + speed * seconds * _SHAPES[shape](part))
            if shape == "stay":
                stays.append((now * stretch, (now + seconds) * stretch))
            now += seconds
        self._times = np.concatenate(times) * stretch
        self._moments = np.maximum.accumulate(np.minimum(np.concatenate(moments), duration))
        self.stays = tuple(stays)

    def moments(self, times: Array) -> Array:
        """Return the seconds of the clip as it was read that play at `times [...]`."""
        return np.asarray(np.interp(times, self._times, self._moments))

    def time(self, moment: float, late: bool = False) -> float:
        """Return when a moment of the clip as it was read plays; late: when it is left, where it is held."""
        side = "right" if late else "left"
        slack = 1e-6 if late else -1e-6
        place = int(np.searchsorted(self._moments, moment + slack, side=side))  # type: ignore[call-overload]
        if place >= len(self._times):
            return float(self._times[-1])
        if place == 0:
            return float(self._times[0])
        a, b = self._moments[place - 1], self._moments[place]
        part = min(max((moment - a) / (b - a), 0.0), 1.0) if b > a else 1.0
        return float(self._times[place - 1] + part * (self._times[place] - self._times[place - 1]))

    def along(self, seconds: float, other: Course, late: bool = False) -> float:
        """Return when what plays at some seconds here plays in another course of the same clip: within a hold
        that both have, as far into it. late: at the end of a hold that only the other has.
        """
        seconds = min(max(0.0, seconds), float(self._times[-1]))
        for hold, (first, last) in zip(self.retime.holds, self.stays, strict=True):
            if first <= seconds <= last and last > first:
                there = [o for h, o in zip(other.retime.holds, other.stays, strict=True) if h.at == hold.at]
                if there:
                    return there[0][0] + (seconds - first) / (last - first) * (there[0][1] - there[0][0])
        return other.time(float(self.moments(np.array(seconds))), late)


_SHAPES = {
    "go": lambda u: u,
    "stay": lambda u: 0.0 * u,
    "slow": lambda u: u - u**3 + u**4 / 2,  # its speed falls smoothly to nothing
    "leave": lambda u: u**3 - u**4 / 2,
}


def _pieces(retime: Retime, duration: float) -> Iterable[tuple[float, float, float, str]]:
    """Return seconds each piece takes, the moment it begins at, its speed and its shape."""
    speed, now = retime.speed, 0.0
    ramps = _ramps(retime, duration)
    for hold, ramp in zip(retime.holds, ramps, strict=True):
        before = hold.at - speed * ramp / 2
        if before > now:
            yield (before - now) / speed, now, speed, "go"
        if ramp > 0:
            yield ramp, before, speed, "slow"
        yield max(0.0, hold.seconds - ramp), hold.at, 0.0, "stay"
        if ramp > 0:
            yield ramp, hold.at, speed, "leave"
        now = hold.at + speed * ramp / 2
    if duration > now:
        yield (duration - now) / speed, now, speed, "go"


def _ramps(retime: Retime, duration: float) -> list[float]:
    """Return in how many seconds each hold is come to: less where another, or an end of the clip, is near."""
    moments = [h.at for h in retime.holds]
    gaps = [b - a for a, b in pairwise(moments)]
    out = []
    for n, hold in enumerate(retime.holds):
        before = gaps[n - 1] / 2 if n else hold.at
        after = gaps[n] / 2 if n < len(gaps) else duration - hold.at
        out.append(max(0.0, min(RAMP, hold.seconds, 2 * before / retime.speed, 2 * after / retime.speed)))
    return out


def apply_retiming(clip: Clip, retime: Retime) -> Clip:
    """Return a clip as a retiming plays it; the same clip if that is as it is."""
    if retime.plain or clip.frames < 2:
        return clip
    clip = hold_hands(clip, retime.contacts)
    if retime.speed == 1.0 and not retime.holds:
        return clip
    course = Course(retime, clip.duration, clip.fps)
    moments = course.moments(np.arange(course.frames) / clip.fps)
    pose = clip.pose_at(moments)
    return replace(
        clip,
        rotations=pose.rotations,
        translations=pose.translations[:, list(clip.translated)],
        weights=clip.weights_at(moments),
    )
