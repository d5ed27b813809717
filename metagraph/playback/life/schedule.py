"""When the life layers do what: drawn from the seed, event by event, then pure in time.

Each event depends only on the one before it and on what is asked meanwhile, and its chance on its number. So
a schedule grows as a plan does: what has begun stays, tick by tick gives what one call gives, and what lies
behind can be forgotten.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from math import ceil, inf, log, pi, sin
from typing import Any

import numpy as np

from metagraph.graph.life import Life, manner
from metagraph.graph.words import MODES, Mode
from metagraph.playback.choice import uniform
from metagraph.playback.life.lane import Lane, lane
from metagraph.playback.life.track import Track
from metagraph.playback.life.voice import Voice, voice_of
from metagraph.playback.life.wanted import GazeTarget, modes_between, targets_between

BLOCK = 8.0  # seconds drawn at a time, so that a running plan need not draw at every tick
RECALL = 4.0  # seconds of looks kept when the past is forgotten: longer than any turn of the head takes

# Blinks (Yang et al., section 7.3): on stressed syllables at least so many seconds after the last; of
# themselves 2 to 5 s after it at 17 a minute: the factors are of the mean gap.
AFTER_BLINK = 1.0
BLINK_GAPS = (0.57, 0.845)  # the shortest gap, and what chance adds to it
# Saccades: fixations last 0.2 s and more; sizes fall off as in "Eyes Alive", small ones only: the eyes stay
# with what they look at.
FIXATION = 0.2
SACCADE, LARGEST_SACCADE, UPRIGHT = 1.2, 4.0, 0.6  # degrees on average, at most; of that, up and down
# Aversions: at somewhat regular intervals, in a random direction, more often to the sides.
AVERSION_GAPS = (0.6, 0.8)
BETWEEN_AVERSIONS = 0.6  # seconds at least
SHORTEST_AVERSION = 0.25
BREATHS = (0.85, 0.3)  # of the mean length and depth: the least, and what chance adds


@dataclass(frozen=True)
class Schedule:
    """Everything that happens of itself from 0 to `end` seconds, in lanes; a lane's values stand in the order
    given here.

    modes: place among MODES. targets: what is looked at. breaths: length s, depth. aversions: end s,
    right-to-left and upward part of the offset (of life's angle). saccades: offset to the left and up,
    degrees. blinks: 0 of itself, 1 on a stressed syllable, 2 asked for. drawn: seconds up to which the lanes
    are filled; the rest is what they were drawn from.
    """

    end: float = 0.0
    drawn: float = 0.0
    modes: Lane = field(default_factory=lambda: lane(1))
    targets: tuple[GazeTarget, ...] = ()
    breaths: Lane = field(default_factory=lambda: lane(2))
    aversions: Lane = field(default_factory=lambda: lane(3))
    saccades: Lane = field(default_factory=lambda: lane(2))
    blinks: Lane = field(default_factory=lambda: lane(1))
    life: Life | None = field(default=None, compare=False, repr=False)
    track: Track | None = field(default=None, compare=False, repr=False)
    voices: Mapping[str, Voice] | None = field(default=None, compare=False, repr=False)
    seed: int = field(default=0, compare=False)

    def since(self, seconds: float) -> Schedule:
        """Return the schedule without what ended before `seconds`; what is drawn on from it stays as it would
        have been.
        """
        lanes = {name: getattr(self, name).since(seconds) for name in _RANDOM}
        # Gaps run in modes' time from the event before, so the modes since then are needed.
        idle = [
            name
            for name, kept in lanes.items()
            if not len(kept) and (self.life is None or getattr(self.life, _RANDOM[name]) > 0)
        ]
        needed = (
            0.0
            if idle
            else min([float(kept.starts[0]) for kept in lanes.values() if len(kept)], default=seconds)
        )
        kept = max(0, bisect_right(self.targets, min(needed, seconds - RECALL), key=_start) - 1)
        return replace(self, modes=self.modes.since(needed, 0), targets=self.targets[kept:], **lanes)


def _start(target: GazeTarget) -> float:
    return target.start


_RANDOM = {
    "breaths": "breath_rate",
    "aversions": "aversion_rate",
    "saccades": "saccade_rate",
    "blinks": "blinks",
}


def schedule(
    life: Life, track: Track, voices: Mapping[str, Voice], seed: int, end: float, before: Schedule, now: float
) -> Schedule:
    """Return the schedule to `end` seconds. What `before` holds that begins before `now` stays exactly as it
    was.

    What it holds for later is kept, too, where nothing it was drawn from has changed.
    """
    if not life.on:
        return replace(before, end=end, life=life, track=track, voices=voices, seed=seed)
    drawn = max(BLOCK, ceil(end / BLOCK) * BLOCK)
    change = _change(before, life, track, voices, seed)
    if change is None and drawn == before.drawn:
        return replace(before, end=end)
    cut = max(0.0, min(before.drawn, drawn if change is None else now))
    chance = cut if change != "places" else min(before.drawn, drawn)
    draw = _Draw(life, track, voices, seed, cut, drawn, before)
    kept = {name: getattr(before, name).until(chance) for name in _RANDOM}
    if chance < drawn:
        draw.begin(chance)
        kept = {name: getattr(draw, name)(kept[name]) for name in _RANDOM}
    return Schedule(
        end, drawn, draw.modes, draw.targets, **kept, life=life, track=track, voices=voices, seed=seed
    )


def _change(before: Schedule, life: Life, track: Track, voices: Mapping[str, Voice], seed: int) -> str | None:
    """Return None where nothing a schedule was drawn from has changed, "places" where only those have, else
    "all".
    """
    old = before.track
    if (
        before.life != life
        or before.seed != seed
        or (before.voices is not voices and before.voices != voices)
        or old is None
    ):
        return "all"
    if old is track or old == track:
        return None
    same = (
        old.looks == track.looks
        and old.speeches == track.speeches
        and old.modes == track.modes
        and old.blinks == track.blinks
    )
    return "places" if same else "all"


class _Draw:
    """One extension: lanes filled from `cut` to `drawn`."""

    def __init__(
        self,
        life: Life,
        track: Track,
        voices: Mapping[str, Voice],
        seed: int,
        cut: float,
        drawn: float,
        before: Schedule,
    ) -> None:
        self.life, self.track, self.voices, self.seed, self.drawn = life, track, voices, seed, drawn
        self.cut = cut
        modes = before.modes.until(cut)
        last = int(modes.values[-1, 0]) if len(modes) else -1
        new = [(at, m) for at, m in modes_between(track, cut, drawn)]
        if new and new[0][1] == last:
            new = new[1:]
        self.modes = modes.plus([at for at, _ in new], [(m,) for _, m in new])
        targets = before.targets[: bisect_left(before.targets, cut, key=_start)]
        for target in targets_between(track, cut, drawn):
            if not targets or not target.like(targets[-1]):
                targets = (*targets, target)
        self.targets = targets
        self.calm = 1.0 - life.stillness
        self._edges: list[float] = []
        self._modes: list[Mode] = []
        self._strict: list[bool] = []

    def begin(self, cut: float) -> None:
        """Lay modes and strict looks out in one row of segments."""
        self.cut = cut
        starts, kinds = self.modes.starts.tolist(), self.modes.values[:, 0].astype(int).tolist()
        for edge in sorted(
            {
                *starts,
                *(
                    t.start
                    for n, t in enumerate(self.targets)
                    if n == 0 or t.strict != self.targets[n - 1].strict
                ),
            }
        ):
            self._edges.append(edge)
            self._modes.append(MODES[kinds[max(0, bisect_right(starts, edge) - 1)]])
            self._strict.append(self.targets[max(0, bisect_right(self.targets, edge, key=_start) - 1)].strict)

    def chance(self, *words: str) -> float:
        return uniform(self.seed, *words)

    def mode(self, seconds: float) -> Mode:
        return self._modes[max(0, bisect_right(self._edges, seconds) - 1)]

    def after(self, seconds: float, need: float, speed: Callable[[Mode, bool], float]) -> float:
        """Return when `need` has passed since `seconds`, for a clock that runs at `speed(mode, strict)`; inf
        where it is not before the end.
        """
        place = max(0, bisect_right(self._edges, seconds) - 1)
        while seconds < self.drawn:
            end = self._edges[place + 1] if place + 1 < len(self._edges) else self.drawn
            rate = speed(self._modes[place], self._strict[place])
            if rate > 0 and seconds + need / rate < end:
                return seconds + need / rate
            need -= rate * max(0.0, end - seconds)
            seconds, place = end, place + 1
        return inf

    # --- the lanes

    def breaths(self, lane: Lane) -> Lane:
        """Each breath follows the one before; the first began before time 0, so that not everybody breathes
        alike.
        """
        starts: list[float] = []
        values: list[tuple[float, float]] = []
        n = lane.next
        at = float(lane.starts[-1] + lane.values[-1, 0]) if len(lane) else None
        while True:
            if at is not None:
                at = max(at, self.cut)
            ways = manner(self.life, self.mode(at or 0.0))
            rate = self.life.breath_rate * ways.breath_rate / 60
            if rate <= 0:  # no breath until another mode begins
                later = bisect_right(self._edges, at or 0.0)
                if self.life.breath_rate <= 0 or later == len(self._edges):
                    break
                at = self._edges[later]
                continue
            length = (BREATHS[0] + BREATHS[1] * self.chance("breath", str(n), "length")) / rate
            length *= 1 + 2 * self.life.stillness  # slower, too, but never halting
            depth = ways.breathing * (BREATHS[0] + BREATHS[1] * self.chance("breath", str(n), "depth"))
            if at is None:
                at = -length * self.chance("breath", "first")
            if at >= self.drawn:
                break
            starts.append(at)
            values.append((length, depth))
            at, n = at + length, n + 1
        return lane.plus(starts, values)

    def saccades(self, lane: Lane) -> Lane:
        life = self.life
        if life.saccade_rate <= 0 or self.calm <= 0:
            return lane
        mean = max(60 / life.saccade_rate, FIXATION + 0.01)

        def next_one(n: int, last: float) -> tuple[float, tuple[float, ...], float]:
            need = FIXATION + (mean - FIXATION) * min(4.0, -log(self.chance("saccade", str(n), "gap")))
            at = max(self.cut, self.after(last, need, lambda m, _: manner(life, m).saccade_rate * self.calm))
            size = min(LARGEST_SACCADE, -SACCADE * log(self.chance("saccade", str(n), "size")))
            size *= manner(life, self.mode(at)).saccades if at < inf else 0.0
            turn = 2 * pi * self.chance("saccade", str(n), "way")
            return at, (size * sin(turn + pi / 2), UPRIGHT * size * sin(turn)), at

        return self._one_by_one(lane, float(lane.starts[-1]) if len(lane) else 0.0, next_one)

    def aversions(self, lane: Lane) -> Lane:
        life = self.life
        if life.aversion_rate <= 0 or life.aversion_length <= 0 or life.aversion_angle <= 0 or self.calm <= 0:
            return lane

        def speed(mode: Mode, strict: bool) -> float:
            ways = manner(life, mode)
            rate = life.aversion_rate * ways.aversion_rate
            if strict or rate <= 0:
                return 0.0
            return self.calm / max(BETWEEN_AVERSIONS, 60 / rate - life.aversion_length * ways.aversion_length)

        def next_one(n: int, last: float) -> tuple[float, tuple[float, ...], float]:
            need = AVERSION_GAPS[0] + AVERSION_GAPS[1] * self.chance("aversion", str(n), "gap")
            at = max(self.cut, last + BETWEEN_AVERSIONS, self.after(last, need, speed))
            ways = manner(life, self.mode(at)) if at < inf else manner(life, "idle")
            length = (
                life.aversion_length
                * ways.aversion_length
                * (0.6 + 0.8 * self.chance("aversion", str(n), "length"))
            )
            end = at + max(SHORTEST_AVERSION, length)
            size = ways.aversion_angle * (0.7 + 0.6 * self.chance("aversion", str(n), "size"))
            turn = 2 * pi * self.chance("aversion", str(n), "way")
            return at, (end, size * sin(turn + pi / 2), UPRIGHT * size * sin(turn)), end

        return self._one_by_one(lane, float(lane.values[-1, 0]) if len(lane) else 0.0, next_one)

    def blinks(self, lane: Lane) -> Lane:
        life = self.life
        shut = life.blink_close + life.blink_open
        mean = 60 / life.blinks if life.blinks > 0 and self.calm > 0 else inf
        last = float(lane.starts[-1]) if len(lane) else -0.5 * min(mean, 10.0) * self.chance("blink", "first")
        accents = (
            list(self._accents(max(0.0, min(self.cut, last))))
            if self.calm > 0 and life.accent_blinks > 0
            else []
        )
        asked = [b.start for b in self.track.blinks]
        starts: list[float] = []
        values: list[tuple[float]] = []
        n, place = lane.next, 0
        while True:
            need = mean * (BLINK_GAPS[0] + BLINK_GAPS[1] * self.chance("blink", str(n), "gap"))
            own = (
                max(self.cut, self.after(last, need, lambda m, _: manner(life, m).blinks * self.calm))
                if need < inf
                else inf
            )
            while place < len(accents) and not self._suits(accents[place], last, shut):
                place += 1
            stressed = accents[place][0] if place < len(accents) else inf
            wish = bisect_left(asked, max(self.cut, last + shut))
            wanted = asked[wish] if wish < len(asked) else inf
            at = min(own, stressed, wanted)
            if at >= self.drawn:
                return lane.plus(starts, values)
            starts.append(at)
            values.append((2.0 if at == wanted else 1.0 if at == stressed else 0.0,))
            last, n = at, n + 1

    def _suits(self, accent: tuple[float, bool], last: float, shut: float) -> bool:
        """Whether a stressed syllable may bring a blink: the first of a speech always, the others some time
        after the last blink.
        """
        at, first = accent
        return at >= self.cut and at >= last + (shut + 0.1 if first else AFTER_BLINK / self.calm)

    def _accents(self, start: float) -> Iterator[tuple[float, bool]]:
        """Yield the stressed syllables from `start` to the end that may bring blinks, and whether each is a
        speech's first.
        """
        for speech in self.track.speeches:
            if speech.end <= start or speech.start >= self.drawn:
                continue
            for n, peak in enumerate(voice_of(self.voices, speech).accents.tolist()):
                at = speech.start + peak
                if (
                    start <= at < min(speech.end, self.drawn)
                    and self.chance(speech.id, "accent", str(n)) < self.life.accent_blinks
                ):
                    yield at, n == 0

    def _one_by_one(
        self, lane: Lane, last: float, next_one: Callable[[int, float], tuple[float, Any, float]]
    ) -> Lane:
        """Draw events until the end: `next_one(number, last)` gives start, values and where the next gap
        begins.
        """
        starts: list[float] = []
        values: list[Any] = []
        n = lane.next
        while True:
            at, value, last = next_one(n, last)
            if not at < self.drawn:
                return lane.plus(starts, values)
            starts.append(at)
            values.append(value)
            n += 1


def share(lane: Lane, start: float, end: float) -> float:
    """Return events a minute between two times."""
    low, high = np.searchsorted(lane.starts, (start, end))
    return float(high - low) / max(end - start, 1e-9) * 60
