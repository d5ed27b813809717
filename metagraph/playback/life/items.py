"""Requests that last: where to look, what to say, which mode to be in, which stance to stay in. Values; times
are seconds.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from metagraph.graph.requests import Point
from metagraph.graph.words import Layer, Mode
from metagraph.playback.life.alphabet import Alphabet
from metagraph.playback.life.line_timing import (
    LineTiming,
    alike_timings,
    extended,
    measure_text,
    pace_text,
    place_told,
    shifted,
    tells_on,
    timed_seconds,
    told_text,
)
from metagraph.playback.life.spots import Spot, is_same_spot
from metagraph.playback.planning.mood import MoodFrom


@dataclass(frozen=True, slots=True)
class LookAt:
    """Look at a point or a named point from `start` until `end`, or until the next look. strict: without
    looking away.
    """

    id: str
    start: float
    end: float
    to: Spot
    amount: float = 1.0
    strict: bool = False
    priority: int = 1


@dataclass(frozen=True, slots=True)
class Speech:
    """Something said. line: id of the project's line, None for `text` alone. priority: a higher one
    interrupts a lower one. length: seconds that all of it would have taken, if it was cut short. timing: the
    times of its words and mouth shapes, if known. skip: seconds of it that were said before a pause. more:
    whether more of it may come, so that it is not over when it falls silent. over: when it was finished, if
    it had fallen silent before. asked: when the first piece of its utterance was asked for, which all its
    pieces share and no other utterance of its id has.
    """

    id: str
    start: float
    end: float
    line: str | None = None
    text: str = ""
    priority: int = 1
    length: float | None = None
    timing: LineTiming | None = None
    skip: float = 0.0
    more: bool = False
    over: float | None = None
    asked: float = 0.0


@dataclass(frozen=True, slots=True)
class ModeFrom:
    """The mode from `start` on; None for talking while something is said and idling otherwise."""

    id: str
    start: float
    mode: Mode | None


@dataclass(frozen=True, slots=True)
class PlaceFrom:
    """Where a named point is from `start` on."""

    id: str
    start: float
    name: str
    point: Point


@dataclass(frozen=True, slots=True)
class BlinkAt:
    """A requested blink."""

    id: str
    start: float


@dataclass(frozen=True, slots=True)
class StayFrom:
    """From `start` on, the models change no stance of a layer, or may do so again with `on` false, until
    `end` or the next item of this kind.
    """

    id: str
    start: float
    layer: Layer
    on: bool = True
    end: float = math.inf


Item = LookAt | Speech | ModeFrom | PlaceFrom | BlinkAt | StayFrom | MoodFrom


def find_line_start(speech: Speech) -> float:
    """Return the second from which the times of a speech count: before its start if it continues after a
    pause.
    """
    return speech.start - speech.skip


def measure_line(speech: Speech) -> float:
    """Return how many seconds all of a speech takes, with the part before a pause and the part that was cut
    off.
    """
    return speech.end - find_line_start(speech) if speech.length is None else speech.length


def cut(speech: Speech, at: float) -> Speech:
    """Return the speech, ending no later than `at`; it remembers its full length."""
    return speech if speech.end <= at else replace(speech, end=at, length=measure_line(speech))


def apart(speeches: Sequence[Speech]) -> list[Speech]:
    """Return speeches, given in order, without overlaps: one of equal or higher importance cuts the running
    one, with its later pieces; a less important one is dropped.
    """
    out: list[Speech] = []
    ends: dict[str, float] = {}  # when what was cut would have ended
    for speech in speeches:
        if speech.id in ends and speech.start == ends[speech.id]:
            ends[speech.id] = speech.end
            continue
        if len(out) > 0 and out[-1].end > speech.start:
            last = out[-1]
            if speech.priority < last.priority:
                continue
            out.pop()
            if last.id != speech.id:
                ends[last.id] = last.end
            if last.start < speech.start:
                out.append(replace(cut(last, speech.start), more=False))
        out.append(speech)
    return out


def behind(said: Sequence[Speech], new: Speech, now: float) -> Speech:
    """Return a text moved to after another one of its id that is being said, also if more of it may come.
    said: in order.
    """
    if (new.timing is not None and not new.timing.paced) or new.line is not None or new.start > now:
        return new
    end = new.start
    for speech in said:
        paced = speech.timing is None or speech.timing.paced
        plain = paced and speech.line is None and speech.length is None
        if speech.id == new.id and plain and speech.start <= end and end < speech.end:
            end = speech.end
    return new if end == new.start else replace(new, start=end, end=end + (new.end - new.start))


def going_on(old: Speech | None, new: Speech, now: float) -> Speech:
    """Return a line as the continuation of the last one with the same id, if that has begun by `now` or
    begins with it: it keeps the start and what has been said. Only lines whose words or shapes have times
    continue.
    """
    if old is None or old.timing is None or new.timing is None or old.length is not None:
        return new
    if new.timing.paced:
        return new if old.end <= now else _behind_words(old, old.timing, new, new.timing, now)
    if max(old.start, new.start) > now and old.start != new.start:
        return new
    said = max(now - find_line_start(old), old.skip)
    if old.end <= now and not tells_on(old.timing, shifted(new.timing, old.timing.later)):
        return new
    told = new.timing if old.start > now and old.skip == 0 else place_told(old.timing, new.timing, said)
    timing = extended(old.timing, told, said)
    length = max(timed_seconds(timing, None), new.end - new.start)
    more = new.text == "" or new.text == told_text(new.timing)
    return replace(
        new,
        start=old.start,
        end=find_line_start(old) + length,
        text=told_text(timing) if more else new.text,
        timing=timing,
        skip=old.skip,
    )


def pace_speech(alphabet: Alphabet, new: Speech) -> Speech:
    """Return a text with times estimated from its letters, so that later pieces can be added."""
    timing = pace_text(alphabet, new.text, None)
    length = timed_seconds(timing, measure_text(alphabet, new.text))
    return replace(new, end=new.start + length, timing=timing)


def _behind_words(old: Speech, told: LineTiming, new: Speech, more: LineTiming, now: float) -> Speech:
    """Return a line with a text after its known words. told, more: the words of both."""
    begin = find_line_start(old)
    at = max(now - begin, old.skip, old.end - begin)
    timing = replace(told, words=(*told.words, *shifted(more, at).words), paced=True)
    length = timed_seconds(timing, at + new.end - new.start)
    return replace(
        new, start=old.start, end=begin + length, text=old.text + new.text, timing=timing, skip=old.skip
    )


def alike_looks(one: Sequence[LookAt], other: Sequence[LookAt]) -> bool:
    """Return whether the looks of two tracks are the same. The functions below compare other items."""
    return len(one) == len(other) and all(a is b or _same_look(a, b) for a, b in zip(one, other, strict=True))


def _same_look(a: LookAt, b: LookAt) -> bool:
    if not is_same_spot(a.to, b.to) or a.amount != b.amount or a.strict != b.strict:
        return False
    return a.id == b.id and a.start == b.start and a.end == b.end and a.priority == b.priority


def alike_speeches(one: Sequence[Speech], other: Sequence[Speech]) -> bool:
    return len(one) == len(other) and all(
        a is b or _same_speech(a, b) for a, b in zip(one, other, strict=True)
    )


def _same_speech(a: Speech, b: Speech) -> bool:
    if a.line != b.line or a.text != b.text or a.length != b.length or a.priority != b.priority:
        return False
    if a.skip != b.skip or a.more != b.more or a.over != b.over or a.asked != b.asked:
        return False
    return a.id == b.id and a.start == b.start and a.end == b.end and alike_timings(a.timing, b.timing)


def alike_modes(one: Sequence[ModeFrom], other: Sequence[ModeFrom]) -> bool:
    return len(one) == len(other) and all(
        a is b or (a.id == b.id and a.start == b.start and a.mode == b.mode)
        for a, b in zip(one, other, strict=True)
    )


def alike_places(one: Sequence[PlaceFrom], other: Sequence[PlaceFrom]) -> bool:
    return len(one) == len(other) and all(
        a is b or _same_place(a, b) for a, b in zip(one, other, strict=True)
    )


def _same_place(a: PlaceFrom, b: PlaceFrom) -> bool:
    if a.id != b.id or a.start != b.start or a.name != b.name:
        return False
    return all(x == y for x, y in zip(a.point, b.point, strict=True))


def alike_blinks(one: Sequence[BlinkAt], other: Sequence[BlinkAt]) -> bool:
    return len(one) == len(other) and all(
        a is b or (a.id == b.id and a.start == b.start) for a, b in zip(one, other, strict=True)
    )


def alike_stays(one: Sequence[StayFrom], other: Sequence[StayFrom]) -> bool:
    return len(one) == len(other) and all(a is b or _same_stay(a, b) for a, b in zip(one, other, strict=True))


def _same_stay(a: StayFrom, b: StayFrom) -> bool:
    if a.layer != b.layer or a.on != b.on or a.end != b.end:
        return False
    return a.id == b.id and a.start == b.start


def alike_felt(one: Sequence[MoodFrom], other: Sequence[MoodFrom]) -> bool:
    return len(one) == len(other) and all(a is b or _same_felt(a, b) for a, b in zip(one, other, strict=True))


def _same_felt(a: MoodFrom, b: MoodFrom) -> bool:
    if a.valence != b.valence or a.arousal != b.arousal or a.intensity != b.intensity:
        return False
    return a.id == b.id and a.start == b.start and a.end == b.end
