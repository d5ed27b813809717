"""The C++ runtime: it conforms without exceptions and run-time types, refuses what is wrong as it says, and its
conformance vectors would notice.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import struct
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from metagraph.engines.reading import read_export
from metagraph.graph.model import LAYERS
from metagraph.graph.requests import request_from
from metagraph.playback.extend_performance import hear, since
from metagraph.playback.life.voice import voice_from_text
from metagraph.playback.plan import Plan
from tests.engines.mutants import PLAYED, broken, folders_to_try
from tests.engines.test_runtime_unity import ASKED, SENSELESS

ROOT = Path(__file__).resolve().parents[2]
RUNTIME = ROOT / "metagraph" / "engines" / "runtimes" / "cpp"
VECTORS = sorted(p.parent for p in (ROOT / "metagraph" / "engines" / "conformance").glob("*/vectors.json"))
STICK = ROOT / "metagraph" / "engines" / "conformance" / "stick"
# That the compiler tidies its memory seldom takes an eighth off its time.
SELDOM = ("--param", "ggc-min-heapsize=600000", "--param", "ggc-min-expand=200")
FLAGS = (*SELDOM, "-std=c++17", "-O0", "-Wall", "-Wextra", "-Werror", "-fno-exceptions", "-fno-rtti")

pytestmark = pytest.mark.skipif(shutil.which("g++") is None, reason="needs a C++ compiler (g++)")


def compiled(source: Path, *more: str | Path) -> Path:
    """Compile one source with all warnings as errors, as engines do that have no exceptions."""
    program = source.with_suffix("")
    done = subprocess.run(
        ["g++", *FLAGS, *map(str, more), str(source), "-o", str(program)],
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert done.returncode == 0, done.stderr[:4000]
    return program


def ran(program: Path, *words: object, **environment: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [str(program), *map(str, words)],
        capture_output=True, text=True, timeout=120, check=False, env={**os.environ, **environment},
    )  # fmt: skip


# What is broken: a file, a rule's expression, what it is instead, and which case notices.
MUTANTS = [
    ("pose.hpp", "1 - pose::cue_weight(*cue, time)", "pose::cue_weight(*cue, time)", "sparse: arms: strokes that are planned on"),
    ("pose.hpp", "elapsed >= period", "elapsed < 0", "standing: the models alone"),
    ("pose.hpp", "rotation::ease((time - rest.fade_start) / rest.fade)", "1.0", "standing: the models alone"),
    ("pose.hpp", "weight == 1 ?", "weight > 0 ?", "varied: nothing is asked"),
    ("pose.hpp", "cue.hold <= 0", "cue.hold <= 1e9", "sparse: arms: holds and preparations"),
    ("loading.hpp", "arm || masked", "masked", "standing: the models alone"),
    ("loading.hpp", "masked = !action.joints.empty()", "masked = action.joints.size() > 1000", "standing: arms: strokes in a mood"),
    ("glb.hpp", "std::clamp((time - track.times[key]) / span, 0.0, 1.0)", "0.0", "quiet: the models alone"),
    ("enliven.hpp", "full_ * breath.w", "2 * full_ * breath.w", "slow: the models alone"),
    ("solve.hpp", "shut + blink * (1 - shut)", "shut + blink", "quiet: the models in four moods"),
    ("solve.hpp", "2 * share);", "share);", "quiet: a thing that moves"),
    ("gaze.hpp", "since > start", "since > 1e9", "standing: chatter 1"),
    ("gaze.hpp", "moved - turned", "now - came", "quiet: a thing that moves"),
    ("lips.hpp", "(time - speech.end) / CLOSING", "(time - speech.end) / 1e-9", "quiet: stressed syllables"),
    ("schedule.hpp", "ways->breathing", "1.0", "calm: the models in four moods"),
    ("items.hpp", "speech->priority < last->priority", "false", "quiet: words that are said"),
    ("hearing.hpp", "bool turns = holds3;", "bool turns = false;", "sparse: modes asked for live"),
    ("meaning.hpp", "at + *inner->at", "at", "stick: lines"),
    ("planner.hpp", "plan.track->stays_at(meta->request->layer, meta->start)", "false", "sparse: arms: to stay"),
]  # fmt: skip


def _switched(path: Path, number: int, rule: str, instead: str) -> str:
    """Return a source in which a rule is followed, or broken where MUTANT says so; it stays one expression."""
    if rule.endswith((";", "?")):
        end = rule[-1]
        head, _, tail = rule[:-1].rpartition(" = ")
        other = instead[:-1].rpartition(" = ")[2]
        lead = f"{head} = " if head else ""
        if rule == "2 * share);":
            return broken(path, rule, f"(MUTANT == {number} ? 1 : 2) * share);")
        return broken(path, rule, f"{lead}(MUTANT == {number} ? ({other}) : ({tail})){end}")
    if " = " in rule or " += " in rule:
        head, sign, tail = re.split(r" (=|\+=) ", rule, maxsplit=1)
        other = re.split(r" (?:=|\+=) ", instead, maxsplit=1)[1]
        return broken(path, rule, f"{head} {sign} (MUTANT == {number} ? ({other}) : ({tail}))")
    return broken(path, rule, f"(MUTANT == {number} ? ({instead}) : ({rule}))")


PROBE = r"""
#include <fstream>
#include <iostream>
#include <iterator>

