"""What has begun and ended between two ticks, told to the clients that want to know. What a client asked for
ends once, whatever becomes of it.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from typing import Literal, Protocol

from msgspec.structs import replace

from metagraph.graph.model import LAYERS, Layer
from metagraph.live.ledger import Ledger, OpenAsk, reword_for_client
from metagraph.live.limits import ADDED
from metagraph.live.messages import Event, Reason, round_seconds
from metagraph.playback.life.alphabet import ALPHABET
from metagraph.playback.life.items import find_line_start
from metagraph.playback.life.track import Speech
from metagraph.playback.life.utterances import is_paused, is_same_utterance
from metagraph.playback.plan import Cue, Plan
from metagraph.playback.planning.extend_performance import find_served
from metagraph.speech.spoken_so_far import spoken_until

LONGEST = 60.0  # seconds a speech is looked back for
TOLD: tuple[str, ...] = (*LAYERS, "say", ADDED)  # of which it is told when they begin and end
Word = Literal["started", "ended"]
WHY: dict[Reason, str] = {"withdrawn": "taken back", "replaced": "asked again under the same id"}


class Listener(Protocol):
    """A client. events: "" for none, "own" or "all"."""

    number: int
    events: str

    @property
    def owner(self) -> int: ...


@dataclass(slots=True)
class Running:
    """A request of a client that has started and not ended. owner, ident: whose it is, and what that one
    calls it. request: of the plan, that plays it. layer: None for speech. start: of what plays, seconds.
    since: when the first piece of it began. reason: why it ends, None as long as nothing but its own
    end is known; why: in words, if that is given.
    """

    owner: int
    ident: str
    request: str
    layer: Layer | None
    event: Event
    start: float
    since: float
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
    """What runs, by the requests of the plan."""

    def __init__(self) -> None:
        self.running: dict[str, Running] = {}
        self._leaving: dict[str, Leaving] = {}
        self._followed = 0.0  # seconds; what began by then runs
        self._told: list[tuple[int | None, str | None, Event]] = []  # whose, called what, which

    def stop(self, request: str, reason: Reason, why: str = "") -> None:
        """Take note why a request ends."""
        if request in self.running:
            self.running[request].reason, self.running[request].why = reason, why

    def owes_end(self, request: str) -> bool:
        """Whether it is still to be told that a request has ended, which runs or begins because it is too
        late to change that.
        """
        return request in self.running or request in self._leaving

    def list_lasting(self) -> list[str]:
        """Return the requests that run and are not known to end."""
        return [request for request, one in self.running.items() if one.reason is None]

    def end_waiting(
        self, key: str, ask: OpenAsk, reason: Reason, why: str, now: float, plan: Plan, fixed: float
    ) -> None:
        """Report that something ends which was promised and never began; what begins before `fixed` seconds
        cannot be stopped, and ends a moment later.
        """
        taken = reason in ("withdrawn", "interrupted")  # which is known before it is planned
        runs = self._runs(key, ask, plan) if taken else key in self.running
        if not ask.settled or ask.ended or runs or ask.lane not in TOLD:
            return
        ask.ended = True
        layer = next((x for x in LAYERS if x == ask.lane), None)
        event = Event(event="ended", t=round_seconds(now), layer=layer, reason=reason, why=why)
        if _begins(plan, key, layer, self._followed, fixed):
            self._leaving[key] = Leaving(ask.client, ask.ident, fixed, event)
        else:
            self._tell(ask.client, ask.ident, event)

    def _runs(self, key: str, ask: OpenAsk, plan: Plan) -> bool:
        """Whether an ask runs, and not only what was said under its id before it."""
        one = self.running.get(key)
        if one is None or one.layer is not None or not one.start < ask.at or ask.at <= self._followed:
            return one is not None
        return any(abs(piece.start - ask.at) < 1e-6 for piece in _list_pieces(plan, one, True))

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
        for speech in plan.track.speeches:
            if speech.end < before - LONGEST:
                continue
            crosses = before < speech.start <= now
            runs = speech.start <= now < speech.end and speech.id not in self.running
            if crosses or (runs and ledger.owner(speech.id) is not None):
                event = _event_of_speech(speech, "started", t)
                self._start(speech.id, speech.id, None, speech.start, event, plan, ledger, now)
        for request in [x for x, late in self._leaving.items() if late.until < now]:
            late = self._leaving.pop(request)  # it was held up after all
            self._tell(late.owner, late.ident, late.event)
        for request in [x for x, one in self.running.items() if not _lasts(plan, one, now)]:
            self._end(request, plan, ledger, now)

    def _tell(self, owner: int | None, ident: str | None, event: Event) -> None:
        self._told.append((owner, ident, event))

    def _start(
        self,
        request: str,
        played: str,
        layer: Layer | None,
        start: float,
        event: Event,
        plan: Plan,
        ledger: Ledger,
        now: float,
    ) -> None:
        before = self.running.get(request)
        goes_on = before is not None and any(s.start == start for s in _list_pieces(plan, before))
        if before is not None and not goes_on and not _lasts(plan, before, now):
            self._end(request, plan, ledger, now)
            before = None
        owner = ledger.owner(request)
        leaving = self._leaving.pop(request, None)
        if leaving is not None:
            self._tell(leaving.owner, leaving.ident, event)
            reason = leaving.event.reason
            self.running[request] = Running(
                leaving.owner, leaving.ident, played, layer, event, start, start, reason
            )
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
        since = start if before is None else before.since
        self.running[request] = Running(whose, ident, played, layer, event, start, since)

    def _end(self, request: str, plan: Plan, ledger: Ledger, now: float) -> None:
        """Report that a request that ran has ended, and why."""
        one = self.running.pop(request)
        reason, why, spoken, word = one.reason, "", None, None
        event = replace(one.event, event="ended", t=round_seconds(now))
        speech = next((s for s in plan.track.speeches if s.id == request and s.start == one.start), None)
        cue = _cue_of(plan, one)
        if speech is not None:
            event = replace(_event_of_speech(speech, "ended", event.t), at=round_seconds(one.since))
            if speech.length is not None:
                spoken, word = spoken_until(ALPHABET, plan.track.speeches, speech.id, speech.end)
                reason = reason or ("replaced" if _said_again(plan, speech) else "interrupted")
                why = one.why or WHY.get(reason, "something else is said")
        elif cue is not None and one.layer is not None:
            event = _event_of(cue, one.layer, "ended", event.t)
            cuts = [r for r in plan.reports if r.request == request and r.outcome in ("cut", "covered")]
            if reason is None and cuts:
                reason, why = "interrupted", reword_for_client(cuts[-1].message, one.owner)
        reason = reason or "finished"
        why = one.why or WHY.get(reason, why)
        event = replace(event, reason=reason, why=why, spoken=spoken, last_word=word)
        self._tell(one.owner, one.ident, event)
        ask = ledger.known.get(request)
        if ask is not None and ask.at <= now:  # else it was asked again, and is still to come
            ask.ended = True


def find_beginning(speeches: Sequence[Speech], piece: Speech) -> float:
    """Return when an utterance began, seconds, of which `piece` is one of the pieces, in the order of their
    starts: a pause does not move that. What is paused before it began begins in a time that never comes.
    """
    first = piece
    for earlier in reversed([x for x in speeches if x.id == piece.id and x.start < piece.start]):
        if not is_same_utterance(earlier, first):
            break
        first = earlier
    return first.start if is_paused(first.start) else find_line_start(first)


def _begins(plan: Plan, request: str, layer: Layer | None, after: float, fixed: float) -> bool:
    """Whether something of a request begins later than `after` and before `fixed` seconds."""
    if layer is None:
        return any(s.id == request and after < s.start < fixed for s in plan.track.speeches)
    low, high = plan.layers[layer].starts.searchsorted((after, fixed), "right")
    cues = plan.layers[layer].cues[int(low) : int(high)]
    return any(c.meta.partition("+")[0] == request and c.start < fixed for c in cues)


def _said_again(plan: Plan, speech: Speech) -> bool:
    return any(s.id == speech.id and s.start == speech.end for s in plan.track.speeches)


def _list_pieces(plan: Plan, one: Running, whole: bool = False) -> list[Speech]:
    """Return the pieces of an utterance that runs, in the order of their starts; none of an action. whole:
    also those after it was said why it ends.
    """
    if one.layer is not None:
        return []
    latest = float("inf") if one.reason is None or whole else one.start
    every = [s for s in plan.track.speeches if s.id == one.request and one.start <= s.start <= latest]
    out = every[:1]
    for piece in every[1:]:
        if not is_same_utterance(out[-1], piece):
            break
        out.append(piece)
    return out


def _lasts(plan: Plan, one: Running, now: float) -> bool:
    """Whether something of a request still plays, or comes."""
    latest = float("inf") if one.reason is None else one.start
    if one.layer is None:
        pieces = _list_pieces(plan, one)
        return bool(pieces) and (pieces[-1].end > now or (pieces[-1].more and one.reason is None))
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
    if one.layer is None:
        return None
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
