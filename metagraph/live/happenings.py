"""What has begun and ended between two ticks, told to the clients that want to know. What a client asked for
ends once, whatever becomes of it.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from typing import Literal, Protocol

from msgspec.structs import replace

from metagraph.graph.model import LAYERS, Layer
from metagraph.live.ledger import Ledger, OpenAsk, reword_for_client
from metagraph.live.limits import ADDED
from metagraph.live.messages import Event, Reason, round_seconds
from metagraph.playback.life.alphabet import ALPHABET
from metagraph.playback.life.track import Speech
from metagraph.playback.plan import Cue, Plan
from metagraph.playback.planning.extend_performance import find_served
from metagraph.speech.spoken_so_far import spoken_until

SAID = ("say", ADDED)  # the lanes of what is said
Word = Literal["started", "ended"]
UNSAID = "something else is said then"
WHY: dict[Reason, str] = {"withdrawn": "taken back", "replaced": "asked again under the same id"}


class Listener(Protocol):
    """A client. events: "" for none, "own" or "all"."""

    number: int
    events: str

    @property
    def owner(self) -> int: ...


@dataclass(slots=True)
class Running:
    """A request for an action that has started and not ended. owner, ident: whose it is, and what that one
    calls it. request: of the plan, that plays it. start: of what plays, seconds. reason: why it ends, None as
    long as nothing but its own end is known; why: in words, if that is given.
    """

    owner: int
    ident: str
    request: str
    layer: Layer
    event: Event
    start: float
    reason: Reason | None = None
    why: str = ""


@dataclass(slots=True)
class Utterance:
    """Something that a client was promised will be said, and whose end has not been reported. owner, ident,
    reason, why: as for `Running`. since: when its first piece began, None before that.
    """

    owner: int
    ident: str
    since: float | None = None
    reason: Reason | None = None
    why: str = ""


@dataclass(frozen=True, slots=True)
class Leaving:
    """A request of a client that is over and still begins, because it is too late to change that. until: when
    it has begun, seconds. event: of its end.
    """

    owner: int
    ident: str
    until: float
    event: Event


class Happenings:
    """What runs, by the requests of the plan. utterances: by request and by when they were asked for."""

    def __init__(self) -> None:
        self.running: dict[str, Running] = {}
        self.utterances: dict[tuple[str, float], Utterance] = {}
        self._leaving: dict[str, Leaving] = {}
        self._followed = 0.0  # seconds; what began by then runs
        self._told: list[tuple[int | None, str | None, Event]] = []  # whose, called what, which

    def stop(self, request: str, reason: Reason, why: str = "") -> None:
        """Take note why a request ends."""
        ending: list[Running | Utterance] = [
            one for (said, _), one in self.utterances.items() if said == request
        ]
        if request in self.running:
            ending.append(self.running[request])
        for one in ending:
            one.reason, one.why = reason, why

    def promise(self, request: str, owner: int, ident: str, plan: Plan) -> None:
        """Take note that something will be said, so that its end is reported."""
        speech = plan.track.last_speech(request)
        if speech is not None:
            self.utterances.setdefault((request, speech.asked), Utterance(owner, ident))

    def find_beginning(self, speech: Speech) -> float | None:
        """Return when the utterance of a piece began, in seconds; None if it has not."""
        one = self.utterances.get((speech.id, speech.asked))
        return None if one is None else one.since

    def owes_end(self, request: str) -> bool:
        """Whether the end of a request is still to be reported: it was promised to be said, it runs, or it
        begins because it is too late to change that.
        """
        said = any(name == request for name, _ in self.utterances)
        return said or request in self.running or request in self._leaving

    def list_lasting(self) -> list[str]:
        """Return the requests that run and are not known to end."""
        said = [name for (name, _), x in self.utterances.items() if x.since is not None and x.reason is None]
        return [*said, *(request for request, one in self.running.items() if one.reason is None)]

    def end_waiting(
        self, key: str, ask: OpenAsk, reason: Reason, why: str, now: float, plan: Plan, fixed: float
    ) -> None:
        """Report that an action ends which was promised and never began; what begins before `fixed` seconds
        cannot be stopped, and ends a moment later.
        """
        layer = next((x for x in LAYERS if x == ask.lane), None)
        if not ask.settled or ask.ended or key in self.running or layer is None:
            return
        ask.ended = True
        event = Event(event="ended", t=round_seconds(now), layer=layer, reason=reason, why=why)
        if _begins(plan, key, layer, self._followed, fixed):
            self._leaving[key] = Leaving(ask.client, ask.ident, fixed, event)
        else:
            self._tell(ask.client, ask.ident, event)

    def list_happenings(
        self, plan: Plan, ledger: Ledger, before: float, now: float, clients: Collection[Listener]
    ) -> Iterator[tuple[Listener, Event]]:
        """Yield whom to tell what: actions and speeches that started or ended after `before`, until `now`."""
        self._follow(plan, ledger, before, now)
        told, self._told = self._told, []
        listening = [client for client in clients if client.events]
        for owner, ident, event in told if listening else ():
            for client in listening:
                own = owner == client.owner
                if own or client.events == "all":
                    yield client, replace(event, id=ident if own else None)

    def _follow(self, plan: Plan, ledger: Ledger, before: float, now: float) -> None:
        t, self._followed = round_seconds(now), now
        served = find_served(plan)
        for layer in LAYERS:
            lane = plan.layers[layer]
            low, high = lane.ends.searchsorted((before, now), "right")
            for cue in lane.cues[int(low) : int(high)]:
                request = cue.meta.partition("+")[0]
                if request not in self.running and ledger.owner(request) is None:
                    self._tell(None, None, _event_of(cue, layer, "ended", t))
            low, high = lane.starts.searchsorted((before, now), "right")
            for cue in lane.cues[int(low) : int(high)]:
                request = cue.meta.partition("+")[0]
                event = _event_of(cue, layer, "started", t)
                for each in (request, *served.get(cue.meta, ())):
                    self._start(each, request, layer, cue.start, event, plan, ledger, now)
        self._follow_speech(plan, ledger, before, now)
        for request in [x for x, late in self._leaving.items() if late.until < now]:
            late = self._leaving.pop(request)  # it was held up after all
            self._tell(late.owner, late.ident, late.event)
        for request in [x for x, one in self.running.items() if not _lasts(plan, one, now)]:
            self._end(request, plan, ledger, now)

    def _follow_speech(self, plan: Plan, ledger: Ledger, before: float, now: float) -> None:
        t, track = round_seconds(now), plan.track
        pieces: dict[tuple[str, float], list[Speech]] = {key: [] for key in self.utterances}
        for speech in track.speeches:
            key = (speech.id, speech.asked)
            one = self.utterances.get(key)
            if one is not None:
                pieces[key].append(speech)
            begins_late = one is not None and one.since is None and speech.start <= now < speech.end
            if before < speech.start <= now or begins_late:
                event = _event_of_speech(speech, "started", t)
                self._tell(None if one is None else one.owner, None if one is None else one.ident, event)
                if one is not None and one.since is None:
                    one.since = speech.start
        for key, said in pieces.items():
            last = said[-1] if said else None
            awaits = last is not None and last.more and self.utterances[key].reason is None
            if last is None or not (last.end > now or (awaits and track.last_speech(key[0]) is last)):
                self._end_utterance(key, last, plan, ledger, now)

    def _end_utterance(
        self, key: tuple[str, float], last: Speech | None, plan: Plan, ledger: Ledger, now: float
    ) -> None:
        """Report that an utterance has ended, and why. last: its last piece, None if none is left."""
        one, request = self.utterances.pop(key), key[0]
        others = any(name == request for name, _ in self.utterances)
        ask = ledger.known.get(request)
        if ask is not None and ask.lane in SAID and not others:
            ask.ended = True
        reason, why, spoken, word, at = one.reason, "", None, None, None
        if last is None:
            reason = reason or ("replaced" if others else "dropped")
            why, event = UNSAID, Event(event="ended", t=round_seconds(now))
        else:
            event = _event_of_speech(last, "ended", round_seconds(now))
            at = None if one.since is None else round_seconds(one.since)
            if last.length is not None:
                spoken, word = spoken_until(ALPHABET, plan.track.speeches, request, last.end)
                reason = reason or ("replaced" if _said_again(plan, last) else "interrupted")
                why = "something else is said"
        reason = reason or "finished"
        why = one.why or WHY.get(reason, why)
        event = replace(event, at=at, reason=reason, why=why, spoken=spoken, last_word=word)
        self._tell(one.owner, one.ident, event)

    def _tell(self, owner: int | None, ident: str | None, event: Event) -> None:
        self._told.append((owner, ident, event))

    def _start(
        self,
        request: str,
        played: str,
        layer: Layer,
        start: float,
        event: Event,
        plan: Plan,
        ledger: Ledger,
        now: float,
    ) -> None:
        before = self.running.get(request)
        if before is not None and not _lasts(plan, before, now):
            self._end(request, plan, ledger, now)
            before = None
        owner = ledger.owner(request)
        leaving = self._leaving.pop(request, None)
        if leaving is not None:
            self._tell(leaving.owner, leaving.ident, event)
            reason = leaving.event.reason
            self.running[request] = Running(leaving.owner, leaving.ident, played, layer, event, start, reason)
            return
        if owner is None and before is None:
            if request == played:
                self._tell(None, None, event)
            return
        if owner is None and before is not None:
            whose, ident = before.owner, before.ident
        else:
            ask = ledger.known[str(owner)]
            whose, ident = ask.client, ask.ident + request.removeprefix(str(owner))
        self._tell(whose, ident, event)
        self.running[request] = Running(whose, ident, played, layer, event, start)

    def _end(self, request: str, plan: Plan, ledger: Ledger, now: float) -> None:
        """Report that a request that ran has ended, and why."""
        one = self.running.pop(request)
        reason, why = one.reason, ""
        event = replace(one.event, event="ended", t=round_seconds(now))
        cue = _cue_of(plan, one)
        if cue is not None:
            event = _event_of(cue, one.layer, "ended", event.t)
            cuts = [r for r in plan.reports if r.request == request and r.outcome in ("cut", "covered")]
            if reason is None and cuts:
                reason, why = "interrupted", reword_for_client(cuts[-1].message, one.owner)
        reason = reason or "finished"
        why = one.why or WHY.get(reason, why)
        self._tell(one.owner, one.ident, replace(event, reason=reason, why=why))
        ask = ledger.known.get(request)
        if ask is not None and ask.at <= now:  # else it was asked again, and is still to come
            ask.ended = True


def _begins(plan: Plan, request: str, layer: Layer, after: float, fixed: float) -> bool:
    """Whether an action of a request begins later than `after` and before `fixed` seconds."""
    low, high = plan.layers[layer].starts.searchsorted((after, fixed), "right")
    cues = plan.layers[layer].cues[int(low) : int(high)]
    return any(c.meta.partition("+")[0] == request and c.start < fixed for c in cues)


def _said_again(plan: Plan, speech: Speech) -> bool:
    return any(s.id == speech.id and s.start == speech.end for s in plan.track.speeches)


def _lasts(plan: Plan, one: Running, now: float) -> bool:
    """Whether something of a request still plays, or comes."""
    latest = float("inf") if one.reason is None else one.start
    lane = plan.layers[one.layer]
    for cue in reversed(lane.cues):
        if cue.end <= now:
            break
        if cue.start <= latest and cue.meta.partition("+")[0] == one.request:
            return True
    return one.reason is None and any(
        m.request.id == one.request for m in reversed(lane.metas) if m.start >= plan.end
    )


def _cue_of(plan: Plan, one: Running) -> Cue | None:
    """Return the last action of a request that has ended."""
    cues = reversed(plan.layers[one.layer].cues)
    return next((c for c in cues if c.meta.partition("+")[0] == one.request and c.start <= one.start), None)


def _event_of(cue: Cue, layer: Layer, word: Word, t: float) -> Event:
    at, until = round_seconds(cue.start), round_seconds(cue.end)
    return Event(event=word, t=t, layer=layer, action=cue.action.name, at=at, until=until)


def _event_of_speech(speech: Speech, word: Word, t: float) -> Event:
    at, until = round_seconds(speech.start), round_seconds(speech.end)
    skip = round_seconds(speech.skip) if speech.skip > 0 and word == "started" else None
    text = speech.text or None
    return Event(event=word, t=t, line=speech.line, text=text, at=at, until=until, skip=skip)
