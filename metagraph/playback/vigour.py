"""How energetic an action is beside others: what makes it likelier or rarer in a mood (`mood.favour`)."""

from __future__ import annotations

from functools import lru_cache
from math import log2
from typing import Any
from weakref import ref

import numpy as np

from metagraph.graph.model import Action, Kind, MetaGraph, Project
from metagraph.motion.clip import Clip
from metagraph.playback.phases import movers, track

STILL = 0.02  # metres a second: slower than this nothing is


def vigour(project: Project, action: Action) -> float:
    """Return how fast an action's hands (arms), head or trunk and feet move on average, beside the median of
    its layer's actions of its kind: -1 for half as fast or less, 1 for twice as fast or more. 0 where nothing
    is known of its motion.
    """
    graph = project.graphs[action.layer]
    known = graph.__dict__.get("_vigour")
    if known is None or known[0] is not project.clips or known[1] is not project.roles:
        known = graph.__dict__["_vigour"] = (project.clips, project.roles, {})
    medians: dict[Kind, float] = known[2]
    if action.kind not in medians:
        medians[action.kind] = _median(project, graph, action.kind)
    own, median = _speed_of(project, action), medians[action.kind]
    if own is None or median <= 0:
        return 0.0
    # To two digits, so that what is read from a file of rounded poses has the same.
    return min(1.0, max(-1.0, round(log2(max(own, STILL) / max(median, STILL)), 2)))


def _median(project: Project, graph: MetaGraph, kind: Kind) -> float:
    found = [_speed_of(project, action) for action in graph.actions.values() if action.kind == kind]
    return float(np.median([x for x in found if x is not None] or [0.0]))


def _speed_of(project: Project, action: Action) -> float | None:
    """Return the mean speed of the fastest mover, metres a second; None where the clip is missing."""
    entry = project.clips.get(action.clip)
    motion = entry.motion if entry is not None else None
    if motion is None or motion.frames < 2:
        return None
    start, end = project.span(action)
    if end <= start:
        return None
    joints, seen_from = movers(project, motion, action.layer, action.limb)
    return _mean_speed(ref(motion), joints, seen_from, start, end)


@lru_cache(maxsize=4096)
def _mean_speed(whose: ref[Clip], joints: tuple[int, ...], seen_from: int, start: float, end: float) -> float:
    motion = whose()
    assert motion is not None
    first = min(int(start * motion.fps), motion.frames - 2)
    places: Any = track(whose, joints, seen_from)[first : max(first + 2, int(end * motion.fps) + 1)]
    return float(np.linalg.norm(np.diff(places, axis=0) * motion.fps, axis=-1).max(-1).mean())
