"""Problems of one kind in one stance are one line."""

from __future__ import annotations

from typing import Any

from metagraph.graph import edits
from metagraph.graph.check import check_project
from metagraph.graph.problem_groups import group_problems


def test_no_problems_have_no_groups(toy: Any) -> None:
    assert group_problems(toy.project(), []) == []


def test_three_actions_of_a_stance_that_begin_or_end_far_off_are_one_line_with_its_list(toy: Any) -> None:
    project = toy.project()
    names = ("rest beat lf", "rest wave rt", "rest long")
    ids = [toy.id(project, name) for name in names]
    two = edits.update_actions(project, ids[:2], timing={"start": 0.4, "blend_in": 0.0})
    alone = group_problems(two, check_project(two))
    assert all(len(group.problems) == 1 and group.words == group.problems[0].message for group in alone)
    wrong = edits.update_actions(two, ids[2:], timing={"start": 0.7, "blend_in": 0.0})
    problems = check_project(wrong)
    groups = group_problems(wrong, problems)
    (together,) = [group for group in groups if len(group.problems) > 1]
    assert together.words.startswith("rest: 3 actions begin or end ") and together.words.endswith(" cm off")
    assert {p.action for p in together.problems} == set(ids)
    assert sorted(map(str, (p for group in groups for p in group.problems))) == sorted(map(str, problems))
