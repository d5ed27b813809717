"""From where a figure is shown: so that its face is seen."""

from __future__ import annotations

import numpy as np
import pytest

from metagraph.motion import rotation
from metagraph.motion.skeleton import Skeleton
from preview.figure import StickFigure
from preview.framing import AVERTED, find_heading, turn_to_face
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
