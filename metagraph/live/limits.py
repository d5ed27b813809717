"""How much a live session takes on, so that nobody can make it stall: what goes beyond is refused with the
reason.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right, insort
from collections import Counter, deque
from dataclasses import dataclass, field
from typing import Any

import msgspec

from metagraph.graph import requests as a
from metagraph.graph.model import LAYERS, Project
from metagraph.playback.planning.understand import find_action, find_stance

FARTHEST = 3600.0  # seconds ahead of now, and seconds anything may last
PENDING = 1000  # requests that have not begun, of all clients
PER_TICK = 2000  # requests answered at one tick; the rest is told to try again
PLANNED_PER_TICK = 64  # requests worked into the plan at one tick
WAITING = 8  # requests of one layer that wait for the same time, those as important counted
SPEECH = 2000  # characters said at once
BML_PER_TICK = 200_000  # characters of BML read at one tick
TAG = 200  # characters that a tag of it counts for besides its own
HINTS = 4  # words nobody knows that are looked up among those known, in a second
NAMES = 64  # points a session knows by name
SPAN = 4.0  # seconds over which these rates are counted
FLOOD = (
    32  # asks of one client for one layer in SPAN seconds, beyond which only one waits while others are there
)
HUNGRY = 1.5  # seconds for which others make way for who was turned away
ADDED = "say on"  # what is added to a line that is said, in pieces of a stream
RATES = {
    "look": 60,
    "place": 500,
    "blink": 16,
    "say": 16,
    ADDED: 960,
    "mode": 16,
    "withdraw": 240,
    "interrupt": 960,
    "pause": 960,
    "resume": 960,
    "finish": 960,
    "keypoints": 960,
    "generate": 8,
    "hear": 960,
}  # in SPAN seconds

BUSY = "too much at once; try again in a moment"


@dataclass
class LimitLane:
    """What waits for one layer: (seconds, priority, key), ascending."""

    waiting: list[tuple[float, int, str]] = field(default_factory=list)

    def add(self, at: float, priority: int, key: str) -> None:
        insort(self.waiting, (at, priority, key))

    def remove(self, at: float, priority: int, key: str) -> None:
        place = bisect_left(self.waiting, (at, priority, key))
        if place < len(self.waiting) and self.waiting[place][2] == key:
            del self.waiting[place]

    def before(self, at: float, wait: float, priority: int) -> int:
        """Return how many as important ones wait for times at which this one could play."""
        low = bisect_left(self.waiting, (at - wait, -1001, ""))
        high = bisect_right(self.waiting, (at + wait, 1001, ""))
        return sum(1 for _, other, _ in self.waiting[low:high] if other >= priority)

    def own(self, at: float, wait: float, client: int) -> int:
        """Return how many of one client wait for times at which another of its could play."""
        low = bisect_left(self.waiting, (at - wait, -1001, ""))
        high = bisect_right(self.waiting, (at + wait, 1001, ""))
        return sum(1 for _, _, key in self.waiting[low:high] if key.startswith(f"c{client}/"))

    def forget(self, now: float) -> None:
        """Drop what has begun."""
        del self.waiting[: bisect_left(self.waiting, (now, -1001, ""))]


@dataclass
class RequestWords:
    """The words a project knows, by which most asks that cannot be met are reported at once."""

    project: Project

    def __post_init__(self) -> None:
        self.actions: dict[str, set[str]] = {}
        self.stances: dict[str, set[str]] = {}
        for layer in LAYERS:
            graph = self.project.graphs[layer]
            for action in graph.actions.values():
                for word in (action.id, action.name):
                    self.actions.setdefault(word, set()).add(layer)
            for stance in graph.stances.values():
                for word in (stance.id, stance.name):
                    self.stances.setdefault(word, set()).add(layer)

    def lane(self, ask: Any) -> str | None:
        """Return which layer, or kind, an ask waits for; None when it names what does not exist."""
        match ask:
            case a.Gesture() | a.Fidget() | a.Change():
                return str(ask.layer)
            case a.Nod() | a.Shake():
                return "head"
            case a.Play():
                return _only(self.actions.get(ask.action), ask.layer)
            case a.Go():
                return _only(self.stances.get(ask.stance), ask.layer)
            case a.Say():
                return "say" if ask.line is None or str(ask.line) in self.project.lines else None
            case _:
                return str(ask.__struct_config__.tag)


def _only(layers: set[str] | None, layer: str | None) -> str | None:
    if not layers or (layer is not None and layer not in layers):
        return None
    return layer or min(layers)


@dataclass
class Share:
    """What clients had of one layer or kind lately. asked: client -> when last. had: client -> when it was
    taken on. turned_away: client -> when last, with how important an ask.
    """

    asked: dict[int, float] = field(default_factory=dict)
    had: dict[int, deque[float]] = field(default_factory=dict)
    turned_away: dict[int, tuple[float, int]] = field(default_factory=dict)
    asks: Counter[int] = field(default_factory=Counter)
    since: float = 0.0

    def tick(self, now: float) -> None:
        if now >= self.since + SPAN:
            self.since = now
            self.asks = Counter({c: n // 2 for c, n in self.asks.items() if n > 1})
        for client in [c for c, at in self.asked.items() if at < now - SPAN]:
            del self.asked[client]
            self.had.pop(client, None)
            self.turned_away.pop(client, None)
        for times in self.had.values():
            while times and times[0] < now - SPAN:
                times.popleft()

    def count(self, client: int) -> int:
        return len(self.had.get(client, ()))

    def of(self, whole: int) -> int:
        """Return how many of a whole are a client's for certain."""
        return max(1, whole // max(1, len(self.asked)))

    def greedy(self, client: int, priority: int, now: float) -> bool:
        """Return whether a client has had more than one that was turned away just now with what is as
        important.
        """
        own = self.count(client)
        return own > 0 and any(
            other != client and at > now - HUNGRY and as_important >= priority and own > self.count(other)
            for other, (at, as_important) in self.turned_away.items()
        )

    def flooding(self, client: int) -> bool:
        """Return whether a client asks for far more than can be played."""
        return self.asks[client] > FLOOD

    def take(self, client: int, now: float) -> None:
        self.had.setdefault(client, deque()).append(now)
        self.turned_away.pop(client, None)


@dataclass
class Limits:
    """What has been taken on lately. lanes: layer -> what waits. shares: layer or kind -> what each client
    had of it. full: layer and client -> until when there is no room for it, for what is how important.
    """

    lanes: dict[str, LimitLane] = field(default_factory=lambda: {layer: LimitLane() for layer in LAYERS})
    shares: dict[str, Share] = field(default_factory=dict)
    full: dict[tuple[str, int], tuple[float, int]] = field(default_factory=dict)
    planned: Counter[int] = field(default_factory=Counter)
    several: bool = False
    around: set[int] = field(default_factory=set)
    characters: int = 0
    hints: int = 0
    hinted: float = 0.0

    def tick(self, now: float) -> None:
        """Begin a tick."""
        self.characters = 0
        self.planned.clear()
        if now >= self.hinted + 1.0:
            self.hinted, self.hints = now, 0
        for lane in self.lanes.values():
            lane.forget(now)
        for share in self.shares.values():
            share.tick(now)

    def share(self, lane: str) -> Share:
        return self.shares.setdefault(lane, Share())

    def refusal(self, lane: str, at: float, wait: float, priority: int, now: float, client: int = 0) -> str:
        """Return why an ask of a client is not taken on, "" when it is: each has its share for certain, and
        more while nobody else is turned away.
        """
        share = self.share(lane)
        share.asked[client] = now
        share.asks[client] += 1
        why = self._refusal(share, lane, at, wait, priority, now, client)
        if why:
            share.turned_away[client] = now, priority
        else:
            share.take(client, now)
        return why

    def turned_away(self, lane: str, client: int, priority: int, now: float) -> None:
        """Take note that there was no room after all for what a client asked for."""
        share = self.share(lane)
        if times := share.had.get(client):
            times.pop()
        share.turned_away[client] = now, priority

    def busy(self, client: int) -> bool:
        """Return whether no more of a client's asks are worked into the plan at this tick."""
        own = self.planned[client]
        return self.planned.total() >= PLANNED_PER_TICK and own >= PLANNED_PER_TICK // max(
            1, len(self.around)
        )

    def _refusal(
        self, share: Share, lane: str, at: float, wait: float, priority: int, now: float, client: int
    ) -> str:
        if self.busy(client):
            return BUSY
        if share.greedy(client, priority, now):
            return f"other clients have used '{lane}' less than you; try again in a moment"
        if lane in self.lanes:
            until, above = self.full.get((lane, client), (0.0, 0))
            if now < until and at <= now + wait and priority <= above:
                return f"a request of the same importance uses the {lane} layer for the next {wait:g} s"
            if self.several and share.flooding(client) and self.lanes[lane].own(at, wait, client):
                return (
                    f"you use '{lane}' too often while other clients wait; one of your requests waits already"
                )
            count = self.lanes[lane].before(at, wait, priority)
            if count >= WAITING and self.lanes[lane].own(at, wait, client) >= share.of(WAITING):
                return f"{count} requests of the same importance wait for the {lane} layer within {wait:g} s"
            return ""
        over = lane in RATES and sum(map(len, share.had.values())) >= RATES[lane]
        if over and share.count(client) >= share.of(RATES[lane]):
            return f"more than {RATES[lane]} of '{lane}' in {SPAN:g} s; try again in a moment"
        return ""


