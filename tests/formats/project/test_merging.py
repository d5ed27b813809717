"""What was done on two sides since they were one is in the whole, and nothing of either is lost unsaid."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from metagraph.formats.project.data import from_data, to_data
from metagraph.formats.project.merging import merge_projects
from metagraph.graph import edits
from metagraph.graph.check import check_project
from metagraph.graph.manual import edits as manual_edits
from metagraph.graph.manual.groups import add_alias
from metagraph.graph.model import Project
from tests.projects import clip, histories

pytestmark = pytest.mark.usefixtures("numbered_ids")


SETS = ("tags", "joints", "hidden", "locked")  # lists in which the order says nothing


def first() -> Project:
    rows = [(f"{n}.glb", 0, "ab" * 32, clip(f"clip {n}")) for n in range(6)]
    project = edits.add_stance(edits.add_clips(Project("show"), rows), "arms", "rest", ["c1"])
    return edits.place_clips(project, ["c2", "c3"], "arms", "gesture", "s7")


def names(project: Project) -> list[str]:
    return [a.name for a in project.actions()]


def test_a_project_merged_with_itself_is_itself() -> None:
    found = merge_projects(first(), first(), first())
    assert to_data(found.project) == to_data(first()) and not found.kept


@settings(max_examples=60, deadline=None)
@given(histories(6), st.data())
def test_where_one_side_did_nothing_the_other_is_the_whole(
    states: list[Project], data: st.DataObject
) -> None:
    a, b = data.draw(st.sampled_from(states)), data.draw(st.sampled_from(states))
    for mine, theirs in ((b, a), (a, b)):
        found = merge_projects(a, mine, theirs)
        wanted, got = to_data(b), to_data(found.project)
        assert got == wanted and not found.kept


@settings(max_examples=80, deadline=None)
@given(histories(6), histories(6), st.data())
def test_two_histories_give_a_project_that_can_be_read_and_checked(
    one: list[Project], two: list[Project], data: st.DataObject
) -> None:
    base = one[0]
    mine, theirs = data.draw(st.sampled_from(one)), data.draw(st.sampled_from(two))
    found = merge_projects(base, mine, theirs)
    assert to_data(from_data(to_data(found.project))) == to_data(found.project)
    check_project(found.project)


def flat(data: Any, where: str = "") -> dict[str, Any]:
    """Return every value of a project by where it stands; what has an id stands under it."""
    if isinstance(data, list) and data and all(isinstance(x, dict) and "id" in x for x in data):
        data = {x["id"]: x for x in data}
    if isinstance(data, dict):
        return {k: v for key, value in data.items() for k, v in flat(value, f"{where}/{key}").items()}
    return {where: data} if data != [] else {}


@pytest.mark.nightly
@settings(max_examples=200, deadline=None)
@given(st.data())
def test_no_edit_of_two_people_is_lost_without_a_report(data: st.DataObject) -> None:
    base = data.draw(histories(8))[-1]
    mine, theirs = (data.draw(histories(5, base))[-1] for _ in range(2))
    found = merge_projects(base, mine, theirs)
    before, ours, others, after = (flat(to_data(p)) for p in (base, mine, theirs, found.project))
    both = 0
    old, here, there = ({v for k, v in side.items() if k.endswith("/id")} for side in (before, ours, others))
    new = (here & there) - old
    for where in before | ours | others:
        old, here, there, now = (side.get(where) for side in (before, ours, others, after))
        if str(here) in new or new.intersection(where.split("/")):
            continue  # made by both, and two things if they are not the same
        if where.rpartition("/")[2] in SETS:  # what either added and neither removed
            kept, sides = set(old or ()), (set(here or ()), set(there or ()))
            wanted = (sorted({x for x in sides[0] | sides[1] if x not in kept or x in sides[0] & sides[1]}),)
            now = sorted(now or ())
        elif here == there or there == old:
            wanted = (here,)
        elif here == old:
            wanted = (there,)
        else:
            wanted = (here, there)
            both += 1
        if now not in wanted:
            assert found.kept or (both and now == old), (where, old, here, there, now)
    assert to_data(merge_projects(base, mine, theirs).project) == to_data(found.project), (
        "it comes out the same"
    )


def test_different_things_changed_are_both_there() -> None:
    base = first()
    mine = edits.rename_clip(base, "c1", "mine")
    theirs = edits.rename_clip(edits.set_settings(base, seed=9), "c4", "theirs")
    found = merge_projects(base, mine, theirs)
    assert found.project.clips["c1"].name == "mine" and found.project.clips["c4"].name == "theirs"
    assert found.project.settings.seed == 9 and not found.kept


def test_different_fields_of_one_thing_are_both_there() -> None:
    base = first()
    (one, _) = (a.id for a in base.actions() if a.kind == "gesture")
    mine = edits.update_actions(base, (one,), likelihood=3.0)
    theirs = edits.update_actions(base, (one,), name="theirs")
    found = merge_projects(base, mine, theirs)
    action = found.project.action(one)
    assert action is not None and (action.likelihood, action.name) == (3.0, "theirs") and not found.kept


def test_the_same_field_changed_on_both_sides_is_mine_and_told() -> None:
    base = first()
    found = merge_projects(
        base, edits.rename_clip(base, "c1", "mine"), edits.rename_clip(base, "c1", "theirs")
    )
    assert found.project.clips["c1"].name == "mine"
    assert len(found.kept) == 1 and "name" in found.kept[0]


def test_a_field_set_back_to_its_default_is_mine_too() -> None:
    base = edits.set_settings(first(), seed=9)
    found = merge_projects(base, edits.set_settings(base, seed=1), edits.set_settings(base, seed=5))
    assert found.project.settings.seed == 1 and len(found.kept) == 1


@pytest.mark.parametrize("here", [True, False])
def test_what_one_removed_and_the_other_changed_stays_and_is_told(here: bool) -> None:
    base = first()
    (one, _) = (a.id for a in base.actions() if a.kind == "gesture")
    gone = edits.remove_actions(base, [one])
    changed = edits.update_actions(base, (one,), likelihood=3.0)
    found = merge_projects(base, *((gone, changed) if here else (changed, gone)))
    action = found.project.action(one)
    assert action is not None and action.likelihood == 3.0 and "removed" in found.kept[0]


def test_what_both_made_under_one_id_is_two_things_and_what_names_them_follows() -> None:
    base = first()
    one, two = (
        edits.add_stance(base, "arms", "mine", ["c4"]),
        edits.add_stance(base, "arms", "theirs", ["c5"]),
    )
    new = [i for i in one.graphs["arms"].stances if i not in base.graphs["arms"].stances]
    assert new == [i for i in two.graphs["arms"].stances if i not in base.graphs["arms"].stances]
    mine = edits.place_clips(one, ["c5"], "arms", "gesture", new[0])
    theirs = edits.place_clips(two, ["c6"], "arms", "gesture", new[0])
    found = merge_projects(base, mine, theirs).project
    stances = {s.name: s.id for s in found.graphs["arms"].stances.values()}
    assert set(stances) == {"rest", "mine", "theirs"}
    clips = {(a.stance, a.clip) for a in found.actions() if a.kind == "gesture"}
    assert {(stances["mine"], "c5"), (stances["theirs"], "c6")} <= clips
    more = edits.place_clips(found, ["c1"], "arms", "gesture", stances["mine"])
    assert len(list(more.actions())) == len(list(found.actions())) + 1, "no id is made twice after it"
    assert not [p for p in check_project(found) if "not in the project" in p.message]


def test_two_timings_of_one_action_are_not_mixed() -> None:
    base = first()
    (one, _) = (a.id for a in base.actions() if a.kind == "gesture")
    action = base.action(one)
    assert action is not None
    mine = edits.update_actions(base, (one,), timing=replace(action.timing, start=0.1))
    theirs = edits.update_actions(base, (one,), timing=replace(action.timing, end=0.9))
    found = merge_projects(base, mine, theirs)
    merged, ours = found.project.action(one), mine.action(one)
    assert merged is not None and ours is not None
    assert merged.timing == ours.timing and "timing" in found.kept[0]


def test_notes_and_lines_are_things_of_their_own() -> None:
    base = replace(first(), notes={"c1": "old"})
    mine = replace(base, notes={"c1": "old", "c2": "mine"})
    theirs = replace(base, notes={"c1": "new", "c3": "theirs"})
    assert merge_projects(base, mine, theirs).project.notes == {"c1": "new", "c2": "mine", "c3": "theirs"}


@pytest.mark.parametrize("swapped", [True, False])
def test_a_state_that_one_removed_and_the_other_linked_stays_and_is_told(swapped: bool) -> None:
    base = manual_edits.add_states(first(), ["c2", "c3"], "arms")
    one, other = base.manual["arms"].states
    removed = manual_edits.remove_states(base, [one])
    linked = manual_edits.add_links(base, "arms", [other], [one])
    sides = (removed, linked) if swapped else (linked, removed)
    found = merge_projects(base, *sides)
    machine = found.project.manual["arms"]
    assert set(machine.states) == {one, other} and len(machine.links) == 1
    assert any("state" in words and "kept" in words for words in found.kept)


@pytest.mark.parametrize("swapped", [True, False])
def test_an_alias_that_one_removed_and_the_other_linked_comes_back_with_its_states(swapped: bool) -> None:
    base = manual_edits.add_states(first(), ["c2", "c3", "c4"], "arms")
    one, other, third = base.manual["arms"].states
    base = add_alias(base, "arms", (one, other))
    (alias,) = base.manual["arms"].aliases
    removed = manual_edits.remove_states(base, [alias, one])
    linked = manual_edits.add_links(base, "arms", [alias], [third])
    sides = (removed, linked) if swapped else (linked, removed)
    machine = merge_projects(base, *sides).project.manual["arms"]
    assert set(machine.aliases[alias].states) == {one, other} <= set(machine.states)
