"""Godot's AnimationTree: the file for Godot 3 is played by Godot 3; the one for Godot 4 is whole and says the
same.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from metagraph.engines.engine_machine import Machine, list_machines
from metagraph.engines.export import make_export_stem
from metagraph.engines.targets import godot_tree
from metagraph.engines.targets.godot_tree import (
    TARGETS,
    find_owned_joints,
    list_track_paths,
    make_godot3_name,
)
from metagraph.engines.targets.target import Contents, ExportOrder
from metagraph.formats.gltf.reader import read_gltf_clips
from metagraph.graph import edits
from metagraph.graph.anatomy import get_base_pose
from metagraph.graph.expand import find_chain, find_end_stance
from metagraph.graph.model import Project
from metagraph.motion import rotation
from metagraph.motion.skeleton import Pose
from metagraph.playback.planner import make_plan
from tests.engines.godot_runtime import install_addon
from tests.posing import pose_at

HERE = Path(__file__).parent
MANNEQUIN = HERE.parents[1] / "sample_clips" / "mannequin.glb"
GODOT = shutil.which("godot3-server")
needs_godot = pytest.mark.skipif(
    GODOT is None, reason="godot3-server is not here (apt install godot3-server)"
)


@pytest.fixture(scope="module")
def folder(sample: Project, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The sample as the target writes it, in a Godot project with the runtime, whose GLB reader the test
    borrows.
    """
    place = tmp_path_factory.mktemp("game")
    install_addon(place)
    (place / "project.godot").write_text('config_version=4\n\n[application]\n\nconfig/name="test"\n')
    shutil.copy(HERE / "run" / "godot_tree.gd", place)
    made = TARGETS[0].write(ExportOrder(sample, place, make_export_stem(sample), Contents(MANNEQUIN)))
    assert all(path.is_file() and path.stat().st_size for path in made.files)
    return place


def play(folder: Path, sample: Project, animations: set[str], *steps: dict[str, Any]) -> list[Any]:
    """Let Godot 3 play steps with its tree; `animations` are those that may be seen."""
    assert sample.skeleton is not None
    stem, built = make_export_stem(sample), list_machines(sample)
    order = {
        "glb": f"res://{stem}.glb",
        "tree": f"res://{stem}.godot3.tres",
        "layers": [m.layer for m in built],
        "bones": {joint: make_godot3_name(joint) for joint in sample.skeleton.names},
        "loops": [s.name for m in built for s in m.states if s.loop],
        "play": sorted(animations),
        "steps": steps,
    }
    (folder / "order.json").write_text(json.dumps(order))
    env = {**os.environ, "HOME": str(folder), "LC_ALL": "C.UTF-8"}
    command = [str(GODOT), "--no-window", "-s", "godot_tree.gd", "res://order.json"]
    done = subprocess.run(
        command, cwd=folder, env=env, capture_output=True, text=True, errors="replace", timeout=300
    )
    told = done.stdout + done.stderr
    assert done.returncode == 0 and "SCRIPT ERROR" not in told, told[-3000:]
    return [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]


def layer_of(sample: Project, name: str) -> Machine:
    return next(m for m in list_machines(sample) if m.layer == name)


def resting(sample: Project, seconds: float) -> Pose:
    """Return the pose of the start loops where each joint has one layer's alone."""
    assert sample.skeleton is not None
    base = get_base_pose(sample)
    turns, shifts = np.array(base.rotations, float), np.array(base.translations, float)
    built = list_machines(sample)
    for machine in built:
        clip = sample.clips[machine.start.action.clip].motion
        assert clip is not None
        pose = clip.pose_at(sample.span(machine.start.action)[0] + seconds)
        for joint in find_owned_joints(sample, built)[machine.layer]:
            place = sample.skeleton.index(joint)
            turns[place], shifts[place] = pose.rotations[place], pose.translations[place]
    return Pose(turns, shifts)


# --- in Godot 3


