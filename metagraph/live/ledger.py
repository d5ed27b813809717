"""What a live session still owes an answer for: the asks that have not ended, and how many wait for which
layer.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Collection, Iterator
from dataclasses import dataclass, field

from metagraph.live.answers import FoundAnswer, find_owning_ask
from metagraph.live.limits import Limits

OVER = 2.0  # seconds for which an ask that has ended is remembered
MOMENTS = ("place", "blink", "mode")  # asks that are over as soon as they have begun
_SAFE = re.compile(r"[\w# -]{1,100}")
_MADE = re.compile(r"(.+)/(\d{1,9})", re.DOTALL)
_CLIENTS = re.compile(r"c\d+/")
_NAMED = re.compile(r"'c(\d+)/([^']*)'")


def plan_key(client: int, ident: str) -> str:
    """Return what a client's id is called in the plan: apart from other clients', and free of what has a
    meaning there, except for a number behind a "/": "answer/2" was made for what "answer" says.
    """
    made = _MADE.fullmatch(ident)
    if made:
        return f"{plan_key(client, made[1])}/{made[2]}"
    if _SAFE.fullmatch(ident) or not ident:
        return f"c{client}/{ident}"
    return f"c{client}/~{hashlib.blake2s(ident.encode('utf-8', 'surrogatepass'), digest_size=12).hexdigest()}"


def is_asked_by_client(meta: str) -> bool:
    """Whether what plays in the plan was asked for, and not written by a model or the character's own."""
    return _CLIENTS.match(meta) is not None


def reword_for_client(why: str, client: int) -> str:
    """Return words about requests as a client may read them: its own ids as it says them, other clients' not
    at all.
    """
    return _NAMED.sub(lambda m: f"'{m[2]}'" if int(m[1]) == client else "another client's request", why)[
        :1000
    ]


@dataclass(slots=True)
class OpenAsk:
    """An ask that has not ended. ident: its id as its client says it. at: when it begins, as far as known.
    missed: seconds by which it was asked for too late. settled: whether it was answered. ended: whether it
    was told that it has. told: when it was asked for.
    """

    client: int
    ident: str
    lane: str
    priority: int
    at: float
    until: float | None = None
    state: str = ""
    actions: tuple[str, ...] = ()
    missed: float = 0.0
    ended: bool = False
    told: float = 0.0

    @property
    def settled(self) -> bool:
        return bool(self.state)

    def over(self, now: float) -> bool:
        """Whether one that has begun has ended, or lasts until something else comes."""
        if self.lane in MOMENTS or (self.until is None and self.lane in ("look", "mood")):
            return True
        return (self.at if self.until is None else self.until) < now - OVER

    def differs(self, found: FoundAnswer | None) -> bool:
        """Whether a plan now does something else than was answered. Times are reported to the millisecond."""
        if found is None:
            return True
        at, until = found.begins, found.until
        same = found.said(self.missed) == self.state and _close(at, self.at) and _close(until, self.until)
        return not same or tuple(found.what) != self.actions

    def settle(self, found: FoundAnswer) -> None:
        """Take in what the plan does about it."""
        self.state, self.until, self.actions = found.said(self.missed), found.until, tuple(found.what)
        self.at = self.at if found.begins is None else found.begins


def _close(a: float | None, b: float | None) -> bool:
    return a == b or (a is not None and b is not None and abs(a - b) < 1e-3)


@dataclass
class Ledger:
    """known: key -> ask. blocks: key of a block of BML -> keys of its parts."""

    limits: Limits = field(default_factory=Limits)
    known: dict[str, OpenAsk] = field(default_factory=dict)
    blocks: dict[str, tuple[str, ...]] = field(default_factory=dict)

    def add(self, key: str, ask: OpenAsk) -> None:
        """Take an ask in, in the place of any other of its key."""
        self.drop(key)
        self.known[key] = ask
        self._wait(key, ask, True)

    def drop(self, key: str) -> list[tuple[str, OpenAsk]]:
        """Forget an ask, or all parts of a block; return what was known of them."""
        out = []
        for each in (key, *self.blocks.pop(key, ())):
            ask = self.known.pop(each, None)
            if ask is not None:
                self._wait(each, ask, False)
                out.append((each, ask))
        return out

    def settle(self, key: str, found: FoundAnswer) -> None:
        """Take in what the plan does about an ask."""
        ask = self.known[key]
        self._wait(key, ask, False)
        ask.settle(found)
        self._wait(key, ask, True)

    def _wait(self, key: str, ask: OpenAsk, waits: bool) -> None:
        lane = self.limits.lanes.get(ask.lane)
        if lane is not None:
            (lane.add if waits else lane.remove)(ask.at, ask.priority, key)

    def of(self, client: int) -> Iterator[str]:
        """Every key of a client."""
        return (key for key, ask in self.known.items() if ask.client == client)

    def belonging(self, key: str) -> list[str]:
        """Every key that is this ask, a part of it, or made for what it says."""
        made = [k for k in self.known if k.rpartition("/")[0] == key and k != key]
        return [k for k in (key, *self.blocks.get(key, ()), *made) if k in self.known]

    def owner(self, request: str) -> str | None:
        """Return which ask a request of the plan belongs to."""
        return find_owning_ask(request, self.known)

    def pending(self, now: float) -> int:
        """How many have not begun."""
        return sum(1 for ask in self.known.values() if ask.at > now)

    def forget(self, now: float, open_: Collection[str]) -> list[tuple[str, OpenAsk]]:
        """Drop what is over; return it. open_: keys of utterances that may have fallen silent and are not."""
        over = [key for key, ask in self.known.items() if ask.settled and ask.at < now and ask.over(now)]
        over = [key for key in over if key not in open_]
        gone = [one for key in over for one in self.drop(key)]
        for key in [
            key for key, parts in self.blocks.items() if not any(part in self.known for part in parts)
        ]:
            del self.blocks[key]
        return gone
