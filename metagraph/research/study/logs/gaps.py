"""Gaps in a log: times in which nothing was reported. What of them is absence and what is watching nobody
knows, so how much there was is reported, and what another limit would make of it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf

from metagraph.research.study.scores.tasks import AWAY, Event, list_event_steps

SHORTEST = 30.0  # seconds; shorter ones are work by any limit
LIMITS = (30.0, AWAY, 120.0, inf)  # seconds above which a gap is taken to be absence


@dataclass(frozen=True, slots=True)
class LogGap:
    """seconds: of more than SHORTEST. playing: the preview was running meanwhile."""

    seconds: float
    playing: bool


def find_log_gaps(events: Sequence[Event]) -> dict[int, tuple[LogGap, ...]]:
    """Return the gaps of each task, by its place in the sitting; pauses are none."""
    out: dict[int, list[LogGap]] = {}
    task: int | None = None
    playing = False
    for event, seconds, why in list_event_steps(events):
        if task is not None and why != "paused" and seconds > SHORTEST:
            out[task].append(LogGap(seconds, playing))
        if event["type"] == "phase":
            begins = event.get("name") == "task" and event.get("state") == "begin"
            task = place_of(event) if begins else None
            if task is not None:
                out[task] = []
        elif event["type"] == "playback" and event.get("what") in ("play", "pause"):
            playing = event["what"] == "play"
    return {index: tuple(found) for index, found in out.items()}


def place_of(phase: Event) -> int:
    """Return a phase's place in the sitting, -1 where it does not say."""
    index = phase.get("index", -1)
    return int(index) if isinstance(index, int | float) else -1


def measure_seconds_by_limit(active: float, found: Sequence[LogGap], limit: float) -> float:
    """Return a task's seconds by another limit. active: by that of AWAY."""
    there = sum(g.seconds for g in found if g.seconds <= AWAY)
    return active - there + sum(g.seconds for g in found if g.seconds <= limit)


@dataclass(frozen=True)
class Vanished:
    """Gaps of more than AWAY in a condition, which no time counts. seconds: a task, on average; share: of
    that and the time that counts; longest: seconds; playing: the share of it in which the preview was
    running.
    """

    count: int
    seconds: float
    share: float
    longest: float
    playing: float


def count_vanished(tasks: Sequence[tuple[float, Sequence[LogGap]]]) -> Vanished:
    """Return what vanished of tasks, each (active seconds, gaps)."""
    lost = [g for _, found in tasks for g in found if g.seconds > AWAY]
    total, active = sum(g.seconds for g in lost), sum(a for a, _ in tasks)
    return Vanished(
        len(lost),
        total / len(tasks) if tasks else 0.0,
        total / (total + active) if total + active else 0.0,
        max((g.seconds for g in lost), default=0.0),
        sum(g.seconds for g in lost if g.playing) / total if total else 0.0,
    )
