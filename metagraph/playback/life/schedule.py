"""The events of the life layers: drawn from the seed one by one, and then a function of time.

Each event depends only on the previous one and on the requests meanwhile; its random draw depends on its
number. So a schedule grows as a plan does: events that have begun stay, many short extensions give the same
as one long one, and past events can be forgotten.
"""

from __future__ import annotations

import math
from bisect import bisect_left, bisect_right
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from metagraph.graph.life import Life, Manner, get_manner, is_same_life
from metagraph.graph.words import MODES
from metagraph.playback.life.expressions import emphases_on, swells_on
from metagraph.playback.life.items import find_line_start
from metagraph.playback.life.lane import Lane
from metagraph.playback.life.track import Track
from metagraph.playback.life.voice import Voice, are_same_voices, stressed
from metagraph.playback.life.wanted import (
    GazeTarget,
    modes_between,
    moods_between,
    moods_of,
    targets_between,
    ways_in,
)
from metagraph.playback.planning.choice import chance_of, keyed, log_normal, uniform
from metagraph.playback.planning.hashing import Bits
from metagraph.playback.planning.mood import Mood

BLOCK = 8.0  # seconds drawn at a time, so that a running plan need not draw at every tick
RECALL = 4.0  # seconds of looks kept when the past is forgotten: longer than any turn of the head takes

# Blinks: on stressed syllables at least so many seconds after the last (Yang et al., section 7.3); of
# themselves after gaps that spread as people's do, log-normal, a few of them doubles.
AFTER_BLINK = 1.0
BLINK_SPREAD = 0.7  # standard deviation of the gaps, times their mean
DOUBLES = 0.06  # share of blinks that follow the one before at once
DOUBLE = 0.4  # seconds after which they do
HALVES = 0.12  # share of blinks by themselves that are incomplete
HALF = 0.6  # how far these shut the eyes
# Saccades: fixations last 0.2 s and more; sizes fall off as in "Eyes Alive", small ones only: the eyes stay
# with what they look at.
FIXATION = 0.2
SACCADE = 1.2  # degrees on average
LARGEST_SACCADE = 4.0  # degrees
UPRIGHT = 0.6  # how much of an offset goes up and down
# Aversions: at somewhat regular intervals, in a random direction, more often to the sides.
AVERSION_GAP = 0.6
AVERSION_CHANCE = 0.8
BETWEEN_AVERSIONS = 0.6  # seconds at least
SHORTEST_AVERSION = 0.25
BREATH = 0.85  # of the mean length and depth: the least
BREATH_CHANCE = 0.3  # and what chance adds
# A character breathes in before it speaks: a breath begins so long before the first word, and the one before
# it is shortened or drawn out by so much of its length at most. Ours.
BREATHES_IN = 0.55  # seconds
STRETCH = 0.5


