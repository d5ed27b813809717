"""Whether the clocks of a log agree: seconds within a run by the program's clock, and the time of day."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from metagraph.research.study.scores.tasks import Event, read_moment

STEP = 2.0  # seconds the time of day may be set by without a word
RATE = 0.002  # of a run, by which the two may go apart


def find_clock_problems(events: Sequence[Event]) -> list[str]:
    """Return in words where the clocks go apart: all along a run, as they do when one of them was tampered
    with, or at one event, as they do when a computer sleeps.
    """
    out = []
    for run in dict.fromkeys(e["run"] for e in events):
        mine = [e for e in events if e["run"] == run]
        first, last = mine[0], mine[-1]
        inner = last["mono"] - first["mono"]
        outer = (read_moment(last) - read_moment(first)).total_seconds()
        offs = [
            (read_moment(b) - read_moment(a)).total_seconds() - (b["mono"] - a["mono"])
            for a, b in pairwise(mine)
        ]
        if abs(outer - inner) <= STEP + RATE * max(abs(inner), abs(outer)):
            continue
        worst = max(range(len(offs)), key=lambda n: abs(offs[n]))
        if abs(offs[worst]) > 0.8 * sum(map(abs, offs)):
            which = (
                "the computer slept, or its clock was set" if offs[worst] > 0 else "its clock was set back"
            )
            out.append(
                f"the clocks differ by {abs(offs[worst]):.0f} s at event {mine[worst + 1]['n']}: {which}"
            )
        else:
            out.append(
                f"the clocks disagree all along events {first['n']} to {last['n']}: {inner:.0f} s within the "
                f"program, {outer:.0f} s by the time of day; one of them is not to be trusted"
            )
    return out
