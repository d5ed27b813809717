"""How soon a character answers: python tests/benchmarks/bench_utterances.py [processor] [utterances] [floods]

An agent says `utterances` (1,000) things one after the other over WebSocket, in turn as text, as tokens, as
words with their times and as sound, and interrupts each after a moment, while 50 others (`floods`) send 20
requests a second each, all at the same moment. Measured is the time from sending the first piece until the
first frame is posed in which the mouth has opened (by 1 % of a shape), and from sending `interrupt` until the
first frame in which the voice has stopped; frames are posed at 60 Hz, as a window would. The lines are in a
child process (`Relay`). Wall time, so that other programs on the machine count. The load is the mean number
of processes that ran or waited in the last minute; on Linux it tells for how long this process's thread was
ready while others had the processors (`/proc/self/schedstat`).

processor: the same without sockets, in a time of its own, which goes on by the processor time that all of it
takes (reading the messages, planning, posing) and waits for the next frame otherwise: what a computer shows
that has a processor for it. Only what sockets and the change of processes take is not in it.
"""

from __future__ import annotations

import base64
import contextlib
import json
import multiprocessing
import os
import random
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

SAMPLE = ROOT / "sample_clips" / "sample.metagraph.yaml"
FRAME = 1 / 60  # seconds
OPEN = 0.01  # of a shape: a mouth that moves
SPEAKS = 0.35  # seconds until an utterance is interrupted
RESTS = 0.15  # seconds between two
KINDS = ("text", "tokens", "words", "sound")
Row = tuple[str, str, float, float]  # kind, id, when it was asked for and interrupted
FLOODED: tuple[dict[str, Any], ...] = (
    {"do": "look", "to": "user"},
    {"do": "nod"},
    {"do": "gesture", "layer": "head"},
    {"do": "status"},
    {"do": "place", "name": "user", "point": [0.1, 1.6, 2]},
    {"do": "withdraw", "what": "nothing"},
    {"do": "pause"},
    {"do": "interrupt"},
    {"do": "resume"},
)


def first_piece(kind: str, ident: str) -> dict[str, Any]:
    """Return the first piece of an utterance."""
    if kind == "text":
        return {"do": "say", "id": ident, "text": "A moment ago it rained, so take a coat with you."}
    if kind == "tokens":
        return {"do": "say", "id": ident, "text": "A", "more": True}
    if kind == "words":
        return {"do": "say", "id": ident, "words": [["A", 0.0, 0.2], ["moment", 0.2, 0.8], ["ago", 0.8, 1.3]]}
    times = np.arange(1600) / 16000
    wave = sum(np.sin(2 * np.pi * f * times) / n for n, f in enumerate((150, 300, 750, 900), 1))
    sound = np.clip(wave * 8000, -32768, 32767).astype("<i2")
    return {"do": "say", "id": ident, "audio": base64.b64encode(sound.tobytes()).decode(), "more": True}


def talk(port: int, count: int, result: Any) -> None:
    """Say and interrupt one utterance after the other; tell when each was asked for."""
    from websockets.sync.client import connect

    with connect(f"ws://127.0.0.1:{port}") as line:

        def ask(request: dict[str, Any]) -> dict[str, Any]:
            line.send(json.dumps(request))
            return dict(json.loads(line.recv(timeout=30)))

        ask({"do": "hello", "name": "talker"})
        for n in range(count):
            kind, ident = KINDS[n % len(KINDS)], f"u{n}"
            asked = time.perf_counter()
            told = ask(first_piece(kind, ident))
            if told.get("state") != "planned":
                print("refused", told, flush=True)
            if kind == "tokens":
                ask({"do": "say", "id": ident, "text": " moment ago it rained.", "more": True})
            ask({"do": "gesture", "id": f"{ident}/0"})
            time.sleep(max(0.0, SPEAKS - (time.perf_counter() - asked)))
            stopped = time.perf_counter()
            told = ask({"do": "interrupt", "what": ident})
            if told.get("state") != "done":
                print("refused", told, flush=True)
            result.send((kind, ident, asked, stopped))
            time.sleep(RESTS)
    result.send(None)


def read_waiting() -> float:
    """Return for how many seconds this thread was ready and had no processor; 0 where the system does not
    tell.
    """
    try:
        return int(Path("/proc/self/schedstat").read_text().split()[1]) * 1e-9
    except OSError:
        return 0.0


