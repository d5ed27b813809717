"""Blends long enough for the way they go: clips that begin or end away from their stance come from it, and go
back, at the pace of a movement instead of jumping.
"""

from __future__ import annotations

from collections.abc import Collection
from math import ceil, floor

import numpy as np

from metagraph.graph import edits
from metagraph.graph.checks.end_gaps import (
    FAR,
    LONG,
    SHARE_SEEN,
    TALL,
    UNHURRIED,
    Edge,
    find_end_gaps,
    measure_distances_to_stance,
    measure_slides,
)
from metagraph.graph.model import LAYERS, Action, Project, Timing
from metagraph.graph.repeating import LEAST_CYCLE, cycle_of, usual_repeat

NEAR = 0.05  # metres of a figure TALL metres high that nobody sees a blend go
SLIDES = 0.25  # of that pace: how fast the hips go over the floor
EDGES: tuple[Edge, Edge] = ("begins", "ends")
SHARE = 0.45  # of a clip that a blend may take
LONGEST = 3.0  # seconds that one repeats to have room for its blends
SWINGS = 0.25  # metres of a figure TALL metres high: a clip this far from its stance at a cut may go farther
RATE = 30.0  # moments a second at which that is looked at
SLOWER = 1.1  # times as long a blend for one that repeats, whose own movement is added


def soften_blends(project: Project, but: Collection[str] = ()) -> Project:
    """Return the project with longer blends where gestures, fidgets and transitions begin or end far from
    their stances, or with the hips over another spot, where the blend has time for that. None becomes
    shorter. but: ids of actions that stay as they are.
    """
    if project.skeleton is None:
        return project
    scale = project.skeleton.height / TALL
    pace, near, shows = (x * scale for x in (UNHURRIED, NEAR, FAR))
    changes = {}
    for layer in LAYERS:
        for action in project.graphs[layer].actions.values():
            if action.kind == "stance" or action.clip not in project.clips or action.id in but:
                continue
            start, end = project.span(action)
            timing = action.timing
            graph = project.graphs[layer]
            far = {g.edge: g.metres for g in find_end_gaps(project, graph, action)}
            slides = measure_slides(project, graph, action)
            most, own, repeat = SHARE * (end - start), pace, timing.repeat
            for edge, metres in far.items():
                if metres > SWINGS * scale and repeat == 0:
                    far[edge] = max(metres, pace * _time_swing(project, action, edge, pace, most))
            if (cycle := cycle_of(action.kind, timing, start, end)) > 0:
                own = pace / SLOWER
                needed = max(far.values(), default=0.0) / own / SHARE_SEEN
                repeat = max(repeat, round(cycle * min(ceil(needed / cycle), floor(LONGEST / cycle)), 3))
                most = SHARE_SEEN * repeat
            into, out = (
                min(
                    most,
                    max(
                        gap / own if gap > near else 0.0,
                        LONG if gap > shows else 0.0,
                        way / (SLIDES * pace) if near < way < most * SLIDES * pace else 0.0,
                    ),
                )
                for gap, way in ((far.get(edge, 0.0), slides.get(edge, 0.0)) for edge in EDGES)
            )
            if action.kind != "transition":
                into, out = _both_seen(into, out, timing, 2 * SHARE_SEEN * (repeat or end - start))
            longer = {
                name: ceil(value * 1000) / 1000
                for name, value, now in (
                    ("blend_in", into, timing.blend_in),
                    ("blend_out", out, timing.blend_out),
                    ("repeat", repeat, timing.repeat),
                )
                if value > now
            }
            if longer:
                changes[action.id] = {"timing": longer}
    return edits.update_each(project, changes) if changes else project


def _time_swing(project: Project, action: Action, edge: Edge, pace: float, most: float) -> float:
    """Return how long a blend has to be that also covers where a clip goes while it blends: a wave that was
    cut at its lowest is soon overhead. At most `most` seconds.
    """
    start, end = project.span(action)
    ways = np.arange(int(most * RATE) + 1) / RATE
    times, which = (start + ways, 0) if edge == "begins" else (end - ways, 1)
    farthest = np.maximum.accumulate(measure_distances_to_stance(project, action, times)[which])
    enough = np.flatnonzero(ways * pace >= farthest)
    return float(ways[enough[0]]) if len(enough) else most


def _both_seen(into: float, out: float, timing: Timing, room: float) -> tuple[float, float]:
    """Return how long an action blends in and out, so that both together leave something to be seen."""
    into, out = max(into, timing.blend_in), max(out, timing.blend_out)
    half = room / 2
    return min(into, max(half, room - out)), min(out, max(half, room - into))


def repeat_actions(project: Project, actions: Collection[str], on: bool = True) -> Project:
    """Return the project with gestures and fidgets that repeat, or play once. Those that begin to repeat do
    so for the usual time, and blend at the pace of a movement. Parts under LEAST_CYCLE seconds cannot repeat.
    """
    changes = {}
    for ident in actions:
        action = project.action(ident)
        if action is None or action.kind not in ("gesture", "fidget") or (action.timing.repeat > 0) == on:
            continue
        start, end = project.span(action)
        if on and end - start < LEAST_CYCLE:
            continue
        timing: dict[str, float] = {"repeat": usual_repeat(end - start)}
        if not on:
            most = round(SHARE_SEEN * (end - start), 3)
            now = {"blend_in": action.timing.blend_in, "blend_out": action.timing.blend_out}
            timing = {"repeat": 0.0, **{name: min(most, blend) for name, blend in now.items()}}
        changes[ident] = {"timing": timing}
    if not changes:
        return project
    after = edits.update_each(project, changes)
    return soften_blends(after, {a.id for a in after.actions()} - changes.keys()) if on else after
