"""The glTF reader and writer: hand-made files with every trap of the format, then real ones."""

from __future__ import annotations

import base64
import json
import os
import shutil
import struct
import subprocess
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from metagraph.errors import FileError
from metagraph.formats.clips import import_clips, read_clips
from metagraph.formats.gltf.reader import read_character, read_gltf_clips, read_vrm_roles, write_glb
from metagraph.formats.gltf.skeleton import compose
from metagraph.formats.gltf.writer import Keys
from metagraph.motion import rotation
from metagraph.motion.character_mesh import CharacterMesh, MeshMaterial, Surface
from metagraph.motion.clip import Clip
from sample_clips.make.mannequin_skeleton import mannequin_skeleton
from tests import zoo

COMPONENTS = {"i1": 5120, "u1": 5121, "<i2": 5122, "<u2": 5123, "<u4": 5125, "<f4": 5126}
WIDTHS = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4", 16: "MAT4"}
QUARTER = np.sqrt(0.5)


class Scene:
    """A small glTF file in the making."""

    def __init__(self, nodes: list[dict[str, Any]] | None = None) -> None:
        self.json: dict[str, Any] = {
            "asset": {"version": "2.0"},
            "nodes": nodes or [],
            "accessors": [],
            "bufferViews": [],
            "animations": [],
        }
        self.data = b""

    def raw(self, data: bytes, **more: Any) -> int:
        self.data += b"\0" * (-len(self.data) % 4)
        self.json["bufferViews"].append(
            {"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data), **more}
        )
        self.data += data
        return len(self.json["bufferViews"]) - 1

    def array(self, values: Any, dtype: str = "<f4", **more: Any) -> int:
        values = np.asarray(values, dtype)
        self.json["accessors"].append(
            {
                "bufferView": self.raw(values.tobytes()),
                "componentType": COMPONENTS[dtype],
                "count": len(values),
                "type": WIDTHS[1 if values.ndim == 1 else values.shape[1]],
                **more,
            }
        )
        return len(self.json["accessors"]) - 1

    def animate(self, name: str | None, *channels: tuple[int, str, Any, Any, str]) -> None:
        """Add an animation of (node, path, times, values or accessor, interpolation)."""
        animation: dict[str, Any] = {"channels": [], "samplers": []}
        if name is not None:
            animation["name"] = name
        for node, path, times, values, mode in channels:
            source = times if isinstance(times, int) else self.array(times)
            output = values if isinstance(values, int) else self.array(values)
            animation["samplers"].append({"input": source, "output": output, "interpolation": mode})
            animation["channels"].append(
                {"sampler": len(animation["samplers"]) - 1, "target": {"node": node, "path": path}}
            )
        self.json["animations"].append(animation)

    def glb(self, path: Path) -> Path:
        self.json["buffers"] = [{"byteLength": len(self.data)}]
        text = json.dumps(self.json).encode()
        text += b" " * (-len(text) % 4)
        body = self.data + b"\0" * (-len(self.data) % 4)
        head = struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(body), len(text), 0x4E4F534A)
        path.write_bytes(head + text + struct.pack("<II", len(body), 0x004E4942) + body)
        return path


def bones() -> list[dict[str, Any]]:
    return [
        {"name": "Hips", "translation": [0, 1, 0], "children": [1]},
        {"name": "Spine", "translation": [0, 0.5, 0], "children": [2]},
        {"name": "Head", "translation": [0, 0.3, 0]},
    ]


TURN = [[0, 0, 0, 1], [0, 0, QUARTER, QUARTER]]  # a quarter turn about z


def read_one(scene: Scene, tmp_path: Path, name: str = "file.glb") -> Clip:
    (clip,) = read_gltf_clips(scene.glb(tmp_path / name))
    return clip


def refused(scene: Scene, tmp_path: Path, *words: str) -> FileError:
    with pytest.raises(FileError) as caught:
        read_gltf_clips(scene.glb(tmp_path / "file.glb"))
    assert caught.value.cause and caught.value.remedy
    for word in words:
        assert word in str(caught.value)
    return caught.value


# --- interpolation and accessors


def test_linear_rotations_turn_at_constant_speed_between_far_keys(tmp_path: Path) -> None:
    scene = Scene(bones())
    scene.animate("bend", (1, "rotation", [0, 1], TURN, "LINEAR"))
    clip = read_one(scene, tmp_path)
    assert (clip.fps, clip.frames) == (30, 31)
    angles = 2 * np.arcsin(clip.rotations[:, 1, 2].astype(float))
    np.testing.assert_allclose(angles, np.linspace(0, np.pi / 2, 31), atol=1e-6)


def test_steps_hold_until_the_next_key(tmp_path: Path) -> None:
    scene = Scene(bones())
    scene.animate("snap", (1, "rotation", [0, 0.5, 1], [*TURN, TURN[0]], "STEP"))
    clip = read_one(scene, tmp_path)
    turned = clip.rotations[:, 1, 2] > 0.5
    assert turned.tolist() == [15 <= f < 30 for f in range(31)]


def test_cubic_splines_follow_hermite_curves_with_tangents_times_the_gap(tmp_path: Path) -> None:
    scene = Scene(bones())
    out = [
        [0, 0, 0],
        [0, 1, 0],
        [1, 0, 0],
        [3, 0, 0],
        [2, 1, 0],
        [0, 0, 0],
    ]  # in, value, out of two keys, 2 s apart
    scene.animate(
        "curve", (0, "translation", [0, 2], out, "CUBICSPLINE"), (1, "rotation", [0, 2], TURN, "LINEAR")
    )
    clip = read_one(scene, tmp_path)
    u = np.linspace(0, 1, 61)
    expected = 2 * (u**3 - 2 * u**2 + u) * 1 + (3 * u**2 - 2 * u**3) * 2 + 2 * (u**3 - u**2) * 3
    np.testing.assert_allclose(clip.root[:, 0], expected, atol=1e-6)


