"""The solvers of contacts, weight and planted feet as compiled loops. Importing this imports numba.

They are compiled from the very functions of `contact_solve`, `weight_solve` and `feet_solve`, which are
written in plain numbers for all languages; what is here only hands them arrays. Results are the same to the
last bit, but for how `sin` and `cos` are rounded.
"""

from __future__ import annotations

from collections import namedtuple
from collections.abc import Callable
from typing import Any

import numpy as np

from metagraph.compiling import compiled_from, compiler, stamp
from metagraph.motion import contact_solve, feet_solve, plain_vectors, weight_solve

Array = Any
Number = Any

KEPT = "hold_hands", "carry_weight"
SOURCES = (plain_vectors, contact_solve, weight_solve, feet_solve)

_OPTIONS: dict[str, Any] = {"nogil": True, "error_model": "numpy"}
_inside = compiler(keep=False, **_OPTIONS)  # kept as part of what calls them


# --- what numba does not know, in other words: dataclasses, generators and fields that are set

_Arm = namedtuple("_Arm", "upper lower hand below")
_Capsule = namedtuple("_Capsule", "joint a to b radius arm kind")
_Body = namedtuple("_Body", "parents arms capsules guard")
_HandGoal = namedtuple("_HandGoal", "arm to at turn weight")
_Pose = namedtuple("_Pose", "local moved turned at")
_Bend = namedtuple("_Bend", "place left up ahead share")
_Collar = namedtuple("_Collar", "place upper axis side")
_Rig = namedtuple("_Rig", "body bends collars knees levers up height strength")
_FootGoal = namedtuple("_FootGoal", "at turn planted lift")


def _on_arm(rig: Any, place: int, arm: int) -> bool:
    found = False
    for below in rig.arms[arm].below:
        found |= place == below
    return found


def _moves_body(drive: Any) -> bool:
    found = False
    for x in drive:
        found |= x != 0.0
    return found


def _spread(rig: Any, pose: Any) -> None:
    for place in range(len(rig.parents)):
        _join(rig, pose, place)  # type: ignore[name-defined]  # noqa: F821 - of the module it stands in for


_OTHERWISE: dict[Any, Any] = {
    contact_solve._on_arm: _on_arm,
    weight_solve.moves_body: _moves_body,
    contact_solve.spread: _spread,
}


_made = compiled_from(SOURCES, _OTHERWISE, _inside)
_join_all = _made[contact_solve.__name__]["spread"]
_solve_contacts = _made[contact_solve.__name__]["solve_contacts"]
_answer_arms = _made[weight_solve.__name__]["answer_arms"]
_plant_feet = _made[feet_solve.__name__]["plant_feet"]


@_inside
def _vector(row: Array, first: int) -> Any:
    return (row[first], row[first + 1], row[first + 2])


@_inside
def _turn(row: Array, first: int) -> Any:
    return (row[first], row[first + 1], row[first + 2], row[first + 3])


@_inside
def _body_of(
    parents: Array, arms: Array, below: Array, capsule_places: Array, capsules: Array, guard: bool
) -> Any:
    made_arms = [
        _Arm(arms[n, 0], arms[n, 1], arms[n, 2], below[arms[n, 3] : arms[n, 4]]) for n in range(len(arms))
    ]
    parts = [
        _Capsule(
            capsule_places[n, 0],
            _vector(capsules[n], 0),
            capsule_places[n, 1],
            _vector(capsules[n], 3),
            capsules[n, 6],
            capsule_places[n, 2],
            capsule_places[n, 3],
        )
        for n in range(len(capsules))
    ]
    return _Body(parents, made_arms, parts, guard)


@_inside
def _pose_of(joints: Array, rotations: Array, translations: Array) -> Any:
    turns, places = rotations.astype(np.float64), translations.astype(np.float64)
    local = [_turn(turns[j], 0) for j in joints]
    moved = [_vector(places[j], 0) for j in joints]
    return _Pose(local, moved, local.copy(), moved.copy())


@_inside
def _put(rotations: Array, joint: int, turn: Any) -> None:
    x, y, z, w = turn
    size = np.sqrt(x * x + y * y + z * z + w * w)
    if size > 1e-12:
        x, y, z, w = x / size, y / size, z / size, w / size
    else:
        x, y, z, w = 0.0, 0.0, 0.0, 1.0
    rotations[joint, 0], rotations[joint, 1], rotations[joint, 2], rotations[joint, 3] = x, y, z, w


