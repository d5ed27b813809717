"""A journal's steps distinguished again: every state of every step as it was."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from metagraph.formats.project.data import from_data, to_data
from metagraph.formats.project.history import list_undo_steps, with_motion
from metagraph.formats.project.journal import Journal
from metagraph.formats.project.journal_records import encode_record
from metagraph.formats.recovery import Left, read_journal
from metagraph.graph import edits
from metagraph.graph.model import Project
from tests.projects import clip, histories

pytestmark = pytest.mark.usefixtures("numbered_ids")


def left_by(journal: Journal) -> Left:
    journal.close()
    found = read_journal(journal.path, None)
    assert found is not None
    return found


def begun(folder: Path | str, base: Project) -> Journal:
    journal = Journal(Path(folder) / "j", None)
    journal.begin(base)
    return journal


@pytest.mark.nightly
@settings(max_examples=80, deadline=None)
@given(histories())
def test_every_state_on_the_way_is_there_again(states: list[Project]) -> None:
    states = [states[0], *(b for a, b in pairwise(states) if to_data(a) != to_data(b))]
    with TemporaryDirectory() as folder:
        journal = begun(folder, states[0])
        for n, (before, after) in enumerate(pairwise(states)):
            journal.edit(before, after, f"edit {n}")
        if len(states) < 2:
            journal.close()
            return
        left = left_by(journal)
        steps = list_undo_steps(left)
        assert [s.text for s in steps] == [f"edit {n}" for n in range(len(states) - 1)]
        for step, (before, after) in zip(steps, pairwise(states), strict=True):
            assert step.before == from_data(to_data(before)) and step.after == from_data(to_data(after))
        assert all(a.after is b.before for a, b in pairwise(steps))


def numbered(count: int) -> list[Project]:
    first = edits.add_clips(Project("p"), [("a.glb", 0, "", clip("a")), ("b.glb", 0, "", clip("b"))])
    return [edits.rename_clip(first, "c1", f"name {n}") for n in range(count)]


def test_what_a_step_left_alone_is_shared(tmp_path: Path) -> None:
    states = numbered(3)
    journal = begun(tmp_path, states[0])
    for before, after in pairwise(states):
        journal.edit(before, after, "rename")
    one, two = list_undo_steps(left_by(journal))
    assert one.before.graphs is two.after.graphs
    assert one.before.clips["c2"] is two.after.clips["c2"]


def test_a_run_of_merged_edits_is_one_step_and_what_was_undone_none(tmp_path: Path) -> None:
    a, b, c, d, e = numbered(5)
    journal = begun(tmp_path, a)
    journal.edit(a, b, "drag")
    journal.edit(b, c, "drag", "merged")
    journal.edit(c, d, "rename")
    journal.edit(d, c, "rename", "undone")
    journal.edit(c, a, "drag", "undone")
    journal.edit(a, c, "drag", "redone")
    journal.edit(c, e, "last")
    left = left_by(journal)
    steps = list_undo_steps(left)
    assert [s.text for s in steps] == ["drag", "last"]
    assert (to_data(steps[0].before), to_data(steps[0].after)) == (to_data(a), to_data(c))
    assert steps[-1].after == left.project


def test_a_drag_is_told_as_one_edit(tmp_path: Path) -> None:
    states = numbered(6)
    journal = begun(tmp_path, states[0])
    for at, (before, after) in enumerate(pairwise(states)):
        journal.edit(before, after, "drag", "merged" if at else "done")
    assert left_by(journal).edits == 1


def test_undoing_what_was_saved_is_a_step_that_can_be_undone(tmp_path: Path) -> None:
    a, b = numbered(2)
    journal = begun(tmp_path, b)  # saved after a became b
    journal.edit(b, a, "rename", "undone")
    (step,) = list_undo_steps(left_by(journal))
    assert step.text == "Undo rename" and to_data(step.before) == to_data(b)


def test_records_of_a_time_without_words_are_steps_too(tmp_path: Path) -> None:
    a, b = numbered(2)
    journal = begun(tmp_path, a)
    journal.edit(a, b)
    (step,) = list_undo_steps(left_by(journal))
    assert step.text == "Recovered edit" and to_data(step.after) == to_data(b)


def test_edits_that_end_where_they_began_are_no_step(tmp_path: Path) -> None:
    a, b = numbered(2)
    journal = begun(tmp_path, a)
    journal.edit(a, b, "rename")
    journal.edit(b, a, "rename", "undone")
    assert list_undo_steps(left_by(journal)) == ()


def test_motion_comes_back_to_clips_that_were_removed_or_renamed_on_the_way(tmp_path: Path) -> None:
    a, b = numbered(2)
    c = edits.remove_clips(b, ["c2"])
    journal = begun(tmp_path, a)
    journal.edit(a, b, "rename")
    journal.edit(b, c, "remove")
    left = left_by(journal)
    files = {"a.glb": clip("a"), "b.glb": clip("b")}
    asked: list[list[str]] = []

    def load(project: Project) -> Project:
        asked.append([e.path for e in project.clips.values()])
        clips = {i: replace(e, motion=files[e.path].renamed(e.name)) for i, e in project.clips.items()}
        return replace(project, clips=clips)

    steps = with_motion(list_undo_steps(left), left.project, load(left.project), load)
    assert asked == [["a.glb"], ["b.glb"]], "what is read already is not read again"
    for step in steps:
        for project in (step.before, step.after):
            assert all(e.motion is not None and e.motion.name == e.name for e in project.clips.values())
    assert steps[0].after is steps[1].before
    assert steps[0].before.clips["c2"] is steps[1].before.clips["c2"]


@pytest.mark.parametrize("garbage", [{"how": "undone"}, {"how": 7, "step": ["x"]}, {"step": None}])
def test_words_that_are_none_do_no_harm(tmp_path: Path, garbage: dict[str, object]) -> None:
    a, b = numbered(2)
    journal = begun(tmp_path, a)
    journal.edit(a, b, "rename")
    journal.close()
    with (tmp_path / "j").open("ab") as file:
        file.write(encode_record({"name": "other", **garbage}, 3))
    found = read_journal(tmp_path / "j", None)
    assert found is not None and found.project.name == "other"
    assert list_undo_steps(found)[-1].after == found.project


@settings(max_examples=40, deadline=None)
@given(histories(6), st.data())
def test_from_any_state_to_any_other(states: list[Project], data: st.DataObject) -> None:
    a, b = data.draw(st.sampled_from(states)), data.draw(st.sampled_from(states))
    with TemporaryDirectory() as folder:
        journal = begun(folder, a)
        journal.edit(a, b, "jump")
        journal.edit(b, a, "back")
        journal.edit(a, b, "again")
        journal.close()
        left = read_journal(journal.path, None)
        if to_data(a) != to_data(b):
            assert left is not None
            assert [s.text for s in list_undo_steps(left)] == ["jump", "back", "again"]
