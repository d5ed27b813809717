"""The Godot runtime: it conforms on a real engine, says what is wrong with bad input, and its rules are tested."""

from __future__ import annotations

import copy
import json
import random
import re
import shutil
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from metagraph.engines.targets import registry
from metagraph.graph.model import Project
from tests.engines.godot_runtime import ADDON, GODOT3, PERFORM, STICK, godot, needs_godot, run
from tests.engines.mutants import PLAYED, broken, folders_to_try, share_of
from tests.thorough import many, some


@pytest.mark.nightly
@needs_godot
@pytest.mark.parametrize("folder", PLAYED, ids=lambda folder: folder.name)
def test_shipped_vectors_pass_on_the_engine(game: Path, folder: Path, tmp_path: Path) -> None:
    folder = share_of(folder, "godot", tmp_path)
    code, told = godot(game, "addons/metagraph/conformance.gd", folder)
    assert code == 0, told
    cases = json.loads((folder / "vectors.json").read_bytes())["cases"]
    assert f"{len(cases)} passed, 0 failed" in told


@pytest.mark.nightly
@needs_godot
def test_vectors_of_the_sample_pass_on_the_engine(game: Path, sample_export: Path) -> None:
    """They are of the shipped vectors' kinds, which all pass here, on sixty joints with a face."""
    assert len(json.loads((sample_export / "vectors.json").read_bytes())["cases"]) > 50
    code, told = godot(game, "addons/metagraph/conformance.gd", sample_export)
    assert code == 0, told
    assert " 0 failed" in told


@pytest.mark.nightly
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
    "what has been said of a line stands": (
        "items.gd",
        "Util.most(now - find_line_start(old), old.skip)",
        "0.0",
    ),
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
    "what is too late": (
        "punctuality.gd",
        "if least > allowed + CueShapes.FITS:",
        "if least > allowed + 9.0:",
    ),
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


@pytest.mark.nightly
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


@pytest.mark.nightly
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


@pytest.mark.nightly
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


@pytest.mark.nightly
@needs_godot
def test_a_glb_of_another_export_is_told(game: Path, tmp_path: Path) -> None:
    data = json.loads(PERFORM.read_bytes())
    glb = PERFORM.with_suffix(".glb").read_bytes()
    said = []
    for length in (len(glb), len(glb) + 4):
        (tmp_path / f"{length}.json").write_text(json.dumps({**data, "glb_bytes": length}))
        (tmp_path / f"{length}.glb").write_bytes(glb)
        said.append(run(game, "out.append(read(words()[0]).problems)", str(tmp_path / f"{length}.json"))[0])
    assert said[0] == [] and len(said[1]) == 1
    assert "is not the GLB that this JSON was written with" in said[1][0]


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
    other, lost = problems
    assert "is not the GLB that this JSON was written with" in other and gone in lost
    assert set(sizes) == {18}


# --- Godot 4, which is not here


@pytest.mark.nightly
def test_every_script_for_godot_4_is_gdscript_2() -> None:
    parser = pytest.importorskip(
        "gdtoolkit.parser", reason="gdtoolkit is not here (pip install gdtoolkit)"
    ).parser
    scripts = sorted(ADDON.rglob("*.gd"))
    assert len(scripts) > 30
    for path in scripts:
        parser.parse(path.read_text(encoding="utf-8"), gather_metadata=False)


@pytest.mark.nightly
def test_the_readme_names_files_that_its_export_writes_and_calls_the_node_has(
    sample: Project, tmp_path: Path
) -> None:
    """What the examples name is looked up."""
    text = (ADDON / "metagraph" / "README.md").read_text(encoding="utf-8")
    examples = [block.split("```")[0] for block in text.split("```gdscript\n")[1:]]
    assert len(examples) == 4
    parser = pytest.importorskip("gdtoolkit.parser", reason="gdtoolkit is not here").parser
    for each in examples:
        parser.parse(each, gather_metadata=False)
    example = "".join(examples)
    made = registry.write_for_target(sample, "godot", tmp_path)
    written = {path.relative_to(tmp_path).as_posix() for path in made.files}
    assert set(re.findall(r"res://([\w.]+)", example)) == {"sample.json"} <= written
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
        assert not [word for word in apart if re.search(rf"(?<!\w){re.escape(word)}", code)], path.name
    shims = [
        (folder / name).read_text().split("static func ")[1:]
        for folder, name in ((GODOT3 / "metagraph" / "core", "shim3.gd"), (core, "shim4.gd"))
    ]
    assert [f.split("(")[0] for f in shims[0]] == [f.split("(")[0] for f in shims[1]]
