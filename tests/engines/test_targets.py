"""Targets: what is written for an engine is loaded by that engine and does there what it says."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from types import ModuleType
from typing import Any
from xml.etree import ElementTree

import msgspec
import numpy as np
import pytest

from metagraph.engines.engine_machine import list_machines, make_animations
from metagraph.engines.export_error import ExportError
from metagraph.engines.targets import registry
from metagraph.engines.targets.agents import make_gesture_file
from metagraph.engines.targets.target import Contents, TargetReport
from metagraph.formats.bvh.file import read_bvh
from metagraph.formats.gltf.reader import read_gltf_clips
from metagraph.graph import edits
from metagraph.graph.anatomy import get_base_pose, project_roles
from metagraph.graph.expand import find_chain, find_end_stance, list_connections
from metagraph.graph.model import LAYERS, Project
from metagraph.graph.requests import Nod, Performance, Say
from metagraph.motion import rotation
from metagraph.playback.bml.reader import read_bml
from metagraph.playback.planner import make_plan
from tests.engines.test_export import gltf, khronos
from tests.posing import pose_at
from tests.recipes import code_of

HERE = Path(__file__).parent
MODULES = HERE.parent / "node_modules"
MANNEQUIN = HERE.parents[1] / "sample_clips" / "mannequin.glb"


def run(script: str, package: str, *arguments: Any) -> list[Any]:
    """Run one of `tests/engines/run` in Node; return what it prints, a JSON a line."""
    if shutil.which("node") is None or not (MODULES / package).is_dir():
        pytest.skip(f"needs Node and {package} (python3 run.py test fetches it where npm is)")
    done = subprocess.run(
        ["node", str(HERE / "run" / script), *map(str, arguments)],
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert done.returncode == 0, done.stderr[-2000:]
    return [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]


@pytest.fixture(scope="module")
def written(sample: Project, tmp_path_factory: pytest.TempPathFactory) -> Any:
    """Write the sample for a target, once."""
    known: dict[str, TargetReport] = {}

    def of(name: str) -> TargetReport:
        if name not in known:
            known[name] = registry.write_for_target(
                sample, name, tmp_path_factory.mktemp(name), Contents(MANNEQUIN)
            )
        return known[name]

    return of


def steps(folder: Path, *rows: dict[str, Any]) -> Path:
    path = folder / "steps.json"
    path.write_text(json.dumps(rows))
    return path


def named(report: TargetReport, ending: str) -> Path:
    return next(path for path in report.files if path.name.endswith(ending))


# --- all of them


@pytest.mark.parametrize("name", registry.list_targets())
def test_every_target_writes_what_it_says_and_glbs_the_validator_accepts(written: Any, name: str) -> None:
    report = written(name)
    assert report.files and all(path.is_file() and path.stat().st_size for path in report.files)
    if glbs := [path for path in report.files if path.suffix == ".glb"]:
        khronos(*glbs, warnings=False)


def _leads(page: Path, to: str) -> bool:
    file, _, heading = to.partition("#")
    there = page.parent / file if file else page
    if not there.is_file():
        return False
    headings = re.findall(r"^#+ (.+)$", there.read_text(encoding="utf-8"), re.MULTILINE)
    return not heading or heading in [
        re.sub(r"[^\w -]", "", each.lower()).replace(" ", "-") for each in headings
    ]


@pytest.mark.parametrize("name", registry.list_targets())
def test_links_of_pages_that_are_exported_lead_to_what_is_exported(written: Any, name: str) -> None:
    for page in [path for path in written(name).files if path.suffix == ".md"]:
        links = re.findall(r"\]\(([^)\s]+)", page.read_text(encoding="utf-8"))
        lost = [to for to in links if not to.startswith("https://") and not _leads(page, to)]
        assert not lost, page


@pytest.mark.parametrize("name", registry.list_targets())
def test_pages_that_are_exported_name_no_file_of_ours_that_is_not(written: Any, name: str) -> None:
    report = written(name)
    there = [path.as_posix() for path in report.files]
    for page in [path for path in report.files if path.suffix == ".md"]:
        said = re.findall(r"`([\w.-]+(?:/[\w.-]+)+\.[a-z]+)`", page.read_text(encoding="utf-8"))
        assert not [file for file in said if not any(path.endswith(f"/{file}") for path in there)], page


@pytest.mark.parametrize("name", ["javascript", "godot", "unity", "cpp", "unreal"])
def test_a_runtime_brings_its_licence(written: Any, name: str) -> None:
    (licence,) = [path for path in written(name).files if path.stem == "LICENSE"]
    assert licence.read_bytes() == (HERE.parents[1] / "LICENSE").read_bytes()


@pytest.mark.parametrize("name", registry.list_targets())
def test_every_target_but_those_that_play_it_all_says_what_it_loses(sample: Project, name: str) -> None:
    told = registry.describe_losses(sample, name)
    assert all("{n}" not in words and words for words in told)
    assert told or name in ("metagraph", "python")


def test_losses_count_what_the_project_has(sample: Project) -> None:
    partial = sum(a.limb != "both" or bool(a.joints) for a in sample.actions())
    assert any(
        words.startswith(f"{partial} actions") for words in registry.describe_losses(sample, "playcanvas")
    )
    weighted = edits.set_weight(sample, "arms", "spine", 0.5)
    assert any("1 layer weight other" in words for words in registry.describe_losses(weighted, "playcanvas"))
    assert not any("layer weight" in words for words in registry.describe_losses(sample, "playcanvas"))
    wave = next(a.id for a in sample.actions() if a.kind == "gesture")
    repeats = edits.update_actions(sample, [wave], timing={"repeat": 4.0})
    assert any(
        words.startswith("1 action repeats") for words in registry.describe_losses(repeats, "playcanvas")
    )
    assert not any("repeats for" in words for words in registry.describe_losses(sample, "playcanvas"))


@pytest.mark.parametrize("name", sorted(registry.list_targets()))
def test_every_target_says_that_conversations_are_left_out(sample: Project, name: str) -> None:
    assert sample.conversations
    words = f"{len(sample.conversations)} conversation"
    assert any(loss.startswith(words) for loss in registry.describe_losses(sample, name))
    assert not any(
        "conversation" in loss for loss in registry.describe_losses(replace(sample, conversations={}), name)
    )


def test_a_target_that_does_not_exist_is_told_with_the_nearest(sample: Project, tmp_path: Path) -> None:
    with pytest.raises(ExportError, match="did you mean 'playcanvas'"):
        registry.write_for_target(sample, "playcanvass", tmp_path)


def test_a_target_comes_by_its_module_and_its_line(
    sample: Project, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The target that the page "Add a target" has as its recipe."""
    module = ModuleType("metagraph.engines.targets.uses")
    exec(code_of("Add a target"), vars(module))
    monkeypatch.setitem(sys.modules, module.__name__, module)
    monkeypatch.setattr(registry, "MODULES", (*registry.MODULES, "uses"))
    registry.list_targets.cache_clear()
    try:
        report = registry.write_for_target(sample, "uses", tmp_path)
    finally:
        registry.list_targets.cache_clear()
    path, readme = report.files
    counts = json.loads(path.read_text())
    assert sum(counts.values()) == sum(1 for _ in sample.actions())
    assert f"`{path.name}`" in readme.read_text(encoding="utf-8")


