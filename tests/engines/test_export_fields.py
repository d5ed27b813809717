"""Every number that an export says of an action is heard by this library and by each runtime: change it, and
both play differently, in the same way.
"""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from metagraph import engines
from metagraph.engines.reading import read_export
from metagraph.engines.vectors import NAME, list_cases, write_vectors
from tests.engines.javascript_runtime import conformance, needs_node

FOLDER = Path(engines.__file__).with_name("conformance") / "random1"
CASES = 12  # of each kind that the maker writes: the first

Action = dict[str, Any]


def _turn(action: Action, number: int) -> None:
    action["vigour"] = (-1.0, 0.9, 0.2)[number % 3]


def _swap_limb(action: Action, number: int) -> None:
    action["limb"] = ("left", "right", "both")[number % 3]


def _move_phases(action: Action, number: int) -> None:
    if action["phases"]:
        action["phases"][1] = (action["phases"][0] + action["phases"][1]) / 2


CHANGES: dict[str, Callable[[Action, int], None]] = {
    "vigour": _turn,
    "limb": _swap_limb,
    "phases": _move_phases,
    "prominence": lambda a, n: a.update(prominence=(0.0, 1.0)[n % 2]),
    "likelihood": lambda a, n: a.update(likelihood=(0.1, 20.0)[n % 2]),
    "cooldown": lambda a, n: a.update(cooldown=30.0),
    "spacing": lambda a, n: a.update(spacing=5),
    "tags": lambda a, n: a.update(tags=(["positive"], ["negative"], ["sad"])[n % 3]),
    "blend_in": lambda a, n: a.update(blend_in=a["blend_in"] / 2),
    "blend_out": lambda a, n: a.update(blend_out=a["blend_out"] / 2),
    "start": lambda a, n: a.update(start=a["start"] + 0.05),
    "joints": lambda a, n: a.update(joints=["Head"] if a["kind"] != "stance" else []),
}


@pytest.fixture(scope="module")
def plain(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An export with a few vectors."""
    return _with_vectors(tmp_path_factory.mktemp("plain"), lambda action, number: None)


def _with_vectors(target: Path, change: Callable[[Action, int], None]) -> Path:
    folder = shutil.copytree(FOLDER, target / FOLDER.name)
    path = folder / f"{FOLDER.name}.json"
    document = json.loads(path.read_bytes())
    for layer in document["layers"].values():
        for number, action in enumerate(layer["actions"]):
            change(action, number)
    path.write_text(json.dumps(document))
    cases = list_cases(read_export(path, resolved=True))
    write_vectors(path, [case for case in cases if "mood" in case.name or "models" in case.name][:CASES])
    return folder


def _cases(folder: Path) -> Any:
    return json.loads((folder / NAME).read_bytes())["cases"]


@pytest.mark.nightly
@needs_node
@pytest.mark.parametrize("field", CHANGES)
def test_a_changed_field_is_played_otherwise_and_as_in_python(
    plain: Path, tmp_path: Path, field: str
) -> None:
    folder = _with_vectors(tmp_path, CHANGES[field])
    assert _cases(folder) != _cases(plain), f"Python does not hear '{field}'"
    done = conformance(folder)
    assert done.returncode == 0, done.stdout[:1000] + done.stderr[:1000]
