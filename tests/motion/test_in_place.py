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
from metagraph.motion.in_place import keep_in_place, measure_travel


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
