"""The stool."""

from __future__ import annotations

import numpy as np

from preview.camera import Camera
from preview.scene import LIGHT, Scene
from preview.stool import Stool, make_stool


def test_a_stool_stands_on_the_ground_and_its_seat_is_where_it_was_asked_for():
    actor = make_stool((0.2, 0.45, -0.3), 0.17)
    low, high = actor.figure.bounds(actor.positions)
    assert np.allclose(low[1], 0.0, atol=0.01)
    assert np.allclose(high[1], 0.45, atol=0.01)
    assert np.allclose((low + high)[[0, 2]] / 2, [0.2, -0.3], atol=0.01)


def test_stools_of_one_size_share_a_mesh():
    assert make_stool((0, 0.45, 0), 0.17).figure is make_stool((1, 0.45, 1), 0.17).figure


def test_its_mesh_moves_with_its_joint():
    palette = Stool(0.45, 0.17).palette(np.array([[0.0, 0, 0, 1]]), np.array([[1.0, 0.45, 2.0]]))
    assert np.allclose(palette[0], np.hstack([np.eye(3), [[1.0], [0.45], [2.0]]]))


def test_it_is_drawn(offscreen):
    camera = Camera(target=(0, 0.25, 0), distance=2.0)
    empty = offscreen.render(Scene(), camera, LIGHT)
    drawn = offscreen.render(Scene((make_stool((0, 0.45, 0), 0.17),)), camera, LIGHT)
    assert (np.abs(drawn.astype(int) - empty).max(-1) > 20).mean() > 0.01
