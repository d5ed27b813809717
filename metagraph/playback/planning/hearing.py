"""The effect of requests on a running plan: what they take back, what lasts from then on, and which layers
have to be planned again.
"""

from __future__ import annotations

from collections.abc import Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, field, replace

from metagraph.graph.words import LAYERS, Layer
from metagraph.playback.life.items import LookAt, Speech, behind, going_on, pace_speech
from metagraph.playback.life.spots import is_same_spot, named
from metagraph.playback.life.track import Track
from metagraph.playback.life.utterances import (
    PAUSED,
    TOGETHER,
    break_off,
    find_slot,
    find_stop,
    find_utterances,
    finish_speech,
    goes_on,
    is_paused,
    pause,
    resume,
    takes_more,
)
from metagraph.playback.plan import MetaRequest
from metagraph.playback.planning.meaning import Meaning
from metagraph.playback.planning.mood import MoodFrom

LISTENS = 2.0  # seconds for which the gaze stays with the partner who interrupts


@dataclass(frozen=True, slots=True)
class Heard:
    """track: lasting items. fresh: requests of layers, with those that continue after a pause. withdrawn: ids
    of earlier requests that no longer hold; stopped: those of them that were taken back, not replaced.
    touched: layers that the requests affect.
    """

    track: Track
    fresh: Sequence[MetaRequest]
    withdrawn: AbstractSet[str]
    stopped: AbstractSet[str]
    touched: AbstractSet[Layer]


def owners(ident: str) -> list[str]:
    """Return the ids of the asks from which a request may come: its own id, and those of which it would be a
    part.
    """
    out = [ident]
    left = ident
    while True:
        left, dot, number = left.rpartition(".")
        if dot == "" or not number.isdigit():
            return out
        out.append(left)


def makers(ident: str) -> list[str]:
    """Return the ids with which a request is taken back: its `owners`, and the speech that a gesture belongs
    to: "answer" for "answer/2".
    """
    out = owners(ident)
    said, slash, number = out[-1].rpartition("/")
    if slash != "" and number.isdigit():
        out.append(said)
    return out


def heard(
    requests: Sequence[MetaRequest],
    track: Track,
    meant: Meaning,
    present: float,
    now: float,
    soon: float,
    turning: Sequence[Layer],
) -> Heard:
    """Return the effect of asks. requests, track: of the plan. meant: the meaning of the asks; speeches may
    overlap in it. present: when they became known. now: everything that begins earlier stays; soon: the same
    for voices. turning: layers whose models perform differently in different modes.
    """
    more = meant.track()
    gone = set(meant.withdrawn)
    for report in meant.refused:
        gone.add(report.request)
    for request in meant.requests:
        gone.add(request.id)
    for ident in more.idents():
        gone.add(ident)
    words = add_speeches(meant, track, present, soon)
    before = [r.id for r in requests]
    before += track.idents()
    # A client that takes everything back keeps the look at the user.
    user = {x.id for x in track.looks if x.start < now and is_same_spot(x.to, named("user"))}
    taken: set[str] = set()
    stopped: set[str] = set()
    withdrawn = meant.withdrawn
    for ident in before:
        every = "" in withdrawn and ident not in user
        if every or (len(withdrawn) > 0 and any(o in withdrawn for o in makers(ident))):
            stopped.add(ident)
        elif len(words.anew) > 0 and ident not in words.anew and any(o in words.anew for o in makers(ident)):
            stopped.add(ident)  # what was made for the words before
        if ident in stopped or ident in gone or ("." in ident and any(o in gone for o in owners(ident))):
            taken.add(ident)
    # Leave to change stances again means nothing if the models always may.
    staying = {s.layer for s in track.stays if s.on}
    for stay in more.stays:
        if stay.on:
            staying.add(stay.layer)
    stays = [s for s in more.stays if s.layer in staying]
    touched = {r.layer for r in meant.requests}
    for request in requests:
        if request.id in taken:
            touched.add(request.layer)
    for stay in [*track.stays, *stays]:
        if stay.id in gone or stay.id in taken:
            touched.add(stay.layer)
    turns = (
        len(more.modes) > 0
        or len(more.speeches) > 0
        or len(meant.steered) > 0
        or any(m.id in taken for m in track.modes)
        or any(s.id in taken for s in track.speeches)
    )
    if turns:  # talking and listening characters move differently
        for layer in turning:
            touched.add(layer)
    if len(more.moods) > 0 or any(m.id in taken for m in track.moods):
        for layer in LAYERS:
            touched.add(layer)
    left = track
    for ident in find_utterances(track, "", soon):
        if ident in stopped:
            left = break_off(left, ident, now)
    over: set[str] = set()
    for ident in taken:
        if ident not in words.on:
            over.add(ident)
    left = words.leave(left.without(over, now))
    for ident in over:
        open_ = left.last_speech(ident)
        if open_ is not None and open_.more:  # something else takes its place
            left = finish_speech(left, ident, soon)
    lasting = Track(
        more.looks, tuple(words.said), more.modes, more.places, more.blinks, tuple(stays), tuple(words.moods)
    )
    said = Heard(left.joined(lasting), meant.requests, taken, stopped, touched)
    return _steer(requests, said, meant, now, soon)