def flood(port: int, clients: int, until: float, sent: Any) -> None:
    """Send requests with many clients, each as fast as it is answered, 20 a second at most; count them."""
    from websockets.exceptions import ConnectionClosed
    from websockets.sync.client import connect

    lines = [connect(f"ws://127.0.0.1:{port}") for _ in range(clients)]
    n = 0
    with contextlib.suppress(ConnectionClosed):  # the character is gone
        while time.time() < until:
            begin = time.perf_counter()
            for k, line in enumerate(lines):
                line.send(json.dumps(FLOODED[(n + k) % len(FLOODED)]))
            for line in lines:
                line.recv(timeout=60)
            sent.value += clients
            n += 1
            time.sleep(max(0.0, 0.05 - (time.perf_counter() - begin)))


def show(found: Sequence[float]) -> str:
    """Return what half, 95 %, 99 % and all of some times are within."""
    some = sorted(found) or [float("nan")]
    at = [some[int(share * (len(some) - 1))] for share in (0.5, 0.95, 0.99, 1.0)]
    return f"median {at[0]:5.1f}  95 % {at[1]:5.1f}  99 % {at[2]:5.1f}  most {at[3]:5.1f} ms"


class Seen:
    """When the first frame was posed in which an utterance's mouth was open, and in which it had stopped."""

    def __init__(self) -> None:
        self.opened: dict[str, float] = {}
        self.closed: dict[str, float] = {}

    def pose(self, session: Any, now: float) -> tuple[Any, float]:
        """Pose a frame; return how far the mouth is open."""
        from metagraph.playback.life.lips import compute_mouth_shapes

        project, track = session.project, session.plan.track
        shapes = compute_mouth_shapes(track, project.voices, project.life.lip_smoothing, np.array([now]))
        session.pose(now)
        return track, 0.0 if shapes is None else float(shapes.sum())

    def note(self, track: Any, mouth: float, now: float, posed: float) -> None:
        """Note what a frame shows of the session's time `now`."""
        for speech in track.speeches:
            name = speech.id.partition("/")[2]
            if speech.id.startswith("c") and name.startswith("u"):
                near = speech.start - 0.05 < now < speech.end + 0.2
                if near and mouth > OPEN and now < speech.end:
                    self.opened.setdefault(name, posed)
                if speech.length is not None and now >= speech.end:
                    self.closed.setdefault(name, posed)

    def report(self, rows: Sequence[Row]) -> None:
        """Print the table."""
        for what, times in (("first movement", self.opened), ("interrupted", self.closed)):
            for kind in (*KINDS, "all"):
                some = [row for row in rows if kind in (row[0], "all")]
                found = [
                    1e3 * (times[ident] - (asked if times is self.opened else stopped))
                    for _, ident, asked, stopped in some
                    if ident in times
                ]
                late = sum(x > 100 for x in found)
                words = f"{late} of {len(found)} above 100 ms, {len(some) - len(found)} not seen"
                print(f"  {what:15} {kind:7} {show(found)}; {words}")


def main(count: int, floods: int) -> None:
    """Run all of it, and print the table."""
    from metagraph.formats.store import open_project
    from metagraph.live.live_session import LiveSession
    from metagraph.live.relay import Relay
    from metagraph.live.server import Options

    session = LiveSession(open_project(SAMPLE).project)
    session.warm()
    relay = Relay(Options(port=0, osc=None))
    relay.start()
    context = multiprocessing.get_context("spawn")
    ours, theirs = context.Pipe()
    begin = time.perf_counter()
    while relay.ready is None:
        relay.tick(session, time.perf_counter() - begin)
        time.sleep(FRAME)
    port = int(str(relay.ready.websocket).rpartition(":")[2])
    length = count * (SPEAKS + RESTS + 0.1) + 30
    sent = context.Value("i", 0)
    others = context.Process(target=flood, args=(port, floods, time.time() + length, sent), daemon=True)
    agent = context.Process(target=talk, args=(port, count, theirs), daemon=True)
    if floods:
        others.start()
    agent.start()
    seen, rows = Seen(), list[Row]()
    ticks: list[float] = []  # processor time of each
    done, first, said, waited = False, time.perf_counter(), time.process_time(), read_waiting()
    while not done:
        start = time.perf_counter()
        busy = time.thread_time()
        relay.tick(session, start - begin)
        ticks.append(1e3 * (time.thread_time() - busy))
        now = time.perf_counter() - begin
        seen.note(*seen.pose(session, now), now, time.perf_counter())
        while ours.poll():
            row = ours.recv()
            done = row is None
            if row is not None:
                rows.append(row)
        time.sleep(max(0.0, FRAME - (time.perf_counter() - start)))
    relay.close(wait=True)
    took = time.perf_counter() - first
    print(
        f"{len(rows)} utterances; {floods} others, {sent.value / took:.0f} requests a second; "
        f"{os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}\nprocessor: {show(ticks)} a tick; this "
        f"process {(time.process_time() - said) / took:.0%} of a core; it waited for one "
        f"{(read_waiting() - waited) / took:.0%} of the time; {len(ticks) / took:.0f} frames a second"
    )
    seen.report(rows)


