"""Faces at many times, in a row: what each shares with the others is made once."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph.model import Project
from metagraph.motion.skeleton import Pose
from metagraph.playback.plan import Plan
from metagraph.playback.player import layered, morphs_at
from metagraph.playback.weight import weighed


def faces_at(plan: Plan, project: Project, times: NDArray[Any]) -> list[dict[str, float]]:
    """Return morph target weights, 0..1, at each of `times [N]`: to the bit what `player.morphs_at` gives."""
    at = np.asarray(times, np.float64)
    if project.skeleton is None or not len(at):
        return [morphs_at(plan, project, float(time)) for time in at]
    pose = weighed(layered(plan, project, at), plan, project, at)
    return [
        morphs_at(plan, project, float(time), composed=Pose(rotations, translations))
        for time, rotations, translations in zip(at, pose.rotations, pose.translations, strict=True)
    ]
