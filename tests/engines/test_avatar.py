"""Another look in JavaScript: a humanoid of any maker, moved by an export's graph as Python retargets it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from metagraph.engines.reading import read_export
from metagraph.formats.gltf.reader import read_character
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.joint_map import find_known_roles, propose_joint_map
from metagraph.motion.retarget import retarget
from tests.engines.avatars import (
    FAMILIES,
    SAMPLES,
    make_avatar,
    name_in_family,
    read_rest,
    without_legs,
    without_skeleton,
)
from tests.engines.javascript_runtime import ROOT, STICK, needs_node, run

pytestmark = [
    needs_node,
    pytest.mark.skipif(
        not (ROOT / "tests" / "node_modules" / "three").is_dir(),
        reason="needs three.js (python3 run.py test fetches it where npm is)",
    ),
]
TIMES = [round(0.37 + 1.31 * n, 3) for n in range(20)]  # seconds
LIMBS = [
    (f"{side}_{upper}", f"{side}_{lower}")
    for side in ("left", "right")
    for upper, lower in (
        ("upper_arm", "lower_arm"), ("lower_arm", "hand"), ("hand", "middle_1"), ("index_1", "index_2"),
        ("upper_leg", "lower_leg"), ("lower_leg", "foot"), ("foot", "toes"),
    )
] + [("hips", "spine"), ("spine", "neck"), ("neck", "head")]  # fmt: skip
# Loads avatars (paths in `rest`) on one graph, and plays it.
PLAY = """
globalThis.self ??= globalThis;
globalThis.ProgressEvent ??= class extends Event {};
const from = (path) => import(pathToFileURL(join(process.cwd(), "node_modules", "three", path)));
const THREE = await from("build/three.module.js");
const { GLTFLoader } = await from("examples/jsm/loaders/GLTFLoader.js");
const { MetagraphObject } = await of("three.js");
const { Avatar } = await of("avatar.js");
const graph = load(text, glb);
async function loaded(path) {
  const bytes = readFileSync(path);
  return new GLTFLoader().parseAsync(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength), "");
}
const scene = new THREE.Group();
for (const name of graph.joints) scene.add(Object.assign(new THREE.Bone(), { name }));
const object = new MetagraphObject(graph, scene, { seed: 5 });
object.ask({ do: "say", text: "Hello over there, father of my cars", id: "s", at: 3 });
object.ask({ do: "look", to: [2, 1.2, 2], at: 9 });
function seen(avatar) {
  avatar.scene.updateMatrixWorld(true);
  return Object.fromEntries(avatar.nodes.map((node) => {
    const [at, turn] = [new THREE.Vector3().setFromMatrixPosition(node.matrixWorld), node.getWorldQuaternion(new THREE.Quaternion())];
    return [node.userData.name ?? node.name, [at.toArray(), turn.toArray()]];
  }));
}
"""
WATCH = """
const avatars = [];
for (const path of rest.slice(1)) avatars.push(new Avatar(graph, await loaded(path)));
const out = { missing: avatars.map((one) => one.missing), poses: [], seen: avatars.map(() => []), scale: avatars.map((one) => one.scene.scale.x) };
for (const time of JSON.parse(rest[0])) {
  object.update(time - object.time);
  const { rotations, translations } = object.character.pose();
  out.poses.push([[...rotations], [...translations]]);
  avatars.forEach((one, n) => { one.pose(object.character); out.seen[n].push(seen(one)); });
}
out.joints = graph.joints;
say(out);
"""
Seen = dict[str, tuple[list[float], list[float]]]


def played(export: Path, *avatars: Path) -> Any:
    return run(PLAY + WATCH, export, json.dumps(TIMES), *map(str, avatars))


def angle(a: Any, b: Any) -> float:
    """Degrees between two directions."""
    a, b = np.asarray(a), np.asarray(b)
    return float(np.degrees(np.arctan2(np.linalg.norm(np.cross(a, b)), a @ b)))


def pose_clip(export: Path, found: Any) -> Clip:
    skeleton = read_export(export / "sample.json", resolved=True).skeleton
    assert skeleton is not None and list(skeleton.names) == found["joints"]
    turns, moves = (np.array([pose[n] for pose in found["poses"]]) for n in (0, 1))
    count = len(skeleton)
    return Clip(
        "played",
        skeleton,
        30.0,
        turns.reshape(-1, count, 4),
        moves.reshape(-1, count, 3),
        tuple(range(count)),
    )


@pytest.fixture(scope="module")
def tall_ben(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Ben as Mixamo's program writes him: in a T, centimetres, taller, with longer shins."""
    folder = tmp_path_factory.mktemp("ben")
    return make_avatar(folder / "ben.glb", "mixamo", unit=100, tall=1.1, legs=1.2, bare=True)