@pytest.mark.parametrize(("dtype", "scale"), [("i1", 127), ("<i2", 32767)])
def test_normalised_integers_are_rotations(tmp_path: Path, dtype: str, scale: int) -> None:
    scene = Scene(bones())
    output = scene.array(np.round(np.array(TURN) * scale), dtype, normalized=True)
    scene.animate("bend", (1, "rotation", [0, 1], output, "LINEAR"))
    clip = read_one(scene, tmp_path)
    assert rotation.measure_angle_between(clip.rotations[-1, 1].astype(float), TURN[1]) < 2 / scale


def test_sparse_accessors_replace_what_they_name_even_without_a_base(tmp_path: Path) -> None:
    scene = Scene(bones())
    indices, values = (
        scene.raw(np.array([1], "<u2").tobytes()),
        scene.raw(np.array([[0, 2, 0]], "<f4").tobytes()),
    )
    scene.json["accessors"].append(
        {
            "componentType": 5126,
            "count": 3,
            "type": "VEC3",
            "sparse": {
                "count": 1,
                "indices": {"bufferView": indices, "componentType": 5123},
                "values": {"bufferView": values},
            },
        }
    )
    scene.animate(
        "jump",
        (0, "translation", [0, 1, 2], len(scene.json["accessors"]) - 1, "LINEAR"),
        (1, "rotation", [0, 2], TURN, "LINEAR"),
    )
    clip = read_one(scene, tmp_path)
    np.testing.assert_allclose(clip.root[[0, 15, 30, 60], 1], [0, 1, 2, 0], atol=1e-6)


def test_targets_that_move_little_of_a_mesh_are_written_sparsely_and_read_back_whole(tmp_path: Path) -> None:
    body = read_character(Path(__file__).parents[3] / "sample_clips" / "ada.glb")
    count = len(body.positions)
    offsets = np.zeros((4, count, 3), np.float32)
    offsets[0, 3] = [0.01, -0.02, 0.03]
    offsets[1, [0, count - 1]] = [[1, 0, 0], [0, 0, -1]]
    offsets[2] = np.random.default_rng(2).normal(size=(count, 3))
    made = replace(body, morphs=("one", "ends", "all", "none"), morph_positions=offsets)
    write_glb(tmp_path / "made.glb", (), made)
    found = read_character(tmp_path / "made.glb")
    assert found.morphs == made.morphs
    np.testing.assert_array_equal(found.morph_positions, offsets)
    write_glb(tmp_path / "bare.glb", (), replace(body, morphs=(), morph_positions=None))
    more = (tmp_path / "made.glb").stat().st_size - (tmp_path / "bare.glb").stat().st_size
    assert 12 * count < more < 2.2 * 12 * count, "that which moves all, and the zeros, take a mesh each"


def test_strides_and_offsets_within_a_view_are_followed(tmp_path: Path) -> None:
    scene = Scene(bones())
    packed = np.zeros((2, 5), "<f4")
    packed[:, 1:] = TURN
    view = scene.raw(packed.tobytes(), byteStride=20)
    scene.json["accessors"].append(
        {"bufferView": view, "byteOffset": 4, "componentType": 5126, "count": 2, "type": "VEC4"}
    )
    scene.animate("bend", (1, "rotation", [0, 1], len(scene.json["accessors"]) - 1, "LINEAR"))
    assert (
        rotation.measure_angle_between(read_one(scene, tmp_path).rotations[-1, 1].astype(float), TURN[1])
        < 1e-6
    )


# --- names, rates, several animations


def test_unnamed_and_default_names_become_the_files_and_stay_unique(tmp_path: Path) -> None:
    scene = Scene(bones())
    for name in (None, "Take 001", "mixamo.com", "Armature|Wave", "Wave"):
        scene.animate(name, (1, "rotation", [0, 1], TURN, "LINEAR"))
    clips = read_gltf_clips(scene.glb(tmp_path / "hello.glb"))
    assert [c.name for c in clips] == ["hello", "hello_2", "hello_3", "Wave", "Wave_2"]
    assert len({id(c.skeleton) for c in clips}) == 1


@pytest.mark.parametrize("fps", [24, 25, 30, 48, 60, 120, 30000 / 1001, 17])
def test_the_frame_rate_is_found_from_the_keys(tmp_path: Path, fps: float) -> None:
    scene = Scene(bones())
    times = np.arange(101) / fps
    scene.animate(
        "wave",
        (
            1,
            "rotation",
            times,
            rotation.from_axis_angle(np.tile([0, 0, 1.0], (101, 1)), 0.01 * np.arange(101)),
            "LINEAR",
        ),
    )
    clip = read_one(scene, tmp_path)
    assert clip.fps == pytest.approx(fps, rel=1e-3)
    assert clip.frames == 101


@pytest.mark.parametrize("times", [[2, 3], [-1, 0]])
def test_a_start_that_is_not_zero_is_moved_to_zero_with_a_note(tmp_path: Path, times: list[int]) -> None:
    scene = Scene(bones())
    scene.animate("late", (1, "rotation", times, TURN, "LINEAR"))
    clip = read_one(scene, tmp_path)
    assert clip.frames == 31 and any("starts at" in note for note in clip.notes)


def test_one_key_makes_one_frame(tmp_path: Path) -> None:
    scene = Scene(bones())
    scene.animate("pose", (1, "rotation", [0], TURN[1:], "LINEAR"))
    assert read_one(scene, tmp_path).frames == 1


# --- skeletons


