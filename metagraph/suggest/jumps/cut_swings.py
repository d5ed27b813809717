"""Clips that were cut in the middle of a swing: their actions begin and end at a turn of it, where the limb
stops by itself. A blend keeps the clip's own speed, so a limb that still moves at the cut would stop at once.
"""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from metagraph.graph import edits
from metagraph.graph.checks.end_gaps import FAR, TALL, find_end_gaps, find_reached_joints, get_action_motion
from metagraph.graph.model import LAYERS, Action, Project
from metagraph.graph.repeating import cycle_of
from metagraph.motion.clip import Clip

RATE = 60.0  # moments a second that are looked at
LONGEST = 0.4  # seconds that may be left out at an end
SHARE = 0.1  # of an action that may be left out at an end
MOVING = 0.6  # m/s of the fastest joint, of a figure TALL metres high, that is seen to stop at once
CALMER = 0.5  # share of its speed at the cut that the fastest joint has at most at a turn


def begin_at_turns(project: Project, but: Collection[str] = ()) -> Project:
    """Return the project with gestures, fidgets and transitions that begin at the first turn of their swing,
    and end at the last, where they are cut far from their stance while a joint moves. but: ids of actions
    that stay as they are.
    """
    if project.skeleton is None:
        return project
    scale = project.skeleton.height / TALL
    changes = {}
    for layer in LAYERS:
        graph = project.graphs[layer]
        for action in graph.actions.values():
            clip = get_action_motion(project, action)
            start, end = project.span(action)
            if clip is None or action.kind == "stance" or action.id in but:
                continue
            if cycle_of(action.kind, action.timing, start, end) > 0:
                continue
            far = {gap.edge for gap in find_end_gaps(project, graph, action) if gap.metres > FAR * scale}
            joints = find_reached_joints(project, graph, action)
            timing = {}
            if "begins" in far and (skipped := _find_turn(clip, joints, start, end, scale)) > 0:
                timing["start"] = round(start + skipped, 3)
            if "ends" in far and (skipped := _find_turn(clip, joints, end, start, scale)) > 0:
                timing["end"] = round(end - skipped, 3)
            if timing and _keeps_moments(action, timing):
                changes[action.id] = {"timing": timing}
    return edits.update_each(project, changes) if changes else project


def _find_turn(clip: Clip, joints: tuple[int, ...], cut: float, other: float, scale: float) -> float:
    """Return how many seconds of a clip to leave out from a cut towards its other end: 0 if its joints are
    still at the cut, or no turn is near.
    """
    room = min(LONGEST, SHARE * abs(other - cut))
    ways = np.arange(int(room * RATE) + 3) / RATE
    times = np.clip(cut + np.sign(other - cut) * ways, 0.0, clip.duration)
    _, places = clip.skeleton.globals(clip.pose_at(times))
    steps = np.diff(places[:, list(joints)] - places[:, :1], axis=0)  # as seen from the root
    speeds = np.linalg.norm(steps, axis=-1).max(axis=-1, initial=0.0) * RATE
    best = int(np.argmin(speeds))
    return float(ways[best]) if speeds[0] > MOVING * scale and speeds[best] < CALMER * speeds[0] else 0.0


def _keeps_moments(action: Action, timing: dict[str, float]) -> bool:
    """Return whether all that is marked in an action is still played."""
    t = action.timing
    marks = [x for x in (t.ready, t.stroke, t.stroke_end, t.relax, t.earliest_exit) if x is not None]
    first, last = timing.get("start", t.start), timing.get("end", t.end)
    return all(first <= x and (last is None or x <= last) for x in marks)
