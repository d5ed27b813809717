"""The VRM target: a figure in a T whose bones, expressions and licence stand where VRM 1.0 wants them."""

from __future__ import annotations

import json
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
