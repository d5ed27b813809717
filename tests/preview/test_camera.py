"""Camera: angles, framing and the agreement of its matrices with its rays."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from preview.camera import Camera, close_up, make_upper_body_camera, make_whole_figure_camera

angles = st.floats(-3.0, 3.0)


def test_yaw_zero_looks_at_the_face_from_positive_z():
    camera = Camera(target=(0, 1, 0), yaw=0, pitch=0, distance=3)
    assert np.allclose(camera.eye, [0, 1, 3])


def test_positive_yaw_shows_the_characters_left_side():
    assert Camera(yaw=math.radians(90), pitch=0).eye[0] > 1


def test_dragging_right_turns_the_figure_to_the_right_and_dragging_down_looks_from_above():
    start = Camera(yaw=0, pitch=0)
    turned = start.orbit(0.1, 0.1)
    assert turned.eye[0] < 0
    assert turned.eye[1] > start.eye[1]


def test_orbit_never_goes_over_the_top():
    camera = Camera().orbit(0, 10)
    assert camera.pitch < math.pi / 2
    assert np.isfinite(camera.view()).all()


def test_a_full_turn_comes_back_to_the_same_yaw():
    assert Camera().orbit(2.0, 0).yaw == pytest.approx(Camera().yaw)


def test_panning_moves_what_is_at_the_target_by_the_drag():
    camera = Camera()
    moved = camera.pan(0.25, -0.1)
    at = moved.project(camera.target, 1.0)
    assert at == pytest.approx([0.75, 0.4])


def test_zooming_in_and_out_by_as_much_changes_nothing():
    assert Camera().zoom(3).zoom(-3).distance == pytest.approx(Camera().distance)


def test_zoom_has_ends():
    assert Camera().zoom(1000).distance > 0
    assert Camera().zoom(-1000).distance < 1000


@given(yaw=angles, pitch=st.floats(-1.5, 1.5), aspect=st.floats(0.2, 4.0))
def test_framing_shows_every_corner_and_wastes_no_room(yaw, pitch, aspect):
    box = np.array([[-0.4, 0.0, -0.2], [0.7, 1.8, 0.3]])
    camera = Camera(yaw=yaw, pitch=pitch).frame((box[0], box[1]), aspect)
    corners = np.array([[box[i, 0], box[j, 1], box[k, 2]] for i in (0, 1) for j in (0, 1) for k in (0, 1)])
    seen = camera.project(corners, aspect)
    assert (seen >= -1e-9).all() and (seen <= 1 + 1e-9).all()
    assert max(np.abs(seen - 0.5).max(0)) > 0.44


def test_framing_something_without_size_or_that_is_not_a_number_still_gives_a_camera():
    assert np.isfinite(Camera().frame((np.zeros(3), np.zeros(3)), 1.0).distance)
    assert Camera().frame((np.full(3, np.nan), np.zeros(3)), 1.0) == Camera()


@given(x=st.floats(0, 1), y=st.floats(0, 1), yaw=angles)
def test_points_on_a_ray_are_seen_where_the_ray_was_asked_for(x, y, yaw):
    camera = Camera(yaw=yaw)
    origin, direction = camera.ray(x, y, 1.6)
    assert camera.project(origin + 2.5 * direction, 1.6) == pytest.approx([x, y])


def test_project_agrees_with_the_matrices():
    camera, point = Camera(), np.array([0.3, 1.2, 0.4])
    clip = camera.projection(1.5) @ camera.view() @ np.append(point, 1)
    ndc = clip[:3] / clip[3]
    assert camera.project(point, 1.5) == pytest.approx([ndc[0] / 2 + 0.5, 0.5 - ndc[1] / 2])
    assert -1 < ndc[2] < 1


def test_a_point_behind_the_eye_is_not_seen():
    assert np.isnan(Camera(yaw=0, pitch=0).project([0, 1, 50], 1.0)).all()


def test_the_presets_aim_where_they_say():
    whole = make_whole_figure_camera((np.array([-0.5, 0, -0.2]), np.array([0.5, 1.7, 0.2])), 16 / 9)
    face = close_up(np.array([0, 1.6, 0.02]), 1.7, 1.0)
    half = make_upper_body_camera(np.array([0, 1.6, 0.02]), 1.7, 1.0)
    assert whole.target == pytest.approx((0, 0.85, 0))
    assert face.distance < half.distance < whole.distance
    assert face.project([0, 1.6, 0.02], 1.0)[1] < 0.5
    assert abs(
        make_whole_figure_camera((-np.ones(3), np.ones(3)), 1.0, heading=1.0).yaw - whole.yaw
    ) == pytest.approx(1.0)
