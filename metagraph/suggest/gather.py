"""Bring clips that were recorded all over the floor to one spot: each begins where the stance stands that it
belongs to, facing the same way. Otherwise the body would slide by metres in each blend.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph import anatomy
from metagraph.graph.clip_source import get_source_clip, with_source
from metagraph.graph.model import LAYERS, Action, MetaGraph, Project
from metagraph.motion import rotation
from metagraph.motion.in_place import find_spot, measure_turn
from metagraph.playback.posing.composer import find_playable_motion

Array = NDArray[Any]
Spot = tuple[Array, Array]  # how the hips are turned, and where they are on the ground

TALL = 1.75  # metres: the figure that the next two are of
AWAY = 0.2  # metres over the floor within which a stance stays where it is
NEAR = 0.08  # and within which a clip does that begins in a stance
TURNED = float(np.radians(25.0))  # how far a stance may be turned
NEARLY = float(np.radians(10.0))  # and a clip that begins in it


STREWN = 0.25  # share of the clips far from their stance, from which on a set was recorded all over the floor
FAR, TURNED_FAR = 0.3, float(np.radians(45.0))  # what is far, metres and radians


def gather_clips(project: Project, clips: Collection[str]) -> Project:
    """Return the project with clips brought to one spot, where they begin far from it or face elsewhere:
    stances to where their layer's first one stands, others to where their stance does. Layers that leave the
    legs alone do not count, nor does a layer whose clips mostly begin at their stance: somebody who sits down
    on a chair behind ends where the sitting begins.
    """
    if project.skeleton is None:
        return project
    left = set(clips)
    for layer in LAYERS:
        graph = project.graphs[layer]
        if graph.weight("legs") <= 0 or not _is_strewn(project, graph, left):
            continue
        home = _find_spot_of_stance(project, graph, graph.start)
        for action in graph.actions.values():
            if action.kind == "stance" and action.clip in left:
                left.discard(action.clip)
                project = _brought(project, action, home, AWAY, TURNED)
        for action in graph.actions.values():
            if action.kind != "stance" and action.clip in left:
                left.discard(action.clip)
                stands = _find_spot_of_stance(project, graph, action.stance)
                project = _brought(project, action, stands, NEAR, NEARLY)
    return project


def _is_strewn(project: Project, graph: MetaGraph, clips: Collection[str]) -> bool:
    """Return whether many of a layer's clips begin far from where their stance stands, or face elsewhere."""
    far, count = 0, 0
    assert project.skeleton is not None
    for action in graph.actions.values():
        if action.kind == "stance" or action.clip not in clips:
            continue
        spot = _find_spot_of_action(project, action)
        to = _find_spot_of_stance(project, graph, action.stance)
        if spot is None or to is None:
            continue
        count += 1
        away = float(np.linalg.norm(spot[1] - to[1])) * TALL / project.skeleton.height
        far += away > FAR or abs(measure_turn(spot[0], to[0])) > TURNED_FAR
    return count > 0 and far >= STREWN * count


def _brought(project: Project, action: Action, to: Spot | None, away: float, turned: float) -> Project:
    """Return the project with an action's clip where it begins at a spot, if it is farther from it."""
    assert project.skeleton is not None
    entry, spot = project.clips.get(action.clip), _find_spot_of_action(project, action)
    source = get_source_clip(entry) if entry is not None else None
    if entry is None or source is None or spot is None or to is None:
        return project
    turn, far = measure_turn(spot[0], to[0]), float(np.linalg.norm(spot[1] - to[1]))
    if far <= away * project.skeleton.height / TALL and abs(turn) <= turned:
        return project
    about = rotation.from_axis_angle(np.array([0.0, 1.0, 0.0]), turn)
    x, _, z = rotation.rotate_vectors(about, np.array([spot[1][0], 0.0, spot[1][1]]))
    moved = replace(
        entry,
        turned=round(float(turn), 6),
        moved_x=round(float(to[1][0] - x), 6),
        moved_z=round(float(to[1][1] - z), 6),
    )
    return replace(project, clips={**project.clips, entry.id: with_source(moved, source)})


def _find_spot_of_stance(project: Project, graph: MetaGraph, stance: str | None) -> Spot | None:
    """Return where a stance's first loop begins."""
    loops = graph.of(stance or "", "stance")
    return _find_spot_of_action(project, loops[0]) if loops else None


def _find_spot_of_action(project: Project, action: Action) -> Spot | None:
    hips = anatomy.project_roles(project).get("hips", 0)
    motion = find_playable_motion(project, action)
    return find_spot(motion, hips, project.span(action)[0]) if motion is not None else None
