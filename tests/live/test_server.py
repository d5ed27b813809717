"""The lines themselves, on this machine's loopback: WebSocket, OSC, JSON lines; who may come in, and who is
hung up on.
"""

from __future__ import annotations

import asyncio
import json
import os
import socket
import struct
import time
from typing import Any

import numpy as np
import pytest
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed, InvalidStatus

from metagraph.graph.model import Project
from metagraph.live import hub as hubs
from metagraph.live import websocket as lines
from metagraph.live.live_session import LiveSession
from metagraph.live.osc_bytes import pad_osc
from metagraph.live.pose_stream import HEADER, MAGIC
from metagraph.live.server import LiveError, Options, Server, check_live_options, is_loopback
from metagraph.live.wire import Ready, exchange
from tests.live.serving import play, serving
from tests.posing import pose_at


async def say(line: ClientConnection, request: Any) -> Any:
    await line.send(request if isinstance(request, str | bytes) else json.dumps(request))
    return json.loads(await line.recv())


# --- where it listens


@pytest.mark.parametrize("host", ["", "localhost", "127.0.0.1", "127.8.8.8", "::1", "[::1]"])
def test_loopback_is_loopback(host: str) -> None:
    assert is_loopback(host) and check_live_options(Options(host=host)).host == host


@pytest.mark.parametrize(
    "host", ["0.0.0.0", "::", "192.168.1.5", "example.org", "localhost.example.org", "127.0.0.1.example.org"]
)
def test_nothing_listens_beyond_loopback_without_a_token(host: str) -> None:
    with pytest.raises(LiveError, match="--token "):
        check_live_options(Options(host=host))
    assert check_live_options(Options(host=host, token="secret")).token == "secret"


def test_options_that_make_no_sense_are_refused() -> None:
    with pytest.raises(LiveError, match="the token is empty"):
        check_live_options(Options(token=""))
    with pytest.raises(LiveError, match="from 0 to 65535"):
        check_live_options(Options(port=70000))


def test_by_default_only_loopback_is_bound(sample: Project) -> None:
    async def work(server: Server, ready: Ready, session: LiveSession) -> None:
        hosts = {s.getsockname()[0] for each in server._servers for s in each.sockets}
        hosts.add(server._osc.transport.get_extra_info("sockname")[0])
        assert hosts <= {"127.0.0.1", "::1"} and "127.0.0.1" in hosts

    play(sample, work)


def test_a_port_that_is_taken_is_told(sample: Project) -> None:
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()

        async def work() -> None:
            with pytest.raises(LiveError, match=r"127\.0\.0\.1.*another port"):
                await Server(Options(port=other.getsockname()[1], osc=None), time.monotonic).open()

        asyncio.run(work())


# --- WebSocket


def test_requests_over_websocket_are_answered_in_order(sample: Project) -> None:
    async def work(server: Server, ready: Ready, session: LiveSession) -> None:
        async with connect(str(ready.websocket)) as line:
            assert (await say(line, {"do": "nod", "id": "n"}))["state"] in ("planned", "late")
            both = await say(line, [{"do": "blink", "id": "b"}, {"do": "dance", "id": "d"}])
            assert (
                both[0]["state"] == "planned"
                and "Invalid value 'dance'" in both[1]["error"]
                and both[1]["id"] == "d"
            )
            assert "not JSON" in (await say(line, "nonsense"))["error"]
            assert "not JSON" in (await say(line, b"\xff\xfe"))["error"]
            for n in range(200):
                await line.send(json.dumps({"do": "status", "id": str(n)}))
            assert [json.loads(await line.recv())["id"] for _ in range(200)] == [str(n) for n in range(200)]

    play(sample, work)


def test_messages_may_come_in_pieces(sample: Project) -> None:
    async def work(server: Server, ready: Ready, session: LiveSession) -> None:
        async with connect(str(ready.websocket)) as line:
            await line.send(['{"do":"st', 'atus","id"', ':"x"}'])
            assert json.loads(await line.recv())["id"] == "x"

    play(sample, work)


