"""How a model does while it learns: short samples beside takes held out, and poses to look at."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from metagraph.generation import statistics
from metagraph.generation.networks import FPS
from metagraph.generation.sampler import generate_recording_poses
from metagraph.generation.stored import Model
from metagraph.generation.takes import Take

SHORT = 20.0  # seconds that are made now and then
SHOWN = 5.0  # poses a second that are shown
LONGEST = 720.0  # seconds that a finished model is judged by
SEED = 1


def judge_held_out(
    model: Model, held: Sequence[Take], seconds: float = SHORT
) -> tuple[dict[str, float], Any]:
    """Return the statistics of motion to the first `seconds` of takes held out, those that could be had, and
    its landmarks SHOWN times a second `[n, 9, 3]`, metres, to look at.
    """
    left, made, true = round(seconds * FPS), [], []
    for take in held:
        part = take.part(0, left)
        if len(part.poses) < 2 * FPS:
            continue
        left -= len(part.poses)
        poses = generate_recording_poses(model, part.features, SEED)
        made.append(statistics.make_motion_sample(model.rig, poses, part))
        true.append(statistics.make_motion_sample(model.rig, part.poses, part))
        if left <= 0:
            break
    if not made:
        return {}, []
    try:
        found = statistics.compute_measures(made, true)
    except ValueError:  # too little to compare; the motion can be looked at all the same
        found = {}
    shown = np.round(made[0].landmarks[:: round(FPS / SHOWN)], 3)
    return {n: round(v, 4) for n, v in found.items() if np.isfinite(v)}, shown.tolist()
