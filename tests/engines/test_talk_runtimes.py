"""Text with gestures in C#, C++ and GDScript: what is said, with which gestures, and what becomes of them is what it is
in JavaScript, whose gestures are Python's.
"""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest

from metagraph.engines.translation.gesture_word_lists import (
    CPP,
    GODOT,
    JAVASCRIPT,
    UNITY,
    make_gesture_word_modules,
)
from tests.engines import cpp_program, csharp_runtime, godot_runtime
from tests.engines.godot_runtime import needs_godot
from tests.speech.test_text_gestures import SPOKEN, TEXTS

ROOT = Path(__file__).resolve().parents[2]
RUNTIMES = ROOT / "metagraph" / "engines" / "runtimes"
OWN = {
    "rules": [{"words": ["kumquat", "Bergamot orange"], "tags": ["positive"], "strength": 2}],
    "clause": {"tags": ["beat"]},
}
# Language, own lexicon, text, and what else the request has.
SAYS: tuple[tuple[str, Any, str, dict[str, Any]], ...] = (
    ("en", None, "Hello! I don't know, perhaps it is a big idea.", {"id": "own", "after": 1.0}),
    ("en", None, "No, never!", {"words": [["No", 0.1, 0.5], {"word": "never", "start": 0.9, "end": 1.4}]}),
    ("en", None, "No, never!", {"words": [["No", 0.1], ["never", 0.9]], "duration": 4.0}),
    ("en", None, "Hello there", {"at": 0.75, "mood": "happy"}),
    ("de-AT", None, SPOKEN["de"][0], {}),
    ("FR", None, SPOKEN["fr"][0], {}),
    ("xx", None, "Yes, of course.", {}),
    ("en", OWN, "A kumquat, hello!", {"gestures": False}),
    ("en", None, "Hello", {"nonsense": 1}),
    ("en", None, "Hello", {"duration": "long"}),
    ("en", None, "", {}),
)

JS = """
import { readFileSync } from "node:fs";
import { Character, Talk, load } from "%(runtime)s/index.js";
const asked = JSON.parse(readFileSync(0, "utf8"));
const json = readFileSync(asked.json), glb = readFileSync(asked.glb);
const graph = load(json.toString(), glb.buffer.slice(glb.byteOffset, glb.byteOffset + glb.length));
const played = (character, talk, said) => {
  const states = {};
  for (let t = 0; t < talk.free + 2; t += 0.1) {
    character.update(t);
    for (const id of said.flatMap((one) => [one.id, ...one.gestures])) states[id] = character.answer(id).state;
  }
  return { said: said.map((one) => [one.id, ...one.gestures]), free: talk.free, states };
};
const out = asked.texts.map((text) => {
  const character = new Character(graph, { seed: 3 });
  const talk = new Talk(character, { seed: 4294967295, name: "text" });
  const said = [...text].flatMap((letter) => talk.take(letter));
  said.push(...talk.take("", true));
  return played(character, talk, said);
});
for (const [language, lexicon, text, more] of asked.says) {
  const character = new Character(graph, { seed: 3 });
  const talk = new Talk(character, { language, lexicon: lexicon ?? undefined });
  const said = talk.say(text, more);
  out.push({ ...played(character, talk, [said]), why: character.answer(said.id).why });
}
console.log(JSON.stringify(out));
"""

CSHARP = r"""
using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using Metagraph;

public static class Program
{
    private static JsonObject Played(Character character, Talk talk, List<SaidText> said)
    {
        var states = new JsonObject();
        for (double t = 0; t < talk.Free + 2; t += 0.1)
        {
            character.Update(t);
            foreach (string id in said.SelectMany(one => one.Gestures.Prepend(one.Id)))
            {
                states[id] = character.AnswerTo(id).State;
            }
        }
        var played = new JsonObject();
        played["said"] = said.Select(one => (object)one.Gestures.Prepend(one.Id).Cast<object>().ToList()).ToList();
        played["free"] = talk.Free;
        played["states"] = states;
        return played;
    }

    public static void Main(string[] args)
    {
        var asked = (JsonObject)Json.Parse(File.ReadAllText(args[0]));
        Graph graph = Graph.Load(File.ReadAllText((string)asked["json"]), File.ReadAllBytes((string)asked["glb"]));
        var played = new List<object>();
        foreach (string text in (List<object>)asked["texts"])
        {
            var character = new Character(graph, new CharacterOptions { Seed = 3 });
            var talk = new Talk(character, seed: 4294967295, name: "text");
            List<SaidText> said = Alphabet.Common.Letters(text).SelectMany(letter => talk.Take(letter)).ToList();
            said.AddRange(talk.Take("", true));
            played.Add(Played(character, talk, said));
        }
        foreach (List<object> row in (List<object>)asked["says"])
        {
            var character = new Character(graph, new CharacterOptions { Seed = 3 });
            var talk = new Talk(character, (string)row[0], row[1] == null ? null : Json.Write(row[1]));
            SaidText said = talk.Say((string)row[2], Json.Write(row[3]));
            JsonObject one = Played(character, talk, new List<SaidText> { said });
            one["why"] = character.AnswerTo(said.Id).Why;
            played.Add(one);
        }
        Console.WriteLine(Json.Write(played));
    }
}
"""

