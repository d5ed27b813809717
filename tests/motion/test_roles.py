"""Roles, parts and sides: on the naming families of the field, then on every real skeleton there is."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from metagraph.formats.clips import read_clips
from metagraph.motion import rotation
from metagraph.motion.roles import (
    PARTS,
    REQUIRED,
    ROLES,
    assign_body_parts,
    find_joint_sides,
    find_missing_roles,
    find_roles,
    is_humanoid,
    is_mirrored,
)
from metagraph.motion.skeleton import Skeleton
from sample_clips.make.mannequin_skeleton import mannequin_skeleton
from tests.zoo import ANIMALS, FIGURE


def tree(text: str) -> Skeleton:
    """Build a skeleton from indented names; `<` and `>` copy a line and what is below it for left and
    right.
    """
    names: list[str] = []
    parents: list[int] = []
    stack: list[tuple[int, int]] = []
    for line in text.strip("\n").splitlines():
        depth = len(line) - len(line.lstrip())
        while stack and stack[-1][0] >= depth:
            stack.pop()
        parents.append(stack[-1][1] if stack else -1)
        stack.append((depth, len(names)))
        names.append(line.strip())
    count = len(names)
    offsets = np.zeros((count, 3))
    offsets[:, 1] = 0.1
    return Skeleton(tuple(names), np.array(parents), rotation.make_identity_rotations((count,)), offsets)


def both(block: str, left: str, right: str) -> str:
    return block.replace("@", left) + block.replace("@", right)


def limbs(arm: list[str], leg: list[str], at: int) -> tuple[str, str]:
    """Return indented arm and leg blocks; the arms stand `at` deep, the legs one deep."""
    return (
        "".join(" " * (at + i) + name + "\n" for i, name in enumerate(arm)),
        "".join(" " * (1 + i) + name + "\n" for i, name in enumerate(leg)),
    )


# family: (names from the root to the last of the spine, neck and head, an arm, a leg, left and right marks)
FAMILIES = {
    "mixamo": (
        ["mixamorig:Hips", "mixamorig:Spine", "mixamorig:Spine1", "mixamorig:Spine2"],
        ["mixamorig:Neck", "mixamorig:Head", "mixamorig:HeadTop_End"],
        [f"mixamorig:@{n}" for n in ("Shoulder", "Arm", "ForeArm", "Hand", "HandIndex1")],
        [f"mixamorig:@{n}" for n in ("UpLeg", "Leg", "Foot", "ToeBase", "Toe_End")],
        ("Left", "Right"),
    ),
    "cmu": (
        ["Hips", "LowerBack", "Spine", "Spine1"],
        ["Neck", "Neck1", "Head"],
        [f"@{n}" for n in ("Shoulder", "Arm", "ForeArm", "Hand", "FingerBase")],
        [f"@{n}" for n in ("HipJoint", "UpLeg", "Leg", "Foot", "ToeBase")],
        ("Left", "Right"),
    ),
    "poser": (
        ["Hips", "Chest", "Chest2"],
        ["Neck", "Head"],
        [f"@{n}" for n in ("Collar", "Shoulder", "Elbow", "Wrist")],
        [f"@{n}" for n in ("Hip", "Knee", "Ankle", "Toe")],
        ("Left", "Right"),
    ),
    "biped": (
        ["Bip01 Pelvis", "Bip01 Spine", "Bip01 Spine1"],
        ["Bip01 Neck", "Bip01 Head", "Bip01 HeadNub"],
        [f"Bip01 @ {n}" for n in ("Clavicle", "UpperArm", "Forearm", "Hand", "Finger0")],
        [f"Bip01 @ {n}" for n in ("Thigh", "Calf", "Foot", "Toe0", "Toe0Nub")],
        ("L", "R"),
    ),
    "valve": (
        ["ValveBiped.Bip01_Pelvis", "ValveBiped.Bip01_Spine", "ValveBiped.Bip01_Spine1"],
        ["ValveBiped.Bip01_Neck1", "ValveBiped.Bip01_Head1"],
        [f"ValveBiped.Bip01_@_{n}" for n in ("Clavicle", "UpperArm", "Forearm", "Hand")],
        [f"ValveBiped.Bip01_@_{n}" for n in ("Thigh", "Calf", "Foot", "Toe0")],
        ("L", "R"),
    ),
    "vrm": (
        ["J_Bip_C_Hips", "J_Bip_C_Spine", "J_Bip_C_Chest", "J_Bip_C_UpperChest"],
        ["J_Bip_C_Neck", "J_Bip_C_Head", "J_Adj_L_FaceEye"],
        [f"J_Bip_@_{n}" for n in ("Shoulder", "UpperArm", "LowerArm", "Hand", "Index1")],
        [f"J_Bip_@_{n}" for n in ("UpperLeg", "LowerLeg", "Foot", "ToeBase")],
        ("L", "R"),
    ),
    "blender": (
        ["hips", "spine", "chest"],
        ["neck", "head"],
        ["shoulder.@", "upper_arm.@", "forearm.@", "hand.@", "f_index.01.@"],
        ["thigh.@", "shin.@", "foot.@", "toe.@"],
        ("L", "R"),
    ),
    "unreal": (
        ["pelvis", "spine_01", "spine_02", "spine_03"],
        ["neck_01", "head"],
        ["clavicle_@", "upperarm_@", "lowerarm_@", "hand_@", "index_01_@"],
        ["thigh_@", "calf_@", "foot_@", "ball_@"],
        ("l", "r"),
    ),
    "sumerian": (
        ["char:hips", "char:spine_01", "char:spine_02"],
        ["char:neck", "char:head"],
        ["char:@_clav", "char:@_shoulder", "char:@_elbow", "char:@_wrist", "char:@_thumb_01"],
        ["char:@_thigh", "char:@_knee", "char:@_ankle", "char:@_ball"],
        ("l", "r"),
    ),
    "daz": (
        ["hip", "abdomenLower", "abdomenUpper", "chestLower"],
        ["neckLower", "head"],
        ["@Collar", "@ShldrBend", "@ForearmBend", "@Hand", "@Thumb1"],
        ["@ThighBend", "@Shin", "@Foot", "@Toe"],
        ("l", "r"),
    ),
    "acclaim": (
        ["root", "lowerback", "upperback", "thorax"],
        ["lowerneck", "upperneck", "head"],
        ["@clavicle", "@humerus", "@radius", "@wrist", "@hand"],
        ["@hipjoint", "@femur", "@tibia", "@foot", "@toes"],
        ("l", "r"),
    ),
    "kaykit": (
        ["hips", "spine", "chest"],
        ["head"],
        ["upperarm.@", "lowerarm.@", "wrist.@", "hand.@", "handslot.@"],
        ["upperleg.@", "lowerleg.@", "foot.@", "toes.@"],
        ("l", "r"),
    ),
    "bandai": (
        ["Hips", "Spine", "Chest"],
        ["Neck", "Head"],
        ["Shoulder_@", "UpperArm_@", "LowerArm_@", "Hand_@"],
        ["UpperLeg_@", "LowerLeg_@", "Foot_@", "Toes_@"],
        ("L", "R"),
    ),
}  # fmt: skip


def build(name: str) -> Skeleton:
    trunk, neck, arm, leg, (left, right) = FAMILIES[name]
    top = "".join(" " * i + n + "\n" for i, n in enumerate(trunk))
    top += "".join(" " * (len(trunk) + i) + n + "\n" for i, n in enumerate(neck))
    arms, legs = limbs(arm, leg, len(trunk))
    return tree(top + both(arms, left, right) + both(legs, left, right))


@pytest.mark.parametrize("name", FAMILIES)
def test_every_naming_family_is_a_humanoid_with_its_limbs_in_order(name: str) -> None:
    skeleton = build(name)
    roles = find_roles(skeleton)
    assert is_humanoid(roles), find_missing_roles(roles)
    for side in ("left", "right"):
        for chain in (("upper_arm", "lower_arm", "hand"), ("upper_leg", "lower_leg", "foot", "toes")):
            places = [roles[f"{side}_{r}"] for r in chain]
            assert all(a in skeleton.chain(b) for a, b in pairwise(places))
            assert all(find_joint_sides(skeleton)[p] == side for p in places)
    trunk, neck, arm, leg, (left, _) = FAMILIES[name]
    assert skeleton.names[roles["hips"]] == trunk[0]
    assert skeleton.names[roles["spine"]] == trunk[1]
    hand = {"kaykit": 2}.get(name, 3)
    assert skeleton.names[roles["left_hand"]] == arm[hand].replace("@", left)
    assert skeleton.names[roles["left_upper_arm"]] == arm[hand - 2].replace("@", left)
    foot = {"cmu": 3, "acclaim": 3}.get(name, 2)
    assert skeleton.names[roles["left_foot"]] == leg[foot].replace("@", left)
    assert skeleton.names[roles["left_upper_leg"]] == leg[foot - 2].replace("@", left)
    parts = dict(zip(skeleton.names, assign_body_parts(skeleton), strict=True))
    assert parts[trunk[0]] == "legs" and parts[trunk[1]] == "spine" and parts[neck[0]] == "head"
    assert {parts[n.replace("@", left)] for n in arm} == {"arms"}
    assert {parts[n.replace("@", left)] for n in leg} == {"legs"}


def test_helpers_beside_the_line_of_a_limb_never_win() -> None:
    skeleton = tree(
        """
