"""From where a figure is shown: so that its face is seen."""

from __future__ import annotations

import numpy as np
import pytest

from metagraph.motion import rotation
from metagraph.motion.skeleton import Skeleton
from preview.figure import StickFigure
from preview.framing import AVERTED, find_heading, find_lamp_turn, has_studio_lamp, turn_to_face
from preview.looks import look_of
from preview.scene import DARK, THEMES
from sample_clips.make.mannequin_skeleton import mannequin_skeleton

SKELETON = mannequin_skeleton()


def turned(angle):
    """Places of the joints at rest, turned about +Y."""
    at = SKELETON.globals(SKELETON.rest)[1]
    return rotation.rotate_vectors(rotation.from_axis_angle(np.array([0.0, 1.0, 0.0]), np.array(angle)), at)


@pytest.mark.parametrize("angle", [0.0, 0.4, -1.3, 2.0, 3.0])
def test_where_a_figure_faces_is_found(angle):
    assert find_heading(StickFigure(SKELETON), turned(angle)) == pytest.approx(angle, abs=1e-6)


def test_a_camera_goes_round_only_to_a_face_that_is_averted():
    figure = StickFigure(SKELETON)
    assert turn_to_face(figure, turned(AVERTED - 0.1)) == 0.0
    assert turn_to_face(figure, turned(np.pi - 0.1)) == pytest.approx(np.pi - 0.1)


def test_of_a_figure_without_sides_nothing_is_known():
    rod = Skeleton(("a", "b"), (-1, 0), np.tile([0.0, 0, 0, 1], (2, 1)), np.array([[0.0, 0, 0], [0, 1, 0]]))
    assert find_heading(StickFigure(rod), rod.globals(rod.rest)[1]) == 0.0


def test_the_lamp_stands_where_the_face_in_sight_is_lit_and_never_leaps():
    theme_yaw = np.arctan2(DARK.toward[0], DARK.toward[2])
    last = None
    for degrees in range(-180, 181, 3):
        yaw = np.radians(degrees)
        turn = find_lamp_turn(yaw)
        lamp = theme_yaw + (turn.angle if turn is not None else 0.0)
        if abs(degrees) <= 90:  # a cheek is seen at least
            assert np.cos(lamp) > 0.7, "the face is lit from the front"
            assert np.cos(lamp - yaw) > 0.4, "and on the camera's side"
        assert np.cos(lamp - yaw) > 0.35, "a back is not in shadow"
        if last is not None:
            assert np.cos(lamp - last) > np.cos(np.radians(6)), "an orbit moves the lamp steadily"
        last = lamp
    assert find_lamp_turn(np.radians(28.0)) is None, "as before, from three quarters"


def test_the_lamp_goes_with_where_the_character_faces():
    there, here = find_lamp_turn(np.radians(90 + 60), np.radians(90)), find_lamp_turn(np.radians(60))
    assert there.angle == pytest.approx(here.angle + np.radians(90))


def test_only_the_studios_lamp_follows():
    assert has_studio_lamp(THEMES["light"]) and has_studio_lamp(look_of("dark", "studio", "sky"))
    assert not has_studio_lamp(look_of("dark", "evening"))