@pytest.mark.nightly
def test_a_taller_ben_of_mixamo_moves_as_python_retargets_him(sample_export: Path, tall_ben: Path) -> None:
    found = played(sample_export, tall_ben)
    clip = pose_clip(sample_export, found)
    target = read_rest(tall_ben, 100)
    joint_map = propose_joint_map(clip.skeleton, target)
    done = retarget(clip, target, joint_map)
    turns, places = target.globals(done.poses())
    roles = find_known_roles(target, None)
    directions, hands, feet, rolls = [], [], [], []
    for n, seen in enumerate(found["seen"][0]):
        at = {role: np.array(seen[target.names[joint]][0]) for role, joint in roles.items()}
        for upper, lower in LIMBS:
            theirs = places[n, roles[lower]] - places[n, roles[upper]]
            directions.append(angle(at[lower] - at[upper], theirs))
        for side in ("left", "right"):
            for part, far in (("hand", hands), ("foot", feet)):
                role = f"{side}_{part}"
                far.append(np.linalg.norm(at[role] - places[n, roles[role]]))
                ours = np.array(seen[target.names[roles[role]]][1])
                rolls.append(np.degrees(rotation.measure_angle_between(ours, turns[n, roles[role]])))
    assert len(directions) == 20 * len(LIMBS) and max(directions) < 5
    assert max(feet) < 1e-3 and max(rolls) < 0.1
    assert max(hands) < 0.02  # hands that touch their own body touch it in Python alone
    moved = [np.array(s["mixamorig:LeftHand"][0]) for s in found["seen"][0]]
    assert np.ptp(moved, axis=0).max() > 0.1


@pytest.mark.parametrize("family", FAMILIES)
def test_the_joints_of_each_family_of_names_have_their_roles(family: str) -> None:
    skeleton = read_character(SAMPLES / "ben.glb").skeleton
    roles = find_known_roles(skeleton, None)
    wanted = {role: joint for role, joint in roles.items() if name_in_family(family, role)}
    called = {joint: name_in_family(family, role) for role, joint in wanted.items()}
    names = [called.get(n, f"extra {n}") for n in range(len(skeleton))]
    found = run(
        """
        const { findRoles } = await of("avatar/roles.js");
        say(Object.fromEntries(findRoles(JSON.parse(rest[0]), JSON.parse(rest[1]))));
        """,
        STICK,
        json.dumps(names),
        json.dumps([int(p) for p in skeleton.parents]),
    )
    assert found == wanted and len(wanted) == 54


def test_helpers_and_ends_of_other_rigs_take_no_role() -> None:
    names = ["root", "pelvis", "spine_01", "neck_01", "head", "HeadTop_End", "ik_hand_l", "upperarm_l",
             "upperarm_twist_01_l", "lowerarm_l", "hand_l", "index_metacarpal_l", "index_01_l", "constructor"]  # fmt: skip
    parents = [-1, 0, 1, 2, 3, 4, 0, 2, 7, 7, 9, 10, 11, 0]
    found = run(
        """
        const { findRoles } = await of("avatar/roles.js");
        say(Object.fromEntries(findRoles(JSON.parse(rest[0]), JSON.parse(rest[1]))));
        """,
        STICK,
        json.dumps(names),
        json.dumps(parents),
    )
    assert {role: names[joint] for role, joint in found.items()} == {
        "left_upper_arm": "upperarm_l", "left_lower_arm": "lowerarm_l", "left_hand": "hand_l",
        "left_index_1": "index_01_l", "head": "head", "hips": "pelvis", "spine": "spine_01", "neck": "neck_01",
    }  # fmt: skip


@pytest.mark.nightly
def test_vrm_of_either_version_and_direction_moves_alike(sample_export: Path, tmp_path: Path) -> None:
    """0.x faces -Z: half a turn of the file changes nothing of what is seen. So does a foot that hangs on
    nothing, as in rigs with IK, and centimetres under a node that shrinks them.
    """
    one = make_avatar(tmp_path / "one.vrm", vrm=1, bare=True)
    old = make_avatar(tmp_path / "old.vrm", vrm=0, turned=True, bare=True)
    loose = make_avatar(tmp_path / "loose.vrm", vrm=1, loose=("left_foot", "right_hand"), bare=True)
    shrunk = make_avatar(tmp_path / "shrunk.vrm", vrm=1, unit=100, shrunk=True, turned=True, bare=True)
    found = played(sample_export, one, old, loose, shrunk)
    named = json.loads((sample_export / "sample.json").read_bytes())["joints"]
    assert all(missing == found["missing"][0] for missing in found["missing"])
    assert {"LeftBrow", "LeftUpperLid"} <= set(found["missing"][0]) < {j["name"] for j in named}
    assert not {"LeftHand", "LeftThumb3", "RightEye"} & set(found["missing"][0])
    for first, *others in zip(*found["seen"], strict=True):
        for name, (at, turn) in first.items():
            for other_at, other_turn in (other[name] for other in others):
                assert np.abs(np.subtract(at, other_at)).max() < 1e-4, name
                assert abs(np.dot(turn, other_turn)) > 0.99999, name