@dataclass(frozen=True)
class Schedule:
    """Everything that the life layers do by themselves from 0 to `end` seconds, in lanes. The columns of a
    lane's rows are listed here.

    modes: index in MODES. moods: valence, arousal, intensity. targets: what the gaze looks at. breaths:
    length s, depth. aversions: end s, right-to-left and upward part of the offset (of life's angle).
    saccades: offset to the left and up, degrees. blinks: 0 spontaneous, 1 on a stressed syllable, 2
    requested, 3 spontaneous and incomplete. swells, emphases: of the face (`expressions`). drawn: seconds up
    to which the lanes are filled; the rest is what they were drawn from.
    """

    end: float = 0.0
    drawn: float = 0.0
    modes: Lane = Lane(width=1)
    moods: Lane = Lane(width=3)
    targets: Sequence[GazeTarget] = ()
    breaths: Lane = Lane(width=2)
    aversions: Lane = Lane(width=3)
    saccades: Lane = Lane(width=2)
    blinks: Lane = Lane(width=1)
    swells: Lane = Lane(width=3)
    emphases: Lane = Lane(width=3)
    life: Life | None = field(default=None, compare=False, repr=False)
    track: Track | None = field(default=None, compare=False, repr=False)
    voices: Mapping[str, Voice] | None = field(default=None, compare=False, repr=False)
    seed: Bits = field(default=0, compare=False)

    def since(self, seconds: float) -> Schedule:
        """Return the schedule without events that ended before `seconds`; later draws do not change."""
        breaths = self.breaths.since(seconds)
        aversions = self.aversions.since(seconds)
        saccades = self.saccades.since(seconds)
        blinks = self.blinks.since(seconds)
        rates = [1.0, 1.0, 1.0, 1.0]
        if self.life is not None:
            rates = [
                self.life.breath_rate, self.life.aversion_rate, self.life.saccade_rate, self.life.blinks
            ]  # fmt: skip
        # Gaps run in modes' time from the event before, so the modes since then are needed.
        lanes = [breaths, aversions, saccades, blinks]
        firsts = [kept.times[0] for kept in lanes if len(kept.times) > 0]
        needed = min(firsts) if len(firsts) > 0 else seconds
        if any(len(kept.times) == 0 and rate > 0 for kept, rate in zip(lanes, rates, strict=True)):
            needed = 0.0
        looked = bisect_right(self.targets, min(needed, seconds - RECALL), key=lambda t: t.start) - 1
        return replace(
            self,
            modes=self.modes.since(needed, 0),
            moods=self.moods.since(min(needed, seconds - RECALL), 0),
            targets=self.targets[max(0, looked) :],
            breaths=breaths,
            aversions=aversions,
            saccades=saccades,
            blinks=blinks,
            swells=self.swells.since(seconds),
            emphases=self.emphases.since(seconds, 3),
        )


def schedule(
    life: Life,
    track: Track,
    voices: Mapping[str, Voice],
    seed: Bits,
    end: float,
    before: Schedule,
    now: float,
) -> Schedule:
    """Return the schedule to `end` seconds. Events of `before` that begin before `now` stay exactly as they
    were.

    Its later events stay, too, if nothing that they were drawn from has changed.
    """
    if not life.on:
        return replace(before, end=end, life=life, track=track, voices=voices, seed=seed)
    drawn = max(BLOCK, math.ceil(end / BLOCK) * BLOCK)
    change = _change(before, life, track, voices, seed)
    if change == "" and drawn == before.drawn:
        return replace(before, end=end)
    cut = max(0.0, min(before.drawn, drawn if change == "" else now))
    chance = min(before.drawn, drawn) if change == "places" else cut
    draw = _draw(life, track, voices, seed, cut, drawn, before)
    breaths = before.breaths.until(chance)
    aversions = before.aversions.until(chance)
    saccades = before.saccades.until(chance)
    blinks = before.blinks.until(chance)
    swells = before.swells.until(chance)
    emphases = before.emphases.until(chance)
    if chance < drawn:
        draw.begin(chance)
        breaths = draw.breaths(breaths)
        aversions = draw.aversions(aversions)
        saccades = draw.saccades(saccades)
        blinks = draw.blinks(blinks)
        swells = swells_on(track, seed, chance, drawn, swells)
        emphases = emphases_on(life, track, voices, seed, chance, drawn, emphases)
    return Schedule(
        end, drawn, draw.modes, draw.moods, draw.targets, breaths, aversions, saccades, blinks,
        swells, emphases, life, track, voices, seed,
    )  # fmt: skip


def _change(before: Schedule, life: Life, track: Track, voices: Mapping[str, Voice], seed: Bits) -> str:
    """Return "" if nothing that a schedule was drawn from has changed, "places" if only places have, else
    "all".
    """
    if before.track is None or before.seed != seed or not is_same_life(before.life, life):
        return "all"
    if not are_same_voices(before.voices, voices):
        return "all"
    if before.track is track or before.track.like(track):
        return ""
    return "places" if before.track.draws_like(track) else "all"