@dataclass(frozen=True, slots=True)
class AddedSpeeches:
    """New speeches, combined with those that are being said. said: all that are new or changed. begun: ids of
    changed earlier ones among them; on: ids of those that continue. `anew`: ids under which something else
    was said before. moods: the moods requested with them.
    """

    said: Sequence[Speech]
    begun: AbstractSet[str]
    on: AbstractSet[str]
    anew: AbstractSet[str]
    moods: Sequence[MoodFrom]

    def leave(self, track: Track) -> Track:
        """Return the part of a track that stays: moods of speeches that continue last as long as these,
        unless another mood is requested.
        """
        if len(self.on) == 0 and len(self.begun) == 0:
            return track
        other = {m.id for m in self.moods}
        ends: dict[str, float] = {}
        for speech in self.said:
            if speech.id in self.on:
                ends[speech.id] = PAUSED if speech.more else speech.end
        speeches = [s for s in track.speeches if s.id not in self.begun]
        moods: list[MoodFrom] = []
        for m in track.moods:
            if m.id not in ends or m.id in other:
                moods.append(m)
            else:
                moods.append(replace(m, end=ends[m.id]))
        return Track(
            track.looks, tuple(speeches), track.modes, track.places, track.blinks, track.stays, tuple(moods)
        )


def add_speeches(meant: Meaning, track: Track, present: float, soon: float) -> AddedSpeeches:
    """Return the effect of asks to say something on a track: a new line, a line after another, or more of
    one. present: what ended by then is over, and its end was reported; more of it begins a new utterance.
    """
    said: list[Speech] = []
    begun: set[str] = set()
    on: set[str] = set()
    anew: set[str] = set()
    later: dict[str, float] = {}  # by how much those begin that are said behind others of their id
    for told in meant.speeches:
        taken = told.id in meant.withdrawn or "" in meant.withdrawn
        before = None if taken else track.last_speech(told.id)
        last = next((s for s in reversed(said) if s.id == told.id), before)
        asked = told
        now = soon
        if last is not None and is_paused(last.start) and told.start <= soon and told.line is None:
            now = last.start  # it is said when that is
            asked = replace(told, start=now, end=told.end + now - told.start)
        paces = told.more or (last is not None and last.more)
        if paces and asked.timing is None and asked.line is None:
            asked = pace_speech(meant.alphabet, asked)
        one = going_on(last, asked, now)
        continues = False
        if one is not asked and last is not None and one.start == last.start:
            continues = True
            said = [s for s in said if s.id != one.id or s.start < one.start]
            if last is before:
                begun.add(one.id)
                said.extend([s for s in track.speeches if s.id == one.id and s is not last])
        elif one is asked and last is not None:
            same = [s for s in [*track.speeches, *said] if s.id == last.id and s.asked == last.asked]
            one = behind(same, asked, now)
            continues = one is not asked or (takes_more(last) and told.line is None and one.start <= now)
        over = last is not None and last.end <= present and not takes_more(last)
        since = find_asked(track, last, continues and not over, one.id, soon)
        if not continues:  # it replaces what was asked for at the same time
            said = [s for s in said if s.id != one.id]
            begun = _without(begun, one.id)
            on = _without(on, one.id)
        if before is not None and since == before.asked:
            on.add(one.id)
        if one.start != told.start:
            later[one.id] = one.start - told.start
        if not continues and one.id not in on and track.last_speech(one.id) is not None:
            anew.add(one.id)
        said.append(replace(one, asked=since))
    opened = {s.id for s in said if s.more}
    moods: list[MoodFrom] = []
    for m in meant.moods:
        by = later[m.id] if m.id in later and m.id not in begun else 0.0
        end = PAUSED if m.id in opened else m.end + by
        moods.append(MoodFrom(m.id, m.start + by, m.valence, m.arousal, m.intensity, end))
    return AddedSpeeches(said, begun, on, anew, moods)


def _without(idents: AbstractSet[str], ident: str) -> set[str]:
    left: set[str] = set()
    for other in idents:
        if other != ident:
            left.add(other)
    return left


def find_asked(track: Track, last: Speech | None, continues: bool, ident: str, soon: float) -> float:
    """Return when the utterance of a new piece was asked for. last: the piece before it, None if that is
    taken back; continues: whether the new one goes on from it.
    """
    if last is not None and continues:
        return last.asked
    known = track.last_speech(ident) if last is None else last
    return soon if known is None else max(soon, known.asked + TOGETHER)


