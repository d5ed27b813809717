"""How fast a joint goes in a clip itself, where a performance plays it: what is seen there need not come from
a blend.
"""

from __future__ import annotations

import numpy as np

from metagraph.graph.model import Layer, Project
from metagraph.playback.plan import Plan
from metagraph.playback.posing.composer import playable


def own_moves(
    project: Project, plan: Plan, layer: Layer, joint: int, time: float, rate: float
) -> tuple[float, float]:
    """Return how fast a joint goes, m/s, and how its speed changes, m/s2, in the clip that a layer plays at a
    time, seconds, alone: the most of three neighbouring poses at `rate` a second. Zeros where no clip plays.
    """
    cue = plan.layers[layer].cue_at(time)
    clip = playable(project, cue.action) if cue is not None else None
    if cue is None or clip is None:
        return 0.0, 0.0
    times = time + np.arange(-2, 4) / rate
    seconds = np.clip(cue.clip_seconds(times), 0.0, clip.duration)
    _, places = clip.skeleton.globals(clip.pose_at(seconds))
    way = np.diff(places[:, joint], axis=0)
    speeds = np.linalg.norm(way, axis=-1) * rate
    changes = np.linalg.norm(np.diff(way, axis=0), axis=-1) * rate**2
    return float(speeds.max()), float(changes.max())
