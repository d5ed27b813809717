"""Study files are read to the last field, and what is wrong with them is given with its line."""

from __future__ import annotations

import contextlib
import json
from pathlib import Path

import jsonschema
import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from metagraph.errors import FileError
from metagraph.research.study.study_plan import SCHEMA, parse_study_plan, read_study, study_schema_text

SMALL = """\
study: 1
title: Small
participants: 2
conditions: [meta, manual]
tasks:
- {id: ten, clips: clips}
"""


def refused(text: str) -> str:
    with pytest.raises(FileError) as caught:
        parse_study_plan(text)
    return str(caught.value)


def test_the_least_a_study_says_is_enough() -> None:
    plan = parse_study_plan(SMALL)
    assert plan.ids == ("P01", "P02")
    assert plan.task("ten").name == "ten" and plan.task("ten").minutes is None
    assert (plan.order, plan.when, plan.tolerance, plan.allow, plan.questions()) == (
        "latin",
        "after_condition",
        0.1,
        (),
        (),
    )


def test_pseudonyms_can_be_given_and_many_participants_are_numbered_alike_wide() -> None:
    assert parse_study_plan(SMALL.replace("participants: 2", "participants: [anna, b-2]")).ids == (
        "anna",
        "b-2",
    )
    ids = parse_study_plan(SMALL.replace("participants: 2", "participants: 120")).ids
    assert (ids[0], ids[-1]) == ("P001", "P120")


def test_a_study_in_a_folder_is_found(tiny: Path) -> None:
    study = read_study(tiny.parent)
    assert study.path == tiny.resolve() and len(study.digest) == 64
    assert study.log("P01") == tiny.parent.resolve() / "data" / "P01" / "log.jsonl"
    assert study.clips(study.plan.tasks[0].clips)[0].name == "head_straight__stance.glb"


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("study: 1", "study: 2", "newer version"),
        ("study: 1", "study: one", "line 1 (study): should be the version"),
        ("study: 1\n", "", "line 1: is no study"),
        ("title: Small\n", "", "the field 'title' is missing"),
        ("title: Small", "title: Small\nbudget: 3", "line 3 (budget): there is no field 'budget'"),
        ("participants: 2", "participants: 0", "line 3 (participants)"),
        ("participants: 2", "participants: ['../x']", "line 3 (participants"),
        ("participants: 2", "participants: [a, a]", "'a' is there twice"),
        ("participants: 2", "participants: [a, A]", "share a folder"),
        ("[meta, manual]", "[meta, unreal]", "line 4 (conditions"),
        ("[meta, manual]", "[meta, meta]", "'meta' is there twice"),
        ("clips: clips", "clips: clips, minutes: 0", "(tasks[0].minutes)"),
        ("clips: clips", "clips: ''", "there are no clips"),
        ("tasks:", "training: [{condition: x, clips: y}]\ntasks:", "line 5 (training"),
        (
            "[meta, manual]",
            "[meta]\ntraining: [{condition: manual, clips: y}]",
            "'manual' is not among the conditions",
        ),
        (
            "tasks:",
            "questionnaires: [susi]\ntasks:",
            "there is no questionnaire 'susi' built in; there are sus, tlx, tlx_weighted",
        ),
        ("tasks:", "questionnaires: [sus, sus]\ntasks:", "one is there twice"),
        (
            "tasks:",
            "questionnaires: [{id: sus, items: [{id: a, text: b, words: true}]}]\ntasks:",
            "'sus' is built in",
        ),
        ("tasks:", "questionnaires: [{id: q, items: [{id: a, text: b}]}]\ntasks:", "one of scale, choices"),
        (
            "tasks:",
            "questionnaires: [{id: q, items: [{id: a, text: b, scale: {from: 3, to: 1}}]}]\ntasks:",
            "goes up",
        ),
        (
            "tasks:",
            "questionnaires: [{id: q, items: [{id: a, text: b, choices: [x]}]}]\ntasks:",
            "two choices",
        ),
        ("tasks:", "order: {given: {P01: [meta]}}\ntasks:", "'P02' is given no order"),
        ("tasks:", "order: {given: {P01: [meta], P02: [meta/six]}}\ntasks:", "'meta/six' is neither"),
        ("tasks:", "order: {given: {P01: [meta], P02: [meta, meta]}}\ntasks:", "once"),
        ("tasks:", "order: random\ntasks:", "line 5 (order)"),
        ("[meta, manual]", "[meta, manual", "not valid YAML"),
    ],
)
def test_what_is_wrong_is_told_with_its_place_and_a_remedy(old: str, new: str, words: str) -> None:
    told = refused(SMALL.replace(old, new))
    assert told.startswith("study.yaml, ")
    assert words in told
    assert "Correct it" in told or "Update" in told


