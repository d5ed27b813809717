"""Every field of a project file at its limits and beyond: what can be read can be edited, saved and read
again, and what cannot is refused with its file, its field and the reason.
"""

from __future__ import annotations

import copy
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import pytest
from msgspec import inspect

from metagraph.errors import FileError
from metagraph.formats.project.data import FORMAT, STRUCTS, to_data
from metagraph.formats.project.fields import Data
from metagraph.formats.project.text import to_text
from metagraph.formats.store import SUFFIX, encode_project, parse_project
from metagraph.graph import edits
from metagraph.graph.model import Project

NUMBERS = (
    0,
    -0.0,
    1,
    -1,
    0.5,
    5e-324,
    1e-9,
    1e-320,
    0.9999999,
    1.0000001,
    2**31,
    2**32,
    2**53,
    10**14,
    10**15,
    1e15,
    1.0000001e15,
    -1e15,
    10**16,
    2**63,
    2**64,
    10**30,
    1e300,
    1e308,
    -1e308,
    float("inf"),
    float("-inf"),
    float("nan"),
)
TEXTS = (
    "",
    " ",
    "~",
    "null",
    "1e5",
    "yes",
    "a: b",
    "- a",
    "#",
    "'",
    '"',
    "\\",
    "\n",
    "\t",
    "\x00",
    "\x07",
    "\x85",
    "\u2028",
    "\ufeff",
    "\ud800",
    "\udfff\ud800",
    "\U0001f600",
    "é" * 3_000,
    "k" * 1_023,
    "k" * 1_100,
    "\x01" * 600,
    "{",
    "[",
    "? a",
    "&a",
    "*a",
    "!a",
    "%a",
    "@a",
    "`a",
    "|",
    ">",
    ":",
    "a" * 100_000,
)
OTHERS = (None, True, [], {}, [[]], [None], {"": None}, [[[[[[[[1]]]]]]]], {"a": {"b": {"c": {"d": {}}}}})
EXTREME = (*NUMBERS, *TEXTS, *OTHERS)


def example(kind: Any) -> Any:
    """Return plain data that a type takes, with every field in it."""
    if isinstance(kind, inspect.Metadata):
        return example(kind.type)
    if isinstance(kind, inspect.UnionType):
        return example(next(one for one in kind.types if not isinstance(one, inspect.NoneType)))
    if isinstance(kind, inspect.BoolType):
        return True
    if isinstance(kind, inspect.IntType | inspect.FloatType):
        low, high = kind.ge if kind.ge is not None else kind.gt, kind.le if kind.le is not None else kind.lt
        return max(min(1, high if high is not None else 1), low if low is not None else 1)
    if isinstance(kind, inspect.StrType):
        return "ab" * 32 if kind.pattern is not None else "x"
    if isinstance(kind, inspect.LiteralType):
        return kind.values[-1]
    if isinstance(kind, inspect.VarTupleType | inspect.ListType):
        return [example(kind.item_type)] * (kind.min_length or 1)
    if isinstance(kind, inspect.TupleType):
        return [example(one) for one in kind.item_types]
    if isinstance(kind, inspect.DictType):
        return {example(kind.key_type): example(kind.value_type)}
    if isinstance(kind, inspect.StructType | inspect.DataclassType):
        tag = {kind.tag_field: kind.tag} if getattr(kind, "tag_field", None) else {}
        return {**tag, **{field.encode_name: example(field.type) for field in kind.fields}}
    raise TypeError(kind)