def test_messages_too_long_close_the_line_with_the_reason(sample: Project) -> None:
    async def work(server: Server, ready: Ready, session: LiveSession) -> None:
        async with connect(str(ready.websocket)) as line:
            await line.send("x" * 2_000_000)
            with pytest.raises(ConnectionClosed) as caught:
                await line.recv()
            assert caught.value.rcvd is not None and caught.value.rcvd.code == 1009

    play(sample, work)


def test_poses_are_streamed_as_json_and_as_packed_numbers(sample: Project) -> None:
    assert sample.skeleton is not None
    joints = len(sample.skeleton)

    async def work(server: Server, ready: Ready, session: LiveSession) -> None:
        async with connect(str(ready.websocket)) as line:
            hello = await say(
                line, {"do": "hello", "poses": {"rate": 60, "format": "binary", "space": "model"}}
            )
            assert hello["poses"]["joints"] == list(sample.skeleton.names)  # type: ignore[union-attr]
            data = await line.recv()
            assert isinstance(data, bytes)
            magic, flags, count, morphs, _, seconds = HEADER.unpack_from(data)
            assert (magic, flags, count, morphs) == (MAGIC, 3, joints, len(hello["poses"]["morphs"]))
            numbers = np.frombuffer(data, "<f4", offset=HEADER.size)
            assert len(numbers) == 3 + 4 * joints + 3 * joints + morphs
            rotations, positions = sample.skeleton.globals(pose_at(session.plan, sample, seconds))  # type: ignore[union-attr]
            np.testing.assert_allclose(numbers[3 : 3 + 4 * joints].reshape(-1, 4), rotations, atol=1e-5)
            np.testing.assert_allclose(
                numbers[3 + 4 * joints : 3 + 7 * joints].reshape(-1, 3), positions, atol=1e-5
            )
            await line.send(
                json.dumps(
                    {
                        "do": "hello",
                        "id": "again",
                        "poses": {"rate": 60, "joints": ["Head"], "translations": True},
                    }
                )
            )
            texts = [json.loads(x) for x in [await line.recv() for _ in range(12)] if isinstance(x, str)]
            frame = next(x for x in texts if "t" in x and "rotations" in x)
            assert (
                len(frame["rotations"]) == 1 and len(frame["translations"]) == 1 and len(frame["root"]) == 3
            )
            await line.send(json.dumps({"do": "hello", "id": "off", "poses": None}))
            while json.loads(await line.recv()).get("id") != "off":
                pass
            with pytest.raises(TimeoutError):
                await asyncio.wait_for(line.recv(), 0.2)

    play(sample, work)


@pytest.mark.nightly
def test_a_client_that_stops_reading_is_dropped_and_others_go_on(
    sample: Project, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(hubs, "BACKLOG", 200_000)
    monkeypatch.setattr(lines, "PART", 0.3)

    async def work(server: Server, ready: Ready, session: LiveSession) -> None:
        async with connect(str(ready.websocket)) as good:
            port = int(str(ready.websocket).rpartition(":")[2])
            bad = socket.create_connection(("127.0.0.1", port))
            bad.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            bad.setblocking(False)
            key = "GET / HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            await asyncio.get_running_loop().sock_sendall(
                bad,
                (
                    key + "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\nSec-WebSocket-Version: 13\r\n\r\n"
                ).encode(),
            )
            ask = b'{"do":"describe"}'
            frame = bytes([0x81, 0x80 | len(ask)]) + b"\0\0\0\0" + ask
            for _ in range(600):
                if len(server.hub.clients) == 1 and server.hub._count == 2:
                    break
                await asyncio.get_running_loop().sock_sendall(bad, frame)
                assert "state" in await say(good, {"do": "status"})
            assert len(server.hub.clients) == 1 and server.hub._count == 2
            assert (await say(good, {"do": "nod"}))["state"] in ("planned", "late")
            for _ in range(100):
                if server.connections == 1:
                    break
                await asyncio.sleep(0.02)
            assert server.connections == 1
            bad.close()

    play(sample, work)