def test_a_project_with_errors_is_not_written(tmp_path: Path) -> None:
    with pytest.raises(ExportError, match="nothing to export"):
        registry.write_for_target(Project(), "xstate", tmp_path / "out")


# --- the machine they are made of


def test_the_machine_has_a_state_for_each_action_and_an_arrow_for_each_connection(sample: Project) -> None:
    built = list_machines(sample)
    assert [m.layer for m in built] == list(LAYERS)
    names = [s.name for m in built for s in m.states]
    assert len(set(names)) == len(names) == sum(1 for _ in sample.actions())
    for machine in built:
        pairs = {(a.source.action.id, a.target.action.id) for a in machine.arrows}
        assert pairs == {(c.source, c.target) for c in list_connections(sample, machine.graph)}


def test_a_stance_is_reached_from_every_other_by_following_its_arrows(sample: Project) -> None:
    for machine in list_machines(sample):
        for goal, number in machine.stances.items():
            for begin in machine.stances:
                at, hops = begin, 0
                while at != goal and hops <= len(machine.stances):
                    ways = [
                        a
                        for a in machine.leaving[machine.rest(at).name]
                        if a.on == "stance" and number in a.values
                    ]
                    assert len(ways) == 1
                    at, hops = str(find_end_stance(ways[0].target.action)), hops + 1
                assert at == goal


