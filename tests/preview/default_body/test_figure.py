"""The default body on skeletons of every kind: its shape, what each point follows, and how it bends."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from metagraph.formats.clips import read_clips
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.fitting.footing import find_footing
from metagraph.motion.roles import find_roles
from metagraph.motion.skeleton import Pose, Skeleton
from preview.default_body.figure import DefaultBody
from preview.default_body.sculpture import read_sculpture
from preview.figure import StickFigure
from preview.scene import DARK, LIGHT, Scene
from tests import zoo
from tests.label_zoo.rigs import Figure, on
from tests.preview.test_renderer import posed, resting, whole

CLIP = Path(__file__).parents[3] / "sample_clips" / "clips" / "arms_crossed__stance.glb"
FIGURES = {
    "sample": Figure(),
    "T-pose": Figure(rest="T"),
    "arms down": Figure("mixamo", rest="I", axes="bones"),
    "unturned": Figure("biped", axes="none"),
    "any axes": Figure(rest="T", axes="random", seed=3),
    "no fingers": Figure(missing=("fingers", "face")),
    "no toes": Figure(missing=("toes",)),
    "no upper chest": Figure(missing=("upper chest", "shoulders")),
    "more joints": Figure(extra=("twist", "props", "root")),
    "no names": Figure("numbers", rest="T"),
}
HEIGHT = 1.72  # metres, of the sample character


@cache
def crossed() -> Clip:
    return read_clips(CLIP)[0]


@cache
def made(name: str) -> tuple[Clip, DefaultBody]:
    clip = on(crossed(), FIGURES[name])
    return clip, DefaultBody(clip.skeleton, find_footing(clip))


def placed(body: DefaultBody, rotations, positions) -> np.ndarray:
    """The body's points in a pose `[V, 3]`."""
    v = body.mesh.vertices
    matrix = (body.palette(rotations, positions)[v["bones"]] * v["weights"][..., None, None]).sum(1)
    return np.einsum("vij,vj->vi", matrix[..., :3], v["position"]) + matrix[..., 3]


def volume(points: np.ndarray, triangles: np.ndarray) -> float:
    a, b, c = (points[triangles[:, k]].astype(float) for k in range(3))
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6)


def apart(points: np.ndarray, others: np.ndarray) -> float:
    """How far one surface is from another, metres."""
    from scipy.spatial import cKDTree

    return float(cKDTree(others).query(points)[0].max())


def owners(body: DefaultBody) -> np.ndarray:
    """How much each point follows each joint `[V, J]`."""
    out = np.zeros((len(body.mesh.vertices), len(body.skeleton)))
    for k in range(4):
        joints = body.sources[body.mesh.vertices["bones"][:, k]]
        np.add.at(out, (np.arange(len(out)), joints), body.mesh.vertices["weights"][:, k])
    return out


def opposite() -> np.ndarray:
    """The mirror image of each sculpted point `[V]`."""
    from scipy.spatial import cKDTree

    points = read_sculpture().character.positions
    return cKDTree(points).query(points * [-1, 1, 1])[1]


def test_the_surface_is_closed_and_alike_on_both_sides():
    body = read_sculpture().character
    edges = np.sort(np.concatenate([body.triangles[:, [k, (k + 1) % 3]] for k in range(3)]), 1)
    _, count = np.unique(edges, axis=0, return_counts=True)
    assert (count == 2).all()
    assert volume(body.positions, body.triangles) == pytest.approx(0.07, abs=0.02), "its outside is outside"
    assert np.abs(body.positions[opposite()] - body.positions * [-1, 1, 1]).max() < 1e-4
    assert len(body.triangles) < 18_000


@pytest.mark.parametrize("name", FIGURES)
def test_it_has_the_skeletons_measures_whatever_its_rest_pose(name):
    _, body = made(name)
    vertices = body.mesh.vertices
    assert np.isfinite(vertices["position"]).all() and np.isfinite(vertices["normal"]).all()
    assert np.allclose(vertices["weights"].sum(1), 1, atol=1e-5)
    assert np.allclose(np.linalg.norm(vertices["normal"], axis=1), 1, atol=1e-4)
    assert np.ptp(vertices["position"][:, 1]) == pytest.approx(HEIGHT, rel=0.03)
    assert np.allclose(placed(body, *body.bound), vertices["position"], atol=1e-5)


@pytest.mark.parametrize("name", FIGURES)
def test_it_stands_on_the_ground_and_keeps_its_volume_with_arms_crossed(name):
    clip, body = made(name)
    points = placed(body, *clip.skeleton.globals(clip.poses()[10]))
    assert points[:, 1].min() == pytest.approx(0, abs=0.012)
    triangles = body.mesh.triangles
    assert volume(points, triangles) == pytest.approx(
        volume(body.mesh.vertices["position"], triangles), rel=0.05
    )


