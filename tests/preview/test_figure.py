"""Figures: palettes at rest and posed, and a character on a skeleton that is not its own."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import sample_clips
from metagraph.formats.gltf.reader import read_character, read_gltf_clips
from metagraph.motion import rotation
from metagraph.motion.character_mesh import CharacterMesh, MeshMaterial, Surface, bind_character
from metagraph.motion.skeleton import Pose, Skeleton
from preview.figure import SkinnedFigure, StickFigure
from preview.mesh import make_ball, make_capsule
from sample_clips.make.conformance_projects import stick_skeleton
from sample_clips.make.mannequin_skeleton import mannequin_skeleton
from tests.preview.conftest import chain

UNIT = np.eye(3, 4)
MANNEQUIN = Path(sample_clips.__file__).with_name("mannequin.glb")


def character(skeleton: Skeleton, **changes) -> CharacterMesh:
    """One vertex for each joint, at the joint."""
    _, positions = skeleton.globals(skeleton.rest)
    count = len(skeleton)
    joints = np.zeros((count, 4), int)
    joints[:, 0] = np.arange(count)
    weights = np.tile([1.0, 0, 0, 0], (count, 1))
    triangles = np.array([[0, min(1, count - 1), min(2, count - 1)]])
    values = {
        "positions": positions,
        "normals": np.tile([0.0, 0, 1], (count, 1)),
        "uvs": np.zeros((count, 2)),
        "joints": joints,
        "weights": weights,
        "triangles": triangles,
        "materials": (MeshMaterial("m"),),
        "surfaces": (Surface(0, 1, 0),),
    }
    return CharacterMesh("c", skeleton, **{**values, **changes})


def bent(skeleton: Skeleton, joint: str) -> tuple[np.ndarray, np.ndarray]:
    rotations = skeleton.rest_rotations.copy()
    rotations[skeleton.index(joint)] = rotation.from_axis_angle(np.array([0.0, 0, 1]), np.pi / 2)
    return skeleton.globals(Pose(rotations, skeleton.rest_translations))


def moved(palette: np.ndarray, matrix: int, point: np.ndarray) -> np.ndarray:
    return palette[matrix, :, :3] @ point + palette[matrix, :, 3]


def test_at_rest_every_matrix_is_the_unit():
    skeleton = mannequin_skeleton()
    pose = skeleton.globals(skeleton.rest)
    assert np.allclose(SkinnedFigure(character(skeleton)).palette(*pose), UNIT, atol=1e-6)
    assert np.allclose(StickFigure(skeleton).palette(*pose), UNIT, atol=1e-5)


def test_matrices_carry_rest_points_to_posed_joints():
    skeleton = chain("a", "b", "c")
    _, rest = skeleton.globals(skeleton.rest)
    rotations, positions = bent(skeleton, "b")
    for figure in (SkinnedFigure(character(skeleton)), StickFigure(skeleton)):
        palette = figure.palette(rotations, positions)
        assert palette.dtype == np.float32
        assert np.allclose(moved(palette, 1, rest[2]), positions[2], atol=1e-6)


def test_palettes_take_any_leading_dimensions():
    skeleton = chain("a", "b", "c")
    rotations, positions = bent(skeleton, "b")
    many = np.tile(rotations, (2, 5, 1, 1)), np.tile(positions, (2, 5, 1, 1))
    for figure in (SkinnedFigure(character(skeleton)), StickFigure(skeleton)):
        assert figure.palette(*many).shape == (2, 5, figure.mesh.matrices, 3, 4)
        assert np.allclose(figure.palette(*many)[1, 3], figure.palette(rotations, positions))


def test_a_missing_joint_follows_its_nearest_matched_ancestor():
    own, project = chain("a", "b", "twist", "c"), chain("a", "b", "c")
    figure = SkinnedFigure(character(own), project)
    palette = figure.palette(*bent(project, "b"))
    assert figure.matched == 3
    assert np.allclose(palette[2], palette[1])
    assert not np.allclose(palette[2], UNIT)


def test_joints_in_another_order_are_matched_by_name():
    own = chain("a", "b", "c")
    project = Skeleton(
        ("z", "a", "b", "c"),
        np.array([-1, 0, 1, 2]),
        np.tile([0.0, 0, 0, 1], (4, 1)),
        np.array([[0, 0, 0], [0, 0, 0], [0, 0.3, 0], [0, 0.3, 0.0]]),
    )
    figure = SkinnedFigure(character(own), project)
    assert np.allclose(
        figure.palette(*bent(project, "b")), SkinnedFigure(character(own)).palette(*bent(own, "b")), atol=1e-6
    )


def test_a_character_without_any_joint_of_the_skeleton_stands_in_its_rest_pose():
    figure = SkinnedFigure(character(chain("x", "y")), chain("a", "b"))
    assert figure.matched == 0
    assert np.allclose(figure.palette(*bent(chain("a", "b"), "a")), UNIT)


def test_a_root_above_the_skeletons_own_follows_the_first_matched_joint():
    own, project = chain("Armature", "a", "b"), chain("a", "b")
    rotations, positions = project.globals(project.rest)
    palette = SkinnedFigure(character(own), project).palette(rotations, positions + [1.0, 0, 0])
    assert np.allclose(palette[0, :, 3], palette[1, :, 3])


def test_stick_bones_stretch_to_joints_a_file_has_moved():
    skeleton = chain("a", "b", "c")
    rotations, positions = skeleton.globals(skeleton.rest)
    positions = positions.copy()
    positions[2] += [0.2, 0.4, 0.0]
    figure = StickFigure(skeleton)
    palette = figure.palette(rotations, positions)
    assert np.allclose(moved(palette, len(skeleton) + 2, np.array([0, 0.6, 0])), positions[2], atol=1e-5)


def test_bones_of_no_length_give_numbers():
    skeleton = chain("a", "b", "c", length=0.0)
    assert np.isfinite(StickFigure(skeleton).palette(*skeleton.globals(skeleton.rest))).all()
    upside_down = chain("a", "b")
    rotations, positions = bent(upside_down, "a")
    assert np.isfinite(StickFigure(upside_down).palette(rotations, -positions)).all()


def test_one_joint_is_drawn_as_a_ball():
    figure = StickFigure(chain("only"))
    assert len(figure.mesh.triangles) > 50
    low, high = figure.bounds(np.zeros((1, 3)))
    assert (high > low).all()


def test_bounds_hold_all_poses_and_ignore_what_is_not_a_number():
    skeleton = mannequin_skeleton()
    _, positions = skeleton.globals(skeleton.rest)
    figure = StickFigure(skeleton)
    low, high = figure.bounds(np.stack([positions, positions + [5.0, 0, 0], np.full_like(positions, np.nan)]))
    assert high[0] > 5 and low[0] < 0 and np.isfinite([low, high]).all()


def test_posed_bounds_hold_the_mesh_however_it_is_turned_and_little_more():
    """A rod in the left hand, as long as the character is tall, straight out ahead at rest."""
    skeleton = mannequin_skeleton()
    hand = skeleton.index("LeftHand")
    _, rest = skeleton.globals(skeleton.rest)
    tip = rest[hand] + [0, 0, 1.7]
    count = len(skeleton)
    rod = {
        "positions": np.stack([rest[hand] + [0, 0.02, 0], rest[hand], tip]),
        "normals": np.tile([0.0, 1, 0], (3, 1)),
        "uvs": np.zeros((3, 2)),
        "joints": np.tile([hand, 0, 0, 0], (3, 1)),
        "weights": np.tile([1.0, 0, 0, 0], (3, 1)),
        "triangles": np.array([[0, 1, 2]]),
    }
    figure = SkinnedFigure(character(skeleton, **rod))
    for axis in np.eye(3):
        rotations = skeleton.rest_rotations.copy()
        rotations[hand] = rotation.from_axis_angle(axis, np.pi / 2)
        rotations[0] = rotation.from_axis_angle(np.roll(axis, 1), np.pi / 2)
        posed = skeleton.globals(Pose(rotations, skeleton.rest_translations))
        palette = figure.palette(*posed)
        vertex = figure.mesh.vertices
        points = np.array(
            [moved(palette, v["bones"][np.argmax(v["weights"])], v["position"]) for v in vertex]
        )
        low, high = figure.posed_bounds(*posed)
        assert (low <= points.min(0)).all() and (high >= points.max(0)).all()
        assert (high - low <= np.ptp(points, axis=0) + 0.2 * figure.height).all()
        assert all(
            np.array_equal(a, b) for a, b in zip(figure.posed_bounds(*posed, hand), (low, high), strict=True)
        )
        others = figure.posed_bounds(*posed, 0)  # has no part of the mesh
        assert all(np.array_equal(a, b) for a, b in zip(others, figure.bounds(posed[1]), strict=True))
    nowhere = np.full((count, 3), np.nan)
    assert np.isfinite(figure.posed_bounds(skeleton.rest_rotations, nowhere)).all()


def test_the_head_is_found_above_its_joint():
    skeleton = mannequin_skeleton()
    rotations, positions = skeleton.globals(skeleton.rest)
    head = StickFigure(skeleton).head(rotations, positions)
    assert head[1] == pytest.approx(1.515 + 0.05 * StickFigure(skeleton).height, abs=0.01)


def test_weights_that_do_not_add_up_are_mended_and_materials_of_one_texture_are_one_batch():
    skeleton = chain("a", "b", "c")
    weights = np.array([[0.5, 0, 0, 0], [0, 0, 0, 0], [np.nan, 0, 0, 0]])
    made = character(
        skeleton,
        weights=weights,
        triangles=np.array([[0, 1, 2], [2, 1, 0]]),
        materials=(MeshMaterial("m", (1, 0, 0, 1)), MeshMaterial("n", (0, 1, 0, 1))),
        surfaces=(Surface(0, 1, 0), Surface(1, 1, 1)),
    )
    mesh = SkinnedFigure(made).mesh
    assert np.allclose(mesh.vertices["weights"].sum(1), 1)
    assert len(mesh.batches) == 1
    assert len(np.unique(mesh.vertices["color"], axis=0)) == 2


def test_morphs_follow_vertices_into_the_mesh():
    skeleton = chain("a", "b", "c")
    offsets = np.arange(9.0).reshape(1, 3, 3)
    offsets[:, 1] = 0
    mesh = SkinnedFigure(character(skeleton, morphs=("smile",), morph_positions=offsets)).mesh
    assert mesh.morphs is not None and len(mesh.morphs) == 1
    assert list(mesh.morphs.moved) == [0, 2], "what stays is not held"
    assert np.array_equal(mesh.morphs.offsets, offsets[:, [0, 2]])
    rest = mesh.vertices["position"]
    assert np.allclose(mesh.morphs.positions(rest, np.array([0.5])), rest + 0.5 * offsets[0])
    assert np.array_equal(mesh.morphs.positions(rest, np.zeros(1)), rest)


def test_shapes_are_closed_and_face_outwards():
    for positions, normals, triangles in (make_ball(0.5), make_capsule(1.0, 0.2, 0.1)):
        corner = positions[triangles]
        face = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
        assert (np.einsum("ij,ij->i", face, normals[triangles].sum(1)) > 0).all()
        assert np.allclose(face.sum(0), 0, atol=1e-9)


def skinned(
    figure: SkinnedFigure, body: CharacterMesh, rotations: np.ndarray, positions: np.ndarray
) -> np.ndarray:
    """The vertices `[V, 3]` of a figure's character in a pose."""
    matrices = figure.palette(rotations, positions)[body.joints].astype(float)
    corners = np.concatenate([body.positions, np.ones((len(body.positions), 1))], 1)
    return np.einsum("vj,vjab,vb->va", body.weights, matrices, corners)