def test_scale_and_turn_of_an_armature_are_folded_into_the_top_joint(tmp_path: Path) -> None:
    nodes = bones()
    for node in nodes:
        node["translation"] = [100 * x for x in node["translation"]]
    nodes.append(
        {"name": "Armature", "children": [0], "scale": [0.01] * 3, "rotation": [-QUARTER, 0, 0, QUARTER]}
    )
    scene = Scene(nodes)
    scene.animate(
        "bend",
        (0, "translation", [0, 1], [[0, 0, 100], [0, 0, 200]], "LINEAR"),
        (0, "rotation", [0, 1], TURN, "LINEAR"),
    )
    clip = read_one(scene, tmp_path)
    assert clip.skeleton.names == ("Hips", "Spine", "Head")
    np.testing.assert_allclose(
        clip.skeleton.rest_translations, [[0, 0, -1], [0, 0.5, 0], [0, 0.3, 0]], atol=1e-9
    )
    np.testing.assert_allclose(clip.root[[0, -1]], [[0, 1, 0], [0, 2, 0]], atol=1e-6)
    expected = rotation.multiply(np.array([-QUARTER, 0, 0, QUARTER]), np.array(TURN[1]))
    assert rotation.measure_angle_between(clip.rotations[-1, 0].astype(float), expected) < 1e-6


def test_an_armature_that_moves_becomes_a_joint(tmp_path: Path) -> None:
    nodes = [*bones(), {"name": "Armature", "children": [0]}]
    scene = Scene(nodes)
    matrices = scene.array(np.tile(np.eye(4), (3, 1, 1)).reshape(-1, 16))
    scene.json["skins"] = [{"joints": [0, 1, 2], "inverseBindMatrices": matrices}]
    scene.animate("walk", (3, "translation", [0, 1], [[0, 0, 0], [0, 0, 3]], "LINEAR"))
    clip = read_one(scene, tmp_path)
    assert clip.skeleton.names[0] == "Armature"
    assert clip.root[-1, 2] == pytest.approx(3)


def test_even_scale_inside_the_skeleton_lengthens_the_bones_below(tmp_path: Path) -> None:
    nodes = bones()
    nodes[1]["scale"] = [2, 2, 2]
    scene = Scene(nodes)
    scene.animate("bend", (1, "rotation", [0, 1], TURN, "LINEAR"))
    clip = read_one(scene, tmp_path)
    np.testing.assert_allclose(clip.skeleton.rest_translations[2], [0, 0.6, 0])
    assert not clip.notes


def test_uneven_and_animated_scale_are_noted(tmp_path: Path) -> None:
    nodes = bones()
    nodes[1]["scale"] = [1, 2, 1]
    scene = Scene(nodes)
    scene.animate(
        "bend",
        (1, "rotation", [0, 1], TURN, "LINEAR"),
        (2, "scale", [0, 1], [[1, 1, 1], [2, 2, 2]], "LINEAR"),
    )
    notes = " ".join(read_one(scene, tmp_path).notes)
    assert "scaled unevenly" in notes and "scale of 1 joints" in notes


def test_translations_that_stay_within_a_hundredth_of_a_millimetre_are_dropped(tmp_path: Path) -> None:
    scene = Scene(bones())
    still = [[0, 0.3, 0], [0, 0.3 + 5e-6, 0]]
    scene.animate(
        "bend",
        (2, "translation", [0, 1], still, "LINEAR"),
        (1, "translation", [0, 1], [[0, 0.5, 0], [0, 0.6, 0]], "LINEAR"),
    )
    assert read_one(scene, tmp_path).translated == (0, 1)


def test_the_bind_pose_counts_where_nodes_were_saved_in_another_pose(tmp_path: Path) -> None:
    posed = bones()
    posed[1]["rotation"] = TURN[1]
    worlds = np.tile(np.eye(4), (3, 1, 1))
    worlds[:, 1, 3] = [1, 1.5, 1.8]
    prints = set()
    for nodes in (bones(), posed):
        scene = Scene(nodes)
        inverse = scene.array(np.linalg.inv(worlds).transpose(0, 2, 1).reshape(-1, 16))
        scene.json["skins"] = [{"joints": [0, 1, 2], "inverseBindMatrices": inverse}]
        scene.animate("bend", (1, "rotation", [0, 1], TURN, "LINEAR"))
        prints.add(read_one(scene, tmp_path).skeleton.fingerprint)
    assert len(prints) == 1


def test_a_skeleton_in_centimetres_is_read_as_metres_with_a_note(tmp_path: Path) -> None:
    nodes = bones()
    for node in nodes:
        node["translation"] = [100 * x for x in node["translation"]]
    scene = Scene(nodes)
    scene.animate("bend", (1, "rotation", [0, 1], TURN, "LINEAR"))
    clip = read_one(scene, tmp_path)
    assert clip.skeleton.height == pytest.approx(0.8)
    assert any("centimetres" in note for note in clip.notes)


def test_repeated_and_missing_names_are_made_unique(tmp_path: Path) -> None:
    nodes = bones()
    nodes[1]["name"] = "Hips"
    del nodes[2]["name"]
    scene = Scene(nodes)
    scene.animate("bend", (1, "rotation", [0, 1], TURN, "LINEAR"))
    assert read_one(scene, tmp_path).skeleton.names == ("Hips", "Hips_2", "node_2")


def test_nodes_with_matrices_are_taken_apart(tmp_path: Path) -> None:
    nodes = bones()
    nodes[1] = {
        "name": "Spine",
        "children": [2],
        "matrix": compose(np.array([0, 0.5, 0]), np.array(TURN[1]), np.ones(3)).T.reshape(-1).tolist(),
    }
    scene = Scene(nodes)
    scene.animate("nod", (2, "rotation", [0, 1], TURN, "LINEAR"))
    clip = read_one(scene, tmp_path)
    assert rotation.measure_angle_between(clip.skeleton.rest_rotations[1], TURN[1]) < 1e-6


def test_a_bind_pose_key_at_the_start_is_dropped_only_when_plain(tmp_path: Path) -> None:
    angles = np.concatenate([[0], 1 + 0.01 * np.arange(20)])
    for start, expected in ((0.0, 20), (0.95, 21)):
        angles[0] = start
        scene = Scene(bones())
        keys = rotation.from_axis_angle(np.tile([0, 0, 1.0], (21, 1)), angles)
        scene.animate("lean", (1, "rotation", np.arange(21) / 30, keys, "LINEAR"))
        assert read_one(scene, tmp_path).frames == expected


