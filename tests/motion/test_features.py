"""Features: speed, stroke, loop error, distance of poses."""

from __future__ import annotations

import numpy as np
import pytest

from metagraph.motion import features, rotation
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Pose, Skeleton

ARM = Skeleton(
    ("root", "hand"), np.array([-1, 0]), np.tile([0.0, 0, 0, 1], (2, 1)), np.array([[0, 1.0, 0], [0.5, 0, 0]])
)


def turning(angles: np.ndarray, travel: float = 0.0, fps: float = 30.0) -> Clip:
    rotations = np.tile([0.0, 0, 0, 1], (len(angles), 2, 1))
    rotations[:, 0] = rotation.from_axis_angle(np.tile([0, 1.0, 0], (len(angles), 1)), angles)
    translations = np.zeros((len(angles), 1, 3))
    translations[:, 0, 0] = 3 + travel * np.arange(len(angles)) / fps
    return Clip("turn", ARM, fps, rotations, translations)


def test_one_frame_has_no_speed_and_its_stroke_is_at_0() -> None:
    one = turning(np.zeros(1))
    assert features.measure_speed(one, [1]).tolist() == [0]
    assert features.find_stroke(features.measure_speed(one, [1]), 30) == 0
    assert features.find_stroke(np.zeros(0), 30) == 0
    assert features.measure_loop_error(one) == 0


def test_no_joints_have_no_speed_and_no_distance() -> None:
    c = turning(np.linspace(0, 1, 5))
    assert not features.measure_speed(c, []).any()
    assert features.measure_pose_distance(ARM, c.poses(), c.poses(), []).tolist() == [0] * 5


def test_the_speed_of_a_turning_hand_is_radius_times_rate() -> None:
    speed = features.measure_speed(turning(np.linspace(0, 2, 61)), [1])
    assert speed[30] == pytest.approx(0.5 * 1.0, rel=1e-3)  # 2 radians in 2 seconds, half a metre out


def test_speed_can_be_taken_relative_to_another_joint() -> None:
    assert features.measure_speed(turning(np.zeros(10), travel=1.5), [1])[5] == pytest.approx(1.5, rel=1e-4)
    assert features.measure_speed(turning(np.zeros(10), travel=1.5), [1], frame_of=0)[5] == pytest.approx(
        0, abs=1e-4
    )


def test_the_stroke_is_where_the_hand_is_fastest() -> None:
    x = np.linspace(0, 1, 61)
    c = turning(np.where(x < 0.5, 0, 1) + 0.1 * x)
    assert features.find_stroke(features.measure_speed(c, [1]), c.fps) == pytest.approx(1.0, abs=0.05)


def test_a_loop_is_open_by_the_distance_of_its_ends() -> None:
    c = turning(np.linspace(0, np.pi, 31))
    assert features.measure_loop_error(c) == pytest.approx(1.0, abs=1e-5)  # half a turn, half a metre out
    assert features.measure_loop_error(c, 0.5, 0.5) == pytest.approx(0, abs=1e-6)
    assert features.measure_loop_error(turning(np.linspace(0, 2 * np.pi, 31))) == pytest.approx(0, abs=1e-5)


def test_poses_are_compared_with_their_roots_together() -> None:
    a, b = turning(np.zeros(1)).pose_at(0), turning(np.zeros(1), travel=0).pose_at(0)
    moved = Pose(b.rotations, b.translations + np.array([[5.0, 0, 0], [0, 0, 0]]))
    assert features.measure_pose_distance(ARM, a, moved) == pytest.approx(0, abs=1e-6)


def test_poses_are_as_far_apart_alone_as_among_others_and_whatever_types_they_have() -> None:
    clip = turning(np.linspace(0, 2, 5))
    poses, exact = clip.poses(), ARM.rest
    found = features.measure_pose_distance(ARM, poses, poses[::-1], [0, 1])
    assert [features.measure_pose_distance(ARM, poses[n], poses[4 - n], [0, 1]) for n in range(5)] == list(
        found
    )
    for n in range(5):
        (one,), other = ARM.globals(poses[n : n + 1])[1], ARM.globals(exact)[1]
        apart = np.linalg.norm((one - one[:1]) - (other - other[:1]), axis=-1).max()
        assert features.measure_pose_distance(ARM, poses[n], exact) == apart
        assert features.measure_pose_distance(ARM, exact, poses[n]) == apart


def test_positions_start_above_the_origin() -> None:
    where = features.measure_positions(turning(np.zeros(4), travel=1.0))
    assert where[0, 0].tolist() == [0, 0, 0]
    assert where[3, 0, 0] == pytest.approx(0.1)
