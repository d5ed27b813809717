"""How soon a character answers: python tests/benchmarks/bench_utterances.py [utterances] [floods]

An agent says `utterances` (1,000) things one after the other over WebSocket, in turn as text, as tokens, as
words with their times and as sound, and interrupts each after a moment, while 50 others (`floods`) send 20
requests a second each. Measured is the time from sending the first piece until the first frame is posed in
which the mouth has opened (by 1 % of a shape), and from sending `interrupt` until the first frame in which
the voice has stopped; frames are posed at 60 Hz, as a window would. The lines are in a child process
(`Relay`). Wall time, so that other programs on the machine count; then, on Linux, the same without the time
in which this process's thread was ready and other programs had the processors (`/proc/self/schedstat`). The
load is the mean number of processes that ran or waited in the last minute.
"""

from __future__ import annotations

import base64
import contextlib
import json
import multiprocessing
import os
import sys
import time
from bisect import bisect_right
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
Row = tuple[str, float, float, float]


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

    asks = [
        {"do": "look", "to": "user"},
        {"do": "nod"},
        {"do": "gesture", "layer": "head"},
        {"do": "status"},
        {"do": "place", "name": "user", "point": [0.1, 1.6, 2]},
        {"do": "withdraw", "what": "nothing"},
        {"do": "pause"},
        {"do": "interrupt"},
        {"do": "resume"},
    ]
    lines = [connect(f"ws://127.0.0.1:{port}") for _ in range(clients)]
    n = 0
    with contextlib.suppress(ConnectionClosed):  # the character is gone
        while time.time() < until:
            begin = time.perf_counter()
            for k, line in enumerate(lines):
                line.send(json.dumps(asks[(n + k) % len(asks)]))
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


def main(count: int, floods: int) -> None:
    """Run all of it, and print the table."""
    from metagraph.formats.store import open_project
    from metagraph.live.live_session import LiveSession
    from metagraph.live.relay import Relay
    from metagraph.live.server import Options
    from metagraph.playback.life.lips import compute_mouth_shapes

    project = open_project(SAMPLE).project
    session = LiveSession(project)
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
    opened: dict[str, float] = {}  # utterance -> when the first frame was posed in which the mouth was open
    closed: dict[str, float] = {}  # and in which its voice had stopped
    rows: list[tuple[str, str, float, float]] = []
    ticks: list[float] = []  # processor time of each
    frames: list[float] = []  # when each began
    waits = [0.0]  # for how long this thread had waited for a processor by then
    done, first, said = False, time.perf_counter(), time.process_time()
    while not done:
        start = time.perf_counter()
        frames.append(start)
        waits.append(read_waiting())
        busy = time.thread_time()
        relay.tick(session, start - begin)
        ticks.append(1e3 * (time.thread_time() - busy))
        now = time.perf_counter() - begin
        track = session.plan.track
        shapes = compute_mouth_shapes(track, project.voices, project.life.lip_smoothing, np.array([now]))
        session.pose(now)
        posed = time.perf_counter()
        for speech in track.speeches:
            name = speech.id.partition("/")[2]
            if speech.id.startswith("c") and name.startswith("u"):
                near = speech.start - 0.05 < now < speech.end + 0.2
                if near and shapes is not None and shapes.sum() > OPEN and now < speech.end:
                    opened.setdefault(name, posed)
                if speech.length is not None and now >= speech.end:
                    closed.setdefault(name, posed)
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
        f"{os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}"
    )
    print(
        f"processor: {show(ticks)} a tick; this process {(time.process_time() - said) / took:.0%} of a core"
    )
    print(
        f"waited for a processor {(waits[-1] - waits[1]) / took:.0%} of the time; "
        f"{len(frames) / took:.0f} frames a second"
    )

    def find_wait(since: float, until: float) -> float:
        """Return for how long this thread waited for a processor."""
        return waits[bisect_right(frames, until)] - waits[bisect_right(frames, since)]

    for what, times in (("first movement", opened), ("interrupted", closed)):
        for own in (False, True):
            for kind in (*KINDS, "all"):
                found = []
                for one, ident, asked, stopped in rows:
                    if ident in times and kind in (one, "all"):
                        since = asked if times is opened else stopped
                        over = find_wait(since, times[ident]) if own else 0.0
                        found.append(1e3 * (times[ident] - since - over))
                wanted = sum(kind in (row[0], "all") for row in rows)
                late = sum(x > 100 for x in found)
                named = f"{what}{', waits left out' if own else ''}"
                print(
                    f"  {named:33} {kind:7} {show(found)}; {late} of {len(found)} above 100 ms, "
                    f"{wanted - len(found)} not seen"
                )


if __name__ == "__main__":
    numbers = [int(word) for word in sys.argv[1:]]
    main(numbers[0] if numbers else 1000, numbers[1] if len(numbers) > 1 else 50)
