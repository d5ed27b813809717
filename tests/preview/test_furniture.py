"""The chair and the rug."""

from __future__ import annotations

import numpy as np

from metagraph.motion import rotation
from preview.camera import Camera
from preview.furniture import make_box, make_chair, make_rug
from preview.scene import LIGHT, Scene


def points(actor):
    """Where all vertices of a piece of furniture are, in metres."""
    at = actor.figure.mesh.vertices["position"].astype(float)
    return rotation.rotate_vectors(actor.rotations[0], at) + actor.positions[0]


def test_the_sides_of_a_box_look_outwards():
    positions, normals, corners = make_box((1, 2, 3), (0.5, 1.0, 1.5))
    assert np.allclose(positions.min(0), [0.5, 1, 1.5]) and np.allclose(positions.max(0), [1.5, 3, 4.5])
    a, b, c = (positions[corners[:, i]] for i in range(3))
    across = np.cross(b - a, c - a)
    assert (np.einsum("ij,ij->i", across, normals[corners[:, 0]]) > 0).all()


def test_a_chair_stands_on_the_ground_with_its_back_behind_who_sits_there():
    for turn in (0.0, np.pi / 2):
        at = points(make_chair((0.2, 0.45, -0.3), 0.17, turn)) - [0.2, 0, -0.3]
        assert abs(at[:, 1].min()) < 1e-3
        ahead = at @ [np.sin(turn), 0, np.cos(turn)]
        assert ahead[at[:, 1] > 0.6].max() < -0.15, "only the back is above the seat, and that is behind"
        assert 0.8 < at[:, 1].max() < 0.95


def test_a_rug_lies_on_the_ground():
    at = points(make_rug((0.2, 0.0, -0.3), 0.8))
    assert at[:, 1].min() >= 0 and at[:, 1].max() < 0.01
    assert np.allclose((at.min(0) + at.max(0))[[0, 2]] / 2, [0.2, -0.3], atol=0.01)


def test_both_are_drawn(offscreen):
    camera = Camera(target=(0, 0.25, 0), distance=2.6)
    empty = offscreen.render(Scene(), camera, LIGHT).astype(int)
    for actor in (make_chair((0, 0.45, 0), 0.17, 0.5), make_rug((0, 0, 0), 0.7)):
        drawn = offscreen.render(Scene((actor,)), camera, LIGHT)
        assert (np.abs(drawn - empty).max(-1) > 20).mean() > 0.01
