"""All clients of a session, whatever line they are on: what they send is gathered into batches, answers go
back in order.

No sockets here, and no threads: lines call in, and are told what to send.
"""

from __future__ import annotations

import hmac
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Protocol

import msgspec

from metagraph.graph.requests import RequestError
from metagraph.live.messages import HeardMessage, Hello, Reply, encode, read_live_request, split_message
from metagraph.live.wire import BatchResult, RequestBatch

CLIENTS = 64  # at most
BACKLOG = 4 * 1024 * 1024  # bytes a client may leave unread
POSES_BACKLOG = 128 * 1024  # bytes unread beyond which poses are left out rather than queued
PER_BATCH = (
    2000  # requests passed on and not answered; each client has its share, half where there is one other
)
UNANSWERED = 20000  # requests of one client for which no answer has come
PROVE = 5.0  # seconds within which a client has to show its token

BUSY_WORDS = "too much at once; try again in a moment"
BUSY = encode(Reply(state="refused", why=BUSY_WORDS))
SLOW, TOO_FAST, STRANGER = (
    "reads too slowly",
    "sends requests faster than they can be answered",
    "needs a token; send it in `hello` first",
)
POLICY, GOING, TRY_LATER = 1008, 1001, 1013  # reasons of closing, as WebSocket numbers them


class ClientLine(Protocol):
    """The way to one client."""

    @property
    def formats(self) -> Sequence[str]:
        """Ways of writing poses that it carries."""

    def send(self, messages: list[tuple[bytes, bool]]) -> None:
        """Send texts and, where the second is true, bytes; never waits."""

    def answered(self, messages: int) -> None:
        """Take note that so many of the messages that came in are answered."""

    def backlog(self) -> int:
        """How many bytes wait to be read by the other side."""

    def close(self, code: int, reason: str) -> None:
        """Hang up, having said why."""


@dataclass(slots=True)
class _Client:
    line: ClientLine
    proven: bool
    since: float
    waiting: int = 0
    taken: int = 0


@dataclass(slots=True)
class _Slot:
    """One message: its requests' answers, None for those the session has to give. listed: whether it was a
    list.
    """

    client: int
    answers: list[bytes | None]
    listed: bool


