"""Characters of the JavaScript runtime: they answer, never fail in play, and move in three.js."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any

import pytest

from metagraph.engines.targets import registry
from tests.engines.javascript_runtime import ROOT, RUNTIME, STICK, VARIED, changed, needs_node, run

pytestmark = needs_node


def test_a_character_answers_and_tells_what_happens() -> None:
    found = run(
        """
        const character = new Character(load(text, glb), { seed: 5, idle: false });
        const first = character.ask({ do: "gesture", after: 1 });
        const before = character.answer(first);
        const events = [];
        for (let t = 0; t < 60; t += 1 / 30) { character.update(t); events.push(...character.events()); }
        say({ first, before, after: character.answer(first), unknown: character.answer("nobody"), events });
        """
    )
    assert found["first"] == "#1"
    assert found["before"]["state"] == "planned"
    assert found["after"]["state"] == "done"
    assert found["after"]["at"] == pytest.approx(1, abs=0.2)
    assert found["unknown"]["state"] == "refused"
    assert [(e["kind"], e["meta"]) for e in found["events"]] == [("begin", "#1"), ("end", "#1")]
    assert found["events"][0]["action"] in found["after"]["what"]


MALFORMED = [
    None,
    3,
    "nod",
    [],
    {},
    {"do": "dance"},
    {"do": 3},
    {"do": "gesture", "layer": "legs"},
    {"do": "gesture", "tags": "positive"},
    {"do": "gesture", "at": -1},
    {"do": "gesture", "at": "soon"},
    {"do": "gesture", "at": 1e300},
    {"do": "gesture", "priority": 1.5},
    {"do": "gesture", "extra": 1},
    {"do": "action"},
    {"do": "action", "action": ""},
    {"do": "action", "action": "nothing of the name"},
    {"do": "stance", "stance": "nowhere at all"},
    {"do": "look", "to": [1, 2]},
    {"do": "look", "to": [1, 2, None]},
    {"do": "look", "amount": 7},
    {"do": "say"},
    {"do": "say", "line": "no such line"},
    {"do": "place", "name": "x"},
    {"do": "mode", "mode": "sleeping"},
    {"do": "gesture", "after": -3},
    {"do": "gesture", "after": "1"},
    {"do": "bml", "bml": "<bml/>"},
    {"do": "gesture", "id": "x" * 300},
    {"do": "gesture", "duration": None, "limb": "tail"},
    {"do": "__proto__"},
    {"do": "constructor"},
    {"do": "gesture", "hold": 1e9},
]


def test_what_cannot_be_understood_is_refused_with_words_and_never_thrown() -> None:
    found = run(
        """
        const character = new Character(load(text, glb), { idle: false });
        const ids = JSON.parse(rest[0]).map((request) => character.ask(request));
        ids.push(character.ask(undefined), character.ask({ do: "gesture", at: NaN }), character.ask(() => 1));
        for (const t of [0, 1, NaN, -5, Infinity, "later", undefined, 3]) { character.update(t); character.pose(); character.morphs(); }
        say(ids.map((id) => character.answer(id)));
        """,
        STICK,
        json.dumps(MALFORMED),
    )
    for request, reply in zip([*MALFORMED, "undefined", "NaN", "function"], found, strict=True):
        assert reply["state"] == "refused", (request, reply)
        assert reply["why"], request


def test_a_fault_of_its_own_does_not_stop_the_game() -> None:
    found = run(
        """
        const graph = load(text, glb);
        const character = new Character(graph, { seed: 3 });
        const { settings } = graph;
        graph.settings = null;
        const id = character.ask({ do: "nod" });
        character.update(1);
        const failed = character.answer(id);
        graph.settings = settings;
        const again = character.ask({ do: "nod" });
        character.update(2);
        say({ failed, again: character.answer(again), finite: character.pose().rotations.every(Number.isFinite) });
        """
    )
    assert found["failed"]["state"] == "refused"
    assert "failed" in found["failed"]["why"]
    assert found["again"]["state"] in ("planned", "late")
    assert found["finite"]


def test_bml_is_not_understood_by_a_runtime() -> None:
    script = (
        "const plan = hear(load(text, glb), emptyPlan(1), 0, [{ do: 'bml', bml: '<bml/>', id: 'b' }], "
        "5); say(plan.reports.at(-1))"
    )
    assert run(script)["outcome"] == "not-understood"


@pytest.mark.nightly
def test_random_requests_never_break_a_character() -> None:
    found = run(
        """
        let state = 12345;
        const draw = (n) => (state = (Math.imul(state, 1103515245) + 12345) >>> 0) % n;
        const values = [0, 1, -1, 2.5, 1e9, "", "hello", "arms", "head", "user", null, true, false, [], [1, 2, 3], ["positive"], {}, "#3"];
        const words = ["gesture", "fidget", "action", "stance", "change", "nod", "shake", "look", "blink", "say", "mode", "place"];
        const fields = ["id", "at", "after", "priority", "layer", "tags", "limb", "duration", "stroke", "hold", "prepare", "resume",
          "action", "stance", "stay", "to", "amount", "strict", "line", "text", "gestures", "mode", "name", "point", "what"];
        const graph = load(text, glb);
        const character = new Character(graph, { seed: 1 });
        let finite = true;
        for (let n = 0; n < 3000; n++) {
          const request = { do: words[draw(words.length)] };
          for (let k = draw(4); k > 0; k--) request[fields[draw(fields.length)]] = values[draw(values.length)];
          const id = character.ask(request);
          character.update(n / 20);
          finite &&= character.pose().rotations.every(Number.isFinite) && typeof character.answer(id).why === "string";
        }
        const failed = [...character.settled.values()].filter((answer) => answer.why.includes("failed"));
        say({ finite, failed, cues: character.plan.layers.arms.cues.length, kept: character.settled.size });
        """
    )
    assert found["finite"]
    assert found["failed"] == []
    assert found["cues"] < 100
    assert found["kept"] <= 1000


def test_time_never_goes_backwards_and_nothing_is_planned_without_need() -> None:
    found = run(
        """
        const character = new Character(load(text, glb), { seed: 3 });
        character.update(5);
        const { plan } = character;
        character.update(2);
        const back = character.now;
        for (let t = 5; t < 6.9; t += 0.1) character.update(t);
        const same = character.plan === plan;
        for (let t = 7; t < 200; t += 0.25) character.update(t);
        say({ back, same, first: character.plan.layers.arms.cues[0].end, end: character.plan.end });
        """
    )
    assert found["back"] == 5
    assert found["same"]
    assert found["first"] > 150, "what is over was not forgotten"
    assert found["end"] >= 217


def test_a_character_that_lives_tick_by_tick_plays_what_one_plan_would() -> None:
    found = run(
        """
        const graph = load(text, glb);
        const character = new Character(graph, { seed: 9 });
        const whole = hear(graph, emptyPlan(9), 0, [], 300);
        let worst = 0;
        for (let t = 0; t < 100; t += 0.37) {
          character.update(t);
          const a = character.pose().rotations;
          const b = poseAt(graph, whole, t).rotations;
          for (let k = 0; k < a.length; k++) worst = Math.max(worst, Math.abs(a[k] - b[k]));
        }
        say(worst);
        """
    )
    assert found < 1e-6


def test_motions_are_made_when_they_first_play_or_are_asked_for_and_are_the_same() -> None:
    first, one, none, off = run(
        """
        const [lazy, whole] = [load(text, glb), load(text, glb)];
        const first = lazy.unmade.length, one = lazy.prepare(0), none = whole.prepare();
        const plan = hear(lazy, emptyPlan(7), 0, [], 60), same = hear(whole, emptyPlan(7), 0, [], 60);
        let off = 0;
        for (let t = 0; t < 60; t += 0.37) {
          const [a, b] = [poseAt(lazy, plan, t).rotations, poseAt(whole, same, t).rotations];
          a.forEach((x, n) => (off = Math.max(off, Math.abs(x - b[n]))));
        }
        say([first, one, none, off]);
        """
    )
    assert first > 10, "what does not play yet is not made"
    assert (one, none, off) == (first - 1, 0, 0)


@pytest.mark.nightly
def test_posing_makes_no_garbage_to_speak_of() -> None:
    bytes_a_pose = run(
        """
        const graph = load(text, glb);
        const player = new Player(graph, hear(graph, emptyPlan(1), 0, [{ do: "say", text: "So what do you say?", at: 3, id: "s" }], 60));
        const [r, t, m] = [4, 3, 0].map((n) => new Float32Array(n ? n * graph.joints.length : graph.morphs.length));
        const poses = () => { for (let n = 0; n < 20000; n++) { player.pose(n * 0.003, r, t); player.morphs(n * 0.003, m); } };
        poses();
        gc();
        const before = process.memoryUsage().heapUsed;
        poses();
        say((process.memoryUsage().heapUsed - before) / 20000);
        """,
        VARIED,
    )
    assert bytes_a_pose < 500  # a few boxed numbers; one array of joints would be thousands


@pytest.fixture(scope="module")
def stranger(tmp_path_factory: pytest.TempPathFactory, sample: Any) -> Path:
    """A fresh folder with a fresh export, as the README says."""
    return (
        registry.write_for_target(sample, "javascript", tmp_path_factory.mktemp("stranger")).files[0].parent
    )


def shown(number: int) -> str:
    """An example of the README."""
    return (RUNTIME / "README.md").read_text().split("```js\n")[1 + number].split("```")[0]


@pytest.mark.nightly
def test_the_readme_plays_as_a_stranger_would_run_it(stranger: Path) -> None:
    assert {"sample.json", "sample.glb", "metagraph"} <= {path.name for path in stranger.iterdir()}
    (stranger / "play.mjs").write_text(shown(0) + shown(2))
    done = subprocess.run(
        ["node", "play.mjs"], cwd=stranger, capture_output=True, text=True, timeout=60, check=False
    )
    assert done.returncode == 0, done.stderr
    assert "begin" in done.stdout
    assert any(f"state: '{state}'" in done.stdout for state in ("done", "planned", "late"))
    assert 7.9 < float(done.stdout.splitlines()[-1]) < 8.2, "the line lasts as long as what was added to it"


PAGE = """
import { readFileSync } from "node:fs";
globalThis.self ??= globalThis;
globalThis.ProgressEvent ??= class extends Event {};
const THREE = await import("three");
const frames = [];
Object.assign(globalThis, {
  fetch: async (path) => new Response(readFileSync(path)), // what a server would do
  scene: new THREE.Scene(), camera: new THREE.PerspectiveCamera(),
  renderer: { setAnimationLoop: (loop) => { globalThis.loop = loop; }, render: (scene) => {
    frames.push(scene.getObjectByName("Jaw").quaternion.toArray());
  } },
});
await import("./main.js");
const begun = performance.now();
for (let n = 0; n < 120; n++) loop(begun + n * 16);
console.log(JSON.stringify(frames.map((frame) => frame.every(Number.isFinite))), new Set(frames.map(String)).size);
"""


@pytest.mark.nightly
def test_the_readme_plays_in_three_js_as_a_stranger_would_run_it(stranger: Path) -> None:
    modules = ROOT / "tests" / "node_modules"
    if not (modules / "three").is_dir():
        pytest.skip("needs three.js: npm install --prefix tests three@0.187.0")
    (stranger / "main.js").write_text(shown(1))
    (stranger / "package.json").write_text('{"type": "module"}')
    (stranger / "page.mjs").write_text(PAGE)
    if not (stranger / "node_modules").exists():
        (stranger / "node_modules").symlink_to(modules)
    done = subprocess.run(
        ["node", "page.mjs"], cwd=stranger, capture_output=True, text=True, timeout=60, check=False
    )
    assert done.returncode == 0, done.stderr
    assert "deprecated" not in done.stdout + done.stderr
    fine, moved = done.stdout.rsplit(maxsplit=1)
    assert json.loads(fine) == [True] * 120 and int(moved) > 20, "the mouth moves with what is said"


# --- three.js


def renamed(document: Any) -> None:
    for node in document["nodes"]:
        if node["name"] == "Head":
            node["name"] = "He ad:1.x"


@pytest.mark.nightly
def test_it_plays_in_three_js(tmp_path: Path) -> None:
    if not (ROOT / "tests" / "node_modules" / "three").is_dir():
        pytest.skip(
            "needs three.js: npm install --prefix tests --no-save --no-package-lock three@0.187.0 "
            "gltf-validator@2.0.0-dev.3.10"
        )
    copy = changed(VARIED, tmp_path, renamed)
    path = copy / "varied.json"
    path.write_text(path.read_text().replace('"Head"', '"He ad:1.x"'))
    found = run(
        """
        globalThis.self ??= globalThis;
        globalThis.ProgressEvent ??= class extends Event {};
        const from = (path) => import(pathToFileURL(join(process.cwd(), "node_modules", "three", path)));
        const THREE = await from("build/three.module.js");
        const { GLTFLoader } = await from("examples/jsm/loaders/GLTFLoader.js");
        const { MetagraphObject } = await of("three.js");
        const { positions } = await of("rotation.js");
        const graph = load(text, glb);
        const gltf = await new GLTFLoader().parseAsync(glb.buffer.slice(glb.byteOffset, glb.byteOffset + glb.byteLength), "");
        const object = new MetagraphObject(graph, gltf.scene, { seed: 4 });
        object.ask({ do: "say", text: "Hello over there, my friend", id: "s", at: 0.5 });
        let worst = 0;
        let heaviest = 0;
        const faces = [];
        gltf.scene.traverse((mesh) => mesh.morphTargetDictionary && faces.push(mesh));
        for (let n = 0; n < 90; n++) {
          object.update(1 / 30);
          gltf.scene.updateMatrixWorld(true);
          const { rotations, translations } = poseAt(graph, object.character.plan, object.time);
          const places = positions(graph.parents, rotations, translations);
          graph.joints.forEach((joint, j) => {
            const bone = gltf.scene.getObjectByName(THREE.PropertyBinding.sanitizeNodeName(joint));
            const at = new THREE.Vector3().setFromMatrixPosition(bone.matrixWorld);
            worst = Math.max(worst, at.distanceTo(new THREE.Vector3(...places.subarray(3 * j, 3 * j + 3))));
          });
          for (const [name, value] of Object.entries(morphsAt(graph, object.character.plan, object.time))) {
            for (const mesh of faces) {
              if (!(name in mesh.morphTargetDictionary)) continue;
              const shown = mesh.morphTargetInfluences[mesh.morphTargetDictionary[name]];
              worst = Math.max(worst, Math.abs(shown - value));
              heaviest = Math.max(heaviest, shown);
            }
          }
        }
        say({ worst, heaviest, faces: faces.length, missing: object.missing });
        """,
        copy,
    )
    assert found["worst"] < 1e-5
    assert not [name for name in found["missing"] if "He" in name]
    if found["faces"]:
        assert found["heaviest"] > 0.2
