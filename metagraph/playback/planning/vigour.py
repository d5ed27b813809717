"""How energetic an action is beside others: what makes it likelier or rarer in a mood (`mood.favour`)."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from math import log2
from typing import Any
from weakref import ref

import numpy as np

from metagraph.graph.model import Action, Kind, MetaGraph, Project
from metagraph.motion.clip import Clip
from metagraph.playback.posing.rigs import ResolvedProject
from metagraph.playback.timing.phases import REMEMBERED, find_movers, track

STILL = 0.02  # metres a second: slower than this nothing is


def measure_vigour(project: Project, action: Action) -> float:
    """Return how fast an action's hands (arms), head or trunk and feet move on average, beside the median of
    its layer's actions of its kind: -1 for half as fast or less, 1 for twice as fast or more. 0 if nothing is
    known of its motion. An export says it.
    """
    if isinstance(project, ResolvedProject):
        return project.vigours.get(action.id, 0.0)
    graph = project.graphs[action.layer]
    medians = _medians(project, graph)
    if action.kind not in medians:
        medians[action.kind] = _median(
            [_speed_of(project, other) for other in graph.actions.values() if other.kind == action.kind]
        )
    return _beside(_speed_of(project, action), medians[action.kind])


def measure_vigours(project: Project, graph: MetaGraph, speeds: Mapping[str, float]) -> dict[str, float]:
    """Return the vigour of those actions of a layer whose speeds (`mean_speed_within`) are known, by their
    ids.
    """
    medians = _medians(project, graph)
    kinds: dict[Kind, list[float | None]] = {}
    for ident, speed in speeds.items():
        kinds.setdefault(graph.actions[ident].kind, []).append(speed)
    medians.update((kind, _median(found)) for kind, found in kinds.items() if kind not in medians)
    return {ident: _beside(speed, medians[graph.actions[ident].kind]) for ident, speed in speeds.items()}


def _medians(project: Project, graph: MetaGraph) -> dict[Kind, float]:
    """Return what is known of the median speeds of a layer's kinds, metres a second, as long as clips and
    roles stay as they are.
    """
    known = graph.__dict__.get("_vigour")
    if known is None or known[0] is not project.clips or known[1] is not project.roles:
        known = graph.__dict__["_vigour"] = (project.clips, project.roles, {})
    medians: dict[Kind, float] = known[2]
    return medians


def _median(speeds: list[float | None]) -> float:
    return float(np.median([x for x in speeds if x is not None] or [0.0]))


def _beside(own: float | None, median: float) -> float:
    if own is None or median <= 0:
        return 0.0
    # To two digits, so that what is read from a file of rounded poses has the same.
    return min(1.0, max(-1.0, round(log2(max(own, STILL) / max(median, STILL)), 2)))


def _speed_of(project: Project, action: Action) -> float | None:
    entry = project.clips.get(action.clip)
    if entry is None or entry.motion is None:
        return None
    return mean_speed_within(project, action, entry.motion, *project.span(action))


def mean_speed_within(
    project: Project, action: Action, motion: Clip, start: float, end: float
) -> float | None:
    """Return the mean speed of the fastest mover in the part that plays (`Project.span`), metres a second;
    None if nothing plays.
    """
    if motion.frames < 2 or end <= start:
        return None
    joints, seen_from = find_movers(project, motion, action.layer, action.limb)
    return _mean_speed(ref(motion), joints, seen_from, start, end)


@lru_cache(maxsize=REMEMBERED)
def _mean_speed(whose: ref[Clip], joints: tuple[int, ...], seen_from: int, start: float, end: float) -> float:
    motion = whose()
    assert motion is not None
    first = min(int(start * motion.fps), motion.frames - 2)
    places: Any = track(whose, joints, seen_from)[first : max(first + 2, int(end * motion.fps) + 1)]
    return float(np.linalg.norm(np.diff(places, axis=0) * motion.fps, axis=-1).max(-1).mean())