@pytest.mark.nightly
@needs_godot
def test_godot_rests_changes_stance_and_comes_back_from_a_gesture(folder: Path, sample: Project) -> None:
    arms, head = layer_of(sample, "arms"), layer_of(sample, "head")
    nod = next(s.name for s in head.states if "nod_emphatic" in s.name)
    wave = next(s.name for s in arms.states if "wave_hello" in s.name)
    seen = {
        s.name for m in list_machines(sample) for s in m.states if s.loop or s.action.kind == "transition"
    } | {
        nod,
        wave,
    }
    rest, going, there, nodding, after, waving, back = play(
        folder, sample, seen,
        {"seconds": 1.0},
        {"seconds": 0.4, "travel": {"arms": "arms_on_hips"}},
        {"seconds": 3.0},
        {"seconds": 0.4, "travel": {"head": nod}},
        {"seconds": 4.0},
        {"seconds": 2.5, "travel": {"arms": wave}},
        {"seconds": 5.0},
    )  # fmt: skip
    assert rest["states"] == {m.layer: m.start.name for m in list_machines(sample)}
    assert sample.skeleton is not None
    alone = sample.skeleton.globals(resting(sample, 1.0))[1]
    preview = sample.skeleton.globals(pose_at(make_plan(sample, 5.0, idle=False), sample, 1.0, alive=False))[
        1
    ]
    for place, joint in enumerate(sample.skeleton.names):
        position = np.array(rest["joints"][joint]["position"])
        assert np.linalg.norm(position - alone[place]) < 1e-4, joint
        assert np.linalg.norm(position - preview[place]) < 0.03, joint  # what Godot 3 does not add
    assert going["states"]["arms"].startswith("arms_to_on_hips")
    assert there["states"]["arms"] == "arms_on_hips" == nodding["states"]["arms"]
    assert nodding["states"]["head"] == nod
    assert after["states"] == there["states"]
    was, now = (
        {joint: np.array(row["joints"][joint]["rotation"]) for joint in ("Head", "LeftHand")}
        for row in (there, nodding)
    )
    assert abs(was["Head"] @ now["Head"]) < 0.9999 and abs(was["LeftHand"] @ now["LeftHand"]) > 0.9995
    assert waving["states"]["arms"] == wave  # by the transition to its stance
    assert back["states"] == {**there["states"], "arms": arms.start.name}


@pytest.mark.nightly
@needs_godot
def test_travel_goes_from_every_state_to_every_stance_by_as_few_transitions_as_the_planner(
    folder: Path, sample: Project
) -> None:
    asked = [
        (machine, state, machine.rest(goal), stances)
        for machine in list_machines(sample)
        for state in machine.states
        for goal in machine.stances
        if (stances := find_chain(machine.graph, str(find_end_stance(state.action)), goal)) is not None
        and state is not machine.rest(goal)
    ]
    rows = [[machine.layer, state.name, goal.name] for machine, state, goal, _ in asked]
    seen = {layer_of(sample, "body").start.name}  # layers without a track to move stand still
    for (machine, state, goal, stances), way in zip(
        asked, play(folder, sample, seen, {"ways": rows})[0]["ways"], strict=True
    ):
        named = {s.name: s.action for s in machine.states}
        assert (
            way and way[-1] == goal.name and all(named[name].kind in ("transition", "stance") for name in way)
        )
        assert sum(named[name].kind == "transition" for name in way) == len(stances), (state.name, way)


@needs_godot
def test_godot_reads_every_state_and_transition(folder: Path, sample: Project) -> None:
    lines = """extends SceneTree
func _init():
	var tree = load("res://%s.godot3.tres")
	var out = {}
	for layer in ["body", "arms", "head"]:
		var machine = tree.get_node(layer)
		var states = 0
		for property in machine.get_property_list():
			if property.name.begins_with("states/") and property.name.ends_with("/node"):
				states += 1
		out[layer] = [states, machine.get_transition_count(), machine.get_start_node()]
	print(to_json(out))
	quit()
"""
    (folder / "count.gd").write_text(lines % make_export_stem(sample))
    env = {**os.environ, "HOME": str(folder), "LC_ALL": "C.UTF-8"}
    command = [str(GODOT), "--no-window", "-s", "count.gd"]
    done = subprocess.run(
        command, cwd=folder, env=env, capture_output=True, text=True, errors="replace", timeout=120
    )
    found = json.loads(next(line for line in done.stdout.splitlines() if line.startswith("{")))
    for machine in list_machines(sample):
        pairs = {(a.source.name, a.target.name) for a in machine.arrows}
        assert found[machine.layer] == [len(machine.states), len(pairs), machine.start.name]


# --- the files


def resources(text: str) -> list[tuple[str, str, dict[str, str]]]:
    """Return (kind, id, fields) of each resource of a .tres, the file's own last."""
    out: list[tuple[str, str, dict[str, str]]] = []
    kind = re.match(r'\[gd_resource type="(\w+)"', text)
    assert kind
    for block in text.split("\n\n")[1:]:
        head, *fields = block.strip().split("\n")
        found = re.fullmatch(r'\[sub_resource type="(\w+)" id="?(\d+)"?\]', head)
        assert found or head == "[resource]", head
        out.append((*(found.groups() if found else (kind[1], "")), dict(f.split(" = ", 1) for f in fields)))  # type: ignore[arg-type]
    return out