# --- morph targets, VRM


def smiling() -> Scene:
    scene = Scene([*bones(), {"name": "Face", "mesh": 0}])
    scene.json["nodes"][2]["children"] = [3]
    corners = scene.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]])
    smile = scene.array([[0, 0, 0], [0, 0.1, 0], [0, 0, 0]])
    scene.json["meshes"] = [
        {
            "primitives": [{"attributes": {"POSITION": corners}, "targets": [{"POSITION": smile}] * 2}],
            "extras": {"targetNames": ["smile", "blink"]},
        }
    ]
    scene.animate(
        "talk", (1, "rotation", [0, 1], TURN, "LINEAR"), (3, "weights", [0, 1], [0, 1, 1, 0], "LINEAR")
    )
    return scene


def test_morph_weights_come_with_their_names(tmp_path: Path) -> None:
    clip = read_one(smiling(), tmp_path)
    assert clip.morphs == ("smile", "blink")
    assert clip.weights is not None
    np.testing.assert_allclose(clip.weights[[0, 15, 30]], [[0, 1], [0.5, 0.5], [1, 0]], atol=1e-6)


def take(scene: Scene, name: str, seconds: float, body: bool, face: bool) -> None:
    turned = [(1, "rotation", [0, seconds], TURN, "LINEAR")] if body else []
    shown = [(3, "weights", [0, seconds], [0, 1, 1, 0], "LINEAR")] if face else []
    scene.animate(name, *turned, *shown)


def test_the_face_of_a_take_that_is_an_animation_of_its_own_is_joined_to_it(tmp_path: Path) -> None:
    scene = smiling()
    scene.json["animations"] = []
    take(scene, "FaceAction", 1.0, False, True)
    take(scene, "talk", 1.0, True, False)
    take(scene, "idle", 3.0, True, False)
    face, talk, idle = read_clips(scene.glb(tmp_path / "file.glb"))
    assert (face.name, face.face_of, talk.face_of) == ("FaceAction", "talk", "")
    imported = import_clips([tmp_path / "file.glb"])
    assert [(take, clip.name) for _, take, clip in imported.clips] == [(1, "talk"), (2, "idle")]
    assert (talk.name, talk.morphs, idle.name, idle.morphs) == ("talk", ("smile", "blink"), "idle", ())
    assert talk.weights is not None and any("'FaceAction'" in note for note in talk.notes)
    np.testing.assert_allclose(talk.weights[[0, 15, 30]], [[0, 1], [0.5, 0.5], [1, 0]], atol=1e-6)


@pytest.mark.parametrize(
    ("names", "owners"),
    [
        (("talk", "wave", "wave_face", "talk_face"), {"talk_face": "talk", "wave_face": "wave"}),
        (("talk", "wave", "one", "two"), {"one": "talk", "two": "wave"}),
        (
            ("wave", "talk", "talk_face", "face of the wave"),
            {"face of the wave": "wave", "talk_face": "talk"},
        ),
    ],
)
def test_of_as_many_faces_as_takes_each_goes_by_its_name_or_else_its_place(
    tmp_path: Path, names: tuple[str, ...], owners: dict[str, str]
) -> None:
    scene = smiling()
    scene.json["animations"] = []
    for name in names:
        take(scene, name, 1.0, name in ("talk", "wave"), name not in ("talk", "wave"))
    found = read_gltf_clips(scene.glb(tmp_path / "file.glb"))
    assert {clip.name: clip.face_of for clip in found if clip.face_of} == owners


def test_a_name_within_another_takes_name_does_not_take_its_face(tmp_path: Path) -> None:
    scene = smiling()
    scene.json["animations"] = []
    for name in ("talk2", "talk", "talk_face", "talk2_face"):
        take(scene, name, 1.0, "face" not in name, "face" in name)
    found = read_gltf_clips(scene.glb(tmp_path / "file.glb"))
    assert {clip.name: clip.face_of for clip in found if clip.face_of} == {
        "talk_face": "talk",
        "talk2_face": "talk2",
    }


def test_of_several_takes_as_long_as_a_face_none_is_given_it(tmp_path: Path) -> None:
    scene = smiling()
    scene.json["animations"] = []
    for name, body, face in (
        ("a", True, False),
        ("b", True, False),
        ("face", False, True),
        ("c", True, True),
    ):
        take(scene, name, 1.0, body, face)
    found = read_gltf_clips(scene.glb(tmp_path / "file.glb"))
    assert [(clip.name, bool(clip.morphs)) for clip in found] == [
        ("a", False),
        ("b", False),
        ("face", True),
        ("c", True),
    ]


def test_a_mesh_without_a_skin_hangs_on_its_joint_and_keeps_its_morph_targets(tmp_path: Path) -> None:
    character = read_character(smiling().glb(tmp_path / "face.glb"))
    assert character.skeleton.names[character.joints[0, 0]] == "Head"
    np.testing.assert_allclose(character.positions[0], [0, 1.8, 0], atol=1e-6)
    np.testing.assert_allclose(character.normals, [[0, 0, 1]] * 3, atol=1e-6)
    assert character.morph_positions is not None and character.morph_positions.shape == (2, 3, 3)


@pytest.mark.parametrize(
    "extension",
    [
        {"VRMC_vrm": {"humanoid": {"humanBones": {"hips": {"node": 0}, "head": {"node": 2}}}}},
        {"VRM": {"humanoid": {"humanBones": [{"bone": "hips", "node": 0}, {"bone": "head", "node": 2}]}}},
    ],
)
def test_vrm_files_state_their_roles(tmp_path: Path, extension: dict[str, Any]) -> None:
    scene = Scene(bones())
    scene.json["extensions"] = extension
    scene.animate("bend", (1, "rotation", [0, 1], TURN, "LINEAR"))
    assert read_vrm_roles(scene.glb(tmp_path / "me.vrm")) == {"hips": "Hips", "head": "Head"}


