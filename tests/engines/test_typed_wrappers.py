"""Typed classes of parameters, in each language: they compile, do what Python does, and a parameter that was
removed is an error of the compiler.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import pytest

from metagraph import engines
from metagraph.engines.character import Character
from metagraph.engines.export_parameters import export_parameters, read_parameters
from metagraph.engines.reading import read_export
from metagraph.engines.targets import registry
from metagraph.engines.targets.typed_wrappers import make_class_name, make_wrapper
from metagraph.graph import edits
from metagraph.graph.editing.parameters import (
    add_parameter,
    list_offered_parameters,
    remove_parameter,
    rename_parameter,
    set_parameter,
)
from metagraph.graph.model import Project
from metagraph.graph.parameter import CharacterParameter, ParameterChoice
from metagraph.graph.requests import Gesture
from tests.browsing import MODULES, Browser
from tests.engines.cpp_program import FLAGS, needs_compiler
from tests.engines.csharp_runtime import CORE, compiled, mono, needs_mono
from tests.engines.godot4_web import needs_godot4, play, seen
from tests.engines.godot_runtime import godot, install_addon, needs_godot
from tests.engines.godot_runtime import run as run_in_godot
from tests.engines.javascript_runtime import needs_node, run

RUNTIMES = Path(engines.__file__).with_name("runtimes")
STICK = RUNTIMES.with_name("conformance") / "stick"
# What is set, and up to when the character then plays: parameter, value; a value of None for a trigger.
SETTINGS: tuple[tuple[tuple[tuple[str, Any], ...], float], ...] = (
    (
        (
            ("mood", "happy"),
            ("energy", 1.5),
            ("partner", [0.5, 1.5, 1.0]),
            ("attention", 0.5),
            ("looks_at", "partner"),
            ("gesture_with", ["positive"]),
        ),
        2.0,
    ),
    ((("arms_stance", "on_hips"), ("speaking", True), ("nod", None), ("energy", 9.0)), 5.0),
    ((("mood", "sad"), ("class", None), ("looks_at", "door"), ("arms_stance", "crossed")), 9.0),
)
# What cannot be set; then what changes nothing, and so makes no request.
REFUSED: tuple[tuple[str, Any], ...] = (("nobody", 1.0), ("mood", "glad"), ("energy", "much"), ("nod", True))
SAME = ("mood", "sad")


@pytest.fixture(scope="module")
def project() -> Project:
    """The stick figure, with a parameter of each kind; one has a name that languages have for themselves."""
    out = read_export(STICK / "stick.json", resolved=True)
    for offered in list_offered_parameters(out):
        if offered.group in ("state", "gesture"):
            out, _ = add_parameter(out, offered.name, offered.parameter)
    out = set_parameter(
        out,
        "class",
        CharacterParameter(type="trigger", request=Gesture(tags=("greeting",)), about="Waves. */ \\ <b>"),
    )
    return replace(out, name="the stick")


@pytest.fixture(scope="module")
def export(project: Project, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The stick figure's export with these parameters."""
    folder = tmp_path_factory.mktemp("export")
    document = json.loads((STICK / "stick.json").read_bytes())
    document["parameters"] = msgspec.to_builtins(export_parameters(project))
    (folder / "stick.json").write_text(json.dumps(document))
    shutil.copy(STICK / "stick.glb", folder)
    return folder / "stick.json"


Told = dict[str, Any]


@pytest.fixture(scope="module")
def wanted(export: Path) -> Told:
    """What Python's character does with them."""
    character = Character(export, seed=3)
    ids, poses = [], []
    for settings, until in SETTINGS:
        ids += [character.set_parameter(name, value) for name, value in settings]
        pose = character.update(until)
        poses.append([float(x) for x in pose.rotations.ravel()])
    refused = [character.answer(character.set_parameter(name, value)).why for name, value in REFUSED]
    again = character.set_parameter(*SAME)
    answers = [[a.state, a.at, a.until, list(a.what)] for a in map(character.answer, ids)]
    values = {name: character.get_parameter(name) for name in character.project.parameters}
    described = character.describe()["parameters"]
    return {
        "ids": [*ids, again],
        "answers": answers,
        "poses": poses,
        "refused": refused,
        "values": values,
        "described": described,
    }


