"""What a session says of itself and of its character, as JSON."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol

import msgspec

from metagraph import __version__
from metagraph.graph.model import LAYERS, Project
from metagraph.graph.offered import list_offered_requests
from metagraph.live import limits, messages
from metagraph.live.generating import Generating
from metagraph.live.ledger import Ledger
from metagraph.live.pose_stream import Stream
from metagraph.live.tick_work import Client
from metagraph.playback.plan import Plan


class DescribedSession(Protocol):
    """What of a live session is reported. now: seconds since it began."""

    ledger: Ledger
    clients: dict[int, Client]
    now: float

    generating: Generating

    @property
    def plan(self) -> Plan: ...

    @property
    def project(self) -> Project: ...


MOST = {"lines": 2000, "points": 500, "actions": 20000}  # described at most


def with_id(data: bytes, ident: str) -> bytes:
    """Return a JSON object with an id."""
    return b'{"id":' + messages.encode(ident) + b"," + data[1:] if ident else data


def make_greeting(session: DescribedSession, stream: Stream | None, ident: str) -> bytes:
    """Return the reply to hello: what is spoken here, and in which order a stream's numbers come."""
    out: dict[str, Any] = {
        "state": "done",
        "metagraph": __version__,
        "t": round(session.now, 4),
        "project": session.project.name,
        "limits": {
            "bytes": messages.LONGEST,
            "bml": messages.LONGEST_BML,
            "list": messages.MOST,
            "pending": limits.PENDING,
            "seconds": limits.FARTHEST,
        },
    }
    if stream is not None:
        out["poses"] = msgspec.to_builtins(stream.wish) | {
            "rate": stream.wish.rate,
            "joints": stream.names,
            "morphs": stream.morphs,
        }
    return with_id(messages.encode(out), ident)


def describe_status(session: DescribedSession) -> bytes:
    """Return what plays at this moment."""
    now, plan = session.now, session.plan
    playing: dict[str, dict[str, Any]] = {}
    for layer in LAYERS:
        lane = plan.layers[layer]
        cue, stance = lane.cue_at(now), session.project.stance(lane.stance_at(now))
        playing[layer] = {"stance": stance.name if stance is not None else None}
        if cue is not None:
            playing[layer] |= {
                "action": cue.action.name,
                "kind": cue.action.kind,
                "at": round(cue.start, 4),
                "until": round(cue.end, 4),
            }
    spoken = next((s for s in reversed(plan.track.speeches) if s.start <= now < s.end), None)
    out = {
        "state": "done",
        "t": round(now, 4),
        "playing": playing,
        "speaking": None
        if spoken is None
        else {"line": spoken.line, "text": spoken.text, "until": round(spoken.end, 4)},
        "waiting": session.ledger.pending(now),
        "clients": len(session.clients),
        "generating": session.generating.status(),
    }
    return messages.encode(out)


def describe(project: Project, models: Sequence[str] = (), graphs: Sequence[str] = ()) -> bytes:
    """Return what may be asked of a character: its joints, stances, actions, tags, lines and points. models,
    graphs: those that can generate motion.
    """
    out = {
        "state": "done",
        **list_offered_requests(project, messages.WORDS),
        "models": list(models),
        "graphs": list(graphs),
    }
    return messages.encode(out)