#define main shipped
#include "conformance.cpp"
#undef main
#define main example
#include "play.cpp"
#undef main
namespace talking {
#define main talk
#include "talk.cpp"
#undef main
}

using namespace metagraph;

static std::string read(const std::string& path) { return conformance::file(path).value_or(""); }

static Loaded loaded(const std::string& json) {
    const std::string text = read(json), glb = read(json.substr(0, json.size() - 4) + "glb");
    return load(text, reinterpret_cast<const std::uint8_t*>(glb.data()), glb.size(), json.substr(json.rfind('/') + 1));
}

static int live(Character& character, const Json& steps) {
    List<std::string> ids;
    for (const Json& step : steps.items) {
        for (const Json& ask : step.items[1].items) ids.push_back(character.ask(ask.text));
        character.update(step.items[0].number);
        character.pose();
        character.morphs();
        for (const Happening& e : character.events()) {
            std::cout << json::text(Json::list({"event", e.kind, e.layer, e.action, e.meta, e.at})) << "\n";
        }
    }
    std::cout << json::text(Json::list({"now", character.now()})) << "\n";
    for (const std::string& id : ids) {
        const Answer a = character.answer(id);
        std::cout << json::text(Json::list({"answer", id, a.state, Json::maybe(a.at), Json::maybe(a.until), a.why})) << "\n";
    }
    for (const std::string& layer : graph::LAYERS) {
        for (const auto& c : character.plan().layers.at(layer)->cues) {
            std::cout << json::text(Json::list({"cue", layer, c->action->id, c->start, c->end, c->meta})) << "\n";
        }
    }
    return 0;
}

int main(int count, char** words) {
    const std::string what = words[1];
    if (what == "conformance") return shipped(count - 1, words + 1);
    if (what == "example") return example();
    if (what == "talk") return talking::talk(count - 1, words + 1);
    const std::string text = read(words[count - 1]);
    json::Parser parser(text);
    const Json data = parser.parse();
    if (what == "json") {
        std::cout << (parser.wrong.empty() ? json::text(data) : parser.wrong) << "\n";
        return 0;
    }
    if (what == "voices") {
        for (const Json& one : data.items) {
            const Ref<Voice> voice = voice::from_text(one.text, 2.5);
            List<Json> accents(voice->accents.begin(), voice->accents.end());
            Json weights = Json::list();
            for (const float weight : voice->weights) weights.items.push_back(static_cast<double>(weight));
            std::cout << json::text(Json::list({Json::list(accents), weights})) << "\n";
        }
        return 0;
    }
    const Loaded export_ = loaded(words[2]);
    if (export_.graph == nullptr) {
        std::cout << export_.error << "\n";
        return 3;
    }
    for (const auto& problem : export_.graph->problems) std::cout << problem << "\n";
    if (what != "live") return 0;
    CharacterOptions options;
    options.seed = 5;
    Character character(export_.graph, options);
    return live(character, data);
}
"""


def example() -> str:
    """Return the README's program, with what else it shows in it."""
    found = re.findall(r"```cpp\n(.*?)```", (RUNTIME / "README.md").read_text(), re.DOTALL)
    program, *more = found
    return str(program).replace("    for (double now = 0;", "".join(more) + "    for (double now = 0;", 1)


