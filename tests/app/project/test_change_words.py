"""What History says an edit changed: which field, from what to what, of how many."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import pytest

from app.project.change_words import describe_edit
from metagraph.graph import edits
from metagraph.graph.model import Project, Settings


@pytest.fixture
def project(toy: Any) -> Project:
    return toy.project()


def ids(project: Project, kind: str) -> tuple[str, ...]:
    return tuple(a.id for a in project.actions() if a.kind == kind)


def retimed(project: Project, some: tuple[str, ...], **values: float) -> Project:
    return edits.update_actions(project, some, timing=values)


def test_one_action_is_named_and_one_field_has_both_values(project: Project, toy: Any) -> None:
    beat = toy.id(project, "rest beat lf")
    was = project.action(beat).timing.blend_in
    after = retimed(project, (beat,), blend_in=0.1)
    assert describe_edit("Change timing", project, after) == f"Blend in {was:.2f} → 0.10 s, rest beat lf"


def test_several_of_a_kind_are_counted(project: Project) -> None:
    gestures = ids(project, "gesture")
    assert len(gestures) > 1
    after = edits.update_actions(project, gestures, likelihood=2.0)
    assert describe_edit("x", project, after) == f"Likelihood 1 → 2, {len(gestures)} gestures"
    everything = edits.update_actions(project, (*gestures, *ids(project, "fidget")), likelihood=2.0)
    assert describe_edit("x", project, everything).endswith(" actions")


def test_values_that_differed_are_left_out(project: Project) -> None:
    first, second, *_ = ids(project, "gesture")
    before = edits.update_actions(project, (first,), likelihood=3.0)
    after = edits.update_actions(before, (first, second), likelihood=2.0)
    assert describe_edit("x", before, after) == "Likelihood → 2, 2 gestures"


def test_two_fields_at_once_keep_the_name_of_the_edit(project: Project, toy: Any) -> None:
    beat = toy.id(project, "rest beat lf")
    after = retimed(project, (beat,), blend_in=0.1, blend_out=0.1)
    assert describe_edit("Change timing", project, after) == "Change timing, rest beat lf"


def test_a_stance_is_called_by_its_name(project: Project, toy: Any) -> None:
    beat = toy.id(project, "rest beat lf")
    graph = project.graphs["arms"]
    now = graph.stances[project.action(beat).stance]
    other = next(s for s in graph.stances.values() if s.id != now.id)
    after = edits.to_stance(project, (beat,), other.id)
    words = describe_edit("Move to another stance", project, after)
    assert words.startswith(f"Stance '{now.name}' → '{other.name}'")


def test_the_setting_that_changed_is_said_and_what_is_new_or_gone_keeps_its_name(project: Project) -> None:
    assert describe_edit("Change seed", project, edits.set_settings(project, seed=7)) == "Seed 1 → 7"
    gone = edits.remove_actions(project, ids(project, "gesture")[:1])
    assert describe_edit("Remove 1 action", project, gone) == "Remove 1 action"
    assert describe_edit("Rename", project, edits.rename_project(project, "b")) == "Rename"


def test_a_name_of_a_hundred_letters_is_cut(project: Project, toy: Any) -> None:
    beat = toy.id(project, "rest beat lf")
    before = edits.update_actions(project, (beat,), name="n" * 100)
    words = describe_edit("x", before, edits.update_actions(before, (beat,), likelihood=2.0))
    assert len(words) < 70 and words.endswith("…")


@pytest.mark.parametrize("field", [f.name for f in fields(Settings)])
def test_each_setting_of_the_planner_can_be_changed_and_is_told(project: Project, field: str) -> None:
    was = getattr(project.settings, field)
    now = not was if isinstance(was, bool) else was + 1
    words = describe_edit("Change a setting", project, edits.set_settings(project, **{field: now}))
    assert words == "Change a setting" if field == "shortest" else "→" in words


def test_a_setting_that_is_on_or_off_says_yes_or_no(project: Project) -> None:
    after = edits.set_settings(project, never_twice=False)
    assert describe_edit("x", project, after) == "Never twice in a row yes → no"
    assert describe_edit("x", project, edits.set_settings(project, wait=6.0)) == "Maximum wait 4.00 → 6.00 s"
