"""What waits to be sent to who reads nothing is bounded, whatever it is: pongs, answers, refusals, poses."""

from __future__ import annotations

import asyncio
import base64
import json
import os
import struct
import threading
from typing import Any

import pytest

from metagraph.graph.model import Project
from metagraph.live import hub as hubs
from metagraph.live import osc, stdio, websocket
from metagraph.live.hub import POLICY, SLOW, UNANSWERED, Hub
from metagraph.live.mcp import McpLine
from metagraph.live.osc import OscLine
from metagraph.live.stdio import StdioLine
from metagraph.live.websocket import WebSocketLine

BACKLOG = 256 * 1024  # bytes, for these tests
CHUNK = 16 * 1024


@pytest.fixture(autouse=True)
def small_backlog(monkeypatch: pytest.MonkeyPatch) -> None:
    for module in (websocket, osc, stdio):
        monkeypatch.setattr(module, "BACKLOG", BACKLOG)


class Unread:
    """A transport whose other side reads nothing: all that is written waits."""

    def __init__(self) -> None:
        self.written, self.aborted = bytearray(), False

    def write(self, data: bytes) -> None:
        self.written += data

    def sendto(self, data: bytes, address: Any) -> None:
        self.written += data

    def get_write_buffer_size(self) -> int:
        return len(self.written)

    def is_closing(self) -> bool:
        return self.aborted

    def abort(self) -> None:
        self.aborted = True

    close = abort


def frame(opcode: int, data: bytes, final: bool = True) -> bytes:
    """Return a client's frame, masked with nothing."""
    size = bytes([0x80 | len(data)]) if len(data) < 126 else b"\xfe" + struct.pack(">H", len(data))
    return bytes([(0x80 if final else 0) | opcode]) + size + b"\0\0\0\0" + data


def greeted(hub: Hub) -> tuple[WebSocketLine, Unread]:
    line, transport = WebSocketLine(hub, set(), (), True), Unread()
    line.connection_made(transport)
    key = base64.b64encode(os.urandom(16)).decode()
    line.data_received(
        f"GET / HTTP/1.1\r\nHost: localhost:1\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n".encode()
    )
    assert line.number
    return line, transport


def flood(data: bytes) -> tuple[Unread, Hub]:
    """Send the same frames again and again to a server whose answers nobody reads."""

    async def play() -> tuple[Unread, Hub]:
        hub = Hub()
        line, transport = greeted(hub)
        chunk = data * (CHUNK // len(data))
        for _ in range(6 * BACKLOG // CHUNK):
            line.data_received(chunk)
        return transport, hub

    return asyncio.run(play())


@pytest.mark.nightly
@pytest.mark.parametrize(
    "data",
    [frame(9, b"p" * 125), frame(9, b""), frame(9, b"x") + frame(1, b"[]")],
    ids=["pings", "empty pings", "pings and messages"],
)
def test_pongs_are_bounded_and_who_reads_none_is_told_why_it_is_hung_up_on(data: bytes) -> None:
    transport, hub = flood(data)
    assert len(transport.written) < BACKLOG + 4 * CHUNK
    if len(data) > 100:
        assert struct.pack(">H", POLICY) + SLOW.encode() in transport.written
        assert not hub.clients


def test_a_message_in_endless_empty_pieces_takes_no_memory() -> None:
    async def play() -> int:
        line, _ = greeted(Hub())
        line.data_received(frame(1, b"[", final=False))
        for _ in range(50):
            line.data_received(frame(0, b"", final=False) * 1000)
        return len(line.message)

    assert asyncio.run(play()) == 1


def test_who_is_hung_up_on_gets_no_more_pongs() -> None:
    async def play() -> int:
        hub = Hub()
        line, transport = greeted(hub)
        transport.written += bytes(BACKLOG + 1)
        before = len(transport.written)
        line.data_received(frame(9, b"p" * 125) * 500)
        return len(transport.written) - before

    assert asyncio.run(play()) == 0


def test_nonsense_that_is_not_answered_yet_is_bounded_as_requests_are() -> None:
    async def play() -> tuple[Hub, Unread]:
        hub = Hub()
        line, transport = greeted(hub)
        for _ in range(UNANSWERED // 1000 + 2):
            line.data_received(frame(1, b"{") * 1000)
        return hub, transport

    hub, transport = asyncio.run(play())
    assert not hub.clients and len(hub._slots) <= UNANSWERED + 1000
    assert hubs.TOO_FAST.encode() in transport.written


def test_datagrams_that_the_system_does_not_take_are_lost() -> None:
    line, transport = OscLine(Hub(), lambda: 0.0), Unread()
    line.connection_made(transport)
    for _ in range(100):
        line.put(bytes(50_000), ("127.0.0.1", 1))
    assert len(transport.written) <= BACKLOG + 50_000


@pytest.mark.parametrize("kind", ["mcp", "stdio"])
def test_lines_are_read_no_further_while_their_answers_are_not_read(sample: Project, kind: str) -> None:
    """A client asks for long answers through a pipe, and reads none."""
    (source, asking), (answers, target) = os.pipe(), os.pipe()
    ended = threading.Event()

    def take(data: bytes | None) -> None:
        if data is None:
            ended.set()
            return
        line.send([(b"x" * 20_000, False)])
        line.answered(1)

    def call(then: Any, *given: Any) -> None:
        then(*given)

    line = (
        McpLine(sample, call, take, source, target)
        if kind == "mcp"
        else StdioLine(call, take, source, target)
    )
    line.start()
    asked = json.dumps({"jsonrpc": "2.0", "id": 1, "method": "tools/list"}).encode().ljust(4000) + b"\n"
    enough = threading.Event()

    def ask() -> None:
        written = 0
        while written < 3 * BACKLOG and not enough.is_set():
            written += os.write(asking, asked)
        os.close(asking)

    asker = threading.Thread(target=ask, daemon=True)
    asker.start()
    most = 0
    for _ in range(200):
        asker.join(0.1)
        before, most = most, max(most, line.backlog())
        if most > BACKLOG and most == before:
            break
    assert BACKLOG < most < 4 * BACKLOG
    enough.set()
    os.close(answers)  # who waits to write is let go
    line.close(0, "")
    asker.join(20)
    assert ended.wait(20), "its reader reads to the end, and answers nothing in later tests"
    line.finish(5.0)
    os.close(source)
    os.close(target)
