"""Levels of detail: kept on disk, made again whenever that is not what it was."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from preview import levels
from preview.figure import MeshFigure
from preview.levels import ERRORS, Level, find_levels_folder, make_levels
from preview.mesh import make_ball, make_egg
from tests.preview.test_simplify import mesh_of


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("METAGRAPH_MESH_CACHE", str(tmp_path / "kept"))
    return tmp_path / "kept"


def a_ball():
    positions, _, triangles = make_ball(0.5, 48, 32)
    return mesh_of(positions, triangles)


def same(one: tuple[Level, ...], other: tuple[Level, ...]) -> bool:
    return len(one) == len(other) and all(
        a.error == b.error
        and np.array_equal(a.mesh.vertices, b.mesh.vertices)
        and np.array_equal(a.mesh.triangles, b.mesh.triangles)
        and [vars(x) for x in a.mesh.batches] == [vars(x) for x in b.mesh.batches]
        for a, b in zip(one, other, strict=True)
    )


def test_levels_are_made_once_and_read_from_then_on(folder, monkeypatch):
    first = make_levels(a_ball(), 1.0)
    errors = [level.error for level in first]
    assert errors and errors == sorted(set(errors) & set(ERRORS))
    monkeypatch.setattr(levels, "simplify", lambda *_: pytest.fail("it was there"))
    assert same(make_levels(a_ball(), 1.0), first)


@pytest.mark.nightly
def test_another_mesh_or_height_is_another_matter(folder):
    make_levels(a_ball(), 1.0)
    make_levels(a_ball(), 2.0)
    positions, _, triangles = make_egg(1.0, 0.4, 40, 40)
    make_levels(mesh_of(positions, triangles), 1.0)
    assert len(list(folder.glob("*/*"))) == 3


@pytest.mark.nightly
@pytest.mark.parametrize("content", [b"", b"no archive", b"PK\x03\x04 cut"])
def test_what_is_broken_is_made_again(folder, content):
    first = make_levels(a_ball(), 1.0)
    (kept,) = folder.glob("*/*")
    kept.write_bytes(content)
    assert same(make_levels(a_ball(), 1.0), first)
    assert kept.read_bytes() != content


@pytest.mark.nightly
def test_what_points_beyond_the_mesh_is_made_again(folder):
    first = make_levels(a_ball(), 1.0)
    (kept,) = folder.glob("*/*")
    with np.load(kept) as held:
        content = dict(held)
    content["used0"] = content["used0"] + 100_000
    np.savez(kept, **content)
    assert same(make_levels(a_ball(), 1.0), first)


def test_little_is_drawn_as_it_is_and_what_is_cancelled_leaves_nothing(folder):
    positions, _, triangles = make_ball(0.5, 8, 6)
    assert make_levels(mesh_of(positions, triangles), 1.0) == ()
    assert make_levels(a_ball(), 1.0, lambda: True) == ()
    assert not list(folder.glob("*/*"))


def test_a_mesh_with_places_that_are_no_numbers_is_drawn_as_it_is(folder):
    mesh = a_ball()
    mesh.vertices["position"][7] = np.nan
    assert make_levels(mesh, 1.0) == ()


def test_a_level_with_hardly_fewer_triangles_is_none(folder):
    """Every edge of a cube's faces, cut into squares that share nothing, is a border."""
    corners = np.array([[x, 0.0, z] for x in (0, 1) for z in (0, 1)])
    squares = [corners + [n, n % 3, n % 5] for n in range(400)]
    triangles = [np.array([[0, 1, 3], [0, 3, 2]]) + 4 * n for n in range(400)]
    assert make_levels(mesh_of(np.concatenate(squares), np.concatenate(triangles)), 1.0) == ()


def test_a_folder_is_named_by_the_environment_or_there_is_none(monkeypatch):
    monkeypatch.setenv("METAGRAPH_MESH_CACHE", "")
    assert find_levels_folder() is None
    monkeypatch.delenv("METAGRAPH_MESH_CACHE")
    found = find_levels_folder()
    assert found is not None and found.name == "meshes"


def test_a_figure_is_drawn_with_the_fewest_triangles_that_are_near_enough(mannequin):
    from preview.figure import SkinnedFigure

    figure: MeshFigure = SkinnedFigure(mannequin)
    assert figure.finest(1.0) is figure.mesh, "before there are any"
    figure.simplify()
    made = figure.levels
    figure.simplify()
    assert figure.levels is made
    assert figure.finest(0.0) is figure.mesh
    assert [figure.finest(level.error) for level in made] == [level.mesh for level in made]
    assert figure.finest(1.0) is made[-1].mesh


@pytest.mark.gl
def test_levels_may_come_while_a_picture_is_drawn(offscreen, mannequin, monkeypatch):
    """They are made on another thread."""
    from preview.camera import make_whole_figure_camera
    from preview.figure import SkinnedFigure
    from preview.scene import DARK, Actor, Scene
    from preview.shadows import Shadows

    figure = SkinnedFigure(mannequin)
    scene = Scene((Actor(figure, *figure.skeleton.globals(figure.skeleton.rest)),))
    cast = Shadows.cast
    monkeypatch.setattr(Shadows, "cast", lambda *told: figure.simplify() or cast(*told))
    camera = make_whole_figure_camera(scene.bounds(), 4 / 3)
    before = offscreen.render(scene, camera, DARK, (160, 120)).astype(int)
    assert figure.levels
    after = offscreen.render(scene, camera, DARK, (160, 120)).astype(int)
    assert (before != after).any() and np.abs(before - after).mean() < 1.5