class SilentLine:
    """A line to nobody."""

    formats = ("json",)

    def send(self, messages: Any) -> None: ...

    def answered(self, messages: int) -> None: ...

    def backlog(self) -> int:
        return 0

    def close(self, code: int, reason: str) -> None: ...


def list_messages(count: int, floods: int) -> tuple[list[tuple[float, int, str]], list[Row]]:
    """Return what clients send (seconds, which client, text) and the agent's utterances."""
    r = random.Random(1)
    sent: list[tuple[float, int, str]] = []
    rows: list[Row] = []
    at = 1.0
    for n in range(count):
        kind, ident = KINDS[n % len(KINDS)], f"u{n}"
        at += RESTS + r.random() * 2 * FRAME
        stop = at + SPEAKS + r.random() * 2 * FRAME
        pieces = [first_piece(kind, ident)]
        if kind == "tokens":
            pieces.append({"do": "say", "id": ident, "text": " moment ago it rained.", "more": True})
        pieces.append({"do": "gesture", "id": f"{ident}/0"})
        sent += [(at + 2 * FRAME * k, 0, json.dumps(piece)) for k, piece in enumerate(pieces)]
        sent.append((stop, 0, json.dumps({"do": "interrupt", "what": ident})))
        rows.append((kind, ident, at, stop))
        at = stop
    for n in range(round((at + 1.0) * 20)):
        sent += [(n / 20, k, json.dumps(FLOODED[(n + k) % len(FLOODED)])) for k in range(1, floods + 1)]
    return sorted(sent), rows


def measure_processor(count: int, floods: int) -> None:
    """Run all of it in a time that goes on by the processor time it takes."""
    from metagraph.formats.store import open_project
    from metagraph.live.hub import Hub
    from metagraph.live.live_session import LiveSession
    from metagraph.live.wire import exchange, join_batches, pack, unpack_batch

    session, hub = LiveSession(open_project(SAMPLE).project), Hub()
    session.warm()
    numbers = [hub.open(SilentLine(), 0.0) for _ in range(floods + 1)]
    sent, rows = list_messages(count, floods)
    seen, ticks, clock, place = Seen(), list[float](), 0.0, 0
    while place < len(sent) or clock < rows[-1][3] + 0.5:
        start = clock = max(clock, (int(clock / FRAME) + 1) * FRAME)
        busy = time.process_time()
        while place < len(sent) and sent[place][0] <= start:
            hub.message(numbers[sent[place][1]], sent[place][2])
            place += 1
        batch = hub.take()
        batches = [] if batch is None else [unpack_batch(pack(batch))]
        hub.give(exchange(session, start, join_batches(batches)))
        now = start + time.process_time() - busy
        ticks.append(1e3 * (now - start))
        frame = seen.pose(session, now)
        clock = start + time.process_time() - busy
        seen.note(*frame, now, clock)
    print(
        f"{len(rows)} utterances; {floods} others, {len(sent) / clock:.0f} requests a second; by processor "
        f"time\n  {show(ticks)} a tick; {len(ticks) / clock:.0f} frames a second"
    )
    seen.report(rows)


if __name__ == "__main__":
    words = sys.argv[1:]
    numbers = [int(word) for word in words if word != "processor"]
    run = measure_processor if "processor" in words else main
    run(numbers[0] if numbers else 1000, numbers[1] if len(numbers) > 1 else 50)