def test_feet_stand_on_the_floor_and_slide_no_more_than_the_scale_implies(
    sample_export: Path, tall_ben: Path
) -> None:
    found = played(sample_export, tall_ben)
    clip = pose_clip(sample_export, found)
    roles = find_known_roles(clip.skeleton, None)
    _, places = clip.skeleton.globals(clip.poses())
    for side, name in (("left", "mixamorig:LeftFoot"), ("right", "mixamorig:RightFoot")):
        theirs = places[:, roles[f"{side}_foot"]]
        ours = np.array([seen[name][0] for seen in found["seen"][0]])
        assert np.abs(ours[:, 1] - 0.088).max() < 0.01 + 1.4 * np.ptp(theirs[:, 1])
        slid = np.linalg.norm(ours - ours[0], axis=-1)
        assert (slid < 1.4 * np.linalg.norm(theirs - theirs[0], axis=-1) + 0.005).all()
    assert found["scale"] == [0.01]


def test_a_look_is_changed_while_it_plays_without_a_jump_of_the_motion(
    sample_export: Path, tall_ben: Path, tmp_path: Path
) -> None:
    small = make_avatar(tmp_path / "small.glb", "unreal", tall=0.8, bare=True)
    out = run(
        PLAY
        + """
        const [ben, other] = [new Avatar(graph, await loaded(rest[0])), new Avatar(graph, await loaded(rest[1]))];
        const alone = new MetagraphObject(graph, scene.clone(), { seed: 5, avatar: ben });
        const plain = new MetagraphObject(graph, scene.clone(), { seed: 5 });
        const shown = [];
        for (let n = 0; n < 90; n++) {
          if (n === 40) alone.avatar = other;
          if (n === 60) alone.avatar = null;
          alone.update(1 / 30);
          plain.update(1 / 30);
          shown.push([alone.scene.visible, ben.scene.visible, other.scene.visible]);
        }
        const same = [alone, plain].map(({ character }) => [...character.pose().rotations]);
        const bones = [alone, plain].map(({ scene }) => scene.children.map((bone) => bone.quaternion.toArray()));
        say({ shown, same, bones, missing: [alone.missing, ben.missing.length] });
        """,
        sample_export,
        str(tall_ben),
        str(small),
    )
    shown = out["shown"]
    assert all(row[:2] == [False, True] for row in shown[:40])
    assert all(row == [False, False, True] for row in shown[40:60])
    assert all(row == [True, False, False] for row in shown[60:])
    assert out["same"][0] == out["same"][1] and out["bones"][0] == out["bones"][1]
    assert out["missing"][0] == [] and out["missing"][1] > 0


def test_faces_of_vrm_speak_and_blink_by_expressions(sample_export: Path, tmp_path: Path) -> None:
    avatars = [make_avatar(tmp_path / f"{n}.vrm", vrm=n, bare=True) for n in (0, 1)]
    arkit = make_avatar(tmp_path / "arkit.glb", bare=True)
    found = run(
        PLAY
        + """
        const avatars = [];
        for (const path of rest) avatars.push(new Avatar(graph, await loaded(path)));
        const most = avatars.map(() => ({}));
        const faceOf = (avatar) => avatar.scene.getObjectByProperty("isSkinnedMesh", true);
        const names = Object.keys(faceOf(avatars[2]).morphTargetDictionary); // the others' are told by no name
        for (let n = 0; n < 300; n++) {
          object.update(1 / 30);
          avatars.forEach((one, a) => {
            one.pose(object.character);
            faceOf(one).morphTargetInfluences.forEach((w, k) => (most[a][names[k]] = Math.max(most[a][names[k]] ?? 0, w)));
          });
        }
        say(most);
        """,
        sample_export,
        *map(str, (*avatars, arkit)),
    )
    for old_or_new in found[:2]:
        shown = {name for name, weight in old_or_new.items() if weight > 0.3}
        assert shown == {"jawOpen", "eyeBlinkLeft", "mouthFunnel"}, old_or_new
    assert found[2]["eyeBlinkRight"] > 0.8 and found[2]["jawOpen"] > 0.1 and found[2]["mouthFunnel"] > 0.1


def test_what_cannot_be_used_says_why(sample_export: Path, tmp_path: Path) -> None:
    told = run(
        PLAY
        + """
        const told = [];
        for (const path of rest) {
          try { new Avatar(graph, await loaded(path)); told.push("fine"); } catch (error) { told.push(error.message); }
        }
        say(told);
        """,
        sample_export,
        str(without_skeleton(tmp_path / "statue.glb")),
        str(without_legs(tmp_path / "legless.glb")),
    )
    assert told[0] == "The avatar cannot be used: it has no skeleton"
    assert (
        "no humanoid: no joint was found for left upper leg, left lower leg, left foot and 3 more" in told[1]
    )
