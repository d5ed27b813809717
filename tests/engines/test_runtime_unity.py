"""The C# runtime: it conforms, and refuses what is wrong as it says."""

from __future__ import annotations

import json
import shutil
import struct
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from metagraph.engines.reading import read_export
from metagraph.graph.model import LAYERS
from metagraph.graph.requests import make_request
from metagraph.motion import rotation
from metagraph.playback.life.voice import guess_voice
from metagraph.playback.plan import Plan
from metagraph.playback.planning.extend_performance import drop_ended, hear_asks
from tests.engines.csharp_runtime import RUNTIME, STICK, Host, compiled, mono, needs_mono
from tests.engines.mutants import PLAYED, share_of
from tests.engines.requests_asked import ASKED, SENSELESS
from tests.posing import pose_at

pytestmark = needs_mono


class Probe:
    """A program that uses the runtime, kept running."""

    def __init__(self, host: Host, path: Path) -> None:
        self.host, self.path = host, path

    def __call__(self, *arguments: object) -> tuple[int, str]:
        return self.host.run(self.path, *arguments)


@pytest.fixture(scope="module")
def conformance(core: Path) -> Path:
    return compiled(
        core.with_name("conformance.exe"), RUNTIME / "Tests" / "Conformance.cs", references=(core,)
    )


@pytest.fixture(scope="module")
def probe(core: Path, host: Host) -> Probe:
    source = core.with_name("probe.cs")
    source.write_text(PROBE)
    return Probe(host, compiled(core.with_name("probe.exe"), source, references=(core,)))


# A program that does what a test says and prints what came of it: load, poses, live, garbage or voices.
PROBE = r"""
using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using Metagraph;

public static class Probe
{
    private static string R(double value) { return value.ToString("R", CultureInfo.InvariantCulture); }

    private static double D(object value) { return value is long ? (long)value : (double)value; }

    private static Graph Read(string json)
    {
        string text = File.ReadAllText(json);
        return Graph.Load(text, File.ReadAllBytes(Path.ChangeExtension(json, ".glb")), Path.GetFileName(json));
    }

    public static int Main(string[] args)
    {
        try
        {
            Graph graph = args[0] == "voices" ? null : Read(args[1]);
            switch (args[0])
            {
                case "load": graph.Problems.ForEach(Console.WriteLine); break;
                case "poses": Poses(graph, (JsonObject)Json.Parse(args[2])); break;
                case "live": Live(graph, (List<object>)Json.Parse(File.ReadAllText(args[2]))); break;
                case "garbage": return Garbage(graph);
                case "voices": Voices((List<object>)Json.Parse(File.ReadAllText(args[1]))); break;
            }
            return 0;
        }
        catch (MetagraphException error)
        {
            Console.WriteLine(error.Message);
            return 3;
        }
    }

    private static void Poses(Graph graph, JsonObject wish)
    {
        Plan plan = Hearing.Hear(graph, Plan.Empty((uint)D(wish["seed"])), 0, new Ask[0], D(wish["end"]));
        var player = new Player(graph);
        var pose = new BodyPose(graph);
        foreach (object time in (List<object>)wish["times"])
        {
            player.PoseAt(plan, D(time), (bool)wish["alive"], pose);
            string rotations = string.Join(",", pose.Rotations.Select(x => R(x)).ToArray());
            Console.WriteLine("[[" + rotations + "],[" + string.Join(",", pose.Translations.Select(x => R(x)).ToArray()) + "]]");
        }
    }

    // Each step: a time to move on to, and the requests that come in before as texts. Then all answers, and the plan.
    private static void Live(Graph graph, List<object> steps)
    {
        var character = new Character(graph, new CharacterOptions { Seed = 5 });
        character.Pose();
        var ids = new List<string>();
        foreach (List<object> step in steps)
        {
            ids.AddRange(((List<object>)step[1]).Select(ask => character.Ask((string)ask)).ToArray());
            character.Update(D(step[0]));
            character.Pose();
            foreach (CharacterEvent e in character.Events())
            {
                string what = Json.Quote(e.Kind) + "," + Json.Quote(e.Layer) + "," + Json.Quote(e.Action) + "," + Json.Quote(e.Meta);
                Console.WriteLine("[\"event\"," + what + "," + R(e.At) + "]");
            }
        }
        Console.WriteLine("[\"now\"," + R(character.Now) + "]");
        foreach (string id in ids)
        {
            Answer a = character.AnswerTo(id);
            string at = (a.At == null ? "null" : R(a.At.Value)) + "," + (a.Until == null ? "null" : R(a.Until.Value));
            Console.WriteLine("[\"answer\"," + Json.Quote(id) + ",\"" + a.State + "\"," + at + "," + Json.Quote(a.Why) + "]");
        }
        foreach (string layer in Basics.Layers)
        {
            foreach (Cue c in character.Plan.Layers[layer].Cues)
            {
                string what = Json.Quote(layer) + "," + Json.Quote(c.Action.Id) + "," + R(c.Start) + "," + R(c.End);
                Console.WriteLine("[\"cue\"," + what + "," + Json.Quote(c.Meta) + "]");
            }
        }
    }

    // How often the nursery was full while nothing but poses was asked for, and a plan that stays.
    private static int Garbage(Graph graph)
    {
        var character = new Character(graph);
        character.Ask("{\"do\":\"say\",\"text\":\"a few words that move the mouth\"}");
        character.Ask("{\"do\":\"look\",\"to\":[1,1,1],\"at\":2}");
        character.Update(0);
        var player = new Player(graph);
        var pose = new BodyPose(graph);
        int before = 0;
        for (int n = 0; n < 41000; n++)
        {
            if (n == 1000)
            {
                GC.Collect();
                before = GC.CollectionCount(0);
            }
            player.PoseAt(character.Plan, n % 1000 * 0.02, true, pose);
            character.Update(0);
        }
        Console.WriteLine(GC.CollectionCount(0) - before);
        return 0;
    }

    private static void Voices(List<object> texts)
    {
        foreach (string text in texts)
        {
            Voice voice = Voice.FromText(text, 2.5);
            string weights = string.Join(",", voice.Weights.SelectMany(row => row).Select(x => R(x)).ToArray());
            Console.WriteLine("[[" + string.Join(",", voice.Accents.Select(R).ToArray()) + "],[" + weights + "]]");
        }
    }
}
"""


