"""How much a live session takes on, so that nobody can make it stall: what goes beyond is refused with the
reason.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right, insort
from collections import deque
from dataclasses import dataclass, field
from typing import Any

from metagraph.graph import requests as a
from metagraph.graph.model import LAYERS, Project
from metagraph.playback.understand import find_action, find_stance

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
RATES = {
    "look": 60,
    "place": 500,
    "blink": 16,
    "say": 16,
    "mode": 16,
    "withdraw": 240,
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

    def forget(self, now: float) -> None:
        """Drop what has begun."""
        del self.waiting[: bisect_left(self.waiting, (now, -1001, ""))]


@dataclass
class RequestWords:
    """The words a project knows, by which most asks that cannot be met are told at once."""

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
class Limits:
    """What has been taken on lately. lanes: layer -> what waits. recent: kind -> when such asks came."""

    lanes: dict[str, LimitLane] = field(default_factory=lambda: {layer: LimitLane() for layer in LAYERS})
    recent: dict[str, deque[float]] = field(default_factory=dict)
    full: dict[str, tuple[float, int]] = field(default_factory=dict)
    planned: int = 0
    characters: int = 0
    hints: int = 0
    hinted: float = 0.0

    def tick(self, now: float) -> None:
        """Begin a tick."""
        self.planned = self.characters = 0
        if now >= self.hinted + 1.0:
            self.hinted, self.hints = now, 0
        for lane in self.lanes.values():
            lane.forget(now)
        for times in self.recent.values():
            while times and times[0] < now - SPAN:
                times.popleft()

    def refusal(self, lane: str, at: float, wait: float, priority: int, now: float) -> str:
        """Return why an ask is not taken on, "" when it is."""
        if self.planned >= PLANNED_PER_TICK:
            return BUSY
        if lane in self.lanes:
            until, above = self.full.get(lane, (0.0, 0))
            if now < until and at <= now + wait and priority <= above:
                return f"the {lane} layer is taken for the next {wait:g} s by what is as important"
            count = self.lanes[lane].before(at, wait, priority)
            if count >= WAITING:
                return (
                    f"{count} requests as important wait for the {lane} layer within {wait:g} s of that time"
                )
            return ""
        times = self.recent.setdefault(lane, deque())
        if lane in RATES and len(times) >= RATES[lane]:
            return f"more than {RATES[lane]} of '{lane}' in {SPAN:g} s; try again in a moment"
        times.append(now)
        return ""


def unknown(project: Project, ask: Any, limits: Limits) -> str:
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