def settle(times: list[float | None]) -> list[float]:
    """Return times, with -1 for what has no end, which each language says in its own way."""
    return [-1.0 if x is None or x > 1e6 else x for x in times]


def compare(found: Told, wanted: Told) -> None:
    assert found["ids"] == wanted["ids"]
    assert found["refused"] == wanted["refused"]
    for ours, theirs in zip(wanted["answers"], found["answers"], strict=True):
        assert [ours[0], ours[3]] == [theirs[0], theirs[3]]
        assert settle(ours[1:3]) == pytest.approx(settle(theirs[1:3]), abs=1e-4)
    for ours, theirs in zip(wanted["poses"], found["poses"], strict=True):
        assert ours == pytest.approx(theirs, abs=2e-3)
    if "values" in found:
        assert found["values"] == wanted["values"]
        assert found["described"] == wanted["described"]


def test_python_does_what_the_parameters_say(wanted: Told, project: Project) -> None:
    refused = [n for n, (state, *_) in enumerate(wanted["answers"]) if state == "refused"]
    assert refused == [11], "the stance that it is in has no greeting"
    assert wanted["values"]["mood"] == "sad" and wanted["values"]["energy"] == 2.0
    assert wanted["values"]["speaking"] is True and wanted["values"]["looks_at"] == "door"
    assert wanted["values"]["listening"] is False and wanted["values"]["nod"] is None
    assert wanted["ids"][-1] == wanted["ids"][10], "what is set already makes no request"
    assert wanted["refused"] == [
        "name: there is no parameter 'nobody'",
        f"value: should be one of {', '.join(wanted['described']['mood']['choices'])}",
        "value: should be a number",
        "value: a trigger has none",
    ]
    assert wanted["described"]["energy"] == {
        "type": "number",
        "about": "",
        "initial": 1.0,
        "least": 0.0,
        "most": 2.0,
    }
    assert read_parameters(export_parameters(project)) == dict(project.parameters)


JAVASCRIPT = """
import { readFileSync } from "node:fs";
import { Character, load } from "RUNTIME/index.js";
import { TheStickCharacter } from "./stick.parameters.js";

const graph = load(readFileSync(process.argv[2], "utf8"), readFileSync(process.argv[2].replace(".json", ".glb")));
const character = new Character(graph, { seed: 3 });
const made = [];
const stick = new TheStickCharacter({
  setParameter: (name, value) => { made.push(character.setParameter(name, value)); return made.at(-1); },
  getParameter: (name) => character.getParameter(name),
});
const poses = [];
const on = (now) => { character.update(now); poses.push([...character.pose().rotations]); };
stick.mood = "happy";
stick.energy = 1.5;
stick.partner = [0.5, 1.5, 1.0];
stick.attention = 0.5;
stick.looksAt = "partner";
stick.gestureWith = ["positive"];
on(2);
stick.armsStance = "on_hips";
stick.speaking = true;
stick.nod();
stick.energy = 9;
on(5);
stick.mood = "sad";
stick.class();
stick.looksAt = "door";
stick.armsStance = "crossed";
on(9);
if (stick.mood !== "sad" || stick.energy !== 2 || stick.partner[0] !== 0.5 || !stick.speaking) throw new Error("values");
const answers = made.map((id) => character.answer(id)).map(({ state, at, until, what }) => [state, at, until, what]);
const refused = JSON.parse(process.argv[3]).map(([name, value]) => character.answer(character.setParameter(name, value)).why);
stick.mood = "sad";
const described = character.describe().parameters;
const values = Object.fromEntries(Object.keys(described).map((name) => [name, character.getParameter(name)]));
console.log(JSON.stringify({ ids: made, answers, poses, refused, values, described }));
"""