@dataclass
class Hub:
    """token: what clients have to say first, None for nothing. wake: called when the first message comes in
    after a batch was taken.
    """

    token: str | None = None
    wake: Callable[[], None] = lambda: None
    clients: dict[int, _Client] = field(default_factory=dict)
    refused: int = 0
    _count: int = 0
    _number: int = 0
    _joined: list[int] = field(default_factory=list)
    _left: list[int] = field(default_factory=list)
    _asked: list[tuple[int, HeardMessage]] = field(default_factory=list)
    _slots: list[_Slot] = field(default_factory=list)
    _flying: deque[tuple[int, list[_Slot], int]] = field(default_factory=deque)  # with the count of requests

    def open(self, line: ClientLine, now: float, proven: bool = False) -> int:
        """Let a client in; return its number, 0 when there are too many. proven: it is known or has shown the
        token.
        """
        if len(self.clients) >= CLIENTS:
            self.refused += 1
            line.close(TRY_LATER, f"{CLIENTS} clients are connected already")
            return 0
        self._count += 1
        self.clients[self._count] = _Client(line, proven or self.token is None, now)
        self._joined.append(self._count)
        return self._count

    def gone(self, number: int) -> None:
        """Let a client go that has hung up."""
        if self.clients.pop(number, None) is not None:
            self._left.append(number)

    def drop(self, number: int, code: int, reason: str) -> None:
        """Hang up on a client."""
        client = self.clients.get(number)
        if client is not None:
            self.gone(number)
            client.line.close(code, reason)

    def message(self, number: int, data: bytes | str) -> None:
        """Take a message in."""
        client = self.clients.get(number)
        if client is None:
            return
        try:
            requests, listed = split_message(data)
        except RequestError as error:
            self._keep(client, _Slot(number, [encode(Reply(error=str(error)))], False))
            return
        slot = _Slot(number, [], listed)
        for request in requests:
            item = read_live_request(request)
            if not client.proven:
                client.proven = self._proves(item)
            if not client.proven:
                client.line.send([(encode(Reply(error=STRANGER)), False)])
                self.drop(number, POLICY, STRANGER)
                return
            slot.answers.append(self._request(number, client, item))
        self._keep(client, slot)

    def _keep(self, client: _Client, slot: _Slot) -> None:
        """Keep a message for the next batch. Hang up on a client that asks for more than can be kept."""
        client.waiting += len(slot.answers)
        self._slots.append(slot)
        if len(self._slots) == 1:
            self.wake()
        if client.waiting > UNANSWERED:
            self.drop(slot.client, POLICY, TOO_FAST)

    def _proves(self, item: HeardMessage | Reply) -> bool:
        """Whether a request shows the token."""
        return (
            self.token is not None
            and isinstance(item, HeardMessage)
            and isinstance(item.message, Hello)
            and is_right_token(item.message.token, self.token)
        )

    def _request(self, number: int, client: _Client, item: HeardMessage | Reply) -> bytes | None:
        """Return the answer to a request, None for what the session has to answer."""
        if isinstance(item, Reply):
            return encode(item)
        message = item.message
        if isinstance(message, Hello):
            wish = message.poses
            if isinstance(wish, msgspec.Struct) and wish.format not in client.line.formats:
                words = (
                    f"poses: this connection has the formats {' or '.join(client.line.formats)}, not as "
                    f"{wish.format}"
                )
                return encode(Reply(id=message.id or None, error=words))
            item = HeardMessage(msgspec.structs.replace(message, token=""))
        if len(self._asked) >= PER_BATCH or client.taken >= PER_BATCH // max(2, len(self.clients)):
            return encode(Reply(id=message.id, state="refused", why=BUSY_WORDS)) if message.id else BUSY
        client.taken += 1
        self._asked.append((number, item))
        return None

    def take(self) -> RequestBatch | None:
        """Return what came in since the last batch; None if nothing came or too much is unanswered."""
        if not (self._joined or self._left or self._slots):
            return None
        if self._flying and sum(count for _, _, count in self._flying) + len(self._asked) > PER_BATCH:
            return None
        self._number += 1
        batch = RequestBatch(self._number, tuple(self._joined), tuple(self._left), tuple(self._asked))
        self._flying.append((self._number, self._slots, len(self._asked)))
        self._joined, self._left, self._asked, self._slots = [], [], [], []
        return batch

    def give(self, result: BatchResult) -> None:
        """Pass a result on to those it is for. It answers all batches up to its number."""
        out: dict[int, list[tuple[bytes, bool]]] = {}
        replies = iter(result.replies)
        while self._flying and self._flying[0][0] <= result.number:
            for slot in self._flying.popleft()[1]:
                answers = [next(replies) if answer is None else answer for answer in slot.answers]
                client = self.clients.get(slot.client)
                if client is not None:
                    client.waiting -= len(answers)
                    data = b"[" + b",".join(answers) + b"]" if slot.listed else answers[0]
                    out.setdefault(slot.client, []).append((data, False))
                    client.line.answered(1)
        if result.number:
            for client in self.clients.values():
                client.taken = 0
        for number, data in result.events:
            out.setdefault(number, []).append((data, False))
        for picture in result.poses:
            for number in picture.clients:
                client = self.clients.get(number)
                if client is not None and client.line.backlog() < POSES_BACKLOG:
                    out.setdefault(number, []).append((picture.data, picture.binary))
        for number, messages in out.items():
            client = self.clients.get(number)
            if client is None:
                continue
            client.line.send(messages)
            if client.line.backlog() > BACKLOG:
                self.drop(number, POLICY, SLOW)

    @property
    def idle(self) -> bool:
        """Whether everything that came in has been answered."""
        return not self._flying and not self._slots

    def check(self, now: float) -> None:
        """Hang up on those that have not shown the token in time."""
        for number, client in list(self.clients.items()):
            if not client.proven and now - client.since > PROVE:
                self.drop(number, POLICY, STRANGER)

    def close(self) -> None:
        """Hang up on everyone."""
        for number in list(self.clients):
            self.drop(number, GOING, "the session has ended")


def is_right_token(given: str, token: str) -> bool:
    """Whether a token is right, in a time that does not tell how much of it is."""
    return hmac.compare_digest(given.encode("utf-8", "replace"), token.encode("utf-8", "replace"))
