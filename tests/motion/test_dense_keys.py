from __future__ import annotations

import numpy as np
import pytest

from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.dense_keys import RATE, count_steps, fill_between_keys
from metagraph.motion.skeleton import Skeleton

ONE = Skeleton(("root",), np.array([-1]), np.array([[0.0, 0, 0, 1]]), np.zeros((1, 3)))


def swaying(fps: float, seconds: float = 2.0, hertz: float = 1.0) -> Clip:
    """Return a joint that turns to and fro by a radian, and moves by a metre."""
    times = np.arange(round(seconds * fps) + 1) / fps
    wave = np.sin(2 * np.pi * hertz * times)
    turns = rotation.from_axis_angle(np.array([0.0, 1, 0]), wave)[:, None]
    return Clip("sway", ONE, fps, turns, wave[:, None, None] * np.array([1.0, 0, 0]))


@pytest.mark.parametrize(
    ("fps", "steps"), [(0.5, 120), (15, 4), (24, 3), (25, 3), (29.97, 3), (30, 2), (59, 2), (60, 1), (120, 1)]
)
def test_dense_keys_are_at_least_sixty_a_second(fps: float, steps: int) -> None:
    assert count_steps(fps) == steps
    assert fps * steps >= RATE - 1e-3


def test_the_keys_of_a_clip_stay_as_they_are() -> None:
    clip = swaying(24)
    dense = clip.dense
    assert dense.frames == 3 * (clip.frames - 1) + 1 and dense.duration == pytest.approx(clip.duration)
    assert np.abs(dense.rotations[::3] - clip.rotations).max() < 1e-6
    assert np.array_equal(dense.translations[::3], clip.translations)


def test_a_clip_of_sixty_frames_a_second_or_of_one_frame_is_dense() -> None:
    fast, single = swaying(60), swaying(30, seconds=0)
    assert fast.dense is fast and single.dense is single


def test_a_clip_of_two_frames_goes_straight_from_one_to_the_other() -> None:
    clip = Clip("two", ONE, 30, np.tile(rotation.IDENTITY, (2, 1, 1)), np.array([[[0.0, 0, 0]], [[1, 0, 0]]]))
    assert clip.dense.translations[:, 0, 0] == pytest.approx([0, 0.5, 1])


def test_keys_that_are_straight_stay_alone() -> None:
    clip = swaying(30)
    straight = Clip("sway", ONE, 30, clip.rotations, clip.translations, straight=True)
    assert straight.dense is straight


def test_a_sine_of_thirty_frames_a_second_is_eight_times_nearer_than_by_straight_lines() -> None:
    clip, exact = swaying(30, hertz=2), swaying(60, hertz=2)
    lines = (clip.translations[1:] + clip.translations[:-1]) / 2
    cubic = np.abs(clip.dense.translations - exact.translations)[1::2].max()
    assert cubic < np.abs(lines - exact.translations[1::2]).max() / 8
    turns = rotation.measure_angle_between(clip.dense.rotations[:, 0], exact.rotations[:, 0])
    assert turns.max() < np.radians(0.15)


def test_what_is_held_stays_still_and_a_jump_of_one_frame_does_not_swing() -> None:
    values = np.array([0.0, 0, 0, 1, 1, 1])[:, None]
    dense = fill_between_keys(values, 4, False)[:, 0]
    assert np.array_equal(dense[:9], np.zeros(9)) and np.array_equal(dense[12:], np.ones(9))
    assert np.all(np.diff(dense) >= 0)


def test_a_slow_move_before_a_jump_does_not_swing_back() -> None:
    values = np.array([0.0, 0.01, 0.02, 1.0, 1.01, 1.02])[:, None]
    assert np.all(np.diff(fill_between_keys(values, 8, False)[:, 0]) > 0)


def test_turning_the_whole_motion_turns_what_is_between() -> None:
    clip = swaying(30)
    turn = rotation.from_axis_angle(np.array([1.0, 2, 3]), np.array(1.1)).astype(np.float32)
    turned = fill_between_keys(rotation.multiply(turn, clip.rotations), 2, False)
    assert np.abs(turned - rotation.multiply(turn, fill_between_keys(clip.rotations, 2, False))).max() < 1e-6


def test_a_loop_goes_on_over_its_seam() -> None:
    loop = swaying(30, seconds=1.0)
    ends = loop.dense.translations[:, 0, 0]
    exact = np.sin(2 * np.pi * np.arange(61) / 60)
    assert abs(ends[1] - exact[1]) < 1e-3 and abs(ends[-2] - exact[-2]) < 1e-3
    part = Clip("part", ONE, 30, loop.rotations[:20], loop.translations[:20])
    assert np.abs(part.dense.translations[:39, 0, 0] - exact[:39])[1::2][1:-1].max() < 1e-3


def test_weights_of_morphs_are_on_curves_and_within_their_keys_where_they_are_held() -> None:
    weights = np.array([0.0, 0, 0.5, 1, 1, 1])[:, None]
    still = np.tile(rotation.IDENTITY, (6, 1, 1))
    clip = Clip("blink", ONE, 30, still, np.zeros((6, 1, 3)), morphs=("shut",), weights=weights)
    shown = [clip.morphs_at(t)["shut"] for t in np.linspace(0, 5 / 30, 101)]
    assert min(shown) == 0 and max(shown) == 1 and shown == sorted(shown)
    assert clip.morphs_at(1.5 / 30)["shut"] < 0.25  # not on the straight line


def test_poses_are_sampled_from_dense_keys() -> None:
    clip = swaying(30)
    assert np.array_equal(clip.pose_at(1 / 60).translations[0], clip.dense.translations[1, 0])
