"""A prop's turn."""

from __future__ import annotations

import numpy as np
import pytest

from metagraph.graph.prop import Prop, make_turn
from metagraph.motion import rotation


@pytest.mark.parametrize(
    "turn", [(0, 0, 0), (90, 0, 0), (0, 90, 0), (0, 0, 90), (20, 50, -70), (180, -180, 359)]
)
def test_a_prop_is_turned_about_x_then_y_then_z(turn: tuple[float, float, float]) -> None:
    point = np.array([1.0, 2, 3])
    expected = point
    for axis, degrees in zip(np.eye(3), turn, strict=True):
        expected = rotation.rotate_vectors(
            rotation.from_axis_angle(axis, np.array(np.radians(degrees))), expected
        )
    made = rotation.rotate_vectors(np.array(make_turn(Prop(name="a", path="a.obj", turn=turn))), point)
    np.testing.assert_allclose(made, expected, atol=1e-9)
