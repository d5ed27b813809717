"""Let mirrored twins begin and end in a stance that is not the same on both sides."""

from __future__ import annotations

from collections.abc import Iterable
from math import ceil

from metagraph.graph import anatomy, edits
from metagraph.graph.checks.end_gaps import SHARE_SEEN, blend_for, find_end_gaps
from metagraph.graph.model import Action, Project
from metagraph.graph.repeating import seconds_played


def fit_twins(project: Project, twins: Iterable[str]) -> Project:
    """Return the project with twins (ids) of one arm that would begin or end far from their stance fitted to
    it: they move that arm alone, so that the other stays as the stance has it, and blend for as long as the
    arm's way takes. What fits, or plays for too short a time, stays as it is.
    """
    for ident in twins:
        action = project.action(ident)
        if action is not None and action.layer == "arms" and action.kind in ("gesture", "fidget"):
            project = _fitted(project, action)
    return project


def _fitted(project: Project, action: Action) -> Project:
    skeleton = project.skeleton
    if skeleton is None or action.limb == "both" or action.joints or not _is_far(project, action):
        return project
    places = zip(skeleton.names, anatomy.project_parts(project), anatomy.project_sides(project), strict=True)
    arm = tuple(name for name, part, side in places if part == "arms" and side == action.limb)
    alone = edits.update_actions(project, [action.id], joints=arm) if arm else project
    moved = alone.action(action.id)
    if moved is None or moved == action:
        return project
    most = SHARE_SEEN * seconds_played(action.kind, action.timing, *project.span(action))
    blends = {}
    for gap in find_end_gaps(alone, alone.graphs["arms"], moved):
        needed = ceil(100 * blend_for(skeleton.height, gap.metres)) / 100
        if gap.far and needed <= most:
            blends["blend_in" if gap.edge == "begins" else "blend_out"] = needed
    fitted = edits.update_actions(alone, [action.id], timing=blends)
    after = fitted.action(action.id)
    return fitted if after is not None and not _is_far(fitted, after) else project


def _is_far(project: Project, action: Action) -> bool:
    return any(gap.far for gap in find_end_gaps(project, project.graphs["arms"], action))
