"""Where a head is turned."""

from __future__ import annotations

import numpy as np
import pytest

from metagraph.mimicry.gaze_reading import EVERY, FAR, HeadFollower, measure_head_turn
from metagraph.mimicry.keypoint_layouts import PLACE
from metagraph.mimicry.pose_measures import turn_about_y
from metagraph.motion import rotation

FACE = {
    "nose": (0, 1.572, 0.125),
    "left_ear": (0.075, 1.6, 0),
    "right_ear": (-0.075, 1.6, 0),
    "left_eye": (0.03, 1.61, 0.1),
    "right_eye": (-0.03, 1.61, 0.1),
}


def face(turn: float = 0.0, pitch: float = 0.0) -> np.ndarray:
    out = np.zeros((17, 3))
    for name, at in FACE.items():
        out[PLACE[name]] = at
    middle = np.array([0, 1.6, 0])
    seen = rotation.rotate_vectors(rotation.from_axis_angle([1, 0, 0], -pitch), out - middle)
    return turn_about_y(seen, turn) + middle


@pytest.mark.parametrize("turn", [-0.8, -0.3, 0.0, 0.5])
@pytest.mark.parametrize("pitch", [-0.3, 0.0, 0.3])
def test_turn_and_pitch_are_found_in_space_and_about_in_a_picture(turn: float, pitch: float) -> None:
    assert measure_head_turn(face(turn, pitch), np.ones(17), 3) == pytest.approx((turn, pitch), abs=1e-6)
    flat = face(turn, pitch) * [1, 1, 0] * 700
    assert measure_head_turn(flat, np.ones(17), 2) == pytest.approx((turn, pitch), abs=0.2)


def test_a_head_that_is_hidden_or_turned_away_says_nothing() -> None:
    assert measure_head_turn(face(), np.zeros(17), 3) is None
    assert measure_head_turn(face(2.0), np.ones(17), 3) is None
    assert measure_head_turn(np.zeros((17, 3)), np.ones(17), 2) is None


def test_the_gaze_follows_in_steps_and_not_too_often() -> None:
    gaze = HeadFollower(face())
    first = gaze.feed(0.0, face(), np.ones(17), 3)
    assert first is not None and np.allclose(np.array(first) - gaze.eyes, [0, 0, FAR], atol=1e-3)
    assert gaze.feed(1.0, face(0.05), np.ones(17), 3) is None
    assert gaze.feed(1.1, face(0.5), np.ones(17), 3) is not None
    assert gaze.feed(1.1 + EVERY / 2, face(-0.5), np.ones(17), 3) is None
    point = gaze.feed(1.2 + EVERY, face(-0.5), np.ones(17), 3)
    assert point is not None and point[0] < -0.5
