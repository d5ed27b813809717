"""One game, four languages: the same script makes every runtime's character do, tell and show the same."""

from __future__ import annotations

import json
import math
import os
import shutil
import subprocess
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from metagraph import Character, engines
from metagraph.engines.script_sounds import list_streams
from metagraph.motion import rotation
from tests.engines.godot_runtime import install_addon

RUNTIMES = Path(engines.__file__).with_name("runtimes")
CONFORMANCE = Path(engines.__file__).with_name("conformance")
SEED, AHEAD, RECENT = 5, 20.0, 5.0  # a short memory, so that much is forgotten within the script
STEPS = (0.013, 0.047, 0.2, 0.111, 0.029)  # seconds between updates
FRAMES = 500
# more updates, quarters of a minute apart, after which it is asked for the first time again what happened
UNHEARD = 225
SHOWN = range(49, FRAMES, 50)  # frames at which answers, poses and morph targets are compared

ASKED: dict[int, list[Any]] = {
    0: [
        {"do": "gesture"},
        {"do": "look", "to": "door"},
        {"do": "say", "text": "Well, hello over there.", "after": 2.0, "at": 30},
    ],
    20: [
        {"do": "gesture", "id": "g", "tags": ["greeting"], "priority": 2},
        {"do": "fidget", "layer": "head"},
    ],
    45: [
        {"do": "dance"},
        {"do": "gesture", "after": -1},
        {"do": "gesture", "after": None},
        {"do": "gesture", "after": 1e9},
        {"do": "gesture", "layer": "legs", "id": "bad"},
        {"do": "gesture", "at": "soon"},
        "nod",
        None,
        [],
        3,
        {},
        {"do": "bml", "bml": "<bml/>"},
        {"do": "gesture", "id": "x" * 201},
        {"do": "action", "action": "no such"},
        {"do": "nod", "id": 7},
        {"do": "nod", "id": "", "after": 0.4},
    ],
    80: [{"do": "stance", "stance": "on hips", "stay": True, "id": "stay"}],
    90: [{"do": "fidget", "layer": "head", "id": "r", "duration": 9, "resume": True, "after": 1.5}],
    100: [{"do": "shake", "priority": 5, "after": 4}],
    130: [
        {"do": "say", "line": "hello", "id": "say"},
        {"do": "look", "to": "user", "duration": 1.5, "priority": 3},
    ],
    170: [{"do": "say", "text": "No, wait!"}],
    200: [
        {"do": "withdraw", "what": "g"},
        {"do": "withdraw", "what": "stay", "id": "w"},
        {"do": "gesture", "id": "g", "after": 1.5},
    ],
    260: [
        {"do": "mode", "mode": "listening"},
        {"do": "place", "name": "door", "point": [-1, 1.2, 1]},
        {"do": "blink"},
        {"do": "shake"},
        {"do": "gesture", "layer": "body", "id": "b", "resume": True, "duration": 6},
    ],
    300: [
        {"do": "gesture", "id": "later", "after": 25},
        {"do": "action", "action": "wave", "after": 2, "hold": 1},
    ],
    330: [{"do": "change"}, {"do": "action", "action": "shrug", "stroke": 30.5}],
    340: [{"do": "withdraw", "what": "later"}],
    360: [{"do": "gesture", "id": "g", "after": "x"}, {"do": "say", "line": 7, "id": "seven"}],
    400: [{"do": "gesture", "after": 3.0}, {"do": "withdraw"}],
    430: [
        {"do": "stance", "stance": "crossed"},
        {"do": "mode"},
        {"do": "say", "line": "hello", "gestures": False, "after": 1},
    ],
    455: [{"do": "say", "id": "told", "text": "We", "more": True}],
    456: [{"do": "say", "id": "told", "text": "ll, it", "more": True}, {"do": "gesture", "id": "told/1"}],
    457: [{"do": "say", "id": "told", "text": " rains all day long.", "more": True}],
    462: [{"do": "pause", "what": "told"}],
    466: [{"do": "say", "id": "told", "text": " Take a coat.", "more": True}],
    468: [{"do": "resume"}],
    480: [{"do": "interrupt", "what": "told", "id": "cut"}],
    485: [{"do": "say", "id": "told", "text": "Yes", "more": True}],
    498: [{"do": "finish"}],
}


# Frames before which a piece of a line's sound comes in, some of them two at once; one of no length.
HEARD: dict[int, list[tuple[str, int, int]]] = {
    352: [("voice", 0, 900)],
    353: [("voice", 900, 2100), ("voice", 2100, 2500)],
    354: [("voice", 2500, 2500)],
    355: [("voice", 2500, 5000)],
    357: [("voice", 5000, 7200)],
    380: [("behind", 0, 1200)],  # the next piece comes too late
    395: [("behind", 1200, 4800)],
}