@needs_node
def test_javascript(project: Project, export: Path, wanted: Told, tmp_path: Path) -> None:
    for name, text in make_wrapper(project, "stick", "javascript").items():
        (tmp_path / name).write_text(text)
    shutil.move(tmp_path / "stick.parameters.js", tmp_path / "stick.parameters.mjs")
    (tmp_path / "game.mjs").write_text(
        JAVASCRIPT.replace("RUNTIME", str(RUNTIMES / "javascript")).replace("parameters.js", "parameters.mjs")
    )
    command = ["node", str(tmp_path / "game.mjs"), str(export), json.dumps(REFUSED)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 0, done.stderr
    compare(json.loads(done.stdout), wanted)


TYPED = """
import { TheStickCharacter } from "./stick.parameters.js";
import type { Character } from "./metagraph/index.js";

export function play(character: Character): string {
  const stick = new TheStickCharacter(character);
  stick.mood = "happy";
  stick.energy = 1.5;
  stick.gestureWith = ["positive", "unsure"];
  const [x] = stick.partner;
  stick.partner = [x, 1, 2];
  return stick.nod();
}
"""
TYPES = Path(os.environ.get("NPM_PACKAGES", MODULES)) / "typescript" / "bin" / "tsc"


@pytest.mark.nightly
@pytest.mark.skipif(not TYPES.is_file(), reason="needs npm's typescript")
def test_typescript_knows_the_types(project: Project, tmp_path: Path) -> None:
    for name, text in make_wrapper(project, "stick", "javascript").items():
        (tmp_path / name).write_text(text)
    shutil.copytree(RUNTIMES / "javascript", tmp_path / "metagraph")

    def check(code: str) -> str:
        (tmp_path / "game.mts").write_text(code)
        options = ("--noEmit", "--strict", "--target", "es2022", "--module", "nodenext")
        command = ["node", str(TYPES), *options, "game.mts"]
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=120, check=False)
        return done.stdout

    assert check(TYPED) == ""
    assert "TS2322" in check(TYPED.replace('"happy"', '"glad"')), "a choice that there is not"
    text = make_wrapper(remove_parameter(project, "energy"), "stick", "javascript")["stick.parameters.d.ts"]
    (tmp_path / "stick.parameters.d.ts").write_text(text)
    assert "Property 'energy' does not exist" in check(TYPED)


CSHARP = """
using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using Metagraph;

public static class Game
{
    public static void Main(string[] args)
    {
        Graph graph = Graph.Load(File.ReadAllText(args[0]), File.ReadAllBytes(args[0].Replace(".json", ".glb")), "stick");
        var character = new Character(graph, new CharacterOptions { Seed = 3 });
        var stick = new TheStickCharacter(character);
        var poses = new List<object>();
        Action<double> on = now =>
        {
            character.Update(now);
            poses.Add(character.Pose().Rotations.Select(x => (object)(double)x).ToList());
        };
        stick.Mood = TheStickCharacter.MoodChoice.Happy;
        stick.Energy = 1.5;
        stick.Partner = (0.5, 1.5, 1.0);
        stick.Attention = 0.5;
        stick.LooksAt = TheStickCharacter.LooksAtChoice.Partner;
        stick.GestureWith = new[] { TheStickCharacter.GestureWithChoice.Positive };
        on(2);
        stick.ArmsStance = TheStickCharacter.ArmsStanceChoice.OnHips;
        stick.Speaking = true;
        stick.Nod();
        stick.Energy = 9;
        on(5);
        stick.Mood = TheStickCharacter.MoodChoice.Sad;
        stick.Class();
        stick.LooksAt = TheStickCharacter.LooksAtChoice.Door;
        stick.ArmsStance = TheStickCharacter.ArmsStanceChoice.Crossed;
        on(9);
        bool kept = stick.Mood == TheStickCharacter.MoodChoice.Sad && stick.Energy == 2 && stick.Partner.X == 0.5 && stick.Speaking
            && stick.GestureWith.Single() == TheStickCharacter.GestureWithChoice.Positive;
        if (!kept) { throw new Exception("values"); }
        List<object> ids = Enumerable.Range(1, 14).Select(n => (object)("#" + n)).ToList();
        List<object> answers = ids.Select(id => character.AnswerTo((string)id)).Select(a => (object)new List<object>
        {
            a.State, a.At, a.Until, a.What.Cast<object>().ToList(),
        }).ToList();
        var refused = new List<object>();
        foreach (object[] one in new[] { new object[] { "nobody", 1f }, new object[] { "mood", "glad" }, new object[] { "energy", "much" }, new object[] { "nod", true } })
        {
            refused.Add(character.AnswerTo(character.SetParameter((string)one[0], one[1])).Why);
        }
        stick.Mood = TheStickCharacter.MoodChoice.Sad;
        ids.Add(character.SetParameter("mood", "sad"));
        var out_ = new JsonObject();
        out_["ids"] = ids;
        out_["answers"] = answers;
        out_["poses"] = poses;
        out_["refused"] = refused;
        out_["described"] = ((JsonObject)Json.Parse(character.Describe()))["parameters"];
        var values = new JsonObject();
        foreach (string name in graph.Parameters.Keys) { values[name] = character.GetParameter(name); }
        out_["values"] = values;
        Console.WriteLine(Json.Write(out_));
    }
}
"""


