"""Who sits is carried: by a stool as high as the underside of its body, or by a prop below it."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
import trimesh

from app.stage.playback_source import ShownPlayback
from app.stage.props import PropMeshes, read_prop_meshes
from app.stage.seat_fit import find_carrying_prop, fit_prop_to_seat, measure_seat_height
from app.stage.stools import make_stools
from metagraph.formats.store import open_project
from metagraph.graph.checks.end_gaps import get_action_motion
from metagraph.graph.editing.props import add_prop
from metagraph.graph.model import Project
from metagraph.graph.prop import Prop
from metagraph.graph.seats import Seat, find_seat
from metagraph.playback.plan import Plan
from preview.character_file import load_mesh_figure
from preview.figure import MeshFigure
from preview.posed_points import find_posed_points

SAMPLES = Path(__file__).resolve().parents[3] / "sample_clips"
BODIES = ["ada.glb", "ben.glb", "mannequin.glb", ""]


@cache
def sitting() -> tuple[Project, Seat]:
    project = open_project(SAMPLES / "seated.metagraph.yaml").project
    seat = find_seat(project)
    assert seat is not None
    return project, seat


@cache
def body(name: str) -> MeshFigure:
    project, _ = sitting()
    assert project.skeleton is not None
    return load_mesh_figure(SAMPLES / name if name else None, project.skeleton, ())


def place_body(figure: MeshFigure) -> tuple[np.ndarray, np.ndarray]:
    """Its vertices and triangles as it sits."""
    project, seat = sitting()
    action = project.action(seat.stance)
    assert action is not None
    motion = get_action_motion(project, action)
    assert motion is not None
    pose = motion.pose_at(project.span(action)[0])
    points = find_posed_points(figure, *figure.skeleton.globals(pose))
    return points, np.asarray(figure.mesh.triangles).reshape(-1, 3)


def measure_sinking(figure: MeshFigure, top: float, radius: float = 0.13) -> tuple[float, float]:
    """How deep the body is in a round seat, metres, and its distance from the seat's surface, by trimesh."""
    _, seat = sitting()
    points, triangles = place_body(figure)
    corners = points[np.unique(triangles)]
    over = np.hypot(corners[:, 0] - seat.at[0], corners[:, 2] - seat.at[2]) < radius
    deepest = top - float(corners[over, 1].min())
    ring = np.array([[seat.at[0], top, seat.at[2]]])
    near = triangles[(np.linalg.norm(points[triangles] - ring[:, None], axis=2) < 0.2).any(1)]
    closest = trimesh.triangles.closest_point(points[near], np.repeat(ring, len(near), 0))
    return deepest, float(np.linalg.norm(closest - ring, axis=1).min())


@pytest.mark.parametrize("name", BODIES)
def test_the_body_rests_on_its_seat_and_does_not_sink_in(name: str) -> None:
    project, seat = sitting()
    figure = body(name)
    high = measure_seat_height(project, seat, figure)
    deep, away = measure_sinking(figure, high)
    assert 0 < deep < 0.03, "it touches, and what gives way is flesh"
    assert away < 0.03
    assert measure_sinking(figure, seat.at[1])[0] > deep, "a share of the thigh alone is too high"
    assert 0.35 < high < 0.5


def test_the_stool_is_as_high_as_the_body_and_gives_way_to_a_prop() -> None:
    project, seat = sitting()
    shown = ShownPlayback(project, Plan(1, 0.0), 1.0)
    (stool,) = make_stools(shown, "stool", body("ben.glb"))
    assert stool.positions[0, 1] == pytest.approx(measure_seat_height(project, seat, body("ben.glb")))
    for name, carried in (("chair", True), ("bench", True), ("plant", False)):
        placed, meshes, _ = put(name, (seat.at[0], 0.0, seat.at[2]))
        assert (make_stools(replace(shown, project=placed), "stool", None, meshes) == ()) == carried, name
        beside, meshes, _ = put(name, (seat.at[0] + 2.0, 0.0, seat.at[2]))
        assert make_stools(replace(shown, project=beside), "stool", None, meshes), name


def put(name: str, at: tuple[float, float, float], **more: float) -> tuple[Project, PropMeshes, str]:
    project, ident = add_prop(
        sitting()[0],
        Prop(name=name, path=f"props/{name}.glb", at=at, **more),  # type: ignore[arg-type]
    )
    meshes, problems = read_prop_meshes(project, SAMPLES)
    assert not problems
    return project, meshes, ident


@pytest.mark.parametrize("lifted", [0.0, 0.1])
def test_a_chair_is_fitted_to_who_sits_on_it(lifted: float) -> None:
    seat, scale = sitting()[1], 0.8 if lifted else 1.2
    project, meshes, ident = put("chair", (seat.at[0], lifted, seat.at[2]), scale=scale)
    found, top = find_carrying_prop(project, meshes, seat)
    assert found == ident
    wanted = measure_seat_height(project, seat, body("ben.glb"))
    assert abs(top - wanted) > 0.01
    fitted = fit_prop_to_seat(project.props[ident], top, wanted)
    assert (fitted.scale == scale) == bool(lifted), "what is lifted keeps its size"
    found, top = find_carrying_prop(replace(project, props={ident: fitted}), meshes, seat)
    assert found == ident and top == pytest.approx(wanted, abs=0.002)
    assert measure_sinking(body("ben.glb"), top)[0] < 0.03


def test_who_sits_on_the_floor_and_a_carried_chair_carry_nobody() -> None:
    seat = sitting()[1]
    project, meshes, ident = put("chair", (seat.at[0], 0.0, seat.at[2]))
    assert find_carrying_prop(project, meshes, replace(seat, floor=True)) == ("", 0.0)
    joint = project.skeleton.names[0]  # type: ignore[union-attr]
    held = {ident: Prop(name="chair", path="props/chair.glb", joint=joint)}
    assert find_carrying_prop(replace(project, props=held), meshes, seat) == ("", 0.0)


@pytest.mark.parametrize("name", BODIES)
def test_the_feet_of_who_sits_reach_the_floor(name: str) -> None:
    points, triangles = place_body(body(name))
    assert -0.015 < float(points[np.unique(triangles), 1].min()) < 0.015
