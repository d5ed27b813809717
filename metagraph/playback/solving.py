"""The solvers of contacts and weight for arrays of poses: their compiled loops, once those are loaded."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.compiling import Loops, plain
from metagraph.motion.contact_solve import ContactRig, HandGoal
from metagraph.motion.feet_solve import FootGoal
from metagraph.motion.skeleton import Pose
from metagraph.motion.weight_solve import WeightRig

Array = NDArray[Any]

COMPILED = Loops("metagraph.motion.solve_kernels")


class _ByIdentity:
    """A rig, to be known again: rigs are compared part by part."""

    def __init__(self, rig: Any) -> None:
        self.rig = rig

    def __hash__(self) -> int:
        return id(self.rig)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _ByIdentity) and other.rig is self.rig


def compiled(pose: Pose) -> bool:
    """Whether the loops are loaded, and are for poses of this kind."""
    return COMPILED.now is not None and pose.rotations.dtype == pose.translations.dtype == np.float32


def hold_hands(pose: Pose, rig: ContactRig, goals: Sequence[Sequence[HandGoal]]) -> Pose:
    """Return poses `[N, J]` with hands at their goals, of each pose its own, and out of the body; the very
    same where nothing moves.
    """
    at, places, numbers = _NOWHERE, _NO_PLACES, _NO_GOALS
    if any(goals):
        at = np.cumsum([0, *(len(some) for some in goals)])
        places = np.array([(g.arm, g.to) for some in goals for g in some], np.int64)
        numbers = np.array([(*g.at, *g.turn, g.weight) for some in goals for g in some], np.float64)
    elif len(goals) > 1:
        at = np.zeros(len(goals) + 1, np.int64)
    rotations = np.array(pose.rotations, order="C")
    translations = plain(pose.translations)
    body = _body(_ByIdentity(rig))
    if not COMPILED.now.hold_hands(*body, at, places, numbers, rotations, translations):
        return pose
    return Pose(rotations, pose.translations)


def carry_weight(
    pose: Pose,
    rig: WeightRig,
    feet: Sequence[Sequence[FootGoal]],
    planted: float,
    drives: Sequence[Sequence[float]],
    follow: Sequence[float],
    lift: Sequence[float],
) -> Pose:
    """Return poses `[N, J]` whose feet are at their goals, as much as `planted` says, and whose bodies answer
    drives `[N, 16]` as much as `follow [N]` and `lift [N]` say; the very same where nothing moves.
    """
    goals = np.full((len(feet), 2, 9), np.nan)
    for n, some in enumerate(feet):
        for side, goal in enumerate(some):
            goals[n, side] = (*goal.at, *goal.turn, goal.planted, goal.lift)
    rotations = np.array(pose.rotations, order="C")
    translations = np.array(pose.translations, order="C")
    amounts = np.array(drives, np.float64), np.array(follow, np.float64), np.array(lift, np.float64)
    given = (*_weight(_ByIdentity(rig)), goals, float(planted), *amounts)
    changed = COMPILED.now.carry_weight(*given, rotations, translations)
    return Pose(rotations, translations) if changed else pose


_NOWHERE = np.zeros(2, np.int64)
_NO_PLACES = np.zeros((0, 2), np.int64)
_NO_GOALS = np.zeros((0, 8))


@lru_cache(maxsize=16)
def _body(of: _ByIdentity) -> tuple[Any, ...]:
    return _laid_out(of.rig)


def _laid_out(rig: ContactRig) -> tuple[Any, ...]:
    """Return a rig as `solve_kernels` takes it."""
    arms: list[tuple[int, ...]] = []
    below: list[int] = []
    for arm in rig.arms:
        arms.append((arm.upper, arm.lower, arm.hand, len(below), len(below) + len(arm.below)))
        below += arm.below
    parts = [(c.joint, c.to, c.arm, c.kind) for c in rig.capsules]
    return (
        np.array(rig.joints, np.int64),
        np.array(rig.parents, np.int64),
        np.array(arms, np.int64).reshape(-1, 5),
        np.array(below, np.int64),
        np.array(parts, np.int64).reshape(-1, 4),
        np.array([(*c.a, *c.b, c.radius) for c in rig.capsules], np.float64).reshape(-1, 7),
        rig.guard,
    )


@lru_cache(maxsize=16)
def _weight(of: _ByIdentity) -> tuple[Any, ...]:
    rig: WeightRig = of.rig
    bends = [(*b.left, *b.up, *b.ahead, b.share) for b in rig.bends]
    return (
        *_laid_out(rig.body),
        np.array([b.place for b in rig.bends], np.int64),
        np.array(bends, np.float64).reshape(-1, 10),
        np.array([(c.place, c.upper, c.side) for c in rig.collars], np.int64).reshape(-1, 3),
        np.array([c.axis for c in rig.collars], np.float64).reshape(-1, 3),
        np.array([(*knee, *lever) for knee, lever in zip(rig.knees, rig.levers, strict=True)], np.float64),
        np.array([*rig.up, rig.height, rig.strength], np.float64),
    )