@needs_mono
def test_csharp(project: Project, export: Path, wanted: Told, tmp_path: Path) -> None:
    (name, text), *_ = make_wrapper(project, "stick", "csharp").items()
    (tmp_path / name).write_text(text)
    (tmp_path / "Game.cs").write_text(CSHARP)
    program = compiled(tmp_path / "game.exe", tmp_path / "Game.cs", tmp_path / name, *CORE)
    done = mono(program, export)
    assert done.returncode == 0, done.stdout + done.stderr
    compare(json.loads(done.stdout), wanted)
    text = make_wrapper(remove_parameter(project, "energy"), "stick", "csharp")[name]
    (tmp_path / name).write_text(text)
    with pytest.raises(AssertionError, match=r"CS1061.*Energy"):
        compiled(tmp_path / "game.exe", tmp_path / "Game.cs", tmp_path / name, *CORE)


CPP = """
#include "stick_parameters.hpp"

#include <cstdio>
#include <fstream>
#include <sstream>

static std::string contents(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream out;
    out << file.rdbuf();
    return out.str();
}

static std::string quoted(const std::string& text) { return "\\"" + text + "\\""; }

int main(int, char** words) {
    const std::string json = contents(words[1]), glb = contents(words[2]);
    const metagraph::Loaded loaded =
        metagraph::load(json, reinterpret_cast<const std::uint8_t*>(glb.data()), glb.size(), "stick.json");
    metagraph::CharacterOptions options;
    options.seed = 3;
    metagraph::Character character(loaded.graph, options);
    TheStickCharacter stick(character);
    std::vector<std::string> ids;
    std::string poses;
    auto on = [&](double now) {
        character.update(now);
        poses += poses.empty() ? "[" : ",[";
        bool first = true;
        for (const auto& one : character.pose()) {
            char text[200];
            const auto& q = one.rotation;
            std::snprintf(text, sizeof text, "%s%.6f,%.6f,%.6f,%.6f", first ? "" : ",", q.x, q.y, q.z, q.w);
            poses += text;
            first = false;
        }
        poses += "]";
    };
    using Stick = TheStickCharacter;
    ids.push_back(stick.set_mood(Stick::MoodChoice::happy));
    ids.push_back(stick.set_energy(1.5));
    ids.push_back(stick.set_partner({0.5, 1.5, 1.0}));
    ids.push_back(stick.set_attention(0.5));
    ids.push_back(stick.set_looks_at(Stick::LooksAtChoice::partner));
    ids.push_back(stick.set_gesture_with({Stick::GestureWithChoice::positive}));
    on(2);
    ids.push_back(stick.set_arms_stance(Stick::ArmsStanceChoice::on_hips));
    ids.push_back(stick.set_speaking(true));
    ids.push_back(stick.nod());
    ids.push_back(stick.set_energy(9));
    on(5);
    ids.push_back(stick.set_mood(Stick::MoodChoice::sad));
    ids.push_back(stick.class_());
    ids.push_back(stick.set_looks_at(Stick::LooksAtChoice::door));
    ids.push_back(stick.set_arms_stance(Stick::ArmsStanceChoice::crossed));
    on(9);
    if (stick.mood() != Stick::MoodChoice::sad || stick.energy() != 2 || stick.partner().x != 0.5 || !stick.speaking()) return 2;
    if (stick.gesture_with() != std::vector<Stick::GestureWithChoice>{Stick::GestureWithChoice::positive}) return 3;
    std::string answers, refused, told;
    for (const std::string& id : ids) {
        const metagraph::Answer a = character.answer(id);
        std::string what;
        for (const std::string& one : a.what) what += (what.empty() ? "" : ",") + quoted(one);
        auto number = [](const std::optional<double>& x) { return x.has_value() ? std::to_string(*x) : std::string("null"); };
        answers += (answers.empty() ? "[" : ",[") + quoted(a.state) + "," + number(a.at) + "," + number(a.until) + ",[" + what + "]]";
    }
    auto refuse = [&](const std::string& id) { refused += (refused.empty() ? "" : ",") + quoted(character.answer(id).why); };
    refuse(character.set_parameter("nobody", 1.0));
    refuse(character.set_parameter("mood", "glad"));
    refuse(character.set_parameter("energy", "much"));
    refuse(character.set_parameter("nod", true));
    ids.push_back(stick.set_mood(Stick::MoodChoice::sad));
    for (const std::string& id : ids) told += (told.empty() ? "" : ",") + quoted(id);
    std::printf("{\\"ids\\":[%s],\\"answers\\":[%s],\\"poses\\":[%s],\\"refused\\":[%s]}", told.c_str(), answers.c_str(), poses.c_str(), refused.c_str());
}
"""


