"""Edits of many at once: patterns make names, properties are pasted in groups, a replaced clip keeps its
settings.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings

from metagraph.graph import edits
from metagraph.graph.check import check_project
from metagraph.graph.edit_error import EditError
from metagraph.graph.editing import batch
from metagraph.graph.model import Project
from tests.projects import projects


@pytest.fixture
def project(toy: Any) -> Project:
    return toy.project()


def gestures(project: Project) -> list[str]:
    return [a.id for a in project.actions() if a.kind == "gesture"]


# --- names


def test_a_pattern_names_and_numbers_in_the_order_given(project: Project) -> None:
    ids = gestures(project)[:2]
    names = batch.rename_by_pattern(project, ids[::-1], "{stance} {kind} {n:02}")
    assert [names[i].rpartition(" ")[2] for i in ids[::-1]] == ["01", "02"]
    after = batch.rename_actions(project, names)
    assert {i: after.action(i).name for i in ids} == names  # type: ignore[union-attr]
    assert batch.rename_actions(after, names) is after


@pytest.mark.parametrize("pattern", ["{colour}", "{n", "{n:x!}", "{0}", "{name[0][0][0]}x{", "{n:s}"])
def test_a_pattern_that_cannot_be_read_says_what_may_stand_in_braces(project: Project, pattern: str) -> None:
    with pytest.raises(EditError, match=r"\{name\}"):
        batch.rename_by_pattern(project, gestures(project), pattern)


def test_a_name_is_never_left_empty(project: Project) -> None:
    with pytest.raises(EditError, match="empty"):
        batch.rename_by_pattern(project, gestures(project), "  ")
    name = project.action(gestures(project)[0]).name  # type: ignore[union-attr]
    with pytest.raises(EditError, match="empty"):
        batch.rename_by_replacing(project, gestures(project)[:1], name, "")
    with pytest.raises(EditError, match="text to find"):
        batch.rename_by_replacing(project, gestures(project), "", "x")


def test_a_text_is_replaced_only_where_it_stands(project: Project) -> None:
    first = gestures(project)[0]
    named = batch.rename_actions(project, {first: "Wave_Lf 01"})
    assert batch.rename_by_replacing(named, gestures(named), "_Lf", r"\1 left") == {first: r"Wave\1 left 01"}
    assert batch.rename_by_replacing(named, gestures(named), r"(\w+)_Lf (\d+)", r"\2 \1", regex=True) == {
        first: "01 Wave"
    }
    assert batch.rename_by_replacing(named, ["nobody"], "Wave", "x") == {}
    with pytest.raises(EditError, match="not a valid regular expression"):
        batch.rename_by_replacing(named, gestures(named), "(", "x", regex=True)
    with pytest.raises(EditError, match="not a valid regular expression"):
        batch.rename_by_replacing(named, gestures(named), "Wave", r"\7", regex=True)


# --- properties


def test_pasting_gives_the_chosen_groups_and_nothing_else(project: Project) -> None:
    source, *others = gestures(project)
    project = edits.update_actions(
        project,
        [source],
        tags=("loud",),
        likelihood=3.0,
        limb="left",
        timing={"blend_in": 0.07, "blend_out": 0.11},
    )
    after = batch.paste_properties(project, source, others, ["tags", "blends"])
    for ident in others:
        before, now = project.action(ident), after.action(ident)
        assert before is not None and now is not None
        assert now == replace(
            before, tags=("loud",), timing=replace(before.timing, blend_in=0.07, blend_out=0.11)
        )
    assert after.action(source) == project.action(source)


def test_pasted_times_stay_within_the_clip(project: Project) -> None:
    source, other = gestures(project)[:2]
    action = project.action(other)
    assert action is not None
    length = project.clips[action.clip].duration
    project = edits.update_actions(
        project, [source], timing={"start": length + 1.0, "end": length + 2.0, "stroke": length + 1.5}
    )
    after = batch.paste_properties(project, source, [other], ["part", "phases"]).action(other)
    assert after is not None
    assert (after.timing.start, after.timing.end) == (action.timing.start, action.timing.end)
    assert after.timing.stroke == length


def test_a_group_that_is_none_and_a_source_that_is_gone_are_told(project: Project) -> None:
    with pytest.raises(EditError, match="blends"):
        batch.paste_properties(project, gestures(project)[0], gestures(project), ["colour"])
    with pytest.raises(EditError, match="no longer"):
        batch.paste_properties(project, "nobody", gestures(project), ["tags"])


# --- clips


def test_a_replaced_clip_keeps_what_was_set(project: Project) -> None:
    first = gestures(project)[0]
    project = edits.update_actions(project, [first], tags=("kept",), timing={"blend_in": 0.05})
    before = project.action(first)
    assert before is not None
    other = next(i for i in project.clips if i != before.clip)
    after = batch.replace_clip(project, [first], other).action(first)
    assert after is not None
    assert (after.clip, after.tags, after.timing.blend_in, after.id) == (other, ("kept",), 0.05, first)
    with pytest.raises(EditError, match="not in the project"):
        batch.replace_clip(project, [first], "nothing")


@given(projects())
@settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))
def test_replacing_clips_in_any_project_makes_no_new_errors(project: Project) -> None:
    if not project.clips:
        return
    clip = next(iter(project.clips))
    errors = {p.message for p in check_project(project) if p.severity == "error"}
    after = batch.replace_clip(project, [a.id for a in project.actions()], clip)
    for action in after.actions():
        assert action.clip == clip
        start, end = after.span(action)
        assert 0 <= start <= end <= after.clips[clip].duration
    assert len({p.message for p in check_project(after) if p.severity == "error"}) <= len(errors) + 1