def make_probe(folder: Path) -> None:
    """Compile the program that does what a test says, the shipped runner among it, with a switch for each
    mutant.
    """
    from tests.engines.test_talk_runtimes import CPP_PROGRAM

    for path in (*RUNTIME.glob("*.hpp"), RUNTIME / "conformance.cpp"):
        shutil.copy(path, folder)
    for number, (name, rule, instead, _) in enumerate(MUTANTS, 1):
        (folder / name).write_text(_switched(folder / name, number, rule, instead))
    language = folder / "language.hpp"
    switch = 'inline const int MUTANT = std::getenv("MUTANT") ? std::atoi(std::getenv("MUTANT")) : 0;\n'
    language.write_text(
        broken(language, "namespace metagraph {\n\ntemplate", f"{switch}namespace metagraph {{\n\ntemplate")
    )
    (folder / "metagraph").symlink_to(folder)
    (folder / "play.cpp").write_text(example())
    (folder / "talk.cpp").write_text(CPP_PROGRAM)
    source = folder / "probe.cpp"
    source.write_text(PROBE)
    compiled(source, "-I", folder)


@pytest.fixture(scope="module")
def probe(cpp_probe: Path) -> Path:
    return cpp_probe


# --- conformance


@pytest.mark.parametrize("folder", PLAYED, ids=lambda folder: folder.name)
def test_the_runtime_agrees_with_the_vectors(probe: Path, folder: Path) -> None:
    done = ran(probe, "conformance", folder)
    assert done.returncode == 0, done.stdout[:2000] + done.stderr[:2000]


def test_the_runtime_agrees_with_the_sample_project(probe: Path, sample_export: Path) -> None:
    done = ran(probe, "conformance", sample_export)
    assert done.returncode == 0, done.stdout[:2000] + done.stderr[:2000]


def test_the_runner_fails_without_vectors_and_with_those_of_another_version(
    probe: Path, tmp_path: Path
) -> None:
    assert ran(probe, "conformance").returncode == 1
    assert ran(probe, "conformance", tmp_path).returncode == 1
    folder = shutil.copytree(STICK, tmp_path / "stick")
    vectors = json.loads((folder / "vectors.json").read_bytes())
    (folder / "vectors.json").write_text(json.dumps({**vectors, "vectors": 2}))
    done = ran(probe, "conformance", folder)
    assert done.returncode == 1
    assert "update the runtime" in done.stdout


def test_the_shipped_headers_compile_as_they_are(tmp_path: Path) -> None:
    """Those with switches are what runs; what is shipped differs from them in the mutants' lines alone."""
    shutil.copy(RUNTIME / "conformance.cpp", tmp_path)
    compiled(tmp_path / "conformance.cpp", "-I", RUNTIME, "-fsyntax-only")


def test_single_cases_that_notice_mutants_pass_where_nothing_is_broken(probe: Path, single: Path) -> None:
    tried = {folders_to_try(hint, VECTORS, single)[0] for *_, hint in MUTANTS}
    assert all(folder.parent == single for folder in tried)
    done = ran(probe, "conformance", *tried)
    assert done.returncode == 0, done.stdout


