"""Hands rest on desks and feet stand on steps, smoothly, and only where there are any."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

from metagraph.formats.props.reader import read_prop
from metagraph.formats.store import open_project
from metagraph.graph import anatomy
from metagraph.graph.model import Project
from metagraph.motion import rotation
from metagraph.motion.prop_tops import PropTop, find_tops
from metagraph.motion.skeleton import Pose
from metagraph.playback.continuity import ContinuityLaw
from metagraph.playback.evaluator import Evaluator
from metagraph.playback.plan import Plan
from metagraph.playback.planner import make_plan
from metagraph.playback.posing.prop_contacts import RestingEvaluator

Three = tuple[float, float, float]
SAMPLES = Path(__file__).resolve().parents[3] / "sample_clips"


@cache
def project_of(name: str) -> Project:
    return open_project(SAMPLES / f"{name}.metagraph.yaml").project


@cache
def plan_of(name: str, seconds: float, seed: int = 1) -> Plan:
    return make_plan(project_of(name), seconds, seed=seed)


@cache
def tops_of(name: str, at: Three, scale: float = 1.0, roll: float = 0.0) -> tuple[PropTop, ...]:
    mesh = read_prop(SAMPLES / "props" / f"{name}.glb")
    turn = np.array([np.sin(roll / 2), 0, 0, np.cos(roll / 2)])
    points = rotation.rotate_vectors(turn, np.asarray(mesh.positions, float)) * scale + at
    return find_tops(points, mesh.triangles)


DESK = tops_of("desk", (0.0, 0.0, 0.07))  # before who sits


def box(size: tuple[float, float, float], at: tuple[float, float, float]) -> tuple[PropTop, ...]:
    mesh = trimesh.creation.box(size)
    return find_tops(mesh.vertices + at, mesh.faces)


def play(
    name: str, tops: Any, seconds: float, **more: Any
) -> tuple[RestingEvaluator, Pose, Pose, np.ndarray]:
    """The evaluator, and poses without and with props, at 60 a second."""
    project, plan = project_of(name), plan_of(name, seconds)
    plain = Evaluator(plan, project)
    rests = RestingEvaluator(plain, project, tops, **more)
    times = np.arange(0, seconds, 1 / 60)
    return rests, plain.at(times), rests.at(times), times


def measure_depths(rests: RestingEvaluator, pose: Pose, side: int) -> np.ndarray:
    """How deep a hand is in the first top, `[N]`, metres."""
    rig, (top, *_) = rests.stage.rig, rests.stage.tops
    assert rig is not None
    joints = [rig.body.joints[p.place] for p in rig.points[side]]
    turned, at = rests.stage.skeleton.globals(pose)
    placed = at[:, joints] + rotation.rotate_vectors(
        turned[:, joints], np.array([p.at for p in rig.points[side]])
    )
    depth = top.find_heights(placed) + np.array([p.radius for p in rig.points[side]]) - placed[..., 1]
    return np.asarray(np.where(top.contains(placed), depth, -1).max(1))


def find_places(name: str, pose: Pose, role: str) -> np.ndarray:
    project = project_of(name)
    assert project.skeleton is not None
    return np.asarray(project.skeleton.globals(pose)[1][:, anatomy.project_roles(project)[role]], float)


def test_hands_that_lie_in_the_lap_lie_on_the_desk() -> None:
    rests, before, after, _ = play("seated", DESK, 60.0)
    for side in range(2):
        assert measure_depths(rests, before, side).max() > 0.15
        assert measure_depths(rests, after, side).max() < 0.01
    still = find_places("seated", after, "left_hand")[:120, 1]
    assert still.min() > 0.74 and still.max() < 0.80  # they lie on it, not above it


def test_a_hand_lies_flat() -> None:
    rests, before, after, _ = play("seated", DESK, 2.0)
    skeleton = rests.stage.skeleton
    names = [skeleton.index("LeftHand"), skeleton.index("LeftMiddle1")]

    def slope(pose: Pose) -> float:
        wrist, knuckle = skeleton.globals(pose)[1][0, names]
        return abs(float(np.degrees(np.arcsin((knuckle - wrist)[1] / np.linalg.norm(knuckle - wrist)))))

    assert slope(after) < 15 and slope(before) < 90


def test_trimesh_finds_no_vertex_of_the_hands_under_the_desk() -> None:
    """The skin itself, not the points that are kept above the top."""
    from preview.character_file import load_mesh_figure
    from preview.posed_points import find_posed_points

    project = project_of("seated")
    assert project.skeleton is not None
    _, _, after, _ = play("seated", DESK, 20.0)
    figure = load_mesh_figure(SAMPLES / "ben.glb", project.skeleton, ())
    fingers = [j for j, name in enumerate(project.skeleton.names) if name[-1] in "123"]
    board = trimesh.creation.box((1.4, 0.03, 0.7))
    board.apply_translation((0, 0.725, 0.07))
    for n in range(0, len(after.rotations), 120):
        turned, at = project.skeleton.globals(after[n])
        points = find_posed_points(figure, turned, at)
        points = points[np.min([np.linalg.norm(points - at[j], axis=1) for j in fingers], 0) < 0.03]
        inside = (np.abs(points - (0, 0.725, 0.07)) < (0.7, 0.015, 0.35)).all(1)
        deep = 0.0
        for point in points[inside]:
            closest = trimesh.triangles.closest_point(board.triangles, np.repeat([point], 12, 0))
            deep = max(deep, float(np.linalg.norm(closest - point, axis=1).min()))
        assert deep < 0.012


@pytest.mark.parametrize(
    ("name", "tops"),
    [
        ("seated", DESK),
        ("sample", tops_of("desk", (0.0, 0.0, 0.55), 1.2)),
        ("sample", tops_of("lectern", (0.0, 0.0, 0.48))),
        ("sample", box((0.3, 0.15, 1.0), (0.25, 0.075, 0.0))),
        ("seated", box((0.3, 0.1, 0.5), (0.15, 0.05, 0.0))),
    ],
    ids=["sits at a desk", "stands at a desk", "at a lectern", "a foot on a step", "sits, a foot on a bar"],
)
@pytest.mark.parametrize("seconds", [48.0, pytest.param(120.0, marks=pytest.mark.nightly)])
def test_what_props_add_keeps_the_law_of_continuity(
    name: str, tops: tuple[PropTop, ...], seconds: float
) -> None:
    _, before, after, _ = play(name, tops, seconds)
    assert np.abs(after.rotations - before.rotations).max() > 0.01
    added = ContinuityLaw(project_of(name)).added([("before", before), ("props", after)])["props"]
    assert added.breaks.max() <= 1


def test_both_feet_on_a_step_raise_the_body_one_foot_does_not() -> None:
    _, before, after, _ = play("sample", box((2.0, 0.15, 2.0), (0, 0.075, 0)), 3.0)
    for role in ("hips", "left_foot", "right_foot", "head"):
        raised = find_places("sample", after, role) - find_places("sample", before, role)
        assert raised[:, 1] == pytest.approx(0.15, abs=1e-3)
    _, _, after, _ = play("sample", box((0.3, 0.15, 1.0), (0.25, 0.075, 0)), 3.0)
    before_left, left = (find_places("sample", pose, "left_foot")[60:, 1] for pose in (before, after))
    assert left - before_left == pytest.approx(0.15, abs=2e-3)
    assert find_places("sample", after, "right_foot") == pytest.approx(
        find_places("sample", before, "right_foot"), abs=2e-3
    )
    assert (
        find_places("sample", after, "hips")[:, 1].max()
        < find_places("sample", before, "hips")[:, 1].max() + 1e-3
    )


def test_who_sits_stays_on_the_seat_with_feet_on_a_bar() -> None:
    _, before, after, _ = play("seated", box((0.8, 0.1, 0.6), (0, 0.05, 0.0)), 3.0)
    assert find_places("seated", after, "hips") == pytest.approx(
        find_places("seated", before, "hips"), abs=1e-6
    )
    raised = find_places("seated", after, "left_foot") - find_places("seated", before, "left_foot")
    assert raised[:, 1] == pytest.approx(0.1, abs=2e-3)


@pytest.mark.parametrize(
    "tops",
    [
        (),
        tops_of("desk", (0.0, 0.0, 2.5)),
        tops_of("desk", (0.0, 1.5, 0.07)),
        tops_of("desk", (0.0, 0.0, 0.07), 1.0, np.pi / 2),
        tops_of("cup", (0.2, 0.6, -0.25)),
        tops_of("chair", (0.0, 0.0, -0.35)),
    ],
    ids=["none", "far", "above the head", "tipped over", "tiny", "the chair below"],
)
def test_nothing_changes_where_no_top_is_near(tops: tuple[PropTop, ...]) -> None:
    rests, before, after, _ = play("seated", tops, 10.0)
    assert np.array_equal(after.rotations, before.rotations)
    one = rests.at(1.0)
    assert np.array_equal(
        one.rotations, Evaluator(plan_of("seated", 10.0), project_of("seated")).at(1.0).rotations
    )


def test_a_desk_that_is_too_high_leaves_the_hands_where_they_are() -> None:
    """They would have to be lifted by more than an arm on a desk is."""
    rests, before, after, _ = play("seated", tops_of("desk", (0.0, 0.25, 0.07)), 5.0)
    assert measure_depths(rests, before, 0)[0] > 0.22
    assert np.array_equal(after.rotations[:60], before.rotations[:60])


def test_a_cup_in_the_hand_stands_on_the_desk() -> None:
    corners = tuple((x, y, z) for x in (-0.04, 0.04) for y in (-0.08, 0.0) for z in (-0.04, 0.04))
    rests, _, after, _ = play("seated", DESK, 5.0, carried={"LeftHand": corners})
    assert measure_depths(rests, after, 0).max() < 0.01
    without, _, other, _ = play("seated", DESK, 5.0)
    higher = find_places("seated", after, "left_hand") - find_places("seated", other, "left_hand")
    assert higher[:, 1].max() > 0.03
    assert measure_depths(without, other, 1) == pytest.approx(measure_depths(rests, after, 1), abs=1e-6)


def test_one_pose_is_that_of_many_and_the_order_of_times_does_not_matter() -> None:
    _, _, after, times = play("seated", DESK, 8.0)
    fresh = RestingEvaluator(
        Evaluator(plan_of("seated", 8.0), project_of("seated")), project_of("seated"), DESK
    )
    for n in (400, 3, 210):
        assert np.abs(fresh.at(float(times[n])).rotations - after.rotations[n]).max() < 1e-6
    shape = fresh.at(times[:6].reshape(2, 3)).rotations.shape
    assert shape[:2] == (2, 3)


def test_a_larger_character_rests_its_hands_as_well() -> None:
    project = project_of("seated")
    assert project.skeleton is not None
    grown = RestingEvaluator(
        _Grown(Evaluator(plan_of("seated", 5.0), project), 1.5), project, box((2, 1.05, 1), (0, 0.525, 0.05))
    )
    assert measure_depths(grown, grown.at(np.arange(0, 5, 1 / 30)), 0).max() < 0.02


class _Grown(Evaluator):
    """The same poses, larger."""

    def __init__(self, inner: Evaluator, by: float) -> None:
        super().__init__(inner.plan, inner.project)
        self.by = by

    def at(self, seconds: Any, *_: Any, **__: Any) -> Pose:
        pose = super().at(seconds)
        return Pose(pose.rotations, pose.translations * self.by)

    def before_life(self, times: np.ndarray) -> Pose:
        pose = super().before_life(times)
        return Pose(pose.rotations, pose.translations * self.by)


def test_a_body_with_one_arm_stands_on_steps_all_the_same() -> None:
    project = project_of("sample")
    roles = {**project.roles, "left_hand": ""}
    rests = RestingEvaluator(
        Evaluator(plan_of("sample", 3.0), project),
        replace(project, roles=roles),
        tops_of("desk", (0, 0, 0.5), 1.2),
    )
    assert rests.at(1.0).rotations.shape[-1] == 4
