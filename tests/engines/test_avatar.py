"""Another look in JavaScript: a humanoid of any maker, moved by an export's graph as Python retargets it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from metagraph.engines.reading import read_export
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.joint_map import find_known_roles, propose_joint_map
from metagraph.motion.retarget import retarget
from tests.engines.avatars import FAMILIES, make_avatar, name_in_family, read_rest, without_legs, without_skeleton
from tests.engines.javascript_runtime import ROOT, needs_node, run

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
object.ask({ do: "say", text: "Hello over there, my friend", id: "s", at: 3 });
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
        "played", skeleton, 30.0, turns.reshape(-1, count, 4), moves.reshape(-1, count, 3), tuple(range(count))
    )


@pytest.fixture(scope="module")
def tall_ben(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Ben as Mixamo's program writes him: in a T, centimetres, taller, with longer shins."""
    folder = tmp_path_factory.mktemp("ben")
    return make_avatar(folder / "ben.glb", "mixamo", unit=100, tall=1.1, legs=1.2, bare=True)


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
    print(max(directions), max(hands), max(feet), max(rolls), [(r, at[r].round(3), places[n, roles[r]].round(3)) for r in ("hips", "left_foot", "left_hand")], target.rest_translations[0], target.names[0], found["scale"])
    assert len(directions) == 20 * len(LIMBS) and max(directions) < 5
    assert max(hands) < 0.02 and max(feet) < 0.01 and max(rolls) < 5
    moved = [np.array(s["mixamorig:LeftHand"][0]) for s in found["seen"][0]]
    assert np.ptp(moved, axis=0).max() > 0.1
