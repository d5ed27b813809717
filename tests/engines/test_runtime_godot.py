"""The Godot runtime: it conforms on a real engine, says what is wrong with bad input, never fails in play,
and its rules are tested.
"""

from __future__ import annotations

import copy
import json
import os
import random
import re
import shutil
import struct
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from metagraph import engines
from metagraph.engines.targets import registry
from metagraph.graph.model import Project
from tests.engines.mutants import PLAYED, broken, folders_to_try
from tests.thorough import many, some

ADDON = Path(engines.__file__).with_name("runtimes") / "godot" / "addons"
FOLDERS = sorted(path for path in Path(engines.__file__).with_name("conformance").iterdir() if path.is_dir())
STICK = next(folder for folder in FOLDERS if folder.name == "stick")
GODOT = shutil.which("godot3-server")
needs_godot = pytest.mark.skipif(
    GODOT is None, reason="godot3-server is not here (apt install godot3-server)"
)


@pytest.fixture
def game(tmp_path: Path) -> Path:
    """A Godot project with the addon."""
    folder = tmp_path / "game"
    shutil.copytree(ADDON, folder / "addons")
    (folder / "project.godot").write_text('config_version=4\n\n[application]\n\nconfig/name="test"\n')
    return folder


def godot(game: Path, script: str, *words: object, fails: bool = False) -> tuple[int, str]:
    """Run a script of the project until it quits; return its exit code and what it printed. fails: whether it
    runs into an error.
    """
    env = {**os.environ, "HOME": str(game), "LC_ALL": "C.UTF-8"}
    command = [str(GODOT), "--no-window", "-s", script, *map(str, words)]
    done = subprocess.run(
        command, cwd=game, env=env, capture_output=True, text=True, errors="replace", timeout=300
    )
    told = done.stdout + done.stderr
    assert ("SCRIPT ERROR" in told) == fails, told[-2000:]
    return done.returncode, done.stdout


def run(game: Path, body: str, *words: object, fails: bool = False) -> Any:
    """Run a function body that fills `out`, with `words()`, and return `out`."""
    lines = "\n".join("\t" + line for line in body.strip().splitlines())
    (game / "test.gd").write_text(
        f"{HEAD}\nfunc _init():\n\tvar out = []\n{lines}\n\tprint('OUT ' + to_json(out))\n\tquit()\n"
    )
    (game / "words.json").write_text(json.dumps(words, ensure_ascii=False))
    code, told = godot(game, "test.gd", fails=fails)
    assert code == 0, told
    return json.loads(next(line for line in told.splitlines() if line.startswith("OUT "))[4:])


HEAD = """extends SceneTree
const Graph = preload("res://addons/metagraph/core/graph.gd")
const Character = preload("res://addons/metagraph/core/character.gd")
const Shim = preload("res://addons/metagraph/core/shim3.gd")

func read(path, glb = ""):
	return Graph.new(Shim.text_of(Shim.read_bytes(path)), Shim.read_bytes(path.replace(".json", ".glb") if glb == "" else glb))

func words():
	return parse_json(Shim.text_of(Shim.read_bytes("res://words.json")))
"""
PERFORM = STICK / "stick.json"


@needs_godot
@pytest.mark.parametrize("folder", PLAYED, ids=lambda folder: folder.name)
def test_shipped_vectors_pass_on_the_engine(game: Path, folder: Path) -> None:
    code, told = godot(game, "addons/metagraph/conformance.gd", folder)
    assert code == 0, told
    cases = json.loads((folder / "vectors.json").read_bytes())["cases"]
    assert f"{len(cases)} passed, 0 failed" in told


@needs_godot
def test_vectors_of_the_sample_pass_on_the_engine(game: Path, sample_export: Path) -> None:
    """They are of the shipped vectors' kinds, which all pass here, on sixty joints with a face."""
    assert len(json.loads((sample_export / "vectors.json").read_bytes())["cases"]) > 50
    code, told = godot(game, "addons/metagraph/conformance.gd", sample_export)
    assert code == 0, told
    assert " 0 failed" in told


