from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from metagraph.motion import rotation
from metagraph.motion.contact_solve import (
    FOREARM,
    BodyCapsule,
    ContactArm,
    ContactPose,
    ContactRig,
    HandGoal,
    apart,
    solve_contacts,
    spread,
)
from metagraph.motion.plain_vectors import between

STILL = (0.0, 0.0, 0.0, 1.0)
# A trunk, and two arms of 0.3 + 0.25 m that hang a little bent.
NAMES = ("Hips", "Chest", "LUpper", "LLower", "LHand", "RUpper", "RLower", "RHand")
PARENTS = (-1, 0, 1, 2, 3, 1, 5, 6)
AT = (
    (0.0, 1.0, 0.0), (0.0, 0.3, 0.0),
    (0.2, 0.1, 0.0), (0.0, -0.3, -0.02), (0.0, -0.25, 0.08),
    (-0.2, 0.1, 0.0), (0.0, -0.3, -0.02), (0.0, -0.25, 0.08),
)  # fmt: skip
TRUNK = BodyCapsule(1, (0.0, 0.0, 0.0), 0, (0.0, 0.0, 0.0), 0.12)


def rig(*capsules: BodyCapsule, guard: bool = False) -> ContactRig:
    arms = ContactArm(2, 3, 4, (2, 3, 4)), ContactArm(5, 6, 7, (5, 6, 7))
    places = {name: n for n, name in enumerate(NAMES)}
    return ContactRig(tuple(range(8)), PARENTS, places, arms, ("LHand", "RHand"), capsules, True, guard)


def posed(one: ContactRig, **turns: tuple[float, float, float]) -> ContactPose:
    local = [tuple(rotation.exp(np.array(turns.get(name, (0.0, 0.0, 0.0)))).tolist()) for name in NAMES]
    out = ContactPose(local, list(AT))  # type: ignore[arg-type]
    spread(one, out)
    return out


def forearms(radius: float = 0.04) -> list[BodyCapsule]:
    ends = ((3, 4), (6, 7))
    none = (0.0, 0.0, 0.0)
    return [BodyCapsule(a, none, b, none, radius, n, FOREARM) for n, (a, b) in enumerate(ends)]


def test_nothing_changes_without_goals_or_where_nothing_is_inside() -> None:
    one = rig(TRUNK, *forearms(), guard=True)
    pose = posed(one)
    before = list(pose.local)
    assert not solve_contacts(one, pose, [])
    assert pose.local == before


def test_a_hand_comes_to_its_goal_on_a_joint_that_has_moved_and_turned() -> None:
    one = rig()
    pose = posed(one, Chest=(0.3, 0.2, 0.0), LUpper=(-1.0, 0.3, 0.0))
    turn = tuple(rotation.multiply(rotation.conjugate(pose.turned[1]), pose.turned[4]).tolist())
    goal = HandGoal(0, 1, (0.1, -0.1, 0.25), turn, 1.0)  # type: ignore[arg-type]
    assert solve_contacts(one, pose, [goal])
    spread(one, pose)
    wanted = np.array(pose.at[1]) + rotation.rotate_vectors(np.array(pose.turned[1]), np.array(goal.at))
    assert_allclose(pose.at[4], wanted, atol=1e-9)
    assert rotation.measure_angle_between(pose.turned[4], rotation.multiply(pose.turned[1], goal.turn)) < 1e-6


def test_half_a_contact_brings_a_hand_half_the_way() -> None:
    one = rig()
    pose = posed(one, LUpper=(-1.0, 0.3, 0.0))
    before, goal = np.array(pose.at[4]), HandGoal(0, 1, (0.15, -0.1, 0.25), STILL, 0.5)
    solve_contacts(one, pose, [goal])
    assert_allclose(pose.at[4], before + 0.5 * (np.array(pose.at[1]) + goal.at - before), atol=1e-9)


def test_an_elbow_is_never_quite_straight_nor_folded_further_than_it_goes() -> None:
    one = rig()
    for at, least, most in (((0.2, -3.0, 0.0), 0.0, 0.9951), ((0.2, 0.1, 0.001), 0.2, 1.0)):
        pose = posed(one)
        solve_contacts(one, pose, [HandGoal(0, 1, at, STILL, 1.0)])
        reach = np.linalg.norm(np.subtract(pose.at[4], pose.at[2]))
        arm = np.linalg.norm(AT[3]) + np.linalg.norm(AT[4])
        assert least * arm < reach < most * arm


def test_a_hand_on_the_other_follows_where_that_one_is_brought() -> None:
    one = rig()
    pose = posed(one, LUpper=(-1.0, -0.6, 0.0), RUpper=(-1.0, 0.6, 0.0))
    goals = [HandGoal(1, 4, (0.0, 0.0, 0.05), STILL, 1.0), HandGoal(0, 1, (0.05, -0.1, 0.3), STILL, 1.0)]
    solve_contacts(one, pose, goals)
    wanted = np.array(pose.at[4]) + rotation.rotate_vectors(
        np.array(pose.turned[4]), np.array([0.0, 0.0, 0.05])
    )
    assert_allclose(pose.at[7], wanted, atol=1e-6)


