"""Clips kept in place: they end where they began, and move in between as they did."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.in_place import keep_in_place, measure_travel, stand_elsewhere
from metagraph.motion.skeleton import Pose, Skeleton


def going(clip: Clip, metres: float, degrees: float) -> Clip:
    """The clip going ahead and turning, evenly."""
    part = np.linspace(0.0, 1.0, clip.frames)
    turn = rotation.from_axis_angle(np.array([0.0, 1.0, 0.0]), np.radians(degrees) * part)
    rotations, places = clip.rotations.astype(float).copy(), clip.translations.astype(float).copy()
    rotations[:, 0] = rotation.multiply(turn, rotations[:, 0])
    places[:, 0] = (
        rotation.rotate_vectors(turn, places[:, 0]) + np.array([0.0, 0.0, 1.0]) * metres * part[:, None]
    )
    return replace(clip, rotations=rotations.astype(np.float32), translations=places.astype(np.float32))


def ends(clip: Clip) -> tuple[Any, Any]:
    return clip.skeleton.globals(clip.pose_at(np.array([0.0, clip.duration])))


def test_a_clip_of_one_frame_and_one_that_stays_are_as_they_were(toy: Any) -> None:
    still = toy.clip("still", 1.0)
    assert keep_in_place(still.trimmed(0, 1)).frames == 1
    kept = keep_in_place(still)
    np.testing.assert_allclose(kept.translations[:, 0], still.translations[:, 0], atol=1e-5)


@given(st.floats(-3, 3), st.floats(-170, 170))
def test_it_ends_where_it_began_whichever_way_it_went_and_turned(
    toy: Any, metres: float, degrees: float
) -> None:
    degrees = 0.0 if abs(degrees) < 10 else degrees
    kept = keep_in_place(going(toy.clip("walk", 2.0), metres, degrees))
    turns, places = ends(kept)
    np.testing.assert_allclose(places[0, :, (0, 2)], places[1, :, (0, 2)], atol=2e-3)
    assert measure_travel(kept, 0, 0.0, kept.duration) < 1e-3
    assert rotation.measure_angle_between(turns[0, :1], turns[1, :1]).max() < 0.01


def test_hips_that_rest_lying_turn_as_far_as_they_turn(toy: Any) -> None:
    clip = toy.clip("lie", 2.0)
    over = rotation.from_axis_angle(np.array([1.0, 0.0, 0.0]), np.radians(np.linspace(178, 183, clip.frames)))
    turned = clip.rotations.astype(float).copy()
    turned[:, 0] = rotation.multiply(over, turned[:, 0])
    lying = replace(clip, rotations=turned.astype(np.float32))
    assert (
        rotation.measure_angle_between(keep_in_place(lying).rotations[-1], lying.rotations[-1]).max() < 0.01
    )


def test_what_is_not_the_way_stays(toy: Any) -> None:
    clip = toy.clip("sway", 2.0)
    kept = keep_in_place(going(clip, 2.0, 0.0))
    np.testing.assert_allclose(kept.rotations, clip.rotations, atol=1e-5)
    np.testing.assert_allclose(kept.translations[:, 0], clip.translations[:, 0], atol=1e-4)


def test_how_far_it_goes_is_measured_between_the_seconds_that_play(toy: Any) -> None:
    clip = going(toy.clip("walk", 2.0, swing=0.0), 2.0, 0.0)
    assert measure_travel(clip, 0, 0.0, 2.0) == pytest.approx(2.0, abs=1e-3)
    assert measure_travel(clip, 0, 0.5, 1.0) == pytest.approx(0.5, abs=0.05)


def under_a_root(clip: Clip, carried: bool = False) -> Clip:
    """The clip under a joint that stands at the origin, turned as tools with another up axis leave it, with a
    second joint below it, as controls have. carried: that joint carries the clip's way.
    """
    bones = clip.skeleton
    tipped = np.array([-np.sqrt(0.5), 0.0, 0.0, np.sqrt(0.5)])
    places = bones.rest_translations.astype(float).copy()
    places[0] = rotation.rotate_vectors(rotation.conjugate(tipped), places[0])
    hips = rotation.multiply(rotation.conjugate(tipped), bones.rest_rotations[0].astype(float))
    under = Skeleton(
        ("root", *bones.names, "control"),
        np.concatenate([[-1], np.where(bones.parents < 0, 0, bones.parents + 1), [0]]),
        np.vstack([tipped, hips, bones.rest_rotations[1:], [0, 0, 0, 1]]),
        np.vstack([[0, 0, 0], places, [0.1, 0.0, 0.2]]),
    )
    count = clip.frames
    turns = np.tile(under.rest_rotations, (count, 1, 1)).astype(float)
    turns[:, 1:-1] = clip.rotations
    turns[:, 1] = rotation.multiply(rotation.conjugate(tipped), clip.rotations[:, 0].astype(float))
    at = rotation.rotate_vectors(rotation.conjugate(tipped), clip.translations[:, 0].astype(float))
    moved = np.stack([np.zeros((count, 3)), at], axis=1)
    if carried:
        moved[:, 0, 0] += 0.3
    return Clip(clip.name, under, clip.fps, turns.astype(np.float32), moved.astype(np.float32), (0, 1))


@pytest.mark.parametrize("carried", [False, True])
@pytest.mark.parametrize("degrees", [0.0, 35.0, 120.0, -179.0])
def test_what_stands_elsewhere_stands_there_with_everything_below_any_root(
    toy: Any, degrees: float, carried: bool
) -> None:
    clip = under_a_root(toy.clip("wave", 2.0), carried)
    turn = np.radians(degrees)
    after = stand_elsewhere(clip, turn, 0.5, -0.25)
    about = rotation.from_axis_angle(np.array([0.0, 1.0, 0.0]), np.full(clip.frames, turn))
    before, there = clip.skeleton.globals(clip.poses()), after.skeleton.globals(after.poses())
    for joint in range(0 if carried else 1, len(clip.skeleton)):
        places = rotation.rotate_vectors(about, before[1][:, joint].astype(float)) + np.array(
            [0.5, 0.0, -0.25]
        )
        np.testing.assert_allclose(there[1][:, joint], places, atol=1e-4)
        turned = rotation.multiply(about, before[0][:, joint].astype(float))
        assert np.abs((there[0][:, joint] * turned).sum(-1)).min() > 1 - 1e-5
    if not carried:  # so that no blend with a clip that stands elsewhere swings the hips about the root
        np.testing.assert_array_equal(after.rotations[:, 0], clip.rotations[:, 0])


def test_clips_from_all_over_the_floor_blend_without_a_swing_about_the_root(toy: Any) -> None:
    clip = under_a_root(toy.clip("rest", 1.0, swing=0.0))
    far = stand_elsewhere(clip, 2.0, 1.5, 0.5)
    back = stand_elsewhere(far, -2.0, *_back(1.5, 0.5, -2.0))
    a, b = clip.pose_at(0.0), back.pose_at(0.0)
    half = Pose(
        rotation.normalize((a.rotations + b.rotations) / 2.0), (a.translations + b.translations) / 2.0
    )
    hips = [clip.skeleton.globals(pose)[1][1] for pose in (a, half, b)]
    assert np.abs(np.diff(hips, axis=0)).max() < 1e-3
    kept = keep_in_place(under_a_root(going(toy.clip("walk", 2.0), 1.0, 90.0)))
    ends_at = kept.skeleton.globals(kept.pose_at(np.array([0.0, kept.duration])))[1]
    np.testing.assert_allclose(ends_at[0, 1, (0, 2)], ends_at[1, 1, (0, 2)], atol=2e-3)
    np.testing.assert_array_equal(kept.rotations[:, 0], kept.rotations[:1, 0].repeat(kept.frames, 0))


def _back(x: float, z: float, turn: float) -> tuple[float, float]:
    about = rotation.from_axis_angle(np.array([0.0, 1.0, 0.0]), turn)
    out = -rotation.rotate_vectors(about, np.array([x, 0.0, z]))
    return float(out[0]), float(out[2])
