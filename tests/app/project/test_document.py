"""The document: one undo step an edit, drags merged, nothing unsaved lost."""

from __future__ import annotations

import json
import shutil
from itertools import pairwise

import pytest

from app.project.autosave import find_journal_shelter, state_folder
from app.project.document import UNDO_STEPS, Document, ProjectPast
from app.project.writing import name_after_file
from metagraph.errors import FileError
from metagraph.formats.project.history import UndoStep
from metagraph.formats.project.journal_records import read_records
from metagraph.formats.recovery import read_journal, recover
from metagraph.formats.store import SUFFIX, read_project, save_project
from metagraph.graph import edits
from metagraph.graph.edit_error import EditError
from metagraph.graph.model import Project


@pytest.fixture
def document(qapp, toy):
    document = Document()
    document.load(toy.project(), None)
    yield document
    document.close_journal()


def likely(document, ident, value, merge=None):
    document.edit("Change likelihood", lambda p: edits.update_actions(p, (ident,), likelihood=value), merge)


def test_an_edit_is_one_step_that_goes_back_and_forth(document, toy):
    before, beat = document.project, toy.id(document.project, "rest beat lf")
    seen = []
    document.changed.connect(lambda a, b: seen.append((a, b)))
    likely(document, beat, 2.0)
    after = document.project
    assert after.action(beat).likelihood == 2.0
    document.undo()
    assert document.project is before
    document.redo()
    assert document.project is after
    assert seen == [(before, after), (after, before), (before, after)]
    assert document.undo_stack.undoText() == "Likelihood 1 → 2, rest beat lf"


def test_an_edit_that_changes_nothing_is_no_step(document, toy):
    document.edit("Nothing", lambda p: p)
    document.edit("Same", lambda p: edits.set_settings(p, seed=p.settings.seed))
    assert document.undo_stack.count() == 0
    assert not document.dirty


def test_a_refused_edit_leaves_everything_as_it_was(document, toy):
    before = document.project
    with pytest.raises(EditError):
        document.edit("Bad", lambda p: edits.place_clips(p, ["no such clip"], "arms", "gesture", None))
    assert document.project is before
    assert document.undo_stack.count() == 0


def test_a_drag_is_one_step_and_the_next_drag_another(document, toy):
    before, beat = document.project, toy.id(document.project, "rest beat lf")
    for value in (1.1, 1.2, 1.3):
        likely(document, beat, value, merge="likelihood")
    document.finish_merging()
    middle = document.project
    for value in (1.4, 1.5):
        likely(document, beat, value, merge="likelihood")
    document.finish_merging()
    assert document.undo_stack.count() == 2
    document.undo()
    assert document.project is middle
    document.undo()
    assert document.project is before


def test_a_cancelled_drag_leaves_no_trace(document, toy):
    before, beat = document.project, toy.id(document.project, "rest beat lf")
    for value in (1.1, 1.2):
        likely(document, beat, value, merge="likelihood")
    document.cancel_merging("likelihood")
    assert document.project is before
    assert not document.undo_stack.canRedo()
    likely(document, beat, 3.0)
    document.cancel_merging("likelihood")
    assert document.project.action(beat).likelihood == 3.0, "only the drag that is going on is taken back"


def test_edits_of_different_things_do_not_merge(document, toy):
    likely(document, toy.id(document.project, "rest beat lf"), 2.0, merge="likelihood")
    document.edit("Change seed", lambda p: edits.set_settings(p, seed=9), merge="seed")
    assert document.undo_stack.count() == 2


def test_the_dirty_mark_follows_saving_and_undo(document, toy, tmp_path):
    beat = toy.id(document.project, "rest beat lf")
    assert not document.dirty
    likely(document, beat, 2.0)
    assert document.dirty
    document.save(tmp_path / "mine.metagraph.yaml")
    assert not document.dirty
    likely(document, beat, 2.5, merge="likelihood")
    document.save()
    likely(document, beat, 2.6, merge="likelihood")
    assert document.dirty, "a drag after saving does not melt into what was saved"
    document.undo()
    assert not document.dirty
    document.undo()
    assert document.dirty, "before the save is not what is in the file"


