"""Exports written by earlier versions load and play, in the library and in JavaScript; what they lack takes
its usual value.

`old/<format>/` holds exports as they were written then; they are never made again.
"""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from metagraph import Character, engines
from metagraph.engines.reading import read_export
from metagraph.engines.script_moods import list_mood_cases
from metagraph.engines.script_shades import list_shade_cases
from metagraph.engines.vectors import check_vectors, list_cases, write_vectors
from metagraph.graph.check import check_project
from tests.thorough import some

OLD = Path(__file__).parent / "old"
EXPORTS = sorted(OLD.glob("*/*.json"))
STICK = Path(engines.__file__).with_name("conformance") / "stick"
RUNNER = Path(engines.__file__).with_name("runtimes") / "javascript" / "conformance.mjs"


def copied(export: Path, folder: Path) -> Path:
    for name in (export.name, json.loads(export.read_bytes())["glb"]):
        shutil.copy(export.with_name(name), folder)
    return folder / export.name


@pytest.mark.parametrize("export", EXPORTS, ids=lambda path: f"{path.parent.name}-{path.stem}")
def test_an_old_export_loads_and_performs(export: Path) -> None:
    project = read_export(export)
    assert not [p for p in check_project(project) if p.severity == "error"]
    character = Character(export)
    character.ask({"do": "gesture", "layer": "arms"})
    character.ask({"do": "say", "line": next(iter(project.lines))})
    poses = [character.update(second / 4).rotations.copy() for second in range(60)]
    assert all(np.isfinite(pose).all() for pose in poses)
    assert np.abs(poses[0] - poses[-1]).max() > 1e-3


@pytest.mark.nightly
@pytest.mark.parametrize("export", EXPORTS, ids=lambda path: f"{path.parent.name}-{path.stem}")
def test_the_runtimes_agree_on_an_old_export(export: Path, tmp_path: Path) -> None:
    old = copied(export, tmp_path)
    # Of moods an old export does not tell how energetic actions are, nor which joints take part.
    project = read_export(old, resolved=True)
    moods = {case.name for part in (list_mood_cases, list_shade_cases) for case in part(project)}
    every = [case for case in list_cases(read_export(old, resolved=True)) if case.name not in moods]
    write_vectors(old, some(every, 4))
    assert check_vectors(tmp_path).failures == []
    if shutil.which("node") is None:
        pytest.skip("needs Node")
    done = subprocess.run(["node", str(RUNNER), str(tmp_path)], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stdout[-1000:]


@pytest.mark.nightly
def test_all_that_was_ever_added_may_be_missing(tmp_path: Path) -> None:
    data = json.loads((STICK / "stick.json").read_bytes())
    shutil.copy(STICK / "stick.glb", tmp_path)
    for field in (
        "rig",
        "voices",
        "life",
        "face",
        "points",
        "lines",
        "performances",
        "roles",
        "parts",
        "expanded",
    ):
        data.pop(field, None)
    for field in ("memory", "rest", "lookahead", "hurry", "least_blend"):
        data["planner"].pop(field)
    for layer in data["layers"].values():
        for action in layer["actions"]:
            for field in ("phases", "own_phases", "cooldown", "spacing"):
                action.pop(field, None)
        for field in ("tags", "lengths"):
            layer["markov"].pop(field, None)
    (tmp_path / "stick.json").write_text(json.dumps(data))
    path = tmp_path / "stick.json"
    write_vectors(path, some([*list_cases(read_export(path, resolved=True))], 4))
    assert check_vectors(tmp_path).failures == []
    if shutil.which("node") is None:
        pytest.skip("needs Node")
    done = subprocess.run(["node", str(RUNNER), str(tmp_path)], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stdout[-1500:]