@pytest.mark.nightly
@pytest.mark.parametrize(
    ("ending", "reference"),
    [(".tres", r'SubResource\("(\d+)"\)'), (".godot3.tres", r"SubResource\( (\d+) \)")],
)
def test_resources_are_there_before_they_are_named_and_states_before_transitions(
    folder: Path, sample: Project, ending: str, reference: str
) -> None:
    text = (folder / f"{make_export_stem(sample)}{ending}").read_text()
    found = resources(text)
    assert text.count("SubResource(") == len(re.findall(reference, text))
    known: set[str] = set()
    for _, ident, fields in found:
        assert {used for value in fields.values() for used in re.findall(reference, value)} <= known
        known.add(ident)
    assert len(known) == len(found)
    clips = {clip.name for clip in read_gltf_clips(folder / f"{make_export_stem(sample)}.glb")}
    named = [
        fields["animation"].lstrip("&").strip('"')
        for kind, _, fields in found
        if kind == "AnimationNodeAnimation"
    ]
    assert len(named) == len(set(named)) and set(named) == clips
    built = list_machines(sample)
    trees = [fields for kind, _, fields in found if kind == "AnimationNodeStateMachine"]
    for machine, fields in zip(built, trees, strict=True):
        names = [f for f in fields if f.endswith("/node")]
        assert list(fields).index("transitions") > list(fields).index(names[-1])
        assert {n.split("/")[1] for n in names} == {s.name for s in machine.states}
        ends = re.split(r",\s*", fields["transitions"].strip("[]"))
        assert len(ends) % 3 == 0
        pairs = [(a.strip('"'), b.strip('"')) for a, b in zip(ends[::3], ends[1::3], strict=True)]
        assert len(pairs) == len(set(pairs))
        assert set(pairs) - {("Start", machine.start.name)} == {
            (a.source.name, a.target.name) for a in machine.arrows
        }
    kinds = [kind for kind, _, _ in found]
    assert (
        kinds.count("AnimationNodeStateMachineTransition") <= 20
    )  # shared, not one for each of the thousands


def test_the_tree_adds_every_layer_to_nothing_and_filters_what_it_moves(
    folder: Path, sample: Project
) -> None:
    found = resources((folder / f"{make_export_stem(sample)}.tres").read_text())
    wires = json.loads(found[-1][2]["node_connections"])
    assert len(wires) % 3 == 0
    into = {(wires[n], wires[n + 1]): wires[n + 2] for n in range(0, len(wires), 3)}
    at, order = into["output", 0], []
    while at != "base":
        order.append(into[at, 1])
        at = into[at, 0]
    assert order[::-1] == [m.layer for m in list_machines(sample)]
    filters = [json.loads(fields["filters"]) for kind, _, fields in found if kind == "AnimationNodeAdd2"]
    assert filters == [[f"Skeleton3D:{joint}" for joint in m.joints] for m in list_machines(sample)]


@pytest.mark.nightly
def test_gestures_and_transitions_alone_end_by_themselves_and_loops_loop(
    folder: Path, sample: Project
) -> None:
    found = resources((folder / f"{make_export_stem(sample)}.tres").read_text())
    by_id = {ident: fields for _, ident, fields in found}
    trees = [fields for kind, _, fields in found if kind == "AnimationNodeStateMachine"]
    for machine, fields in zip(list_machines(sample), trees, strict=True):
        ends = re.split(r",\s*", fields["transitions"].strip("[]"))
        auto = {
            ends[n].strip('"')
            for n in range(0, len(ends), 3)
            if "advance_mode" in by_id[re.findall(r"\d+", ends[n + 2])[0]]
        }
        assert auto == {s.name for s in machine.states if s.action.kind != "stance"} | {"Start"}
    for kind, _, fields in found:
        if kind == "AnimationNodeAnimation":
            state = next(
                s for m in list_machines(sample) for s in m.states if f'&"{s.name}"' == fields["animation"]
            )
            assert (fields.get("loop_mode") == "1") == state.loop
            assert not state.loop or float(fields["timeline_length"]) == pytest.approx(
                state.seconds, abs=1e-3
            )


