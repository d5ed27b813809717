"""VRM animations: a file for each action, read back by this product's own reader and by the format's words."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from metagraph.engines.export_error import ExportError
from metagraph.engines.targets import registry
from metagraph.engines.targets.target import Contents
from metagraph.engines.targets.vrma import cut_action
from metagraph.formats.gltf.reader import read_gltf_clips
from metagraph.graph import anatomy, edits
from metagraph.graph.model import Project
from metagraph.motion import rotation
from tests.engines.test_export import gltf, khronos
from tests.engines.test_npm_package import PACKAGES, needs
from tests.engines.test_npm_package import node as run_node
from tests.engines.test_target_vrm import with_document

SAMPLES = Path(__file__).parents[2] / "sample_clips"


@pytest.fixture(scope="module")
def project() -> Project:
    made = Project(name="Somebody")
    for name in ("stance", "wave_hello_rt_01"):
        [clip] = read_gltf_clips(SAMPLES / "clips" / f"hands_at_sides__{name}.glb")
        made = edits.add_clips(made, [(f"{name}.glb", 0, "", clip)])
    still, wave = made.clips
    made = edits.add_stance(made, "arms", "rest", [still])
    stance = next(iter(made.graphs["arms"].stances))
    made = edits.place_clips(made, [wave], "arms", "gesture", stance)
    (gesture,) = (a.id for a in made.actions() if a.kind == "gesture")
    return edits.update_actions(made, [gesture], timing={"start": 0.2, "end": 1.4})


@pytest.fixture(scope="module")
def written(project: Project, tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    report = registry.write_for_target(project, "vrma", tmp_path_factory.mktemp("vrma"))
    assert any("no blends" in loss for loss in report.losses)
    return sorted(path for path in report.files if path.suffix == ".vrma")


@pytest.mark.nightly
def test_each_action_has_a_file_that_the_validator_accepts(project, written):
    assert len(written) == len(list(project.actions())) == 2
    for path in written:
        assert path.suffix == ".vrma"
        khronos(path)


def test_a_list_says_what_each_file_is(project, written):
    listed = json.loads((written[0].parent / "Somebody.animations.json").read_text(encoding="utf-8"))
    assert {entry["file"] for entry in listed} == {path.name for path in written}
    gesture = next(entry for entry in listed if entry["kind"] == "gesture")
    assert (gesture["layer"], gesture["stance"], gesture["seconds"]) == (
        "arms",
        "rest",
        pytest.approx(1.2, abs=0.05),
    )


def test_actions_of_one_name_are_told_apart_by_their_stances(toy, tmp_path):
    made = toy.project()
    names = [a.id for a in made.actions() if a.kind == "gesture"][:2] + [toy.id(made, "up beat")]
    made = edits.update_actions(made, names, name="beat")
    files = {path.name for path in registry.write_for_target(made, "vrma", tmp_path).files}
    assert {"beat (rest).vrma", "beat (rest)-2.vrma", "beat (up).vrma"} <= files


def test_the_nodes_are_the_humanoids_bones_without_eyes_in_a_t(written):
    data = gltf(written[0])
    stated = data["extensions"]["VRMC_vrm_animation"]
    bones = {bone: entry["node"] for bone, entry in stated["humanoid"]["humanBones"].items()}
    assert stated["specVersion"] == "1.0" and data["extensionsUsed"] == ["VRMC_vrm_animation"]
    assert {"hips", "spine", "head", "leftUpperArm", "rightFoot"} <= bones.keys()
    assert not {"leftEye", "rightEye"} & bones.keys(), "the eyes are moved by lookAt alone"
    at, turned = {}, {}
    above = {c: n for n, node in enumerate(data["nodes"]) for c in node.get("children", ())}
    for n, node in enumerate(data["nodes"]):
        p, q = np.array(node.get("translation", [0, 0, 0])), np.array(node.get("rotation", [0, 0, 0, 1.0]))
        if n in above:
            p = at[above[n]] + rotation.rotate_vectors(turned[above[n]], p)
            q = rotation.multiply(turned[above[n]], q)
        at[n], turned[n] = p, q
    arm = at[bones["leftHand"]] - at[bones["leftUpperArm"]]
    assert arm[0] > 0.99 * np.linalg.norm(arm)


def test_read_back_a_gesture_is_the_part_that_its_action_plays(project, written):
    gesture = next(a for a in project.actions() if a.kind == "gesture")
    path = next(p for p in written if "wave" in p.name)
    [clip] = read_gltf_clips(path)
    want = cut_action(project, gesture)
    assert want is not None and clip.duration == pytest.approx(1.2, abs=0.02)
    _, was = want.skeleton.globals(want.poses())
    _, now = clip.skeleton.globals(clip.poses())
    for role in ("right_hand", "head", "left_foot"):
        joint = anatomy.project_roles(project)[role]
        back = clip.skeleton.names.index(want.skeleton.names[joint])
        np.testing.assert_allclose(now[:, back], was[:, joint], atol=2e-3)


def test_a_face_becomes_expressions_that_the_reader_finds_again(project, tmp_path):
    entry = next(e for e in project.clips.values() if "wave" in e.name)
    frames = entry.motion.frames
    blink = np.zeros((frames, 2), np.float32)
    blink[10:20] = 1.0
    faced = replace(entry.motion, morphs=("eyeBlinkLeft", "eyeBlinkRight"), weights=blink)
    with_face = edits.with_motions(project, {entry.id: faced})
    report = registry.write_for_target(with_face, "vrma", tmp_path)
    path = next(p for p in report.files if "wave" in p.name)
    khronos(path)
    presets = gltf(path)["extensions"]["VRMC_vrm_animation"]["expressions"]["preset"]
    assert presets.keys() == {"blink"}, "both eyes together are one preset"
    [clip] = read_gltf_clips(path)
    assert any("blink" in name.lower() for name in clip.morphs)
    assert clip.weights is not None and clip.weights.max() == pytest.approx(1.0, abs=0.01)


def test_eyes_that_move_become_where_it_looks(project, tmp_path):
    entry = next(e for e in project.clips.values() if "wave" in e.name)
    roles = anatomy.project_roles(project)
    rotations = np.array(entry.motion.rotations)
    aside = rotation.from_axis_angle(np.array([0.0, 1.0, 0.0]), 0.3)
    for eye in ("left_eye", "right_eye"):
        rotations[:, roles[eye]] = rotation.multiply(rotations[:, roles[eye]], aside)
    looking = edits.with_motions(project, {entry.id: replace(entry.motion, rotations=rotations)})
    report = registry.write_for_target(looking, "vrma", tmp_path)
    data = gltf(next(p for p in report.files if "wave" in p.name))
    node = data["extensions"]["VRMC_vrm_animation"]["lookAt"]["node"]
    assert data["nodes"][node]["name"] == "lookAt"
    assert any(c["target"] == {"node": node, "path": "rotation"} for c in data["animations"][0]["channels"])


def test_what_is_no_humanoid_is_refused(project, tmp_path):
    lame = replace(project, roles={"left_hand": ""})
    with pytest.raises(ExportError, match="needs a humanoid"):
        registry.write_for_target(lame, "vrma", tmp_path)


READ = """
import { readFileSync } from "node:fs";
import { VRMLoaderPlugin } from "@pixiv/three-vrm";
import { createVRMAnimationClip, VRMAnimationLoaderPlugin } from "@pixiv/three-vrm-animation";
import { AnimationMixer, Vector3 } from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";