@pytest.mark.nightly
@needs_compiler
def test_cpp(project: Project, export: Path, wanted: Told, tmp_path: Path) -> None:
    (tmp_path / "metagraph").symlink_to(RUNTIMES / "cpp")
    (tmp_path / "stick_parameters.hpp").write_text(
        make_wrapper(project, "stick", "cpp")["stick_parameters.hpp"]
    )
    (tmp_path / "game.cpp").write_text(CPP)

    def build(*more: str) -> subprocess.CompletedProcess[str]:
        command = ["g++", "-std=c++17", *FLAGS, *more, "game.cpp", "-o", "game"]
        return subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=300, check=False)

    done = build()
    assert done.returncode == 0, done.stderr[:3000]
    ran = subprocess.run(
        [str(tmp_path / "game"), str(export), str(export.with_suffix(".glb"))],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert ran.returncode == 0, ran.stdout + ran.stderr
    compare(json.loads(ran.stdout.replace(",inf", ",null")), wanted)
    less = make_wrapper(remove_parameter(project, "energy"), "stick", "cpp")["stick_parameters.hpp"]
    (tmp_path / "stick_parameters.hpp").write_text(less)
    assert "has no member named 'set_energy'" in build("-fsyntax-only").stderr.replace("‘", "'").replace(
        "’", "'"
    )


GODOT3 = """extends SceneTree
const Graph = preload("res://addons/metagraph/core/graph.gd")
const Character = preload("res://addons/metagraph/core/character.gd")
const Shim = preload("res://addons/metagraph/core/shim3.gd")

func _init():
	var args = parse_json(Shim.text_of(Shim.read_bytes("res://args.json")))
	var json = args.export
	var graph = Graph.new(Shim.text_of(Shim.read_bytes(json)), Shim.read_bytes(json.replace(".json", ".glb")))
	var character = Character.new(graph, {seed = 3})
	var out = {ids = [], answers = [], poses = [], refused = [], values = {}}
	for step in args.steps:
		for setting in step[0]:
			out.ids.append(character.set_parameter(setting[0], setting[1]))
		character.update(step[1])
		var row = []
		for q in character.pose().rotations:
			row += [q.x, q.y, q.z, q.w]
		out.poses.append(row)
	for id in out.ids:
		var a = character.answer(id)
		out.answers.append([a.state, a.at, a.until, a.what])
	for one in args.refused:
		out.refused.append(character.answer(character.set_parameter(one[0], one[1])).why)
	out.ids.append(character.set_parameter("mood", "sad"))
	out.described = character.describe().parameters
	for name in out.described:
		out.values[name] = character.get_parameter(name)
	print("OUT " + to_json(out))
	quit()
"""


@needs_godot
def test_godot_3(export: Path, wanted: Told, tmp_path: Path) -> None:
    """The core of the add-on; the typed class needs Godot 4."""
    install_addon(tmp_path)
    (tmp_path / "project.godot").write_text('config_version=4\n\n[application]\n\nconfig/name="game"\n')
    (tmp_path / "game.gd").write_text(GODOT3)
    args = {"export": str(export), "steps": SETTINGS, "refused": REFUSED}
    (tmp_path / "args.json").write_text(json.dumps(args))
    _, told = godot(tmp_path, "game.gd")
    line = next(line for line in told.splitlines() if line.startswith("OUT "))
    compare(json.loads(line.removeprefix("OUT ").replace(",inf", ",null")), wanted)


BROKEN: tuple[Any, ...] = (
    None,
    5,
    {},
    {"type": "number"},
    {"type": "odd", "request": {}},
    {"type": "boolean", "request": {"do": "mode"}, "choices": []},
    {"type": "enum", "request": {"do": "mode"}, "choices": [5]},
    {"type": "enum", "request": [], "choices": []},
    {"type": "number", "request": {"do": "mood"}, "least": "low"},
    {"type": "number", "request": {"do": "mood"}, "beside": 1},
)


@needs_node
@pytest.mark.parametrize("broken", BROKEN, ids=str)
def test_a_broken_parameter_is_an_error_of_loading(export: Path, broken: Any) -> None:
    found = run(
        """
        const data = { ...JSON.parse(text), parameters: { broken: JSON.parse(rest[0]) } };
        try {
          load(JSON.stringify(data), glb);
          say("loaded");
        } catch (error) {
          say(error.message);
        }
        """,
        STICK,
        json.dumps(broken),
    )
    assert "parameters.broken" in found


@needs_godot
def test_a_broken_parameter_is_an_error_of_loading_in_godot(export: Path, tmp_path: Path) -> None:
    install_addon(tmp_path)
    (tmp_path / "project.godot").write_text('config_version=4\n\n[application]\n\nconfig/name="game"\n')
    document = json.loads((STICK / "stick.json").read_bytes())
    shutil.copy(STICK / "stick.glb", tmp_path)
    paths = []
    for n, broken in enumerate(BROKEN):
        paths.append(tmp_path / f"broken{n}.json")
        paths[-1].write_text(json.dumps({**document, "parameters": {"broken": broken}}))
    errors = run_in_godot(
        tmp_path,
        'for path in words():\n\tout.append(read(path, "res://stick.glb").error)',
        *map(str, paths),
    )
    assert all("$.parameters" in error for error in errors), errors


GODOT4 = """extends Node
const Graph = preload("res://addons/metagraph/core/graph.gd")
const Performer = preload("res://addons/metagraph/core/character.gd")
const Shim = preload("res://addons/metagraph/core/shim4.gd")
const Stick = preload("res://stick_parameters.gd")
const TalkCharacter = preload("res://talk_parameters.gd")

func page(performer):
PAGE
	return [talk.mood, talk.energy, talk.arms_stance, talk.partner.y]

func _ready():
	var graph = Graph.new(Shim.text_of(Shim.read_bytes("res://stick.data")), Shim.read_bytes("res://stick.motion"))
	var character = Performer.new(graph, {"seed": 3})
	var stick := Stick.new(character)
	var out = {"ids": [], "answers": [], "poses": [], "refused": [], "values": {}}
	var on = func(now):
		character.update(now)
		var row = []
		for q in character.pose().rotations:
			row.append_array([q.x, q.y, q.z, q.w])
		out.poses.append(row)
	stick.mood = Stick.MoodChoice.HAPPY
	stick.energy = 1.5
	stick.partner = Vector3(0.5, 1.5, 1.0)
	stick.attention = 0.5
	stick.looks_at = Stick.LooksAtChoice.PARTNER
	stick.gesture_with = [Stick.GestureWithChoice.POSITIVE]
	on.call(2.0)
	stick.arms_stance = Stick.ArmsStanceChoice.ON_HIPS
	stick.speaking = true
	stick.nod()
	stick.energy = 9.0
	on.call(5.0)
	stick.mood = Stick.MoodChoice.SAD
	stick.class_()
	stick.looks_at = Stick.LooksAtChoice.DOOR
	stick.arms_stance = Stick.ArmsStanceChoice.CROSSED
	on.call(9.0)
	var kept = stick.mood == Stick.MoodChoice.SAD and stick.energy == 2.0 and stick.partner.x == 0.5 and stick.speaking
	kept = kept and stick.gesture_with == [Stick.GestureWithChoice.POSITIVE]
	for n in 14:
		out.ids.append("#%d" % (n + 1))
	for id in out.ids:
		var a = character.answer(id)
		out.answers.append([a.state, a.at, a.until, a.what])
	for one in [["nobody", 1.0], ["mood", "glad"], ["energy", "much"], ["nod", true]]:
		out.refused.append(character.answer(character.set_parameter(one[0], one[1])).why)
	stick.mood = Stick.MoodChoice.SAD
	out.ids.append(character.set_parameter("mood", "sad"))
	out["described"] = character.describe().parameters
	for parameter in out.described:
		out["values"][parameter] = character.get_parameter(parameter)
	out["page"] = page(Performer.new(graph, {}))
	print("seen ", JSON.stringify(out if kept else {"kept": kept}))
	get_tree().quit(0)
"""


@needs_godot4
def test_godot_4(project: Project, export: Path, wanted: Told, tmp_path: Path, browse: Browser) -> None:
    addon = RUNTIMES / "godot" / "addons"
    files = {
        f"addons/{path.relative_to(addon).as_posix()}": path.read_bytes()
        for path in addon.rglob("*")
        if path.is_file()
    }
    text = make_wrapper(project, "stick", "gdscript")["stick_parameters.gd"]
    body = "".join(f"\t{line}\n" for line in read_block("gdscript").splitlines())
    files |= {"stick_parameters.gd": text.encode(), "main.gd": GODOT4.replace("PAGE\n", body).encode()}
    page = make_wrapper(replace(project, name="talk"), "talk", "gdscript")["talk_parameters.gd"]
    files["talk_parameters.gd"] = page.replace("class_name TalkCharacter\n", "").encode()
    files |= {"stick.data": export.read_bytes(), "stick.motion": export.with_suffix(".glb").read_bytes()}
    code, told = play(tmp_path, browse, files)
    assert code == 0, told[-3000:]
    found = seen(told)
    assert found["page"] == pytest.approx([4, 1.5, 1, 1.6])
    compare(found, wanted)


PAGE = Path(__file__).parents[2] / "docs" / "engines" / "parameters.md"


def read_block(language: str) -> str:
    """Return the page's code in a language."""
    return PAGE.read_text(encoding="utf-8").split(f"```{language}\n")[1].split("```")[0]


@pytest.fixture(scope="module")
def talk(project: Project) -> Project:
    return replace(project, name="talk")


@needs_node
def test_the_pages_javascript_runs(talk: Project, export: Path, tmp_path: Path) -> None:
    code = make_wrapper(talk, "talk", "javascript")["talk.parameters.js"]
    (tmp_path / "talk.parameters.mjs").write_text(code)
    begin, rest = read_block("js").replace("parameters.js", "parameters.mjs").split("\n", 1)
    made = f"""import {{ readFileSync }} from "node:fs";
import {{ Character, load }} from "{RUNTIMES / "javascript" / "index.js"}";
{begin}
const character = new Character(load(readFileSync("{export}", "utf8"), readFileSync("{export.with_suffix(".glb")}")));
{rest}
character.update(1);
console.log(JSON.stringify([talk.mood, talk.energy, talk.armsStance, talk.partner, character.answer("#5").state]));
"""
    (tmp_path / "game.mjs").write_text(made)
    command = ["node", str(tmp_path / "game.mjs")]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout) == ["happy", 1.5, "on_hips", [0.5, 1.6, 1.2], "planned"]