CPP_PROGRAM = r"""
#include "metagraph.hpp"
using namespace metagraph;

static std::string read(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
}

static Json played(Character& character, const Talk& talk, const List<SaidText>& said) {
    Json states = Json::object(), rows = Json::list();
    for (double t = 0; t < talk.free() + 2; t += 0.1) {
        character.update(t);
        for (const SaidText& one : said) {
            states.set(one.id, character.answer(one.id).state);
            for (const std::string& id : one.gestures) states.set(id, character.answer(id).state);
        }
    }
    for (const SaidText& one : said) {
        List<std::string> row = one.gestures;
        row.insert(row.begin(), one.id);
        rows.items.push_back(Json::texts(row));
    }
    return Json::object({{"said", rows}, {"free", talk.free()}, {"states", states}});
}

int main(int, char** words) {
    const std::string text = read(words[1]);
    json::Parser parser(text);
    const Json asked = parser.parse();
    const std::string json = read(asked.find("json")->text), glb = read(asked.find("glb")->text);
    const Loaded loaded = load(json, reinterpret_cast<const std::uint8_t*>(glb.data()), glb.size(), "sample.json");
    CharacterOptions options;
    options.seed = 3;
    Json out = Json::list();
    for (const Json& one : asked.find("texts")->items) {
        Character character(loaded.graph, options);
        TalkOptions words_;
        words_.seed = 4294967295u;
        words_.name = "text";
        Talk talk(character, words_);
        List<SaidText> said;
        for (const char letter : one.text) {
            for (const SaidText& told : talk.take(std::string(1, letter))) said.push_back(told);
        }
        for (const SaidText& told : talk.take("", true)) said.push_back(told);
        out.items.push_back(played(character, talk, said));
    }
    for (const Json& row : asked.find("says")->items) {
        Character character(loaded.graph, options);
        TalkOptions words_;
        words_.language = row.items[0].text;
        words_.lexicon = row.items[1];
        Talk talk(character, words_);
        const SaidText said = talk.say(row.items[2].text, row.items[3]);
        Json one = played(character, talk, {said});
        one.set("why", character.answer(said.id).why);
        out.items.push_back(one);
    }
    std::cout << json::text(out) << "\n";
    return 0;
}
"""

GDSCRIPT = """extends SceneTree
const Graph = preload("res://addons/metagraph/core/graph.gd")
const Character = preload("res://addons/metagraph/core/character.gd")
const Talk = preload("res://addons/metagraph/core/talk.gd")
const Shim = preload("res://addons/metagraph/core/shim3.gd")

func played(character, talk, said):
	var rows = []
	for one in said:
		rows.append([one.id] + one.gestures)
	var states = {}
	var t = 0.0
	while t < talk.free_from + 2:
		character.update(t)
		for row in rows:
			for id in row:
				states[id] = character.answer(id).state
		t += 0.1
	return {"said": rows, "free": talk.free_from, "states": states}

func _init():
	var asked = parse_json(Shim.text_of(Shim.read_bytes("res://asked.json")))
	var graph = Graph.new(Shim.text_of(Shim.read_bytes(asked.json)), Shim.read_bytes(asked.glb))
	var out = []
	for text in asked.texts:
		var character = Character.new(graph, {"seed": 3})
		var talk = Talk.new(character, {"seed": 4294967295, "name": "text"})
		var said = []
		for letter in text:
			said += talk.take(letter)
		said += talk.take("", true)
		out.append(played(character, talk, said))
	for row in asked.says:
		var character = Character.new(graph, {"seed": 3})
		var talk = Talk.new(character, {"language": row[0], "lexicon": row[1]})
		var said = talk.say(row[2], row[3])
		var one = played(character, talk, [said])
		one["why"] = character.answer(said.id).why
		out.append(one)
	print("OUT " + to_json(out))
	quit()
"""


def asked(sample_export: Path) -> dict[str, Any]:
    files = {kind: str(sample_export / f"sample.{kind}") for kind in ("json", "glb")}
    return {**files, "texts": TEXTS, "says": SAYS}


