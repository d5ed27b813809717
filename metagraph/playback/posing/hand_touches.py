"""Find where contacts keep the hands at a time, and how far the hands are from there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph.model import LAYERS, Layer, Project
from metagraph.motion import rotation
from metagraph.motion.contact_solve import ContactRig, HandGoal
from metagraph.playback.plan import Cue, LayerPlan, Plan
from metagraph.playback.posing.contacts import find_hand_goals
from metagraph.playback.posing.rigs import get_rigs

Array = NDArray[Any]

WHOLE = 0.99  # weight from which on a contact should be met
MISSED = 0.01  # metres from which on a hand misses its contact


@dataclass(frozen=True, slots=True)
class HandTouch:
    """A hand that a contact keeps somewhere.

    `side` is 0 for left, 1 for right. `hand` and `to` are the joints of the hand and of what it touches.
    `weight` is how much of the contact shows, 0..1. `away` is the distance of the wrist from where it should
    be, in metres.
    """

    side: int
    hand: int
    to: int
    weight: float
    away: float

    @property
    def held(self) -> bool:
        """Return whether the hand has arrived and not yet begun to leave."""
        return self.weight >= WHOLE

    @property
    def missed(self) -> bool:
        """Return whether the hand should be there and is not."""
        return self.held and self.away >= MISSED


def find_hand_touches(
    plan: Plan, project: Project, seconds: float, rotations: Array, positions: Array
) -> list[HandTouch]:
    """Return the contacts of a plan at a time, left hand first, one for each hand and joint it touches.

    `rotations` `[J, 4]` and `positions` `[J, 3]` are the visible pose in model space, in metres. The list is
    empty if the project has its contacts off, or does not have two arms.
    """
    rig = get_rigs(project).contacts if project.skeleton is not None else None
    if rig is None or not rig.contacts:
        return []
    found: dict[tuple[int, int], list[HandGoal]] = {}
    for goal in find_hand_goals(plan, project, rig, seconds):
        found.setdefault((goal.arm, goal.to), []).append(goal)
    return [_touch(rig, goals, rotations, positions) for _, goals in sorted(found.items())]


def _touch(rig: ContactRig, goals: Sequence[HandGoal], rotations: Array, positions: Array) -> HandTouch:
    strongest = max(goals, key=lambda g: g.weight)
    hand, to = rig.joints[rig.arms[strongest.arm].hand], rig.joints[strongest.to]
    wanted = positions[to] + rotation.rotate_vectors(np.asarray(rotations[to], float), np.array(strongest.at))
    away = float(np.linalg.norm(positions[hand] - wanted))
    return HandTouch(strongest.arm, hand, to, min(1.0, sum(g.weight for g in goals)), away)


def plan_of_clip(project: Project, clip: str) -> Plan:
    """Return a plan that plays the first use with contacts of a clip on each layer unchanged: its seconds are
    the clip's.
    """
    layers: dict[Layer, LayerPlan] = {layer: LayerPlan(layer) for layer in LAYERS}
    length = project.clips[clip].duration
    for action in project.uses.get(clip, ()):
        if action.contacts and not layers[action.layer].cues:
            start, end = project.span(action)
            cue = Cue(action, start, end, start, 0.0, 0.0, action.stance, action.stance, "")
            layers[action.layer] = LayerPlan(action.layer, cues=(cue,))
    return Plan(0, length, layers)