@needs_mono
def test_the_pages_csharp_compiles(talk: Project, tmp_path: Path) -> None:
    (tmp_path / "TalkCharacter.cs").write_text(make_wrapper(talk, "talk", "csharp")["TalkCharacter.cs"])
    body = read_block("csharp")
    game = f"using Metagraph;\npublic static class Game {{ public static void Play(Character character) {{ {body} }} }}"
    (tmp_path / "Game.cs").write_text(game)
    compiled(tmp_path / "game.dll", tmp_path / "Game.cs", tmp_path / "TalkCharacter.cs", *CORE)


@pytest.mark.nightly
@needs_compiler
def test_the_pages_cpp_compiles(talk: Project, tmp_path: Path) -> None:
    (tmp_path / "metagraph").symlink_to(RUNTIMES / "cpp")
    (tmp_path / "talk_parameters.hpp").write_text(make_wrapper(talk, "talk", "cpp")["talk_parameters.hpp"])
    code = f"std::string play(metagraph::Character& character) {{ {read_block('cpp')} return id; }}"
    (tmp_path / "game.cpp").write_text(f'#include "talk_parameters.hpp"\n{code}\n')
    command = ["g++", "-std=c++17", *FLAGS, "-fsyntax-only", "game.cpp"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=300, check=False)
    assert done.returncode == 0, done.stderr[:3000]