# --- conformance


@pytest.mark.parametrize("folder", PLAYED, ids=lambda folder: folder.name)
def test_the_runtime_agrees_with_the_vectors(conformance: Path, folder: Path, tmp_path: Path) -> None:
    done = mono(conformance, share_of(folder, "csharp", tmp_path))
    assert done.returncode == 0, done.stdout[:2000] + done.stderr[:2000]


@pytest.mark.nightly
def test_the_runtime_agrees_with_the_sample_project(conformance: Path, sample_export: Path) -> None:
    done = mono(conformance, sample_export)
    assert done.returncode == 0, done.stdout[:2000] + done.stderr[:2000]


@pytest.mark.nightly
def test_the_culture_of_the_machine_does_not_matter(conformance: Path) -> None:
    assert mono(conformance, STICK, LANG="tr_TR.UTF-8", LC_ALL="tr_TR.UTF-8").returncode == 0


@pytest.mark.nightly
def test_the_runner_fails_without_vectors_and_with_those_of_another_version(
    conformance: Path, tmp_path: Path
) -> None:
    assert mono(conformance).returncode == 1
    assert mono(conformance, tmp_path).returncode == 1
    folder = shutil.copytree(STICK, tmp_path / "stick")
    vectors = json.loads((folder / "vectors.json").read_bytes())
    (folder / "vectors.json").write_text(json.dumps({**vectors, "vectors": 2}))
    done = mono(conformance, folder)
    assert done.returncode == 1
    assert "update the runtime" in done.stdout


@pytest.mark.nightly
def test_words_move_the_mouth_as_they_do_in_the_library(probe: Probe, tmp_path: Path) -> None:
    texts = [
        "Hello there, how are you?",
        "  Straße - ¡Übergröße!  ",
        "Ты знаешь, это хорошо.",
        "日本語のテキスト 123 ½ ² ①",
        "नमस्ते दुनिया",
        "",
        "αβγ Ελληνικά ώρα",
        "🙂 ok 🙂",
        "...",
        "(x)",
        "It's 'quoted' though",
        "İstanbul ılık",
        "שָׁלוֹם עולם",
        "العَرَبِيَّة",
        "tiếng Việt",
        "the eye igh though tion ee nation queue",
        "\x1c hi \x1f",
        "한국어 텍스트",
        "ไทยภาษา",
        "e\u0301te\u0301",
        "x" * 200,
    ]
    (tmp_path / "texts.json").write_text(json.dumps(texts))
    code, told = probe("voices", tmp_path / "texts.json")
    assert code == 0, told
    for text, line in zip(texts, told.splitlines(), strict=True):
        accents, weights = json.loads(line)
        voice = guess_voice(text, 2.5)
        assert np.allclose(accents, voice.accents, atol=1e-9), text
        assert np.abs(np.reshape(weights, (-1, 15)) - voice.weights).max() < 1e-5, text


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


