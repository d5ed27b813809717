"""Measures of a person: the same wherever they stand, however large they are and, in space, however they are
turned.
"""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.mimicry import pose_measures as m
from metagraph.mimicry.keypoint_layouts import PLACE, POINTS
from metagraph.motion import rotation

WIDTH = 0.72
FIGURE = {
    "nose": (0, 1.6, 0.1),
    "left_eye": (0.03, 1.64, 0.08),
    "right_eye": (-0.03, 1.64, 0.08),
    "left_ear": (0.07, 1.62, 0),
    "right_ear": (-0.07, 1.62, 0),
    "left_shoulder": (0.18, 1.45, 0),
    "right_shoulder": (-0.18, 1.45, 0),
    "left_elbow": (0.25, 1.2, -0.03),
    "right_elbow": (-0.25, 1.2, 0.02),
    "left_wrist": (0.1, 1.1, 0.2),
    "right_wrist": (-0.27, 0.95, 0.05),
    "left_hip": (0.1, 0.95, 0),
    "right_hip": (-0.1, 0.95, 0),
    "left_knee": (0.1, 0.5, 0.02),
    "right_knee": (-0.1, 0.5, 0.02),
    "left_ankle": (0.12, 0.08, -0.02),
    "right_ankle": (-0.12, 0.08, -0.02),
}
SURE = np.ones(17)


def figure() -> np.ndarray:
    return np.array([FIGURE[name] for name in POINTS], float)


def measures(points: np.ndarray, dims: int = 3, sure: np.ndarray = SURE) -> dict[str, np.ndarray]:
    frame = m.measure_body_frame(points, sure, dims, WIDTH)
    assert frame is not None
    return {layer: m.measure_pose(layer, points, frame) for layer in m.MEASURES}


def test_points_that_make_no_torso_have_no_frame() -> None:
    assert m.measure_body_frame(figure(), np.zeros(17), 3, WIDTH) is None
    assert m.measure_body_frame(np.zeros((17, 3)), SURE, 3, WIDTH) is None
    lying = figure()[:, [1, 0, 2]]
    assert m.measure_body_frame(lying, SURE, 3, WIDTH) is None
    assert m.measure_body_frame(figure() * [1, -1, 1], SURE, 3, WIDTH) is None


@given(st.floats(-3, 3), st.floats(0.01, 1000), st.floats(-100, 100), st.floats(-100, 100))
def test_place_size_and_heading_change_nothing_in_space(turn: float, size: float, x: float, z: float) -> None:
    before = measures(figure())
    after = measures(m.turn_about_y(figure(), turn) * size + [x, 0, z])
    for layer, some in before.items():
        assert np.allclose(some, after[layer], atol=1e-6), layer


def test_the_heading_is_found_in_space() -> None:
    for angle in (-1.2, -0.3, 0.0, 0.7):
        frame = m.measure_body_frame(m.turn_about_y(figure(), angle), SURE, 3, WIDTH)
        assert frame is not None and frame.heading == pytest.approx(angle, abs=1e-9)
        assert frame.size == pytest.approx(0.5) and frame.width == pytest.approx(WIDTH * np.cos(angle))


def test_arms_are_seen_from_the_torso_and_the_body_upright() -> None:
    tilt = rotation.from_axis_angle([0, 0, 1.0], 0.3)
    middle = np.array([0, 0.95, 0])
    leaning = figure()
    upper = [PLACE[n] for n in POINTS if not n.endswith(("hip", "knee", "ankle"))]
    leaning[upper] = rotation.rotate_vectors(tilt, leaning[upper] - middle) + middle
    before, after = measures(figure()), measures(leaning)
    rows = [
        n for n, measure in enumerate(m.MEASURES["arms"]) if not any(k.endswith("hip") for k in measure.minus)
    ]
    assert np.allclose(before["arms"][rows], after["arms"][rows], atol=1e-9)
    assert not np.allclose(before["body"], after["body"], atol=0.05)


def test_a_picture_gives_the_first_two_of_three_when_facing_it() -> None:
    flat = measures(figure() * [1, 1, 0], 2)
    for layer, some in measures(figure()).items():
        assert np.allclose(flat[layer][:, :2], some[:, :2], atol=1e-9), layer


def test_without_hips_the_torso_is_guessed_from_shoulders_and_ears() -> None:
    sure = SURE.copy()
    sure[[PLACE["left_hip"], PLACE["right_hip"]]] = 0
    frame = m.measure_body_frame(figure(), sure, 2, WIDTH)
    assert frame is not None and frame.size == pytest.approx(0.5, rel=0.02) and tuple(frame.up) == (0, 1, 0)
    aside = m.turn_about_y(figure(), 0.9) * [1, 1, 0]  # the shoulders say less, the ears as much
    turned = m.measure_body_frame(aside, sure, 2, WIDTH)
    assert turned is not None and turned.size == pytest.approx(0.5, rel=0.2)
    sure[[PLACE["left_ear"], PLACE["right_ear"]]] = 0
    assert m.measure_body_frame(figure(), sure, 2, WIDTH).size == pytest.approx(0.5)  # type: ignore[union-attr]


def test_a_measure_is_trusted_as_far_as_its_least_certain_point() -> None:
    sure = SURE.copy()
    sure[PLACE["left_wrist"]], sure[PLACE["right_hip"]] = 0.0, 0.4
    for measure, t in zip(m.MEASURES["arms"], m.measure_trust("arms", sure), strict=True):
        names = {*measure.plus, *measure.minus}
        assert t == (0.0 if "left_wrist" in names else 0.4 if "right_hip" in names else 1.0)


def test_every_measure_is_a_difference() -> None:
    for layer, rows in m.ROWS.items():
        assert np.allclose(rows.sum(1), 0), layer


@given(st.floats(-1.5, 1.5), st.floats(-0.9, 0.9), st.floats(-0.9, 0.9))
def test_straightening_takes_up_to_y_and_keeps_lengths(x: float, y: float, z: float) -> None:
    up = np.array([x, 1.0 + y, z])
    up /= np.linalg.norm(up)
    vectors = np.vstack([up, np.eye(3)])
    out = m.straighten(vectors, up)
    assert np.allclose(out[0], [0, 1, 0], atol=1e-9)
    assert np.allclose(np.linalg.norm(out, axis=1), 1)


def test_lines_are_believed_less_the_more_somebody_is_turned_in_a_picture() -> None:
    ahead, aside = (m.weigh_in_picture("head", turn) for turn in (0.0, 0.8))
    assert np.allclose(ahead, m.SHARP["head"][:, :2])
    assert (aside <= ahead).all() and (aside[1:3, 1] < ahead[1:3, 1]).all()