@needs_godot
def test_vectors_that_are_broken_fail(game: Path, tmp_path: Path) -> None:
    folder = shutil.copytree(STICK, tmp_path / "broken")
    data = json.loads((folder / "vectors.json").read_bytes())
    data["cases"] = data["cases"][:1]
    data["cases"][0]["poses"][0]["positions"][3][1] += 0.001
    (folder / "vectors.json").write_text(json.dumps(data, ensure_ascii=False))
    code, told = godot(game, "addons/metagraph/conformance.gd", folder)
    assert code == 1
    assert "FAIL nothing is asked: pose at" in told
    (folder / "vectors.json").write_text(json.dumps({**data, "vectors": 2}))
    code, told = godot(game, "addons/metagraph/conformance.gd", folder)
    assert code == 1
    assert "version" in told


# One rule each, as (file, what it says, what it would say). Each must be noticed by the shipped vectors.
MUTATIONS = {
    "the curve of blends": ("util.gd", "x * x * (3.0 - 2.0 * x)", "x"),
    "what synthesisers count seconds in": ("told_timing.gd", "const TICKS = 1e7", "const TICKS = 1e6"),
    "what has been said of a line stands": ("items.gd", "Util.most(now - old.start, 0.0)", "0.0"),
    "uses are counted": ("remembering.gd", "uses.get(ident, 0) + 1", "1"),
    "ties go by id": (
        "replan.gd",
        "-meta.request.priority, meta.request.id, meta.part]",
        "-meta.request.priority, meta.part]",
    ),
    "layers multiply on the right": (
        "pose.gd",
        "rotations[joint] * (turn if each[1] == 1 else Turns.power(turn, each[1]))",
        "(turn if each[1] == 1 else Turns.power(turn, each[1])) * rotations[joint]",
    ),
    "the hash": ("hashing.gd", "value ^= value >> 13", "value ^= value >> 12"),
    "a remainder has a key of its own": ("replan.gd", "last.part + 1 if kept else last.part", "last.part"),
    "holds hurry": ("cue_shapes.gd", "(hold_to - hold_from) / HURRY", "(hold_to - hold_from)"),
    "what is too late": ("sampling.gd", "if least > allowed + CueShapes.FITS:", "if least > allowed + 9.0:"),
    "a stroke may be shared": ("cue_shapes.gd", "<= SHARED", "<= 0.0"),
    "the head sets off after the eyes": (
        "gaze.gd",
        "settle((gone - HEAD_LAG) / aim.head)",
        "settle(gone / aim.head)",
    ),
    "a blink shuts what is open": ("solve.gd", "shut + blink * (1.0 - shut)", "shut + blink"),
    "the other arm keeps to the stance": (
        "graph.gd",
        'parts[joint] == "arms" and sides[joint] == other',
        "false",
    ),
    "what is forgotten of life": (
        "planner.gd",
        "changes.life = plan.life.since(seconds)",
        "changes.life = plan.life",
    ),
}

# A case that notices each, tried first.
HINTS = {
    "the curve of blends": "stick: layers body",
    "what synthesisers count seconds in": "stick: words and shapes with their times",
    "what has been said of a line stands": "stick: a line that is added to",
    "uses are counted": "stick: cut again and again",
    "ties go by id": "stick: ties of start and priority",
    "layers multiply on the right": "stick: no time at all",
    "the hash": "stick: hashes",
    "a remainder has a key of its own": "stick: cut and resumed",
    "holds hurry": "stick: arms: holds and preparations",
    "what is too late": "stick: arms: starts that may not be late",
    "a stroke may be shared": "stick: arms: strokes that may not be late",
    "the head sets off after the eyes": "stick: looks",
    "a blink shuts what is open": "stick: blinks and modes",
    "the other arm keeps to the stance": "stick: no room",
    "what is forgotten of life": "stick: a past that is forgotten",
}


TRIED = some([*MUTATIONS], 3)


def test_every_rule_that_could_be_broken_stands_in_its_file_once() -> None:
    """Of those, one in three is broken here, and all where asked to be thorough."""
    for file, said, instead in MUTATIONS.values():
        broken(ADDON / "metagraph" / "core" / file, said, instead)


