"""A live session for hours of real time: python tests/reliability/live_hours.py [--hours 2] [--flood 20]

`metagraph live` runs as programs start it. Three honest clients ask once a second over WebSocket, one of them
is sent poses 10 times a second; every ten minutes another one floods it with junk and bursts for some
seconds, and 50 lines say nothing. Every ten minutes: what the process holds, how long replies took, and what
was not answered.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import random
import socket
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from tests.live.traffic import mixed, valid  # noqa: E402
from tests.processes import started  # noqa: E402

SAMPLE = ROOT / "sample_clips" / "sample.metagraph.yaml"
PATIENCE = 5.0  # seconds for a reply, after which it counts as none
EVERY = 600.0  # seconds between two floods, and between two lines that are printed


class Honest(threading.Thread):
    """A client that asks once a second. waits: seconds until replies came. unanswered: asks."""

    def __init__(self, address: str, number: int, poses: bool) -> None:
        super().__init__(daemon=True)
        self.address, self.number, self.poses = address, number, poses
        self.waits: list[float] = []
        self.unanswered = 0
        self.over = threading.Event()

    def run(self) -> None:
        from websockets.sync.client import connect

        chance = random.Random(self.number)
        with connect(self.address, max_size=None) as line:
            if self.poses:
                line.send(json.dumps({"do": "hello", "poses": {"rate": 10}}))
            count = 0
            while not self.over.wait(1.0):
                count += 1
                ask = valid(chance) | {"id": f"{self.number}-{count}"}
                begin = time.monotonic()
                line.send(json.dumps(ask))
                self.waits.append(self._answered(line, ask["id"], begin))

    def _answered(self, line: Any, ident: str, begin: float) -> float:
        while (left := begin + PATIENCE - time.monotonic()) > 0:
            with contextlib.suppress(TimeoutError):
                message = line.recv(timeout=left)
                if isinstance(message, str) and json.loads(message).get("id") == ident:
                    return time.monotonic() - begin
        self.unanswered += 1
        return PATIENCE


def flood(address: str, seconds: float, chance: random.Random) -> int:
    """Send as much as the line takes; return how many messages it took."""
    from websockets.exceptions import ConnectionClosed
    from websockets.sync.client import connect

    count, end = 0, time.monotonic() + seconds
    with contextlib.suppress(ConnectionClosed), connect(address, max_size=None) as line:
        threading.Thread(target=lambda: [None for _ in line], daemon=True).start()
        while time.monotonic() < end:
            line.send(mixed(chance))
            count += 1
    return count


def silent(address: str, count: int) -> list[socket.socket]:
    """Open lines that say nothing."""
    host, _, port = address.removeprefix("ws://").rstrip("/").partition(":")
    return [socket.create_connection((host, int(port))) for _ in range(count)]


def held(process: subprocess.Popen[str]) -> float:
    """Return the MB of memory a process holds; nan where the system does not tell."""
    with contextlib.suppress(OSError):
        pages = int(Path(f"/proc/{process.pid}/statm").read_text().split()[1])
        return pages * os.sysconf("SC_PAGE_SIZE") / 2**20
    return float("nan")


def main(hours: float, flooded: float) -> int:
    """Play; return how many asks of the honest were not answered."""
    words = [sys.executable, "-m", "app.cli", "live", SAMPLE, "--json", "--port", 0, "--no-osc", "--no-stdin"]
    seconds = 3600 * hours
    with started(*words, longest=seconds + 120, stdout=subprocess.PIPE) as process:
        assert process.stdout is not None
        address = json.loads(process.stdout.readline())["websocket"]
        clients = [Honest(address, n, n == 0) for n in range(3)]
        for client in clients:
            client.start()
        begin, chance, lost = time.monotonic(), random.Random(9), 0
        lines = silent(address, 50)
        print("minutes  MB held  asks  median ms  95 % ms  most ms  unanswered  flood", flush=True)
        while (past := time.monotonic() - begin) < seconds:
            time.sleep(max(0.0, min(EVERY, seconds - past) - flooded))
            taken = flood(address, flooded, chance)
            waits = sorted(w for client in clients for w in client.waits)
            for client in clients:
                client.waits = []
            ms = [1e3 * waits[int(part * (len(waits) - 1))] for part in (0.5, 0.95, 1.0)] if waits else []
            lost = sum(client.unanswered for client in clients)
            told = "  ".join(f"{x:7.1f}" for x in ms)
            minutes = (time.monotonic() - begin) / 60
            print(
                f"{minutes:7.1f}  {held(process):7.1f}  {len(waits):4d}  {told}  {lost:10d}  {taken:6,d}",
                flush=True,
            )
            lost += not waits
        for client in clients:
            client.over.set()
        for client in clients:
            client.join(10.0)
        for line in lines:
            line.close()
        alive = process.poll() is None
        lost += sum(c.is_alive() for c in clients)
    print(f"{'it still ran' if alive else 'IT HAD ENDED'}; {lost} asks of the honest were not answered")
    return lost + (not alive)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--hours", type=float, default=2.0)
    parser.add_argument("--flood", type=float, default=20.0, help="seconds, every ten minutes")
    options = parser.parse_args()
    sys.exit(bool(main(options.hours, options.flood)))