@pytest.mark.parametrize("name", [n for n in FIGURES if not n.startswith("no ")])
def test_one_motion_looks_alike_on_all_rigs_of_one_figure(name):
    """Rest poses, axes, names and further joints change nothing that is seen."""
    clip, body = made(name)
    first, reference = made("sample")
    points, wanted = (
        placed(b, *c.skeleton.globals(c.poses()[10])) for c, b in ((clip, body), (first, reference))
    )
    assert apart(points, wanted) < 0.015


@pytest.mark.parametrize("name", FIGURES)
def test_arms_and_trunk_let_each_other_be(name):
    _, body = made(name)
    roles, parts = find_roles(body.skeleton), owners(body)
    at = body.bound[1]
    for side in ("left", "right"):
        arm = list(body.skeleton.descendants(roles[f"{side}_upper_arm"]))
        points = body.mesh.vertices["position"].astype(float)
        shoulder, elbow = at[roles[f"{side}_upper_arm"]], at[roles[f"{side}_lower_arm"]]
        along = (points - shoulder) @ (elbow - shoulder) / np.linalg.norm(elbow - shoulder)
        out = np.linalg.norm(points - shoulder - along[:, None] * _unit(elbow - shoulder), axis=1)
        on_arm = (along > 0.13) & (out < 0.07) & (points[:, 1] > at[roles[f"{side}_hand"], 1] - 0.02)
        assert on_arm.sum() > 200
        assert parts[on_arm][:, arm].sum(1).min() > 0.99
        trunk = np.abs(points[:, 0]) < 0.05
        assert parts[trunk][:, arm].max() < 0.02


def _unit(v: np.ndarray) -> np.ndarray:
    return v / np.linalg.norm(v)


def test_a_symmetrical_skeleton_gives_a_symmetrical_body():
    points = DefaultBody(made("T-pose")[0].skeleton).mesh.vertices["position"].astype(float)
    assert np.abs(points[opposite()] - points * [-1, 1, 1]).max() < 2e-3


@pytest.mark.parametrize("degrees", [90, 140])
def test_elbows_and_knees_stay_round_when_they_bend(degrees):
    _, body = made("sample")
    bend = posed(body, [("LeftLowerLeg", (1, 0, 0), degrees), ("LeftLowerArm", (0, 1, 0), -degrees)])
    points = placed(body, bend.rotations, bend.positions)
    rest, triangles = body.mesh.vertices["position"], body.mesh.triangles
    assert volume(points, triangles) > 0.98 * volume(rest, triangles)
    for joint in ("LeftLowerLeg", "LeftLowerArm"):
        near = np.linalg.norm(rest - body.bound[1][body.skeleton.index(joint)], axis=1) < 0.05
        some = triangles[near[triangles].all(1)]
        assert area(points, some) > 0.85 * area(rest, some), joint


def area(points: np.ndarray, triangles: np.ndarray) -> float:
    a, b, c = (points[triangles[:, k]].astype(float) for k in range(3))
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


def test_a_hand_that_turns_over_does_not_wring_its_wrist():
    _, body = made("sample")
    hand = body.bound[1][body.skeleton.index("LeftHand")]
    along = _unit(hand - body.bound[1][body.skeleton.index("LeftLowerArm")])
    turned = posed(body, [("LeftHand", tuple(along), 150)])
    rest = body.mesh.vertices["position"].astype(float) - hand
    wrist = (np.abs(rest @ along) < 0.012) & (np.linalg.norm(rest, axis=1) < 0.05)

    def thick(points: np.ndarray) -> float:
        ring = points[wrist] - points[wrist].mean(0)
        return float(np.linalg.norm(ring - (ring @ along)[:, None] * along, axis=1).mean())

    assert thick(placed(body, turned.rotations, turned.positions)) > 0.9 * thick(rest)


def test_soles_are_on_the_ground_of_the_clip_wherever_the_rest_pose_has_it():
    clip = made("sample")[0]
    lifted = clip.translations.copy()
    lifted[:, 0, 1] += 0.025
    clip = replace(clip, translations=lifted)
    body = DefaultBody(clip.skeleton, find_footing(clip))
    points = placed(body, *clip.skeleton.globals(clip.poses()[10]))
    assert points[:, 1].min() == pytest.approx(0, abs=0.006)


@pytest.mark.parametrize("scale", [0.01, 0.5, 40.0])
def test_it_takes_any_size(scale):
    skeleton = made("sample")[0].skeleton
    grown = Skeleton(
        skeleton.names, skeleton.parents, skeleton.rest_rotations, skeleton.rest_translations * scale
    )
    points, wanted = (DefaultBody(s).mesh.vertices["position"] for s in (grown, skeleton))
    assert np.allclose(points / scale, wanted, atol=2e-3)


def test_where_it_faces_does_not_matter():
    skeleton = made("sample")[0].skeleton
    turn = rotation.from_axis_angle(np.array([0.0, 1, 0]), 1.9)
    rotations, translations = skeleton.rest_rotations.copy(), skeleton.rest_translations.copy()
    rotations[0] = rotation.multiply(turn, rotations[0])
    translations[0] = rotation.rotate_vectors(turn, translations[0])
    turned = DefaultBody(Skeleton(skeleton.names, skeleton.parents, rotations, translations))
    assert np.allclose(
        turned.mesh.vertices["position"], DefaultBody(skeleton).mesh.vertices["position"], atol=1e-3
    )