def test_what_is_exported_of_a_mesh_on_another_skeleton_is_what_is_drawn() -> None:
    body, skeleton = read_character(MANNEQUIN), stick_skeleton()
    assert body.skeleton != skeleton
    drawn, exported = ((SkinnedFigure(x, skeleton), x) for x in (body, bind_character(body, skeleton)))
    rest = skeleton.globals(skeleton.rest)
    assert np.abs(skinned(*drawn, *rest) - skinned(*exported, *rest)).max() < 1e-5
    turns = rotation.multiply(skeleton.rest_rotations, rotation.exp(np.full((len(skeleton), 3), 0.15)))
    posed = skeleton.globals(Pose(turns, skeleton.rest_translations))
    apart = np.linalg.norm(skinned(*drawn, *posed) - skinned(*exported, *posed), axis=1)
    assert apart.mean() < 1e-3 and apart.max() < 0.02, "they mix several joints in another order"
    assert np.linalg.norm(skinned(*drawn, *posed) - skinned(*drawn, *rest), axis=1).max() > 0.1


@pytest.mark.nightly
def test_a_bound_mesh_names_no_joint_twice_for_a_vertex() -> None:
    body = bind_character(read_character(MANNEQUIN), stick_skeleton())
    for joints, weights in zip(body.joints, body.weights, strict=True):
        used = joints[weights > 0].tolist()
        assert len(used) == len(set(used)) and np.isclose(weights.sum(), 1, atol=1e-5)


