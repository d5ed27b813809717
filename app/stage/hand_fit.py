"""Find how far the hands of a character pass below the top of a prop, where they are not brought onto it."""

from __future__ import annotations

import numpy as np

from metagraph.graph.face.rig import gather_face_parts
from metagraph.graph.model import Project
from metagraph.graph.remembered import Remembered
from metagraph.motion import rotation
from metagraph.motion.prop_tops import PropTop
from metagraph.playback.evaluator import Evaluator
from metagraph.playback.planner import make_plan
from metagraph.playback.posing.prop_contacts import REACH, find_resting_rig, measure_reach

SECONDS, RATE = 30.0, 3.0  # of what the character does by itself that is looked at, and how often
OFTEN = 0.1  # of that time: what happens less often is not told
SPARE = 0.02  # metres by which a hand is within reach after a prop was fitted

_known: Remembered[np.ndarray] = Remembered(
    lambda project: (*gather_face_parts(project), project.graphs, project.life)
)


def measure_hands_below(project: Project, tops: tuple[PropTop, ...]) -> tuple[float, float] | None:
    """Return how far hands pass below the highest of some tops where they are not brought onto it, metres,
    and how high that top is; 0 where they rest on it, None if no hand comes there.
    """
    if not tops or project.skeleton is None:
        return None
    top, reach = tops[-1], measure_reach(project)
    points = _known.of(project, project.base, lambda: _find_points(project))
    if not len(points) or top.distance > reach:
        return None
    over = top.contains(points[..., :3])
    depths = top.find_heights(points[..., :3]) + points[..., 3] - points[..., 1]
    deep = np.where(over, depths, -np.inf).max(-1)
    if (deep > -np.inf).mean() < OFTEN:
        return None
    below = deep[deep > REACH]
    if len(below) < OFTEN * len(deep):
        return 0.0, top.height
    return float(np.median(below)), top.height


def find_fitting_height(below: float, height: float) -> float:
    """Return how high a top should be that hands pass so far below, so that they rest on it, metres."""
    return height - (below - REACH) - SPARE


def _find_points(project: Project) -> np.ndarray:
    """Return the points of both hands in what the character does by itself, `[N, P, 4]`: places and radii."""
    rig = find_resting_rig(project)
    assert project.skeleton is not None
    if rig is None:
        return np.zeros((0, 1, 4))
    times = np.arange(0, SECONDS, 1 / RATE)
    pose = Evaluator(make_plan(project, SECONDS, seed=1), project).before_life(times)
    turned, at = (np.asarray(x, float) for x in project.skeleton.globals(pose))
    out = []
    for points in rig.points:
        joints = [rig.body.joints[p.place] for p in points]
        placed = at[:, joints] + rotation.rotate_vectors(turned[:, joints], np.array([p.at for p in points]))
        radii = np.broadcast_to([p.radius for p in points], placed.shape[:2])
        out.append(np.concatenate([placed, radii[..., None]], -1))
    return np.concatenate(out)
