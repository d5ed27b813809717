"""Props are drawn where they stand, and with the joint that carries them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh

from app.stage.playback_source import ShownPlayback
from app.stage.props import PropMeshes, make_prop_actors, read_prop_meshes
from metagraph.graph.editing.props import add_prop
from metagraph.graph.model import Project
from metagraph.graph.prop import Prop
from metagraph.playback.planner import make_plan
from metagraph.speech.duet import Stand
from tests.conftest import Toy


@pytest.fixture
def room(tmp_path: Path) -> tuple[Project, PropMeshes, str]:
    """A project with a desk that stands and a cup that a joint carries; the joint."""
    (tmp_path / "box.glb").write_bytes(trimesh.creation.box((1, 1, 1)).export(file_type="glb"))
    project = Toy().project()
    assert project.skeleton is not None
    joint = project.skeleton.names[1]
    project, _ = add_prop(project, Prop(name="desk", path="box.glb", at=(1, 0, 2), turn=(0, 90, 0)))
    project, _ = add_prop(project, Prop(name="cup", path="box.glb", at=(0, 0.1, 0), scale=0.1, joint=joint))
    meshes, problems = read_prop_meshes(project, tmp_path)
    assert problems == []
    return project, meshes, joint


def show(project: Project, **more: object) -> ShownPlayback:
    return replace(ShownPlayback(project, make_plan(project, 2.0), 2.0), **more)  # type: ignore[arg-type]


def place(shown: ShownPlayback) -> tuple[np.ndarray, np.ndarray]:
    assert shown.skeleton is not None
    pose = shown.pose(0.5)
    assert pose is not None
    rotations, positions = shown.skeleton.globals(pose)
    return (rotations, positions) if shown.stand is None else shown.stand.placed(rotations, positions)


def test_what_stands_stays_and_what_is_carried_goes_with_its_joint(
    room: tuple[Project, PropMeshes, str],
) -> None:
    project, meshes, joint = room
    shown = show(project)
    placed = place(shown)
    desk, cup = make_prop_actors(shown, meshes, placed)
    np.testing.assert_allclose(desk.positions[0], (1, 0, 2))
    number = project.skeleton.names.index(joint)  # type: ignore[union-attr]
    off = cup.positions[0] - placed[1][number]
    assert np.linalg.norm(off) == pytest.approx(0.1, abs=1e-6)
    assert float(np.ptp(cup.figure.mesh.vertices["position"][:, 0])) == pytest.approx(0.1, abs=1e-6)


def test_in_a_conversation_the_first_speaker_has_what_stands_and_each_what_it_carries(
    room: tuple[Project, PropMeshes, str],
) -> None:
    project, meshes, _ = room
    first = show(project, stand=Stand(turn=np.pi / 2, x=3.0))
    second = show(project, stand=Stand(x=-3.0), side=1)
    desk, cup = make_prop_actors(first, meshes, place(first))
    np.testing.assert_allclose(desk.positions[0], (3 + 2, 0, -1), atol=1e-6)
    (other,) = make_prop_actors(second, meshes, place(second))
    assert other.figure is cup.figure and np.linalg.norm(other.positions - cup.positions) > 1


def test_a_clip_alone_has_no_props_and_a_joint_that_is_gone_leaves_its_prop_out(
    room: tuple[Project, PropMeshes, str],
) -> None:
    project, meshes, _ = room
    clip = next(iter(project.clips))
    alone = show(project, clip=clip)
    assert list(make_prop_actors(alone, meshes, place(show(project)))) == []
    gone = replace(project, props={"o1": Prop(name="cup", path="box.glb", joint="Tail")})
    assert list(make_prop_actors(show(gone), meshes, place(show(gone)))) == []


def test_a_prop_that_cannot_be_read_is_said_and_others_are_drawn(tmp_path: Path) -> None:
    project, _ = add_prop(Toy().project(), Prop(name="gone", path="gone.obj"))
    (tmp_path / "box.stl").write_bytes(trimesh.creation.box().export(file_type="stl"))
    project, _ = add_prop(project, Prop(name="box", path="box.stl"))
    meshes, problems = read_prop_meshes(project, tmp_path)
    assert list(meshes.meshes) == [tmp_path / "box.stl"]
    assert len(problems) == 1 and "gone.obj" in problems[0]


def test_sizes_that_nothing_has_any_more_are_forgotten(room: tuple[Project, PropMeshes, str]) -> None:
    _, meshes, _ = room
    (place_of,) = meshes.meshes
    one, two = meshes.find_figure(place_of, 1.0), meshes.find_figure(place_of, 2.0)
    meshes.keep_used({(place_of, 2.0)})
    assert meshes.find_figure(place_of, 2.0) is two and meshes.find_figure(place_of, 1.0) is not one
    meshes.keep_used(set())
    assert meshes.meshes == {} and meshes.find_figure(place_of, 2.0) is None
