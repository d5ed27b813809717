"""Say how long actions play that repeat a part of their clip, such as one cycle of a wave."""

from __future__ import annotations

from math import floor

from metagraph.graph.model import Kind, Timing

LEAST_CYCLE = 0.1  # seconds of a part that can repeat
MOST_TIMES = 1e6  # that a cycle plays in a row
USUAL_REPEAT = 2.25  # seconds that a cycle is repeated for when it is first set to
LONGEST_REPEAT = 60.0  # most seconds that an action repeats if no request says how long


def cycle_of(kind: Kind, timing: Timing, start: float, end: float) -> float:
    """Return the length in seconds of the part from `start` to `end` that an action repeats, 0 if it plays
    once.
    """
    repeats = timing.repeat > 0 and kind in ("gesture", "fidget")
    return end - start if repeats and end - start >= LEAST_CYCLE else 0.0


def times_played(cycle: float, seconds: float) -> float:
    """Return how many whole times, at least one, a cycle must play to last as close to `seconds`
    as possible.
    """
    return max(1.0, floor(min(seconds / cycle, MOST_TIMES) + 0.5))


def usual_repeat(cycle: float) -> float:
    """Return for how many seconds a cycle should repeat at first: whole cycles, mostly 1.5 to 3 s."""
    return round(cycle * times_played(cycle, USUAL_REPEAT), 3)


def seconds_played(kind: Kind, timing: Timing, start: float, end: float) -> float:
    """Return how many seconds an action plays at its own speed if no request says how long."""
    cycle = cycle_of(kind, timing, start, end)
    if cycle <= 0:
        return end - start
    return cycle * times_played(cycle, min(timing.repeat, LONGEST_REPEAT))
