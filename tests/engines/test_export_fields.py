"""Every number and switch of an export is heard by this library and by each runtime: change it, and both play
differently, in the same way.
"""

from __future__ import annotations

import json
import re
import shutil
from collections import defaultdict
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from metagraph import engines
from metagraph.engines.reading import read_export
from metagraph.engines.vectors import NAME, list_cases, write_vectors
from tests.engines.csharp_runtime import CORE, RUNTIME, compiled, mono
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


@pytest.mark.nightly
@needs_node
def test_a_joint_that_bows_without_breathing_turns_everywhere(tmp_path: Path) -> None:
    """No export has bowed hips, but the format allows them."""
    folder = shutil.copytree(FOLDER, tmp_path / FOLDER.name)
    path = folder / f"{FOLDER.name}.json"
    document = json.loads(path.read_bytes())
    rig = document["rig"]
    assert rig["breath"][0][3] == 0 and rig["bowed"][0] == 0
    rig["bowed"][0], rig["thrust"][0] = 0.1, -0.05
    path.write_text(json.dumps(document))
    cases = [case for case in list_cases(read_export(path, resolved=True)) if "mood" in case.name][:CASES]
    write_vectors(path, cases)
    played = {case["name"]: case for case in _cases(folder)}
    before = {case["name"]: case for case in _cases(FOLDER)}
    assert any(played[name] != before[name] for name in played.keys() & before.keys())
    done = conformance(folder)
    assert done.returncode == 0, done.stdout[:1000] + done.stderr[:1000]
    if shutil.which("mcs") and shutil.which("mono"):
        sources = [*CORE, RUNTIME / "Tests" / "Conformance.cs"]
        ran = mono(compiled(tmp_path / "conformance.exe", *sources), folder)
        assert ran.returncode == 0, ran.stdout[:1000]


# What is no number to play with, and why. The manual's page on exports says of the last five that they are constants.
NOT_HEARD = {
    "joints.[].rotation.[]": "a quaternion: changing each number alone spoils it",
    "layers.*.own_markov": "for programs that edit",
    "touch.guard": "for programs that edit; contact_rig.guard is played",
    "points.*.[]": "no case looks at one",
    "weight_rig.knees.[].[]": "where legs are straight, which none are here",
    "joints.[].translation.[]": "in the GLB as well, which runtimes read",
    "layers.*.markov.positive": "only where a model has no tags, as none here",
    "layers.*.markov.negative": "as above",
    "height": "of the figure, for whoever shows it",
    "planner.window": "a constant",
    "planner.loop_fade": "a constant",
    "planner.hurry": "a constant",
    "planner.least_blend": "a constant",
}
WHOLE = ("standing", "random1", "steady")  # exports with every field; what one does not play another does
MANY = 130  # cases that are played
MATRIX = "layers.*.markov.matrix.[].[]"


def _leaves(value: Any, path: tuple[str | int, ...] = ()) -> Iterator[tuple[tuple[str | int, ...], Any]]:
    parts = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, part in parts:
        yield from _leaves(part, (*path, key))
    if isinstance(value, bool | float):
        yield path, value


def _name_field(path: tuple[str | int, ...]) -> str:
    """Return which field a place in an export is, whatever layer, line, mode or shape it belongs to."""
    name = ".".join("[]" if isinstance(part, int) else part for part in path)
    for pattern, general in (
        (r"^layers\.(body|arms|head)\.", "layers.*."),
        (r"^(lines|voices|points)\.[^.]+", r"\1.*"),
        (r"^life\.modes\.[a-z]+\.", "life.modes.*."),
        (r"^rig\.face\.morphs\..*", "rig.face.morphs.*"),
    ):
        name = re.sub(pattern, general, name)
    return name


def _fields_of(folder: str) -> dict[str, list[tuple[str | int, ...]]]:
    """Return the numbers and switches of an export, apart from those of actions and clips, by field."""
    found = defaultdict(list)
    for path, _ in _leaves(json.loads((FOLDER.with_name(folder) / f"{folder}.json").read_bytes())):
        if path[0] != "clips" and "actions" not in path:
            found[_name_field(path)].append(path)
    return {name: paths for name, paths in found.items() if name not in NOT_HEARD}


def _play(target: Path, folder: str, field: str) -> Path:
    """Write the vectors of an export with a field changed everywhere, "" for none; return its folder."""
    made = shutil.copytree(FOLDER.with_name(folder), target / (field.replace("*", "all") or "plain") / folder)
    path = made / f"{folder}.json"
    document, before = (json.loads(path.read_bytes()) for _ in range(2))
    places = _fields_of(folder).get(field, ())
    added = 0.01 if all(value == 0 for path, value in _leaves(before) if path in places) else 0.0
    for place in places:
        part, was = document, before
        for key in place[:-1]:
            part, was = part[key], was[key]
        value = was[place[-1]]
        if field == MATRIX:  # rows that sum to 1
            part[place[-1]] = was[-1 - int(place[-1])]
        else:
            part[place[-1]] = not value if isinstance(value, bool) else 0.8 * value + added
    path.write_text(json.dumps(document))
    cases = [c for c in list_cases(read_export(path, resolved=True)) if not c.name.startswith("asked again")]
    write_vectors(path, cases[:MANY])
    return made


@pytest.fixture(scope="module")
def unchanged(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """What exports play as they are."""
    target = tmp_path_factory.mktemp("unchanged")
    return {folder: _cases(_play(target, folder, "")) for folder in WHOLE}


@pytest.mark.nightly
@needs_node
@pytest.mark.parametrize("field", sorted({field for folder in WHOLE for field in _fields_of(folder)}))
def test_a_changed_number_is_played_otherwise_and_as_in_python(
    unchanged: dict[str, Any], tmp_path: Path, field: str
) -> None:
    heard = False
    for folder in (name for name in WHOLE if field in _fields_of(name)):
        made = _play(tmp_path, folder, field)
        if not heard and _cases(made) != unchanged[folder]:
            heard = True
            done = conformance(made)
            assert done.returncode == 0, done.stdout[:1000] + done.stderr[:1000]
    assert heard, f"Python does not hear '{field}'"