def vrm_animation(skin: bool) -> Scene:
    scene = Scene([*bones(), {"name": "mouth"}, {"name": "smirk"}, {"name": "eyes"}])
    if skin:
        scene.json["skins"] = [{"joints": [0, 1, 2]}]
    scene.json["extensions"] = {
        "VRMC_vrm_animation": {
            "humanoid": {"humanBones": {"hips": {"node": 0}, "head": {"node": 2}}},
            "expressions": {"preset": {"aa": {"node": 3}}, "custom": {"Smirk": {"node": 4}, "odd": 7}},
            "lookAt": {"node": 5},
        }
    }
    moved = [[0, 0, 0], [0.5, 0, 0], [1, 0, 0]]
    scene.animate(
        "talk",
        (1, "rotation", [0, 1], TURN, "LINEAR"),
        (3, "translation", [0, 0.5, 1], moved, "LINEAR"),
        (4, "translation", [0, 0.5, 1], moved[::-1], "LINEAR"),
        (5, "rotation", [0, 1], TURN, "LINEAR"),
    )
    return scene


@pytest.mark.parametrize("skin", [True, False])
def test_the_expressions_of_a_vrm_animation_are_weights_and_its_eyes_are_named(
    tmp_path: Path, skin: bool
) -> None:
    clip = read_one(vrm_animation(skin), tmp_path, "talk.vrma")
    assert clip.skeleton.names == ("Hips", "Spine", "Head")
    assert clip.morphs == ("aa", "Smirk") and clip.weights is not None
    np.testing.assert_allclose(clip.weights[[0, 15, 30]], [[0, 1], [0.5, 0.5], [1, 0]], atol=1e-6)
    assert any("lookAt" in note for note in clip.notes)


def test_an_expression_whose_weight_is_no_number_of_its_node_is_refused(tmp_path: Path) -> None:
    scene = vrm_animation(False)
    scene.animate("odd", (3, "translation", [0, 1], [0.0, 1.0], "LINEAR"))
    refused(scene, tmp_path, "VEC3")


def test_files_that_are_not_vrm_state_no_roles(tmp_path: Path) -> None:
    scene = Scene(bones())
    assert read_vrm_roles(scene.glb(tmp_path / "me.glb")) == {}


# --- text files and buffers


def as_text(scene: Scene, uri: str) -> str:
    scene.json["buffers"] = [{"byteLength": len(scene.data), "uri": uri}]
    return json.dumps(scene.json)


def bending() -> Scene:
    scene = Scene(bones())
    scene.animate("bend", (1, "rotation", [0, 1], TURN, "LINEAR"))
    return scene


def test_text_files_take_their_buffer_from_a_data_uri_or_a_file_beside_them(tmp_path: Path) -> None:
    scene, path = bending(), tmp_path / "bend.gltf"
    path.write_text(
        as_text(scene, "data:application/octet-stream;base64," + base64.b64encode(scene.data).decode())
    )
    assert read_gltf_clips(path)[0].frames == 31
    (tmp_path / "my data.bin").write_bytes(scene.data)
    path.write_text(as_text(scene, "my%20data.bin"))
    assert read_gltf_clips(path)[0].frames == 31


@pytest.mark.parametrize(
    "uri",
    [
        "gone.bin",
        "../secret.bin",
        "/etc/hostname",
        "https://example.org/a.bin",
        "data:;base64,!!",
        "",
        "\x00",
    ],
)
def test_buffers_that_are_absent_or_elsewhere_are_refused(tmp_path: Path, uri: str) -> None:
    (tmp_path / "secret.bin").write_bytes(b"\0" * 1000)
    (tmp_path / "inner").mkdir()
    path = tmp_path / "inner" / "bend.gltf"
    path.write_text(as_text(bending(), uri))
    with pytest.raises(FileError) as caught:
        read_gltf_clips(path)
    assert caught.value.where and caught.value.remedy


# --- refused


@pytest.mark.parametrize("name", ["KHR_meshopt_compression", "ACME_future"])
def test_required_extensions_that_are_unknown_are_refused_by_name(tmp_path: Path, name: str) -> None:
    scene = bending()
    scene.json["extensionsRequired"] = [name]
    refused(scene, tmp_path, name, "without")


def test_the_motion_of_a_file_packed_with_draco_is_read_and_its_mesh_refused_with_a_remedy(
    tmp_path: Path,
) -> None:
    scene = smiling()
    scene.json["extensionsRequired"] = ["KHR_draco_mesh_compression"]
    clip = read_one(scene, tmp_path)
    assert clip.morphs == ("smile", "blink") and any("Draco" in note for note in clip.notes)
    with pytest.raises(FileError, match="gltf-transform"):
        read_character(tmp_path / "file.glb")


def by_pointers(scene: Scene, **others: str) -> Scene:
    """The same animations with KHR_animation_pointer; others: pointers instead of those to nodes, by path."""
    for animation in scene.json["animations"]:
        for channel in animation["channels"]:
            target = channel["target"]
            pointer = f"/nodes/{target['node']}/{target['path']}"
            said = {"KHR_animation_pointer": {"pointer": others.get(target["path"], pointer)}}
            channel["target"] = {"path": "pointer", "extensions": said}
    scene.json["extensionsUsed"] = scene.json["extensionsRequired"] = ["KHR_animation_pointer"]
    return scene


def test_animation_pointers_to_joints_and_weights_move_what_they_point_to(tmp_path: Path) -> None:
    for made in (bending, smiling):
        plain, pointed = read_one(made(), tmp_path), read_one(by_pointers(made()), tmp_path, "pointed.glb")
        assert np.array_equal(plain.rotations, pointed.rotations)
        assert plain.morphs == pointed.morphs and np.array_equal(plain.weights, pointed.weights)


