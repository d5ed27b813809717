"""Characters of the Godot runtime never fail in play, and move a skeleton's bones."""

from __future__ import annotations

import json
import random
import shutil
from pathlib import Path
from typing import Any

import pytest

from tests.engines.godot_runtime import PERFORM, godot, needs_godot, run


@pytest.mark.nightly
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


@pytest.mark.nightly
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
    from metagraph.playback.life.voice import guess_voice

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
	var voice = Voice.of(graph, {"line": null, "text": text, "start": 0.0, "end": 2.0, "length": null, "skip": 0.0})
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
        voice = guess_voice(text, 2.0)
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


@pytest.mark.nightly
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
const Node3 = preload("res://addons/metagraph/metagraph_character.gd")
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
