"""Bringing a clip onto the project's skeleton, and saying why it cannot be."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from metagraph.motion import rotation
from metagraph.motion.adopt import SkeletonMismatchError, adopt, describe_difference, measure_bone_difference
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Skeleton

NAMES = ("hips", "spine", "head", "arm", "hand", "leg")
PARENTS = [-1, 0, 1, 1, 3, 0]
OFFSETS = np.array([[0, 1.0, 0], [0, 0.3, 0], [0, 0.3, 0], [0.2, 0.2, 0], [0.3, 0, 0], [0.1, -0.5, 0]])


def skeleton(
    names: tuple[str, ...] = NAMES,
    parents: list[int] = PARENTS,
    scale: float = 1.0,
    offsets: np.ndarray = OFFSETS,
) -> Skeleton:
    return Skeleton(
        names, np.array(parents), np.tile([0.0, 0, 0, 1], (len(names), 1)), offsets[: len(names)] * scale
    )


def clip(on: Skeleton, angle: float = 0.5) -> Clip:
    rotations = np.tile([0.0, 0, 0, 1], (4, len(on), 1))
    rotations[:, -1] = rotation.from_axis_angle(np.array([0.0, 0, 1]), np.linspace(0, angle, 4))
    return Clip("c", on, 30.0, rotations, np.tile(on.rest_translations[:1], (4, 1, 1)))


def test_the_same_skeleton_needs_nothing() -> None:
    ours, c = skeleton(), clip(skeleton())
    assert adopt(c, c.skeleton) is c
    adopted = adopt(c, ours)
    assert adopted.skeleton is ours and adopted.rotations is c.rotations


def test_joints_in_another_order_find_their_places() -> None:
    order = [0, 5, 1, 3, 4, 2]
    parents = [-1, 0, 0, 2, 3, 2]
    other = Skeleton(
        tuple(NAMES[i] for i in order), np.array(parents), np.tile([0.0, 0, 0, 1], (6, 1)), OFFSETS[order]
    )
    adopted = adopt(clip(other), skeleton())
    assert np.allclose(adopted.rotations[:, 2], clip(other).rotations[:, -1])
    assert np.allclose(adopted.rotations[:, 5], [0, 0, 0, 1])


def test_joints_the_clip_lacks_stay_at_rest() -> None:
    fewer = skeleton(NAMES[:4], PARENTS[:4])
    adopted = adopt(clip(fewer), skeleton())
    assert adopted.rotations.shape == (4, 6, 4)
    assert np.allclose(adopted.rotations[:, 4:], [0, 0, 0, 1])
    assert np.allclose(adopted.pose_at(0).translations, OFFSETS, atol=1e-6)


def test_bones_as_the_clip_has_them_are_kept() -> None:
    longer = OFFSETS.copy()
    longer[4] *= 1.05
    adopted = adopt(clip(skeleton(offsets=longer)), skeleton())
    assert adopted.translated == (0, 4)
    assert np.allclose(adopted.poses().translations[0, 4], longer[4])


@pytest.mark.parametrize("scale", [100.0, 0.01, 1.5])
def test_another_scale_is_named(scale: float) -> None:
    with pytest.raises(SkeletonMismatchError, match="times as long"):
        adopt(clip(skeleton(scale=scale)), skeleton())


def with_tail() -> Skeleton:
    return Skeleton(
        (*NAMES, "tail"),
        np.array([*PARENTS, 0]),
        np.tile([0.0, 0, 0, 1], (7, 1)),
        np.concatenate([OFFSETS, [[0, 0, -0.3]]]),
    )


def test_the_motion_of_an_end_of_its_own_is_left_out_and_named() -> None:
    assert describe_difference(with_tail(), skeleton()) is None
    adopted = adopt(clip(with_tail()), skeleton())
    assert adopted.skeleton == skeleton() and any("'tail'" in note for note in adopted.notes)
    assert not adopt(clip(skeleton()), with_tail()).notes


def with_chest() -> Skeleton:
    """The skeleton with a chest between the spine and what hangs on it."""
    names = ("armature", "hips", "spine", "chest", "head", "arm", "hand", "leg")
    offsets = np.array([[0.1, 0, 0], *OFFSETS[:2], [0, 0.1, 0], *OFFSETS[2:]])
    offsets[1, 0] = -0.1
    offsets[[4, 5], 1] -= 0.1
    parents = np.array([-1, 0, 1, 2, 3, 3, 5, 1])
    return Skeleton(names, parents, np.tile([0.0, 0, 0, 1], (8, 1)), offsets)


def bent(on: Skeleton) -> Clip:
    """A clip that turns every joint of a skeleton, and moves its root."""
    rng = np.random.default_rng(1)
    rotations = rotation.normalize(rng.normal(size=(4, len(on), 4)) * 0.2 + [0, 0, 0, 1.0])
    return Clip("bent", on, 30.0, rotations, rng.normal(size=(4, 1, 3)))


@pytest.mark.parametrize("more", [True, False])
def test_a_joint_between_shared_ones_is_no_other_skeleton_and_all_stand_where_they_stood(more: bool) -> None:
    source, target = (with_chest(), skeleton()) if more else (skeleton(), with_chest())
    assert describe_difference(source, target) is None and measure_bone_difference(
        source, target
    ) == pytest.approx(0)
    before = bent(source)
    adopted = adopt(before, target)
    told = "handed down" if more else "at rest while it plays"
    assert any("'chest'" in note and told in note for note in adopted.notes)
    _, places = source.globals(before.poses())
    _, found = target.globals(adopted.poses())
    for name in NAMES:
        assert np.allclose(found[:, target.index(name)], places[:, source.index(name)], atol=1e-5), name


def test_many_joints_between_shared_ones_are_another_skeleton() -> None:
    ours = skeleton()
    names, parents, offsets = list(NAMES), list(PARENTS), [*OFFSETS]
    for joint in range(1, 6):  # a helper above each joint
        names.append(f"helper of {NAMES[joint]}")
        parents.append(PARENTS[joint])
        offsets.append(np.zeros(3))
        parents[joint] = len(names) - 1
    order = [0, *(n for k in (1, 2, 3, 4, 5) for n in (5 + k, k))]
    new = {old: n for n, old in enumerate(order)}
    above = np.array([-1 if parents[o] < 0 else new[parents[o]] for o in order])
    other = Skeleton(
        tuple(names[o] for o in order),
        above,
        np.tile([0.0, 0, 0, 1], (11, 1)),
        np.array([offsets[o] for o in order]),
    )
    assert "5 joints between" in str(describe_difference(other, ours))


def test_limbs_that_lead_another_way_from_their_joints_are_another_skeleton() -> None:
    hanging, leaning = OFFSETS.copy(), OFFSETS.copy()
    hanging[4] = [0, -0.3, 0]  # the same joints, whose arm hangs where the other is stretched out
    leaning[4] = [0.29, 0.08, 0]
    assert "'arm' point another way" in str(describe_difference(skeleton(offsets=hanging), skeleton()))
    assert describe_difference(skeleton(offsets=leaning), skeleton()) is None
    with pytest.raises(SkeletonMismatchError, match="point another way"):
        adopt(clip(skeleton(offsets=hanging)), skeleton())


def test_axes_that_one_turn_leads_to_the_project_s_are_turned_and_all_stand_where_they_stood(
    toy: Any,
) -> None:
    s, wave = toy.skeleton, toy.clip("wave")
    turn = rotation.from_axis_angle(np.array([1.0, 0, 0]), np.radians(-90))  # Z up, in the file's own axes
    count = len(s)
    below = np.arange(1, count)

    def turned(rotations: np.ndarray, translations: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        around = rotation.multiply(rotations.astype(float), rotation.conjugate(turn))
        around[..., below, :] = rotation.multiply(turn, around[..., below, :])
        moved = translations.astype(float).copy()
        moved[..., below, :] = rotation.rotate_vectors(turn, moved[..., below, :])
        return around, moved

    file = Skeleton(s.names, s.parents, *turned(s.rest_rotations, s.rest_translations))
    poses = wave.poses()
    rotations, _ = turned(poses.rotations, poses.translations)
    other = Clip("wave", file, wave.fps, rotations, poses.translations[:, :1])
    _, before = file.globals(other.poses())
    adopted = adopt(other, s)
    _, after = s.globals(adopted.poses())
    assert np.allclose(after, before, atol=1e-5)
    assert np.allclose(adopted.rotations, wave.rotations, atol=1e-5)
    assert any("axes of its joints were turned" in note for note in adopted.notes)


def test_other_names_are_said_to_be_other_names() -> None:
    strange = skeleton(tuple(f"bone{i}" for i in range(6)))
    assert re.search("'bone0'.*'hips'", describe_difference(strange, skeleton()))


def test_another_hierarchy_is_said_with_both_parents() -> None:
    found = describe_difference(skeleton(parents=[-1, 0, 1, 1, 2, 0]), skeleton())
    assert re.search("'hand'.*'head'.*'arm'", found)
    found = describe_difference(skeleton(), skeleton(parents=[-1, 0, 1, 1, -1, 0]))
    assert re.search("'hand'.*'arm'.*nothing", found)


def test_one_joint_can_be_adopted_by_one_joint() -> None:
    one = skeleton(("hips",), [-1])
    other = replace(clip(one), skeleton=skeleton(("hips",), [-1], scale=1.5))
    assert adopt(other, one).rotations.shape == (4, 1, 4)


def test_both_signs_of_a_rotation_stay_on_one_side() -> None:
    fewer = skeleton(NAMES[:4], PARENTS[:4])
    c = clip(fewer)
    flipped = replace(c, rotations=c.rotations * np.array([1, -1, 1, -1], np.float32)[:, None, None])
    adopted = adopt(flipped, skeleton())
    assert np.all(np.einsum("fji,fji->fj", adopted.rotations[1:], adopted.rotations[:-1]) > 0)


@pytest.mark.parametrize(
    ("ours", "theirs"),
    [
        ("mixamorig:{}", "{}"),
        ("{}", "mixamorig1:{}"),
        ("a:{}", "b|c:{}"),
        ("Bip01 {}", "Bip02 {}"),
        ("{}_jnt", "x_{}"),
    ],
)
def test_names_that_differ_by_what_all_joints_bear_are_the_same_skeleton(ours: str, theirs: str) -> None:
    project = skeleton(tuple(ours.format(n) for n in NAMES))
    own = clip(skeleton(tuple(theirs.format(n) for n in NAMES)))
    assert describe_difference(own.skeleton, project) is None
    adopted = adopt(own, project)
    assert adopted.skeleton is project
    assert any(f"'{theirs.format('hips')}' for '{ours.format('hips')}'" in note for note in adopted.notes)
    np.testing.assert_array_equal(adopted.rotations, own.rotations)


def test_a_prefix_does_not_make_another_tree_or_other_joints_the_same() -> None:
    project = skeleton()
    other = skeleton(tuple(f"x:{n}" for n in NAMES), [-1, 0, 1, 1, 0, 3])
    assert "is attached to" in str(describe_difference(other, project))
    assert describe_difference(skeleton(("x:hips", "x:spine", "x:tail"), PARENTS[:3]), project) is not None


def test_how_far_bones_differ_is_told_by_the_longest_share() -> None:
    longer = OFFSETS.copy()
    longer[4] *= 1.05
    assert measure_bone_difference(skeleton(), skeleton()) == 0
    assert measure_bone_difference(skeleton(offsets=longer), skeleton()) == pytest.approx(0.05)
    assert (
        measure_bone_difference(skeleton(tuple(f"x:{n}" for n in NAMES), offsets=longer), skeleton()) > 0.04
    )


def with_names(on: Skeleton, names: tuple[str, ...]) -> Skeleton:
    return Skeleton(names, on.parents, on.rest_rotations, on.rest_translations)


def test_other_names_for_the_same_roles_at_rest_alike_are_the_same_character(toy: Any) -> None:
    vrm = with_names(toy.skeleton, tuple(name[0].lower() + name[1:] for name in toy.skeleton.names))
    wave = toy.clip("wave")
    there = replace(wave, skeleton=vrm)
    assert describe_difference(vrm, toy.skeleton) is None
    adopted = adopt(there, toy.skeleton)
    assert adopted.skeleton is toy.skeleton and np.allclose(adopted.rotations, wave.rotations, atol=1e-6)
    odd = with_names(toy.skeleton, tuple(f"bone{n:02}" for n in range(len(toy.skeleton))))
    assert describe_difference(odd, toy.skeleton) is None, "the shape says which joint is which"


@pytest.mark.parametrize("change", ["turned", "longer"])
def test_other_names_and_another_rest_are_another_character(toy: Any, change: str) -> None:
    names = tuple(name[0].lower() + name[1:] for name in toy.skeleton.names)
    turns, offsets = toy.skeleton.rest_rotations.copy(), toy.skeleton.rest_translations.copy()
    arm = toy.skeleton.index("LeftUpperArm")
    if change == "turned":
        turns[arm] = rotation.from_axis_angle(np.array([1.0, 0, 0]), np.radians(30))
    else:
        offsets[arm + 1] *= 1.5
    other = Skeleton(names, toy.skeleton.parents, turns, offsets)
    assert "other names" in str(describe_difference(other, toy.skeleton))


def test_a_joint_of_the_clip_named_like_another_of_the_project_keeps_out_of_its_way(toy: Any) -> None:
    names = tuple(f"bone{n:02}" for n in range(len(toy.skeleton)))
    tail = Skeleton(
        (*names, "Head"),
        np.array([*toy.skeleton.parents, 0]),
        np.concatenate([toy.skeleton.rest_rotations, [[0, 0, 0, 1.0]]]),
        np.concatenate([toy.skeleton.rest_translations, [[0, 0, -0.3]]]),
    )
    assert describe_difference(tail, toy.skeleton) is None
    adopted = adopt(clip(tail), toy.skeleton)
    assert any("'Head (of the clip)'" in note for note in adopted.notes)
