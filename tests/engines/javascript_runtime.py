"""What tests of the JavaScript runtime share: scripts that use it, and an export that needs what few do."""

from __future__ import annotations

import json
import shutil
import struct
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from metagraph.engines.export import export_project
from metagraph.engines.reading import read_export
from metagraph.engines.script import ScriptCase, ScriptStep
from metagraph.engines.vectors import write_vectors

ROOT = Path(__file__).resolve().parents[2]
RUNTIME = ROOT / "metagraph" / "engines" / "runtimes" / "javascript"
VECTORS = sorted(p.parent for p in (ROOT / "metagraph" / "engines" / "conformance").glob("*/vectors.json"))
STICK = ROOT / "metagraph" / "engines" / "conformance" / "stick"
VARIED = ROOT / "metagraph" / "engines" / "conformance" / "varied"

needs_node = pytest.mark.skipif(shutil.which("node") is None, reason="needs Node 18 or newer")


def conformance(*folders: Path, runtime: Path = RUNTIME) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        ["node", str(runtime / "conformance.mjs"), *map(str, folders)],
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )


HEAD = """
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
const [runtime, folder, ...rest] = process.argv.slice(1);
const of = (name) => import(pathToFileURL(join(runtime, name)));
const metagraph = await of("index.js");
const { Character, Player, emptyPlan, hear, load, poseAt, morphsAt, since } = metagraph;
const name = folder.split("/").pop();
const text = readFileSync(join(folder, `${name}.json`), "utf8");
const glb = readFileSync(join(folder, `${name}.glb`));
const say = (data) => console.log(JSON.stringify(data));
"""


def run(script: str, folder: Path = STICK, *arguments: str) -> Any:
    """Return what a script prints as JSON; it has HEAD's names, `folder` and the arguments in `rest`."""
    command = [
        "node",
        "--expose-gc",
        "--input-type=module",
        "-e",
        HEAD + script,
        str(RUNTIME),
        str(folder),
        *arguments,
    ]
    done = subprocess.run(
        command, capture_output=True, text=True, timeout=120, check=False, cwd=ROOT / "tests"
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def changed(folder: Path, target: Path, change: Any) -> Path:
    """Copy an export, its GLB's document changed."""
    copy = target / folder.name
    shutil.copytree(folder, copy)
    path = copy / f"{folder.name}.glb"
    raw = path.read_bytes()
    length = struct.unpack_from("<I", raw, 12)[0]
    document = json.loads(raw[20 : 20 + length])
    change(document)
    head = json.dumps(document).encode()
    head += b" " * (-len(head) % 4)
    rest = raw[20 + length :]
    path.write_bytes(
        struct.pack("<4sIIII", b"glTF", 2, 20 + len(head) + len(rest), len(head), 0x4E4F534A) + head + rest
    )
    return copy


def rarely(document: dict[str, Any]) -> None:
    """Change an export so that it needs what few do: long spacing, ways of equal length, eyes that joints do
    not turn.
    """
    arms, body, head = (document["layers"][layer] for layer in ("arms", "body", "head"))
    actions = {a["name"]: a for layer in (arms, body, head) for a in layer["actions"]}
    for name in ("wave", "point", "shrug", "nudge"):
        actions[name] |= {"spacing": 4, "cooldown": 0}
    arms["markov"]["states"][0] = ["left", "gesture"]
    arms["stances"].append({"id": "s900", "name": "far away"})
    arms["actions"].append(actions["crossed"] | {"id": "a900", "stance": "s900"})
    for ident, start, end in (
        ("a901", "s21", "s28"),
        ("a902", "s28", "s900"),
        ("a903", "s25", "s900"),
        ("a904", "s25", "s900"),
    ):
        arms["actions"].append(
            actions["to crossed"] | {"id": ident, "name": ident, "stance": start, "end_stance": end}
        )
    document["face"]["channels"] = {"eye_left": "", "eye_right": ""}


def rare_cases(eyes: list[float]) -> Iterator[ScriptCase]:
    """Yield cases of what the shipped ones pass over. eyes: where they are at rest."""
    for seed in range(4):
        yield ScriptCase("the models", "", (ScriptStep(0, 60),), seed=seed, idle=True)
        gestures = tuple({"do": "gesture", "id": f"g{n}", "at": 3.0 * n} for n in range(12))
        yield ScriptCase("spacing", "", (ScriptStep(0, 50, gestures),), seed=seed)
        yield ScriptCase(
            "a way",
            "",
            (ScriptStep(0, 20, ({"do": "stance", "stance": "far away", "id": "go", "at": 1.0},)),),
            seed=seed,
        )
    said = ScriptStep(
        0, 20, ({"do": "say", "line": "hello", "id": "say", "at": 2.0}, {"do": "gesture", "id": "g", "at": 6})
    )
    yield ScriptCase(
        "withdrawn with its parts",
        "",
        (said, ScriptStep(0.5, 20, ({"do": "withdraw", "what": "say", "id": "w"},))),
        alive=(True,),
    )
    cut = ScriptStep(2.5, 20, ({"do": "withdraw", "what": "say", "id": "w"},))
    yield ScriptCase("cut short", "", (said, cut), times=(2.9, 3.0, 3.05, 3.1, 3.15, 3.2), alive=(True,))
    text = "Well, whatever do you think of all the wonderful things that I have told you about today?"
    for seed in range(3):
        yield ScriptCase(
            "a long speech",
            "",
            (ScriptStep(0, 20, ({"do": "say", "text": text, "id": "say", "at": 2.0},)),),
            seed=seed,
            alive=(True,),
        )
    for away in (0.1, 0.2):
        near = {
            "do": "look",
            "to": [eyes[0] + 0.03, eyes[1] + 0.02, eyes[2] + away],
            "id": "look",
            "at": 1.0,
            "strict": True,
        }
        yield ScriptCase("something near", "", (ScriptStep(0, 20, (near,)),), times=(1.5, 3.0), alive=(True,))


def make_rare(target: Path) -> None:
    """Write an export and vectors of what few exports need into a folder."""
    shutil.copytree(VARIED, target / "changed")
    path = target / "changed" / "varied.json"
    document = json.loads(path.read_text())
    rarely(document)
    path.write_text(json.dumps(document))
    exported = export_project(read_export(path, resolved=True), target)
    eyes = json.loads(exported.json.read_text())["rig"]["eyes_at_rest"]
    write_vectors(exported.json, list(rare_cases(eyes)))
