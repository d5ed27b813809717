"""Cameras of a conversation: all on one side of the line, who is meant in the picture, nobody in the way."""

from __future__ import annotations

import numpy as np
import pytest

from preview.shots import find_camera_side, is_lamp_on_right, make_shot_camera, place_camera

HEADS = np.array([[-0.65, 1.6, 0.0], [0.65, 1.7, 0.0]])
HEIGHTS = [1.7, 1.8, 1.6]
HEAD = 0.13  # of the height, from chin to top
CIRCLE = np.array([[-0.9, 1.6, 0.0], [0.9, 1.6, 0.0], [0.0, 1.6, -1.2]])


def seen(shot, side, heads=HEADS, aspect=16 / 9):
    camera = make_shot_camera(shot, side, heads, HEIGHTS[: len(heads)], aspect)
    return camera, camera.project(heads, aspect)


@pytest.mark.parametrize("aspect", [16 / 9, 1.0, 9 / 16])
@pytest.mark.parametrize(
    "heads", [HEADS, HEADS @ np.diag([-1, 1, 1]), CIRCLE], ids=["two", "swapped", "three"]
)
def test_who_is_meant_is_in_the_picture_and_all_cameras_stand_on_one_side(heads, aspect):
    beside, middle = find_camera_side(heads), heads[:2].mean(0)
    for shot in ("over", "close", "two"):
        for side in range(len(heads)):
            camera, at = seen(shot, side, heads, aspect)
            shown = at if shot == "two" else at[[side]]
            assert ((shown > 0.04) & (shown < 0.96)).all()
            if len(heads) == 2:
                assert (camera.eye - middle) @ beside > 0


def test_over_a_shoulder_the_other_is_nearer_and_to_the_side_of_the_face():
    for heads, side, other in ((HEADS, 0, 1), (HEADS, 1, 0), (CIRCLE, 0, 1), (CIRCLE, 1, 0), (CIRCLE, 2, 0)):
        camera, at = seen("over", side, heads)
        away = np.linalg.norm(heads - camera.eye, axis=1)
        assert away[other] < 1.8 < 2.4 < away[side]
        assert abs(at[other, 0] - at[side, 0]) > 0.2, "the one does not hide the other"


def test_who_looks_to_the_right_does_so_in_every_picture():
    """The left one's partner is to the right of it, whatever is seen."""
    for shot in ("over", "two"):
        for side in (0, 1):
            _, at = seen(shot, side)
            assert at[0, 0] < at[1, 0]
    close, _ = seen("close", 0)
    assert close.axes[0] @ (HEADS[1] - HEADS[0]) > 0


def test_a_camera_is_where_it_was_put():
    camera = place_camera((1.0, 2.0, 3.0), (0.5, 1.0, -1.0), 0.5)
    assert camera.eye == pytest.approx([1.0, 2.0, 3.0]) and camera.target == (0.5, 1.0, -1.0)


def test_one_alone_is_seen_whole():
    camera, at = seen("over", 3, HEADS[:1])
    assert ((at > 0) & (at < 1)).all() and camera.distance > 1


def test_of_two_no_head_is_lower_than_120_of_540_pixels():
    for shot in ("over", "close", "two"):
        for side in (0, 1):
            camera, _ = seen(shot, side)
            for n in (0, 1) if shot == "two" else (side,):
                half = np.array([0.0, HEAD * HEIGHTS[n] / 2, 0.0])
                low, high = camera.project(np.array([HEADS[n] - half, HEADS[n] + half]), 16 / 9)
                assert abs(high[1] - low[1]) * 540 > 120, (shot, side, n)


def test_the_lamp_lights_the_side_of_a_face_that_is_turned_from_the_camera():
    for shot in ("over", "close"):
        for side in (0, 1):
            camera, _ = seen(shot, side)
            looks = camera.axes[0] @ (HEADS[1 - side] - HEADS[side])
            assert is_lamp_on_right(camera, shot, side, HEADS) == (looks > 0)
    assert not is_lamp_on_right(seen("two", 0)[0], "two", 0, HEADS)
