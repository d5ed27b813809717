"""A performance as plain motion: one clip that any program plays without a planner."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph.model import Project
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Pose
from metagraph.playback.faces import faces_at
from metagraph.playback.plan import Plan
from metagraph.playback.player import pose_at

Array = NDArray[Any]

STILL = 1e-6  # metres: a joint that moves less than this from its rest translation keeps it


def bake(
    plan: Plan,
    project: Project,
    seconds: float,
    fps: float = 30.0,
    poses: Callable[[Array], Pose | None] | None = None,
    start: float = 0.0,
) -> Clip:
    """Return `seconds` of a plan as a clip on the project's skeleton, with the life layers and morph targets
    that move. poses: of times `[N]`, where they are not the plan's alone. start: second it begins at.

    Raises ValueError when the project has no skeleton.
    """
    if project.skeleton is None:
        raise ValueError("a project without clips cannot be posed")
    times = start + np.arange(max(1, round(seconds * fps) + 1)) / fps
    pose = (poses(times) if poses is not None else None) or pose_at(plan, project, times)
    away = np.abs(pose.translations - project.skeleton.rest_translations).max(axis=(0, 2))
    moved = (0, *(int(j) for j in np.flatnonzero(away > STILL) if j > 0))
    turned = rotation.continuous(pose.rotations)
    return Clip(
        project.name,
        project.skeleton,
        fps,
        turned,
        pose.translations[:, list(moved)],
        moved,
        *_morphs(plan, project, times),
    )


def _morphs(plan: Plan, project: Project, times: Array) -> tuple[tuple[str, ...], Array]:
    """Return the names of morph targets that move, and their weights `[F, K]`."""
    face = bool(project.face.morphs) or any(
        e.motion is not None and e.motion.morphs for e in project.clips.values()
    )
    rows = faces_at(plan, project, times) if face else [{} for _ in times]
    names = tuple(sorted({name for row in rows for name, value in row.items() if value > 0}))
    return names, np.array([[row.get(name, 0.0) for name in names] for row in rows], np.float32).reshape(
        len(times), len(names)
    )
