"""The scripts that write logs in engines, run: in Godot 4.6 and in Blender itself; Unity's and Unreal's with
classes that stand in for those of their editors. What they write is imported and reported.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from app.cli.parser import main
from metagraph.research.study import engine_logs
from metagraph.research.study.logs.log import StudyLog, read_log
from metagraph.research.study.simulation.files import write_study
from metagraph.research.study.simulation.people import Truth
from metagraph.research.study.study_plan import Study
from tests.browsing import Browser
from tests.engines.blender_python import find_blender
from tests.engines.csharp_runtime import compiled, mono, needs_mono
from tests.engines.godot4_web import needs_godot4, play, seen

SCRIPTS = Path(engine_logs.__file__).parent
HERE = Path(__file__).parent
EDITOR = """extends Node

const DOCK_SLOT_RIGHT_UL = 4
var docked: Control
var history := UndoRedo.new()

func add_control_to_dock(_slot, control):
	docked = control
	get_tree().root.add_child.call_deferred(control)

func remove_control_from_docks(control):
	control.get_parent().remove_child(control)

func get_undo_redo():
	return history
"""
WORK = """extends Node

var plugin

func click(control):
	for down in [true, false]:
		var event = InputEventMouseButton.new()
		event.button_index = MOUSE_BUTTON_LEFT
		event.pressed = down
		event.position = control.get_global_rect().get_center()
		event.global_position = event.position
		get_viewport().push_input(event)
	await get_tree().create_timer(0.05).timeout

func type(control, words):
	await click(control)
	for letter in words:
		var event = InputEventKey.new()
		event.pressed = true
		event.unicode = letter.unicode_at(0)
		get_viewport().push_input(event)

func add(machine, state):
	plugin.history.create_action("Add Node")
	plugin.history.add_do_method(machine.add_node.bind(state, AnimationNodeAnimation.new()))
	plugin.history.add_undo_method(machine.remove_node.bind(state))
	plugin.history.commit_action()

func join(machine, from, to):
	plugin.history.create_action("Add Transition")
	plugin.history.add_do_method(machine.add_transition.bind(from, to, AnimationNodeStateMachineTransition.new()))
	plugin.history.add_undo_method(machine.remove_transition.bind(from, to))
	plugin.history.commit_action()

func _ready():
	var machine = AnimationNodeStateMachine.new()
	plugin = load("res://logger.gd").new()
	add_child(plugin)
	await get_tree().create_timer(0.1).timeout
	get_tree().root.size = Vector2i(300, 300)
	plugin.docked.size = Vector2(300, 300)
	await get_tree().create_timer(0.1).timeout
	var fields = plugin.docked.get_children()
	add(machine, "before")
	await type(fields[0], "P01")
	await type(fields[1], "TASK")
	await click(fields[2])
	await click(fields[2])
	for state in ["idle", "wave", "point"]:
		add(machine, state)
	join(machine, "idle", "wave")
	await click(fields[3])
	join(machine, "idle", "point")
	await click(fields[3])
	join(machine, "wave", "idle")
	plugin.history.undo()
	plugin.history.redo()
	await get_tree().create_timer(1.0).timeout
	await click(fields[4])
	add(machine, "after")
	plugin.queue_free()
	await get_tree().create_timer(0.1).timeout
	var files = Array(DirAccess.get_files_at("user://")).filter(func(name): return name.ends_with(".jsonl"))
	var found = {"files": files, "log": FileAccess.get_file_as_string("user://" + files[0])}
	found["states"] = machine.get_transition_count()
	print("seen ", JSON.stringify(found))
	get_tree().quit(0)