@pytest.mark.nightly
def test_animations_are_the_parts_that_play_on_nodes_that_stand_in_the_base_pose(
    sample: Project, written: Any
) -> None:
    built = list_machines(sample)
    made = make_animations(sample, built)
    assert [c.name for c in made] == [s.name for m in built for s in m.states]
    for clip, state in zip(made, (s for m in built for s in m.states), strict=True):
        assert clip.duration == pytest.approx(state.seconds, abs=1e-6) or state.seconds == 0
    path = named(written("playcanvas"), ".glb")
    nodes = {n["name"]: n for n in gltf(path)["nodes"]}
    base = get_base_pose(sample)
    assert sample.skeleton is not None
    for place, joint in enumerate(sample.skeleton.names):
        assert np.allclose(nodes[joint]["rotation"], base.rotations[place], atol=1e-6)
    assert [c.name for c in read_gltf_clips(path)] == [c.name for c in made]


@pytest.mark.nightly
def test_an_animation_of_an_action_that_moves_a_joint_in_part_has_it_as_far_from_how_its_stance_begins(
    sample: Project,
) -> None:
    action = next(
        a for a in sample.graphs["arms"].actions.values() if a.kind == "gesture" and a.limb == "both"
    )
    skeleton = sample.skeleton
    assert skeleton is not None
    joint = project_roles(sample)["right_upper_arm"]
    soft = edits.update_actions(sample, [action.id], joint_weights=((skeleton.names[joint], 0.5),))
    built = list_machines(sample)
    place = [s.action.id for m in built for s in m.states].index(action.id)
    whole = make_animations(sample, built)[place].rotations[:, joint]
    half = make_animations(soft, list_machines(soft))[place].rotations[:, joint]
    loop = next(iter(sample.graphs["arms"].of(action.stance, "stance")))
    motion = sample.clips[loop.clip].motion
    assert motion is not None
    rest = motion.pose_at(sample.span(loop)[0]).rotations[joint]
    far, gone = rotation.measure_angle_between(rest, whole), rotation.measure_angle_between(rest, half)
    assert far.max() > 0.1 and np.allclose(gone, far / 2, atol=1e-3)
    told = registry.describe_losses(soft, "unity-controller")
    assert any(words.startswith("1 action has partial joint weights") for words in told)


# --- engines


