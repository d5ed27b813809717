"""How long a kept session takes to perform again: python tests/benchmarks/bench_replay.py

Requests of four sorts, one every four seconds of sessions of ever greater length; seconds of processor
time, the median of three. It should grow with the length and not with its square.
"""

from __future__ import annotations

import statistics
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from metagraph.formats.store import open_project  # noqa: E402
from metagraph.graph import requests as a  # noqa: E402
from metagraph.playback.planning.running_plan import plan_performance  # noqa: E402

EVERY = 4.0  # seconds between two requests


def session(count: int) -> list[a.AnyRequest]:
    """Return requests as they came in."""
    out: list[a.AnyRequest] = []
    for n in range(count):
        told = round(n * EVERY, 3)
        out.append(
            (
                a.Gesture(id=f"r{n}", at=told + 0.5, told=told),
                a.Nod(id=f"r{n}", at=told + 0.4, told=told),
                a.Look(id=f"r{n}", to="user", at=told + 0.2, told=told),
                a.Gesture(id=f"r{n}", tags=("positive",), at=told + 1.0, told=told),
            )[n % 4]
        )
    return out


def main() -> None:
    project = open_project(ROOT / "sample_clips" / "sample.metagraph.yaml").project
    for count in (100, 225, 450, 900, 1800):
        asks, times = session(count), []
        for _ in range(3):
            begun = time.process_time()
            plan_performance(project, asks, count * EVERY + 8.0)
            times.append(time.process_time() - begun)
        print(f"{count:5} requests in {count * EVERY / 60:5.1f} min   {statistics.median(times):6.2f} s")


if __name__ == "__main__":
    main()