"""


@pytest.fixture
def study(tmp_path: Path) -> Study:
    return write_study(tmp_path / "study", Truth(participants=4, ratio=2.0))


def reported(
    study: Study, log: Path, engine: str, capsys: pytest.CaptureFixture[str]
) -> tuple[StudyLog, dict[str, Any]]:
    """Import a log by the command, report the study by the command; return the log and the report's table."""
    assert main(["study", "import", str(study.path), "P01", str(log), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told == {"tasks": 1, "notes": []}
    assert main(["study", "report", str(study.path), "--no-jumps"]) == 0
    page = (study.folder / "report" / "report.html").read_text(encoding="utf-8")
    assert "Other conditions" in page and {"godot": "Godot", "blender": "Blender", "unity": "Unity",
        "unreal": "Unreal Engine"}[engine] in page  # fmt: skip
    read = read_log(log)
    assert read.problems == () and not read.torn
    (run,) = read.tasks()
    assert run.finished and run.condition == engine
    return read, {"edits": run.edits, "seconds": run.seconds}


def task(study: Study) -> str:
    return study.plan.tasks[0].id


@pytest.mark.nightly
@needs_godot4
def test_the_script_for_godot_logs_a_session_in_godot_4(
    study: Study, tmp_path: Path, browse: Browser, capsys: pytest.CaptureFixture[str]
) -> None:
    """All of it but its base class runs in the engine: the build for the web has no editor."""
    script = (SCRIPTS / "godot" / "metagraph_study_log.gd").read_text(encoding="utf-8")
    assert script.count("extends EditorPlugin") == 1
    script = script.replace("extends EditorPlugin", 'extends "res://editor.gd"')
    files = {"logger.gd": script, "editor.gd": EDITOR, "main.gd": WORK.replace("TASK", task(study))}
    (tmp_path / "web").mkdir()
    code, told = play(tmp_path / "web", browse, {name: text.encode() for name, text in files.items()})
    assert code == 0 and "Study log: " in told
    found = seen(told)
    (name,) = found["files"]
    assert re.fullmatch(r"study-P01-godot-[0-9a-f]{12}\.jsonl", name)
    log = tmp_path / name
    log.write_text(found["log"], encoding="utf-8")
    read, run = reported(study, log, "godot", capsys)
    assert str(read.events[0]["version"]).startswith("4.")
    # Three nodes and two links, taken back once and done again; none before, in the pause and after.
    assert run["edits"] == 7 and 1.0 < run["seconds"] < 60
    kinds = [e["type"] for e in read.events]
    assert kinds == ["begin", "phase", *4 * ["edit"], "pause", "pause", *3 * ["edit"], "phase"]


def test_the_script_for_blender_logs_a_session_in_blender(
    study: Study, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    python = find_blender()
    script = SCRIPTS / "blender" / "metagraph_study_log.py.txt"
    done = subprocess.run(
        [python, "-B", str(HERE / "loggers" / "blender_session.py"), str(script), task(study)],
        capture_output=True, text=True, timeout=120, check=False,
        env=os.environ | {"BLENDER_USER_RESOURCES": str(tmp_path)},
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    log = Path(done.stdout.partition("seen ")[2].strip())
    assert tmp_path in log.parents
    read, run = reported(study, log, "blender", capsys)
    assert [e["type"] for e in read.events] == [
        "begin", "phase", *3 * ["edit"], "pause", "pause", "edit", "undo", "redo", "phase",
    ]  # fmt: skip
    assert run["edits"] == 4


@needs_mono
def test_the_script_for_unity_logs_a_session_with_classes_that_stand_in(
    study: Study, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    program = compiled(
        tmp_path / "session.exe",
        SCRIPTS / "unity" / "MetagraphStudyLog.cs",
        HERE / "loggers" / "UnityEditorStandIn.cs",
    )
    done = mono(program, tmp_path, task(study))
    assert done.returncode == 0, done.stdout + done.stderr
    read, run = reported(study, Path(done.stdout.partition("Study log: ")[2].strip()), "unity", capsys)
    assert [e["type"] for e in read.events] == [
        "begin", "phase", *5 * ["edit"], "pause", "pause", "undo", "phase",
    ]  # fmt: skip
    assert read.events[2]["words"] == 'Add State "Wave\\1"\t'
    assert run["edits"] == 5 and run["seconds"] > 1


@pytest.mark.nightly
def test_the_script_for_unreal_logs_a_session_with_a_module_that_stands_in(
    study: Study, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    script = SCRIPTS / "unreal" / "metagraph_study_log.py.txt"
    done = subprocess.run(
        [sys.executable, "-B", str(HERE / "loggers" / "unreal_session.py"), str(script), str(tmp_path), task(study)],
        capture_output=True, text=True, timeout=60, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    read, run = reported(study, Path(done.stdout.partition("Study log: ")[2].strip()), "unreal", capsys)
    assert [e["type"] for e in read.events] == [
        "begin", "phase", "edit", "edit", "save", "pause", "pause", "edit", "phase",
    ]  # fmt: skip
    assert run["edits"] == 3
