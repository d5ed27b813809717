"""Break off, pause, resume and finish utterances. An utterance is everything that is said under one id, piece
by piece, until it is over. Times are seconds.

A paused utterance is moved to a time that never comes (`PAUSED`), each to a slot of its own.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from collections.abc import Set as AbstractSet
from dataclasses import replace

from metagraph.playback.life.alphabet import Alphabet
from metagraph.playback.life.graphemes import spelled
from metagraph.playback.life.items import LookAt, Speech, cut, find_line_start, measure_line
from metagraph.playback.life.line_timing import timed_sounds
from metagraph.playback.life.track import Track
from metagraph.playback.planning.mood import MoodFrom

PAUSED = 1e9  # seconds from which on lies what is paused
VOICE = 0.04  # seconds in which a voice can begin; more than lips look ahead
EARLIER = 0.03  # seconds by which it can stop sooner, since a mouth takes its time to close
FORGOTTEN = 60.0  # seconds of silence after which nothing more is awaited of what was promised to go on
TOGETHER = 1e-3  # seconds between two pieces of one utterance, at most


def find_soon(now: float, lookahead: float) -> float:
    """Return when a voice can begin: sooner than gestures, which blend. At the very beginning it can begin at
    once, because nothing has been shown.
    """
    return now + min(lookahead, VOICE) if now > 0 else 0.0


def is_paused(start: float) -> bool:
    """Return whether an item with this start is paused."""
    return start >= PAUSED


def takes_more(speech: Speech) -> bool:
    """Return whether more can be added to a piece that is not being said: more was announced, or it is
    paused.
    """
    return speech.more or speech.start >= PAUSED


def goes_on(speeches: Sequence[Speech], ident: str, now: float) -> bool:
    """Return whether an utterance is not over at `now`: it is being said, will be said, is paused, or expects
    more.
    """
    last = next((s for s in reversed(speeches) if s.id == ident), None)
    return last is not None and (last.end > now or last.more)


def find_utterances(track: Track, what: str, now: float) -> list[str]:
    """Return the ids of the utterances that are not over at `now`; what: of one, "" for all."""
    if what != "":
        return [what] if goes_on(track.speeches, what, now) else []
    last = {s.id: s for s in track.speeches}
    lasting = {s.id for s in track.speeches if (s.end > now or s.more) and last[s.id] is s}
    out: list[str] = []
    for speech in track.speeches:
        if speech.id in lasting and speech.id not in out:
            out.append(speech.id)
    return out


def find_forgotten(track: Track, now: float) -> list[str]:
    """Return the ids of the utterances of which more was promised, and nothing has come for `FORGOTTEN`."""
    silent = [s for s in track.speeches if s.more and s.end < now - FORGOTTEN]
    return [s.id for s in silent if track.last_speech(s.id) is s]


def find_stop(alphabet: Alphabet, track: Track, ident: str, soon: float, now: float) -> float:
    """Return when the voice of an utterance stops: at the end of the current sound, at `soon` at the latest;
    at once if its sounds are unknown or it is in a pause; at its start if it has not begun. now: when
    gestures can stop.
    """
    first = soon - EARLIER if now > soon else soon
    running = next((s for s in track.speeches if s.id == ident and s.start < first and first < s.end), None)
    if running is None:
        coming = [s.start for s in track.speeches if s.id == ident and s.start >= first]
        return min([*coming, PAUSED]) if len(coming) > 0 else soon
    if running.line is not None and running.timing is None:
        return first
    begin = find_line_start(running)
    said = (
        spelled(alphabet, running.text, measure_line(running))
        if running.timing is None
        else timed_sounds(alphabet, running.timing)
    )
    ends = [begin + p.end for p in said.pieces if begin + p.start < first and first < begin + p.end]
    return min([soon, running.end, *ends]) if len(ends) > 0 else first


def find_slot(track: Track) -> float:
    """Return a free slot among the times that never come."""
    return max([PAUSED, *[s.end + 1.0 for s in track.speeches if s.start >= PAUSED]])


def break_off(track: Track, ident: str, stop: float) -> Track:
    """Return the track with an utterance ended at `stop`: its later pieces are not said."""
    last = track.last_speech(ident)
    speeches: list[Speech] = []
    for speech in track.speeches:
        if speech.id != ident or speech.end <= stop:
            speeches.append(speech)
        elif speech.start < stop:
            speeches.append(cut(speech, stop))
    return track if last is None else _closed(track, speeches, last, stop, True)


def finish_speech(track: Track, ident: str, soon: float) -> Track:
    """Return the track with an utterance that is over once all its known pieces are said."""
    last = track.last_speech(ident)
    return track if last is None else _closed(track, list(track.speeches), last, soon, False)


def _closed(track: Track, speeches: Sequence[Speech], of: Speech, now: float, cuts: bool) -> Track:
    """Return the track with these speeches, in which an utterance expects no more pieces. of: its last piece
    before. cuts: whether it was broken off.
    """
    out = list(speeches)
    end = now
    for n in reversed(range(len(out))):
        last = out[n]
        if last.id != of.id or last.asked != of.asked:
            continue
        held = cuts and last.length is not None  # it was paused
        silent = last.end < now and (last.more or held)
        length = measure_line(last) if cuts and last.more else last.length
        out[n] = replace(last, more=False, over=now if silent else last.over, length=length)
        end = max(last.end, now)
        break
    moods = [_until(m, end) if m.id == of.id and m.end == PAUSED else m for m in track.moods]
    return Track(track.looks, tuple(out), track.modes, track.places, track.blinks, track.stays, tuple(moods))


def _until(mood: MoodFrom, end: float) -> MoodFrom:
    return replace(mood, end=end)


def pause(track: Track, ident: str, made: AbstractSet[str], stop: float, slot: float) -> Track:
    """Return the track with an utterance paused from `stop` on, in `slot` (`find_slot`). made: ids of
    requests that belong to it; they wait, too, if they have not begun.
    """
    by = slot - stop
    kept: list[Speech] = []
    held: list[Speech] = []
    for speech in track.speeches:
        if speech.id != ident or speech.start >= PAUSED or speech.end <= stop:
            kept.append(speech)
        elif speech.start < stop:
            kept.append(replace(cut(speech, stop), more=False))
            skip = stop - find_line_start(speech)
            held.append(replace(speech, start=slot, end=speech.end + by, skip=skip))
        else:
            held.append(replace(speech, start=speech.start + by, end=speech.end + by))
    last = track.last_speech(ident)
    if len(held) == 0 and last is not None and last.more and last.start < PAUSED:
        held.append(Speech(ident, slot, slot, None, "", last.priority, more=True, asked=last.asked))
    if len(held) == 0:
        return track
    moods = [
        _until(m, PAUSED) if m.id == ident and m.start < stop and m.end > stop else m for m in track.moods
    ]
    left = Track(track.looks, tuple(kept), track.modes, track.places, track.blinks, track.stays, tuple(moods))
    return _moved(left, held, made, stop, PAUSED, by)


def resume(track: Track, ident: str, made: AbstractSet[str], soon: float) -> Track:
    """Return the track with an utterance that continues at `soon`. made: as for `pause`."""
    held = [s for s in track.speeches if s.id == ident and s.start >= PAUSED]
    if len(held) == 0:
        return track
    by = soon - held[0].start
    kept = [s for s in track.speeches if s.id != ident or s.start < PAUSED]
    on = [replace(s, start=s.start + by, end=s.end + by) for s in held if s.end > s.start]
    end = PAUSED if held[-1].more else held[-1].end + by
    moods = [_until(m, end) if m.id == ident and m.end == PAUSED else m for m in track.moods]
    left = Track(track.looks, tuple(kept), track.modes, track.places, track.blinks, track.stays, tuple(moods))
    if len(on) == 0:  # it had fallen silent when it was paused
        left = left if held[-1].more else finish_speech(left, ident, soon)
    return _moved(left, on, made, PAUSED, math.inf, by)


def _moved(
    track: Track, speeches: Sequence[Speech], made: AbstractSet[str], low: float, high: float, by: float
) -> Track:
    """Return the track with more speeches, and with the looks and moods of `made` that begin from `low` to
    before `high` moved by a number of seconds.
    """
    looks: list[LookAt] = []
    for x in track.looks:
        if x.id in made and low <= x.start and x.start < high:
            looks.append(replace(x, start=x.start + by, end=x.end + by))
    moods: list[MoodFrom] = []
    for m in track.moods:
        if m.id in made and low <= m.start and m.start < high:
            moods.append(replace(m, start=m.start + by, end=m.end + by))
    gone = {x.id for x in looks}
    over = {m.id for m in moods}
    left = Track(
        tuple([x for x in track.looks if x.id not in gone or x.start < low or x.start >= high]),
        track.speeches, track.modes, track.places, track.blinks, track.stays,
        tuple([m for m in track.moods if m.id not in over or m.start < low or m.start >= high]),
    )  # fmt: skip
    return left.joined(Track(tuple(looks), tuple(speeches), (), (), (), (), tuple(moods)))


def explain_end(speeches: Sequence[Speech], speech: Speech) -> str:
    """Return why an utterance is over at the end of a piece: "finished", "interrupted" or "replaced"; "" if
    it is not over there.
    """
    coming = next((s for s in speeches if s.id == speech.id and s.start > speech.start), None)
    if coming is not None and coming.asked == speech.asked:
        return ""
    if speech.more:
        return "" if coming is None else "replaced"
    if speech.length is None:
        return "finished"
    return "interrupted" if coming is None or coming.start > speech.end + TOGETHER else "replaced"
