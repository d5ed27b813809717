"""The C++ runtime: it conforms without exceptions and run-time types, refuses what is wrong as it says, and its
conformance vectors would notice.
"""

from __future__ import annotations

import json
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
from metagraph.graph.requests import make_request
from metagraph.playback.life.voice import guess_voice
from metagraph.playback.plan import Plan
from metagraph.playback.planning.extend_performance import drop_ended, hear_asks
from tests.engines.cpp_program import MUTANTS, needs_compiler, ran
from tests.engines.mutants import PLAYED, folders_to_try, share_of
from tests.engines.requests_asked import ASKED, SENSELESS

ROOT = Path(__file__).resolve().parents[2]
VECTORS = sorted(p.parent for p in (ROOT / "metagraph" / "engines" / "conformance").glob("*/vectors.json"))
STICK = ROOT / "metagraph" / "engines" / "conformance" / "stick"

pytestmark = [needs_compiler, pytest.mark.nightly]  # `test_cpp_compiles.py` is for each day


@pytest.fixture(scope="module")
def probe(cpp_probe: Path) -> Path:
    return cpp_probe


# --- conformance


@pytest.mark.parametrize("folder", PLAYED, ids=lambda folder: folder.name)
def test_the_runtime_agrees_with_the_vectors(probe: Path, folder: Path, tmp_path: Path) -> None:
    done = ran(probe, "conformance", share_of(folder, "cpp", tmp_path))
    assert done.returncode == 0, done.stdout[:2000] + done.stderr[:2000]


def test_the_runtime_agrees_with_the_sample_project(probe: Path, sample_export: Path) -> None:
    done = ran(probe, "conformance", sample_export)
    assert done.returncode == 0, done.stdout[:2000] + done.stderr[:2000]


def test_what_is_left_of_a_division_is_what_python_leaves_at_exact_multiples_too(probe: Path) -> None:
    rng = np.random.default_rng(3)
    parts = rng.choice([0.1, 0.31, 1.55, 2.0 / 3.0, 1.0 / 60.0, -0.7], 400).tolist()
    pairs = [(float(n) * b, b) for n, b in zip(rng.integers(-40, 200, 400), parts, strict=True)]
    pairs += [(float(a), 1.37) for a in rng.uniform(-30, 30, 200)]
    told = subprocess.run(
        [probe, "left"],
        input="\n".join(f"{a!r} {b!r}" for a, b in pairs),
        capture_output=True,
        text=True,
        timeout=60,
        check=True,
    )
    assert [float.fromhex(line) for line in told.stdout.split()] == [a % b for a, b in pairs]


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
        voice = guess_voice(text, 2.5)
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


def test_a_glb_of_another_export_is_told(probe: Path, tmp_path: Path) -> None:
    done = ran(probe, "load", altered(tmp_path, glb=lambda b: b + bytes(4)))
    assert done.returncode == 0
    assert "'stick.glb' is not the GLB that this JSON was written with" in done.stdout
    assert ran(probe, "load", altered(tmp_path)).stdout == ""


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
    plan, cut = hear_asks(project, Plan(5, 0.0), 0.0, [], 20.0), 0.0
    for n, now in enumerate(moments):
        asks = [dict(ask) for ask in ASKED.get(n, [])]
        for ask in asks:
            if "after" in ask:
                ask["at"] = now + ask.pop("after")
        far = plan.end >= now + 18
        if asks or not far:
            plan = hear_asks(
                project, plan, now, [make_request(ask) for ask in asks], plan.end if far else now + 20
            )
        if now - cut >= 15:
            cut, plan = now, drop_ended(plan, now - 30)
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
    assert done.stdout.split()[-1] in ("planned", "late", "done")