@pytest.mark.nightly
def test_playcanvas_rests_as_the_preview_does_changes_stance_and_adds_a_gesture(
    sample: Project, written: Any, tmp_path: Path
) -> None:
    report = written("playcanvas")
    numbers = json.loads(named(report, "numbers.json").read_bytes())
    stance = numbers["arms"]["stance"]["on hips"]
    nod = next(n for name, n in numbers["head"]["action"].items() if "head_nod" in name)
    script = steps(
        tmp_path,
        {"seconds": 1.0},
        {"seconds": 0.4, "integers": {"arms_stance": stance}},
        {"seconds": 3.0},
        {"seconds": 0.5, "integers": {"head_action": nod}, "triggers": ["head_play"]},
        {"seconds": 4.0},
    )
    rest, going, there, nodding, after = run(
        "playcanvas.mjs", "playcanvas", named(report, "graph.json"), named(report, ".glb"), script
    )
    assert sample.skeleton is not None
    _, positions = sample.skeleton.globals(
        pose_at(make_plan(sample, 5.0, idle=False), sample, 1.0, alive=False)
    )
    for place, joint in enumerate(sample.skeleton.names):
        assert np.linalg.norm(np.array(rest["joints"][joint]["position"]) - positions[place]) < 0.003, joint
    assert going["states"]["arms"].startswith("arms_to_on_hips")
    assert there["states"]["arms"] == "arms_on_hips"
    assert (
        nodding["states"] == {**there["states"], "head": nodding["states"]["head"]}
        and "head_nod" in nodding["states"]["head"]
    )
    assert after["states"] == there["states"]
    head, hand = (
        np.array([row["joints"][joint]["rotation"] for row in (there, nodding)])
        for joint in ("Head", "LeftHand")
    )
    assert (
        abs(head[0] @ head[1]) < 0.9999 and abs(hand[0] @ hand[1]) > 0.9995
    )  # the head moves, what the arms do goes on


def test_xstate_goes_to_a_stance_and_plays_a_gesture_on_its_clock(written: Any, tmp_path: Path) -> None:
    chart = named(written("xstate"), ".json")
    nod = next(s for s in json.loads(chart.read_bytes())["states"]["head"]["states"] if "head_nod" in s)
    script = steps(
        tmp_path,
        {"seconds": 1.0},
        {"seconds": 0.1, "events": ["arms.stance.on_hips", f"head.action.{nod}"]},
        {"seconds": 6.0},
        {"seconds": 0.1, "events": ["arms.stance.nowhere", "nonsense"]},
    )
    rest, going, there, still = run("xstate.mjs", "xstate", chart, script)
    assert rest["states"]["arms"] == "arms_hands_at_sides"
    assert [p["animation"] for p in rest["played"]] == list(rest["states"].values()), "its first loops"
    assert all(p["loop"] and p["blend"] == 0 for p in rest["played"])
    assert going["states"]["arms"] == "arms_to_on_hips_from_hands_at_sides" and going["states"]["head"] == nod
    assert {p["animation"] for p in going["played"]} == {"arms_to_on_hips_from_hands_at_sides", nod}
    assert there["states"]["arms"] == "arms_on_hips" and there["states"]["head"] == rest["states"]["head"]
    assert still["states"] == there["states"]
    assert still["played"] == [{"missed": "arms.stance.nowhere"}], "what no layer is asked for is nobody's"
    script = steps(
        tmp_path,
        {"seconds": 0.1, "events": [f"head.action.{nod}"]},
        {"seconds": 0.1, "events": [f"head.action.{nod}", "arms.stance.on_hips"]},
    )
    _, again = run("xstate.mjs", "xstate", chart, script)
    assert [p.get("missed", p.get("animation")) for p in again["played"]] == [
        f"head.action.{nod}",
        "arms_to_on_hips_from_hands_at_sides",
    ], "what comes too early is told, and only for its layer"


@pytest.mark.nightly
def test_babylon_plays_the_behaviour_graph_without_code(written: Any, tmp_path: Path) -> None:
    report = written("interactivity")
    events = json.loads(named(report, "events.json").read_bytes())
    wave, go = (next(e for e in events if word in e) for word in ("wave_hello", "arms_to_on_hips"))
    script = steps(
        tmp_path,
        {"seconds": 1.0},
        {"seconds": 1.0, "events": [wave]},
        {"seconds": 3.0},
        {"seconds": 4.0, "events": [go]},
        {"seconds": 0.5, "events": [wave]},
    )
    rest, waving, back, hips, deaf = run(
        "interactivity.mjs", "@babylonjs/loaders", named(report, ".glb"), script
    )
    assert (
        rest["playing"]
        == ["body_weight_both", "arms_hands_at_sides", "head_head_straight"]
        == back["playing"]
    )
    assert waving["playing"][1] == wave.removeprefix("arms.action.")
    assert waving["joints"]["RightHand"][1] > rest["joints"]["RightHand"][1] + 0.3
    assert (
        hips["playing"][1] == "arms_on_hips" == deaf["playing"][1]
    )  # a gesture of another stance is passed over