root
 hips
  spine
   head
   clav_l
    upperarm_twist_01_l
    upperarm_l
     lowerarm_twist_01_l
     lowerarm_l
      ik_hand_l
      hand_l
   upperarm_r
    lowerarm_r
     hand_r
  thigh_l
   thigh_twist_l
   calf_l
    foot_l
  thigh_r
   calf_r
    foot_r
 ik_hand_root
  ik_hand_gun
   hand_l_ik
 foot_ik_l
 hips_ctrl
"""
    )
    roles = find_roles(skeleton)
    assert skeleton.names[roles["left_upper_arm"]] == "upperarm_l"
    assert skeleton.names[roles["left_lower_arm"]] == "lowerarm_l"
    assert skeleton.names[roles["left_hand"]] == "hand_l"
    assert skeleton.names[roles["left_foot"]] == "foot_l"
    assert skeleton.names[roles["hips"]] == "hips"
    assert is_humanoid(roles)


def test_rigifys_numbered_spine_gives_hips_neck_and_head() -> None:
    skeleton = tree(
        """
spine
 spine.001
  spine.002
   spine.003
    spine.004
     spine.005
      spine.006
    shoulder.L
     upper_arm.L
      forearm.L
       hand.L
    shoulder.R
     upper_arm.R
      forearm.R
       hand.R
 thigh.L
  shin.L
   foot.L
 thigh.R
  shin.R
   foot.R