@cache
def streaming() -> tuple[int, list[float]]:
    """Return the rate and the samples that pieces are cut from."""
    stream = list_streams()[1]
    return stream["rate"], [x / 128 for piece in stream["pieces"] for x in piece]


def sounds(frame: int) -> list[dict[str, Any]]:
    """Return what is streamed before a frame's update."""
    rate, whole = streaming()
    return [
        {"id": ident, "samples": whole[start:end], "rate": rate} for ident, start, end in HEARD.get(frame, ())
    ]


def script() -> list[dict[str, Any]]:
    """Return the steps: now (null for NaN), what is asked before that update, whether events are asked for
    and all is shown after it.
    """
    out: list[dict[str, Any]] = []
    now = 0.0
    for frame in range(FRAMES):
        told = {98: None, 151: now - 3.0}.get(frame, now)
        looks = (
            [{"do": "look", "to": "ahead" if frame % 2 else "door", "priority": frame % 3}]
            if frame % 13 == 12
            else []
        )
        out.append(
            {
                "now": told,
                "ask": [*ASKED.get(frame, []), *looks],
                "sounds": sounds(frame),
                "hear": frame % 7 == 6 or frame == FRAMES - 1,
                "show": frame in SHOWN,
            }
        )
        now += STEPS[frame % len(STEPS)]
    unheard = [
        {"now": now + 15.0 * n, "ask": [], "sounds": [], "hear": n == UNHEARD, "show": n == UNHEARD}
        for n in range(1, UNHEARD + 1)
    ]
    leap = {"now": 1e9, "ask": [], "sounds": [], "hear": True, "show": True}
    end = now + 15.0 * UNHEARD + 2 * 3600.0
    open_ = {"do": "say", "id": "open", "text": "Well", "more": True}  # nothing more of it comes
    rest = [
        {"now": end + 15.0 * n, "ask": [open_] * (n == 1), "sounds": [], "hear": True, "show": n == 7}
        for n in range(1, 8)
    ]
    return [*out, *unheard, leap, leap, *rest]


def in_python(export: Path, steps: list[dict[str, Any]], folder: Path) -> dict[str, Any]:
    character = Character(export, seed=SEED, ahead=AHEAD, recent=RECENT)
    out: dict[str, Any] = {"ids": [], "events": [], "shown": []}
    for step in steps:
        out["ids"] += [character.ask(request) for request in step["ask"]]
        out["ids"] += [character.say_sound(s["id"], s["samples"], s["rate"]) for s in step["sounds"]]
        character.update(math.nan if step["now"] is None else step["now"])
        if step["hear"]:
            events = character.events()
            out["events"] += [[e.kind, e.at, e.layer, e.action, f"{e.meta} {e.reason}"] for e in events]
        if step["show"]:
            answers = [character.answer(ident) for ident in [*out["ids"], "nobody"]]
            pose = character.pose()
            shown = {
                "now": character.now,
                "spoken": list(character.spoken("told")),
                "answers": [[a.state, a.at, a.until, list(a.what), bool(a.why)] for a in answers],
            }
            shown |= {
                "rotations": pose.rotations.tolist(),
                "positions": character.project.skeleton.globals(pose)[1].tolist(),
            }
            out["shown"].append(shown | {"morphs": character.morphs()})
    return out


JAVASCRIPT = r"""
import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";
const [runtime, file, stepsFile, seed, ahead, recent] = process.argv.slice(2);
const { Character, load } = await import(pathToFileURL(`${runtime}/index.js`));
const { positions } = await import(pathToFileURL(`${runtime}/rotation.js`));
const graph = load(readFileSync(file, "utf8"), readFileSync(file.replace(".json", ".glb")));
const character = new Character(graph, { seed: +seed, ahead: +ahead, recent: +recent });
const out = { ids: [], events: [], shown: [] };
const rows = (flat, n) => graph.joints.map((_, j) => [...flat.subarray(n * j, n * j + n)]);
for (const step of JSON.parse(readFileSync(stepsFile, "utf8"))) {
  for (const request of step.ask) out.ids.push(character.ask(request));
  for (const { id, samples, rate } of step.sounds) out.ids.push(character.saySound(id, samples, rate));
  character.update(step.now ?? NaN);
  if (step.hear) for (const e of character.events()) out.events.push([e.kind, e.at, e.layer, e.action, `${e.meta} ${e.reason}`]);
  if (!step.show) continue;
  const { rotations, translations } = character.pose();
  out.shown.push({
    now: character.now,
    spoken: Object.values(character.spoken("told")),
    answers: [...out.ids, "nobody"].map((id) => character.answer(id)).map((a) => [a.state, a.at, a.until, a.what, a.why !== ""]),
    rotations: rows(rotations, 4),
    positions: rows(positions(graph.parents, rotations, translations), 3),
    morphs: Object.fromEntries([...character.morphs()].map((weight, n) => [graph.morphs[n], weight])),
  });
}
console.log(JSON.stringify(out));
"""