@pytest.mark.nightly
def test_babylon_goes_to_a_stance_by_as_many_transitions_as_it_takes(
    sample: Project, written: Any, tmp_path: Path
) -> None:
    report = written("interactivity")
    events = json.loads(named(report, "events.json").read_bytes())
    (machine,) = (m for m in list_machines(sample) if m.layer == "arms")
    pairs = [(a, b) for a in machine.stances for b in machine.stances if a != b]
    here, goal = max(pairs, key=lambda pair: len(find_chain(machine.graph, *pair) or ()))
    assert len(find_chain(machine.graph, here, goal) or ()) == 2
    wave = next(e for e in events if "wave_hello" in e)
    to_here, to_goal = (f"arms.stance.{machine.stance_words[x]}" for x in (here, goal))
    assert {to_here, to_goal} <= set(events)
    script = steps(
        tmp_path,
        {"seconds": 0.5},
        {"seconds": 0.5, "events": [wave]},
        {"seconds": 0.3, "events": [to_here]},  # while it plays: it goes there afterwards
        {"seconds": 6.0},
        {"seconds": 7.0, "events": [to_goal]},
        {"seconds": 0.5, "events": [to_goal, "arms.stance.nowhere"]},
    )
    played = run("interactivity.mjs", "@babylonjs/loaders", named(report, ".glb"), script)
    _, waving, still, there, beyond, stays = (row["playing"][1] for row in played)
    assert waving == still == wave.removeprefix("arms.action.")
    assert there == machine.rest(here).name
    assert beyond == stays == machine.rest(goal).name


def test_the_scxml_is_run_by_qt(written: Any, qtbot: Any) -> None:
    scxml = pytest.importorskip("PySide6.QtScxml", reason="needs PySide6-Addons")
    machine = scxml.QScxmlStateMachine.fromFile(str(named(written("scxml"), ".scxml")))
    assert not machine.parseErrors()
    machine.start()
    qtbot.waitUntil(lambda: "arms_hands_at_sides" in machine.activeStateNames(False), timeout=2000)
    machine.submitEvent("arms.stance.on_hips")
    qtbot.waitUntil(
        lambda: any(n.startswith("arms_to_on_hips") for n in machine.activeStateNames(False)), timeout=2000
    )
    qtbot.waitUntil(lambda: "arms_on_hips" in machine.activeStateNames(False), timeout=5000)
    machine.stop()


@pytest.mark.nightly
def test_the_scxml_names_an_animation_a_blend_and_a_state_there_is_everywhere(
    sample: Project, written: Any
) -> None:
    report = written("scxml")
    tree = ElementTree.parse(named(report, ".scxml"))
    main, ours = "{http://www.w3.org/2005/07/scxml}", "{urn:metagraph:scxml}"
    ids = {node.get("id") for node in tree.iter(f"{main}state")}
    clips = {clip.name for clip in read_gltf_clips(named(report, ".glb"))}
    assert {node.get(f"{ours}animation") for node in tree.iter(f"{main}state")} - {None} == clips
    for arrow in tree.iter(f"{main}transition"):
        assert arrow.get("target") in ids
        assert arrow.get("event", "").endswith(".leave") or float(arrow.get(f"{ours}blend", "nan")) >= 0


# --- agents


def test_the_blocks_of_bml_say_what_was_kept(sample: Project, written: Any) -> None:
    report = written("bml")
    kept = next(iter(sample.performances.values()))
    block = read_bml(named(report, f"{kept.name}.bml").read_text(), 0.0, 1, sample)
    assert [type(ask) for ask in block] == [type(ask) for ask in kept.asks]
    words = json.loads(named(report, "vocabulary.json").read_bytes())
    assert "hands at sides" in words["postures"]["arms"] and set(words["lines"]) == set(sample.lines)