@dataclass
class LifeDraw:
    """One extension: lanes filled from `cut` to `drawn` seconds. edges: when modes, moods or strict looks
    change; manners: the factors of the amounts from each edge on; strict: 1 if the look is strict from there
    on, else 0. phrases: when the character begins to speak.
    """

    life: Life
    track: Track
    voices: Mapping[str, Voice]
    seed: Bits
    cut: float
    drawn: float
    calm: float
    modes: Lane
    moods: Lane
    targets: Sequence[GazeTarget]
    edges: list[float] = field(default_factory=list)
    manners: list[Manner] = field(default_factory=list)
    strict: list[int] = field(default_factory=list)
    phrases: list[float] = field(default_factory=list)

    def begin(self, cut: float) -> None:
        """Combine modes, moods and strict looks into one list of segments."""
        self.cut = cut
        talks = [change.start for change in self.track.modes if change.mode == "talking"]
        self.phrases = sorted([*[speech.start for speech in self.track.speeches], *talks])
        edges = list(self.modes.times)
        edges += self.moods.times
        for n, target in enumerate(self.targets):
            if n == 0 or target.strict != self.targets[n - 1].strict:
                edges.append(target.start)
        begun = [t.start for t in self.targets]
        for edge in sorted(edges):
            if len(self.edges) > 0 and self.edges[-1] == edge:
                continue
            mode = max(0, bisect_right(self.modes.times, edge) - 1)
            look = max(0, bisect_right(begun, edge) - 1)
            self.edges.append(edge)
            felt = self.moods.rows[max(0, bisect_right(self.moods.times, edge) - 1)]
            ways = get_manner(self.life, MODES[int(self.modes.rows[mode][0])])
            self.manners.append(ways_in(ways, Mood(felt[0], felt[1], felt[2])))
            self.strict.append(1 if self.targets[look].strict else 0)

    def key(self, what: str, number: int) -> Bits:
        """Return the key of an event's random numbers, for `chance_of`."""
        return keyed(self.seed, what, str(number))

    def place_at(self, seconds: float) -> int:
        """Return the index of the segment that contains a time."""
        return max(0, bisect_right(self.edges, seconds) - 1)

    def thinks(self, seconds: float) -> bool:
        """Return whether the character is thinking at a time: then it looks up and aside, never down."""
        mode = max(0, bisect_right(self.modes.times, seconds) - 1)
        return MODES[int(self.modes.rows[mode][0])] == "thinking"

    def after(self, seconds: float, need: float, rates: Sequence[float]) -> float:
        """Return when `need` seconds have passed since `seconds` on a clock that runs at these rates, one for
        each segment; infinity if that is after the end.
        """
        at = seconds
        left = need
        place = self.place_at(at)
        while at < self.drawn:
            end = self.edges[place + 1] if place + 1 < len(self.edges) else self.drawn
            rate = rates[place]
            if rate > 0 and at + left / rate < end:
                return at + left / rate
            left -= rate * max(0.0, end - at)
            at = end
            place += 1
        return math.inf

    def breaths(self, lane: Lane) -> Lane:
        """Draw breaths, each after the previous one. The first began before time 0, so that characters do not
        breathe in step.
        """
        times: list[float] = []
        rows: list[list[float]] = []
        number = lane.next
        begun = len(lane.times) > 0
        at = lane.times[-1] + lane.rows[-1][0] if begun else 0.0
        while True:
            if begun:
                at = max(at, self.cut)
            ways = self.manners[self.place_at(at)]
            rate = self.life.breath_rate * ways.breath_rate / 60.0
            if rate <= 0:  # no breath until another mode begins
                later = bisect_right(self.edges, at)
                if self.life.breath_rate <= 0 or later == len(self.edges):
                    break
                at = self.edges[later]
                begun = True
                continue
            key = self.key("breath", number)
            length = (BREATH + BREATH_CHANCE * chance_of(key, "length")) / rate
            length *= 1.0 + 2.0 * self.life.stillness  # slower, too, but never halting
            length = self.to_phrase(at, length) if begun else length
            depth = ways.breathing * (BREATH + BREATH_CHANCE * chance_of(key, "depth"))
            if not begun:
                at = -length * uniform(self.seed, "breath", "first")
                begun = True
            if at >= self.drawn:
                break
            times.append(at)
            rows.append([length, depth])
            at += length
            number += 1
        return lane.plus(times, rows)

    def to_phrase(self, at: float, length: float) -> float:
        """Return the length of a breath that begins at `at`, so that the next one begins right before the
        character speaks.
        """
        place = bisect_left(self.phrases, at + (1.0 - STRETCH) * length + BREATHES_IN)
        if place == len(self.phrases):
            return length
        wanted = self.phrases[place] - BREATHES_IN - at
        return wanted if wanted <= (1.0 + STRETCH) * length else length

    def saccades(self, lane: Lane) -> Lane:
        """Draw the small jumps of the eyes."""
        if self.life.saccade_rate <= 0 or self.calm <= 0:
            return lane
        mean = max(60.0 / self.life.saccade_rate, FIXATION + 0.01)
        rates = [ways.saccade_rate * self.calm for ways in self.manners]
        times: list[float] = []
        rows: list[list[float]] = []
        number = lane.next
        last = lane.times[-1] if len(lane.times) > 0 else 0.0
        while True:
            key = self.key("saccade", number)
            need = FIXATION + (mean - FIXATION) * min(4.0, -math.log(chance_of(key, "gap")))
            last = max(self.cut, self.after(last, need, rates))
            if not last < self.drawn:
                return lane.plus(times, rows)
            size = min(LARGEST_SACCADE, -SACCADE * math.log(chance_of(key, "size")))
            size *= self.manners[self.place_at(last)].saccades
            turn = 2.0 * math.pi * chance_of(key, "way")
            times.append(last)
            rows.append([size * math.sin(turn + math.pi / 2.0), UPRIGHT * size * math.sin(turn)])
            number += 1

    def aversions(self, lane: Lane) -> Lane:
        """Draw short looks away."""
        life = self.life
        if life.aversion_rate <= 0 or life.aversion_length <= 0 or life.aversion_angle <= 0 or self.calm <= 0:
            return lane
        rates: list[float] = []
        for ways, strict in zip(self.manners, self.strict, strict=True):
            rate = life.aversion_rate * ways.aversion_rate
            if strict == 1 or rate <= 0:
                rates.append(0.0)
            else:
                mean = max(BETWEEN_AVERSIONS, 60.0 / rate - life.aversion_length * ways.aversion_length)
                rates.append(self.calm / mean)
        times: list[float] = []
        rows: list[list[float]] = []
        number = lane.next
        last = lane.rows[-1][0] if len(lane.rows) > 0 else 0.0
        while True:
            key = self.key("aversion", number)
            need = AVERSION_GAP + AVERSION_CHANCE * chance_of(key, "gap")
            at = max(self.cut, last + BETWEEN_AVERSIONS, self.after(last, need, rates))
            if not at < self.drawn:
                return lane.plus(times, rows)
            own = self.manners[self.place_at(at)]
            length = life.aversion_length * own.aversion_length
            length *= 0.6 + 0.8 * chance_of(key, "length")
            last = at + max(SHORTEST_AVERSION, length)
            size = own.aversion_angle * (0.7 + 0.6 * chance_of(key, "size"))
            turn = 2.0 * math.pi * chance_of(key, "way")
            up = UPRIGHT * size * math.sin(turn)
            times.append(at)
            rows.append([last, size * math.sin(turn + math.pi / 2.0), abs(up) if self.thinks(at) else up])
            number += 1

    def blinks(self, lane: Lane) -> Lane:
        """Draw blinks: spontaneous ones, those on stressed syllables and requested ones, in the order in
        which they come.
        """
        life = self.life
        shut = life.blink_close + life.blink_open
        mean = 60.0 / life.blinks if life.blinks > 0 and self.calm > 0 else math.inf
        rates = [ways.blinks * self.calm for ways in self.manners]
        last = -0.5 * min(mean, 10.0) * uniform(self.seed, "blink", "first")
        if len(lane.times) > 0:
            last = lane.times[-1]
        accents: list[tuple[float, bool]] = []
        if self.calm > 0 and life.accent_blinks > 0:
            accents = self.accents(max(0.0, min(self.cut, last)))
        asked = [b.start for b in self.track.blinks]
        times: list[float] = []
        rows: list[list[float]] = []
        number = lane.next
        place = 0
        while True:
            own = math.inf
            if mean < math.inf:
                key = self.key("blink", number)
                drawn = log_normal(mean, BLINK_SPREAD * mean, chance_of(key, "gap"), chance_of(key, "gap2"))
                need = DOUBLE if chance_of(key, "double") < DOUBLES else max(DOUBLE, drawn)
                own = max(self.cut, self.after(last, need, rates))
            # A stressed syllable may bring a blink: the first of a speech always, the others some time after
            # the last blink.
            while place < len(accents):
                accent, first = accents[place]
                if accent >= self.cut and accent >= last + (shut + 0.1 if first else AFTER_BLINK / self.calm):
                    break
                place += 1
            heard = accents[place][0] if place < len(accents) else math.inf
            wish = bisect_left(asked, max(self.cut, last + shut))
            wanted = asked[wish] if wish < len(asked) else math.inf
            at = min(own, heard, wanted)
            if at >= self.drawn:
                return lane.plus(times, rows)
            times.append(at)
            kind = 1.0 if at == heard else 0.0
            if at == own and at != heard and chance_of(self.key("blink", number), "half") < HALVES:
                kind = 3.0
            rows.append([2.0 if at == wanted else kind])
            last = at
            number += 1

    def accents(self, start: float) -> list[tuple[float, bool]]:
        """Return the stressed syllables from `start` to the end that may bring blinks, and whether each is a
        speech's first.
        """
        out: list[tuple[float, bool]] = []
        for speech in self.track.speeches:
            if speech.end <= start or speech.start >= self.drawn:
                continue
            end = min(speech.end, self.drawn)
            for n, peak in enumerate(stressed(self.voices, speech)):
                at = find_line_start(speech) + peak
                if at < max(start, speech.start) or at >= end:
                    continue
                if n == 0 or uniform(self.seed, speech.id, "accent", str(n)) < self.life.accent_blinks:
                    out.append((at, n == 0))
        return out