def in_javascript(export: Path, steps: list[dict[str, Any]], folder: Path) -> dict[str, Any]:
    (folder / "game.mjs").write_text(JAVASCRIPT)
    command = [
        "node",
        str(folder / "game.mjs"),
        str(RUNTIMES / "javascript"),
        str(export),
        str(folder / "steps.json"),
    ]
    return told([*command, str(SEED), str(AHEAD), str(RECENT)])


CSHARP = r"""
using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using Metagraph;

public static class Game
{
    private static string Of(object value)
    {
        if (value is double[]) { return Of(((double[])value).Cast<object>()); }
        if (value is float[]) { return Of(((float[])value).Select(x => (object)(double)x)); }
        if (value is double) { return ((double)value).ToString("R", CultureInfo.InvariantCulture); }
        if (value is string) { return Json.Quote((string)value); }
        if (value is bool) { return (bool)value ? "true" : "false"; }
        if (value is IEnumerable<object>) { return "[" + string.Join(",", ((IEnumerable<object>)value).Select(Of).ToArray()) + "]"; }
        var fields = value as JsonObject;
        if (fields == null) { return "null"; }
        return "{" + string.Join(",", fields.Names.Select(n => Json.Quote(n) + ":" + Of(fields[n])).ToArray()) + "}";
    }

    private static IEnumerable<object> Rows(double[] flat, int n)
    {
        return Enumerable.Range(0, flat.Length / n).Select(j => (object)flat.Skip(n * j).Take(n).ToArray());
    }

    private static double[] Doubles(float[] flat) { return flat.Select(x => (double)x).ToArray(); }

    public static void Main(string[] args)
    {
        Graph graph = Graph.Load(File.ReadAllText(args[0]), File.ReadAllBytes(args[0].Replace(".json", ".glb")));
        double ahead = double.Parse(args[3], CultureInfo.InvariantCulture), recent = double.Parse(args[4], CultureInfo.InvariantCulture);
        var character = new Character(graph, new CharacterOptions { Seed = uint.Parse(args[2]), Ahead = ahead, Recent = recent });
        var ids = new List<object>();
        var events = new List<object>();
        var shown = new List<object>();
        foreach (JsonObject step in (List<object>)Json.Parse(File.ReadAllText(args[1])))
        {
            foreach (object request in (List<object>)step["ask"]) { ids.Add(character.Ask(request as string)); }
            foreach (JsonObject sound in (List<object>)step["sounds"])
            {
                IEnumerable<float> samples = ((List<object>)sound["samples"]).Select(x => (float)Convert.ToDouble(x, CultureInfo.InvariantCulture));
                ids.Add(character.SaySound((string)sound["id"], samples, Convert.ToDouble(sound["rate"], CultureInfo.InvariantCulture)));
            }
            character.Update(step["now"] == null ? double.NaN : Convert.ToDouble(step["now"], CultureInfo.InvariantCulture));
            if ((bool)step["hear"])
            {
                events.AddRange(character.Events().Select(e => (object)new object[] { e.Kind, e.At, e.Layer, e.Action, e.Meta + " " + e.Reason }));
            }
            if (!(bool)step["show"]) { continue; }
            var one = new JsonObject();
            one["now"] = character.Now;
            string text, word;
            character.Spoken("told", out text, out word);
            one["spoken"] = new object[] { text, word };
            one["answers"] = ids.Concat(new object[] { "nobody" }).Select(id => character.AnswerTo((string)id))
                .Select(a => (object)new object[] { a.State, a.At, a.Until, a.What, a.Why != "" }).ToArray();
            BodyPose pose = character.Pose();
            var positions = new double[3 * graph.Joints.Length];
            pose.Positions(graph, positions);
            one["rotations"] = Rows(Doubles(pose.Rotations), 4);
            one["positions"] = Rows(positions, 3);
            var morphs = new JsonObject();
            for (int n = 0; n < graph.Morphs.Count; n++) { morphs[graph.Morphs[n]] = (double)pose.Morphs[n]; }
            one["morphs"] = morphs;
            shown.Add(one);
        }
        var found = new JsonObject();
        found["ids"] = ids;
        found["events"] = events;
        found["shown"] = shown;
        Console.WriteLine(Of(found));
    }
}
"""


