"""Which joints are drawn, judged by the names of many rigs."""

from __future__ import annotations

import numpy as np
import pytest

from metagraph.motion.skeleton import Skeleton
from preview import joints
from sample_clips.make.mannequin_skeleton import mannequin_skeleton


def rig(*rows: tuple[str, str | None]) -> Skeleton:
    names = [name for name, _ in rows]
    parents = [-1 if parent is None else names.index(parent) for _, parent in rows]
    return Skeleton(
        tuple(names),
        np.array(parents),
        np.tile([0.0, 0, 0, 1], (len(rows), 1)),
        np.tile([0.0, 0.2, 0], (len(rows), 1)),
    )


@pytest.mark.parametrize(
    "name", ["ik_foot_l", "LeftHand_end", "CTRL_Hips", "upperarm_twist_01_l", "Bip01 L Toe0Nub", "Site"]
)
def test_rig_helpers_are_no_bones(name):
    assert joints.is_control(name)


@pytest.mark.parametrize(
    "name", ["Hips", "mixamorig:Spine1", "Bip01 L Thigh", "Head", "Pendulum", "LeftForeArm"]
)
def test_bones_are_not_taken_for_helpers_or_faces(name):
    assert not joints.is_control(name)
    assert not joints.is_face(name)


def test_sides_come_from_names_and_pass_down():
    skeleton = rig(
        ("Hips", None),
        ("upperleg.L", "Hips"),
        ("shin", "upperleg.L"),
        ("RightUpLeg", "Hips"),
        ("l_arm", "Hips"),
        ("Neck", "Hips"),
    )
    assert joints.find_side_signs(skeleton).tolist() == [0, 1, 1, -1, 1, 0]


def test_a_root_on_the_ground_is_not_drawn_but_the_hips_are():
    skeleton = rig(("Root", None), ("Hips", "Root"), ("LeftLeg", "Hips"), ("RightLeg", "Hips"))
    assert joints.find_drawn_joints(skeleton).tolist() == [False, True, True, True]


def test_a_chain_without_branches_is_drawn_whole():
    assert joints.find_drawn_joints(rig(("a", None), ("b", "a"), ("c", "b"))).all()


def test_something_is_always_drawn():
    assert joints.find_drawn_joints(rig(("ik_target", None))).any()


def test_the_mannequins_face_is_left_to_its_head():
    skeleton = mannequin_skeleton()
    shown = {skeleton.names[i] for i in np.flatnonzero(joints.find_drawn_joints(skeleton))}
    assert not any("Eye" in n or "Lid" in n or "Brow" in n or n == "Jaw" for n in shown)
    assert {"Hips", "Head", "LeftIndex2", "RightToes"} <= shown
    assert skeleton.names[joints.find_head(skeleton) or 0] == "Head"


def test_a_head_that_is_not_called_one_is_drawn_by_its_role():
    skeleton = mannequin_skeleton()
    names = tuple(n.replace("Head", "JtSkullA").replace("Neck", "JtNeckB") for n in skeleton.names)
    renamed = Skeleton(names, skeleton.parents, skeleton.rest_rotations, skeleton.rest_translations)
    assert joints.find_head(renamed) == skeleton.names.index("Head")


def test_a_bone_goes_past_what_is_not_drawn_to_the_nearest_joint_that_is():
    rows = ("Hips", None), ("ik_spine", "Hips"), ("Spine", "ik_spine"), ("Head", "Spine"), ("Prop", None)
    shown = np.array([True, False, True, True, True])
    assert joints.find_nearest_above(rig(*rows), shown).tolist() == [-1, 0, 0, 2, -1]
