"""Evaluate single clips, and clips that move a character while a plan says where it looks and what it says.
These have the same methods as `evaluator.Evaluator`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph.face.curves import fit_curves_to_face
from metagraph.graph.model import Project
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Pose
from metagraph.playback.evaluator import Evaluator
from metagraph.playback.plan import Plan
from metagraph.playback.posing.overlay import Overlay, make_clip_overlay

Array = NDArray[Any]
Faces = list[dict[str, float]]


class ClipEvaluator:
    """Plays only a clip, on its own skeleton."""

    def __init__(self, project: Project, clip: Clip) -> None:
        self._clip = fit_curves_to_face(project, clip)

    def at(self, seconds: Any) -> Pose:
        """Return the pose at `seconds`, a number or an array `[...]`."""
        return self._clip.pose_at(seconds)

    def morphs_at(self, seconds: float) -> dict[str, float]:
        """Return morph target weights, 0..1, at one time."""
        return self._clip.morphs_at(seconds)

    def faces_at(self, times: Array) -> Faces:
        """Return morph target weights, 0..1, at each of `times [N]`."""
        return [self.morphs_at(float(time)) for time in times]


class MovedEvaluator(Evaluator):
    """Plays a clip that moves the whole body. The plan moves eyes, lids and lips, and breathes."""

    def __init__(self, plan: Plan, project: Project, clip: Clip) -> None:
        super().__init__(plan, project)
        self._clip = clip

    def at(self, seconds: Any, alive: bool = True, overlay: Overlay | None = None) -> Pose:
        times = np.asarray(seconds, np.float64).reshape(-1)
        pose = self._clip.pose_at(np.clip(times, 0.0, self._clip.duration))
        if alive and self._lives:
            pose = self._life.run(pose, times)
        shape = (*np.shape(seconds), len(self._clip.skeleton))
        return Pose(pose.rotations.reshape(*shape, 4), pose.translations.reshape(*shape, 3))

    def faces_at(self, times: Array) -> Faces:
        return [self.morphs_at(float(time)) for time in times]


class OverlaidEvaluator(Evaluator):
    """Plays a plan with live motion over it. `over` returns the overlay at a time in seconds, None
    for none.
    """

    def __init__(self, plan: Plan, project: Project, over: Callable[[float], Overlay | None]) -> None:
        super().__init__(plan, project)
        self._over = over

    def at(self, seconds: Any, alive: bool = True, overlay: Overlay | None = None) -> Pose:
        if overlay is not None or np.size(seconds) == 0:
            return super().at(seconds, alive, overlay)
        if np.ndim(seconds) == 0:
            return super().at(seconds, alive, self._over(float(seconds)))
        poses = [self.at(time, alive) for time in np.asarray(seconds, np.float64).reshape(-1).tolist()]
        shape = (*np.shape(seconds), len(self.rigs.composer.ground.skeleton))
        return Pose(
            np.stack([pose.rotations for pose in poses]).reshape(*shape, 4),
            np.stack([pose.translations for pose in poses]).reshape(*shape, 3),
        )


class GeneratedEvaluator(Evaluator):
    """Plays a generated clip. It moves everything above the hips; the plan moves the rest."""

    def __init__(self, plan: Plan, project: Project, clip: Clip) -> None:
        super().__init__(plan, project)
        self._clip = clip

    def at(self, seconds: Any, alive: bool = True, overlay: Overlay | None = None) -> Pose:
        times = np.asarray(seconds, np.float64).reshape(-1)
        return super().at(seconds, alive, overlay or make_clip_overlay(self.project, self._clip, times))

    def morphs_at(self, seconds: float, alive: bool = True, composed: Pose | None = None) -> dict[str, float]:
        return super().morphs_at(seconds, alive, composed or self.at(seconds, alive=False))

    def faces_at(self, times: Array) -> Faces:
        return [self.morphs_at(float(time)) for time in times]