@pytest.mark.parametrize("number", range(1, len(MUTANTS) + 1), ids=lambda n: MUTANTS[n - 1][1][:40])
def test_the_vectors_notice_a_broken_rule(probe: Path, single: Path, number: int) -> None:
    hint = MUTANTS[number - 1][3]
    assert any(
        ran(probe, "conformance", folder, MUTANT=str(number)).returncode != 0
        for folder in folders_to_try(hint, VECTORS, single)
    )


def test_words_move_the_mouth_as_they_do_in_the_library(probe: Path, tmp_path: Path) -> None:
    texts = [
        "Hello there, how are you?", "  Straße - ¡Übergröße!  ", "Ты знаешь, это хорошо.", "日本語のテキスト 123 ½ ² ①",
        "नमस्ते दुनिया", "", "αβγ Ελληνικά ώρα", "🙂 ok 🙂", "...", "İstanbul ılık", "שָׁלוֹם עולם", "tiếng Việt",
        "the eye igh though tion ee nation queue", "\x1c hi \x1f", "한국어 텍스트", "e\u0301te\u0301", "x" * 200,
    ]  # fmt: skip
    (tmp_path / "texts.json").write_text(json.dumps(texts))
    done = ran(probe, "voices", tmp_path / "texts.json")
    assert done.returncode == 0, done.stderr
    for text, line in zip(texts, done.stdout.splitlines(), strict=True):
        accents, weights = json.loads(line)
        voice = voice_from_text(text, 2.5)
        assert np.allclose(accents, voice.accents, atol=1e-9), text
        assert np.abs(np.reshape(weights, (-1, 15)) - voice.weights).max() < 1e-5, text


# --- JSON


@pytest.mark.parametrize(
    "text",
    [
        "0", "-0.5", "1e3", "123456789.123456789", "0.1", "5e-324", "1.7976931348623157e308", "9007199254740993",
        "0.30000000000000004", "[]", "{}", '"\\u00e9\\ud83d\\ude42\\n\\"\\\\/"', '{"a": [1, {"b": null}], "c": true}', " [ 1 , 2 ] ",
        '"é🙂"', "-1.5E-7", "[" * 200 + "]" * 200,
    ],
)  # fmt: skip
def test_json_is_read_as_python_reads_it(probe: Path, tmp_path: Path, text: str) -> None:
    (tmp_path / "text.json").write_text(text, encoding="utf-8")
    found = ran(probe, "json", tmp_path / "text.json").stdout
    assert json.loads(found, parse_int=float) == json.loads(text, parse_int=float)


@pytest.mark.parametrize(
    "text",
    [
        "", "[1,]", '{"a":1,}', "{a:1}", "01", "1.", ".5", "1e", "+1", "tru", '"a', '"\n"', '"\\x"', '"\\u12"', '"\\ud800"', "[1 2]", '{"a" 1}',
        "1 1", "[" * 100000, "1e999", "-", "NaN", "'a'", "\x00",
    ],
)  # fmt: skip
def test_what_is_no_json_is_refused_with_its_place(probe: Path, tmp_path: Path, text: str) -> None:
    (tmp_path / "text.json").write_text(text, encoding="utf-8")
    done = ran(probe, "json", tmp_path / "text.json")
    assert done.returncode == 0
    assert re.search(r"is not JSON: .* in line \d+, column \d+", done.stdout)


# --- what is wrong


def altered(tmp_path: Path, change: Any = None, glb: Any = None) -> Path:
    """Return a copy of the stick's JSON with its document changed in place, and its GLB's bytes."""
    document = json.loads((STICK / "stick.json").read_bytes())
    data = (STICK / "stick.glb").read_bytes()
    if change is not None:
        changed = change(document)
        document = changed if isinstance(changed, dict | str) else document
    path = tmp_path / "stick.json"
    path.write_text(document if isinstance(document, str) else json.dumps(document))
    path.with_suffix(".glb").write_bytes(data if glb is None else glb(data))
    return path