def test_a_host_whose_mesh_came_with_another_skeleton_is_exported_as_it_is_drawn(shared_data: Path) -> None:
    """The same names, other rests: what others publish as one character."""
    home = shared_data / "sumerian-hosts" / "glTF"
    body = read_character(home / "characters" / "adult_female" / "cristine" / "cristine.gltf")
    idle = read_gltf_clips(home / "animations" / "adult_female" / "stand_idle.glb")[0]
    assert body.skeleton.names == idle.skeleton.names and body.skeleton != idle.skeleton
    drawn, exported = (
        (SkinnedFigure(x, idle.skeleton), x) for x in (body, bind_character(body, idle.skeleton))
    )
    pose = idle.skeleton.globals(idle.pose_at(1.0))
    apart = np.linalg.norm(skinned(*drawn, *pose) - skinned(*exported, *pose), axis=1)
    assert len(apart) > 10_000 and apart.max() < 1e-3


def test_bounds_are_those_of_the_mesh_where_the_projects_rest_pose_is_another():
    """The project's rest pose is a clip's first frame: away from the middle, and bent."""
    own = mannequin_skeleton()
    turned = own.rest_rotations.copy()
    for name, axis, angle in (("LeftUpperLeg", [1.0, 0, 0], -1.4), ("Spine", [1.0, 0, 0], 0.9)):
        turned[own.index(name)] = rotation.from_axis_angle(np.array(axis), angle)
    away = own.rest_translations.copy()
    away[0] += [0, 0, 3.28]
    project = Skeleton(own.names, own.parents, turned, away)
    figure = SkinnedFigure(read_character(MANNEQUIN), project)
    pose = own.globals(own.rest)  # what is shown stands in the middle
    points = SkinnedFigure(read_character(MANNEQUIN)).mesh.vertices["position"]
    for low, high in (figure.bounds(pose[1]), figure.posed_bounds(*pose)):
        assert (low <= points.min(0) + 0.03).all() and (high >= points.max(0) - 0.03).all()
        assert (high - low <= np.ptp(points, axis=0) + 0.25).all()
    assert figure.head(*pose)[1] == pytest.approx(SkinnedFigure(read_character(MANNEQUIN)).head(*pose)[1])
    assert figure.height == pytest.approx(SkinnedFigure(read_character(MANNEQUIN)).height)