def whole() -> Data:
    """Return a project's data with every field in it."""
    contact = {
        "hand": "left",
        "place": "palm",
        "to": "Hips",
        "start": 0.1,
        "end": 0.4,
        "ease_in": 0.2,
        "ease_out": 0.3,
        "keys": [[0.1, 0, 0.1, 0.2, 0, 0, 0, 1], [0.2, 0, 0.1, 0.2, 0, 0, 0, 1]],
    }
    action = {
        "id": "a5",
        "clip": "c1",
        "kind": "gesture",
        "stance": "s3",
        "name": "wave",
        "end_stance": "s4",
        "limb": "left",
        "joints": ["Head"],
        "tags": ["positive"],
        "likelihood": 2,
        "cooldown": 1,
        "spacing": 2,
        "start": 0.1,
        "end": 0.9,
        "blend_in": 0.3,
        "blend_out": 0.4,
        "loop": True,
        "earliest_exit": 0.5,
        "stroke": 0.4,
        "ready": 0.3,
        "stroke_end": 0.5,
        "relax": 0.6,
        "repeat": 2.5,
        "joint_weights": {"Head": 0.5},
        "contacts": [contact],
    }
    clip = {
        "id": "c1",
        "name": "wave",
        "path": "wave.glb",
        "take": 1,
        "frames": 30,
        "fps": 25,
        "sha256": "ab" * 32,
        "as_is": [],
        "brought_from": "x",
        "made_by": "y",
        "made_seed": 3,
        "speed": 1.5,
        "holds": [{"at": 0.1, "seconds": 0.5}, {"at": 0.2, "seconds": 0.5}],
        "contacts": [{"upper": "A", "lower": "B", "hand": "C", "to": "D", "first": 1, "last": 2}],
    }
    markov = {
        "states": ["both gesture positive", "left gesture"],
        "matrix": [[0.5, 0.5], [1, 0]],
        "gap": 2,
        "positive": 0.2,
        "negative": 0.1,
        "lengths": [[1, 0.5], [1, 0.5]],
        "modes": [[0.1, 0.2, 0.3], [0.1, 0.2, 0.3], [0.1, 0.2, 0.3]],
    }
    state = {"id": "n6", "clip": "c1", "name": "state", "x": 1, "y": 2, "joint_weights": {"Head": 0.5}}
    link = {"id": "l8", "source": "n6", "target": "n6", "blend": 0.2, "exit_part": 0.5, "when": "finished"}
    data = {
        "metagraph": FORMAT,
        "name": "whole",
        "character": "ada.glb",
        "hidden": ["Hat"],
        "language": "de",
        "base": {"clip": "c1", "frame": 2},
        "settings": {
            "alpha": 3,
            "seed": 7,
            "never_twice": False,
            "shortest": 0.5,
            "wait": 3,
            "memory": 20,
            "rest": 1,
            "lookahead": 0.2,
        },
        "roles": {"head": "Head"},
        "parts": {"Head": "head"},
        "clips": [clip],
        "layers": {
            "arms": {
                "start": "s3",
                "weights": {"arms": 0.5},
                "stances": [{"id": "s3", "name": "rest"}, {"id": "s4", "name": "up"}],
                "actions": [action],
            }
        },
        "markov": {"arms": markov},
        "manual": {
            "arms": {
                "start": "n6",
                "any_x": 1,
                "any_y": 2,
                "states": [state],
                "aliases": [{"id": "i7", "name": "any", "states": ["n6"]}],
                "links": [link],
            }
        },
        "skeleton": [
            {"name": "Hips", "at": [0, 1, 0]},
            {"name": "Head", "parent": "Hips", "at": [0, 0.5, 0], "turn": [0, 0, 0, 1]},
        ],
    }
    found = {**data, **{key: example(inspect.type_info(kind)) for key, kind in STRUCTS.items()}}
    for side in found["conversations"]["x"]["sides"]:
        for row in (*side["words"], *side["segments"]):
            row |= {"start": 0.1, "end": 0.9}
        for segment in side["segments"]:
            segment |= {"peak": 0.5, "to": -1}
    found["timelines"]["x"]["range"] = [0, 1]
    return found


Place = tuple[str | int, ...]


def places(value: Any, at: Place = ()) -> Iterator[Place]:
    """Yield where every value in plain data is."""
    for key, inside in value.items() if isinstance(value, dict) else enumerate(value):
        yield (*at, key)
        if isinstance(inside, dict | list):
            yield from places(inside, (*at, key))