def refused(probe: Path, path: Path) -> str:
    done = ran(probe, "load", path)
    assert done.returncode == 3, done.stdout + done.stderr
    return done.stdout


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda d: {**d, "metagraph": 2}, "Update the runtime"),
        (lambda d: json.dumps(d)[:-40], "not JSON"),
        (lambda d: "[1]", "should be an object"),
        (lambda d: "[" * 5000, "nested too deeply"),
        (lambda d: {k: v for k, v in d.items() if k != "layers"}, "'layers' is missing"),
        (lambda d: d["layers"]["arms"]["actions"][2].pop("blend_in"), "actions[2]: 'blend_in' is missing"),
        (lambda d: d["layers"]["arms"]["actions"][2].update(kind="dance"), "actions[2].kind: should be one of stance"),
        (lambda d: d["layers"]["head"]["actions"][0].update(id=d["layers"]["head"]["actions"][1]["id"]), "is used twice"),
        (lambda d: d["layers"]["head"]["actions"][0].update(clip="c999"), "is no clip"),
        (lambda d: d["joints"][1].update(parent="Tail"), "should stand before it"),
        (lambda d: d["base"]["rotations"].pop(), "a row for each"),
        (lambda d: d["rig"]["chain"].append(10**6), "is no joint"),
        (lambda d: d["rig"]["breath"].pop(), "a breath for each"),
        (lambda d: d["rig"]["face"]["turns"].pop(), "channels"),
        (lambda d: d["randomness"].update(hash="md5"), "another hash"),
        (lambda d: d["planner"].update(wait="long"), "planner.wait: should be a number"),
        (lambda d: d["clips"][0].update(frames=10**9), "clips[0].frames: is out of range"),
        (lambda d: d["layers"]["arms"]["markov"]["states"].append([]), "should be a limb and a kind"),
        (lambda d: d.update(life={"blinks": 1e9}), "life.blinks: is out of range"),
        (lambda d: d["joints"][-1].update(name="Tail") or d.update(joints=[{**j, "name": j["name"] + "x", "parent":
            None if j["parent"] is None else j["parent"] + "x"} for j in d["joints"][:-1]]), "should"),
    ],
)  # fmt: skip
def test_a_broken_json_is_refused_by_the_place_that_is_wrong(
    probe: Path, tmp_path: Path, change: Any, words: str
) -> None:
    told = refused(probe, altered(tmp_path, change))
    assert words in told
    assert "stick.json" in told


@pytest.mark.parametrize("kept", [0, 3, 19, 40, 2000, 0.5, 0.9, 0.999])
def test_a_cut_off_glb_is_refused(probe: Path, tmp_path: Path, kept: float) -> None:
    assert "stick.glb" in refused(
        probe, altered(tmp_path, glb=lambda b: b[: int(kept * len(b)) if isinstance(kept, float) else kept])
    )


def test_a_glb_whose_data_is_shorter_than_it_says_is_refused(probe: Path, tmp_path: Path) -> None:
    def shorten(data: bytes) -> bytes:
        short = data[:-400]
        return short[:8] + struct.pack("<I", len(short)) + short[12:]

    assert "lies outside" in refused(probe, altered(tmp_path, glb=shorten))


def test_what_the_glb_lacks_is_told_and_the_rest_plays(probe: Path, tmp_path: Path) -> None:
    def rename(document: Any) -> None:
        document["joints"][-1]["name"] = "Tail"
        document["clips"][0]["name"] = "lost"

    done = ran(probe, "load", altered(tmp_path, rename))
    assert done.returncode == 0
    assert "has no joint 'Tail'" in done.stdout
    assert "has no animation 'lost'" in done.stdout


# --- live