def test_a_pointer_to_something_else_is_left_out_by_name(tmp_path: Path) -> None:
    scene = bending()
    more = [(1, "translation", [0, 1], [[0, 1, 0], [0, 1.2, 0]], "LINEAR")]
    scene.animate("lit", (1, "rotation", [0, 1], TURN, "LINEAR"), *more)
    by_pointers(scene, translation="/materials/0/emissiveFactor")
    clips = read_gltf_clips(scene.glb(tmp_path / "a.glb"))
    assert any("'/materials/0/emissiveFactor' were left out" in note for note in clips[1].notes)
    assert len(clips[0].rotations) == len(clips[1].rotations)


def test_quantised_meshes_are_welcome(tmp_path: Path) -> None:
    scene = bending()
    scene.json["extensionsRequired"] = ["KHR_mesh_quantization"]
    corners = scene.array([[0, 0, 0, 0], [100, 0, 0, 0], [0, 50, 0, 0]], "<i2")
    scene.json["accessors"][corners]["type"] = "VEC3"
    scene.json["bufferViews"][-1]["byteStride"] = 8
    scene.json["meshes"] = [{"primitives": [{"attributes": {"POSITION": corners}}]}]
    scene.json["nodes"].append({"name": "Mesh", "mesh": 0, "scale": [0.01] * 3})
    character = read_character(scene.glb(tmp_path / "small.glb"))
    np.testing.assert_allclose(character.positions, [[0, 0, 0], [1, 0, 0], [0, 0.5, 0]], atol=1e-6)


def test_a_file_without_animation_is_refused_with_advice(tmp_path: Path) -> None:
    refused(Scene(bones()), tmp_path, "no animation")


def test_a_circle_of_nodes_is_refused(tmp_path: Path) -> None:
    scene = bending()
    scene.json["nodes"][2]["children"] = [0]
    scene.json["nodes"].append({"name": "top"})
    refused(scene, tmp_path, "ancestor")


def test_a_node_with_two_parents_is_refused(tmp_path: Path) -> None:
    scene = bending()
    scene.json["nodes"][0]["children"] = [1, 2]
    refused(scene, tmp_path, "more than one parent")


def test_keys_that_are_not_numbers_are_refused_with_their_node(tmp_path: Path) -> None:
    scene = Scene(bones())
    scene.animate("bend", (1, "rotation", [0, 1], [[0, 0, 0, 1], [np.nan, 0, 0, 1]], "LINEAR"))
    refused(scene, tmp_path, "bend", "Spine")


@pytest.mark.parametrize("times", [[1, 0], [0, np.nan], [0, np.inf], [0, 1e9]])
def test_senseless_key_times_are_refused(tmp_path: Path, times: list[float]) -> None:
    scene = Scene(bones())
    scene.animate("bend", (1, "rotation", times, TURN, "LINEAR"))
    refused(scene, tmp_path, "bend")


def test_an_accessor_beyond_its_buffer_is_refused(tmp_path: Path) -> None:
    scene = bending()
    scene.json["accessors"][1]["count"] = 1 << 40
    refused(scene, tmp_path, "accessor 1")


def test_an_empty_accessor_may_not_ask_for_memory_out_of_proportion(tmp_path: Path) -> None:
    scene = bending()
    del scene.json["accessors"][1]["bufferView"]
    scene.json["accessors"][1]["count"] = 1 << 40
    refused(scene, tmp_path, "memory")


def test_the_wrong_number_of_values_is_refused(tmp_path: Path) -> None:
    scene = Scene(bones())
    scene.animate("bend", (1, "rotation", [0, 1, 2], TURN, "LINEAR"))
    refused(scene, tmp_path, "expected 3x4")


# --- writing


def moving(frames: int = 40, fps: float = 24.0) -> list[Clip]:
    skeleton = mannequin_skeleton()
    t = np.arange(frames) / fps
    wave = rotation.make_identity_rotations((frames, len(skeleton)))
    arm = skeleton.index("RightUpperArm")
    wave[:, arm] = rotation.from_axis_angle(np.tile([0, 0, 1.0], (frames, 1)), np.sin(5 * t))
    wave[:, 5] = rotation.from_axis_angle(np.array([0, 1.0, 0]), np.array(0.3))
    root = skeleton.rest_translations[0] + np.stack([0.1 * np.sin(t), 0 * t, 0 * t], 1)
    jaw = np.tile(skeleton.rest_translations[6], (frames, 1)) + 0.01
    still = np.tile(skeleton.rest_translations[:1], (frames, 1, 1))
    return [
        Clip("wave", skeleton, fps, wave, np.stack([root, jaw], 1), (0, 6)),
        Clip("still", skeleton, fps, rotation.make_identity_rotations((frames, len(skeleton))), still),
        Clip("pose", skeleton, fps, wave[:1], still[:1]),
    ]


def figure() -> CharacterMesh:
    skeleton = mannequin_skeleton()
    positions = np.array([[0, 1, 0], [0.1, 1, 0], [0, 1.1, 0], [0, 1.7, 0]], np.float32)
    png = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\1\0\0\0\1" + b"\0" * 20
    return CharacterMesh(
        "figure",
        skeleton,
        positions,
        np.tile(np.float32([0, 0, 1]), (4, 1)),
        np.zeros((4, 2), np.float32),
        np.array([[0, 1, 0, 0], [0, 0, 0, 0], [3, 0, 0, 0], [5, 0, 0, 0]]),
        np.array([[0.5, 0.5, 0, 0]] + [[1, 0, 0, 0]] * 3, np.float32),
        np.array([[0, 1, 2], [0, 2, 3]]),
        (MeshMaterial("skin", (1, 0.5, 0.25, 1), png), MeshMaterial("cloth", double_sided=True)),
        (Surface(0, 1, 0), Surface(1, 1, 1)),
        ("smile",),
        np.full((1, 4, 3), 0.01, np.float32),
    )


