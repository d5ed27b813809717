"""How joints move in the clips themselves, by which what is seen in a performance is judged: what a clip does
need not come from a blend, nor from what is added to it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph.model import Layer, Project
from metagraph.motion.skeleton import Skeleton
from metagraph.playback.plan import Plan
from metagraph.playback.posing.composer import find_playable_motion

Array = NDArray[Any]

RATE = 60.0  # poses a second that are looked at
# m/s, of a figure of 1.75 m, that the body may go over the floor in a blend, however still the clips are:
SHIFTS = 0.3


def find_body_joints(skeleton: Skeleton, roles: Mapping[str, int]) -> list[int]:
    """Return the joints of the body itself, with what its feet end in; without control joints, props and
    clothes, which may be anywhere. All joints where no roles are known.
    """
    feet = [roles[foot] for foot in ("left_foot", "right_foot") if foot in roles]
    ends = {joint for foot in feet for joint in skeleton.descendants(foot)}
    return sorted(ends.union(roles.values())) or list(range(len(skeleton)))


def play_clips(project: Project) -> Iterator[tuple[Array, Array]]:
    """Yield the rotations `[F, J, 4]` and positions `[F, J, 3]`, metres, of all joints in what each action
    plays of its clip, F >= 3 poses at RATE, in the character's space.
    """
    for action in project.actions():
        clip = find_playable_motion(project, action)
        if clip is None:
            continue
        start, end = project.span(action)
        times = start + np.arange(max(3, round((end - start) * RATE))) / RATE
        yield clip.skeleton.globals(clip.pose_at(np.clip(times, 0.0, clip.duration)))


def measure_own_moves(
    project: Project, plan: Plan, layer: Layer, joint: int, time: float
) -> tuple[float, float]:
    """Return how fast a joint goes, m/s, and how its speed changes, m/s2, in the clip that a layer plays at a
    time, seconds, alone: the most of the poses next to it, at RATE. Zeros where only a stance's loop plays.
    """
    cue = plan.layers[layer].cue_at(time)
    clip = find_playable_motion(project, cue.action) if cue is not None else None
    if cue is None or clip is None:
        return 0.0, 0.0
    near = float(cue.clip_seconds(time)) + np.arange(-2, 4) * cue.tempo / RATE  # not over a cycle's seam
    seconds = np.clip(near, 0.0, clip.duration)
    _, places = clip.skeleton.globals(clip.pose_at(seconds))
    way = np.diff(places[:, joint], axis=0)
    speeds = np.linalg.norm(way, axis=-1) * RATE
    changes = np.linalg.norm(np.diff(way, axis=0), axis=-1) * RATE**2
    return float(speeds.max()), float(changes.max())