def test_many_poses_are_as_each_of_them():
    clip, body = made("more joints")
    rotations, positions = clip.skeleton.globals(clip.poses()[np.array([0, 20, 40])])
    many = body.palette(rotations, positions)
    assert many.dtype == np.float32 and many.shape == (3, body.mesh.matrices, 3, 4)
    assert np.allclose(many[2], body.palette(rotations[2], positions[2]), atol=1e-6)


@pytest.fixture(scope="module")
def animals(tmp_path_factory) -> dict[str, Path]:
    return zoo.make(tmp_path_factory.mktemp("zoo"))


@pytest.mark.parametrize("animal", zoo.ANIMALS)
def test_every_animal_of_the_zoo_has_a_body_on_its_bones(animals, animal):
    clip = read_clips(animals[animal])[0]
    body = DefaultBody(clip.skeleton, find_footing(clip))
    roles = find_roles(clip.skeleton)
    turned, at = clip.skeleton.globals(clip.poses()[len(clip.rotations) // 2])
    points = placed(body, turned, at)
    tall = body.height
    for role in ("head", "left_hand", "right_hand", "left_lower_leg", "right_lower_leg", "left_foot"):
        near = np.linalg.norm(points - at[roles[role]], axis=1).min()
        assert near < 0.08 * tall, role


def test_what_is_no_person_is_refused_with_the_reason():
    skeleton = Skeleton(
        ("a", "b"), np.array([-1, 0]), np.tile([0.0, 0, 0, 1], (2, 1)), np.array([[0, 0, 0], [0, 1.0, 0]])
    )
    with pytest.raises(ValueError, match="the skeleton has no hips"):
        DefaultBody(skeleton)


def test_a_rest_pose_that_does_not_stand_needs_a_clip():
    clip = on(crossed(), FIGURES["sample"])
    skeleton = clip.skeleton
    rotations = skeleton.rest_rotations.copy()
    rotations[0] = rotation.from_axis_angle(np.array([1.0, 0, 0]), np.pi / 2)
    lying = Skeleton(skeleton.names, skeleton.parents, rotations, skeleton.rest_translations)
    with pytest.raises(ValueError, match="no pose is known in which the skeleton stands"):
        DefaultBody(lying)
    idle = on(read_clips(CLIP.with_name("hands_at_sides__stance.glb"))[0], FIGURES["sample"])
    standing = Clip(idle.name, lying, idle.fps, idle.rotations, idle.translations, idle.translated)
    body = DefaultBody(lying, find_footing(standing))
    points = placed(body, *skeleton.globals(clip.poses()[10]))
    reference = DefaultBody(skeleton, find_footing(idle))
    wanted = placed(reference, *skeleton.globals(clip.poses()[10]))
    assert apart(points, wanted) < 0.02


@pytest.mark.nightly
def test_levels_of_detail_are_those_of_every_other_body(tmp_path, monkeypatch):
    monkeypatch.setenv("METAGRAPH_MESH_CACHE", str(tmp_path))
    bodies = [made("T-pose")[1], made("no fingers")[1]]
    for body in bodies:
        body.simplify()
        counts = [len(level.mesh.triangles) for level in body.levels]
        assert counts == sorted(counts, reverse=True) and counts[-1] < 6000
    assert len([path for path in tmp_path.rglob("*") if path.is_file()]) == 1
    assert [len(a.mesh.triangles) for a in bodies[0].levels] == [
        len(a.mesh.triangles) for a in bodies[1].levels
    ]


@pytest.mark.gl
def test_it_looks_as_it_did(offscreen, golden):
    clip, body = made("T-pose")
    size = (160, 120)
    stand = Scene((resting(body),))
    golden("default_body", offscreen.render(stand, whole(stand), DARK, size))
    pose = clip.skeleton.globals(clip.poses()[10])
    arms = Scene((type(stand.actors[0])(body, *pose),))
    golden("default_body_arms_crossed", offscreen.render(arms, whole(arms), LIGHT, size))


def test_a_pose_in_which_joints_are_nowhere_gives_numbers_or_none_but_no_error():
    _, body = made("sample")
    rotations, positions = body.bound
    assert not np.isfinite(body.palette(rotations, np.full_like(positions, np.nan))).all()
    low, high = body.bounds(np.full_like(positions, np.nan))
    assert np.isfinite([low, high]).all()


def test_it_is_as_large_as_the_stick_figure_of_the_same_skeleton():
    clip, body = made("sample")
    sticks = StickFigure(clip.skeleton)
    assert body.height == pytest.approx(sticks.height, rel=0.2)
    assert isinstance(clip.skeleton.rest, Pose)
