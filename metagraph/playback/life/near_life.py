"""The part of a long schedule that drawing it on needs, and the whole again from what became of that."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from metagraph.playback.life.lane import Lane
from metagraph.playback.life.schedule import Schedule
from metagraph.playback.planning.strand import join_sequence

LANES = ("modes", "moods", "breaths", "aversions", "saccades", "blinks", "swells", "emphases")


def with_past(life: Schedule, near: Schedule, grown: Schedule) -> Schedule:
    """Return what a schedule became. near: that schedule without its past (`Schedule.since`); grown: what
    that became. The past is shared, not copied.
    """
    lanes: dict[str, Any] = {
        name: _with_past(getattr(life, name), getattr(near, name), getattr(grown, name)) for name in LANES
    }
    gone = len(life.targets) - len(near.targets)
    return replace(grown, targets=join_sequence(life.targets, gone, grown.targets), **lanes)


def _with_past(lane: Lane, near: Lane, grown: Lane) -> Lane:
    if grown is near:
        return lane
    gone = near.first - lane.first
    times, rows = join_sequence(lane.times, gone, grown.times), join_sequence(lane.rows, gone, grown.rows)
    return Lane(times, rows, lane.first, lane.width)