@pytest.fixture(scope="module")
def wanted(sample_export: Path) -> Any:
    """What JavaScript says."""
    node = shutil.which("node")
    if node is None:
        pytest.skip("needs Node")
    done = subprocess.run(
        [node, "--input-type=module", "-e", JS % {"runtime": (RUNTIMES / "javascript").as_uri()}],
        input=json.dumps(asked(sample_export)), capture_output=True, text=True, timeout=60, encoding="utf-8",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def same(found: Any, wanted: Any) -> None:
    for mine, theirs in zip(found, wanted, strict=True):
        assert mine["said"] == theirs["said"]
        assert mine["states"] == theirs["states"], mine["said"]
        assert mine["free"] == pytest.approx(theirs["free"])
        assert bool(mine.get("why")) == bool(theirs.get("why"))


@pytest.mark.nightly
def test_what_is_said_gestures_and_what_cannot_be_read_is_refused(wanted: Any) -> None:
    """Or the comparisons with it would be of nothing."""
    *_, nonsense, long, empty = wanted
    assert all(len(one["said"][0]) == 1 for one in (nonsense, long, empty))
    assert set(nonsense["states"].values()) == set(long["states"].values()) == {"refused"}
    assert nonsense["free"] == 0
    said = wanted[len(TEXTS) : -3]
    assert [one["said"][0][0] for one in said[:2]] == ["own", "talk1"]
    assert all(len(one["said"][0]) > 1 for one in said)
    states = [state for one in wanted[:-3] for state in one["states"].values()]
    assert len(states) > 40 and states.count("refused") < 0.2 * len(states)


@pytest.mark.nightly
@csharp_runtime.needs_mono
def test_c_sharp_says_what_javascript_says(
    wanted: Any, sample_export: Path, core: Path, tmp_path: Path
) -> None:
    source = tmp_path / "program.cs"
    source.write_text(CSHARP)
    program = csharp_runtime.compiled(core.with_name("program.exe"), source, references=(core,))
    (tmp_path / "asked.json").write_text(json.dumps(asked(sample_export)))
    done = csharp_runtime.mono(program, tmp_path / "asked.json", LANG="tr_TR.UTF-8", LC_ALL="tr_TR.UTF-8")
    assert done.returncode == 0, done.stderr
    same(json.loads(done.stdout), wanted)


@csharp_runtime.needs_mono
def test_a_lexicon_that_is_none_is_an_error_with_a_remedy_in_c_sharp(core: Path, tmp_path: Path) -> None:
    source = tmp_path / "none.cs"
    source.write_text(
        "using System; using Metagraph; public static class None { public static void Main() { try {"
        ' Talk.LexiconOf("en", "{\\"rules\\": 3}"); } catch (MetagraphException error)'
        " { Console.Write(error.Message); } } }"
    )
    program = csharp_runtime.compiled(core.with_name("none.exe"), source, references=(core,))
    told = csharp_runtime.mono(program).stdout
    assert "'rules' should be a list" in told and "docs/agents/text-to-gestures.md" in told


@pytest.mark.nightly
@cpp_program.needs_compiler
def test_cpp_says_what_javascript_says(
    wanted: Any, sample_export: Path, cpp_probe: Path, tmp_path: Path
) -> None:
    (tmp_path / "asked.json").write_text(json.dumps(asked(sample_export)))
    done = cpp_program.ran(cpp_probe, "talk", tmp_path / "asked.json")
    assert done.returncode == 0, done.stderr
    same(json.loads(done.stdout), wanted)


@pytest.mark.nightly
@cpp_program.needs_compiler
def test_small_letters_are_pythons_in_cpp(cpp_probe: Path) -> None:
    """Of the alphabets that lexicons are likely to be written in; all else stays as it is."""
    kept = {*range(0x181, 0x1CD), *range(0x1F1, 0x1F8), 0x220, 0x130, 0x4C0} - {0x1A0, 0x1AF}
    codes = {*range(0x21, 0x7F), *range(0xA1, 0x234), *range(0x386, 0x3CF), *range(0x3D0, 0x3D8)}
    codes |= {*range(0x400, 0x588), *range(0x1E00, 0x1F00), 0x4E00, 0xAC00, 0x1F600}
    letters = [chr(code) for code in sorted(codes - kept) if chr(code).isprintable()]
    broken = [b"\xc3", b"\xe2\x82 A", b"\xff\x80A"]
    done = subprocess.run(
        [cpp_probe, "lowered"],
        input=b"\n".join([*(x.encode() for x in letters), *broken]),
        capture_output=True,
        timeout=60,
    )
    found = done.stdout.splitlines()
    assert [x.decode() for x in found[: len(letters)]] == [x.lower() for x in letters]
    assert found[len(letters) :] == [b"\xc3", b"\xe2\x82 a", b"\xff\x80a"]


@pytest.mark.nightly
@needs_godot
def test_gdscript_says_what_javascript_says(wanted: Any, sample_export: Path, game: Path) -> None:
    (game / "asked.json").write_text(json.dumps(asked(sample_export)))
    (game / "talk.gd").write_text(GDSCRIPT)
    code, told = godot_runtime.godot(game, "talk.gd")
    assert code == 0, told
    same(json.loads(next(line for line in told.splitlines() if line.startswith("OUT "))[4:]), wanted)


def test_every_language_has_the_lists() -> None:
    """That they are equal to the files is given by `test_talk`."""
    assert set(make_gesture_word_modules()) == {JAVASCRIPT, GODOT, UNITY, CPP}