def _steer(requests: Sequence[MetaRequest], told: Heard, meant: Meaning, now: float, soon: float) -> Heard:
    """Return the effect of asks that interrupt, pause, resume or finish speech, in order. requests: of the
    plan before.
    """
    if len(meant.steered) == 0:
        return told
    steered = SteeredSpeech(told.track, set(told.withdrawn), set(told.stopped), set(told.touched))
    steered.requests = [r for r in requests if r.id not in told.withdrawn]
    for request in told.fresh:
        steered.requests.append(request)
        steered.anew.add(request.id)
    for ask in meant.steered:
        ids = find_utterances(steered.track, ask.what, soon)
        if ask.do == "interrupt":
            if len(ids) > 0:
                look = LookAt(ask.id, now, now + LISTENS, named("user"), 1.0, True, ask.priority)
                steered.track = steered.track.joined(Track((look,)))
            if ask.what != "" and ask.what not in ids:  # it may have been said, and its gestures go on
                ids.append(ask.what)
        for ident in ids:
            made = {x for x in steered.idents() if x.startswith(ident) and ident in makers(x)}
            if ask.do == "interrupt":
                stop = find_stop(meant.alphabet, steered.track, ident, soon, now)
                steered.interrupt(ident, made, min(stop, now), now, soon)
            elif ask.do == "pause":
                steered.pause(ident, made, find_stop(meant.alphabet, steered.track, ident, soon, now), now)
            elif ask.do == "resume":
                steered.resume(ident, made, now, soon)
            else:
                steered.track = finish_speech(steered.track, ident, soon)
    fresh = [r for r in steered.requests if r.id in steered.anew]
    return Heard(steered.track, fresh, steered.withdrawn, steered.stopped, steered.touched)


@dataclass
class SteeredSpeech:
    """A track and requests while asks steer speech. `anew`: ids of the requests that are made again; the
    other fields are as in `Heard`.
    """

    track: Track
    withdrawn: set[str]
    stopped: set[str]
    touched: set[Layer]
    requests: list[MetaRequest] = field(default_factory=list)
    anew: set[str] = field(default_factory=set)

    def idents(self) -> list[str]:
        """Return the ids of everything in it."""
        return [*[r.id for r in self.requests], *self.track.idents()]

    def interrupt(self, ident: str, made: AbstractSet[str], stop: float, now: float, soon: float) -> None:
        """Break off an utterance at `stop`, and the requests that belong to it at `now`."""
        if goes_on(self.track.speeches, ident, soon):
            self.track = break_off(self.track, ident, stop)
        if any(m.id in made for m in self.track.moods):
            for layer in LAYERS:
                self.touched.add(layer)
        self.track = self.track.without(made, now)
        for request in self.requests:
            if request.id in made:
                self.withdrawn.add(request.id)
                self.stopped.add(request.id)
                self.touched.add(request.layer)
        self.requests = [r for r in self.requests if r.id not in made]

    def pause(self, ident: str, made: AbstractSet[str], stop: float, now: float) -> None:
        """Pause an utterance, and the requests that belong to it and whose moment has not come; those that
        have begun go back.
        """
        if is_paused(stop):
            return
        slot = find_slot(self.track)
        self.track = pause(self.track, ident, made, stop, slot)
        kept: list[MetaRequest] = []
        for request in self.requests:
            if request.id not in made or is_paused(request.start):
                kept.append(request)
                continue
            self.withdrawn.add(request.id)
            self.touched.add(request.layer)
            if request.start < now:
                self.stopped.add(request.id)
            wanted = request.start if request.stroke is None else request.stroke
            if wanted >= stop:
                kept.append(self.move_request(request, slot - stop, 0.0))
                self.anew.add(request.id)
        self.requests = kept

    def resume(self, ident: str, made: AbstractSet[str], now: float, soon: float) -> None:
        """Resume a paused utterance, and the requests that wait for it."""
        held = next((s for s in self.track.speeches if s.id == ident and is_paused(s.start)), None)
        if held is None:
            return
        self.track = resume(self.track, ident, made, soon)
        kept: list[MetaRequest] = []
        for request in self.requests:
            if request.id in made and is_paused(request.start):
                self.withdrawn.add(request.id)
                self.touched.add(request.layer)
                self.anew.add(request.id)
                kept.append(self.move_request(request, soon - held.start, now))
            else:
                kept.append(request)
        self.requests = kept

    def move_request(self, request: MetaRequest, by: float, least: float) -> MetaRequest:
        """Return a request moved by a number of seconds, but not to before `least`."""
        stroke = None if request.stroke is None else request.stroke + by
        return replace(request, start=max(least, request.start + by), stroke=stroke)
