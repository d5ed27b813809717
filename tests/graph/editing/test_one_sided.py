"""Stances in which one arm alone moves."""

from __future__ import annotations

from metagraph.formats.store import open_project
from metagraph.graph.editing.one_sided import describe_one_sided, list_one_sided
from metagraph.graph.model import Project


def test_the_samples_one_sided_stances_are_counted() -> None:
    from app.project.files import SAMPLE

    found = list_one_sided(open_project(SAMPLE).project)
    assert {one.name: (one.lacks, len(one.actions)) for one in found} == {
        "arms crossed": ("left", 5),
        "hand to chin": ("left", 6),
        "hands clasped": ("left", 2),
    }
    assert (
        describe_one_sided(found[0]) == "'arms crossed' has 5 actions of the right arm and none of the left"
    )
    assert list_one_sided(Project()) == []