LANGUAGES = ("javascript", "csharp", "gdscript", "cpp")


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_reorganised_graph_changes_nothing_and_a_rename_does(project: Project, language: str) -> None:
    """Neither other names of stances and actions nor other clips change what the compiler sees."""
    stance = next(iter(project.graphs["arms"].stances.values()))
    action = next(x for x in project.graphs["arms"].actions.values() if x.kind == "gesture")
    other = edits.rename_stance(project, stance.id, "somewhere else")
    other = edits.update_actions(other, [action.id], name="another name", likelihood=5.0)
    before = make_wrapper(project, "stick", language)
    assert make_wrapper(other, "stick", language) == before
    assert make_wrapper(rename_parameter(project, "energy", "vigour"), "stick", language) != before


@pytest.mark.parametrize(
    ("name", "called"),
    [
        ("talk", "TalkCharacter"),
        ("my character", "MyCharacter"),
        ("Character", "ExportedCharacter"),
        ("metagraph", "ExportedCharacter"),
    ],
)
def test_the_class_is_called_after_the_project(project: Project, name: str, called: str) -> None:
    assert make_class_name(replace(project, name=name)) == called
    assert make_class_name(replace(project, name="話す")) == "ExportedCharacter"


def test_names_that_would_meet_in_a_language_are_kept_apart(project: Project) -> None:
    """A choice's type, the class itself and words of the language keep their names."""
    some = replace(project, parameters={})
    for name in (
        "mood",
        "mood_choice",
        "to_string",
        "the_stick_character",
        "constructor",
        "script",
        "default",
    ):
        some = set_parameter(some, name, project.parameters["mood"])
    code = make_wrapper(some, "stick", "csharp")["TheStickCharacter.cs"]
    for member in (
        "MoodChoice MoodChoice ",
        "MoodChoice_ Mood",
        "ToString_",
        "TheStickCharacter_",
        "Default",
    ):
        assert member.strip() in code or member == "MoodChoice MoodChoice ", member
    assert "constructor_" in make_wrapper(some, "stick", "javascript")["stick.parameters.js"]
    assert "var script_:" in make_wrapper(some, "stick", "gdscript")["stick_parameters.gd"]
    assert "default_()" in make_wrapper(some, "stick", "cpp")["stick_parameters.hpp"]


