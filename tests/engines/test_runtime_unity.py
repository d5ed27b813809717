"""The C# runtime: it conforms, refuses what is wrong as it says, fits Unity's types, and its conformance
vectors would notice.
"""

from __future__ import annotations

import base64
import json
import os
import shutil
import struct
import subprocess
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from metagraph.engines.reading import read_export
from metagraph.graph.model import LAYERS
from metagraph.graph.requests import request_from
from metagraph.motion import rotation
from metagraph.playback.extend_performance import hear, since
from metagraph.playback.life.voice import voice_from_text
from metagraph.playback.plan import Plan
from metagraph.playback.player import pose_at
from tests.engines.mutants import PLAYED, broken, folders_to_try
from tests.processes import Answering, started
from tests.thorough import some

ROOT = Path(__file__).resolve().parents[2]
RUNTIME = ROOT / "metagraph" / "engines" / "runtimes" / "unity"
VECTORS = sorted(p.parent for p in (ROOT / "metagraph" / "engines" / "conformance").glob("*/vectors.json"))
STICK = ROOT / "metagraph" / "engines" / "conformance" / "stick"
CORE = sorted((RUNTIME / "Core").rglob("*.cs"))

pytestmark = pytest.mark.skipif(
    shutil.which("mcs") is None or shutil.which("mono") is None,
    reason="needs Mono's compiler and runtime (mcs, mono)",
)