def test_a_study_that_is_not_there_or_no_text_is_told(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="cannot be read"):
        read_study(tmp_path)
    (tmp_path / "study.yaml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(FileError, match="is not text"):
        read_study(tmp_path)


@pytest.mark.nightly
@given(
    st.recursive(
        st.none() | st.booleans() | st.integers() | st.text(max_size=5),
        lambda x: (
            st.lists(x, max_size=3)
            | st.dictionaries(
                st.sampled_from(
                    (
                        "study",
                        "title",
                        "participants",
                        "conditions",
                        "tasks",
                        "id",
                        "clips",
                        "order",
                        "given",
                        "items",
                    )
                ),
                x,
                max_size=6,
            )
        ),
    )
)
def test_whatever_yaml_says_is_a_plan_or_a_file_error(data: object) -> None:
    if isinstance(data, dict):
        data = {"study": 1, **data}
    with contextlib.suppress(FileError):
        parse_study_plan(yaml.safe_dump(data))


def test_orders_are_latin_fixed_or_given() -> None:
    two = SMALL + "- {id: twenty, clips: clips}\n"
    assert {parse_study_plan(two).blocks(p)[0][0] for p in ("P01", "P02")} == {"meta", "manual"}
    assert parse_study_plan(two + "order: fixed").blocks("P02") == (
        ("meta", ("ten", "twenty")),
        ("manual", ("ten", "twenty")),
    )
    given = parse_study_plan(
        two
        + "order: {given: {P01: [manual, meta], P02: [meta/twenty, meta/ten, manual/ten, meta/ten]}}".replace(
            ", meta/ten]", "]"
        )
    )
    assert given.blocks("P01") == (("manual", ("ten", "twenty")), ("meta", ("ten", "twenty")))
    assert given.blocks("P02") == (("meta", ("twenty", "ten")), ("manual", ("ten",)))
    with pytest.raises(ValueError, match="'P03'"):
        given.blocks("P03")


def test_clips_that_are_not_there_are_told(tmp_path: Path) -> None:
    (tmp_path / "study.yaml").write_text(SMALL)
    study = read_study(tmp_path)
    assert study.problems()[0].startswith("task 'ten': ") and "'clips'" in study.problems()[0]
    with pytest.raises(FileError, match="there is no clip"):
        study.clips(("a.glb",))


def test_a_task_without_a_reference_is_told(tiny: Path) -> None:
    (problem,) = read_study(tiny).problems()
    assert "'nods'" in problem and "reference" in problem


def test_the_published_schema_is_this_one_and_accepts_what_is_read(tiny: Path) -> None:
    assert SCHEMA.read_bytes() == study_schema_text()
    validator = jsonschema.Draft202012Validator(json.loads(study_schema_text()))
    for text in (SMALL, tiny.read_text(encoding="utf-8")):
        validator.validate(yaml.safe_load(text))
    with pytest.raises(jsonschema.ValidationError):
        validator.validate(yaml.safe_load(SMALL + "budget: 3"))
