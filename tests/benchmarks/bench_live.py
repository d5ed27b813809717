"""The live session under load: python tests/benchmarks/bench_live.py [flood|soak|generate] [seconds]

flood: a client in a process of its own sends 10,000 requests a second over WebSocket, one to a message and
then a hundred to a message, while this process ticks at 60 Hz as a window would, planning and posing; the
lines are in a child process (`Relay`). Counted are replies; measured is how long a tick holds the window up.
Then the same in one process, as `metagraph live`. soak: an hour of session time, simulated, 100 requests a
second from three clients, valid and hostile; memory after 10 and after 60 minutes, and what a tick costs.
generate: ten minutes of session time with motion that a model of each kind (small, by chance) makes of sound,
25 pieces a second, and a gesture now and then, then without it: what a tick and a pose cost, and memory.
"""

from __future__ import annotations

import asyncio
import json
import multiprocessing
import os
import random
import socket
import sys
import time
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from metagraph.live.server import Options  # noqa: E402

SAMPLE = ROOT / "sample_clips" / "sample.metagraph.yaml"
RATE = 10_000  # requests a second
BURST = 0.01  # seconds between the client's bursts


# --- a client fast enough not to be what is measured


def handshake(port: int) -> socket.socket:
    from websockets.client import ClientProtocol
    from websockets.uri import parse_uri

    protocol = ClientProtocol(parse_uri(f"ws://127.0.0.1:{port}"))
    line = socket.create_connection(("127.0.0.1", port))
    line.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    protocol.send_request(protocol.connect())
    line.sendall(b"".join(protocol.data_to_send()))
    got = b""
    while b"\r\n\r\n" not in got:
        got += line.recv(4096)
    assert b" 101 " in got, got
    return line


def framed(data: bytes) -> bytes:
    """A masked text frame; the mask is zero, which leaves the bytes as they are."""
    size = len(data)
    head = bytes([0x81, 0x80 | size]) if size < 126 else bytes([0x81, 0xFE]) + size.to_bytes(2, "big")
    return head + b"\0\0\0\0" + data


def requests(listed: bool) -> tuple[list[bytes], int]:
    """Frames to send again and again, and how many requests each holds."""
    some = [
        {"do": "gesture", "tags": ["beat"]},
        {"do": "gesture", "layer": "body"},
        {"do": "nod"},
        {"do": "look", "to": "user"},
        {"do": "place", "name": "user", "point": [0.1, 1.6, 2]},
        {"do": "fidget"},
        {"do": "stance", "stance": "on hips"},
        {"do": "action", "action": "nobody_01"},
        {"do": "gesture", "in": 30, "id": "later"},
        {"do": "say", "text": "Well, well."},
    ]
    if listed:
        return [framed(json.dumps([some[n % len(some)] for n in range(100)]).encode())], 100
    return [framed(json.dumps(ask).encode()) for ask in some], 1


def client(port: int, listed: bool, seconds: float, result: Any) -> None:
    line = handshake(port)
    frames, each = requests(listed)
    line.setblocking(False)
    sent = replies = bad = 0
    waits: list[float] = []
    marks: dict[int, float] = {}
    inbox, outbox = bytearray(), bytearray()
    begin = time.perf_counter()
    bursts = 0
    while time.perf_counter() - begin < seconds + 5 and (
        replies < sent or time.perf_counter() - begin < seconds
    ):
        now = time.perf_counter() - begin
        while bursts * BURST <= now and bursts * BURST < seconds:
            bursts += 1
            marks[sent] = time.perf_counter()
            for n in range(int(RATE * BURST / each)):
                outbox += frames[n % len(frames)]
                sent += each
        try:
            if outbox:
                del outbox[: line.send(outbox)]
        except BlockingIOError:
            pass
        try:
            inbox += line.recv(1 << 20)
        except BlockingIOError:
            time.sleep(0.001)
        place = 0
        while len(inbox) - place >= 2:
            size, head = inbox[place + 1], 2
            if size == 126:
                size, head = int.from_bytes(inbox[place + 2 : place + 4], "big"), 4
            elif size == 127:
                size, head = int.from_bytes(inbox[place + 2 : place + 10], "big"), 10
            if len(inbox) - place < head + size:
                break
            opcode, body = inbox[place] & 15, inbox[place + head : place + head + size]
            if opcode == 8:
                raise SystemExit(f"closed: {bytes(body)!r}")
            if replies in marks:
                waits.append(time.perf_counter() - marks.pop(replies))
            replies += each
            bad += b'"error"' in body
            place += head + size
        del inbox[:place]
    took = time.perf_counter() - begin
    result.send((sent, replies, bad, took, sorted(waits)))
    line.close()