def test_saving_elsewhere_names_the_project_and_makes_paths_relative(document, toy, tmp_path):
    absolute = [(tmp_path / "clips" / e.path).as_posix() for e in document.project.clips.values()]
    from dataclasses import replace

    clips = {
        i: replace(e, path=p) for (i, e), p in zip(document.project.clips.items(), absolute, strict=True)
    }
    document.load(replace(document.project, clips=clips), None)
    document.save(tmp_path / "shows" / "tuesday.metagraph.yaml")
    assert document.project.name == "tuesday"
    assert next(iter(document.project.clips.values())).path == "../clips/rest loop.glb"
    assert document.folder == tmp_path / "shows"
    document.save(tmp_path / "other.metagraph.yaml")
    assert next(iter(document.project.clips.values())).path == "clips/rest loop.glb"
    assert read_project(tmp_path / "other.metagraph.yaml").name == "other"
    first = next(iter(document.project.clips.values()))
    assert first.motion is not None, "what is loaded stays loaded"


@pytest.mark.parametrize(
    ("file", "name"),
    [
        ("a.metagraph.yaml", "a"),
        ("B.METAGRAPH.YAML", "B"),
        ("c.yaml", "c"),
        ("d.yml", "d"),
        ("e.f", "e.f"),
        (".yaml", ".yaml"),
    ],
)
def test_a_project_is_named_after_its_file(tmp_path, file, name):
    assert name_after_file(tmp_path / file) == name


def test_the_first_save_keeps_every_step(document, toy, tmp_path):
    beat = toy.id(document.project, "rest beat lf")
    likely(document, beat, 2.0)
    likely(document, beat, 3.0)
    document.undo()
    document.save(tmp_path / "mine.metagraph.yaml")
    assert not document.dirty
    assert document.project.action(beat).likelihood == 2.0
    document.undo()
    assert document.project.action(beat).likelihood == 1.0 and document.dirty
    assert document.project.name == "mine"
    document.redo()
    assert not document.dirty
    document.redo()
    assert document.project.action(beat).likelihood == 3.0


def test_undo_after_saving_elsewhere_leads_to_paths_of_the_new_place(document, toy, tmp_path):
    (tmp_path / "a").mkdir()
    (tmp_path / "b").mkdir()
    document.save(tmp_path / "a" / "one.metagraph.yaml")
    likely(document, toy.id(document.project, "rest beat lf"), 2.0)
    document.save(tmp_path / "b" / "two.metagraph.yaml")
    now = {i: e.path for i, e in document.project.clips.items()}
    document.undo()
    assert {i: e.path for i, e in document.project.clips.items()} == now
    assert document.project.name == "two"
    document.save()
    assert read_project(document.path).clips.keys() == document.project.clips.keys()


def test_an_edit_made_while_it_is_saved_elsewhere_can_be_undone(document, toy, tmp_path):
    beat = toy.id(document.project, "rest beat lf")
    likely(document, beat, 2.0)
    writing = document.begin_saving(tmp_path / "mine.metagraph.yaml")
    likely(document, beat, 3.0)
    writing.write()
    document.end_saving(writing)
    assert document.dirty and document.project.name == "mine"
    document.undo()
    assert document.project.action(beat).likelihood == 2.0
    document.undo()
    assert document.project.action(beat).likelihood == 1.0
    document.redo()
    document.redo()
    assert document.project.action(beat).likelihood == 3.0


def test_a_failed_save_changes_nothing(document, toy, tmp_path):
    likely(document, toy.id(document.project, "rest beat lf"), 2.0)
    before = document.project
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(FileError):
        document.save(tmp_path / "file" / "x.metagraph.yaml")
    assert document.project is before
    assert document.path is None
    assert document.dirty
    assert document.undo_stack.canUndo()


def test_saving_without_a_place_is_a_mistake_of_the_program(qapp):
    with pytest.raises(ValueError, match="needs a path"):
        Document().save()


def test_loading_forgets_the_steps_of_what_was_before(document, toy):
    likely(document, toy.id(document.project, "rest beat lf"), 2.0)
    document.load(Project("fresh"), None)
    assert not document.undo_stack.canUndo()
    assert not document.dirty
    assert document.folder is None


def test_edits_of_an_unsaved_project_are_in_its_journal(document, toy):
    beat = toy.id(document.project, "rest beat lf")
    assert recover(document.journal_place, None) is None, "no edits, nothing to recover"
    likely(document, beat, 2.0)
    likely(document, beat, 2.5)
    document.undo()
    found, count = recover(document.journal_place, None)
    assert count == 3
    assert found.action(beat).likelihood == 2.0
    document.close_journal()
    assert not document.journal_place.exists()