def assert_same(clip: Clip, back: Clip, tolerance: float) -> None:
    assert (back.name, back.fps, back.frames, back.skeleton) == (
        clip.name,
        clip.fps,
        clip.frames,
        clip.skeleton,
    )
    mine, theirs = clip.poses(), back.poses()
    side = np.sign(np.einsum("fji,fji->fj", mine.rotations, theirs.rotations))[..., None]
    assert np.abs(mine.rotations - theirs.rotations * side).max() <= tolerance
    assert np.abs(mine.translations - theirs.translations).max() <= tolerance


@pytest.mark.parametrize(("quantize", "tolerance"), [(True, 1e-4), (False, 1e-6)])
def test_written_and_read_back_clips_are_equal(tmp_path: Path, quantize: bool, tolerance: float) -> None:
    clips = moving()
    write_glb(tmp_path / "all.glb", clips, keys=Keys(quantize))
    for clip, back in zip(clips, read_gltf_clips(tmp_path / "all.glb"), strict=True):
        assert_same(clip, back, tolerance)


def test_a_written_character_reads_back_with_its_skin_morphs_and_materials(tmp_path: Path) -> None:
    character = figure()
    skeleton = character.skeleton
    weights = np.linspace(0, 1, 9)[:, None]
    still = np.tile(skeleton.rest_translations[:1], (9, 1, 1))
    clip = Clip(
        "smile",
        skeleton,
        30,
        rotation.make_identity_rotations((9, len(skeleton))),
        still,
        morphs=("smile",),
        weights=weights,
    )
    write_glb(tmp_path / "figure.glb", [clip], character)
    back = read_character(tmp_path / "figure.glb")
    np.testing.assert_allclose(back.positions, character.positions, atol=1e-5)
    np.testing.assert_allclose(back.weights, character.weights)
    np.testing.assert_array_equal(back.triangles, character.triangles)
    assert back.materials[0].image == character.materials[0].image and back.materials[1].double_sided
    assert back.morphs == ("smile",)
    read = read_gltf_clips(tmp_path / "figure.glb")[0]
    assert read.weights is not None
    np.testing.assert_allclose(read.weights, weights, atol=1e-6)


def test_thinning_out_keys_keeps_the_motion_within_tolerance_and_shrinks_the_file(tmp_path: Path) -> None:
    clips = moving(4000)
    write_glb(tmp_path / "all.glb", clips, keys=Keys(tolerance=0))
    write_glb(tmp_path / "thin.glb", clips, keys=Keys(tolerance=1e-3))
    assert_same(clips[0], read_gltf_clips(tmp_path / "thin.glb")[0], 1.1e-3)
    assert (tmp_path / "thin.glb").stat().st_size < 0.8 * (tmp_path / "all.glb").stat().st_size


def test_clips_of_different_skeletons_are_not_mixed(tmp_path: Path) -> None:
    other = read_one(bending(), tmp_path)
    with pytest.raises(ValueError, match="another skeleton"):
        write_glb(tmp_path / "all.glb", [*moving(), other])
    with pytest.raises(ValueError, match="nothing to write"):
        write_glb(tmp_path / "none.glb", [])


def validator() -> tuple[str, str]:
    """Return node and the folder whose node_modules hold gltf-validator."""
    folders = [os.environ.get("METAGRAPH_GLTF_VALIDATOR", ""), str(Path(__file__).parents[2])]
    node = shutil.which("node")
    for folder in folders:
        if node and folder and (Path(folder) / "node_modules" / "gltf-validator").is_dir():
            return node, folder
    pytest.skip(
        "node or gltf-validator is missing (set METAGRAPH_GLTF_VALIDATOR to the folder with its node_modules)"
    )


@pytest.mark.parametrize("quantize", [True, False])
def test_written_files_pass_the_khronos_validator(tmp_path: Path, quantize: bool) -> None:
    node, folder = validator()
    write_glb(tmp_path / "clips.glb", moving(), keys=Keys(quantize))
    character = figure()
    image = base64.b64decode(
        "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=="
    )
    materials = (MeshMaterial("skin", (1, 0.5, 0.25, 1), image), character.materials[1])
    fields = {f: getattr(character, f) for f in character.__dataclass_fields__}
    write_glb(
        tmp_path / "figure.glb",
        moving(),
        CharacterMesh(**{**fields, "materials": materials}),
        keys=Keys(quantize),
    )
    program = (
        "const v=require('gltf-validator'),fs=require('fs');(async()=>{for(const f of process.argv.slice(1))"
        "{const r=await v.validateBytes(new "
        "Uint8Array(fs.readFileSync(f)));console.log(JSON.stringify(r.issues))}})()"
    )
    files = [str(tmp_path / "clips.glb"), str(tmp_path / "figure.glb")]
    done = subprocess.run(
        [node, "-e", program, *files], cwd=folder, capture_output=True, text=True, check=True, timeout=300
    )
    for line in done.stdout.splitlines():
        issues = json.loads(line)
        assert issues["numErrors"] == 0 and issues["numWarnings"] == 0, issues["messages"][:5]


# --- real files


