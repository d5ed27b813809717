"""Actions in an export. There may be ten thousand of a layer: what is the same for all is asked once."""

from __future__ import annotations

from typing import Any

from msgspec import UNSET

from metagraph.engines import contract as c
from metagraph.engines.export_contacts import export_contacts
from metagraph.graph.model import MetaGraph, Project
from metagraph.graph.repeating import cycle_of
from metagraph.playback.planning.prominence import measure_prominence
from metagraph.playback.planning.vigour import mean_speed_within, measure_vigours
from metagraph.playback.timing.phases import find_phases_within

NONE: list[Any] = []  # as most have it: an export is made to be written, and nothing is added to it


def list_exported_actions(project: Project, graph: MetaGraph) -> list[c.ExportedAction]:
    """Return a layer's actions as they are exported, in the order they were placed."""
    span, clips, make = project.span, project.clips, c.ExportedAction
    out: list[c.ExportedAction] = []
    speeds: dict[str, float] = {}
    for action in graph.actions.values():
        timing, entry = action.timing, clips.get(action.clip)
        motion = entry.motion if entry is not None else None
        start, end = span(action)
        if (
            motion is not None
            and (speed := mean_speed_within(project, action, motion, start, end)) is not None
        ):
            speeds[action.id] = speed
        phases: list[float] = NONE
        own_phases: list[float | None] = NONE
        if action.kind == "gesture":
            found = find_phases_within(project, action, motion, start, end)
            phases = [found.ready, found.stroke, found.stroke_end, found.relax]
            if not timing.ready is timing.stroke_end is timing.relax is None:
                own_phases = [timing.ready, timing.stroke_end, timing.relax]
        blend_in, blend_out, cooldown = timing.blend_in, timing.blend_out, action.cooldown
        out.append(
            make(
                action.id,
                action.name,
                action.clip,
                action.kind,
                action.stance,
                action.end_stance,
                start,
                end,
                timing.end is None,
                blend_in if blend_in > 0.0 else 0.0,
                blend_out if blend_out > 0.0 else 0.0,
                timing.loop,
                timing.earliest_exit,
                timing.stroke,
                action.limb,
                list(action.joints) if action.joints else NONE,
                list(action.tags) if action.tags else NONE,
                action.likelihood,
                phases,
                own_phases,
                cooldown if cooldown > 0.0 else 0.0,
                action.spacing,
                export_contacts(action) if action.contacts else NONE,
                0.0,
                dict(action.joint_weights) if action.joint_weights else {},
                timing.repeat if cycle_of(action.kind, timing, start, end) > 0.0 else UNSET,
                measure_prominence(project, action) if action.kind in ("gesture", "fidget") else 0.0,
                action.prominence,
            )
        )
    found_vigours = measure_vigours(project, graph, speeds)
    if found_vigours:
        for made in out:
            made.vigour = found_vigours.get(made.id, 0.0)
    return out
