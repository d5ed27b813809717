"""What is a character to draw, whatever it is called, and what is a stand-in for one."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from metagraph.formats.gltf.reader import read_character
from metagraph.motion import rotation
from metagraph.motion.character_mesh import CharacterMesh, Surface, explain_no_character
from metagraph.motion.skeleton import Skeleton
from tests.bodies import body, column, everywhere


def scaled(character: CharacterMesh, factor: float) -> CharacterMesh:
    skeleton = character.skeleton
    return replace(
        character,
        positions=character.positions * np.float32(factor),
        skeleton=Skeleton(
            skeleton.names,
            skeleton.parents,
            skeleton.rest_rotations,
            skeleton.rest_translations * factor,
        ),
    )


@pytest.mark.parametrize("factor", [1e-3, 1.0, 100.0])
def test_a_body_round_the_joints_is_a_character_at_any_scale(factor: float) -> None:
    assert explain_no_character(scaled(everywhere(column()), factor)) is None


@pytest.mark.parametrize("size", [1e-3, 0.14, 3.0])
def test_a_single_triangle_is_a_stand_in_however_large(size: float) -> None:
    skeleton = column()
    points = np.float32([[0, 0, 0], [size, 0, 0], [0, 0, size]])
    flat = replace(
        everywhere(skeleton),
        positions=points,
        normals=np.tile(np.float32([0, 1, 0]), (3, 1)),
        uvs=np.zeros((3, 2), np.float32),
        joints=np.array([[0, 0, 0, 0], [2, 0, 0, 0], [4, 0, 0, 0]]),
        weights=np.tile(np.float32([1, 0, 0, 0]), (3, 1)),
        triangles=np.array([[0, 1, 2]]),
        surfaces=(Surface(0, 1, 0),),
    )
    assert explain_no_character(flat) == "is 1 triangle, a stand-in"


def test_a_mesh_gathered_in_one_point_or_on_a_line_has_no_surface() -> None:
    whole = everywhere(column())
    for squeeze in ([0, 0, 0], [0, 1, 0]):
        thin = replace(whole, positions=whole.positions * np.float32(squeeze))
        assert explain_no_character(thin) == "has no surface"


def test_a_small_thing_away_from_the_joints_it_follows_is_a_stand_in() -> None:
    skeleton = column()
    small = body(skeleton, {3: 0.05, 4: 0.05}, {3: [0, 0, 0], 4: [0.05, 0, 0]})
    assert "a stand-in" in (explain_no_character(small) or "")


def test_a_small_head_where_its_joints_are_is_a_character() -> None:
    skeleton = column(12)
    assert explain_no_character(body(skeleton, {10: 0.15, 11: 0.15})) is None


def test_a_control_far_away_makes_no_stand_in_of_a_body() -> None:
    skeleton = column()
    far = Skeleton(
        (*skeleton.names, "goal"),
        np.append(skeleton.parents, 0),
        rotation.make_identity_rotations((7,)),
        np.vstack([skeleton.rest_translations, [[0, 0, 40.0]]]),
    )
    assert explain_no_character(body(far, dict.fromkeys(range(6), 0.15))) is None


def test_a_statue_moves_with_one_joint_alone() -> None:
    whole = everywhere(column())
    assert explain_no_character(replace(whole, joints=np.zeros_like(whole.joints))).startswith(
        "moves with one joint"
    )


def test_a_head_of_morph_targets_may_hang_on_one_joint() -> None:
    whole = everywhere(column())
    talking = replace(
        whole,
        joints=np.zeros_like(whole.joints),
        morphs=("aa",),
        morph_positions=np.zeros((1, *whole.positions.shape), np.float32),
    )
    assert explain_no_character(talking) is None


def test_a_body_of_other_names_is_bound_to_none_of_the_skeletons_joints() -> None:
    other = Skeleton(
        tuple(f"x{n}" for n in range(6)),
        column().parents,
        column().rest_rotations,
        column().rest_translations,
    )
    assert explain_no_character(everywhere(column()), other).startswith("is bound to none")


def test_meshes_left_out_take_their_triangles_with_them_and_their_names_stay() -> None:
    whole = everywhere(column(4))
    less = whole.without({"ball 1", "ball 3", "no such mesh"})
    assert [s.mesh for s in less.surfaces] == ["ball 0", "ball 2"]
    assert less.meshes == whole.meshes and len(less.triangles) == len(whole.triangles) // 2
    for surface in less.surfaces:
        run = less.triangles[surface.first : surface.first + surface.count]
        assert set(np.unique(whole.joints[run])) == {0, surface.held}
    assert whole.without(()) is whole
    assert len(whole.without(whole.meshes).triangles) == 0


@pytest.mark.parametrize("who", ["alien", "adult_female", "adult_male"])
def test_files_of_animations_hold_stand_ins(shared_data: Path, who: str) -> None:
    for path in (shared_data / "sumerian-hosts/glTF/animations" / who).glob("*.glb"):
        assert explain_no_character(read_character(path)) == "is 1 triangle, a stand-in"


@pytest.mark.parametrize(
    "file",
    [
        "sumerian-hosts/glTF/characters/alien/alien.gltf",
        "sumerian-hosts/glTF/characters/adult_female/cristine/cristine.gltf",
        "kaykit-rogue/Rogue.glb",
        "robot-expressive/RobotExpressive.glb",
        "mesh2motion-cmu/human-addon-animations.glb",
        "mesh2motion-cmu/quad-creature-animations.glb",
        "mesh2motion-cmu/bird-animations.glb",
    ],
)
def test_characters_others_made_are_characters(shared_data: Path, file: str) -> None:
    assert explain_no_character(read_character(shared_data / file)) is None