def _draw(
    life: Life,
    track: Track,
    voices: Mapping[str, Voice],
    seed: Bits,
    cut: float,
    drawn: float,
    before: Schedule,
) -> LifeDraw:
    """Return the draw that extends a schedule from `cut` to `drawn` seconds, with modes and looks
    filled in.
    """
    modes = before.modes.until(cut)
    last = int(modes.rows[-1][0]) if len(modes.rows) > 0 else -1
    times: list[float] = []
    rows: list[list[float]] = []
    for at, mode in modes_between(track, cut, drawn):
        if len(times) > 0 or mode != last:
            times.append(at)
            rows.append([float(mode)])
    moods = before.moods.until(cut)
    felt: list[float] = []
    if len(moods.rows) > 0:
        felt = list(moods.rows[-1])
    changes: list[float] = []
    wanted: list[list[float]] = []
    for at, mood in moods_between(moods_of(life, track), cut, drawn):
        same = (
            len(felt) > 0
            and felt[0] == mood.valence
            and felt[1] == mood.arousal
            and felt[2] == mood.intensity
        )
        if len(changes) > 0 or not same:
            changes.append(at)
            wanted.append([mood.valence, mood.arousal, mood.intensity])
    begun = bisect_left(before.targets, cut, key=lambda t: t.start)
    targets = list(before.targets[:begun])
    for target in targets_between(track, cut, drawn):
        if len(targets) == 0 or not target.like(targets[-1]):
            targets.append(target)
    return LifeDraw(
        life, track, voices, seed, cut, drawn, 1.0 - life.stillness, modes.plus(times, rows),
        moods.plus(changes, wanted), tuple(targets),
    )  # fmt: skip
