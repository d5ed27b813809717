"""Return poses of a plan with one call, for scripts: those that others wrote ask for poses by these names.
Code of our own keeps an evaluator for each plan.
"""

from __future__ import annotations

from typing import Any

from metagraph.graph.model import Project
from metagraph.motion.skeleton import Pose
from metagraph.playback.evaluator import Evaluator
from metagraph.playback.plan import Plan

_latest: list[Evaluator] = []  # of the latest plan, which is usually the next one, too


def pose_at(plan: Plan, project: Project, seconds: Any, alive: bool = True) -> Pose:
    """Return the composed pose at `seconds`, a number or an array `[...]`: rotations `[..., J, 4]` xyzw,
    translations `[..., J, 3]` metres.

    With `alive`, life is added as the project has it set. Raises ValueError if the project has no skeleton.
    """
    return _evaluator(plan, project).at(seconds, alive)


def compute_morphs_at(
    plan: Plan, project: Project, seconds: float, alive: bool = True, composed: Pose | None = None
) -> dict[str, float]:
    """Return morph target weights, 0..1, at one time.

    `composed` is the pose `[J]` before life, if it differs from the plan's. Raises ValueError as
    `pose_at` does.
    """
    return _evaluator(plan, project).morphs_at(seconds, alive, composed)


def _evaluator(plan: Plan, project: Project) -> Evaluator:
    known = next(iter(_latest), None)
    found = known.follow(plan, project) if known is not None else Evaluator(plan, project)
    _latest[:] = [found]
    return found