def test_edits_of_a_saved_project_are_beside_it_until_it_is_saved(document, toy, tmp_path):
    path, beat = tmp_path / "mine.metagraph.yaml", toy.id(document.project, "rest beat lf")
    document.save(path)
    assert not document.journal_place.exists()
    assert not document.journal_place.exists()
    likely(document, beat, 2.0)
    found, count = recover(document.journal_place, path)
    assert (found.action(beat).likelihood, count) == (2.0, 1)
    document.save()
    assert not document.journal_place.exists()


def test_recovered_edits_are_unsaved_and_survive_a_second_crash(qapp, toy, tmp_path):
    path = tmp_path / "mine.metagraph.yaml"
    project = save_project(toy.project(), path)
    beat = toy.id(project, "rest beat lf")
    recovered = edits.update_actions(project, (beat,), likelihood=2.0)
    document = Document()
    document.load(recovered, path, ProjectPast(lost=1))
    assert document.dirty
    document.edit("Change seed", lambda p: edits.set_settings(p, seed=5))
    found, _ = recover(document.journal_place, path)
    assert (found.action(beat).likelihood, found.settings.seed) == (2.0, 5)
    document.save()
    assert not document.dirty


@pytest.mark.parametrize("shelter_too", [False, True])
def test_a_journal_that_cannot_be_written_is_told_and_the_edit_stands(document, toy, tmp_path, shelter_too):
    path, beat, told = tmp_path / "mine.metagraph.yaml", toy.id(document.project, "rest beat lf"), []
    document.save(path)
    (document.failed if shelter_too else document.warned).connect(told.append)
    place = document.journal_place
    place.mkdir()
    if shelter_too:
        shutil.rmtree(find_journal_shelter(state_folder()), ignore_errors=True)
        find_journal_shelter(state_folder()).write_text("in the way")
    seen = []
    document.changed.connect(lambda a, b: seen.append(b))
    likely(document, beat, 2.0)
    assert document.project.action(beat).likelihood == 2.0
    assert seen == [document.project], "the views follow all the same"
    assert len(told) == 1
    if shelter_too:
        assert "autosaved" in told[0]
        find_journal_shelter(state_folder()).unlink()
    else:
        assert "Metagraph's own folder" in told[0]
        found = read_journal(document.journal_place, path)
        assert found is not None and found.project.action(beat).likelihood == 2.0
    place.rmdir()


def test_a_drag_writes_small_records(document, toy):
    beat = toy.id(document.project, "rest beat lf")
    for value in range(1, 50):
        likely(document, beat, 1 + value / 100, merge="likelihood")
    records = read_records(document.journal_place.read_bytes()).whole[2:]
    assert len(records) == 49
    assert max(len(json.dumps(record.data)) for record in records) < 600


def test_a_document_that_opened_nothing_is_autosaved_from_the_first_edit_on(qapp, toy):
    document = Document()
    assert not document.journal_place.exists(), "what a crash left behind must first be offered"
    document.edit("Import", lambda p: edits.add_clips(p, [("a.glb", 0, "", toy.clip("a"))]))
    found, count = recover(document.journal_place, None)
    assert ([e.name for e in found.clips.values()], count) == (["a"], 1)
    document.close_journal()


def test_the_last_steps_can_be_undone_and_no_more_are_held(document, toy, monkeypatch, tmp_path):
    beat = toy.id(document.project, "rest beat lf")
    document.save(tmp_path / f"mine{SUFFIX}")
    for n in range(UNDO_STEPS + 5):
        likely(document, beat, 2.0 + n)
    assert document.undo_stack.count() == UNDO_STEPS
    while document.undo_stack.canUndo():
        document.undo()
    assert document.project.action(beat).likelihood == 2.0 + 4
    assert document.dirty, "what was saved is further back"
    left = read_journal(document.journal_place, document.path)
    assert left.project.action(beat).likelihood == 2.0 + 4


def test_steps_that_a_crash_left_are_undone_as_far_as_any(document, toy):
    states = [document.project]
    beat = toy.id(document.project, "rest beat lf")
    for n in range(UNDO_STEPS + 3):
        states.append(edits.update_actions(states[-1], (beat,), likelihood=2.0 + n))
    steps = tuple(UndoStep(f"Step {n}", *two) for n, two in enumerate(pairwise(states)))
    document.load(states[-1], None, ProjectPast(steps=steps))
    assert document.undo_stack.count() == UNDO_STEPS and document.project == states[-1]
    while document.undo_stack.canUndo():
        document.undo()
    assert document.project == states[3]