def test_a_forearm_in_the_trunk_is_brought_out_and_only_that() -> None:
    one = rig(TRUNK, *forearms(), guard=True)
    pose = posed(one, LLower=(-0.3, 0.0, -0.7))
    right = pose.local[5:]
    assert _depth(one, pose) > 0.02
    assert solve_contacts(one, pose, [])
    assert _depth(one, pose) < 0.006
    assert pose.local[5:] == right


def test_hands_in_each_other_give_way_both() -> None:
    one = rig(*forearms(), guard=True)
    pose = posed(one, LUpper=(-1.0, -0.9, 0.0), RUpper=(-1.1, 0.9, 0.0))
    before = list(pose.at)
    assert solve_contacts(one, pose, [])
    assert all(np.linalg.norm(np.subtract(before[n], pose.at[n])) > 1e-3 for n in (4, 7))


def test_a_hand_that_is_held_is_not_pushed() -> None:
    one = rig(TRUNK, *forearms(), guard=True)
    pose = posed(one, LLower=(-0.3, 0.0, -0.7))
    turn = tuple(rotation.multiply(rotation.conjugate(pose.turned[1]), pose.turned[4]).tolist())
    at = rotation.rotate_vectors(rotation.conjugate(pose.turned[1]), np.subtract(pose.at[4], pose.at[1]))
    wrist = pose.at[4]
    solve_contacts(one, pose, [HandGoal(0, 1, tuple(at.tolist()), turn, 1.0)])  # type: ignore[arg-type]
    assert_allclose(pose.at[4], wrist, atol=1e-9)


def test_the_guard_is_smooth() -> None:
    one = rig(TRUNK, *forearms(), guard=True)
    wrists = []
    for angle in np.linspace(0.0, 0.8, 801):
        pose = posed(one, LLower=(-0.3, 0.0, -float(angle)))
        solve_contacts(one, pose, [])
        wrists.append(pose.at[4])
    steps = np.linalg.norm(np.diff(np.array(wrists), axis=0), axis=1)
    assert steps.max() < 5 * 0.55 * 0.001


@pytest.mark.nightly
def test_an_arm_that_goes_through_the_body_does_not_jump_out_on_the_other_side() -> None:
    one = rig(TRUNK, *forearms(), guard=True)
    for straight in np.linspace(-0.3, 0.3, 7):
        before, after = [], []
        for angle in np.linspace(0.0, 2.4, 1201):
            pose = posed(one, LUpper=(0.0, 0.0, -float(angle)), LLower=(float(straight), 0.0, 0.0))
            before.append(pose.at[4])
            solve_contacts(one, pose, [])
            after.append(pose.at[4])
        moved, shown = (np.linalg.norm(np.diff(x, axis=0), axis=1) for x in (before, after))
        assert shown.max() < 2.5 * moved.max()


def test_a_touch_of_the_other_arm_that_begins_does_not_undo_the_guard() -> None:
    one = rig(TRUNK, *forearms(), guard=True)
    wrists = []
    for weight in (0.0, 1e-5):
        pose = posed(one, LLower=(-0.3, 0.0, -0.7))
        solve_contacts(one, pose, [HandGoal(0, 6, (0.0, -0.1, 0.05), STILL, weight)])
        wrists.append(pose.at[4])
    assert_allclose(wrists[0], wrists[1], atol=1e-4)


@pytest.mark.parametrize("seed", range(20))
def test_the_shortest_way_between_lines_is_the_least_of_many(seed: int) -> None:
    chance = np.random.default_rng(seed)
    ends = [tuple(x) for x in chance.normal(0, 1, (4, 3)).tolist()]
    if seed == 0:
        ends[1] = ends[0]
    if seed == 1:
        ends[3] = tuple(np.add(ends[2], np.subtract(ends[1], ends[0])).tolist())
    x, y, z, gap = apart(ends, 0, 2)  # type: ignore[arg-type]
    parts = np.linspace(0, 1, 201)[:, None]
    a, b, c, d = (np.array(e) for e in ends)
    far = np.linalg.norm((a + (b - a) * parts)[:, None] - (c + (d - c) * parts)[None], axis=-1)
    assert gap == pytest.approx(np.linalg.norm((x, y, z)))
    assert gap <= far.min() + 1e-9 and gap > far.min() - 0.02


def test_opposite_directions_are_half_a_turn_apart() -> None:
    for v in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.6, -0.8)):
        turned = rotation.rotate_vectors(np.array(between(v, tuple(-x for x in v))), np.array(v))  # type: ignore[arg-type]
        assert_allclose(turned, np.negative(v), atol=1e-9)


def test_a_switch_turns_the_guard_off() -> None:
    one = replace(rig(TRUNK, *forearms(), guard=True), guard=False)
    assert not solve_contacts(one, posed(one, LLower=(-0.3, 0.0, -0.7)), [])


def _depth(one: ContactRig, pose: ContactPose) -> float:
    from metagraph.motion.contact_solve import capsule_ends

    ends = capsule_ends(one, pose)
    gap = apart(ends, 2, 0)[3]
    return one.capsules[0].radius + one.capsules[1].radius - gap