def in_csharp(export: Path, steps: list[dict[str, Any]], folder: Path) -> dict[str, Any]:
    texts = [step | {"ask": [json.dumps(request) for request in step["ask"]]} for step in steps]
    (folder / "texts.json").write_text(json.dumps(texts))
    (folder / "game.cs").write_text(CSHARP)
    sources = [folder / "game.cs", *sorted((RUNTIMES / "unity" / "Runtime" / "Core").rglob("*.cs"))]
    command = ["mcs", "-optimize", f"-out:{folder / 'game.exe'}", *map(str, sources)]
    made = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert made.returncode == 0, made.stdout + made.stderr
    return told(
        [
            "mono",
            str(folder / "game.exe"),
            str(export),
            str(folder / "texts.json"),
            str(SEED),
            str(AHEAD),
            str(RECENT),
        ]
    )


GODOT = """extends SceneTree
const Graph = preload("res://addons/metagraph/core/graph.gd")
const Character = preload("res://addons/metagraph/core/character.gd")
const Pose = preload("res://addons/metagraph/core/pose.gd")
const Shim = preload("res://addons/metagraph/core/shim3.gd")

func _init():
	var args = parse_json(Shim.text_of(Shim.read_bytes("res://args.json")))
	var json = args.export
	var graph = Graph.new(Shim.text_of(Shim.read_bytes(json)), Shim.read_bytes(json.replace(".json", ".glb")))
	var character = Character.new(graph, args.options)
	var out = {ids = [], events = [], shown = []}
	for step in args.steps:
		for request in step.ask:
			out.ids.append(character.ask(request))
		for sound in step.sounds:
			out.ids.append(character.say_sound(sound.id, sound.samples, sound.rate))
		character.update(NAN if step.now == null else step.now)
		if step.hear:
			for e in character.events():
				out.events.append([e.kind, e.at, e.layer, e.action, e.meta + " " + e.reason])
		if not step.show:
			continue
		var one = {now = character.now, spoken = character.spoken("told"), answers = [], rotations = [], positions = [], morphs = character.morphs()}
		for id in out.ids + ["nobody"]:
			var a = character.answer(id)
			one.answers.append([a.state, a.at, a.until, a.what, a.why != ""])
		for q in character.pose().rotations:
			one.rotations.append([q.x, q.y, q.z, q.w])
		for p in Pose.positions(graph, character.pose()):
			one.positions.append([p.x, p.y, p.z])
		out.shown.append(one)
	print("OUT " + to_json(out))
	quit()
"""


def in_godot(export: Path, steps: list[dict[str, Any]], folder: Path) -> dict[str, Any]:
    install_addon(folder)
    (folder / "project.godot").write_text('config_version=4\n\n[application]\n\nconfig/name="game"\n')
    (folder / "game.gd").write_text(GODOT)
    options = {"seed": SEED, "ahead": AHEAD, "recent": RECENT}
    (folder / "args.json").write_text(json.dumps({"export": str(export), "steps": steps, "options": options}))
    return told(
        ["godot3-server", "--no-window", "-s", "game.gd"],
        cwd=folder,
        env={**os.environ, "HOME": str(folder), "LC_ALL": "C.UTF-8"},
    )


def told(command: list[str], **more: Any) -> dict[str, Any]:
    """Run a command; return the JSON of its last line."""
    done = subprocess.run(
        command, capture_output=True, text=True, errors="replace", timeout=300, check=False, **more
    )
    assert done.returncode == 0 and "SCRIPT ERROR" not in done.stdout + done.stderr, (
        done.stdout + done.stderr
    )[-3000:]
    found: dict[str, Any] = json.loads(done.stdout.strip().splitlines()[-1].removeprefix("OUT "))
    return found


def stick(folder: Path) -> Path:
    return CONFORMANCE / "stick" / "stick.json"


def unlisted(folder: Path) -> Path:
    """A face of morph targets, in an export that does not list them: that it has them says its rig."""
    document = json.loads((CONFORMANCE / "varied" / "varied.json").read_bytes())
    document["face"]["morphs"] = []
    (folder / "varied.json").write_text(json.dumps(document))
    shutil.copy(CONFORMANCE / "varied" / "varied.glb", folder)
    return folder / "varied.json"


