"""Tops are level upper faces that are large enough for a hand."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from metagraph.motion.prop_tops import find_tops


def box(size: tuple[float, float, float], at: tuple[float, float, float] = (0, 0, 0)) -> trimesh.Trimesh:
    mesh = trimesh.creation.box(size)
    mesh.apply_translation(at)
    return mesh


def tilt(mesh: trimesh.Trimesh, degrees: float) -> trimesh.Trimesh:
    mesh.apply_transform(trimesh.transformations.rotation_matrix(np.radians(degrees), [1, 0, 0]))
    return mesh


def test_a_desk_has_one_top_as_high_and_as_large_as_its_board() -> None:
    desk = trimesh.util.concatenate(
        [box((1.4, 0.03, 0.7), (0, 0.725, 0)), box((0.05, 0.7, 0.05), (0.6, 0.35, 0))]
    )
    (top,) = find_tops(desk.vertices, desk.faces)
    assert top.height == pytest.approx(0.74)
    assert top.inside.sum() * 0.02**2 == pytest.approx(1.4 * 0.7, rel=0.05)
    places = np.array([[0, 0, 0], [0.69, 0, 0.34], [0.8, 0, 0], [0, 0, 0.5]])
    assert top.contains(places).tolist() == [True, True, False, False]
    assert top.find_heights(places).tolist() == pytest.approx([0.74] * 4)  # beside it, those of its edge


@pytest.mark.parametrize(
    "mesh",
    [box((0.1, 0.1, 0.1)), box((1, 0.1, 0.1)), tilt(box((1, 0.05, 1)), 30), box((1, 1, 1), (9, 0, 0))],
    ids=["tiny", "narrow", "tipped", "far"],
)
def test_what_is_tiny_narrow_tipped_or_far_has_none(mesh: trimesh.Trimesh) -> None:
    assert find_tops(mesh.vertices, mesh.faces) == ()


def test_a_lectern_slopes_and_its_heights_follow_it() -> None:
    board = tilt(box((0.6, 0.02, 0.45)), 15)
    (top,) = find_tops(board.vertices, board.faces)
    at = np.array([[0, 0, -0.1], [0, 0, 0.1]])
    near, far = top.find_heights(at)
    assert near - far == pytest.approx(0.2 * np.tan(np.radians(15)), abs=2e-3)
    for place, high in zip(at, (near, far), strict=True):
        place = (*place[[0]], high, *place[[2]])
        closest = trimesh.triangles.closest_point(board.triangles, np.repeat([place], len(board.faces), 0))
        assert np.linalg.norm(closest - place, axis=1).min() < 2e-3


def test_two_boards_one_above_the_other_are_two_tops() -> None:
    shelf = trimesh.util.concatenate([box((1, 0.02, 0.4), (0, 0.3, 0)), box((1, 0.02, 0.4), (0, 0.9, 0))])
    assert [top.height for top in find_tops(shelf.vertices, shelf.faces)] == pytest.approx([0.31, 0.91])


def test_the_boards_of_a_bench_are_one_top() -> None:
    boards = [box((1.5, 0.03, 0.09), (0, 0.4, z)) for z in (-0.15, -0.05, 0.05, 0.15)]
    bench = trimesh.util.concatenate(boards)
    (top,) = find_tops(bench.vertices, bench.faces)
    assert top.contains(np.array([0.0, 0.0, 0.0]))


def test_an_open_surface_is_a_top_from_both_sides() -> None:
    points = np.array([[-1, 0.7, -1], [1, 0.7, -1], [1, 0.7, 1], [-1, 0.7, 1]], float)
    down = np.array([[0, 1, 2], [0, 2, 3]])
    assert find_tops(points, down) == () and len(find_tops(points, down, both=True)) == 1


def test_a_ball_of_many_triangles_is_level_only_on_its_top() -> None:
    ball = trimesh.creation.icosphere(5, 1.0)
    (top,) = find_tops(ball.vertices, ball.faces)
    i, k = np.nonzero(top.inside)
    assert np.hypot(top.x + i * 0.02, top.z + k * 0.02).max() == pytest.approx(
        np.sin(np.radians(20)), abs=0.03
    )


def test_one_place_has_the_height_of_many() -> None:
    board = tilt(box((0.6, 0.02, 0.45)), 15)
    (top,) = find_tops(board.vertices, board.faces)
    places = np.random.default_rng(1).uniform(-0.4, 0.4, (50, 3))
    assert [top.meet(x, z)[0] for x, _, z in places] == pytest.approx(
        top.find_heights(places).tolist(), abs=1e-9
    )
    assert top.meet(0, 0)[1] == 1 and top.meet(3, 3)[1] == 0
