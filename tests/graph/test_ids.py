"""Ids do not collide, whoever makes them where, and never depend on what was made before."""

from __future__ import annotations

import re
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.graph import edits
from metagraph.graph import timeline_edits as t
from metagraph.graph.editing import performances as performance_edits
from metagraph.graph.ids import derive_id, make_id
from metagraph.graph.manual import edits as manual_edits
from metagraph.graph.manual import groups as manual_groups
from metagraph.graph.model import Project
from metagraph.graph.requests import Nod, Performance
from tests.projects import clip


def two_clips() -> Project:
    return edits.add_clips(Project(), [(f"{n}.glb", 0, "", clip(n)) for n in ("one", "two")])


def every_id(project: Project) -> list[str]:
    graphs, machines = project.graphs.values(), project.manual.values()
    return [
        *project.clips,
        *(i for g in graphs for i in (*g.stances, *g.actions)),
        *(i for m in machines for i in (*m.states, *m.links, *m.aliases)),
        *project.performances,
        *project.conversations,
        *(m.id for line in project.timelines.values() for m in line.markers),
    ]


def everything() -> Project:
    project = two_clips()
    one, two = project.clips
    project = edits.add_stance(project, "arms", "rest", [one])
    (stance,) = project.graphs["arms"].stances
    project = edits.place_clips(project, [one, two, one], "arms", "gesture", stance)
    project = manual_edits.add_states(project, [one, two, one], "head")
    a, b, c = project.manual["head"].states
    project = manual_edits.add_links(project, "head", [a, b], [b, c])
    project = manual_groups.add_alias(project, "head", [a, b])
    project, kept = performance_edits.add_performance(project, Performance(name="talk", asks=(Nod(at=1.0),)))
    project, _ = performance_edits.add_performance(project, Performance(name="talk", asks=(Nod(at=1.0),)))
    return t.add_marker(t.add_marker(project, kept, 1.0)[0], kept, 2.0)[0]


def test_everything_that_can_be_made_has_an_id_of_its_own() -> None:
    made = every_id(everything())
    assert len(made) == len(set(made)) == 2 + 1 + 4 + 3 + 3 + 1 + 2 + 2
    assert all(re.fullmatch("[acglmps][1-9][0-9]{8}", ident) for ident in made)


def test_the_same_thing_made_twice_apart_has_the_same_id() -> None:
    assert every_id(everything()) == every_id(everything())


def test_what_two_people_add_to_one_project_has_other_ids(toy: Any) -> None:
    base = toy.project()
    sides = [edits.add_clips(base, [(f"{n}.glb", 0, "", toy.clip(n))]) for n in ("mine", "theirs")]
    rest = toy.id(base, "rest")
    for n, side in enumerate(sides):
        (new,) = side.clips.keys() - base.clips.keys()
        sides[n] = edits.place_clips(side, [new], "arms", "gesture", rest)
    mine, theirs = (set(every_id(side)) - set(every_id(base)) for side in sides)
    assert len(mine) == len(theirs) == 2 and not mine & theirs


def test_an_id_that_is_taken_is_not_made_again() -> None:
    project = two_clips()
    ident = next(iter(project.clips))
    assert make_id(project, "c", "one.glb", 0) != ident == make_id(Project(), "c", "one.glb", 0)
    assert make_id(Project(), "c", "one.glb", 0, more=[ident]) != ident


def test_the_same_thing_made_a_thousand_times_has_a_thousand_ids() -> None:
    project = two_clips()
    one, _ = project.clips
    project = edits.add_stance(project, "arms", "rest", [one])
    (stance,) = project.graphs["arms"].stances
    project = edits.place_clips(project, [one] * 1000, "arms", "gesture", stance)
    project = edits.place_clips(project, [one] * 1000, "arms", "gesture", stance)
    assert len({a.id for a in project.actions()}) == 2001


def test_ids_of_old_files_stay_and_new_ones_are_made_beside_them(toy: Any) -> None:
    project = toy.project()
    assert "c1" in project.clips
    after = edits.add_clips(project, [("new.glb", 0, "", toy.clip("new"))])
    assert [*after.clips][:-1] == [*project.clips] and len([*after.clips][-1]) == 10


@given(st.lists(st.text(), max_size=3), st.lists(st.text(), max_size=3))
def test_other_things_have_other_ids(one: list[str], other: list[str]) -> None:
    assert (derive_id("a", *one) == derive_id("a", *other)) == (one == other)


@pytest.mark.parametrize("path", ["\ud800.glb", "", "a" * 10_000])
def test_any_path_gives_an_id(path: str) -> None:
    assert re.fullmatch("c[1-9][0-9]{8}", derive_id("c", path, 0))
