"""Differences of two states of a project, as people read them."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given, settings

from metagraph.graph import edits
from metagraph.graph.editing.differences import describe_differences
from metagraph.graph.manual.machine import Manual
from metagraph.graph.model import Project
from tests.projects import histories


def test_a_project_does_not_differ_from_itself(toy) -> None:
    project = toy.project()
    assert describe_differences(project, project) == []
    assert describe_differences(project, replace(project, clips=dict(project.clips))) == []


BEAT = "Gesture 'rest beat lf' (arms) changed:"


def beat(toy, project: Project) -> str:
    return toy.id(project, "rest beat lf")


@pytest.mark.parametrize(
    ("edit", "line"),
    [
        (lambda p, i: edits.update_actions(p, [i("rest beat lf")], likelihood=2.5), f"{BEAT} likelihood 1 → "
                                                                                    "2.5"),
        (lambda p, i: edits.update_actions(p, [i("rest beat lf")], tags=("positive",)), f"{BEAT} tags none → "
                                                                                        "'positive'"),
        (
            lambda p, i: edits.update_actions(p, [i("rest beat lf")], name="beat"),
            "Gesture 'beat' (arms) changed: name 'rest beat lf' → 'beat'",
        ),
        (lambda p, i: edits.remove_actions(p, [i("rest cough")]), "Fidget 'rest cough' (arms) removed"),
        (lambda p, i: edits.rename_stance(p, i("far"), "away"), "Stance 'away' (arms) changed: name 'far' → "
                                                                "'away'"),
        (lambda p, i: edits.set_settings(p, seed=7), "Settings changed: seed 1 → 7"),
        (lambda p, i: edits.rename_project(p, "other"), "Name changed: 'toy' → 'other'"),
        (lambda p, i: edits.set_character(p, "a.glb"), "Character changed: none → 'a.glb'"),
        (lambda p, i: edits.set_weight(p, "arms", "head", 0.5), "Weights of arms changed: head none → 0.5"),
        (lambda p, i: p.with_manual(Manual("arms")), "Manual state machine (arms) added"),
    ],
)  # fmt: skip
def test_an_edit_is_one_line_that_says_what_it_did(toy, edit, line) -> None:
    before = toy.project()
    assert describe_differences(before, edit(before, lambda name: toy.id(before, name))) == [line]


def test_timing_is_told_by_its_own_fields(toy) -> None:
    before = toy.project()
    action = before.action(beat(toy, before))
    after = edits.update_actions(before, [action.id], timing=replace(action.timing, start=0.1, end=0.5))
    (line,) = describe_differences(before, after)
    assert all(piece in line for piece in ("'rest beat lf' (arms)", "start 0 → 0.1, end none → 0.5"))


def test_clips_that_came_and_went_are_named(toy) -> None:
    before = toy.project()
    after = edits.add_clips(before, [("new.glb", 0, "", toy.clip("new"))])
    assert describe_differences(before, after) == ["Clip 'new' added"]
    assert describe_differences(after, before) == ["Clip 'new' removed"]


@settings(max_examples=60, deadline=None)
@given(histories())
def test_any_two_states_that_are_not_equal_differ_in_words(states: list[Project]) -> None:
    for before in states:
        for after in states:
            lines = describe_differences(before, after)
            assert all(isinstance(line, str) and "\n" not in line for line in lines)
            assert (before == after) == (not lines)
