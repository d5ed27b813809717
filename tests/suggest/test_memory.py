"""What is kept between projects: bounded, read back as it was written, and never a reason to stop."""

from __future__ import annotations

import json

import numpy as np
import pytest

from metagraph.suggest import memory
from metagraph.suggest.alike import LabelledExample
from metagraph.suggest.memory import Memory, MemoryFormatError
from metagraph.suggest.words.names import PatternsError, read_names

NAMES = ["idle_arms_shrug", "idle_arms_wobble", "idle_arms"]


def example(word: str = "shrug", kind: str = "gesture") -> LabelledExample:
    return LabelledExample((word,), np.array([0.5, np.nan]), {"kind": kind})


def test_an_empty_memory_knows_nothing_and_is_written_short() -> None:
    assert Memory().others("") == []
    assert Memory.from_json(Memory().to_json()) == Memory()


def test_a_correction_is_remembered_and_reads_the_next_name() -> None:
    told = Memory().corrected("idle_arms_wobble", "kind", "fidget", NAMES)
    guess = read_names(["seated_wobble_02", "seated"], told.patterns)["seated_wobble_02"]
    assert guess.kind is not None and guess.kind.value == "fidget"
    assert Memory().patterns.learned == {}


def test_a_label_that_there_is_not_is_refused() -> None:
    with pytest.raises(PatternsError, match="cannot be 'nonsense'"):
        Memory().corrected("idle_arms_wobble", "kind", "nonsense", NAMES)


def test_what_is_written_is_read_again() -> None:
    kept = (
        Memory().corrected("idle_arms_wobble", "tags", ["happy", "new"], NAMES).with_project("a", [example()])
    )
    again = Memory.from_json(json.loads(json.dumps(kept.to_json())))
    assert again.patterns == kept.patterns
    (one,) = again.others("b")
    assert one.words == ("shrug",) and one.labels == {"kind": "gesture"}
    np.testing.assert_array_equal(one.measures, [0.5, np.nan])


def test_a_project_is_no_example_to_itself_and_is_replaced_not_added_to() -> None:
    kept = (
        Memory()
        .with_project("a", [example(), example()])
        .with_project("b", [example("nod")])
        .with_project("a", [example("bow")])
    )
    assert [e.words for e in kept.others("a")] == [("nod",)]
    assert [e.words for e in kept.others("b")] == [("bow",)]
    assert kept.with_project("a", []).others("b") == []


def test_only_the_latest_projects_are_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    kept = Memory()
    for n in range(memory.PROJECTS + 3):
        kept = kept.with_project(f"p{n}", [example(str(n))])
    assert len(kept.examples) == memory.PROJECTS and "p2" not in kept.examples and "p3" in kept.examples
    monkeypatch.setattr(memory, "EXAMPLES", 10)
    large = kept.with_project("large", [example(str(n)) for n in range(25)])
    assert [*large.examples] == [f"p{memory.PROJECTS + 2}", "large"]
    assert [e.words[0] for e in large.examples["large"]] == [str(n) for n in range(0, 25, 3)]


def test_forgetting_leaves_what_the_user_wrote() -> None:
    mine = Memory().patterns.with_pattern("kinds", "wobble", "gesture")
    kept = Memory(mine).corrected("idle_arms_wobble", "kind", "fidget", NAMES).with_project("a", [example()])
    bare = kept.forgotten()
    assert bare.patterns.learned == {} and bare.patterns.changes == mine.changes and not bare.examples
    assert kept.forgotten(words=False).patterns == kept.patterns
    assert kept.forgotten(projects=False).examples == kept.examples
    narrow = kept.forgotten(field="kind", phrase="wobble")
    assert narrow.examples == kept.examples and "wobble" not in narrow.patterns.learned.get("kind", {})


@pytest.mark.parametrize(
    ("data", "place"),
    [
        (None, "NoneType"),
        ([], "list"),
        ({}, "'learned' is version None"),
        ({"learned": 99}, "version 99"),
        ({"learned": 1, "more": 1}, "'more'"),
        ({"learned": 1, "names": {"patterns": 1, "kinds": {"wobble": 3}}}, "'names': 'kinds', 'wobble'"),
        ({"learned": 1, "projects": []}, "'projects' should be an object"),
        ({"learned": 1, "projects": {"a": {}}}, "'projects', 'a' should be a list"),
        ({"learned": 1, "projects": {"a": [{"words": ["x"], "labels": {}}, 3]}}, "'projects', 'a', number 2"),
    ],
)
def test_what_is_broken_is_told_with_its_place(data: object, place: str) -> None:
    with pytest.raises(MemoryFormatError) as error:
        Memory.from_json(data)
    assert place in str(error.value)