def refused(probe: Probe, path: Path) -> str:
    code, told = probe("load", path)
    assert code == 3, told
    return told


def test_a_newer_format_is_refused_and_says_what_to_do(probe: Probe, tmp_path: Path) -> None:
    words = refused(probe, altered(tmp_path, lambda d: {**d, "metagraph": 2}))
    assert "stick.json" in words
    assert "Update the runtime" in words


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda d: json.dumps(d)[:-40], "not JSON"),
        (lambda d: "", "not JSON"),
        (lambda d: "[1]", "should be an object"),
        (lambda d: "[" * 5000, "nested too deeply"),
        (lambda d: {k: v for k, v in d.items() if k != "layers"}, "'layers' is missing"),
        (lambda d: d["layers"]["arms"]["actions"][2].pop("blend_in"), "stick.json.layers.arms.actions[2]: "
                                                                      "'blend_in' is missing"),
        (lambda d: d["layers"]["arms"]["actions"][2].update(kind="dance"), "actions[2].kind: should be one "
                                                                           "of stance"),
        (lambda d: d["layers"]["head"]["actions"][0].update(id=d["layers"]["head"]["actions"][1]["id"]), "is used twice"),
        (lambda d: d["layers"]["head"]["actions"][0].update(clip="c999"), "is no clip"),
        (lambda d: d["joints"][1].update(parent="Tail"), "should stand before it"),
        (lambda d: d["base"]["rotations"].pop(), "a row for each"),
        (lambda d: d["rig"]["chain"].append(10**6), "is no joint"),
        (lambda d: d["randomness"].update(hash="md5"), "another hash"),
        (lambda d: d["planner"].update(wait="long"), "planner.wait: should be a number"),
        (lambda d: d["planner"].update(memory=-1), "planner.memory: is out of range"),
        (lambda d: d["clips"][0].update(frames=10**9), "clips[0].frames: is out of range"),
        (lambda d: d["layers"]["arms"]["markov"]["states"].append([]), "should be a limb and a kind"),
        (lambda d: d.update(life={"blinks": 1e9}), "life.blinks: is out of range"),
    ],
)  # fmt: skip
def test_a_broken_json_is_refused_by_the_place_that_is_wrong(
    probe: Probe, tmp_path: Path, change: Any, words: str
) -> None:
    assert words in refused(probe, altered(tmp_path, change))


def test_fields_that_nobody_knows_are_passed_over(probe: Probe, tmp_path: Path) -> None:
    path = altered(
        tmp_path, lambda d: d["layers"]["arms"]["actions"][0].update(mood=[{}]) or {**d, "later": 1}
    )
    assert probe("load", path) == (0, "")


@pytest.mark.parametrize("kept", [0, 3, 19, 40, 2000, 0.5, 0.9, 0.999])
def test_a_cut_off_glb_is_refused(probe: Probe, tmp_path: Path, kept: float) -> None:
    assert "stick.glb" in refused(
        probe, altered(tmp_path, glb=lambda b: b[: int(kept * len(b)) if isinstance(kept, float) else kept])
    )


def test_a_glb_whose_data_is_shorter_than_it_says_is_refused(probe: Probe, tmp_path: Path) -> None:
    def shorten(data: bytes) -> bytes:
        short = data[:-400]
        return short[:8] + struct.pack("<I", len(short)) + short[12:]

    assert "lies outside" in refused(probe, altered(tmp_path, glb=shorten))


def test_a_foreign_glb_is_refused(probe: Probe, tmp_path: Path) -> None:
    assert "has no joint" in refused(probe, altered(tmp_path, lambda d: d["joints"][-1].update(name="Tail")))
    assert "not a binary glTF" in refused(
        probe, altered(tmp_path, glb=lambda b: b"glTF but not really, this is text")
    )


def test_a_glb_of_another_export_is_told(probe: Probe, tmp_path: Path) -> None:
    code, told = probe("load", altered(tmp_path, glb=lambda b: b + bytes(4)))
    assert code == 0 and "'stick.glb' is not the GLB that this JSON was written with" in told
    assert probe("load", altered(tmp_path))[1] == ""