def test_a_client_that_is_dropped_can_read_why(sample: Project) -> None:
    async def work(server: Server, ready: Ready, session: LiveSession) -> None:
        async with connect(str(ready.websocket)) as line:
            await say(line, {"do": "status"})
            server.hub.drop(1, hubs.POLICY, hubs.SLOW)
            with pytest.raises(ConnectionClosed) as caught:
                await line.recv()
            assert caught.value.rcvd is not None and (caught.value.rcvd.code, caught.value.rcvd.reason) == (
                1008,
                hubs.SLOW,
            )

    play(sample, work)


def test_who_never_says_a_word_is_cut_off(sample: Project, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(lines, "GREET", 0.2)

    async def work(server: Server, ready: Ready, session: LiveSession) -> None:
        host, port = "127.0.0.1", int(str(ready.websocket).rpartition(":")[2])
        reader, writer = await asyncio.open_connection(host, port)
        writer.write(b"GET / HT")
        assert await asyncio.wait_for(reader.read(), 5) == b""
        writer.close()
        reader, writer = await asyncio.open_connection(host, port)
        writer.write(b"\x16\x03\x01 not a web socket at all\r\n\r\n")
        await asyncio.wait_for(reader.read(), 5)
        writer.close()

    play(sample, work)


def test_the_end_is_said_to_clients(sample: Project) -> None:
    async def run() -> None:
        async with serving(sample) as (_, ready, _session):
            line = await connect(str(ready.websocket))
            await say(line, {"do": "status"})
        with pytest.raises(ConnectionClosed) as caught:
            await line.recv()
        assert caught.value.rcvd is not None and caught.value.rcvd.code == 1001

    asyncio.run(run())


# --- who may come in


@pytest.mark.parametrize(
    "origin", ["http://localhost", "http://localhost:3000", "https://127.0.0.1:8080", "http://[::1]:5"]
)
def test_pages_of_this_machine_may_connect(sample: Project, origin: str) -> None:
    async def work(server: Server, ready: Ready, session: LiveSession) -> None:
        async with connect(str(ready.websocket), origin=origin) as line:  # type: ignore[arg-type]
            assert (await say(line, {"do": "status"}))["state"] == "done"

    play(sample, work)


@pytest.mark.parametrize(
    "origin",
    [
        "https://example.org",
        "null",
        "http://localhost.example.org",
        "http://127.0.0.1.example.org",
        "file://",
        "http://localhost@example.org",
    ],
)
def test_other_web_pages_may_not(sample: Project, origin: str) -> None:
    async def work(server: Server, ready: Ready, session: LiveSession) -> None:
        with pytest.raises(InvalidStatus) as caught:
            await connect(str(ready.websocket), origin=origin)  # type: ignore[arg-type]
        assert caught.value.response.status_code == 403 and b"may not connect" in (
            caught.value.response.body or b""
        )
        assert not server.hub.clients

    play(sample, work)


def test_pages_that_are_named_or_know_the_token_may(sample: Project) -> None:
    async def work(server: Server, ready: Ready, session: LiveSession) -> None:
        async with connect(str(ready.websocket), origin="null") as line:  # type: ignore[arg-type]
            reply = await say(
                line, {"do": "hello", "token": "secret"} if server.hub.token else {"do": "status"}
            )
            assert reply["state"] == "done"

    play(sample, work, Options(port=0, osc=None, origins=("null",)))
    play(sample, work, Options(port=0, osc=None, token="secret"))


def test_a_name_that_was_bent_to_this_machine_is_turned_away(sample: Project) -> None:
    async def work(server: Server, ready: Ready, session: LiveSession) -> None:
        with pytest.raises(InvalidStatus) as caught:
            await connect(
                str(ready.websocket).replace("127.0.0.1", "example.org"),
                host="127.0.0.1",
                port=int(str(ready.websocket)[-5:].strip(":")),
            )
        assert caught.value.response.status_code == 403 and b"connect to localhost" in (
            caught.value.response.body or b""
        )

    play(sample, work)


@pytest.mark.nightly
def test_the_token_is_asked_for_in_the_header_or_in_hello(
    sample: Project, monkeypatch: pytest.MonkeyPatch
) -> None:
    async def work(server: Server, ready: Ready, session: LiveSession) -> None:
        address = str(ready.websocket)
        async with connect(address, additional_headers={"Authorization": "Bearer secret"}) as line:
            assert (await say(line, {"do": "status"}))["state"] == "done"
        async with connect(address) as line:
            assert (await say(line, {"do": "hello", "token": "secret"}))["state"] == "done"
            assert (await say(line, {"do": "nod"}))["state"] in ("planned", "late")
        with pytest.raises(InvalidStatus) as refused:
            await connect(address, additional_headers={"Authorization": "Bearer wrong"})
        assert refused.value.response.status_code == 401
        for first in ({"do": "hello", "token": "wrong"}, {"do": "hello"}, {"do": "nod"}, 7):
            async with connect(address) as line:
                assert "needs a token" in (await say(line, first))["error"]
                with pytest.raises(ConnectionClosed) as caught:
                    await line.recv()
                assert caught.value.rcvd is not None and caught.value.rcvd.code == 1008
        monkeypatch.setattr(hubs, "PROVE", 0.0)
        async with connect(address) as line:
            with pytest.raises(ConnectionClosed):
                await asyncio.wait_for(line.recv(), 5)
        assert not session.plan.requests or {r.id.partition("/")[2] for r in session.plan.requests} == {"#1"}

    play(sample, work, Options(port=0, osc=None, token="secret"))


# --- OSC


class Osc:
    """A program that speaks OSC."""

    def __init__(self, ready: Ready) -> None:
        assert ready.osc is not None
        self.line = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.line.connect(ready.osc)
        self.line.setblocking(False)

    def send(self, address: str, *values: str | float | int) -> None:
        tags = "," + "".join(
            "s" if isinstance(v, str) else "f" if isinstance(v, float) else "i" for v in values
        )
        parts = [
            pad_osc(v) if isinstance(v, str) else struct.pack(">f" if isinstance(v, float) else ">i", v)
            for v in values
        ]
        self.line.send(pad_osc(address) + pad_osc(tags) + b"".join(parts))

    async def receive(self) -> bytes:
        return await asyncio.wait_for(asyncio.get_running_loop().sock_recv(self.line, 65536), 5)

    async def reply(self) -> Any:
        data = await self.receive()
        assert data.startswith(pad_osc("/metagraph/reply") + pad_osc(",s"))
        return json.loads(data[len(pad_osc("/metagraph/reply")) + 4 :].rstrip(b"\0"))

    async def ask(self, address: str, *values: str | float | int) -> Any:
        self.send(address, *values)
        return await self.reply()


def test_requests_over_osc_are_planned_and_answered_to_who_wants_it(sample: Project) -> None:
    async def work(server: Server, ready: Ready, session: LiveSession) -> None:
        osc = Osc(ready)
        osc.send("/metagraph/nod")  # nobody wants to know
        await asyncio.sleep(0.2)
        osc.send("/metagraph/replies", 1)
        reply = await osc.ask("/metagraph/gesture", "arms", "positive", "priority=3", "id=g")
        assert reply["id"] == "g" and reply["state"] in ("planned", "late")
        assert (await osc.ask("/metagraph/stance", "on hips", "in=3"))["state"] in ("planned", "late")
        assert (await osc.ask("/metagraph/look", 0.1, 1.6, 2.0))["actions"] == ["look"]
        assert (await osc.ask("/metagraph/place", "user", 0, 1.5, 2.0))["actions"] == ["place"]
        assert (await osc.ask("/metagraph/text", "Hello", "there"))["actions"] == ["speech"]
        assert (await osc.ask("/metagraph/json", '[{"do":"blink"},{"do":"mode","mode":"idle"}]'))[1][
            "actions"
        ] == ["mode"]
        assert (await osc.ask("/metagraph/status"))["clients"] == 1

        assert "there is no address" in (await osc.ask("/metagraph/dance"))["error"]
        assert "needs a name" in (await osc.ask("/metagraph/action"))["error"]
        osc.line.send(b"nonsense")
        assert "not OSC" in (await osc.reply())["error"]
        assert any(r.id == "c1/g" and r.priority == 3 for r in session.plan.requests)
        osc.line.close()

    play(sample, work)


def test_poses_are_streamed_as_osc_bundles(sample: Project) -> None:
    from pythonosc.osc_packet import OscPacket

    async def work(server: Server, ready: Ready, session: LiveSession) -> None:
        osc = Osc(ready)
        osc.send("/metagraph/poses", 60.0, "Head", "Hips")
        messages = [m.message for m in OscPacket(await osc.receive()).messages]
        assert [m.address for m in messages[:4]] == [
            "/metagraph/pose",
            "/metagraph/root",
            "/metagraph/joint",
            "/metagraph/joint",
        ]
        assert messages[2].params[0] == "Head" and len(messages[2].params) == 5
        pose = pose_at(session.plan, sample, messages[0].params[0])
        head = list(sample.skeleton.names).index("Head")  # type: ignore[union-attr]
        np.testing.assert_allclose(messages[2].params[1:], pose.rotations[head], atol=1e-5)
        osc.send("/metagraph/poses", 0)
        await asyncio.sleep(0.1)
        osc.line.close()

    play(sample, work)


def test_osc_needs_the_token_where_there_is_one(sample: Project) -> None:
    async def work(server: Server, ready: Ready, session: LiveSession) -> None:
        osc = Osc(ready)
        osc.send("/metagraph/nod")
        osc.send("/metagraph/hello", "wrong")
        await asyncio.sleep(0.1)
        assert not server.hub.clients
        osc.send("/metagraph/hello", "secret")
        await asyncio.sleep(0.2)
        osc.send("/metagraph/replies", 1)
        assert (await osc.ask("/metagraph/nod"))["state"] in ("planned", "late")
        osc.line.close()

    play(sample, work, Options(port=None, osc=0, token="secret"))


# --- JSON lines


def piped(project: Project, data: bytes) -> list[Any]:
    """Play with lines on a pipe; return what was written until the end."""

    async def run() -> bytes:
        source, feed = os.pipe()
        drain, target = os.pipe()
        server = Server(Options(port=None, osc=None, stdio=True), time.monotonic, (source, target))
        session = LiveSession(project)
        await server.open()
        loop = asyncio.get_running_loop()
        got = bytearray()

        def read() -> None:
            while some := os.read(drain, 65536):
                got.extend(some)

        reading = loop.run_in_executor(None, read)
        writing = loop.run_in_executor(None, _write, feed, data)
        begin = time.monotonic()
        await asyncio.wait_for(
            server.run(lambda batch: exchange(session, time.monotonic() - begin, batch)), 20
        )
        await server.close()
        await writing
        os.close(target)
        await reading
        os.close(drain)
        os.close(source)
        return bytes(got)

    return [json.loads(line) for line in asyncio.run(run()).splitlines()]


def _write(feed: int, data: bytes) -> None:
    view = memoryview(data)
    while view:
        view = view[os.write(feed, view) :]
    os.close(feed)


def test_lines_are_answered_and_the_end_of_input_is_the_end(sample: Project) -> None:
    replies = piped(
        sample, b'{"do":"nod","id":"n"}\n\n  \r\nbad\n[{"do":"blink"},7]\n{"do":"status","id":"last"}'
    )
    assert (
        replies[0]["id"] == "n"
        and "not JSON" in replies[1]["error"]
        and len(replies[2]) == 2
        and replies[3]["id"] == "last"
    )
    assert len(replies) == 4


def test_no_input_at_all_is_the_end_too(sample: Project) -> None:
    assert piped(sample, b"") == []


def test_a_line_without_end_is_refused_and_the_next_is_heard(sample: Project) -> None:
    replies = piped(sample, b"x" * 5_000_000 + b'\n{"do":"status","id":"s"}\n')
    assert "at most" in replies[0]["error"] and replies[-1]["id"] == "s" and len(replies) == 2


def test_thousands_of_lines_wait_for_their_turn_and_are_all_answered(sample: Project) -> None:
    replies = piped(sample, b'{"do":"status"}\n' * 9000)
    assert len(replies) == 9000 and {r["state"] for r in replies} == {"done"}
