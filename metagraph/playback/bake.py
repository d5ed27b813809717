"""A performance as plain motion: one clip that any program plays without a planner."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph.model import Project
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.playback.evaluator import Poses

Array = NDArray[Any]

STILL = 1e-6  # metres: a joint that moves less than this from its rest translation keeps it


def bake(poses: Poses, project: Project, seconds: float, fps: float = 30.0, start: float = 0.0) -> Clip:
    """Return `seconds` of what an evaluator shows as a clip on the project's skeleton, with the life layers
    and morph targets that move. start: second it begins at.

    Raises ValueError when the project has no skeleton.
    """
    if project.skeleton is None:
        raise ValueError("a project without clips cannot be posed")
    times = start + np.arange(max(1, round(seconds * fps) + 1)) / fps
    pose = poses.at(times)
    away = np.abs(pose.translations - project.skeleton.rest_translations).max(axis=(0, 2))
    moved = (0, *(int(j) for j in np.flatnonzero(away > STILL) if j > 0))
    turned = rotation.make_continuous(pose.rotations)
    return Clip(
        project.name,
        project.skeleton,
        fps,
        turned,
        pose.translations[:, list(moved)],
        moved,
        *_morphs(poses, project, times),
    )


def _morphs(poses: Poses, project: Project, times: Array) -> tuple[tuple[str, ...], Array]:
    """Return the names of morph targets that move, and their weights `[F, K]`."""
    face = bool(project.face.morphs) or any(
        e.motion is not None and e.motion.morphs for e in project.clips.values()
    )
    rows = poses.faces_at(times) if face else [{} for _ in times]
    names = tuple(sorted({name for row in rows for name, value in row.items() if value > 0}))
    return names, np.array([[row.get(name, 0.0) for name in names] for row in rows], np.float32).reshape(
        len(times), len(names)
    )
