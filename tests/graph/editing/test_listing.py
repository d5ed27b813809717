"""Clips once more, and actions in another order."""

from __future__ import annotations

import pytest

from metagraph.formats.project.journal import find_changes
from metagraph.formats.store import open_project, save_project
from metagraph.graph import edits
from metagraph.graph.editing.listing import (
    duplicate_clips,
    is_listed_differently,
    reorder_actions,
    reorder_stances,
    shift_actions,
    shift_stance,
)
from metagraph.graph.editing.marks import mark
from metagraph.playback.planner import make_plan
from metagraph.research.exhibits.paper_planner import plan_as_in_paper


@pytest.fixture(scope="module")
def project(toy):
    """Five gestures on one stance, with a fidget between them."""
    out = toy.project()
    more = [(f"more/{n}.bvh", 0, "", toy.clip(f"g{n}")) for n in range(5)]
    out = edits.add_clips(out, more)
    known = {e.name: e.id for e in out.clips.values()}
    stance = out.action(toy.id(out, "rest cough")).stance
    for n in range(5):
        out = edits.place_clips(out, [known[f"g{n}"]], "arms", "gesture", stance)
        if n == 2:
            out = edits.place_clips(out, [known["g2"]], "arms", "fidget", stance)
    return out


def gestures(project):
    return [a for a in project.graphs["arms"].actions.values() if a.kind == "gesture" and a.name[0] == "g"]


def names(project):
    return "".join(a.name[1] for a in gestures(project))


def ids(project, digits):
    return {a.id for a in gestures(project) if a.name[1] in digits}


@pytest.mark.parametrize(
    ("moving", "before", "after"),
    [
        ("3", "0", "30124"),
        ("0", None, "12340"),
        ("13", "0", "13024"),
        ("04", "2", "10423"),
        ("2", "3", "01234"),
    ],
)
def test_actions_are_listed_in_front_of_another(project, moving, before, after):
    target = next(iter(ids(project, before))) if before else None
    assert names(reorder_actions(project, ids(project, moving), target)) == after


@pytest.mark.parametrize(
    ("moving", "steps", "after"),
    [("2", -1, "02134"), ("2", 1, "01324"), ("0", -1, "01234"), ("01", -1, "01234"), ("02", -1, "02134"),
     ("34", 1, "01234"), ("24", 1, "01324"), ("13", 1, "02143"), ("", 1, "01234")],
)  # fmt: skip
def test_actions_go_a_place_earlier_or_later_and_keep_together(project, moving, steps, after):
    assert names(shift_actions(project, ids(project, moving), steps)) == after


def test_other_nodes_keep_their_order_and_nothing_else_changes(project):
    after = reorder_actions(project, ids(project, "3"), next(iter(ids(project, "0"))))
    assert after.graphs["arms"].actions == project.graphs["arms"].actions
    others = [[a for a in p.graphs["arms"].actions if p.action(a).kind == "fidget"] for p in (project, after)]
    assert others[0] == others[1]
    assert set(find_changes(project, after)["layers"]["arms"]) == {"actions_order"}


def test_another_order_survives_saving(project, tmp_path):
    after = reorder_actions(project, ids(project, "4"), next(iter(ids(project, "1"))))
    save_project(after, tmp_path / "p.metagraph.yaml")
    assert names(open_project(tmp_path / "p.metagraph.yaml").project) == "04123"


def test_what_plays_does_not_depend_on_the_order_of_lists(project):
    after = shift_actions(project, ids(project, "13"), -1)
    plans = [make_plan(p, 40.0) for p in (plan_as_in_paper(project), plan_as_in_paper(after))]
    heard = [[(c.action.id, c.start) for c in p.layers["arms"].cues] for p in plans]
    assert heard[0] == heard[1] and len(heard[0]) > 3


def test_what_is_the_same_is_the_same_project(project):
    assert reorder_actions(project, [], None) is project
    assert reorder_actions(project, ids(project, "4"), None) is project
    assert shift_actions(project, ids(project, "4"), 1) is project


def test_duplicates_have_names_of_their_own_and_what_is_on_the_first(toy):
    project = toy.project()
    one = next(iter(project.clips))
    project = mark(project, [one], rating=3)
    twice = duplicate_clips(duplicate_clips(project, [one]), [one])
    entries = [e for e in twice.clips.values() if e.path == project.clips[one].path]
    name = project.clips[one].name
    assert [e.name for e in entries] == [name, f"{name} copy 2", f"{name} copy"]
    assert all(twice.marks[e.id].rating == 3 and e.motion is project.clips[one].motion for e in entries)
    assert len(twice.clips) == len(project.clips) + 2 and duplicate_clips(project, []) is project


def test_duplicates_are_read_again_with_their_file(toy, tmp_path):
    from metagraph.formats.gltf.writer import write_glb

    write_glb(tmp_path / "wave.glb", [toy.clip("wave")])
    project = edits.add_clips(toy.project(), [("wave.glb", 0, "", toy.clip("wave"))])
    twice = duplicate_clips(project, [toy.id(project, "wave")])
    save_project(twice, tmp_path / "p.metagraph.yaml")
    opened = open_project(tmp_path / "p.metagraph.yaml").project
    assert [e.motion is not None for e in opened.clips.values() if e.path == "wave.glb"] == [True, True]
    again = edits.add_clips(twice, [("wave.glb", 0, "new", toy.clip("wave"))])
    assert [e.digest for e in again.clips.values() if e.path == "wave.glb"] == ["new", "new"]
    assert len(again.clips) == len(twice.clips)


def stances(project):
    return [s.name for s in project.graphs["arms"].stances.values()]


@pytest.mark.parametrize(
    ("moving", "before", "after"),
    [("far", "rest", "far rest up"), ("rest", None, "up far rest"), ("rest", "far", "up rest far")],
)
def test_a_stance_is_listed_in_front_of_another(project, toy, moving, before, after):
    target = toy.id(project, before) if before else None
    assert stances(reorder_stances(project, toy.id(project, moving), target)) == after.split()


def test_a_stance_that_stands_there_or_is_gone_stays(project, toy):
    assert reorder_stances(project, toy.id(project, "far"), None) is project
    assert reorder_stances(project, toy.id(project, "rest"), toy.id(project, "up")) is project
    assert reorder_stances(project, "gone", None) is project
    assert shift_stance(project, toy.id(project, "rest"), -1) is project
    assert stances(shift_stance(project, toy.id(project, "up"), 1)) == ["rest", "far", "up"]
    assert stances(shift_stance(project, toy.id(project, "up"), -1)) == ["up", "rest", "far"]


def test_the_order_of_stances_is_kept_in_the_file_and_the_journal_and_changes_no_plan(project, toy, tmp_path):
    after = reorder_stances(project, toy.id(project, "far"), toy.id(project, "rest"))
    assert is_listed_differently(project, after)
    assert list(find_changes(project, after)["layers"]["arms"]["stances_order"]) == list(
        after.graphs["arms"].stances
    )
    path = tmp_path / "p.metagraph.json"
    save_project(after, path)
    assert stances(open_project(path).project) == ["far", "rest", "up"]
    assert make_plan(after, 30.0) == make_plan(project, 30.0)