@needs_godot
@pytest.mark.parametrize("rule", TRIED)
def test_a_broken_rule_fails_the_vectors(game: Path, single: Path, rule: str) -> None:
    file, said, instead = MUTATIONS[rule]
    path = game / "addons" / "metagraph" / "core" / file
    path.write_text(broken(path, said, instead))
    for folder in folders_to_try(HINTS.get(rule), [STICK], single):
        code, told = godot(game, "addons/metagraph/conformance.gd", folder)
        if code:
            break
    assert code == 1
    assert "FAIL " in told


@needs_godot
def test_the_single_cases_that_notice_mutants_pass_where_nothing_is_broken(game: Path, single: Path) -> None:
    tried = [folders_to_try(HINTS[rule], [STICK], single)[0] for rule in TRIED]
    code, told = godot(game, "addons/metagraph/conformance.gd", *tried)
    assert code == 0, told


# --- bad input


@needs_godot
def test_a_bad_export_is_one_error_with_place_and_remedy(game: Path, tmp_path: Path) -> None:
    good = json.loads(PERFORM.read_bytes())
    glb = PERFORM.with_suffix(".glb").read_bytes()
    renamed = {
        **good,
        "joints": [
            {**j, "name": j["name"] + "x", "parent": j["parent"] and j["parent"] + "x"}
            for j in good["joints"]
        ],
    }
    late = {**good, "joints": good["joints"][::-1]}
    cases = {
        "newer": (json.dumps({**good, "metagraph": 2}), glb, "update the runtime"),
        "text": ("{nothing", glb, "not JSON"),
        "list": ("[]", glb, "not JSON"),
        "other": ('{"asset": {"version": "2.0"}}', glb, "$.metagraph"),
        "field": (
            json.dumps({k: v for k, v in good.items() if k != "planner"}),
            glb,
            "$.planner: it is missing",
        ),
        "order": (json.dumps(late), glb, "after its parent"),
        "short": (json.dumps(good), glb[: len(glb) // 2], "cut short"),
        "nothing": (json.dumps(good), b"", "no GLB"),
        "picture": (json.dumps(good), b"\x89PNG" + bytes(100), "no GLB"),
        "stranger": (json.dumps(renamed), glb, "no joint 'Hipsx'"),
    }
    for name, (text, data, _) in cases.items():
        (tmp_path / f"{name}.json").write_text(text)
        (tmp_path / f"{name}.glb").write_bytes(data)
    body = 'for path in words():\n\tout.append(read(path).error)\nout.append(read("res://none.json").error)'
    *found, none = run(game, body, *(str(tmp_path / f"{name}.json") for name in cases))
    for error, (name, (_, _, part)) in zip(found, cases.items(), strict=True):
        assert part in error, (name, error)
    assert "check that it is there" in none


def _without(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Yield the path of every field, in the first item of each list."""
    if isinstance(value, dict):
        for key in value:
            yield (*path, key)
            yield from _without(value[key], (*path, key))
    elif isinstance(value, list) and value:
        yield from _without(value[0], (*path, 0))


@needs_godot
def test_an_export_that_lacks_a_field_is_refused_or_played(game: Path, tmp_path: Path) -> None:
    """Whatever is missing: an error that names the place, or a character that plays on."""
    small = json.loads(PERFORM.read_bytes())
    paths = []
    fields = [p for p in _without(small) if p[-1] not in ("expanded", "performances", "randomness")]
    for n, path in enumerate(random.Random(1).sample(fields, len(fields) // many(6, 1))):
        data = copy.deepcopy(small)
        at = data
        for key in path[:-1]:
            at = at[key]
        del at[path[-1]]
        paths.append(str(tmp_path / f"{n}.json"))
        Path(paths[-1]).write_text(json.dumps(data))
    body = f"""
for path in words():
	var graph = read(path, "{PERFORM.with_suffix(".glb")}")
	if graph.error == "":
		var character = Character.new(graph, {{}})
		character.ask({{"do": "say", "line": "hello"}})
		for n in range(8):
			character.update(n)
			character.pose()
	out.append(graph.error)
"""
    errors = run(game, body, *paths)
    assert sum(error != "" for error in errors) > 10
    assert all(error == "" or "$" in error for error in errors)


@needs_godot
def test_a_clip_that_the_glb_lacks_is_told_and_its_actions_show_their_stance(
    game: Path, tmp_path: Path
) -> None:
    shutil.copy(PERFORM, tmp_path / "lacking.json")
    raw = PERFORM.with_suffix(".glb").read_bytes()
    (length,) = struct.unpack_from("<I", raw, 12)
    head = json.loads(raw[20 : 20 + length])
    gone = head["animations"].pop()["name"]
    text = json.dumps(head).encode()
    text += b" " * (-len(text) % 4)
    rest = raw[20 + length :]
    size = 20 + len(text) + len(rest)
    (tmp_path / "lacking.glb").write_bytes(
        raw[:8] + struct.pack("<III", size, len(text), 0x4E4F534A) + text + rest
    )
    body = """
var graph = read(words()[0])
var character = Character.new(graph, {})
for n in range(30):
	character.update(n)
	out.append(character.pose().rotations.size())
out.append([graph.error, graph.problems])
"""
    *sizes, (error, problems) = run(game, body, str(tmp_path / "lacking.json"))
    assert error == ""
    assert len(problems) == 1
    assert gone in problems[0]
    assert set(sizes) == {18}


# --- a character at play


@needs_godot
def test_a_character_does_what_is_asked_and_says_so(game: Path) -> None:
    body = """
var graph = read(words()[0])
var character = Character.new(graph, {"idle": false, "seed": 5})
var twin = Character.new(graph, {"idle": false, "seed": 5})
var first = character.ask({"do": "gesture", "after": 1.0})
var named = character.ask({"do": "look", "to": [1.0, 1.5, 2.0], "id": "there"})
var none = character.ask({"do": "action", "action": "no such"})
var bml = character.ask({"do": "bml", "bml": "<bml/>"})
for request in [{"do": "gesture", "after": 1.0}, {"do": "look", "to": [1.0, 1.5, 2.0], "id": "there"}]:
	twin.ask(request)
var told = []
var same = true
var before = character.answer(first)
for n in range(60 * 50):
	character.update(n / 60.0)
	twin.update(n / 60.0)
	for event in character.events():
		told.append([event.kind, event.layer, event.at, n / 60.0])
	if n == 60:
		out.append([character.answer(first), character.answer(named), character.answer(none), character.answer(bml)])
	if n % 300 == 0:
		for joint in range(graph.names.size()):
			same = same and character.pose().rotations[joint] == twin.pose().rotations[joint]
character.update(3.0)
out.append([first, named, none, same, told, character.now, character.answer(first), character.answer("never"), before])
"""
    planned, rest = run(game, body, str(PERFORM))
    first, named, none, bml = planned
    assert first["state"] == "planned"
    assert first["at"] == pytest.approx(1.0, abs=0.2)
    assert named["state"] == "planned"
    assert named["what"] == ["look"]
    assert none["state"] == bml["state"] == "refused"
    assert "no such" in none["why"]
    assert "BML" in bml["why"]
    assert rest[:4] == ["#1", "there", "#3", True]
    begins = [event for event in rest[4] if event[0] == "begin"]
    assert len(begins) == len(rest[4]) - len(begins) == 1
    assert all(0 <= now - at < 1 / 59 for _, _, at, now in rest[4])
    assert rest[5] == pytest.approx(3000 / 60 - 1 / 60)
    assert rest[6]["state"] == "done"
    assert rest[7]["state"] == "refused"
    assert rest[8]["state"] == "planned"


@needs_godot
def test_malformed_requests_are_refused_and_nothing_fails(game: Path) -> None:
    wrong: list[Any] = [
        None,
        3,
        "gesture",
        [],
        {},
        {"do": 1},
        {"do": "fly"},
        {"do": "gesture", "layer": "legs"},
        {"do": "gesture", "tags": "x"},
        {"do": "gesture", "tags": [1]},
        {"do": "gesture", "priority": 1.5},
        {"do": "gesture", "at": -1},
        {"do": "gesture", "at": "now"},
        {"do": "gesture", "hold": 1e9},
        {"do": "gesture", "prepare": 1},
        {"do": "gesture", "colour": "red"},
        {"do": "action"},
        {"do": "action", "action": ""},
        {"do": "stance", "stance": None},
        {"do": "look", "to": [1, 2]},
        {"do": "look", "to": [1, 2, "3"]},
        {"do": "look", "amount": 2},
        {"do": "say"},
        {"do": "say", "line": 1.5},
        {"do": "say", "line": "none"},
        {"do": "mode", "mode": "x"},
        {"do": "place", "name": "x"},
        {"do": "place", "point": [1, 2, 3]},
        {"do": "blink", "after": "x"},
        {"do": "stance", "stance": "none"},
        {"do": "bml", "bml": ""},
        {"do": "gesture", "tags": ["none such"]},
    ]
    right: list[Any] = [
        {"do": "gesture"},
        {"do": "gesture", "at": None, "limb": None, "stroke": 9},
        {"do": "say", "text": "Größe, ты 日本 🙂!"},
        {"do": "look", "to": "user", "duration": 2},
        {"do": "blink"},
        {"do": "mode", "mode": None},
        {"do": "withdraw"},
        {"do": "place", "name": "x", "point": [1, 2, 3]},
    ]
    body = """
var character = Character.new(read(words()[0]), {"idle": false})
var ids = []
for request in words()[1]:
	ids.append(character.ask(request))
for n in range(12):
	character.update(n)
	character.pose()
for id in ids:
	out.append(character.answer(id))
"""
    answers = run(game, body, str(PERFORM), wrong)
    for request, answer in zip(wrong, answers, strict=True):
        assert answer["state"] == "refused", request
        assert answer["why"], request
    for request in right:
        (answer,) = run(game, body, str(PERFORM), [request])
        assert answer["why"] in ("", "nothing came of it") or answer["state"] != "refused", request


@needs_godot
def test_a_fault_of_its_own_does_not_stop_the_game(game: Path) -> None:
    body = """
var graph = read(words()[0])
var character = Character.new(graph, {"seed": 3})
var settings = graph.settings
graph.settings = {}
var id = character.ask({"do": "nod"})
character.update(1.0)
out.append(character.answer(id).state)
graph.settings = settings
var again = character.ask({"do": "nod"})
character.update(2.0)
out.append(character.answer(again).state)
out.append(character.pose().rotations.size())
"""
    failed, again, joints = run(game, body, str(PERFORM), fails=True)
    assert (failed, joints) == ("refused", 18)
    assert again in ("planned", "late")


@needs_godot
def test_letters_are_read_as_python_reads_them(game: Path) -> None:
    from metagraph.playback.life.alphabet import ALPHABET
    from metagraph.playback.life.graphemes import spelled
    from metagraph.playback.life.voice import voice_from_text

    texts = [
        "Hello there, how are you?",
        "Thought - tion sch.",
        "Größe über Straße!",
        "Ποιος είσαι; Ξέρω.",
        "Хорошо, ещё щука",
        "日本語が好き",
        "한국어 말",
        "naïve e\u0301te\u0301",
        "x2 30 (ok)",
        "  \u3000blank\u00a0 ",
        "🙂 fun",
        "…",
        "Հայերեն",
        "ĲŉǄ",
    ]
    body = """
var graph = read(words()[0])
var Voice = load("res://addons/metagraph/core/voice.gd")
var Graphemes = load("res://addons/metagraph/core/graphemes.gd")
for text in words()[1]:
	var voice = Voice.of(graph, {"line": null, "text": text, "start": 0.0, "end": 2.0, "length": null})
	var said = Graphemes.spelled(graph.alphabet, text, 2.0)
	var shapes = []
	for piece in said.pieces:
		shapes.append(piece.viseme)
	out.append([shapes, said.peaks, said.strengths, voice.accents, voice.weights])
"""
    for text, (shapes, peaks, strengths, accents, weights) in zip(
        texts, run(game, body, str(PERFORM), texts), strict=True
    ):
        expected = spelled(ALPHABET, text, 2.0)
        assert shapes == [p.viseme for p in expected.pieces], text
        voice = voice_from_text(text, 2.0)
        for ours, theirs in (
            (peaks, expected.peaks),
            (strengths, expected.strengths),
            (accents, voice.accents.tolist()),
        ):
            assert ours == pytest.approx(theirs, abs=1e-5), text
        assert len(weights) == len(voice.weights)
        for ours, theirs in zip(weights, voice.weights.tolist(), strict=True):
            assert ours == pytest.approx(theirs, abs=1e-4), text


@needs_godot
def test_seconds_are_written_as_python_writes_them(game: Path) -> None:
    chance = random.Random(2)
    numbers = [
        1.0005,
        1.0015,
        2.0625,
        2.1875,
        1.9995,
        1.99951,
        12.0005,
        3.5,
        7.0,
        1.0624999999,
        1000.0625,
        1.4375,
    ]
    numbers += [round(chance.uniform(1, 2000) * 16000) / 16000 for _ in range(200)]
    numbers += [chance.uniform(1, 500) for _ in range(200)]
    body = """
var Util = load("res://addons/metagraph/core/util.gd")
for number in words()[0]:
	out.append(Util.thousandths(number[0] + number[1]))
"""
    # In two parts, each exact in any reader of decimals.
    parts = [[float(int(x)), x - int(x)] for x in numbers]
    assert run(game, body, parts) == [f"{a + b:.3f}" for a, b in parts]


@needs_godot
def test_the_node_moves_a_skeletons_bones(game: Path) -> None:
    """Bones have other rests and small letters, as importers of Godot 3 leave them."""
    (game / "node.gd").write_text(NODE)
    for file in (PERFORM, PERFORM.with_suffix(".glb")):
        shutil.copy(file, game / f"stick{file.suffix}")
    code, told = godot(game, "node.gd")
    assert code == 0, told
    out = json.loads(next(line for line in told.splitlines() if line.startswith("OUT "))[4:])
    assert out["bones"] == 18
    assert out["apart"] < 1e-4
    assert out["moved"] > 0.01
    assert out["began"] >= 1
    assert out["answer"] in ("planned", "late")  # the line makes a gesture of its own
    assert out["broken"] == "refused"
    assert out["said"] == [True, "said#1", 0, ["said#2", "said#3"], True, True, "", []], (
        "lines have their own"
    )


NODE = """extends SceneTree
const Node3 = preload("res://addons/metagraph/godot3/metagraph_character.gd")
var avatar
var broken
var skeleton
var frames = 0
var began = 0
var asked
var first
var moved = 0.0
var said

func _init():
	var data = parse_json(Node3.Shim.text_of(Node3.Shim.read_bytes("res://stick.json")))
	skeleton = Skeleton.new()
	var names = []
	for joint in data.joints:
		skeleton.add_bone(joint.name.to_lower())
		names.append(joint.name)
		if joint.parent != null:
			skeleton.set_bone_parent(names.size() - 1, names.find(joint.parent))
		skeleton.set_bone_rest(names.size() - 1, Transform(Basis(Vector3(0.1, 0.2, 0.3)), Vector3(0.0, 0.1, 0.0)))
	root.add_child(skeleton)
	avatar = Node3.new()
	avatar.json_path = "res://stick.json"
	avatar.glb_path = "res://stick.glb"
	root.add_child(avatar)
	avatar.skeleton_path = avatar.get_path_to(skeleton)
	avatar._ready()
	avatar.connect("began", self, "_on_began")
	asked = avatar.gesture([], {"after": 0.5})
	avatar.look(Vector3(1.0, 1.5, 2.0))
	said = [avatar.say("hello").begins_with("#"), avatar.say("no such line"), avatar.say_piece("Hello").size()]
	said.append(avatar.say_piece(" there! No", true))
	said.append(avatar.say("Hello you", {"gestures": false}).begins_with("#"))
	avatar.gestures = false
	said.append(avatar.say("Hello you").begins_with("#"))
	avatar.go("none such")
	broken = Node3.new()
	broken.json_path = "res://none.json"
	root.add_child(broken)

func _on_began(_action, _layer, _meta):
	began += 1

func _iteration(_delta):
	frames += 1
	avatar._process(0.05)
	broken._process(0.05)
	var pose = avatar.character.pose()
	var joint = 9
	var local = skeleton.get_bone_rest(joint) * skeleton.get_bone_pose(joint)
	if first == null:
		first = local
	moved = max(moved, local.basis.x.distance_to(first.basis.x))
	if frames < 60:
		return false
	var d = Quat(local.basis).inverse() * pose.rotations[joint]
	var out = {
		said = said + [broken.say("x"), broken.say_piece("x", true)], bones = avatar._bones.size(), began = began, answer = avatar.answer(asked).state, broken = broken.answer("x").state,
		apart = Vector3(d.x, d.y, d.z).length() + local.origin.distance_to(pose.translations[joint]),
		moved = moved
	}
	print("OUT " + to_json(out))
	quit()
	return true
"""


# --- Godot 4, which is not here


def test_every_script_for_godot_4_is_gdscript_2() -> None:
    parser = pytest.importorskip(
        "gdtoolkit.parser", reason="gdtoolkit is not here (pip install gdtoolkit)"
    ).parser
    scripts = sorted(path for path in ADDON.rglob("*.gd") if path.parent.name != "godot3")
    assert len(scripts) > 30
    for path in scripts:
        parser.parse(path.read_text(encoding="utf-8"), gather_metadata=False)


def test_the_readme_names_files_that_its_export_writes_and_calls_the_node_has(
    sample: Project, tmp_path: Path
) -> None:
    """Godot 4 is not here to run it: it is parsed, and what it names is looked up."""
    text = (ADDON.parent / "README.md").read_text(encoding="utf-8")
    examples = [block.split("```")[0] for block in text.split("```gdscript\n")[1:]]
    assert len(examples) == 4
    parser = pytest.importorskip("gdtoolkit.parser", reason="gdtoolkit is not here").parser
    for each in examples:
        parser.parse(each, gather_metadata=False)
    example = "".join(examples)
    made = registry.write(sample, "godot", tmp_path)
    written = {path.relative_to(tmp_path).as_posix() for path in made.files}
    named = {name.replace(".motion", ".glb") for name in re.findall(r"res://([\w.]+)", example)}
    assert named == {"sample.json", "sample.glb"} and named <= written, "the .motion is a copy of the .glb"
    assert (
        re.findall(r'preload\("res://([^"]+)"\)', text) == ["addons/metagraph/godot3/metagraph_character.gd"]
        and "addons/metagraph/godot3/metagraph_character.gd" in written
    )
    node = (ADDON / "metagraph" / "metagraph_character.gd").read_text(encoding="utf-8")
    for name in set(re.findall(r"avatar\.(\w+)", example)):
        assert re.search(rf"^(@export\S* )*(\(.*\) )?.*\b(var|func|signal) {name}\b", node, re.M), name


def test_what_differs_between_the_engines_is_in_the_shims_alone() -> None:
    """Words that only one of the two knows, or that mean different things in both."""
    apart = (
        "Quat(",
        "Quaternion(",
        "PoolByteArray",
        "PackedByteArray",
        "File.",
        "FileAccess",
        "JSON.",
        ".to_utf8",
        ".empty()",
        ".is_empty()",
        ".remove(",
        ".remove_at(",
        "deg2rad",
        "deg_to_rad",
        ".slice(",
        ".instance()",
        "yield(",
        "await ",
        ".xform(",
        "ord(",
        "char(",
        " min(",
        " max(",
        " clamp(",
        "(min(",
        "(max(",
        ".sort_custom(",
        "stepify",
        "TYPE_REAL",
        "TYPE_FLOAT",
        "OS.get_ticks",
        "Time.",
    )
    core = ADDON / "metagraph" / "core"
    for path in [*core.glob("*.gd"), ADDON / "metagraph" / "conformance.gd"]:
        if path.name.startswith("shim") or path.name == "hashing.gd":  # which asks for the version
            continue
        code = "\n".join(line.split("#")[0] for line in path.read_text(encoding="utf-8").splitlines())
        assert not [word for word in apart if word in code], path.name
    shims = [(core / f"shim{n}.gd").read_text().split("static func ")[1:] for n in (3, 4)]
    assert [f.split("(")[0] for f in shims[0]] == [f.split("(")[0] for f in shims[1]]
