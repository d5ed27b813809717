"""The mannequin's file and the sculpting it comes from."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from metagraph.formats.gltf.reader import read_character
from metagraph.motion import rotation
from sample_clips.make import mannequin, openings, sculpt, shapes
from sample_clips.make.mannequin_skeleton import mannequin_skeleton

FILE = Path(__file__).parents[2] / "sample_clips" / "mannequin.glb"


@pytest.fixture(scope="module")
def character():
    return read_character(FILE)


def test_the_file_is_small_and_light_enough_for_software_drawing(character):
    assert FILE.stat().st_size < 1_200_000
    assert len(character.triangles) < 20_000


def test_every_vertex_belongs_to_a_triangle(character):
    assert len(np.unique(character.triangles)) == len(character.positions)


def test_it_is_on_the_samples_skeleton(character):
    assert character.skeleton == mannequin_skeleton()


def test_weights_add_up_and_hold_only_numbers(character):
    assert np.isfinite(character.positions).all() and np.isfinite(character.normals).all()
    assert np.allclose(character.weights.sum(1), 1, atol=0.01)
    assert np.linalg.norm(character.normals, axis=1) == pytest.approx(
        np.ones(len(character.normals)), abs=0.02
    )


def test_it_stands_on_the_ground_and_is_as_tall_as_it_says(character):
    low, high = character.positions.min(0), character.positions.max(0)
    assert low[1] == pytest.approx(0, abs=0.003)
    assert 1.70 < high[1] < 1.76
    assert high[0] == pytest.approx(-low[0], abs=0.005)


def joints_of(character, chosen):
    """The joints that move the vertices `chosen` by a hundredth or more."""
    return {
        character.skeleton.names[j]
        for j in np.unique(character.joints[chosen][character.weights[chosen] > 0.01])
    }


def test_no_limb_pulls_at_another(character):
    p = character.positions
    left_leg, left_arm = (p[:, 1] < 0.7) & (p[:, 0] > 0.02), p[:, 0] > 0.45
    assert not any(n.startswith("Right") for n in joints_of(character, left_leg | left_arm))
    assert joints_of(character, left_arm & (p[:, 1] < 1.2)) <= {
        n for n in character.skeleton.names if n.startswith("Left")
    }


def test_a_fingers_end_is_moved_by_that_finger_alone(character):
    for finger in ("Thumb", "Index", "Middle", "Ring", "Little"):
        tip = shapes.finger_points(finger)[3]
        near = np.linalg.norm(character.positions - tip, axis=1) < 0.009
        assert near.any()
        assert all(n.startswith("Left" + finger) for n in joints_of(character, near))


def test_a_nod_does_not_part_the_lips(character):
    neck = character.skeleton.index("Neck")
    share = np.where(character.joints == neck, character.weights, 0).sum(1)
    x, y, z = np.abs(character.positions).T
    lips = (x < 0.025) & (np.abs(y - shapes.MOUTH_Y) < 0.012) & (z > 0.055)
    assert lips.sum() > 50 and share[lips].max() < 0.01, "both lips go with the head"
    assert share[(y < 1.47) & (y > 1.44) & (z < 0.03)].mean() > 0.3, "and the neck still bends"


def test_the_closing_angles_bring_the_lids_edges_together():
    for name, edge, turn in (
        ("Upper", openings.UPPER_LID_OPEN, mannequin.UPPER_LID_CLOSED),
        ("Lower", openings.LOWER_LID_OPEN, mannequin.LOWER_LID_CLOSED),
    ):
        at = np.array([0, np.sin(np.radians(edge)), np.cos(np.radians(edge))])
        closed = rotation.rotate_vectors(
            rotation.from_axis_angle(np.array([1.0, 0, 0]), np.radians(turn)), at
        )
        assert np.degrees(np.arcsin(closed[1])) == pytest.approx(-13.5, abs=1.0), name


@pytest.mark.nightly
def test_a_sculpted_ball_is_closed_even_and_on_its_surface():
    field = sculpt.ellipsoid((0, 0, 0), (0.1, 0.1, 0.1))
    positions, triangles = sculpt.polygonise(field, (-0.15,) * 3, (0.15,) * 3, 0.008)
    positions, triangles = sculpt.remesh(field, positions, triangles, lambda p: np.full(len(p), 0.03))
    positions = sculpt.project(field, positions)
    assert np.linalg.norm(positions, axis=1) == pytest.approx(np.full(len(positions), 0.1), abs=1e-5)
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    assert len(positions) - len(edges) // 2 + len(triangles) == 2
    assert len({tuple(e) for e in edges.tolist()}) == len(edges)
    length = np.linalg.norm(positions[edges[:, 0]] - positions[edges[:, 1]], axis=1)
    assert length.max() < 2.5 * length.min()


@pytest.mark.nightly
def test_the_same_is_sculpted_every_time():
    part = next(p for p in shapes.PARTS if p.name == "shoe")
    first, second = mannequin.sculpted(part), mannequin.sculpted(part)
    assert np.array_equal(first[0], second[0]) and np.array_equal(first[1], second[1])
