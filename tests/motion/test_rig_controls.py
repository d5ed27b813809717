"""Joints that steer a rig are identified by name, and no measure of a pose counts them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from metagraph.formats.gltf.reader import read_gltf_clips
from metagraph.motion.features import measure_pose_distance
from metagraph.motion.rig_controls import find_rig_controls
from metagraph.motion.skeleton import Pose, Skeleton
from sample_clips.make.mannequin_skeleton import mannequin_skeleton


def with_joints(*names: str, on: str = "Hips") -> Skeleton:
    """The mannequin, and joints that hang on one of its own."""
    body = mannequin_skeleton()
    count = len(names)
    return Skeleton(
        (*body.names, *names),
        np.append(body.parents, [body.index(on)] * count),
        np.concatenate([body.rest_rotations, np.tile([0.0, 0, 0, 1], (count, 1))]),
        np.concatenate([body.rest_translations, np.full((count, 3), 0.2)]),
    )


@pytest.mark.parametrize(
    "name",
    ["handIK.l", "elbowIK.r", "control-toe-roll.l", "IK_foot_L", "knee_pole", "MCH-spine", "lookTarget"],
)
def test_goals_poles_and_handles_are_a_rigs(name):
    skeleton = with_joints(name)
    assert find_rig_controls(skeleton) == {skeleton.index(name)}


@pytest.mark.parametrize(
    "name", ["LeftSkirt", "Tail1", "weapon_r", "handslot.l", "pikachu", "hair_controlled"]
)
def test_what_is_seen_is_none(name):
    assert find_rig_controls(with_joints(name)) == frozenset()


def test_what_the_body_hangs_on_is_none_whatever_it_is_called():
    body = mannequin_skeleton()
    named = replace(body, names=tuple("Ctrl_" + n for n in body.names))
    controls = find_rig_controls(named)
    assert not controls & {
        named.index("Ctrl_" + n) for n in ("Hips", "LeftHand", "RightFoot", "Head", "Spine")
    }


def test_a_goal_that_lies_elsewhere_makes_no_pose_another():
    skeleton = with_joints("elbowIK.l")
    there = skeleton.rest_translations.copy()
    there[-1] += 1.44
    a, b = Pose(skeleton.rest_rotations, skeleton.rest_translations), Pose(skeleton.rest_rotations, there)
    assert measure_pose_distance(skeleton, a, b) == 0
    assert measure_pose_distance(skeleton, a, b, [len(skeleton) - 1]) == pytest.approx(1.44 * 3**0.5)


def test_of_a_rig_nobody_made_here_body_and_weapons_count(shared_data):
    skeleton = read_gltf_clips(shared_data / "kaykit-rogue" / "Rogue.glb")[0].skeleton
    names = {skeleton.names[j] for j in find_rig_controls(skeleton)}
    assert {"handIK.l", "elbowIK.r", "kneeIK.l"} <= names
    assert not names & {"hips", "spine", "chest", "head", "hand.l", "handslot.r", "toes.l", "upperarm.r"}