globalThis.self ??= globalThis;
const loader = new GLTFLoader();
loader.register((parser) => new VRMLoaderPlugin(parser));
loader.register((parser) => new VRMAnimationLoaderPlugin(parser));
const read = async (path) => {
  const bytes = readFileSync(path);
  return (await loader.parseAsync(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length), "")).userData;
};
const [avatar, animation] = process.argv.slice(2);
const { vrm } = await read(avatar);
const { vrmAnimations } = await read(animation);
const clip = createVRMAnimationClip(vrmAnimations[0], vrm);
const mixer = new AnimationMixer(vrm.scene);
mixer.clipAction(clip).play();
const hand = vrm.humanoid.getRawBoneNode("rightHand");
const places = [0.1, 0.5].map((seconds) => {
  mixer.setTime(seconds);
  vrm.update(0);
  vrm.scene.updateMatrixWorld(true);
  return hand.getWorldPosition(new Vector3()).toArray();
});
console.log(JSON.stringify({ duration: clip.duration, tracks: clip.tracks.length, places }));
"""


@needs("@pixiv/three-vrm", "@pixiv/three-vrm-animation", "three")
def test_three_vrm_plays_a_file_on_an_avatar_as_the_clip_moves(
    project: Project, written: list[Path], tmp_path: Path
) -> None:
    """On the project's own avatar, whose hands should be where the clip has them."""
    report = registry.write_for_target(project, "vrm", tmp_path / "out", Contents(SAMPLES / "ada.glb"))
    (avatar,) = (path for path in report.files if path.suffix == ".vrm")
    bald = gltf(avatar)
    for field in ("images", "textures", "samplers"):  # Node decodes no pictures
        bald.pop(field, None)
    bald["materials"] = [{"name": m.get("name", "")} for m in bald["materials"]]
    avatar = with_document(avatar, bald, tmp_path / "bald.vrm")
    (tmp_path / "node_modules").symlink_to(PACKAGES)
    (tmp_path / "read.mjs").write_text(READ)
    gesture = next(a for a in project.actions() if a.kind == "gesture")
    file = next(path for path in written if path.stem == gesture.name)
    words = ("--preserve-symlinks", "--preserve-symlinks-main", "read.mjs", avatar, file)
    found = json.loads(run_node(*words, cwd=tmp_path).splitlines()[-1])
    clip = cut_action(project, gesture)
    assert clip is not None and found["duration"] == pytest.approx(clip.duration, abs=0.02)
    place = clip.skeleton.index("RightHand")
    for seconds, shown in zip((0.1, 0.5), found["places"], strict=True):
        wanted = clip.skeleton.globals(clip.pose_at(seconds))[1][place]
        assert np.linalg.norm(wanted - np.array(shown)) < 0.02, (seconds, wanted, shown)
