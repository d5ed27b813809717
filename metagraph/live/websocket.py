"""WebSocket lines. The protocol is the `websockets` package's, without its tasks: a message costs
microseconds, and writing never waits. What web pages may do is decided here.
"""

from __future__ import annotations

import asyncio
from collections.abc import Collection
from typing import Any

from websockets.frames import Frame, Opcode
from websockets.http11 import Request
from websockets.protocol import State
from websockets.server import ServerProtocol

from metagraph.live.hub import BACKLOG, CLIENTS, POLICY, SLOW, Hub, is_right_token
from metagraph.live.messages import LONGEST_MESSAGE

GREET = 5.0  # seconds for the opening handshake
PART = 2.0  # seconds for the closing one
QUIET = 20.0  # seconds of silence after which a client is asked whether it is there
LOST = 45.0  # seconds of silence after which it is not
LOCAL = ("localhost", "127.0.0.1", "[::1]")


class WebSocketLine(asyncio.Protocol):
    """One connection. lines: all that are open. origins: web pages, besides those of this machine, that may
    connect. local: whether only loopback is bound.
    """

    formats = ("json", "binary")

    def __init__(self, hub: Hub, lines: set[WebSocketLine], origins: Collection[str], local: bool) -> None:
        self.hub, self.lines, self.origins, self.local = hub, lines, origins, local
        self.protocol = ServerProtocol(max_size=LONGEST_MESSAGE)
        self.number = 0
        self.message = bytearray()
        self.transport: asyncio.Transport | None = None
        self.heard = self.made = 0.0
        self.pinged = self.parting = False

    # --- from the other side

    def connection_made(self, transport: Any) -> None:
        self.transport = transport
        waiting = [line for line in self.lines if line.protocol.state is State.CONNECTING]
        if len(waiting) >= CLIENTS:  # who has waited longest has had the most time to say hello
            min(waiting, key=lambda line: line.made).drop()
        if len(self.lines) >= 2 * CLIENTS:
            transport.abort()
            return
        loop = asyncio.get_running_loop()
        self.heard = self.made = loop.time()
        loop.call_later(GREET, self._greeted)
        self.lines.add(self)

    def drop(self) -> None:
        """Make room for another line, at once."""
        self.lines.discard(self)
        self.cut()

    def _greeted(self) -> None:
        if self.protocol.state is State.CONNECTING and self.transport is not None:
            self.transport.abort()

    def data_received(self, data: bytes) -> None:
        if self.backlog() > BACKLOG:
            return  # it was told to go, and will be cut off; answers to this, pongs too, would only pile up
        self.heard, self.pinged = asyncio.get_running_loop().time(), False
        self.protocol.receive_data(data)
        for event in self.protocol.events_received():
            if isinstance(event, Request):
                self._request(event)
            elif isinstance(event, Frame) and self.number:
                self._frame(event)
        self._flush()
        if self.backlog() > BACKLOG:
            self.hub.drop(self.number, POLICY, SLOW)

    def eof_received(self) -> None:
        self.protocol.receive_eof()
        self._flush()

    def connection_lost(self, error: Exception | None) -> None:
        self.lines.discard(self)
        self.hub.gone(self.number)
        self.transport = None

    def _request(self, request: Request) -> None:
        why = self._forbidden(request)
        token = _bearer(request)
        if why:
            response = self.protocol.reject(403, f"{why}\n")
        elif self.hub.token is not None and token is not None and not is_right_token(token, self.hub.token):
            response = self.protocol.reject(401, "that is not the token\n")
        else:
            response = self.protocol.accept(request)
        self.protocol.send_response(response)
        self._flush()
        if response.status_code == 101:
            self.number = self.hub.open(self, self.heard, proven=token is not None)

    def _forbidden(self, request: Request) -> str:
        """Return why a request is turned away: web pages of others must not drive the character behind
        somebody's back.
        """
        if self.hub.token is not None:
            return ""  # who knows the token may come from anywhere
        hosts, origins = request.headers.get_all("Host"), request.headers.get_all("Origin")
        if self.local and any(_name(host) not in LOCAL for host in hosts):
            return "this server only serves this computer; connect to localhost"
        if any(o not in self.origins and _name(o.partition("://")[2]) not in LOCAL for o in origins):
            return (
                f"web pages of '{origins[0][:100]}' may not connect; start with --origin to let them, or "
                "with --token"
            )
        return ""

    def _frame(self, frame: Frame) -> None:
        if frame.opcode in (Opcode.TEXT, Opcode.BINARY):
            self.message = bytearray(frame.data)
        elif frame.opcode is Opcode.CONT:
            self.message += frame.data
        else:
            return
        if frame.fin:
            data, self.message = bytes(self.message), bytearray()
            self.hub.message(self.number, data)

    # --- to the other side

    def send(self, messages: list[tuple[bytes, bool]]) -> None:
        """Send texts and bytes; never waits."""
        if self.protocol.state is not State.OPEN:
            return
        for data, binary in messages:
            (self.protocol.send_binary if binary else self.protocol.send_text)(data)
        self._flush()

    def answered(self, messages: int) -> None:
        """Nothing depends on it."""

    def backlog(self) -> int:
        """How many bytes wait here; what the system has taken on already is not counted."""
        return 0 if self.transport is None else self.transport.get_write_buffer_size()

    def close(self, code: int, reason: str) -> None:
        """Hang up, having said why; who does not answer is cut off."""
        self.number = 0
        if self.protocol.state is State.OPEN:
            self.protocol.send_close(code, reason)
            self._flush()
        asyncio.get_running_loop().call_later(PART, self.cut)

    def cut(self) -> None:
        """Break the connection off."""
        if self.transport is not None:
            self.transport.abort()

    def ask(self, now: float) -> None:
        """See whether the other side is still there, when it has been silent."""
        if self.protocol.state is State.OPEN and now - self.heard > QUIET and not self.pinged:
            self.pinged = True
            self.protocol.send_ping(b"")
            self._flush()
        elif now - self.heard > LOST:
            self.cut()

    def _flush(self) -> None:
        data = self.protocol.data_to_send()
        if self.transport is None or self.transport.is_closing():
            return
        end = bool(data) and data[-1] == b""
        whole = b"".join(data)
        if whole:
            self.transport.write(whole)
        if end:
            self.transport.close()
        elif (
            not self.parting
            and self.protocol.state is not State.CONNECTING
            and self.protocol.close_expected()
        ):
            self.parting = True
            asyncio.get_running_loop().call_later(PART, self.cut)


def _name(host: str) -> str:
    """Return a host without its port."""
    name, colon, port = host.strip().lower().rpartition(":")
    return name if colon and (port.isdigit() or not port) else host.strip().lower()


def _bearer(request: Request) -> str | None:
    found = request.headers.get_all("Authorization")
    scheme, _, token = found[0].partition(" ") if found else ("", "", "")
    return token.strip() if scheme.lower() == "bearer" else None
