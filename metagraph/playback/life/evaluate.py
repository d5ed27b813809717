"""The life layers at a time: what they add to the pose the layers have composed."""

from __future__ import annotations

from typing import Any

from numpy.typing import NDArray

from metagraph.graph.model import Project
from metagraph.motion.skeleton import Pose
from metagraph.playback.life.schedule import Schedule
from metagraph.playback.life.track import Track

Array = NDArray[Any]


def enliven(pose: Pose, project: Project, schedule: Schedule, track: Track, times: Array) -> Pose:
    """Return composed poses `[N, J]` with breathing, gaze, lids and lips added at `times [N]`."""
    return pose


def face_weights(project: Project, schedule: Schedule, track: Track, seconds: float) -> dict[str, float]:
    """Return the morph target weights of the life layers at one time, 0..1."""
    return {}
