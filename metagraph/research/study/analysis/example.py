"""The comparison that was published with the meta-graph (Borer et al., section 7.1), recomputed: what it
shows, and what it does not.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import log

from metagraph.research.study.statistics import small_samples as stats

CLIPS = 152
META_HOURS, META_DAYS = 8.0, 1.5
MANUAL_HOURS, MANUAL_DAYS = 63.0, 8.5
WEEK = 5  # working days, of the tutorial
SCATTERS = (0.25, 0.5, 1.0)  # standard deviations of the logs of people's ratios that are looked at


@dataclass(frozen=True)
class PublishedExample:
    """minutes: a clip, meta and by hand. ratio: without an interval. with_tutorial: the ratio when the week
    before counts, in days as long as those of the work. needed: scatter -> people for an 80 % chance to show
    such a ratio.
    """

    minutes: tuple[float, float]
    ratio: stats.Estimate
    with_tutorial: float
    needed: dict[float, int | None]


def compute_example() -> PublishedExample:
    """Return the published figures, recomputed."""
    ratio = stats.estimate_ratio([MANUAL_HOURS], [META_HOURS])
    tutorial = WEEK * MANUAL_HOURS / MANUAL_DAYS
    needed = {s: stats.count_pairs_needed(log(ratio.value) / s) for s in SCATTERS}
    minutes = META_HOURS * 60 / CLIPS, MANUAL_HOURS * 60 / CLIPS
    return PublishedExample(minutes, ratio, (MANUAL_HOURS + tutorial) / META_HOURS, needed)


def describe_example(found: PublishedExample) -> str:
    """Return the example in words."""
    meta, manual = found.minutes
    lines = [
        "Borer et al., section 7.1: one animator, three years of Maya, wires 152 clips.",
        "",
        "                       hours   days   minutes a clip",
        f"meta-graph            {META_HOURS:6.1f} {META_DAYS:6.1f} {meta:16.2f}",
        f"Unreal state machine  {MANUAL_HOURS:6.1f} {MANUAL_DAYS:6.1f} {manual:16.2f}",
        f"ratio                 {found.ratio.value:6.2f}",
        "",
        f"What it shows: this animator, with these clips, needed {manual - meta:.1f} minutes less for each "
        "of them.",
        "",
        "What it does not show:",
        f"- {stats.list_ratio_cautions(found.ratio, None)[0]}",
        "- The meta-graph came first and the state machine second, so practice with the clips helped the "
        "second.",
        "- Before the state machine there was a week of tutorial and often help, before the meta-graph an "
        "example. With a week of days as",
        f"  long as those of the work the ratio is {found.with_tutorial:.1f}.",
        "- Mistakes were told, not counted: by hand there were 'several jumps' and 'many more mistakes'.",
        "",
        "How many people show such a ratio with a chance of 80 %, by how much theirs differ (standard "
        "deviation of logs):",
        *(f"- {scatter:.2f}: {people} people" for scatter, people in found.needed.items()),
        f"The signed-rank test needs {stats.FEWEST_RANKED} at least, and two orders as many people in each.",
    ]
    return "\n".join(lines)
