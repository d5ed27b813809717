"""A live session for a day, as fast as it goes: python tests/benchmarks/soak_live.py [hours] [ticks a second]

Three honest clients ask once a second and one sends junk and a burst now and then, in simulated time. Every
hour: what the process holds, what of that is the tape of what was asked, what a tick costs, and whether every
request was answered.
"""

from __future__ import annotations

import contextlib
import gc
import json
import random
import sys
import time
import tracemalloc
from collections.abc import Iterator
from pathlib import Path

with contextlib.suppress(ImportError):  # Windows has none
    import resource

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from metagraph.formats.store import open_project  # noqa: E402
from metagraph.live.hub import Hub  # noqa: E402
from metagraph.live.live_session import LiveSession  # noqa: E402
from metagraph.live.wire import exchange  # noqa: E402
from tests.live.traffic import mixed, valid  # noqa: E402


class Counted:
    """A line that counts what it is sent."""

    formats = ("json", "binary")

    def __init__(self) -> None:
        self.replies = 0

    def send(self, messages: list[tuple[bytes, bool]]) -> None:
        self.replies += sum(not binary for _, binary in messages)

    def answered(self, messages: int) -> None:
        pass

    def backlog(self) -> int:
        return 0

    def close(self, code: int, reason: str) -> None:
        raise RuntimeError(f"hung up on: {reason}")


def held() -> float:
    """Return the bytes this process holds now; nan where the system does not tell."""
    try:
        return float(Path("/proc/self/statm").read_text().split()[1]) * resource.getpagesize()
    except (OSError, NameError):
        return float("nan")


def soak(
    hours: float, rate: int = 20, every: float = 3600.0, history: float = 600.0, traced: bool = False
) -> Iterator[dict[str, float]]:
    """Play for `hours` of session time; yield what there is to say of each `every` seconds of it. memory:
    bytes of the process, or that Python holds where it is `traced`, which takes ten times as long; tape: of
    these, what was asked; p50, p99: milliseconds of a tick; unanswered: messages.
    """
    project = open_project(ROOT / "sample_clips" / "sample.metagraph.yaml").project
    session, hub, chance = LiveSession(project, seed=1, history=history), Hub(), random.Random(1)
    lines = [Counted() for _ in range(4)]
    numbers = [hub.open(line, 0.0) for line in lines]
    sent = [0] * len(lines)
    costs: list[float] = []
    if traced:
        tracemalloc.start()
    for tick in range(1, round(hours * 3600 * rate) + 1):
        for n, number in enumerate(numbers[:3]):
            if tick % rate == n * rate // 3:
                hub.message(number, json.dumps(valid(chance)))
                sent[n] += 1
        if tick % (7 * rate) == 0:
            for _ in range(30):
                hub.message(numbers[3], mixed(chance))
                sent[3] += 1
        begin = time.perf_counter()
        hub.give(exchange(session, tick / rate, hub.take()))
        costs.append(1e3 * (time.perf_counter() - begin))
        if tick % round(every * rate) == 0:
            gc.collect()
            costs.sort()
            yield {
                "hour": tick / rate / 3600,
                "memory": tracemalloc.get_traced_memory()[0] if traced else held(),
                "tape": len(session.tape),
                "past": len(session._past),
                "known": len(session.ledger.known),
                "p50": costs[len(costs) // 2],
                "p99": costs[int(len(costs) * 0.99)],
                "unanswered": sum(sent) - sum(line.replies for line in lines),
            }
            costs.clear()
    tracemalloc.stop()


if __name__ == "__main__":
    for row in soak(*(float(x) for x in sys.argv[1:2] or ["24"]), *(int(x) for x in sys.argv[2:3])):
        print(" ".join(f"{name} {value:.3f}" for name, value in row.items()), flush=True)