def compiled(out: Path, *sources: Path, references: tuple[Path, ...] = ()) -> Path:
    """Compile sources, warnings as errors, at a language level that every Unity since 2019 has."""
    kind = "library" if out.suffix == ".dll" else "exe"
    command = [
        "mcs",
        "-langversion:7.2",
        "-warn:4",
        "-warnaserror",
        "-optimize",
        f"-target:{kind}",
        f"-out:{out}",
    ]
    done = subprocess.run(
        [*command, *(f"-r:{r}" for r in references), *map(str, sources)],
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return out


def mono(program: Path, *arguments: object, **environment: str) -> subprocess.CompletedProcess[str]:
    """Run a program in a process of its own."""
    return subprocess.run(
        ["mono", str(program), *map(str, arguments)],
        capture_output=True, text=True, timeout=300, check=False, env={**os.environ, **environment},
    )  # fmt: skip


class Host:
    """One process that compiles and runs programs, each many times as fast as on its own."""

    def __init__(self, process: subprocess.Popen[str]) -> None:
        self._host = Answering(process, 300)

    def _ask(self, *words: object) -> tuple[int, str]:
        code, said = self._host.ask("\t".join(map(str, words))).split("\t")
        return int(code), base64.b64decode(said).decode()

    def compile(self, out: Path, *sources: Path) -> None:
        """Compile a program. Raises AssertionError with what the compiler says where it cannot."""
        code, said = self._ask(
            "compile", "-langversion:7.2", "-warn:0", "-target:exe", f"-out:{out}", *sources
        )
        assert code == 0, said

    def run(self, program: Path, *arguments: object) -> tuple[int, str]:
        """Return a program's exit code, -1 for an exception, and what it printed. Programs need names of
        their own.
        """
        return self._ask("run", program, *arguments)


@pytest.fixture(scope="module")
def host(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Host]:
    program = compiled(
        tmp_path_factory.mktemp("host") / "host.exe", Path(__file__).parent / "run" / "Host.cs"
    )
    with started("mono", program, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as process:
        yield Host(process)


class Probe:
    """A program that uses the runtime, kept running."""

    def __init__(self, host: Host, path: Path) -> None:
        self.host, self.path = host, path

    def __call__(self, *arguments: object) -> tuple[int, str]:
        return self.host.run(self.path, *arguments)


@pytest.fixture(scope="module")
def core(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return compiled(tmp_path_factory.mktemp("unity") / "metagraph.dll", *CORE)


@pytest.fixture(scope="module")
def conformance(core: Path) -> Path:
    return compiled(
        core.with_name("conformance.exe"), RUNTIME / "Conformance" / "Conformance.cs", references=(core,)
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
def test_the_runtime_agrees_with_the_vectors(conformance: Path, folder: Path) -> None:
    done = mono(conformance, folder)
    assert done.returncode == 0, done.stdout[:2000] + done.stderr[:2000]


def test_the_runtime_agrees_with_the_sample_project(conformance: Path, sample_export: Path) -> None:
    done = mono(conformance, sample_export)
    assert done.returncode == 0, done.stdout[:2000] + done.stderr[:2000]


def test_the_culture_of_the_machine_does_not_matter(conformance: Path) -> None:
    assert mono(conformance, STICK, LANG="tr_TR.UTF-8", LC_ALL="tr_TR.UTF-8").returncode == 0


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
        voice = voice_from_text(text, 2.5)
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


def test_actions_of_a_clip_that_is_missing_show_their_stance(probe: Probe, tmp_path: Path) -> None:
    project = read_export(STICK / "stick.json")
    plan = hear(project, Plan(3, 0.0), 0.0, [], 60.0)
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
        assert np.degrees(rotation.angle_between(rotations.reshape(-1, 4), pose.rotations)).max() < 0.05
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


ASKED: dict[int, list[dict[str, Any]]] = {
    0: [{"do": "gesture", "id": "a", "after": 1.0}],
    31: [
        {"do": "gesture", "id": "b", "layer": "head", "priority": 2},
        {"do": "say", "id": "c", "text": "and now for something else"},
    ],
    90: [
        {"do": "look", "id": "d", "to": [1, 1.5, 1], "duration": 2},
        {"do": "gesture", "id": "e", "after": 30.0},
    ],
    130: [
        {"do": "withdraw", "id": "f", "what": "e"},
        {"do": "gesture", "id": "b", "layer": "arms", "at": 20},
    ],
    300: [{"do": "change", "id": "g", "layer": "arms"}, {"do": "blink", "id": "h"}],
}


def test_a_character_plans_what_the_library_hears(probe: Probe, tmp_path: Path) -> None:
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


SENSELESS: list[Any] = [
    "",
    "null",
    "[]",
    "7",
    "{",
    '{"do":"gesture"} x',
    "[" * 9000,
    '{"do":"gesture","id":"\\ud800"}',
    {},
    {"do": 1},
    {"do": "dance"},
    {"do": "gesture", "layer": "legs"},
    {"do": "gesture", "layer": None},
    {"do": "gesture", "tags": "positive"},
    {"do": "gesture", "tags": [1]},
    {"do": "gesture", "mood": 1},
    {"do": "gesture", "priority": 1.5},
    {"do": "gesture", "priority": 1001},
    {"do": "gesture", "at": True},
    {"do": "gesture", "at": -1},
    {"do": "gesture", "at": 1e7},
    {"do": "gesture", "hold": 601},
    {"do": "gesture", "prepare": 1},
    {"do": "gesture", "after": "soon"},
    {"do": "gesture", "after": -1},
    {"do": "gesture", "id": "x" * 201},
    {"do": "action"},
    {"do": "action", "action": "juggle"},
    {"do": "action", "action": ""},
    {"do": "stance", "stance": "lotus"},
    {"do": "stance"},
    {"do": "look", "to": [1, 2]},
    {"do": "look", "to": ""},
    {"do": "look", "amount": 2},
    {"do": "say"},
    {"do": "say", "line": "no such line"},
    {"do": "say", "line": 1.5},
    {"do": "mode", "mode": "angry"},
    {"do": "place", "name": "door"},
    {"do": "place", "name": "door", "point": [0, 0, None]},
    {"do": "withdraw", "what": None},
    {"do": "nod", "tags": ["no such tag"]},
    {"do": "gesture", "tags": ["no such tag"]},
    {"do": "bml", "bml": "<bml/>"},
]


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


def test_no_frame_makes_garbage(probe: Probe) -> None:
    done = mono(probe.path, "garbage", STICK / "stick.json", MONO_GC_PARAMS="nursery-size=512k")
    assert (done.returncode, done.stdout.strip()) == (0, "0"), done.stdout + done.stderr


# --- Unity: compiled against its types by name, and moved by hand; never run in the engine itself

ENGINE = r"""
using System;
using System.Collections.Generic;

namespace UnityEngine
{
    public struct Vector3 { public float x, y, z; public Vector3(float x, float y, float z) { this.x = x; this.y = y; this.z = z; } }
    public struct Quaternion
    {
        public float x, y, z, w;
        public Quaternion(float x, float y, float z, float w) { this.x = x; this.y = y; this.z = z; this.w = w; }
    }
    public class Object
    {
        public string name = "";
        public static bool operator ==(Object a, Object b) { return ReferenceEquals(a, b); }
        public static bool operator !=(Object a, Object b) { return !ReferenceEquals(a, b); }
        public override bool Equals(object other) { return ReferenceEquals(this, other); }
        public override int GetHashCode() { return 0; }
    }
    public class TextAsset : Object { public string text = ""; public byte[] bytes = new byte[0]; }
    public class Mesh : Object
    {
        public List<string> shapes = new List<string>();
        public int GetBlendShapeIndex(string name) { return shapes.IndexOf(name); }
        public int GetBlendShapeFrameCount(int shape) { return 1; }
        public float GetBlendShapeFrameWeight(int shape, int frame) { return 100f; }
    }
    public class Component : Object
    {
        public static List<Component> all = new List<Component>();
        public Transform transform;
        public T[] GetComponentsInChildren<T>(bool inactive) { return all.FindAll(c => c is T).ConvertAll(c => (T)(object)c).ToArray(); }
    }
    public class Transform : Component
    {
        public Quaternion localRotation;
        public Vector3 localPosition;
        public Vector3 InverseTransformPoint(Vector3 world) { return world; }
    }
    public class SkinnedMeshRenderer : Component
    {
        public Mesh sharedMesh;
        public Dictionary<int, float> weights = new Dictionary<int, float>();
        public void SetBlendShapeWeight(int index, float value) { weights[index] = value; }
    }
    public class Behaviour : Component { public bool enabled = true; }
    public class MonoBehaviour : Behaviour { }
    public static class Time { public static float deltaTime; }
    public static class Application { public static string streamingAssetsPath = ""; }
    public static class Debug
    {
        public static void Log(object message) { Console.WriteLine(message); }
        public static void LogWarning(object message, Object context) { Console.WriteLine("warning: " + message); }
        public static void LogError(object message, Object context) { Console.WriteLine("error: " + message); }
    }
    public sealed class TooltipAttribute : Attribute { public TooltipAttribute(string text) { } }
    public enum RuntimeInitializeLoadType { SubsystemRegistration }
    public sealed class RuntimeInitializeOnLoadMethodAttribute : Attribute
    {
        public RuntimeInitializeOnLoadMethodAttribute(RuntimeInitializeLoadType when) { }
    }
    public sealed class DisallowMultipleComponent : Attribute { }
    public sealed class AddComponentMenu : Attribute { public AddComponentMenu(string name) { } }
}

namespace UnityEngine.Events
{
    public abstract class UnityEvent<A, B, C>
    {
        private Action<A, B, C> listeners = (a, b, c) => { };
        public void AddListener(Action<A, B, C> listener) { listeners += listener; }
        public void Invoke(A a, B b, C c) { listeners(a, b, c); }
    }
}
"""

SCENE = r"""
using System;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Reflection;
using Metagraph;
using UnityEngine;

public static class Scene
{
    public static void Main(string[] args)
    {
        var actor = new MetagraphCharacter { seed = 3, transform = new Transform() };
        if (args.Length > 0)
        {
            actor.export = new TextAsset { name = "stick", text = File.ReadAllText(args[0] + ".json") };
            actor.glb = new TextAsset { bytes = File.ReadAllBytes(args[0] + ".glb") };
        }
        Graph graph = args.Length > 0 ? Graph.Load(actor.export.text, actor.glb.bytes) : null;
        foreach (JointInfo joint in graph != null ? graph.Joints : new JointInfo[0])
        {
            Component.all.Add(new Transform { name = joint.Name });
        }
        Component.all.Add(new SkinnedMeshRenderer { sharedMesh = new Mesh() });
        actor.begin.AddListener((layer, action, meta) => Console.WriteLine("begin " + layer + " " + meta));
        Call(actor, "Awake");
        Call(actor, "LateUpdate");
        string id = actor.Gesture("no such tag");
        string[] asked =
        {
            actor.Gesture(), actor.Look(new Vector3(1, 1.5f, 2)), actor.Place("door", new Vector3(1, 1, 1)), actor.Look("door"),
            actor.Say("a \"few\" words\n"), actor.Go("nowhere"), actor.Ask("nonsense"),
        };
        for (int frame = 0; frame < 150; frame++)
        {
            Time.deltaTime = 0.02f;
            Call(actor, "LateUpdate");
        }
        Answer unknown = actor.AnswerTo(id);
        Console.WriteLine("pieces " + actor.SayPiece("Hello").Count + " " + string.Join(" ", actor.SayPiece(" there! No", true).ToArray()));
        actor.gestures = false;
        Console.WriteLine("plain " + (actor.Say("Hello there!") ?? "nothing"));
        if (graph == null)
        {
            Console.WriteLine(actor.enabled + " " + (id ?? "nothing") + " " + (unknown == null ? "nothing" : unknown.State));
            return;
        }
        Console.WriteLine(string.Join(" ", asked.Select(one => actor.AnswerTo(one).State).ToArray()));
        Console.WriteLine(actor.Character.Plan.Track.Looks[0].To.Point[0]);
        // Forward kinematics by what Unity shows; mirrored, it must be where the pose is.
        var positions = new double[3 * graph.Joints.Length];
        actor.Character.Pose().Positions(graph, positions);
        var turned = new Quat[graph.Joints.Length];
        var at = new Vec[turned.Length];
        double far = 0;
        for (int j = 0; j < turned.Length; j++)
        {
            var shown = (Transform)Component.all[j];
            int parent = graph.Joints[j].Parent;
            Quat above = parent < 0 ? Quat.Identity : turned[parent];
            Quaternion q = shown.localRotation;
            turned[j] = above * new Quat(q.x, q.y, q.z, q.w);
            at[j] = above.Rotate(new Vec(shown.localPosition.x, shown.localPosition.y, shown.localPosition.z));
            at[j] = parent < 0 ? at[j] : at[j] + at[parent];
            Vec apart = at[j] - new Vec(-positions[3 * j], positions[3 * j + 1], positions[3 * j + 2]);
            far = Math.Max(far, Math.Sqrt(Vec.Dot(apart, apart)));
        }
        Console.WriteLine(far < 1e-5 ? "mirrored" : "apart by " + far.ToString(CultureInfo.InvariantCulture));
    }

    private static void Call(object actor, string method)
    {
        actor.GetType().GetMethod(method, BindingFlags.Instance | BindingFlags.NonPublic).Invoke(actor, null);
    }
}
"""


@pytest.fixture(scope="module")
def scene(core: Path) -> Path:
    """The component, compiled against Unity's names, and a program that does to it what the engine would."""
    engine, program = core.with_name("engine.cs"), core.with_name("scene.cs")
    engine.write_text(ENGINE)
    program.write_text(SCENE)
    types = compiled(core.with_name("UnityEngine.dll"), engine)
    component = compiled(
        core.with_name("component.dll"), RUNTIME / "Unity" / "MetagraphCharacter.cs", references=(core, types)
    )
    return compiled(core.with_name("scene.exe"), program, references=(core, types, component))


def test_the_component_moves_joints_as_unity_shows_them(scene: Path) -> None:
    done = mono(scene, STICK / "stick")
    assert done.returncode == 0, done.stdout + done.stderr
    lines = done.stdout.splitlines()
    states = lines[-3].split()
    assert set(states[:5]) <= {"planned", "late", "done"}
    assert states[5:] == ["refused", "refused"]
    assert float(lines[-2]) == -1  # to the right in Unity is to the left in glTF
    assert lines[-1] == "mirrored"
    assert any(line.startswith("begin arms") for line in lines)
    assert "pieces 0 said#2 said#3" in lines, "said#1 was said whole; a sentence is said once it is whole"
    assert any(line.startswith("plain #") for line in lines), "without gestures it is a request as any other"


def test_a_component_without_its_files_says_so_and_stays_quiet(scene: Path) -> None:
    done = mono(scene)
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.startswith("error: ")
    assert done.stdout.splitlines()[-3:] == ["pieces 0 ", "plain nothing", "False nothing nothing"]


SHARING = r"""
using System;
using System.IO;
using System.Reflection;
using Metagraph;
using UnityEngine;

public static class Sharing
{
    private static TextAsset text, bytes;

    private static MetagraphCharacter Made(TextAsset glb)
    {
        var actor = new MetagraphCharacter { seed = 3, transform = new Transform(), export = text, glb = glb };
        Call(actor, "Awake");
        return actor;
    }

    private static void Call(MetagraphCharacter actor, string name)
    {
        BindingFlags any = BindingFlags.Instance | BindingFlags.Static | BindingFlags.NonPublic;
        typeof(MetagraphCharacter).GetMethod(name, any).Invoke(actor, null);
    }

    public static void Main(string[] args)
    {
        text = new TextAsset { name = "stick", text = File.ReadAllText(args[0] + ".json") };
        bytes = new TextAsset { bytes = File.ReadAllBytes(args[0] + ".glb") };
        MetagraphCharacter broken = Made(new TextAsset { bytes = new byte[3] });
        MetagraphCharacter first = Made(bytes), second = Made(bytes), other = Made(new TextAsset { bytes = bytes.bytes });
        Console.WriteLine(broken.Character == null);
        Console.WriteLine(ReferenceEquals(first.Character.Graph, second.Character.Graph));
        Console.WriteLine(ReferenceEquals(first.Character.Graph, other.Character.Graph));
        Console.WriteLine(ReferenceEquals(first.Character, second.Character));
        Call(null, "Forget");
        Console.WriteLine(ReferenceEquals(first.Character.Graph, Made(bytes).Character.Graph));
        GC.KeepAlive(first);
    }
}
"""


def test_characters_of_the_same_assets_read_them_once(scene: Path) -> None:
    source = scene.with_name("sharing.cs")
    source.write_text(SHARING)
    references = tuple(
        scene.with_name(name) for name in ("metagraph.dll", "UnityEngine.dll", "component.dll")
    )
    program = compiled(scene.with_name("sharing.exe"), source, references=references)
    done = subprocess.run(
        ["mono", str(program), str(STICK / "stick")], capture_output=True, text=True, timeout=60, check=False
    )
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    broken, shared, other, one, after = (line == "True" for line in lines if line in ("True", "False"))
    assert broken and shared and not (other or one or after)
    assert sum(line.startswith("error") for line in lines) == 1


def test_what_the_readme_shows_compiles(scene: Path) -> None:
    shown = [block.split("```")[0] for block in (RUNTIME / "README.md").read_text().split("```csharp")[1:]]
    assert len(shown) == 5
    source = scene.with_name("readme.cs")
    inner = (
        "public static class Shown { public static void Main() { float seconds = 0; "
        + shown[1]
        + shown[2]
        + shown[3]
        + shown[4]
        + " System.Console.Write(pose); } }"
    )
    source.write_text("using UnityEngine; using System.IO; using Metagraph;\n" + shown[0] + inner)
    references = tuple(
        scene.with_name(name) for name in ("metagraph.dll", "UnityEngine.dll", "component.dll")
    )
    compiled(scene.with_name("readme.exe"), source, references=references)


def test_the_package_is_one_that_unity_can_take() -> None:
    package = json.loads((RUNTIME / "package.json").read_bytes())
    assert package["unity"] == "2019.4"
    core, unity = (
        json.loads(next((RUNTIME / part).glob("*.asmdef")).read_bytes()) for part in ("Core", "Unity")
    )
    assert core["noEngineReferences"]
    assert unity["references"] == [core["name"]]
    assert not any("UnityEngine" in path.read_text() for path in CORE)


# --- the vectors

MUTATIONS = [
    ("Basics.cs", "x * x * (3 - 2 * x)", "x", "the blending curve"),
    (
        "Language.cs",
        "return unchecked(value * Prime); // the closing zero byte",
        "return value;",
        "the zero byte that closes a word",
    ),
    ("Language.cs", "value ^= value >> 13;", "value ^= value >> 12;", "the mixing"),
    (
        "Sampling.cs",
        "Math.Max(Count(a.Id, now), 1.0)",
        "(Count(a.Id, now) + 1.0)",
        "the count under a likelihood",
    ),
    ("Sampling.cs", "NeverTwice ? 1 : 0;", "NeverTwice ? 0 : 0;", "never the same twice"),
    (
        "Sampling.cs",
        "Math.Max(shape.Shortest, Math.Min(bound.Limit, wish) - shape.Start)",
        "shape.Length",
        "the earliest exit",
    ),
    (
        "CueShapes.cs",
        "(holdTo - holdFrom) / Hurry",
        "(holdTo - holdFrom)",
        "how short a hold can be",
    ),
    ("Sampling.cs", "Math.Min(1.0, length / (into + out_))", "1.0", "blends that must fit"),
    ("Sampling.cs", "a => a.Cooldown <= 0", "a => a.Cooldown <= 1e9", "cooling down"),
    ("Sampling.cs", "waits > Project.Settings.Wait", "waits > 1e9", "how long what was asked for waits"),
    ("Language.cs", "Basics.ThreeDecimals(number)", "Basics.Words(number)", "the decimals that key a loop"),
    (
        "Sampling.cs",
        "if (!exact.Any(a => !again.Contains(a.Id)))",
        "if (!exact.Any())",
        "models that do not repeat themselves",
    ),
    (
        "Planner.cs",
        "bool leaves = meta.Request.Kind",
        "bool leaves = meta.Part > 99 && meta.Request.Kind",
        "staying in a stance",
    ),
    ("Markov.cs", "return share >= 1 ||", "return share >= 0 ||", "modes of the models"),
    (
        "Sampling.cs",
        "if (least > allowed + CueShapesRules.Fits)",
        "if (least > allowed + 9)",
        "what is too late",
    ),
    ("Sampling.cs", "if (over.Count > 0)", "if (over.Count > 99)", "room for what follows"),
    ("Bounds.cs", "Math.Min(meta.Start, meta.Request.Start)", "meta.Start", "when what is judged begins"),
    (
        "Asks.cs",
        'case "late": Late = Seconds(name, value, 600);',
        'case "late":',
        "reading how late it may be",
    ),
    ("Plan.cs", "held * ((cue.HoldTo - cue.HoldFrom) / cue.Hold)", "held", "the stretch of a hold"),
    ("Replan.cs", "-meta.Request.Priority, meta", "0, meta", "priority at equal starts"),
    (
        "Replan.cs",
        "meta.Request.Id, meta.Part",
        '"", meta.Part',
        "ids at equal starts and priorities",
    ),
    ("Replan.cs", "kept ? last.Part + 1 : last.Part", "last.Part", "the key of a remainder"),
    ("Replan.cs", "var resumes = last.Request.Resume &&", "var resumes =", "what goes on after a cut"),
    ("Markov.cs", "0.35 + 1.3 *", "0.3 + 1.3 *", "the gap between what a model writes"),
    ("Hear.cs", "now + graph.Settings.Lookahead", "now", "the lookahead"),
    (
        "Hear.cs",
        "ForEach(cue => RememberingRules.Remember(cue, past.Uses, past.Recent, past.Ended))",
        "ForEach(cue => { })",
        "the uses of what was forgotten",
    ),
    (
        "Pose.cs",
        "composed[j] *= weight == 1 ? found.Turns[j] : found.Turns[j].Power(weight);",
        "composed[j] = (weight == 1 ? found.Turns[j] : found.Turns[j].Power(weight)) * composed[j];",
        "the order in which layers add",
    ),
    (
        "Pose.cs",
        "entering ? cue.Entry : cue.ClipSeconds(cue.End)",
        "cue.ClipSeconds(cue.End)",
        "the edge a clip is led in from",
    ),
    ("Pose.cs", "old = 1 - Basics.Ease(phase / seam);", "old = 0.0;", "the seam of a loop"),
    ("Clip.cs", "Basics.Clamp((time - keys[low]) / gap, 0, 1)", "0.0", "keys that were thinned out"),
    ("Loading.cs", "joint.Side == other", "joint.Side != other", "the arm that a gesture leaves alone"),
    (
        "Life/Gaze.cs",
        "private const double HeadLag = 0.04;",
        "private const double HeadLag = 0.0;",
        "a head that sets off later",
    ),
    (
        "Schedule.cs",
        "first ? shut + 0.1 : ScheduleRules.AfterBlink / Calm",
        "ScheduleRules.AfterBlink / Calm",
        "a blink at the first stressed syllable",
    ),
    ("Life/Solve.cs", "shut + blink * (1 - shut)", "shut + blink", "lids that meet and go no farther"),
    ("ToldTiming.cs", "Ticks = 1e7", "Ticks = 1e6", "what synthesisers count seconds in"),
    (
        "Items.cs",
        "LineTimingRules.Extended(old.Timing, new_.Timing, Math.Max(now - old.Start, 0.0))",
        "LineTimingRules.Extended(old.Timing, new_.Timing, 0.0)",
        "what has been said of a line stands",
    ),
    (
        "Mouth.cs",
        "public const double Early = 0.075",
        "public const double Early = 0.065",
        "mouths that are early",
    ),
]

# A case that notices each, tried first; the others follow where it does not.
NOTICED_BY = {
    "sparse: arms: holds and preparations": ["the stretch of a hold"],
    "sparse: arms: to stay": ["staying in a stance"],
    "sparse: asked in the past, at rest": ["ids at equal starts and priorities"],
    "sparse: cut": ["what goes on after a cut"],
    "sparse: cut again and again": ["priority at equal starts"],
    "sparse: cut and resumed": ["the key of a remainder"],
    "sparse: hashes": ["the zero byte that closes a word", "the mixing"],
    "sparse: interrupted live": ["cooling down", "the lookahead"],
    "sparse: much that is forgotten": ["the uses of what was forgotten"],
    "sparse: the arms begin in s6": ["the order in which layers add"],
    "sparse: the arms begin in s8": ["the gap between what a model writes"],
    "stick: blinks and modes": ["a head that sets off later", "lids that meet and go no farther"],
    "stick: interrupted live": ["never the same twice"],
    "varied: a queue": ["the earliest exit"],
    "varied: all withdrawn": ["models that do not repeat themselves"],
    "varied: arms: an action of another stance": ["blends that must fit", "the seam of a loop"],
    "varied: arms: fidgets": ["how long what was asked for waits"],
    "varied: arms: for a certain time": ["the count under a likelihood"],
    "varied: arms: holds and preparations": ["how short a hold can be"],
    "varied: beyond the end": ["the decimals that key a loop"],
    "varied: layers body": ["the blending curve", "the edge a clip is led in from"],
    "varied: no room": ["the arm that a gesture leaves alone"],
    "varied: no time at all": ["keys that were thinned out"],
    "varied: stressed syllables": ["a blink at the first stressed syllable", "mouths that are early"],
    "stick: arms: strokes that may not be late": ["room for what follows", "reading how late it may be"],
    "sparse: every shape of every set": ["what synthesisers count seconds in"],
    "stick: a line that is added to": ["what has been said of a line stands"],
    "sparse: arms: strokes that may not be late": ["when what is judged begins"],
    "stick: ties of start and priority": ["ids at equal starts and priorities"],
    "stick: body: strokes that may not be late": ["what is too late"],
}  # fmt: skip
HINTS = {about: case for case, noticed in NOTICED_BY.items() for about in noticed}
TRIED = some(MUTATIONS, 3)


def program_of(host: Host, out: Path, sources: list[Path]) -> Path:
    """Return a program of a runtime's sources and what runs the vectors."""
    host.compile(out, *sources, RUNTIME / "Conformance" / "Conformance.cs")
    return out


def test_every_rule_that_could_be_broken_stands_in_its_file_once() -> None:
    """Of those, one in three is broken here, and all where asked to be thorough."""
    for file, rule, instead, _ in MUTATIONS:
        broken(RUNTIME / "Core" / file, rule, instead)


def test_what_tries_mutants_finds_no_fault_with_what_is_whole(
    host: Host, single: Path, tmp_path: Path
) -> None:
    program = program_of(host, tmp_path / "whole.exe", CORE)
    hints = dict.fromkeys(HINTS[about] for *_, about in TRIED if about in HINTS)
    tried = [folder for hint in hints for folder in folders_to_try(hint, VECTORS, single)[:1]]
    code, told = host.run(program, *tried)
    assert code == 0, told[:2000]


@pytest.mark.parametrize(
    ("file", "rule", "instead", "about"), TRIED, ids=[m[3].replace(" ", "-") for m in TRIED]
)
def test_the_vectors_notice_when_a_rule_is_broken(
    host: Host, single: Path, tmp_path: Path, file: str, rule: str, instead: str, about: str
) -> None:
    path = RUNTIME / "Core" / file
    changed = tmp_path / path.name
    changed.write_text(broken(path, rule, instead), encoding="utf-8")
    number = [m[3] for m in MUTATIONS].index(about)
    program = program_of(
        host, tmp_path / f"mutant{number}.exe", [*(other for other in CORE if other != path), changed]
    )
    hinted = folders_to_try(HINTS.get(about), VECTORS, single)
    assert any(host.run(program, folder)[0] != 0 for folder in hinted), about