def test_actions_of_a_clip_that_is_missing_show_their_stance(probe: Probe, tmp_path: Path) -> None:
    project = read_export(STICK / "stick.json")
    plan = hear_asks(project, Plan(3, 0.0), 0.0, [], 60.0)
    lost = [plan.layers["arms"].cues[0].action.clip, plan.layers["body"].rests[0].action.clip]

    def rename(document: Any) -> None:
        for clip in document["clips"]:
            if clip["id"] in lost:
                clip["name"] += " (lost)"

    path = altered(tmp_path, rename)
    told = probe("load", path)[1].splitlines()
    assert len(told) == 2
    assert all("lacks clip" in line for line in told)
    times = [x / 4 for x in range(0, 240, 3)]
    _, posed = probe("poses", path, json.dumps({"seed": 3, "end": 60.0, "times": times, "alive": False}))
    clips = {k: replace(c, motion=None) if k in lost else c for k, c in project.clips.items()}
    without = replace(project, clips=clips)
    for time, line in zip(times, posed.splitlines(), strict=True):
        rotations, translations = (np.array(x) for x in json.loads(line))
        pose = pose_at(plan, without, time, alive=False)
        assert (
            np.degrees(rotation.measure_angle_between(rotations.reshape(-1, 4), pose.rotations)).max() < 0.05
        )
        assert np.abs(translations.reshape(-1, 3) - pose.translations).max() < 1e-4


# --- live


def live(probe: Probe, tmp_path: Path, steps: list[Any]) -> dict[str, list[Any]]:
    """Return what a live character printed, by what it is; requests may be data or texts."""
    texts = [[now, [ask if isinstance(ask, str) else json.dumps(ask) for ask in asks]] for now, asks in steps]
    (tmp_path / "steps.json").write_text(json.dumps(texts))
    code, told = probe("live", STICK / "stick.json", tmp_path / "steps.json")
    assert code == 0, told
    out: dict[str, list[Any]] = {"event": [], "answer": [], "cue": [], "now": []}
    for line in told.splitlines():
        kind, *values = json.loads(line)
        out[kind].append(values)
    return out


def test_a_character_plans_what_the_library_hears(probe: Probe, tmp_path: Path) -> None:
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


def test_what_begins_ends_and_is_told_once(probe: Probe, tmp_path: Path) -> None:
    found = live(
        probe,
        tmp_path,
        [
            [n * 0.3, [{"do": "gesture", "id": "a"}, {"do": "say", "text": "hi there"}] if n == 2 else []]
            for n in range(90)
        ],
    )
    times = [at for *_, at in found["event"]]
    assert times == sorted(times)
    begun = [(layer, meta, action) for kind, layer, action, meta, _ in found["event"] if kind == "begin"]
    ended = [(layer, meta, action) for kind, layer, action, meta, _ in found["event"] if kind == "end"]
    assert len(begun) - len(ended) in range(4)  # at most one of each layer still plays
    assert begun[: len(ended) - 4] == ended[: len(ended) - 4] or sorted(ended) == sorted(
        b for b in begun if b in ended
    )
    assert [x for x in begun if x[1] == "a"]
    assert [x[2] for x in begun if x[0] == "speech"] == ["hi there"]


@pytest.fixture(scope="module")
def refusals(probe: Probe, tmp_path_factory: pytest.TempPathFactory) -> list[Any]:
    """What became of every senseless request; asked for all at once, since each start of the program takes a
    while.
    """
    found = live(probe, tmp_path_factory.mktemp("refusals"), [[0, SENSELESS], [0.1, []], [40, []]])
    assert found["now"] == [[40.0]]
    return found["answer"]


@pytest.mark.parametrize("number", range(len(SENSELESS)), ids=lambda n: json.dumps(SENSELESS[n])[:40])
def test_requests_that_make_no_sense_are_refused_with_a_reason(refusals: list[Any], number: int) -> None:
    _, state, at, until, why = refusals[number]
    assert (state, at, until) == ("refused", None, None)
    assert why


def test_time_never_goes_backwards(probe: Probe, tmp_path: Path) -> None:
    assert live(probe, tmp_path, [[5, []], [2, []], [-1, []], [5.5, []], [0, []]])["now"] == [[5.5]]


@pytest.mark.nightly
def test_no_frame_makes_garbage(probe: Probe) -> None:
    done = mono(probe.path, "garbage", STICK / "stick.json", MONO_GC_PARAMS="nursery-size=512k")
    assert (done.returncode, done.stdout.strip()) == (0, "0"), done.stdout + done.stderr