def test_godot_4_composes_as_the_contract_does(sample: Project) -> None:
    """Its rule: offsets from the rest are multiplied in the tree's order, each only for the tracks its filter
    lets pass.
    """
    assert sample.skeleton is not None
    base = get_base_pose(sample)
    turns, shifts = np.array(base.rotations, float), np.array(base.translations, float)
    for machine in list_machines(sample):
        clip = sample.clips[machine.start.action.clip].motion
        assert clip is not None
        pose = clip.pose_at(sample.span(machine.start.action)[0] + 1.0)
        for joint in machine.joints:
            n = sample.skeleton.index(joint)
            turns[n] = rotation.multiply(
                turns[n], rotation.multiply(rotation.conjugate(base.rotations[n]), pose.rotations[n])
            )
            shifts[n] += pose.translations[n] - base.translations[n]
    got = sample.skeleton.globals(Pose(turns, shifts))[1]
    preview = sample.skeleton.globals(pose_at(make_plan(sample, 5.0, idle=False), sample, 1.0, alive=False))[
        1
    ]
    assert np.abs(got - preview).max() < 1e-4


def test_a_joint_has_one_layer_in_godot_3_and_the_next_where_its_own_does_not_reach_it(
    sample: Project,
) -> None:
    alone = find_owned_joints(sample, list_machines(sample))
    every = [joint for joints in alone.values() for joint in joints]
    assert (
        len(every) == len(set(every))
        and sample.skeleton is not None
        and set(every) == set(sample.skeleton.names)
    )
    assert "Spine" in alone["body"] and "LeftHand" in alone["arms"] and "Head" in alone["head"]
    without = edits.set_weight(sample, "head", "head", 0.0)
    assert "Head" in find_owned_joints(without, list_machines(without))["body"]
    assert "Spine" in find_owned_joints(sample, list_machines(sample)[1:])["arms"]


def test_states_of_other_stances_stand_further_off_than_those_that_lead_to_a_stance(sample: Project) -> None:
    for machine in list_machines(sample):
        places = list(godot_tree._places(machine))
        assert len({place for _, place in places}) == len(places) == len(machine.states)
        for goal in machine.stances:
            block = [np.array(p) for s, p in places if find_end_stance(s.action) == goal]
            leading = [
                np.array(p)
                for s, p in places
                if s.action.kind == "transition" and s.action.end_stance == goal
            ]
            away = [float(np.linalg.norm(p - block[0])) for p in block]
            assert away == sorted(away) and np.array_equal(
                leading, block[1 : 1 + len(leading)]
            )  # of several, the first placed is the nearest
            others = [np.array(p) for s, p in places if find_end_stance(s.action) != goal]
            wide = max((float(np.linalg.norm(a - b)) for a in block for b in block), default=0.0)
            assert all(np.linalg.norm(a - b) > wide for a in block for b in others)


@pytest.mark.parametrize(
    ("joint", "bone"),
    [("Hips", "hips"), ("LeftThumb1", "left_thumb_1"), ("LeftUpperArm", "left_upper_arm"),
     ("mixamorig:LeftArm", "mixamorig_left_arm"),
     ("RightToeBase", "right_toe_base"), ("Spine02", "spine_02"), ("upperarm_l", "upperarm_l")],
)  # fmt: skip
def test_bones_are_named_as_godot_3_imports_them(joint: str, bone: str) -> None:
    assert make_godot3_name(joint) == bone


def test_a_skeleton_of_two_roots_hangs_below_the_node_that_holds_them(sample: Project) -> None:
    assert sample.skeleton is not None and list_track_paths(sample, "LeftHand", 3) == (
        "Skeleton:LeftHand",
        "Skeleton:left_hand",
    )
    parents = sample.skeleton.parents.copy()
    parents[sample.skeleton.index("LeftUpperLeg")] = -1
    two = replace(sample, skeleton=replace(sample.skeleton, parents=parents))
    assert list_track_paths(two, "LeftHand", 4) == ("Armature/Skeleton3D:LeftHand",)


def test_the_guide_names_every_state_and_the_losses_say_what_godot_does_not(
    folder: Path, sample: Project
) -> None:
    text = (folder / f"{make_export_stem(sample)}.godot.md").read_text()
    assert all(f"`{s.name}`" in text for m in list_machines(sample) for s in m.states)
    told = [words for loss in TARGETS[0].losses if (words := loss.told(sample))]
    assert told and all("{n}" not in words for words in told)
    assert any(words.startswith("Godot 3:") for words in told)