def live(probe: Path, tmp_path: Path, steps: list[Any]) -> dict[str, list[Any]]:
    """Return what a live character printed, by what it is; requests may be data or texts."""
    texts = [[now, [ask if isinstance(ask, str) else json.dumps(ask) for ask in asks]] for now, asks in steps]
    (tmp_path / "steps.json").write_text(json.dumps(texts))
    done = ran(probe, "live", STICK / "stick.json", tmp_path / "steps.json")
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr
    out: dict[str, list[Any]] = {"event": [], "answer": [], "cue": [], "now": []}
    for line in done.stdout.splitlines():
        kind, *values = json.loads(line)
        out[kind].append(values)
    return out


def test_a_character_plans_what_the_library_hears(probe: Path, tmp_path: Path) -> None:
    moments = [n * 0.25 + 0.1 * (n % 3 == 1) for n in range(400)]
    found = live(probe, tmp_path, [[now, ASKED.get(n, [])] for n, now in enumerate(moments)])
    project = read_export(STICK / "stick.json", resolved=True)
    plan, cut = hear(project, Plan(5, 0.0), 0.0, [], 20.0), 0.0
    for n, now in enumerate(moments):
        asks = [dict(ask) for ask in ASKED.get(n, [])]
        for ask in asks:
            if "after" in ask:
                ask["at"] = now + ask.pop("after")
        far = plan.end >= now + 18
        if asks or not far:
            plan = hear(
                project, plan, now, [request_from(ask) for ask in asks], plan.end if far else now + 20
            )
        if now - cut >= 15:
            cut, plan = now, since(plan, now - 30)
    expected = [
        [layer, c.action.id, c.start, c.end, c.meta] for layer in LAYERS for c in plan.layers[layer].cues
    ]
    assert [[*x[:2], *x[4:]] for x in found["cue"]] == [[*x[:2], *x[4:]] for x in expected]
    assert np.allclose([x[2:4] for x in found["cue"]], [x[2:4] for x in expected], atol=1e-6)
    answers = {ident: state for ident, state, *_ in found["answer"]}
    assert answers["f"] == "done"
    assert answers["g"] in ("planned", "late", "done")


def test_what_begins_ends_and_is_told_once(probe: Path, tmp_path: Path) -> None:
    asks = [{"do": "gesture", "id": "a"}, {"do": "say", "text": "hi there"}]
    found = live(probe, tmp_path, [[n * 0.3, asks if n == 2 else []] for n in range(90)])
    times = [at for *_, at in found["event"]]
    assert times == sorted(times)
    begun = [(layer, meta, action) for kind, layer, action, meta, _ in found["event"] if kind == "begin"]
    ended = [(layer, meta, action) for kind, layer, action, meta, _ in found["event"] if kind == "end"]
    assert len(begun) - len(ended) in range(4)  # at most one of each layer still plays
    assert [x for x in begun if x[1] == "a"]
    assert [x[2] for x in begun if x[0] == "speech"] == ["hi there"]


def test_requests_that_make_no_sense_are_refused_with_a_reason(probe: Path, tmp_path: Path) -> None:
    found = live(probe, tmp_path, [[0, SENSELESS], [0.1, []], [40, []]])
    assert found["now"] == [[40.0]]
    assert len(found["answer"]) == len(SENSELESS)
    for ask, (_, state, at, until, why) in zip(SENSELESS, found["answer"], strict=True):
        assert (state, at, until) == ("refused", None, None), ask
        assert why, ask


def test_time_never_goes_backwards(probe: Path, tmp_path: Path) -> None:
    assert live(probe, tmp_path, [[5, []], [2, []], [-1, []], [5.5, []], [0, []]])["now"] == [[5.5]]


def test_the_example_in_the_readme_runs(probe: Path, tmp_path: Path) -> None:
    for path in STICK.glob("stick.*"):
        shutil.copy(path, tmp_path / path.name.replace("stick", "sample"))
    done = subprocess.run(
        [str(probe), "example"], cwd=tmp_path, capture_output=True, text=True, timeout=60, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert "begin" in done.stdout
    assert "planned" in done.stdout or "done" in done.stdout
