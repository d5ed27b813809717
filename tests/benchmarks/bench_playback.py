"""Planning and posing: python tests/benchmarks/bench_playback.py

Plan of one hour; one pose of one character; what the life layers add to a frame. Medians on the sample
project.
"""

from __future__ import annotations

import os
import statistics
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from metagraph.formats.store import open_project  # noqa: E402
from metagraph.graph import edits  # noqa: E402
from metagraph.graph.model import LAYERS, Project  # noqa: E402
from metagraph.playback.life.schedule import Schedule, schedule  # noqa: E402
from metagraph.playback.life.track import LookAt, Speech, track_of  # noqa: E402
from metagraph.playback.plan import Plan  # noqa: E402
from metagraph.playback.planner import extend_plan, make_plan  # noqa: E402
from tests.posing import pose_at  # noqa: E402


def clock(work: Callable[[], object]) -> float:
    """Milliseconds."""
    start = time.perf_counter()
    work()
    return (time.perf_counter() - start) * 1e3


def row(words: str, values: list[float], note: str = "") -> None:
    print(f"  {words:46} {statistics.median(values):9.3f} {min(values):9.3f}  {note}", flush=True)


def crowded(project: Project, copies: int) -> Project:
    """Every gesture and fidget `copies` times: hundreds of candidates a stance."""
    for layer in LAYERS:
        for action in list(project.graphs[layer].actions.values()):
            if action.kind in ("gesture", "fidget"):
                project = edits.place_clips(
                    project, [action.clip] * copies, layer, action.kind, action.stance
                )
    return project


def lively(project: Project) -> None:
    """What the life layers cost one character that talks and looks about: a frame of each kind in turn."""
    text = (
        "Well, I think that we should go there tomorrow, because the weather will be fine and everybody "
        "has time."
    )
    asks = [Speech(f"s{n}", 9.0 * n, 9.0 * n + 7.5, None, text) for n in range(60)]
    looks = [LookAt(f"l{n}", 7.0 * n, 7.0 * n + 4.0, (np.sin(n), 1.5, 1.0)) for n in range(80)]
    plan = make_plan(project, 600.0)
    track = track_of([*asks, *looks])
    life = schedule(project.life, track, {}, 1, 600.0, Schedule(), 0.0)
    plan = replace(plan, track=track, life=life)
    bare: list[float] = []
    whole: list[float] = []
    planned: list[float] = []
    running = make_plan(project, 12.0)
    pose_at(plan, project, 1.0)
    for n in range(600):
        at, now = 100 + n / 60, n / 60
        bare.append(clock(lambda at=at: pose_at(plan, project, at, alive=False)))  # type: ignore[misc]
        whole.append(clock(lambda at=at: pose_at(plan, project, at)))  # type: ignore[misc]
        began = time.perf_counter()
        running = replace(
            running, life=schedule(project.life, running.track, {}, 1, 12.0 + now, running.life, now)
        )
        planned.append((time.perf_counter() - began) * 1e3)
    times = np.arange(3600) / 60
    print("\none character, talking and looking about")
    row("a frame of the layers", bare)
    row(
        "a frame of layers and life",
        whole,
        f"life adds {statistics.median(whole) - statistics.median(bare):.3f}",
    )
    row("what drawing life ahead adds to a tick", planned, f"mean {statistics.mean(planned):.3f}")
    row(
        "one minute at 60 fps, a frame",
        [clock(lambda: pose_at(plan, project, times)) / 3600 for _ in range(3)],
    )
    hour = [clock(lambda: schedule(project.life, track, {}, 1, 3600.0, Schedule(), 0.0)) for _ in range(5)]
    row("an hour of life, drawn at once", hour)


def one_character(project: Project, plan: Plan) -> None:
    """A pose and where its joints are, at one time after the other as a preview asks, and at any: the
    processor's microseconds.
    """
    drawn = np.random.default_rng(1).uniform(0, 120, 400)
    print("\none character, the processor's us")
    for words, times, alive in (
        ("pose_at without life, any time", drawn, False),
        ("pose_at without life, 60 a second", np.arange(400) / 60, False),
        ("pose_at with life and weight, any time", drawn, True),
        ("pose_at with life and weight, 60 a second", np.arange(400) / 60, True),
    ):
        taken: list[float] = []
        after: list[float] = []
        pose_at(plan, project, float(times[0]), alive)
        for time_ in times.tolist():
            start = time.thread_time_ns()
            pose = pose_at(plan, project, time_, alive)
            done = time.thread_time_ns()
            project.skeleton.globals(pose)  # type: ignore[union-attr]
            taken.append((done - start) / 1e3)
            after.append((time.thread_time_ns() - done) / 1e3)
        row(words, taken)
        row("  and Skeleton.globals", after)
    minute = np.arange(3600) / 60
    for alive in (False, True):
        start = time.thread_time_ns()
        pose_at(plan, project, minute, alive)
        spent = (time.thread_time_ns() - start) / 3.6e6
        row(f"one minute at 60 fps, a frame, {'alive' if alive else 'without life'}", [spent])


def main() -> None:
    sample = open_project(ROOT / "sample_clips" / "sample.metagraph.yaml").project
    assert sample.skeleton is not None
    joints = len(sample.skeleton)
    print(
        f"sample project: {joints} joints, three layers; {os.cpu_count()} cores\n  {'':46} {'median':>9} "
        f"{'best':>9}  ms"
    )

    hour = make_plan(sample, 3600)
    cues = sum(len(lane.cues) for lane in hour.layers.values())
    row("plan of one hour", [clock(lambda: make_plan(sample, 3600)) for _ in range(7)], f"{cues} cues")
    many = crowded(sample, 24)
    most = max(len(bucket) for graph in many.graphs.values() for bucket in graph.index.values())
    row(
        "plan of one hour, hundreds of candidates",
        [clock(lambda: make_plan(many, 3600)) for _ in range(3)],
        f"up to {most} a draw",
    )
    row(
        "extend an hour's plan by a minute",
        [clock(lambda: extend_plan(sample, hour, 3590, (), 3660)) for _ in range(7)],
    )
    day = make_plan(sample, 36000)
    row(
        "extend a plan of ten hours by a minute",
        [clock(lambda: extend_plan(sample, day, 35990, (), 36060)) for _ in range(7)],
    )

    times = np.random.default_rng(1).uniform(0, 3600, 400)
    pose_at(hour, sample, times, alive=False)
    row(
        "pose_at without life, one time",
        [clock(lambda t=t: pose_at(hour, sample, t, alive=False)) for t in times],
    )  # type: ignore[misc]
    minute = np.arange(3600) / 60
    row(
        "the same, one minute at 60 fps, a frame",
        [clock(lambda: pose_at(hour, sample, minute, alive=False)) / 3600 for _ in range(3)],
    )
    one_character(sample, make_plan(sample, 120))
    lively(sample)


if __name__ == "__main__":
    main()