def test_the_gesture_map_runs_in_smartbodys_place_and_names_motions_that_are_there(
    sample: Project, written: Any
) -> None:
    report = written("smartbody")
    rows: list[tuple[str, ...]] = []

    class Map:
        def addGestureMapping(self, *row: str) -> None:
            rows.append(row)

    class Scene:
        def getGestureMapManager(self) -> Scene:
            return self

        def createGestureMap(self, name: str) -> Map:
            return Map()

    exec(named(report, "gestures.py").read_text(), {"scene": Scene()})
    motions = {path.stem for path in report.files if path.suffix == ".bvh"}
    assert len(rows) == sum(a.kind == "gesture" for a in sample.actions())
    assert {row[0] for row in rows} | {row[5] for row in rows} <= motions
    assert {row[3] for row in rows} <= {"LEFT_HAND", "RIGHT_HAND", "BOTH_HANDS"}
    assert read_bvh(next(path for path in report.files if path.stem == rows[0][0])).frames > 1


@pytest.mark.nightly
def test_gesture_json_goes_in_holds_and_comes_out_in_order(written: Any) -> None:
    report = written("sumerian")
    clips = {clip.name: clip for clip in read_gltf_clips(named(report, ".glb"))}
    table = json.loads(named(report, "gesture.json").read_bytes())
    assert table
    for name, gesture in table.items():
        into, hold, out = gesture["queueOptions"]
        assert [into["name"], hold["name"], out["name"]] == ["in", "hold", "out"]
        assert 0 == into["from"] <= into["to"] == hold["from"] <= hold["to"] == out["from"] <= out["to"]
        assert out["to"] == pytest.approx(clips[name].duration * 30, abs=1)
        assert "loopCount" not in hold


def test_gesture_json_holds_a_gesture_that_repeats_for_its_whole_cycles(sample: Project) -> None:
    wave = next(a for a in sample.actions() if a.kind == "gesture")
    project = edits.update_actions(sample, [wave.id], timing={"start": 0.2, "end": 0.8, "repeat": 2.4})
    built = list_machines(project)
    name = next(s.name for m in built for s in m.states if s.action.id == wave.id)
    edges = [(each["from"], each["to"]) for each in make_gesture_file(project, built)[name]["queueOptions"]]
    assert edges == [(0, 18), (18, 54), (54, 72)]


@pytest.mark.nightly
def test_control_characters_in_names_and_texts_spoil_no_export(sample: Project, tmp_path: Path) -> None:
    """Whatever a target writes as XML is read by a parser; what was replaced is reported, and the rest is
    whole.
    """
    bad = "bell \x07 and \x1b[31m \ufffe"
    first, *rest = sample.actions()
    project = edits.update_actions(sample, [first.id, rest[0].id], tags=(bad,))
    project = edits.rename_stance(project, first.stance, bad)
    line = next(iter(project.lines))
    changed = msgspec.structs.replace(project.lines[line], text=bad)
    project = replace(project, name=f"ca\x01se {bad}", lines={**project.lines, line: changed})
    asks = (Say(text=bad), Nod(at=1.0))
    kept = Performance(name="kept", length=5.0, asks=asks)
    project = replace(project, performances={**project.performances, "p9999": kept})
    parsed = 0
    for name in ("bml", "scxml"):
        report = registry.write_for_target(project, name, tmp_path / name)
        for path in report.files:
            if path.suffix in (".bml", ".scxml", ".xml", ".svg"):
                ElementTree.parse(path)
                parsed += 1
        if name == "bml":
            assert any("\ufffd replaces them" in note for note in report.warnings)
            said = [read_bml(p.read_text()) for p in report.files if p.suffix == ".bml"]
            assert any(len(asks) == 2 for asks in said)
    assert parsed >= 3