def _drivers(said: int) -> tuple[Callable[..., Any], Callable[..., Any]]:
    """Return what is called from without. said: `stamp` of the sources, part of what numba keeps them
    under.
    """
    compiled = compiler(**_OPTIONS)

    @compiled
    def hold_hands(
        joints: Array,
        parents: Array,
        arms: Array,
        below: Array,
        capsule_places: Array,
        capsules: Array,
        guard: bool,
        goal_at: Array,
        goal_places: Array,
        goals: Array,
        rotations: Array,
        translations: Array,
    ) -> int:
        """Bring hands of poses to their goals and out of the body, in place; return of how many.

        joints, parents `[n]`, arms `[2, 5]` (upper, lower, hand, slice of below), capsule_places `[C, 4]`
        (joint, to, arm, kind), capsules `[C, 7]` (a, b, radius): the rig's. goal_at `[N + 1]`: each pose's
        goals: goal_places `[G, 2]` (arm, to), goals `[G, 8]` (at, turn, weight). rotations `[N, J, 4]`,
        translations `[N, J, 3]`.
        """
        count = 0 * said
        body = _body_of(parents, arms, below, capsule_places, capsules, guard)
        for n in range(len(rotations)):
            pose = _pose_of(joints, rotations[n], translations[n])
            _join_all(body, pose)
            wanted = [
                _HandGoal(
                    goal_places[k, 0],
                    goal_places[k, 1],
                    _vector(goals[k], 0),
                    _turn(goals[k], 3),
                    goals[k, 7],
                )
                for k in range(goal_at[n], goal_at[n + 1])
            ]
            if _solve_contacts(body, pose, wanted):
                count += 1
                for arm in body.arms:
                    for place in (arm.upper, arm.lower, arm.hand):
                        _put(rotations[n], joints[place], pose.local[place])
        return count

    @compiled
    def carry_weight(
        joints: Array,
        parents: Array,
        arms: Array,
        below: Array,
        capsule_places: Array,
        capsules: Array,
        guard: bool,
        bend_places: Array,
        bends: Array,
        collar_places: Array,
        collars: Array,
        sides: Array,
        figure: Array,
        feet: Array,
        planted: Number,
        drives: Array,
        follow: Array,
        lift: Array,
        rotations: Array,
        translations: Array,
    ) -> int:
        """Let feet stay planted and bodies answer their arms, in place; return in how many poses.

        bend_places `[B]`, bends `[B, 10]` (left, up, ahead, share), collar_places `[Q, 3]` (place, upper,
        side), collars `[Q, 3]`, sides `[2, 5]` (knee, lever), figure `[5]` (up, height, strength): the rig's.
        feet `[N, 2, 9]` (at, turn, planted, lift), nan where there is no goal; planted: the dial. drives `[N,
        16]`, follow, lift `[N]`: the dials, both 0 where arms are not answered.
        """
        count = 0 * said
        body = _body_of(parents, arms, below, capsule_places, capsules, guard)
        rig = _Rig(
            body,
            [
                _Bend(
                    bend_places[n],
                    _vector(bends[n], 0),
                    _vector(bends[n], 3),
                    _vector(bends[n], 6),
                    bends[n, 9],
                )
                for n in range(len(bends))
            ],
            [
                _Collar(collar_places[n, 0], collar_places[n, 1], _vector(collars[n], 0), collar_places[n, 2])
                for n in range(len(collars))
            ],
            [_vector(sides[n], 0) for n in range(2)],
            [(sides[n, 3], sides[n, 4]) for n in range(2)],
            _vector(figure, 0),
            figure[3],
            figure[4],
        )
        hips = bend_places[0]
        for n in range(len(rotations)):
            pose = _pose_of(joints, rotations[n], translations[n])
            goals = [
                _FootGoal(_vector(feet[n, k], 0), _turn(feet[n, k], 3), feet[n, k, 7], feet[n, k, 8])
                for k in range(0 if np.isnan(feet[n, 0, 0]) else 2)
            ]
            changed = _plant_feet(rig, pose, goals, planted)
            if _answer_arms(rig, pose, drives[n], follow[n], lift[n]):
                changed = True
            if changed:
                count += 1
                for place in range(len(joints)):
                    _put(rotations[n], joints[place], pose.local[place])
                x, y, z = pose.moved[hips]
                j = joints[hips]
                translations[n, j, 0], translations[n, j, 1], translations[n, j, 2] = x, y, z
        return count

    return hold_hands, carry_weight


hold_hands, carry_weight = _drivers(stamp(SOURCES))


def warm() -> None:
    """Have ready what is called with float32 poses."""
    turns, places = np.zeros((0, 1, 4), np.float32), np.zeros((0, 1, 3), np.float32)
    none, row, numbers = np.zeros(0, np.int64), np.zeros((0, 5), np.int64), np.zeros((0, 8))
    body = none, none, row, none, row, numbers, True
    hold_hands(*body, np.zeros(1, np.int64), row, numbers, turns, places)
    bends = np.zeros(1, np.int64), numbers, row, numbers, np.zeros((2, 5)), np.zeros(5)
    carry_weight(*body, *bends, np.zeros((0, 2, 9)), 0.0, numbers, np.zeros(0), np.zeros(0), turns, places)
