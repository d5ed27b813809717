"""Find where the feet of a project's clips are and when they stand, and where a plan wants them at a time.

The rules are those of `planted_feet` and `motion.feet_solve`, which all runtimes share; this module applies
them to arrays.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph import anatomy
from metagraph.graph.checks.end_gaps import get_action_motion
from metagraph.graph.model import LAYERS, Layer, Project
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.feet_solve import FootGoal
from metagraph.motion.weight_solve import WeightRig
from metagraph.playback.plan import Plan
from metagraph.playback.posing.planted_feet import FOOT_NUMBERS, FOOT_RATE, FOOT_UNIT, FootTrack, foot_goals

Array = NDArray[Any]
Rows = Sequence[Sequence[float]]

STANDS = 0.03  # of the height, a second: a foot whose joints are slower stands
SAME = 10  # units of a row: a clip that moves less all along needs only one row
# Speeds are measured over the time between two rows: from frame to frame, clips stored in 16 bits tremble.


def find_feet_layer(project: Project, rig: WeightRig) -> Layer | None:
    """Return the layer that alone moves the joints from the root to the feet, with full weight: the feet are
    then where its clips have them. None if several do, or one in part. A layer without actions moves nothing.
    """
    parts = anatomy.project_parts(project)
    legs = {rig.body.joints[p] for leg in rig.body.arms for p in leg.below}
    above = [j for j in range(len(rig.body.parents)) if rig.body.joints[j] not in legs]
    chain = legs | {rig.body.joints[p] for p in above if _leads(rig, p)}
    playing = [layer for layer in LAYERS if project.graphs[layer].actions]
    weights = {layer: {project.graphs[layer].weight(parts[joint]) for joint in chain} for layer in playing}
    moving = [layer for layer in playing if weights[layer] != {0}]
    return moving[0] if len(moving) == 1 and weights[moving[0]] == {1} else None


def _leads(rig: WeightRig, place: int) -> bool:
    """Return whether a joint is above a leg."""
    for leg in rig.body.arms:
        here = leg.upper
        while here >= 0:
            if here == place:
                return True
            here = rig.body.parents[here]
    return False


def make_foot_rows(project: Project, motion: Clip, rig: WeightRig) -> Rows:
    """Return the rows of a clip's `FootTrack`."""
    skeleton, roles = motion.skeleton, anatomy.project_roles(project)
    count = int(np.ceil(motion.duration * FOOT_RATE - 1e-6)) + 1
    times = np.arange(count) / FOOT_RATE
    turned, at = skeleton.globals(motion.pose_at(times))
    half = 0.5 / FOOT_RATE
    ends = np.clip(np.stack([times - half, times + half]), 0.0, motion.duration)
    sides = [skeleton.globals(motion.pose_at(end))[1].astype(float) for end in ends]
    apart = np.maximum(ends[1] - ends[0], 1e-6)
    out = np.zeros((count, 2 * FOOT_NUMBERS))
    for side, leg in enumerate(rig.body.arms):
        foot = rig.body.joints[leg.hand]
        toes = roles.get(f"{('left', 'right')[side]}_toes", foot)
        speed = np.max([np.linalg.norm(sides[1][:, j] - sides[0][:, j], axis=-1) for j in (foot, toes)], 0)
        still = speed / apart < STANDS * rig.height
        still &= np.append(still[1:], True) & np.insert(still[:-1], 0, True)
        n = FOOT_NUMBERS * side
        out[:, n] = still
        out[:, n + 1 : n + 4] = at[:, foot]
        out[:, n + 4 : n + 8] = rotation.make_continuous(turned[:, foot].astype(float))
    found = np.round(out / FOOT_UNIT)
    if (np.ptp(found, axis=0) <= SAME).all():
        found = found[:1]
    return tuple(tuple(row) for row in found.tolist())


class FeetOfPlan:
    """Says where the feet should be in a plan."""

    def __init__(self, rows: Any, height: float, layer: Layer) -> None:
        self.rows, self.height, self.layer = rows, height, layer
        self.tracks: dict[str, FootTrack] = {}

    def goals(self, plan: Plan, project: Project, time: float) -> list[FootGoal]:
        """Return where both feet should be at a time; an empty list if nothing blends."""
        layer = plan.layers[self.layer]
        if not layer.rests:
            return []
        cue = layer.cue_at(time)
        if cue is not None and get_action_motion(project, cue.action) is None:
            cue = None
        place = max(int(layer.fade_starts.searchsorted(time, "right")) - 1, 0)
        nearby = range(max(0, place - 4), min(len(layer.rests), place + 5))
        for action in [layer.rests[n].action for n in nearby] + ([cue.action] if cue is not None else []):
            if action.id not in self.tracks:
                self.tracks[action.id] = FootTrack(self.rows(project, action.clip))
        return foot_goals(project, self.tracks, self.height, layer, cue, place, time)
