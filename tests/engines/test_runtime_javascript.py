"""The JavaScript runtime: it conforms, and refuses what is wrong as it says."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from metagraph.playback.life.voice import guess_voice
from tests.engines.javascript_runtime import RUNTIME, STICK, VARIED, changed, conformance, needs_node, run
from tests.engines.mutants import PLAYED, share_of
from tests.thorough import many

pytestmark = needs_node


# --- conformance


@pytest.mark.parametrize("folder", PLAYED, ids=lambda folder: folder.name)
def test_it_does_what_the_shipped_vectors_say(folder: Path, tmp_path: Path) -> None:
    done = conformance(share_of(folder, "javascript", tmp_path))
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.nightly
def test_it_does_what_the_sample_project_does(sample_export: Path) -> None:
    done = conformance(sample_export)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.nightly
def test_it_does_what_few_exports_need(rare: Path) -> None:
    done = conformance(rare)
    assert done.returncode == 0, done.stdout + done.stderr


TEXTS = [
    "Hello! How are you?",
    "Through the queue, one rhythm at a time...",
    "Straße, ﬁne, İstanbul ıl",
    "ΑΒΓ ρέμα θάλασσας",
    "Это ещё не всё, эхо",
    "日本語 2024 ② ²³",
    "naïve café — déjà-vu…",
    "हिन्दी ตัวอย่าง 각각",
    "a",
    "",
    "  . ",
    "x̂́y̶ 'tis’",
]


def test_letters_become_the_same_mouth_shapes() -> None:
    found = run(
        """
        const { voiceFromText } = await of("voice.js");
        const asked = JSON.parse(rest[0]).flatMap((words) => [null, 1.3].map((duration) => voiceFromText(words, duration)));
        say(asked.map(({ duration, accents, weights }) => ({ duration, accents, weights: [...weights] })));
        """,
        STICK,
        json.dumps(TEXTS),
    )
    wanted = [guess_voice(text, duration) for text in TEXTS for duration in (None, 1.3)]
    for voice, got in zip(wanted, found, strict=True):
        assert got["duration"] == pytest.approx(voice.duration)
        assert got["accents"] == pytest.approx(voice.accents.tolist())
        assert got["weights"] == pytest.approx(voice.weights.reshape(-1).tolist(), abs=1e-5)


def test_seconds_that_key_draws_are_written_as_python_writes_them() -> None:
    times = [n / 16 for n in range(1, 200)] + [n * 0.37 for n in range(200)] + [1e5 + 0.0625, 2.0005, 1.0015]
    found = run(
        'const { thousandths } = await of("basics.js"); say(JSON.parse(rest[0]).map(thousandths))',
        STICK,
        json.dumps(times),
    )
    assert found == [f"{x:.3f}" for x in times]


# --- what is wrong with files


def refused(folder: Path, change: str) -> str:
    return str(
        run(
            f"let json = text; let bytes = glb; {change}; try {{ load(json, bytes, 'x.json'); say(''); }} "
            f"catch (e) {{ say(e.message); }}",
            folder,
        )
    )


@pytest.mark.nightly
@pytest.mark.parametrize(
    ("change", "words"),
    [
        ("json = json.replace(/\"metagraph\":\\s*1/, '\"metagraph\": "
         "2')", ("x.json at metagraph", "Update the runtime")),
        ("json = json.slice(0, 100)", ("x.json", "is not JSON", "Export it again")),
        ("json = '[]'", ("x.json at metagraph", "is missing")),
        ("json = 'null'", ("x.json at metagraph", "is missing")),
        ("const d = JSON.parse(json); delete d.layers.arms; json = "
         "JSON.stringify(d)", ("x.json at layers.arms", "is missing")),
        ("const d = JSON.parse(json); delete d.planner; json = "
         "JSON.stringify(d)", ("x.json at planner", "is missing")),
        ("const d = JSON.parse(json); d.layers.arms.actions = 3; json = "
         "JSON.stringify(d)", ("x.json", "cannot be understood")),
        ("const d = JSON.parse(json); d.joints.pop(); json = JSON.stringify(d)", ("x.json", "base pose")),
        ("bytes = glb.subarray(0, glb.length - 1000)", ("stick.glb", "cut short", "copy both files")),
        ("bytes = glb.subarray(0, 10)", ("stick.glb", "is no GLB")),
        ("bytes = new Uint8Array(1000)", ("stick.glb", "is no GLB")),
        ("const d = JSON.parse(json); d.joints.forEach((j) => j.name += 1); json = "
         "JSON.stringify(d)", ("none of the export's joints",)),
    ],
)  # fmt: skip
def test_a_file_that_cannot_be_loaded_is_refused_with_place_and_remedy(
    change: str, words: tuple[str, ...]
) -> None:
    message = refused(STICK, change)
    assert all(word in message for word in words), message


def test_every_truncation_of_the_files_is_refused_clearly() -> None:
    found = run(
        """
        const out = [];
        for (let n = 0; n < 40; n++) {
          try { load(text, glb.subarray(0, Math.floor((n * glb.length) / 40))); out.push("loaded"); }
          catch (e) { out.push(e.name); }
          try { load(text.slice(0, Math.floor((n * text.length) / 40)), glb); out.push("loaded"); }
          catch (e) { out.push(e.name); }
        }
        say([...new Set(out)]);
        """
    )
    assert found == ["MetagraphError"]


@pytest.mark.nightly
def test_whatever_is_changed_in_an_export_is_refused_or_plays() -> None:
    found = run(
        """
        let state = 4321;
        const draw = (n) => (state = (Math.imul(state, 1103515245) + 12345) >>> 0) % n;
        const values = [null, "", "x", -1, 1e9, NaN, [], {}, true];
        const names = new Set();
        const thrown = [];
        for (let n = 0; n < %d; n++) {
          const data = JSON.parse(text);
          let at = data;
          let path = "";
          for (;;) {
            const keys = Object.keys(at);
            const key = keys[draw(keys.length)];
            path += `.${key}`;
            if (typeof at[key] === "object" && at[key] !== null && Object.keys(at[key]).length && draw(5)) { at = at[key]; continue; }
            if (draw(3)) at[key] = values[draw(values.length)];
            else delete at[key];
            break;
          }
          let graph;
          try { graph = load(JSON.stringify(data), glb); } catch (error) { names.add(error.name); continue; }
          names.add("loaded");
          try {
            const character = new Character(graph, { seed: n });
            character.ask({ do: "say", line: "hello" });
            for (const t of [0.1, 1, 2, 5, 9, 21]) { character.update(t); character.pose(); character.morphs(); }
          } catch (error) { thrown.push(`${path}: ${error.stack.split("\\n").slice(0, 2).join("")}`); }
        }
        say({ names: [...names].sort(), thrown });
        """.replace("%d", str(many(80, 400))),
        VARIED,
    )
    assert found["names"] == ["MetagraphError", "loaded"]
    assert found["thrown"] == []


@pytest.mark.nightly
def test_unknown_fields_of_an_export_are_passed_over() -> None:
    script = (
        "const d = JSON.parse(text); d.news = 1; d.layers.arms.news = 2; d.joints[0].news = []; "
        "say(load(JSON.stringify(d), glb).problems)"
    )
    assert run(script) == []


@pytest.mark.nightly
def test_a_glb_of_another_export_is_told_and_plays_all_the_same() -> None:
    script = """
        const longer = new Uint8Array(glb.byteLength + 4);
        longer.set(new Uint8Array(glb.buffer ?? glb, glb.byteOffset ?? 0, glb.byteLength));
        say([load(text, longer).problems, load(text, glb).problems]);
        """
    (told,), none = run(script)
    assert "is not the GLB that this JSON was written with" in told and none == []


@pytest.mark.nightly
def test_a_clip_that_the_glb_lacks_is_listed_and_shows_its_stance(tmp_path: Path) -> None:
    copy = changed(STICK, tmp_path, lambda document: document["animations"].pop(3))
    found = run(
        """
        const graph = load(text, glb);
        const lost = JSON.parse(text).clips[3];
        const action = Object.values(graph.layers).flatMap((l) => [...l.actions.values()]).find((a) => a.clip === lost.id);
        const plan = hear(graph, emptyPlan(1), 0, [{ do: "action", action: action.id, id: "a" }], 20, { idle: false });
        const cue = plan.layers[action.layer].cues.at(-1);
        const far = Math.max(...poseAt(graph, plan, (cue.start + cue.end) / 2).rotations.map((x) => Math.abs(x)));
        say({ problems: graph.problems, name: lost.name, cue: cue.action.id === action.id, far });
        """,
        copy,
    )
    other, lost = found["problems"]
    assert "'stick.glb' is not the GLB that this JSON was written with" in other
    assert lost == f"the GLB has no animation '{found['name']}'; its actions show their stance"
    assert found["cue"]
    assert 0.5 < found["far"] <= 1.0001


def test_a_joint_that_the_glb_lacks_is_listed_and_stays() -> None:
    found = run(
        """
        const d = JSON.parse(text);
        d.joints.at(-1).name = "Tail";
        const graph = load(JSON.stringify(d), glb);
        const pose = poseAt(graph, hear(graph, emptyPlan(1), 0, [], 10), 5);
        say({ problems: graph.problems, finite: pose.rotations.every(Number.isFinite) });
        """
    )
    assert len(found["problems"]) == 1
    assert "Tail" in found["problems"][0]
    assert found["finite"]


def test_the_types_know_every_attribute_that_the_element_reads() -> None:
    source = (RUNTIME / "element.js").read_text(encoding="utf-8")
    read = {*re.findall(r'(?:get|has)Attribute\("([\w-]+)"\)', source)} - {"aria-label"}
    read |= {*re.findall(r'"(\w+)"', re.search(r"observedAttributes = \[(.*?)\]", source)[1])}  # type: ignore[index]
    types = (RUNTIME / "element.d.ts").read_text(encoding="utf-8")
    told = re.search(r"interface MetagraphCharacterAttributes \{(.*?)\n\}", types, re.DOTALL)
    assert told and read == {*re.findall(r"^  (\w+)\?:", told[1], re.MULTILINE)}
    assert types.count('"metagraph-character": InJsx') == 2  # of React, and of all else
