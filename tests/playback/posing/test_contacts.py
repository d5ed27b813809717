"""Hands in contact and out of the body, in whole performances of the sample."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from metagraph.formats.store import open_project
from metagraph.graph.model import Project
from metagraph.graph.requests import make_request
from metagraph.motion import rotation
from metagraph.motion.contact_solve import ContactPose, apart, capsule_ends, solve_contacts, spread
from metagraph.motion.skeleton import Pose
from metagraph.playback.evaluator import Evaluator
from metagraph.playback.plan import Plan
from metagraph.playback.planner import make_plan
from metagraph.playback.planning.running_plan import plan_performance
from metagraph.playback.posing.contacts import (
    find_hand_goals,
    find_inside,
    find_nearest_between_lines,
    list_capsule_pairs,
    measure_contact_depths,
)
from tests.posing import contact_rig, pose_at

SAMPLE = Path(__file__).resolve().parents[3] / "sample_clips" / "sample.metagraph.yaml"
TIMES = np.arange(0.0, 240.0, 0.41)


@lru_cache(maxsize=1)
def sample() -> Project:
    return open_project(SAMPLE).project


@lru_cache(maxsize=1)
def plan() -> Plan:
    return make_plan(sample(), 240.0, seed=4)


def switched(**changes: bool) -> Project:
    return replace(sample(), touch=msgspec.structs.replace(sample().touch, **changes))


def plain() -> Pose:
    return pose_at(plan(), switched(contacts=False, guard=False), TIMES)


def test_hands_that_are_held_are_where_contacts_say() -> None:
    project = switched(guard=False)
    rig = contact_rig(project)
    assert rig is not None and project.skeleton is not None
    pose = pose_at(plan(), project, TIMES)
    turned, at = project.skeleton.globals(pose)
    joints, found = list(rig.joints), 0
    for n, time in enumerate(TIMES.tolist()):
        for goal in find_hand_goals(plan(), project, rig, time):
            if goal.weight < 0.9999:
                continue
            to, hand = joints[goal.to], joints[rig.arms[goal.arm].hand]
            wanted = at[n, to] + rotation.rotate_vectors(turned[n, to], np.array(goal.at))
            found += 1
            assert np.linalg.norm(at[n, hand] - wanted) < 0.003
    assert found > 30


@pytest.mark.nightly
def test_the_guard_brings_hands_out_of_the_body() -> None:
    rig = contact_rig(sample())
    assert rig is not None
    before, after = (
        measure_contact_depths(rig, plain()).max(-1),
        measure_contact_depths(rig, pose_at(plan(), sample(), TIMES)).max(-1),
    )
    assert (after > 0.005).mean() < 0.35 * (before > 0.005).mean()
    assert np.percentile(after, 95) < 0.006 < np.percentile(before, 95)


@pytest.mark.nightly
def test_nothing_but_arms_moves_and_only_in_their_upper_lower_and_hand_joints() -> None:
    rig = contact_rig(sample())
    assert rig is not None
    arms = {rig.joints[p] for arm in rig.arms for p in (arm.upper, arm.lower, arm.hand)}
    after, before = pose_at(plan(), sample(), TIMES), plain()
    others = [j for j in range(after.rotations.shape[1]) if j not in arms]
    assert_array_equal(after.rotations[:, others], before.rotations[:, others])
    assert_array_equal(after.translations, before.translations)


@pytest.mark.nightly
def test_off_by_its_switches_poses_are_those_of_a_project_without_contacts_to_the_bit() -> None:
    graph = sample().graphs["arms"]
    bare = graph.with_actions({a.id: replace(a, contacts=()) for a in graph.actions.values()})
    without = replace(sample().with_graph(bare), touch=msgspec.structs.replace(sample().touch, guard=False))
    assert_array_equal(pose_at(plan(), without, TIMES).rotations, plain().rotations)


def test_poses_are_the_same_one_by_one_and_all_at_once() -> None:
    some = TIMES[::40]
    many = pose_at(plan(), sample(), some)
    for n, time in enumerate(some.tolist()):
        assert_allclose(pose_at(plan(), sample(), time).rotations, many.rotations[n], atol=1e-6)


@pytest.mark.nightly
def test_arrays_are_told_to_be_inside_exactly_where_one_pose_after_the_other_would_be_moved() -> None:
    rig = contact_rig(sample())
    assert rig is not None
    pose = plain()
    told = find_inside(rig, pose)
    first, second, _ = list_capsule_pairs(rig)
    for n in range(0, len(TIMES), 7):
        one = _one(rig, pose, n)
        assert solve_contacts(rig, one, []) == told[n] or measure_contact_depths(rig, pose)[n].max() < 1e-6
        ends = capsule_ends(rig, _one(rig, pose, n))
        a, b, c, d = (np.array([ends[2 * i + k] for i in some]) for some in (first, second) for k in (0, 1))
        way, _ = find_nearest_between_lines(a, b, c, d)
        ours = [apart(ends, 2 * i, 2 * k) for i, k in zip(first, second, strict=True)]
        assert_allclose(np.linalg.norm(way, axis=-1), [o[3] for o in ours], atol=1e-6)
        assert_allclose(way, [o[:3] for o in ours], atol=1e-6)


def test_a_skeleton_without_arms_is_left_alone() -> None:
    project = replace(sample(), roles={"left_hand": "nothing", "right_hand": "nothing"})
    assert contact_rig(project) is None
    life = msgspec.structs.replace(sample().life, follow_through=0, shoulder_lift=0)  # nor does a body answer
    stiff = replace(switched(contacts=False, guard=False), life=life)
    expected = pose_at(plan(), stiff, TIMES[:9]).rotations
    assert_array_equal(pose_at(plan(), project, TIMES[:9]).rotations, expected)


@pytest.mark.parametrize("joint", ["Hips", "LeftUpperArm"])
def test_contacts_with_a_joint_that_is_gone_are_passed_over(joint: str) -> None:
    graph = sample().graphs["arms"]
    lost = {
        a.id: replace(a, contacts=tuple(replace(s, to="gone" if s.to == joint else s.to) for s in a.contacts))
        for a in graph.actions.values()
    }
    project = sample().with_graph(graph.with_actions(lost))
    assert np.isfinite(pose_at(plan(), project, TIMES[::20]).rotations).all()


def _one(rig: Any, pose: Pose, n: int) -> ContactPose:
    joints = list(rig.joints)
    out = ContactPose(
        [tuple(q) for q in pose.rotations[n, joints].tolist()],
        [tuple(v) for v in pose.translations[n, joints].tolist()],
    )
    spread(rig, out)
    return out


def test_clasped_hands_do_not_tremble_in_a_bowed_body() -> None:
    """Sadness brings them into the hips while one holds the other: they are pushed out as steadily as the
    clips move them.
    """
    project = sample()
    skeleton, arms = project.skeleton, project.graphs["arms"]
    assert skeleton is not None
    clasped = next(i for i, s in arms.stances.items() if s.name == "hands clasped")
    gestures = arms.of(clasped, "gesture")
    asks: list[dict[str, Any]] = [
        {"do": "mood", "mood": "sad", "id": "mood", "at": 0.0},
        {"do": "stance", "stance": clasped, "stay": True, "id": "stay", "at": 0.0},
        *({"do": "action", "action": g.id, "id": g.id, "at": 6.0 * n + 5.0} for n, g in enumerate(gestures)),
    ]
    end = 6.0 * len(gestures) + 5.0
    made = plan_performance(project, [make_request(x) for x in asks], end, 1, idle=False)
    assert len(made.layers["arms"].cues) == len(gestures) + 1
    times = np.arange(3.0, end, 1 / 60)
    poses = dict(Evaluator(made, project).stages(times))
    hands = [skeleton.index(f"{side}Hand") for side in ("Left", "Right")]

    def shakes(stage: str) -> Any:
        at = skeleton.globals(poses[stage])[1][:, hands]
        return np.linalg.norm(np.diff(at, 2, axis=0), axis=-1) * 3600  # m/s2

    assert np.percentile(shakes("contacts"), 99) < np.percentile(shakes("life"), 99) + 15.0
    assert shakes("contacts").mean() < 2.0 * shakes("life").mean()


def test_a_hand_that_passes_through_a_thigh_does_not_jerk() -> None:
    """In a body that leans, the hand that pointed at the chest goes back through the thigh."""
    project = sample()
    skeleton, body = project.skeleton, project.graphs["body"]
    assert skeleton is not None
    leaning = next(i for i, s in body.stances.items() if s.name == "lean forward")
    points = next(a for a in project.graphs["arms"].actions.values() if a.name == "point_me_rt_01")
    presses = next(a for a in body.actions.values() if a.name == "press_in_01")
    asks = [{"do": "action", "action": a.id, "id": a.id, "at": 1.0} for a in (points, presses)]
    made = plan_performance(
        project, [make_request(x) for x in asks], 5.0, 1, stances={"body": leaning}, idle=False
    )
    times = np.arange(0.5, 4.5, 1 / 60)
    at = skeleton.globals(Evaluator(made, project).at(times))[1][:, skeleton.index("RightHand")]
    assert np.linalg.norm(np.diff(at, 2, axis=0), axis=-1).max() * 3600 < 80.0
