"""The pieces of a tick: who asks, what waits for the plan, what comes out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from metagraph.graph import requests as a
from metagraph.graph.words import Layer
from metagraph.live.camera_mimicry import ClientCamera
from metagraph.live.ledger import OpenAsk
from metagraph.live.messages import Event, Reply
from metagraph.live.pose_stream import PoseFrame, Stream
from metagraph.playback.life.track import Speech, Track
from metagraph.playback.plan import Plan

THIN = 2.0  # seconds after which of a moving point only some places are kept
COARSE = 0.25  # seconds between those


@dataclass(slots=True)
class Agent:
    """Whose requests they are: of one client, or of all that have said the same name, one after the other.
    number: of its first client. count: of ids made up.
    """

    number: int
    count: int = 0


@dataclass(slots=True)
class Client:
    """Someone who asks. events: "" for none, "own" or "all"."""

    number: int
    agent: Agent
    name: str = ""
    events: str = ""
    stream: Stream | None = None
    camera: ClientCamera | None = None

    @property
    def owner(self) -> int:
        """The number that its requests are kept under."""
        return self.agent.number


@dataclass
class Out:
    """What a tick gives: a reply to each request in order, JSON where it is bytes; events and poses for
    clients.
    """

    replies: list[Reply | bytes] = field(default_factory=list)
    events: list[tuple[int, Event]] = field(default_factory=list)
    frames: list[PoseFrame] = field(default_factory=list)


@dataclass(slots=True)
class Open:
    """A request that waits for the plan. place: among the replies. parts: of a block, or of keypoints: key,
    what it is called, ask, why it was refused already. seen: of keypoints. why: what has become of it in the
    meantime. adds: what was said last under its id; replaces: what
    waited under it. also: those of the same tick that it is joined with.
    """

    place: int
    ident: str
    key: str
    parts: list[tuple[str, str, str, str]] | None = None
    notes: tuple[str, ...] = ()
    why: str = ""
    adds: Speech | None = None
    replaces: OpenAsk | None = None
    also: list[Open] = field(default_factory=list)
    seen: dict[Layer, str] = field(default_factory=dict)


@dataclass
class TickWork:
    """A tick's asks on their way into the plan. gone: what is taken back before they count, by its key.
    steered: what is done to what is said, in turn; turned: keys of what that concerns, and of the words that
    are paused for it.
    """

    asks: dict[str, a.AnyRequest] = field(default_factory=dict)
    gone: dict[str, a.AnyRequest] = field(default_factory=dict)
    open: dict[str, Open] = field(default_factory=dict)
    over: list[Open] = field(default_factory=list)
    steered: list[a.Interrupt | a.Pause | a.Resume | a.Finish] = field(default_factory=list)
    turned: set[str] = field(default_factory=set)
    paused: set[str] = field(default_factory=set)

    def close(self, key: str, why: str) -> OpenAsk | None:
        """Answer a request at once: something else has taken its place. Return what it would have replaced,
        if that was promised.
        """
        found = self.open.pop(key, None)
        every = () if found is None else (*found.also, found)
        for each in every:
            each.why = why
            self.over.append(each)
        return next((x.replaces for x in every if x.replaces is not None and x.replaces.settled), None)


def order_requests(clients: Sequence[int]) -> list[int]:
    """Return the places of requests in the order in which they are taken up: one of each client, then the
    next of each ..., so that who sends a thousand at once comes before nobody. clients: who sent each.
    """
    counts: dict[int, int] = {}
    turns = []
    for place, client in enumerate(clients):
        counts[client] = counts.get(client, 0) + 1
        turns.append((counts[client], place))
    return [place for _, place in sorted(turns)] if len(counts) > 1 else list(range(len(turns)))


def thin_track(plan: Plan, now: float) -> Track:
    """Return the track with fewer of the places a moving point had long ago; a stream of them would slow
    every plan down.
    """
    places = plan.track.places
    if len(places) < 100:
        return plan.track
    kept, last = [], dict[str, float]()
    for place in places:
        if place.start > now - THIN or place.start - last.get(place.name, -1e9) >= COARSE:
            kept.append(place)
            last[place.name] = place.start
    return replace(plan.track, places=tuple(kept)) if len(kept) < len(places) else plan.track
