"""Blends long enough for the way they go: clips that begin or end away from their stance come from it, and go
back, at the pace of a movement instead of jumping.
"""

from __future__ import annotations

from collections.abc import Collection
from math import ceil

from metagraph.graph import edits
from metagraph.graph.checks.end_gaps import TALL, UNHURRIED, find_end_gaps
from metagraph.graph.model import LAYERS, Project

NEAR = 0.05  # metres of a figure TALL metres high that nobody sees a blend go
SHARE = 0.45  # of a clip that a blend may take


def soften_blends(project: Project, but: Collection[str] = ()) -> Project:
    """Return the project with longer blends where gestures, fidgets and transitions begin or end far from
    their stances. None becomes shorter. but: ids of actions that stay as they are.
    """
    if project.skeleton is None:
        return project
    pace, near = (x * project.skeleton.height / TALL for x in (UNHURRIED, NEAR))
    changes = {}
    for layer in LAYERS:
        for action in project.graphs[layer].actions.values():
            if action.kind == "stance" or action.clip not in project.clips or action.id in but:
                continue
            start, end = project.span(action)
            most, timing = SHARE * (end - start), action.timing
            far = {g.edge: g.metres for g in find_end_gaps(project, project.graphs[layer], action)}
            into, out = (
                min(most, gap / pace) if (gap := far.get(edge, 0.0)) > near else 0.0
                for edge in ("begins", "ends")
            )
            longer = {
                name: ceil(value * 1000) / 1000
                for name, value, now in (
                    ("blend_in", into, timing.blend_in),
                    ("blend_out", out, timing.blend_out),
                )
                if value > now
            }
            if longer:
                changes[action.id] = {"timing": longer}
    return edits.update_each(project, changes) if changes else project