"""
    )
    roles = {role: skeleton.names[joint] for role, joint in find_roles(skeleton).items()}
    assert (roles["hips"], roles["spine"], roles["neck"], roles["head"]) == (
        "spine",
        "spine.001",
        "spine.004",
        "spine.006",
    )


def test_a_four_legged_animal_is_no_humanoid_and_its_missing_roles_say_why() -> None:
    skeleton = tree(
        "Hips\n Spine\n  Head\n  Front_Leg_Upper.L\n   Front_Foot.L\n Back_Leg_Upper.L\n  Back_Foot.L\n "
        "Tail\n"
    )
    roles = find_roles(skeleton)
    assert not is_humanoid(roles)
    assert "left_hand" in find_missing_roles(roles)


@pytest.mark.parametrize("names", ["a", "a\n b\n  c\n", "左腕\n 頭\n", "L\n R\n  left\n", ".\n _\n  :\n"])
def test_names_that_say_nothing_are_no_error(names: str) -> None:
    skeleton = tree(names)
    find_roles(skeleton)
    assert len(assign_body_parts(skeleton)) == len(find_joint_sides(skeleton)) == len(skeleton)


def test_a_skeleton_without_telling_names_is_known_by_its_shape() -> None:
    real = mannequin_skeleton()
    plain = Skeleton(
        tuple(f"bone{i}" for i in range(len(real))), real.parents, real.rest_rotations, real.rest_translations
    )
    shaped, named = find_roles(plain), find_roles(real)
    assert is_humanoid(shaped)
    assert {role: named[role] for role in REQUIRED} == {role: shaped[role] for role in REQUIRED}


def renamed(skeleton: Skeleton, names: Sequence[str]) -> Skeleton:
    return Skeleton(tuple(names), skeleton.parents, skeleton.rest_rotations, skeleton.rest_translations)


def with_twists(skeleton: Skeleton) -> Skeleton:
    """Return the figure with a joint halfway along the bones of its limbs, under names that say nothing but
    where they were: `12`, and `12.5` for what lies in the bone above it.
    """
    ends = ("lower_arm", "hand", "lower_leg", "foot")
    limbs = {joint for role, joint in find_roles(skeleton).items() if role.endswith(ends)}
    names, parents, rotations, offsets = [], [], [], []
    place: dict[int, int] = {}
    for j in range(len(skeleton)):
        above = int(skeleton.parents[j])
        parent, offset = place.get(above, -1), skeleton.rest_translations[j]
        if j in limbs:
            names.append(f"{j}.5")
            parents.append(parent)
            rotations.append(rotation.make_identity_rotations())
            offsets.append(offset / 2)
            parent, offset = len(names) - 1, offset / 2
        place[j] = len(names)
        names.append(str(j))
        parents.append(parent)
        rotations.append(skeleton.rest_rotations[j])
        offsets.append(offset)
    return Skeleton(tuple(names), np.array(parents), np.stack(rotations), np.stack(offsets))


@pytest.mark.parametrize("name", ANIMALS)
def test_the_zoo_is_known_by_its_shape_alone(zoo_files: dict[str, Path], name: str) -> None:
    skeleton = read_clips(zoo_files[name])[0].skeleton
    named = find_roles(skeleton)
    assert find_roles(renamed(skeleton, [f"joint{n}" for n in range(len(skeleton))])) == named
    twisted = with_twists(skeleton)
    found = {role: twisted.names[joint] for role, joint in find_roles(twisted).items()}
    assert {r: found.get(r) for r in REQUIRED} == {r: str(named[r]) for r in REQUIRED}


@pytest.mark.parametrize(
    "file",
    [
        "smartbody-brad/ChrBrad@Idle03.bvh",
        "kaykit-rogue/Rogue.glb",
        "mesh2motion-cmu/human-addon-animations.glb",
        "edge-bvh/bvh_example.bvh",
        "edge-bvh/bvh_test3.bvh",
        "edge-bvh/AV_8Walk_Meredith_HVHA_Rep1.bvh",
        "edge-bvh/Geno_bind.bvh",
        "sumerian-hosts/glTF/animations/adult_female/blink.glb",
        "sumerian-hosts/glTF/animations/adult_male/blink.glb",
        "sumerian-hosts/glTF/animations/alien/blink.glb",
    ],
)
def test_real_people_are_known_by_their_shape_alone(shared_data: Path, file: str) -> None:
    skeleton = read_clips(shared_data / file)[0].skeleton
    named = find_roles(skeleton)
    found = find_roles(renamed(skeleton, [f"joint{n}" for n in range(len(skeleton))]))
    body = [role for role in named if not role.endswith(("jaw", "eye", "lid"))]
    assert {r: found.get(r) for r in body} == {r: named[r] for r in body}


def test_a_skull_under_two_joints_of_the_neck_is_the_head(shared_data: Path) -> None:
    skeleton = read_clips(shared_data / "smartbody-brad/ChrBrad@Idle03.bvh")[0].skeleton
    assert skeleton.names[find_roles(skeleton)["head"]] == "JtSkullA"
    other = renamed(skeleton, [n.replace("Skull", "Cabeza") for n in skeleton.names])
    assert other.names[find_roles(other)["head"]] == "JtCabezaA"


def test_names_in_a_language_nobody_knows_here_leave_the_shape_to_decide() -> None:
    real = mannequin_skeleton()
    words = {
        "Left": "Vasen",
        "Right": "Oikea",
        "Hips": "Lantio",
        "Head": "Paa",
        "Neck": "Kaula",
        "Arm": "Varsi",
    }
    words |= {"Leg": "Jalka", "Hand": "Kasi", "Foot": "Tera", "Shoulder": "Hartia", "Toes": "Varpaat"}
    names = list(real.names)
    for word, other in words.items():
        names = [name.replace(word, other) for name in names]
    found, named = find_roles(renamed(real, names)), find_roles(real)
    assert {r: found.get(r) for r in REQUIRED} == {r: named[r] for r in REQUIRED}


def test_a_bare_stick_figure_is_known_by_its_shape_and_its_toes_tell_left_from_right() -> None:
    places = {
        0: (-1, (0, 1, 0)),
        1: (0, (0, 0.2, 0)),
        2: (1, (0, 0.2, 0)),
        3: (2, (0, 0.1, 0)),
        4: (3, (0, 0.1, 0)),
        5: (2, (0.1, 0, 0)),
        6: (5, (0.2, 0, 0)),
        7: (6, (0.2, 0, 0)),
        8: (7, (0.2, 0, 0)),
        9: (2, (-0.1, 0, 0)),
        10: (9, (-0.2, 0, 0)),
        11: (10, (-0.2, 0, 0)),
        12: (11, (-0.2, 0, 0)),
        13: (0, (0.1, 0, 0)),
        14: (13, (0, -0.45, 0)),
        15: (14, (0, -0.45, 0)),
        16: (15, (0, -0.1, 0.1)),
        17: (0, (-0.1, 0, 0)),
        18: (17, (0, -0.45, 0)),
        19: (18, (0, -0.45, 0)),
        20: (19, (0, -0.1, 0.1)),
    }
    parents = np.array([p for p, _ in places.values()])
    offsets = np.array([o for _, o in places.values()], float)
    names = tuple(f"n{i}" for i in range(len(places)))
    roles = find_roles(Skeleton(names, parents, rotation.make_identity_rotations((len(places),)), offsets))
    assert is_humanoid(roles)
    assert roles["left_hand"] == 8 and roles["right_foot"] == 19 and roles["head"] == 4
    offsets = offsets * np.array([1, 1, -1])
    assert (
        find_roles(Skeleton(names, parents, rotation.make_identity_rotations((len(places),)), offsets))[
            "right_hand"
        ]
        == 8
    )


def test_the_mannequin_has_every_role_and_every_part() -> None:
    skeleton = mannequin_skeleton()
    assert set(find_roles(skeleton)) == set(ROLES)
    parts = dict(zip(skeleton.names, assign_body_parts(skeleton), strict=True))
    assert set(parts.values()) == set(PARTS)
    assert parts["Jaw"] == parts["LeftBrow"] == parts["RightUpperLid"] == "face"
    assert parts["LeftThumb3"] == "arms" and parts["LeftToes"] == "legs" and parts["Hips"] == "legs"
    sides = dict(zip(skeleton.names, find_joint_sides(skeleton), strict=True))
    assert sides["LeftThumb3"] == "left" and sides["RightBrow"] == "right" and sides["Head"] == "centre"


def test_required_roles_are_roles() -> None:
    assert set(REQUIRED) <= set(ROLES) and len(set(ROLES)) == len(ROLES)


# --- real skeletons

PEOPLE = {
    "kaykit-rogue/Rogue.glb": ("hips", "wrist.l", "upperarm.l"),
    "robot-expressive/RobotExpressive.glb": ("Body", "Palm2L", "UpperArmL"),
    "mesh2motion-cmu/human-skeleton.glb": ("DEF-hips", "DEF-hand.L", "DEF-upper_arm.L"),
    "mesh2motion-cmu/human-addon-animations.glb": ("DEF-hips", "DEF-hand.L", "DEF-upper_arm.L"),
    "sumerian-hosts/glTF/animations/alien/stand_idle.glb": ("char:hips", "char:l_wrist", "char:l_shoulder"),
    "sumerian-hosts/glTF/animations/adult_female/emote.glb": (
        "char:def_c_hip",
        "char:def_l_wrist",
        "char:def_l_shoulder",
    ),
    "sumerian-hosts/glTF/animations/adult_male/lipsync.glb": (
        "char:def_c_hip",
        "char:def_l_wrist",
        "char:def_l_shoulder",
    ),
    "edge-bvh/01_01.bvh": ("Hips", "LeftHand", "LeftArm"),
    "edge-bvh/sample.bvh": ("Hips", "LeftWrist", "LeftShoulder"),
    "edge-bvh/bvh_test3.bvh": ("Hips", "LeftHand", "LeftArm"),
    "edge-bvh/Geno_bind.bvh": ("Hips", "LeftHand", "LeftArm"),
    "edge-bvh/AV_8Walk_Meredith_HVHA_Rep1.bvh": ("Hips", "LeftHand", "LeftArm"),
    "bandai-namco-1/dataset-1_bye_active_001.bvh": ("Hips", "Hand_L", "UpperArm_L"),
    "fbx-pab/walk.fbx": ("Pelvis", "Lefthand", "LeftArm"),
    "mesh2motion-cmu/91_48.fbx": ("hip", "lHand", "lShldr"),
}


@pytest.mark.parametrize("file", PEOPLE)
def test_real_people_have_the_roles_one_would_point_at(shared_data: Path, file: str) -> None:
    if file.endswith(".fbx"):
        pytest.importorskip("ufbx", reason="the extra metagraph-studio[fbx] is not installed")
    skeleton = read_clips(shared_data / file)[0].skeleton
    roles = find_roles(skeleton)
    assert is_humanoid(roles), find_missing_roles(roles)
    hips, hand, arm = PEOPLE[file]
    named = {role: skeleton.names[joint] for role, joint in roles.items()}
    assert (named["hips"], named["left_hand"], named["left_upper_arm"]) == (hips, hand, arm)
    assert named["right_hand"] != named["left_hand"]
    parts = assign_body_parts(skeleton, roles)
    assert set(parts) >= {"legs", "spine", "arms", "head"}
    assert find_joint_sides(skeleton, roles).count("left") == pytest.approx(
        find_joint_sides(skeleton, roles).count("right"), abs=3
    )


@pytest.mark.parametrize("name", ANIMALS)
def test_joints_of_the_zoo_have_the_roles_they_are_named_for(zoo_files: dict[str, Path], name: str) -> None:
    skeleton = read_clips(zoo_files[name])[0].skeleton
    roles = find_roles(skeleton)
    assert is_humanoid(roles), find_missing_roles(roles)
    named = {role: skeleton.names[joint] for role, joint in roles.items()}
    wanted = {role: ANIMALS[name].called(role) for role in ROLES if role in FIGURE and role in REQUIRED}
    assert {role: named[role] for role in wanted} == wanted
    assert {"legs", "spine", "arms", "head"} <= set(assign_body_parts(skeleton, roles))
    assert find_joint_sides(skeleton, roles).count("left") == find_joint_sides(skeleton, roles).count("right")


@pytest.mark.parametrize("file", ["bird-animations.glb", "quad-creature-animations.glb"])
def test_real_animals_are_told_apart_from_people(shared_data: Path, file: str) -> None:
    assert not is_humanoid(find_roles(read_clips(shared_data / "mesh2motion-cmu" / file)[0].skeleton))


def test_a_figure_whose_left_is_on_its_right_is_mirrored_and_no_other_is() -> None:
    body = mannequin_skeleton()
    assert not is_mirrored(body)
    flipped = body.rest_translations * np.array([-1.0, 1.0, 1.0])  # as axes of the other handedness
    turns = body.rest_rotations * np.array([1.0, -1.0, -1.0, 1.0])
    assert is_mirrored(Skeleton(body.names, body.parents, turns, flipped))
    feet = find_roles(body)
    stumps = [j for side in ("left", "right") for j in body.descendants(feet[f"{side}_foot"])[1:]]
    offsets = flipped.copy()
    offsets[stumps] = 0.0
    assert not is_mirrored(Skeleton(body.names, body.parents, turns, offsets)), "without toes nobody can tell"
