"""What has begun and ended between two ticks, told to the clients that want to know."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from typing import Literal, Protocol

from msgspec.structs import replace

from metagraph.graph.model import LAYERS
from metagraph.live.ledger import Ledger
from metagraph.live.messages import Event, round_seconds
from metagraph.playback.plan import Plan

HAPPENED: tuple[Literal["started", "ended"], ...] = ("started", "ended")
LONGEST = 60.0  # seconds a speech is looked back for


class Listener(Protocol):
    """A client. events: "" for none, "own" or "all"."""

    number: int
    events: str


def list_happenings(
    plan: Plan, ledger: Ledger, before: float, now: float, clients: Collection[Listener]
) -> Iterator[tuple[int, Event]]:
    """Yield whom to tell what: actions and speeches that started or ended after `before`, until `now`."""
    listening = [client for client in clients if client.events]
    for request, event in _changes(plan, before, now) if listening else ():
        owner = ledger.owner(request)
        ask = ledger.known[owner] if owner is not None else None
        for client in listening:
            own = ask is not None and ask.client == client.number
            if own or client.events == "all":
                yield client.number, replace(event, id=ask.ident if ask is not None and own else None)


def _changes(plan: Plan, before: float, now: float) -> Iterator[tuple[str, Event]]:
    """Yield of what request something has started or ended, and the event."""
    t = round_seconds(now)
    for layer in LAYERS:
        lane = plan.layers[layer]
        for word in reversed(HAPPENED):
            times = lane.starts if word == "started" else lane.ends
            low, high = times.searchsorted((before, now), "right")
            for cue in lane.cues[int(low) : int(high)]:
                at, until = round_seconds(cue.start), round_seconds(cue.end)
                event = Event(event=word, t=t, layer=layer, action=cue.action.name, at=at, until=until)
                yield cue.meta.partition("+")[0], event
    for speech in reversed(plan.track.speeches):
        if speech.start < before - LONGEST and speech.end < before:
            break
        at, until = round_seconds(speech.start), round_seconds(speech.end)
        for word, seconds in zip(HAPPENED, (speech.start, speech.end), strict=True):
            if before < seconds <= now:
                said = speech.text or None
                yield speech.id, Event(event=word, t=t, line=speech.line, text=said, at=at, until=until)
