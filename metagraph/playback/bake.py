"""A performance as plain motion: one clip that any program plays without a planner."""

from __future__ import annotations

import numpy as np

from metagraph.graph.model import Project
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.playback.plan import Plan
from metagraph.playback.player import pose_at

STILL = 1e-6  # metres: a joint that moves less than this from its rest translation keeps it


def bake(plan: Plan, project: Project, seconds: float, fps: float = 30.0) -> Clip:
    """Return `seconds` of a plan as a clip on the project's skeleton. Raises ValueError when the project has none."""
    if project.skeleton is None:
        raise ValueError("a project without clips cannot be posed")
    pose = pose_at(plan, project, np.arange(max(1, round(seconds * fps) + 1)) / fps)
    away = np.abs(pose.translations - project.skeleton.rest_translations).max(axis=(0, 2))
    moved = (0, *(int(j) for j in np.flatnonzero(away > STILL) if j > 0))
    return Clip(project.name, project.skeleton, fps, rotation.continuous(pose.rotations), pose.translations[:, list(moved)], moved)
