"""What tests of the Godot runtime share: scripts that run on the engine."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest

from metagraph import engines

ADDON = Path(engines.__file__).with_name("runtimes") / "godot" / "addons"
GODOT3 = ADDON.with_name("godot3") / "addons"  # what Godot 3 wants laid over it
FOLDERS = sorted(path for path in Path(engines.__file__).with_name("conformance").iterdir() if path.is_dir())
STICK = next(folder for folder in FOLDERS if folder.name == "stick")
GODOT = shutil.which("godot3-server")
needs_godot = pytest.mark.skipif(
    GODOT is None, reason="godot3-server is not here (apt install godot3-server)"
)


def install_addon(game: Path) -> None:
    """Put the add-on for Godot 3 into a project."""
    shutil.copytree(ADDON, game / "addons")
    shutil.copytree(GODOT3, game / "addons", dirs_exist_ok=True)


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