def report(words: str, got: Any, ticks: list[float]) -> None:
    sent, replies, bad, took, waits = got
    ticks = sorted(x * 1e3 for x in ticks)
    print(f"{words}\n  sent {sent}, replies {replies}, errors {bad}, {sent / took:.0f} a second")
    for what, times in (("reply after", [w * 1e3 for w in waits]), ("tick", ticks)):
        middle, most = times[len(times) // 2], times[int(0.95 * len(times))]
        print(f"  {what:12} median {middle:7.2f}  95 % {most:7.2f}  most {times[-1]:7.2f} ms", flush=True)


def spawn(port: int, listed: bool, seconds: float) -> tuple[Any, Any]:
    context = multiprocessing.get_context("spawn")
    ours, theirs = context.Pipe()
    process = context.Process(target=client, args=(port, listed, seconds, theirs))
    process.start()
    return process, ours


def flood(seconds: float) -> None:
    from metagraph.formats.store import open_project
    from metagraph.live.live_session import LiveSession
    from metagraph.live.relay import Relay
    from metagraph.live.server import Server
    from metagraph.live.wire import BatchResult, RequestBatch, exchange
    from tests.posing import pose_at

    project = open_project(SAMPLE).project
    print(f"{os.cpu_count()} cores; {RATE} requests a second for {seconds:g} s\n")
    for listed in (False, True):
        session = LiveSession(project)
        session.warm()
        relay = Relay(Options(port=0, osc=None))
        relay.start()
        begin = time.perf_counter()
        ticks: list[float] = []
        process = ours = None
        while ours is None or not ours.poll():
            start = time.perf_counter()
            relay.tick(session, start - begin)
            ticks.append(time.perf_counter() - start)
            pose_at(session.plan, project, start - begin)
            if relay.ready is not None and process is None:
                assert not relay.error, relay.error
                process, ours = spawn(int(str(relay.ready.websocket).rpartition(":")[2]), listed, seconds)
                ticks.clear()
            time.sleep(max(0.0, 1 / 60 - (time.perf_counter() - start)))
        report(f"relay, {'a hundred to a message' if listed else 'one to a message'}", ours.recv(), ticks)
        assert process is not None
        process.join()
        relay.close(wait=True)
    for listed in (False, True):
        session = LiveSession(project)
        session.warm()
        ticks = []

        async def play(listed: bool = listed, session: Any = session, ticks: list[float] = ticks) -> None:
            server = Server(Options(port=0, osc=None), time.monotonic)
            ready = await server.open()
            process, ours = spawn(int(str(ready.websocket).rpartition(":")[2]), listed, seconds)
            begin = time.monotonic()

            def step(batch: RequestBatch | None) -> BatchResult:
                start = time.perf_counter()
                out = exchange(session, time.monotonic() - begin, batch)
                ticks.append(time.perf_counter() - start)
                if ours.poll():
                    server.stopped.set()
                return out

            await server.run(step)
            await server.close()
            report(
                f"one process, {'a hundred to a message' if listed else 'one to a message'}",
                ours.recv(),
                ticks,
            )
            process.join()

        asyncio.run(play())


def resident() -> float:
    """Megabytes of memory this process has."""
    try:
        pages = int(Path("/proc/self/statm").read_text().split()[1])
    except OSError:
        return float("nan")
    return pages * os.sysconf("SC_PAGE_SIZE") / 2**20


def soak(seconds: float, rate: int = 100) -> None:
    from metagraph.formats.store import open_project
    from metagraph.live.live_session import LiveSession
    from metagraph.live.messages import Reply, encode
    from tests.live.traffic import mixed

    session = LiveSession(open_project(SAMPLE).project)
    session.warm()
    r = random.Random(1)
    for number in (1, 2, 3):
        session.receive(number, json.dumps({"do": "hello", "events": number == 1, "poses": {"rate": 1}}))
    asked = answered = events = 0
    ticks: list[float] = []
    states: dict[str, int] = {}
    begin = time.perf_counter()
    shown = 60.0
    print(
        f"{rate} requests a second\n minute    asked answered  events   memory    tape   tick   95 %   most  "
        "ms of processor time"
    )
    for n in range(1, int(seconds * 60) + 1):
        now = n / 60
        for _ in range(int(now * rate) - int((n - 1) / 60 * rate)):
            message = mixed(r)
            asked += 1
            session.receive(r.randint(1, 3), message)
        start = time.process_time()
        out = session.tick(now)
        ticks.append((time.process_time() - start) * 1e3)
        for reply in out.replies:
            state = "own" if isinstance(reply, bytes) else "error" if reply.error else str(reply.state)
            states[state] = states.get(state, 0) + 1
            assert isinstance(reply, bytes) or reply.error or reply.state, reply
            assert encode(reply) if isinstance(reply, Reply) else reply
        answered += len(out.replies)
        events += len(out.events)
        if now >= shown or n == int(seconds * 60):
            shown += 600.0 if now >= 600.0 else 540.0
            some = sorted(ticks)
            print(
                f"{now / 60:7.0f} {asked:8d} {answered:8d} {events:7d} {resident():6.0f} MB "
                f"{len(session.tape) / 2**20:4.1f} MB"
                f" {some[len(some) // 2]:6.2f} {some[int(0.95 * len(some))]:6.2f} {some[-1]:6.1f}",
                flush=True,
            )
            ticks.clear()
    print(f"took {time.perf_counter() - begin:.0f} s; replies: {states}")


def generate(seconds: float) -> None:
    import base64
    import tempfile

    import numpy as np

    from metagraph.formats.store import open_project
    from metagraph.generation.networks import Kind, make_sizes
    from metagraph.generation.stored import write_model
    from metagraph.live.live_session import LiveSession
    from tests.generation.makers import babble, rig, untrained

    voice = np.clip(babble(60.0) * 32768, -32768, 32767).astype("<i2")
    pieces = [
        base64.b64encode(voice[n : n + 640].tobytes()).decode() for n in range(0, len(voice) - 640, 640)
    ]
    kinds: tuple[Kind | None, ...] = ("flow-vae", "cvae", "matching", None)
    print("ms of processor time, what the model takes, then tick and pose: median, 95 %, 99 %, most")
    with tempfile.TemporaryDirectory() as scratch:
        for kind in kinds:
            path = Path(scratch) / f"{kind}.mgmodel"
            if kind is not None:
                write_model(untrained(kind, sizes=make_sizes(kind, pose=rig().numbers)), path)
            session = LiveSession(open_project(SAMPLE).project, models={str(kind): path})
            session.warm()
            session.receive(1, json.dumps({"do": "generate", "model": kind}))
            ticks: list[float] = []
            own: list[float] = []
            reach = session.generating.reach

            def timed(*arguments: Any, reach: Any = reach, own: list[float] = own) -> None:
                start = time.process_time()
                reach(*arguments)
                own.append((time.process_time() - start) * 1e3)

            session.generating.reach = timed  # type: ignore[method-assign]
            heard, shown = 0, 60.0
            for n in range(1, int(seconds * 60) + 1):
                now = n / 60
                while heard < now * 25:
                    session.receive(1, json.dumps({"do": "hear", "audio": pieces[heard % len(pieces)]}))
                    heard += 1
                if n % 900 == 0:
                    session.receive(1, json.dumps({"do": "gesture"}))
                start = time.process_time()
                session.tick(now)
                session.pose(now)
                ticks.append((time.process_time() - start) * 1e3)
                if now >= shown or n == int(seconds * 60):
                    shown += max(60.0, seconds - 60.0)
                    told = ""
                    for some in (sorted(own[60:]), sorted(ticks[60:])):
                        at = (some[int(q * (len(some) - 1))] for q in (0.5, 0.95, 0.99, 1.0))
                        told += "".join(f"{x:8.2f}" for x in at) + "  "
                    print(
                        f"{kind or 'none':10s} {now / 60:6.1f}            {told}   {resident():5.0f} MB",
                        flush=True,
                    )
                    ticks.clear()
                    own.clear()


if __name__ == "__main__":
    what = sys.argv[1] if len(sys.argv) > 1 else "flood"
    length = float(sys.argv[2]) if len(sys.argv) > 2 else 0.0
    if what == "flood":
        flood(length or 10.0)
    elif what == "soak":
        soak(length or 3600.0)
    elif what == "generate":
        generate(length or 600.0)