def changed(data: Data, place: Place, value: Any) -> Data:
    out = copy.deepcopy(data)
    inside: Any = out
    for key in place[:-1]:
        inside = inside[key]
    inside[place[-1]] = value
    return out


def keyed(data: Data, place: Place, key: str) -> Data:
    """Return data in which a field has another name."""
    out = copy.deepcopy(data)
    inside: Any = out
    for one in place[:-1]:
        inside = inside[one]
    inside[key] = inside.pop(place[-1])
    return out


def check(data: Data, path: Path) -> bool:
    """Read, edit, save and read again; return whether it could be read. What is refused names file and
    reason.
    """
    try:
        project = parse_project(to_text(data), path)
    except FileError as error:
        assert error.path == path and error.cause and error.where and error.remedy
        return False
    edited = edits.rename_project(project, "edited")
    again = parse_project(encode_project(edited, path).decode(), path)
    assert to_data(again) == to_data(edited)
    return True


def part(top: str) -> Data:
    """Return the whole with nothing in it but one of its fields."""
    return {"metagraph": FORMAT, **({top: WHOLE[top]} if top != "metagraph" else {})}


def refused_or_saved(place: Place, values: Sequence[Any], path: Path) -> int:
    """Try values in one place; return how many of them could be read."""
    data, read = part(str(place[0])), 0
    for value in values:
        try:
            read += check(changed(data, place, value), path)
        except Exception as error:
            error.add_note(f"{place} = {str(value)[:60]!r}")
            raise
    return read


def renamed_or_saved(place: Place, keys: Sequence[str], path: Path) -> int:
    """Try other names for one field; return how many of them could be read."""
    data, read = part(str(place[0])), 0
    for key in keys:
        try:
            read += check(keyed(data, place, key), path)
        except Exception as error:
            error.add_note(f"{place} is called {key[:60]!r}")
            raise
    return read


WHOLE = whole()
FEW = 6  # one of so many values is tried in each place; `tests/reliability/every_field.py` tries all
PLACES = list(places(WHOLE))


def test_every_field_is_there_and_the_whole_can_be_read() -> None:
    project = parse_project(to_text(WHOLE), Path("whole"))
    data = to_data(project)
    assert not set(data) ^ set(WHOLE)
    for key in STRUCTS:
        assert getattr(project, key) != getattr(Project(), key), f"{key} has nothing in it"


@pytest.mark.parametrize("top", sorted({str(place[0]) for place in PLACES}))
def test_what_can_be_read_can_be_saved_and_the_rest_is_refused_by_name(top: str) -> None:
    path = Path(f"whole{SUFFIX}")
    read = sum(
        refused_or_saved(place, EXTREME[n % FEW :: FEW], path)
        for n, place in enumerate(PLACES)
        if place[0] == top
    )
    assert read or top == "metagraph" or FEW > 1, "of a few of the values it may be none"


@pytest.mark.nightly
def test_odd_names_of_fields_are_read_and_saved_or_refused() -> None:
    path = Path(f"whole{SUFFIX}")
    named = [place for place in PLACES if isinstance(place[-1], str)]
    assert sum(renamed_or_saved(place, TEXTS[n % FEW :: FEW], path) for n, place in enumerate(named))


def test_a_number_that_is_too_large_is_refused_with_its_place_and_limits() -> None:
    data = changed(WHOLE, ("touch", "parts", 0, "a", 2), 1e300)
    with pytest.raises(
        FileError, match=r"line \d+: touch\.parts\[0\]\.a\[2\] should be a number from -1e\+15 to 1e\+15"
    ):
        parse_project(to_text(data), Path("x"))


def test_a_long_name_in_a_file_that_is_wrong_elsewhere_is_no_error_of_its_own() -> None:
    text = f"metagraph: {FORMAT}\nroles:\n  {'k' * 2_000}: x\nsettings:\n  alpha: x\n"
    with pytest.raises(FileError, match=r"settings\.alpha"):
        parse_project(text, Path("x"))
