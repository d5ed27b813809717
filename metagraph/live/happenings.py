"""What has begun and ended between two ticks, told to the clients that want to know."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from typing import Any, Protocol

from metagraph.graph.model import LAYERS
from metagraph.live.ledger import Ledger
from metagraph.live.messages import Event, rounded
from metagraph.playback.plan import Plan

LONGEST = 60.0  # seconds a speech is looked back for


class Listener(Protocol):
    """A client. events: "" for none, "own" or "all"."""

    number: int
    events: str


def happenings(
    plan: Plan, ledger: Ledger, before: float, now: float, clients: Collection[Listener]
) -> Iterator[tuple[int, Event]]:
    """Yield whom to tell what: actions and speeches that started or ended after `before`, until `now`."""
    listening = [client for client in clients if client.events]
    for word, request, what in _changes(plan, before, now) if listening else ():
        owner = ledger.owner(request)
        ask = ledger.known[owner] if owner is not None else None
        for client in listening:
            own = ask is not None and ask.client == client.number
            if own or client.events == "all":
                yield (
                    client.number,
                    Event(
                        event=word,  # type: ignore[arg-type]
                        t=rounded(now),  # type: ignore[arg-type]
                        id=ask.ident if ask is not None and own else None,
                        **what,
                    ),
                )


def _changes(plan: Plan, before: float, now: float) -> Iterator[tuple[str, str, dict[str, Any]]]:
    for layer in LAYERS:
        lane = plan.layers[layer]
        for word, times in (("ended", lane.ends), ("started", lane.starts)):
            low, high = times.searchsorted((before, now), "right")
            for cue in lane.cues[int(low) : int(high)]:
                times_ = {"at": rounded(cue.start), "until": rounded(cue.end)}
                yield word, cue.meta.partition("+")[0], {"layer": layer, "action": cue.action.name, **times_}
    for speech in reversed(plan.track.speeches):
        if speech.start < before - LONGEST and speech.end < before:
            break
        for word, at in (("started", speech.start), ("ended", speech.end)):
            if before < at <= now:
                said = {"line": speech.line, "text": speech.text or None}
                yield word, speech.id, {"at": rounded(speech.start), "until": rounded(speech.end), **said}