def by_the_book(path: Path, name: str, seconds: float) -> dict[str, np.ndarray]:
    """Evaluate one animation as the specification says, one node at a time: world matrices by node name."""
    data = path.read_bytes()
    size = struct.unpack_from("<I", data, 12)[0]
    doc, blob = json.loads(data[20 : 20 + size]), data[28 + size :]

    def values(index: int) -> np.ndarray:
        accessor = doc["accessors"][index]
        view = doc["bufferViews"][accessor["bufferView"]]
        width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[accessor["type"]]
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        return np.frombuffer(blob, "<f4", accessor["count"] * width, start).reshape(-1, width).astype(float)

    pose = [
        {"translation": (0, 0, 0), "rotation": (0, 0, 0, 1), "scale": (1, 1, 1), **node}
        for node in doc["nodes"]
    ]
    animation = next(a for a in doc["animations"] if a["name"] == name)
    for channel in animation["channels"]:
        sampler = animation["samplers"][channel["sampler"]]
        if channel["target"]["path"] == "weights":
            continue
        times, keys = values(sampler["input"])[:, 0], values(sampler["output"])
        k = int(np.clip(np.searchsorted(times, seconds + 1e-5, "right") - 1, 0, max(0, len(times) - 2)))
        gap = times[k + 1] - times[k] if len(times) > 1 else 1.0
        u = float(np.clip((seconds - times[k]) / gap, 0, 1))
        mode = sampler.get("interpolation", "LINEAR")
        if mode == "CUBICSPLINE":
            p0, m0, p1, m1 = keys[3 * k + 1], gap * keys[3 * k + 2], keys[3 * k + 4], gap * keys[3 * k + 3]
            value = (
                (2 * u**3 - 3 * u**2 + 1) * p0
                + (u**3 - 2 * u**2 + u) * m0
                + (3 * u**2 - 2 * u**3) * p1
                + (u**3 - u**2) * m1
            )
        elif len(times) == 1 or (mode == "STEP" and u < 1):
            value = keys[k]
        elif channel["target"]["path"] == "rotation":
            value = rotation.slerp(keys[k], keys[k + 1], u)
        else:
            value = keys[k] * (1 - u) + keys[k + 1] * u
        pose[channel["target"]["node"]][channel["target"]["path"]] = value
    parents = {child: i for i, node in enumerate(doc["nodes"]) for child in node.get("children", [])}

    def world(i: int) -> np.ndarray:
        own = compose(*(np.asarray(pose[i][k], float) for k in ("translation", "rotation", "scale")))
        return np.asarray(world(parents[i]) @ own if i in parents else own)

    return {node.get("name", ""): world(i) for i, node in enumerate(doc["nodes"])}


@pytest.mark.parametrize(
    ("file", "name", "frame", "unit"),
    [
        ("sumerian-hosts/glTF/animations/alien/gesture.glb", "wave", 40, 1.0),
        ("sumerian-hosts/glTF/animations/adult_female/lipsync.glb", "stand_talk", 100, 0.01),
        ("sumerian-hosts/glTF/animations/adult_male/poi.glb", "head_l", 1, 1.0),
        ("robot-expressive/RobotExpressive.glb", "Wave", 17, 1.0),
        ("kaykit-rogue/Rogue.glb", "Cheer", 20, 1.0),
        ("mesh2motion-cmu/bird-animations.glb", "Fly", 9, 1.0),
    ],
)
def test_real_clips_put_every_joint_where_the_specification_does(
    shared_data: Path, file: str, name: str, frame: int, unit: float
) -> None:
    agrees_with_the_book(shared_data / file, name, frame, unit, rough="adult" in file)


@pytest.mark.parametrize("name", [name for name, animal in zoo.ANIMALS.items() if animal.kind == ".glb"])
@pytest.mark.parametrize("take", zoo.TAKES)
def test_clips_of_the_zoo_put_every_joint_where_the_specification_does(
    zoo_files: dict[str, Path], name: str, take: str
) -> None:
    agrees_with_the_book(zoo_files[name], take, 17, 1.0)


def agrees_with_the_book(file: Path, name: str, frame: int, unit: float, rough: bool = False) -> None:
    clip = next(c for c in read_gltf_clips(file) if c.name == name)
    rotations, positions = clip.skeleton.globals(clip.poses()[frame])
    expected = by_the_book(file, name, frame / clip.fps)
    for i, joint in enumerate(clip.skeleton.names):
        np.testing.assert_allclose(
            positions[i], expected[joint][:3, 3] * unit, atol=2e-3 if rough else 2e-4, err_msg=joint
        )
        axes = expected[joint][:3, :3] / np.linalg.norm(expected[joint][:3, :3], axis=0)
        np.testing.assert_allclose(
            rotation.to_matrix(rotations[i]), axes, atol=2e-2 if rough else 2e-3, err_msg=joint
        )


@pytest.mark.parametrize(
    "file", ["characters/alien/alien.gltf", "characters/adult_female/cristine/cristine.gltf"]
)
def test_real_characters_stand_in_their_rest_pose(shared_data: Path, file: str) -> None:
    character = read_character(shared_data / "sumerian-hosts" / "glTF" / file)
    assert np.ptp(character.positions[:, 1]) == pytest.approx(1.2 if "alien" in file else 1.77, abs=0.03)
    assert np.abs(character.positions[:, 1].min()) < 0.02
    _, joints = character.skeleton.globals(character.skeleton.rest)
    strongest = character.joints[np.arange(len(character.joints)), character.weights.argmax(1)]
    assert (
        np.linalg.norm(character.positions - joints[strongest], axis=1).max() < 0.6
    )  # every vertex is near its joint
    assert any("texture left out" in note for note in character.notes)


def test_attached_weapons_stay_in_the_hand(shared_data: Path) -> None:
    character = read_character(shared_data / "kaykit-rogue" / "Rogue.glb")
    slot = character.skeleton.index("handslot.r")
    held = character.positions[(character.joints[:, 0] == slot) & (character.weights[:, 0] == 1)]
    _, joints = character.skeleton.globals(character.skeleton.rest)
    assert len(held) > 100
    assert np.linalg.norm(held.mean(0) - joints[slot]) < 1.0
    assert character.materials[0].image is not None


def test_files_of_one_character_share_a_skeleton(shared_data: Path) -> None:
    folder = shared_data / "sumerian-hosts" / "glTF" / "animations" / "alien"
    prints = {read_gltf_clips(f)[0].skeleton.fingerprint for f in sorted(folder.glob("*.glb"))}
    prints.add(read_character(folder.parents[1] / "characters" / "alien" / "alien.gltf").skeleton.fingerprint)
    assert len(prints) == 1