Made = tuple[Path, dict[str, Any]]


@pytest.fixture(scope="module", params=[stick, unlisted], ids=lambda make: make.__name__)
def wanted(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Made:
    """An export, and what Python's character makes of it."""
    folder = tmp_path_factory.mktemp("export")
    export = request.param(folder)
    return export, in_python(export, script(), folder)


@pytest.mark.nightly
def test_the_script_has_something_of_everything(wanted: Made) -> None:
    _, found = wanted
    states = {state for shown in found["shown"] for state, *_ in shown["answers"]}
    assert states == {"planned", "late", "refused", "done"}
    spoken = [e for e in found["events"] if e[2] == "speech" and e[4].startswith("voice ")]
    assert [e[0] for e in spoken] == ["begin", "end"] and 0.5 < spoken[1][1] - spoken[0][1] < 1.0
    ends = [e[4] for e in found["events"] if e[2] == "speech" and e[4].startswith("told ") and e[0] == "end"]
    assert ends == ["told ", "told interrupted", "told ", "told finished"]
    assert found["shown"][FRAMES // 50 - 1]["spoken"] == ["Yes", "Yes"]
    assert {layer for _, _, layer, _, _ in found["events"]} == {"body", "arms", "head", "speech"}
    assert found["ids"][:5] == ["#1", "#2", "#3", "#4", "g"]
    *times, heard, once, twice, last = [shown["now"] for shown in found["shown"]]
    assert (once, twice, last) == pytest.approx((heard + 3600, heard + 7200, heard + 7305))
    forgotten = [e for e in found["events"] if e[4] == "open finished"]
    assert [(e[0], twice + 60 < e[1] < last) for e in forgotten] == [("end", True)]
    told = [event[1] for event in found["events"]]
    assert told == sorted(told)
    assert sum(times[-1] < at <= heard for at in told) == 1000, "the latest are kept, and no more"
    assert sum(heard < at <= once for at in told) > 5, "what a leap has passed over is told"


needs_node = pytest.mark.skipif(shutil.which("node") is None, reason="needs Node 18 or newer")
needs_mono = pytest.mark.skipif(
    shutil.which("mcs") is None or shutil.which("mono") is None,
    reason="needs Mono's compiler and runtime (mcs, mono)",
)
needs_godot = pytest.mark.skipif(
    shutil.which("godot3-server") is None, reason="needs Godot 3 (godot3-server)"
)


@pytest.mark.nightly
@pytest.mark.parametrize(
    "play",
    [
        pytest.param(in_javascript, marks=needs_node, id="javascript"),
        pytest.param(in_csharp, marks=needs_mono, id="csharp"),
        pytest.param(in_godot, marks=needs_godot, id="godot"),
    ],
)
def test_a_character_is_the_same_in_every_language(
    wanted: Made, play: Callable[[Path, list[dict[str, Any]], Path], dict[str, Any]], tmp_path: Path
) -> None:
    export, python = wanted
    (tmp_path / "steps.json").write_text(json.dumps(script()))
    found = play(export, script(), tmp_path)
    assert found["ids"] == python["ids"]
    for ours, theirs in zip(python["shown"], found["shown"], strict=True):
        assert theirs["now"] == pytest.approx(ours["now"], abs=1e-6)
        assert theirs["spoken"] == ours["spoken"]
        for number, (mine, other) in enumerate(zip(ours["answers"], theirs["answers"], strict=True)):
            asked = [*python["ids"], "nobody"][number], ours["now"]
            assert [mine[0], *mine[3:]] == [other[0], *other[3:]], asked
            assert [x is None for x in mine[1:3]] == [x is None for x in other[1:3]], asked
            assert [x or 0.0 for x in mine[1:3]] == pytest.approx([x or 0.0 for x in other[1:3]], abs=1e-6), (
                asked
            )
        turned = rotation.measure_angle_between(np.array(ours["rotations"]), np.array(theirs["rotations"]))
        assert np.degrees(turned).max() < 0.05
        assert np.abs(np.array(ours["positions"]) - np.array(theirs["positions"])).max() < 1e-4
        for name in ours["morphs"].keys() | theirs["morphs"].keys():
            assert ours["morphs"].get(name, 0.0) == pytest.approx(
                theirs["morphs"].get(name, 0.0), abs=1e-3
            ), name
    assert [[e[0], *e[2:]] for e in python["events"]] == [[e[0], *e[2:]] for e in found["events"]]
    assert [e[1] for e in python["events"]] == pytest.approx([e[1] for e in found["events"]], abs=1e-6)
