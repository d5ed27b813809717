"""docs/format.md alone is enough: an evaluator written from its words, without a line of ours, poses
characters as the conformance vectors say.

`reading`, `posing` and `drawing`, beside this file, are that evaluator; each function names the heading or
the bold words of the page whose rule it follows. Where a case fails after a change of the page or the player,
mend whichever is wrong; never teach the evaluator what the page does not say.
"""

import ast
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from metagraph import engines
from tests.engines.stranger.drawing import key32, rests_of
from tests.engines.stranger.posing import morphs, pose, positions
from tests.engines.stranger.reading import Character, read_character

SHIPPED = Path(engines.__file__).with_name("conformance")
NAMES = ("stick", "sparse", "varied")
Vectors = tuple[Character, dict[str, Any]]


def read_vectors(folder: Path) -> Vectors:
    vectors = json.loads((folder / "vectors.json").read_text("utf-8"))
    return read_character(folder / vectors["export"]), vectors


def errors(character: Character, vectors: dict[str, Any]) -> dict[str, float]:
    """The largest error of all poses without life: of a joint's place in metres, of its own turn in degrees,
    of a morph target's weight.
    """
    wanted = [(case, p) for case in vectors["cases"] for p in case["poses"] if not p["alive"]]
    found = [pose(character, case["plan"]["layers"], p["time"]) for case, p in wanted]
    rotations, translations = (np.array(each) for each in zip(*found, strict=True))
    far = positions(character, rotations, translations) - np.array([p["positions"] for _, p in wanted])
    told = np.array([p["rotations"] for _, p in wanted])
    told /= np.linalg.norm(told, axis=-1, keepdims=True)
    chord = np.minimum(np.linalg.norm(rotations - told, axis=-1), np.linalg.norm(rotations + told, axis=-1))
    weight = 0.0
    for case, p in wanted:
        ours = morphs(character, case["plan"]["layers"], p["time"])
        for name in ours.keys() | p["morphs"].keys():
            weight = max(weight, abs(ours.get(name, 0.0) - p["morphs"].get(name, 0.0)))
    return {
        "metres": float(np.linalg.norm(far, axis=-1).max()),
        "degrees": float(np.degrees(4.0 * np.arcsin(chord.max() / 2.0))),
        "weight": weight,
    }


@pytest.fixture(scope="module")
def shipped() -> dict[str, Vectors]:
    return {name: read_vectors(SHIPPED / name) for name in NAMES}


@pytest.mark.parametrize("name", NAMES)
def test_the_pages_words_pose_a_character_as_its_vectors_say(shipped: dict[str, Vectors], name: str) -> None:
    character, vectors = shipped[name]
    found = errors(character, vectors)
    assert {kind: found[kind] < vectors["tolerance"][kind] for kind in found} == dict.fromkeys(found, True), (
        found
    )


@pytest.mark.parametrize("name", NAMES)
def test_the_pages_words_say_when_a_new_loop_takes_over(shipped: dict[str, Vectors], name: str) -> None:
    character, vectors = shipped[name]
    for case in vectors["cases"]:
        if len(case["steps"]) > 1:
            continue
        for layer, plan in case["plan"]["layers"].items():
            ours = rests_of(character, layer, case)
            assert [rest[:2] for rest in ours] == [rest[:2] for rest in plan["rests"]], (case["name"], layer)
            for mine, told in zip(ours, plan["rests"], strict=True):
                assert mine[2:] == pytest.approx(told[2:], abs=vectors["tolerance"]["seconds"])


def test_the_pages_words_hash_as_the_vectors_do(shipped: dict[str, Vectors]) -> None:
    for seed, words, told in shipped["stick"][1]["hashes"]:
        assert key32(seed, *words) == told


def test_the_stranger_knows_nothing_of_ours() -> None:
    for module in ("reading", "rotating", "posing", "drawing"):
        for node in ast.walk(ast.parse(Path(__file__).with_name(f"{module}.py").read_text("utf-8"))):
            names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            names += [node.module or ""] if isinstance(node, ast.ImportFrom) else []
            for name in names:
                assert name.split(".")[0] in {"ast", "dataclasses", "json", "math", "numpy", "pathlib"} | {
                    "struct", "typing"
                } or name.startswith("tests.engines.stranger.")  # fmt: skip
