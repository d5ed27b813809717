"""Skeletons: what makes one, what makes two the same, and forward kinematics."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from metagraph.motion import rotation
from metagraph.motion.skeleton import Pose, Skeleton, make_names_unique

REST = [0.0, 0, 0, 1]


def skeleton(parents: list[int], offset: float = 1.0) -> Skeleton:
    count = len(parents)
    return Skeleton(
        tuple(f"j{i}" for i in range(count)),
        np.array(parents),
        np.tile(REST, (count, 1)),
        np.tile([0, offset, 0], (count, 1)),
    )


def test_one_joint_is_a_skeleton() -> None:
    one = skeleton([-1])
    turned = rotation.from_axis_angle([0, 0, 1], 0.5)[None]
    r, p = one.globals(Pose(turned, np.array([[1.0, 2, 3]])))
    assert np.array_equal(r, turned)
    assert np.array_equal(p, [[1.0, 2, 3]])
    assert one.levels[0].tolist() == [0]
    assert one.height == pytest.approx(1e-3)


def test_several_roots_move_on_their_own() -> None:
    two = skeleton([-1, 0, -1, 2])
    pose = Pose(np.tile(REST, (4, 1)), np.array([[5.0, 0, 0], [0, 1, 0], [0, 0, 7.0], [0, 1, 0]]))
    _, p = two.globals(pose)
    assert p.tolist() == [[5, 0, 0], [5, 1, 0], [0, 0, 7], [0, 1, 7]]


@pytest.mark.parametrize(
    ("parents", "words"),
    [
        ([], "at least one joint"),
        ([0], "before it"),
        ([-1, 1], "before it"),
        ([-1, 2, 0], "before it"),
        ([-1, -2], "before it"),
        ([1, -1], "before it"),
    ],
)
def test_parents_that_do_not_come_first_are_refused(parents: list[int], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        skeleton(parents)


def test_wrong_shapes_twice_the_same_name_and_numbers_that_are_none_are_refused() -> None:
    rest, zero = np.tile(REST, (2, 1)), np.zeros((2, 3))
    with pytest.raises(ValueError, match=r"parents \[2\]"):
        Skeleton(("a", "b"), np.array([-1]), rest, zero)
    with pytest.raises(ValueError, match="unique"):
        Skeleton(("a", "a"), np.array([-1, 0]), rest, zero)
    with pytest.raises(ValueError, match="not a number"):
        Skeleton(("a", "b"), np.array([-1, 0]), rest, np.array([[0, 0, 0], [0, np.nan, 0]]))


def test_its_arrays_cannot_be_changed() -> None:
    with pytest.raises(ValueError, match="read-only"):
        skeleton([-1, 0]).rest_translations[0] = 1


def test_skeletons_are_the_same_by_names_parents_and_rest_pose() -> None:
    a = skeleton([-1, 0, 1])
    assert a == skeleton([-1, 0, 1]) and hash(a) == hash(skeleton([-1, 0, 1]))
    assert a != skeleton([-1, 0, 0]) and a != skeleton([-1, 0, 1], 1.001) and a != "a skeleton"
    assert a == skeleton([-1, 0, 1], 1.00001)  # rounded to a tenth of a millimetre
    flipped = Skeleton(a.names, a.parents, -a.rest_rotations, a.rest_translations)
    assert a == flipped  # the other sign is the same rotation


def test_joints_are_found_by_name_and_by_line() -> None:
    s = skeleton([-1, 0, 1, 0])
    assert s.index("j2") == 2 and "j3" in s and "j9" not in s
    assert s.children == ((1, 3), (2,), (), ())
    assert s.descendants(1) == (1, 2) and s.chain(2) == (0, 1, 2)
    with pytest.raises(KeyError):
        s.index("j9")


def test_forward_kinematics_of_a_bent_arm() -> None:
    arm = skeleton([-1, 0, 1])
    bent = np.tile(rotation.from_axis_angle([0, 0, 1], np.pi / 2), (3, 1))
    r, p = arm.globals(Pose(bent, arm.rest_translations))
    assert np.allclose(p, [[0, 1, 0], [-1, 1, 0], [-1, 0, 0]], atol=1e-12)
    assert rotation.measure_angle_between(r[2], rotation.from_axis_angle([0, 0, 1], 1.5 * np.pi)) < 1e-7


@given(st.data())
@settings(max_examples=40)
def test_forward_kinematics_agrees_with_matrices_on_any_hierarchy(data: st.DataObject) -> None:
    count = data.draw(st.integers(1, 9))
    parents = [-1] + [data.draw(st.integers(-1, i - 1)) for i in range(1, count)]
    rng = np.random.default_rng(data.draw(st.integers(0, 1000)))
    s = skeleton(parents)
    pose = Pose(rotation.normalize(rng.normal(size=(2, 3, count, 4))), rng.normal(size=(2, 3, count, 3)))
    r, p = s.globals(pose)
    whole = np.zeros((2, 3, count, 4, 4))
    for j in range(count):
        local = np.zeros((2, 3, 4, 4))
        local[..., :3, :3], local[..., :3, 3], local[..., 3, 3] = (
            rotation.to_matrix(pose.rotations[..., j, :]),
            pose.translations[..., j, :],
            1,
        )
        whole[..., j, :, :] = local if parents[j] < 0 else whole[..., parents[j], :, :] @ local
    assert np.allclose(p, whole[..., :3, 3], atol=1e-9)
    assert np.allclose(rotation.to_matrix(r), whole[..., :3, :3], atol=1e-9)


def test_a_pose_is_picked_along_its_leading_dimensions() -> None:
    poses = Pose(np.zeros((5, 2, 4)), np.arange(30.0).reshape(5, 2, 3))
    assert poses[1:3].translations.shape == (2, 2, 3)
    assert poses[3].root.tolist() == [18, 19, 20]


def test_names_are_made_unique_and_never_empty() -> None:
    assert make_names_unique(["a", "a", " ", "", "a_2", "a"]) == (
        "a",
        "a_2",
        "joint",
        "joint_2",
        "a_2_2",
        "a_3",
    )