@pytest.mark.parametrize(
    ("target", "files"),
    [
        ("javascript", ("stick.parameters.js", "stick.parameters.d.ts")),
        ("unity", ("TheStickCharacter.cs",)),
        ("godot", ("stick_parameters.gd",)),
        ("cpp", ("stick_parameters.hpp",)),
    ],
)
def test_targets_write_the_class_only_for_projects_with_parameters(
    toy: Any, tmp_path: Path, target: str, files: tuple[str, ...]
) -> None:
    plain = toy.project()
    stems = [name.replace("stick", "toy").replace("TheStick", "Toy") for name in files]
    names = {path.name for path in registry.write_for_target(plain, target, tmp_path / "plain").files}
    assert not names & set(stems)
    offered = next(x for x in list_offered_parameters(plain) if x.name == "energy")
    typed, _ = add_parameter(plain, "energy", offered.parameter)
    report = registry.write_for_target(typed, target, tmp_path / "typed")
    assert set(stems) <= {path.name for path in report.files}
    readme = next(p for p in report.files if p.name == "README.md" and p.parent == tmp_path / "typed")
    text = readme.read_text(encoding="utf-8")
    assert all(name in text or name.endswith(".cs") for name in stems)
    assert "a typed class of the character's parameters" in text


def test_a_choice_keeps_its_name_whatever_it_stands_for(project: Project) -> None:
    parameter = project.parameters["arms_stance"]
    other = msgspec.structs.replace(
        parameter,
        choices=tuple(ParameterChoice(c.name, parameter.choices[0].value) for c in parameter.choices),
    )
    changed = set_parameter(project, "arms_stance", other)
    assert make_wrapper(changed, "stick", "cpp") == make_wrapper(project, "stick", "cpp")
