"""Poses as numbers and back."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.generation.poses import (
    JOINTS,
    LEAST,
    PoseError,
    decode_poses,
    encode_clip,
    encode_rotations,
    find_rig,
    orthonormalise_rows,
    resample_rotations,
    scale_of,
)
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.mirror import find_joint_twins, mirror
from metagraph.motion.skeleton import Pose, Skeleton
from tests.bodies import column
from tests.generation.makers import moving, rig, stance

IDENTITY = [1, 0, 0, 0, 1, 0]


def _turned(count: int, seed: int = 1):
    chance = np.random.default_rng(seed)
    return rotation.normalize(chance.standard_normal((count, len(rig().skeleton), 4)))


def _long_spine() -> tuple[Skeleton, Skeleton]:
    """A skeleton, and the same with a joint more in the spine and in each arm, which has no role."""
    plain = stance().skeleton
    names, parents, turns, offsets = list(plain.names), [int(p) for p in plain.parents], [], []
    turns, offsets = list(plain.rest_rotations), list(plain.rest_translations)
    for role in ("chest", "left_lower_arm", "right_lower_arm"):
        own = dict(zip(rig().roles, rig().joints, strict=True)).get(role)
        if own is None:
            continue
        joint = names.index(plain.names[own])
        names.insert(joint, f"{plain.names[own]} roll helper")
        parents = [p + (p >= joint) for p in parents]
        parents.insert(joint, parents[joint])
        parents[joint + 1] = joint
        turns.insert(joint, np.array([0, 0, 0, 1.0]))
        offsets.insert(joint, offsets[joint] / 2)
        offsets[joint + 1] = offsets[joint + 1] / 2
    return plain, Skeleton(tuple(names), np.array(parents), np.array(turns), np.array(offsets))


def test_thirteen_joints_of_the_upper_body_are_78_numbers():
    own = rig()
    assert own.roles == JOINTS
    assert own.numbers == 78
    names = [own.skeleton.names[j].lower() for j in own.joints]
    assert not any(part in name for name in names for part in ("leg", "foot", "hips", "finger"))


def test_the_base_pose_is_the_identity():
    own = rig()
    assert np.allclose(encode_rotations(own, own.base).reshape(-1, 6), IDENTITY, atol=1e-6)
    leaning = _turned(1)[0]
    assert np.allclose(
        encode_rotations(find_rig(own.skeleton, base=leaning), leaning).reshape(-1, 6), IDENTITY, atol=1e-6
    )


def test_any_pose_comes_back():
    own = rig()
    turned = _turned(50)
    back = decode_poses(own, encode_rotations(own, turned))
    assert np.degrees(rotation.measure_angle_between(back, turned[:, list(own.joints)]).max()) < 0.01


def test_what_turns_between_two_joints_is_not_lost():
    plain, longer = _long_spine()
    one, two = find_rig(plain), find_rig(longer)
    assert two.numbers == one.numbers
    assert max(map(len, two.lines)) == 2
    turned = _turned(20)
    spread = np.repeat(longer.rest_rotations[None], 20, 0)
    for name in plain.names:
        spread[:, longer.index(name)] = turned[:, plain.index(name)]
    for line in two.lines:
        if len(line) > 1:  # half of the turn in the joint between
            half = rotation.scale_rotation(spread[:, line[1]], np.full(20, 0.5))
            spread[:, line[0]], spread[:, line[1]] = half, half
    assert np.abs(encode_rotations(one, turned) - encode_rotations(two, spread)).max() < 1e-5
    back = spread.copy()
    between = [j for line in two.lines for j in line[:-1]]
    back[:, between] = longer.rest_rotations[between]
    back[:, list(two.joints)] = decode_poses(two, encode_rotations(two, spread))
    still = np.repeat(longer.rest_translations[None], 20, 0)
    ends = [two.joints[two.roles.index(role)] for role in ("left_hand", "head")]
    there, again = (longer.globals(Pose(r, still))[0][:, ends] for r in (spread, back))
    assert np.abs(spread - back).max() > 0.1
    assert np.degrees(rotation.measure_angle_between(there, again).max()) < 0.01


def test_a_skeleton_without_hands_is_refused_in_words():
    with pytest.raises(PoseError, match=r"no spine.*Correct"):
        find_rig(column(), {})


def test_fewer_spines_and_no_collar_bones_will_do():
    own = rig()
    roles = dict(zip(own.roles, own.joints, strict=True)) | {"hips": int(own.skeleton.parents[own.joints[0]])}
    for role in ("chest", "upper_chest", "neck", "left_shoulder", "right_shoulder"):
        del roles[role]
    few = find_rig(own.skeleton, roles)
    assert few.numbers == 48
    # What the joints without roles turn is in those below.
    turned = _turned(4)
    assert np.abs(encode_rotations(few, turned) - encode_rotations(own, turned)[:, : few.numbers]).max() > 0.1


@given(st.lists(st.floats(-9, 9), min_size=6, max_size=6))
def test_whatever_a_network_gives_is_a_rotation(numbers):
    matrix = orthonormalise_rows(np.array(numbers).reshape(2, 3))
    assert np.allclose(matrix @ matrix.T, np.eye(3), atol=1e-6)
    assert np.linalg.det(matrix) == pytest.approx(1)


def test_noise_on_the_rows_leaves_the_first_ones_direction():
    rows = np.array([[2.0, 0, 0], [0.5, 3.0, 0]])
    assert np.allclose(orthonormalise_rows(rows), np.eye(3))


@pytest.mark.parametrize("fps", [24.0, 30.0, 60.0, 120.0])
def test_clips_of_any_rate_are_at_the_same_places(fps):
    steady = moving(4, seed=3, fps=fps)
    fine = resample_rotations(moving(4, seed=3, fps=1000.0), 25.0)
    own = resample_rotations(steady, 25.0)
    assert len(own) == 101
    worst = np.degrees(rotation.measure_angle_between(own, fine[: len(own)]).max())
    assert worst < 40 / fps**1.5


def test_a_quarter_turn_is_half_way_at_half_time():
    own = rig()
    rotations = np.repeat(own.skeleton.rest_rotations[None], 2, 0)
    joint = own.joints[4]
    rotations[1, joint] = rotation.multiply(rotations[1, joint], rotation.from_axis_angle([0, 1, 0], 2.4))
    clip = Clip("turn", own.skeleton, 12.5, rotations, np.zeros((2, 1, 3)))
    seen = resample_rotations(clip, 25.0, (joint,))[:, 0]
    assert rotation.measure_angle_between(seen[0], seen[1]) == pytest.approx(1.2, abs=1e-5)


def test_another_skeletons_clip_is_refused():
    other = column()
    clip = Clip("x", other, 30, np.repeat(other.rest_rotations[None], 2, 0), np.zeros((2, 1, 3)))
    with pytest.raises(PoseError, match=r"'x' .*retarget it"):
        encode_clip(rig(), clip, 25.0)


def test_joints_that_do_not_move_are_not_blown_up():
    rows = np.tile([1.0, 0.5], (50, 1))
    rows[:, 1] += np.linspace(-1, 1, 50)
    scale = scale_of(rows)
    assert scale.deviation[0] == np.float32(LEAST)
    assert scale.deviation[1] == pytest.approx(rows[:, 1].std())
    assert np.abs(scale.undo(scale.apply(rows)) - rows).max() < 1e-6
    assert scale.undo(np.array([1e9, -1e9])).tolist() == pytest.approx(
        [1 + 8 * LEAST, rows[:, 1].mean() - 8 * scale.deviation[1]], abs=1e-5
    )


def test_a_twins_twin_is_the_take():
    clip = moving(2)
    pairs = find_joint_twins(clip.skeleton)
    own = rig()
    there = mirror(clip, pairs)
    back = mirror(there, pairs)
    assert np.abs(encode_clip(own, back, 25.0) - encode_clip(own, clip, 25.0)).max() < 1e-4
    assert np.abs(encode_clip(own, there, 25.0) - encode_clip(own, clip, 25.0)).max() > 0.05