def explain_too_far(ask: Any, now: float) -> str:
    """Say which time of an ask is too far ahead, or too long; "" where none is."""
    for name in ("at", "stroke", "duration"):
        value = getattr(ask, name, None)
        if value is None:
            continue
        if name == "duration" and value > FARTHEST:
            return f"{name}: at most {FARTHEST:g} s"
        if name != "duration" and value > FARTHEST + now:
            return f"{name}: at most {FARTHEST:g} s ahead; the session is at {now:.1f} s"
    return ""


@dataclass(frozen=True)
class Timed:
    """An ask as it is understood now. missed: seconds since it should have come. why: it comes too late, ""
    if it does not.
    """

    ask: Any
    missed: float
    why: str = ""


def set_start_now(ask: Any, now: float, wait: float) -> Timed:
    """Return an ask without a start that is over. wait: how long the project lets asks wait."""
    stroke, late, missed = getattr(ask, "stroke", None), getattr(ask, "late", None), 0.0
    if ask.at is not None and ask.at < now:
        missed, ask = now - ask.at, msgspec.structs.replace(ask, at=None)
    if stroke is not None:
        missed = max(0.0, now - stroke)
    if late is not None and missed > late:
        why = f"too late by {missed:.2f} s, with {late:g} s allowed; the session is at {now:.1f} s"
        return Timed(ask, missed, why)
    if late is not None and stroke is None and missed > 0:
        ask = msgspec.structs.replace(ask, late=late - missed)  # it counts from when it was asked for
    if missed > wait:
        return Timed(ask, missed, f"too late by {missed:.1f} s; the session is at {now:.1f} s")
    return Timed(ask, missed)


def explain_unknown(project: Project, ask: Any, limits: Limits) -> str:
    """Say that there is nothing of a name that an ask has; for a few asks a tick, which names there are."""
    limits.hints += 1
    what, name = (
        ("line", ask.line)
        if isinstance(ask, a.Say)
        else ("action", ask.action)
        if isinstance(ask, a.Play)
        else ("stance", ask.stance)
    )
    if limits.hints <= HINTS:
        try:
            if isinstance(ask, a.Play):
                find_action(project, ask.action, ask.layer)
            elif isinstance(ask, a.Go):
                find_stance(project, ask.stance, ask.layer)
        except a.RequestError as error:
            return str(error)
    known = f"; there are {', '.join(list(project.lines)[:6]) or 'none'}" if what == "line" else ""
    return f"there is no {what} '{str(name)[:60]}'{known}"
