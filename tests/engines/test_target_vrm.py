"""The VRM target: a figure in a T whose bones, expressions and licence stand where VRM 1.0 wants them."""

from __future__ import annotations

import json
import struct
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from metagraph.engines.export_error import ExportError
from metagraph.engines.targets import registry
from metagraph.engines.targets.target import Contents
from metagraph.engines.targets.vrm import META
from metagraph.errors import FileError
from metagraph.formats.gltf.reader import read_character, read_gltf_clips
from metagraph.graph.edits import add_clips, add_stance
from metagraph.graph.model import Project
from metagraph.motion import rotation
from tests.engines.test_export import gltf, khronos
from tests.engines.test_npm_package import PACKAGES, needs
from tests.engines.test_npm_package import node as run_node

SAMPLES = Path(__file__).parents[2] / "sample_clips"


@pytest.fixture(scope="module")
def project() -> Project:
    [still] = read_gltf_clips(SAMPLES / "clips" / "hands_at_sides__stance.glb")
    made = add_clips(Project(name="Somebody"), [("still.glb", 0, "", still)])
    return add_stance(made, "arms", "rest", list(made.clips))


@pytest.fixture(scope="module")
def written(project: Project, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("vrm")
    report = registry.write_for_target(project, "vrm", folder, Contents(SAMPLES / "ada.glb", base=folder))
    assert any(META in warning for warning in report.warnings)
    return report.files[0]


def turned(nodes: list[Any]) -> tuple[dict[str, Any], list[Any]]:
    """Return where nodes stand, by name."""
    at: dict[str, Any] = {}
    globals_: list[Any] = [None] * len(nodes)
    above = {child: n for n, node in enumerate(nodes) for child in node.get("children", ())}
    for n, node in enumerate(nodes):
        own = np.array(node.get("translation", [0, 0, 0])), np.array(node.get("rotation", [0, 0, 0, 1.0]))
        parent = globals_[above[n]] if n in above else (np.zeros(3), np.array([0, 0, 0, 1.0]))
        globals_[n] = (
            parent[0] + rotation.rotate_vectors(parent[1], own[0]), rotation.multiply(parent[1], own[1])
        )  # fmt: skip
        at[node["name"]] = globals_[n][0]
    return at, globals_


@pytest.mark.nightly
def test_the_figure_stands_in_a_t_on_its_feet(written: Path) -> None:
    assert written.suffix == ".vrm"
    khronos(written)
    at, _ = turned(gltf(written)["nodes"])
    for side, way in (("Left", 1), ("Right", -1)):
        arm = at[f"{side}Hand"] - at[f"{side}UpperArm"]
        assert way * arm[0] > 0.45 and np.abs(arm[1:]).max() < 0.002
        leg = at[f"{side}Foot"] - at[f"{side}UpperLeg"]
        assert leg[1] < -0.7 and np.abs(leg[[0, 2]]).max() < 0.002
    assert at["LeftFoot"][1] == pytest.approx(0.082, abs=0.002)


def test_bones_expressions_and_eyes_are_vrms(written: Path) -> None:
    document = gltf(written)
    vrm = document["extensions"]["VRMC_vrm"]
    assert document["extensionsUsed"] == ["VRMC_vrm"] and vrm["specVersion"] == "1.0"
    bones = {bone: document["nodes"][b["node"]]["name"] for bone, b in vrm["humanoid"]["humanBones"].items()}
    assert len(bones) == len(set(bones.values())) == 55
    assert bones["leftThumbMetacarpal"] == "LeftThumb1" and bones["rightLittleDistal"] == "RightLittle3"
    presets = vrm["expressions"]["preset"]
    assert {"happy", "angry", "sad", "relaxed", "surprised", "aa", "blink", "lookLeft"} <= presets.keys()
    names = document["meshes"][0]["extras"]["targetNames"]
    for preset in presets.values():
        for bind in preset["morphTargetBinds"]:
            assert "mesh" in document["nodes"][bind["node"]]
            assert 0 <= bind["index"] < len(names) and 0 < bind["weight"] <= 1
    assert {names[b["index"]] for b in presets["blinkLeft"]["morphTargetBinds"]} == {"eyeBlinkLeft"}
    assert vrm["lookAt"]["type"] == "bone" and vrm["lookAt"]["offsetFromHeadBone"][2] > 0.05
    assert vrm["meta"]["avatarPermission"] == "onlyAuthor" and vrm["meta"]["name"] == "Somebody"


def test_its_clips_play_as_they_were(project: Project, written: Path) -> None:
    [made] = read_gltf_clips(written, ("bind_pose",))
    [entry] = project.clips.values()
    assert entry.motion is not None and made.frames == entry.motion.dense.frames
    joints = [made.skeleton.index(n) for n in entry.motion.skeleton.names]
    apart = rotation.measure_angle_between(made.rotations[:, joints], entry.motion.dense.rotations)
    assert np.degrees(apart.max()) < 0.05
    assert len(read_character(written).morphs) == 52


def test_the_licence_is_what_stands_beside_the_project(project: Project, tmp_path: Path) -> None:
    said = {"authors": ["Ann"], "commercialUsage": "corporation", "allowRedistribution": True}
    (tmp_path / META).write_text(json.dumps(said))
    report = registry.write_for_target(
        project, "vrm", tmp_path / "out", Contents(SAMPLES / "ada.glb", base=tmp_path)
    )
    meta = gltf(report.files[0])["extensions"]["VRMC_vrm"]["meta"]
    assert meta.items() >= said.items() and meta["creditNotation"] == "required"
    assert not any(META in warning for warning in report.warnings)
    for wrong in ({"commercialUsage": "all"}, {"authors": []}, {"fee": 3}, {"name": 1}):
        (tmp_path / META).write_text(json.dumps(wrong))
        with pytest.raises(FileError, match=next(iter(wrong))):
            registry.write_for_target(
                project, "vrm", tmp_path / "no", Contents(SAMPLES / "ada.glb", base=tmp_path)
            )


def test_what_is_no_avatar_is_refused(project: Project, tmp_path: Path) -> None:
    with pytest.raises(ExportError, match="choose a mesh"):
        registry.write_for_target(project, "vrm", tmp_path)
    lame = replace(project, roles={"left_foot": ""})
    with pytest.raises(ExportError, match="left_foot"):
        registry.write_for_target(lame, "vrm", tmp_path, Contents(SAMPLES / "ada.glb"))


def add_springs(path: Path, folder: Path) -> Path:
    """Return a copy of a VRM file that has spring bones: a little finger's, and one of nodes that are no joints."""
    document = gltf(path)
    names = [node.get("name") for node in document["nodes"]]
    finger = [names.index(f"LeftLittle{n}") for n in (1, 2, 3)]
    mesh = next(n for n, node in enumerate(document["nodes"]) if "mesh" in node)
    sphere = {"shape": {"sphere": {"offset": [0.0, 0.1, 0.0], "radius": 0.1}}}
    document["extensionsUsed"].append("VRMC_springBone")
    document["extensions"]["VRMC_springBone"] = {
        "specVersion": "1.0",
        "colliders": [
            {"node": mesh, **sphere},
            {"node": names.index("Head"), "extensions": {"x": {}}, **sphere},
        ],
        "colliderGroups": [{"name": "none", "colliders": [0]}, {"name": "head", "colliders": [0, 1]}],
        "springs": [
            {"name": "gone", "joints": [{"node": mesh}, {"node": finger[0]}]},
            {
                "name": "finger",
                "joints": [
                    {"node": n, "hitRadius": 0.02, "stiffness": 1.5, "dragForce": 0.3} for n in finger
                ],
                "colliderGroups": [0, 1],
                "center": names.index("Hips"),
            },
        ],
    }
    return with_document(path, document, folder / "sprung.vrm")


def with_document(path: Path, document: dict[str, Any], to: Path) -> Path:
    """Return a copy of a GLB with other JSON."""
    data = path.read_bytes()
    size = int.from_bytes(data[12:16], "little")
    words = json.dumps(document).encode()
    words += b" " * (-len(words) % 4)
    rest = data[20 + size :]
    head = b"glTF" + struct.pack("<III", 2, 20 + len(words) + len(rest), len(words)) + b"JSON"
    to.write_bytes(head + words + rest)
    return to


def test_spring_bones_of_the_source_are_kept(project: Project, written: Path, tmp_path: Path) -> None:
    source = add_springs(written, tmp_path)
    report = registry.write_for_target(project, "vrm", tmp_path / "out", Contents(source, base=tmp_path))
    document = gltf(report.files[0])
    names = [node["name"] for node in document["nodes"]]
    springs = document["extensions"]["VRMC_springBone"]
    assert "VRMC_springBone" in document["extensionsUsed"]
    (finger,) = springs["springs"]
    assert [names[j["node"]] for j in finger["joints"]] == ["LeftLittle1", "LeftLittle2", "LeftLittle3"]
    assert finger["joints"][0]["stiffness"] == 1.5 and names[finger["center"]] == "Hips"
    (collider,), (group,) = springs["colliders"], springs["colliderGroups"]
    assert names[collider["node"]] == "Head" and "extensions" not in collider
    assert group == {"name": "head", "colliders": [0]} and finger["colliderGroups"] == [0]
    assert any("2 joints of the spring bones" in warning for warning in report.warnings)


READ = """
import { readFileSync } from "node:fs";
import { VRMLoaderPlugin } from "@pixiv/three-vrm";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";

globalThis.self ??= globalThis;
const loader = new GLTFLoader();
loader.register((parser) => new VRMLoaderPlugin(parser));
const bytes = readFileSync(process.argv[2]);
const { vrm } = (await loader.parseAsync(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length), "")).userData;
const joints = [...vrm.springBoneManager.joints];
const tip = joints[joints.length - 1].bone;
vrm.update(0);
const before = tip.quaternion.clone();
vrm.humanoid.autoUpdateHumanBones = false;
vrm.scene.getObjectByName("LeftUpperArm").rotation.x += 1;
for (let n = 0; n < 3; n++) vrm.update(1 / 60);
console.log(JSON.stringify({ joints: joints.map((j) => j.bone.name), moved: before.angleTo(tip.quaternion) > 0.01 }));
"""


@needs("@pixiv/three-vrm", "three")
def test_three_vrm_moves_the_spring_bones(project: Project, written: Path, tmp_path: Path) -> None:
    bald = gltf(written)
    for field in ("images", "textures", "samplers"):  # Node decodes no pictures
        bald.pop(field, None)
    bald["materials"] = [{"name": m.get("name", "")} for m in bald["materials"]]
    source = add_springs(with_document(written, bald, tmp_path / "bald.vrm"), tmp_path)
    report = registry.write_for_target(project, "vrm", tmp_path / "out", Contents(source, base=tmp_path))
    (tmp_path / "node_modules").symlink_to(PACKAGES)
    (tmp_path / "read.mjs").write_text(READ)
    said = run_node(
        "--preserve-symlinks", "--preserve-symlinks-main", "read.mjs", report.files[0], cwd=tmp_path
    )
    found = json.loads(said.splitlines()[-1])
    assert found == {"joints": ["LeftLittle1", "LeftLittle2"], "moved": True}
