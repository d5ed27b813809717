"""Saving on a thread: edits go on meanwhile, one writing follows another, and closing waits."""

from __future__ import annotations

import threading

import pytest
from PySide6.QtCore import QTimer

from app.project import writing
from app.project.document import Document
from app.project.jobs import Jobs
from app.project.saver import Saver
from metagraph.errors import FileError
from metagraph.formats.recovery import read_journal
from metagraph.formats.store import read_project
from metagraph.graph import edits


@pytest.fixture
def saver(qapp, toy, tmp_path):
    """A saver of a document that was saved once, with a gate that writing waits at while it is closed."""
    document, jobs = Document(), Jobs()
    document.load(toy.project(), None)
    document.save(tmp_path / "mine.metagraph.yaml")
    saver = Saver(document, jobs, document)
    saver.told = []
    saver.failed.connect(lambda error, path: saver.told.append(error))
    saver.changed.connect(saver.told.append)
    yield saver
    jobs.stop()
    document.close_journal()


@pytest.fixture
def gate(monkeypatch):
    """Writing waits until the gate is opened; it counts how often the file was written."""
    gate, write = threading.Event(), writing.write_project
    gate.count = 0

    def late(*args):
        assert gate.wait(20)
        write(*args)
        gate.count += 1

    monkeypatch.setattr(writing, "write_project", late)
    yield gate
    gate.set()


def seed(saver, value):
    saver.document.edit("Change seed", lambda p: edits.set_settings(p, seed=value))


def on_disk(saver):
    return read_project(saver.document.path).settings.seed


def test_the_window_goes_on_while_it_is_written_and_is_clean_after(saver, gate, qtbot):
    seed(saver, 7)
    saver.save()
    assert saver.busy and saver.document.dirty and on_disk(saver) == 1
    gate.set()
    qtbot.waitUntil(lambda: not saver.busy)
    assert on_disk(saver) == 7
    assert not saver.document.dirty
    assert not saver.document.journal_place.exists()


def test_edits_made_meanwhile_are_not_saved_and_keep_it_dirty(saver, gate, qtbot):
    seed(saver, 7)
    saver.save()
    seed(saver, 8)
    gate.set()
    qtbot.waitUntil(lambda: not saver.busy)
    assert on_disk(saver) == 7
    assert saver.document.dirty
    left = read_journal(saver.document.journal_place, saver.document.path)
    assert (left.project.settings.seed, left.edits) == (8, 1), "a crash now loses nothing"
    saver.document.undo()
    assert not saver.document.dirty, "this is what was saved"
    saver.document.undo()
    assert saver.document.dirty


def test_what_was_saved_is_a_step_of_its_own_even_within_a_drag(saver, gate, qtbot):
    for value in (2, 3):
        saver.document.edit("Seed", lambda p, v=value: edits.set_settings(p, seed=v), "drag")
    saver.save()
    saver.document.edit("Seed", lambda p: edits.set_settings(p, seed=4), "drag")
    gate.set()
    qtbot.waitUntil(lambda: not saver.busy)
    saver.document.undo()
    assert saver.document.project.settings.seed == 3 and not saver.document.dirty


def test_saving_again_meanwhile_follows_and_saving_nothing_new_does_not(saver, gate, qtbot):
    seed(saver, 7)
    saver.save()
    seed(saver, 8)
    saver.save()
    saver.save()
    gate.set()
    qtbot.waitUntil(lambda: not saver.busy)
    assert on_disk(saver) == 8 and not saver.document.dirty
    assert gate.count == 2


def test_waiting_returns_when_all_is_written(saver, gate, qtbot):
    seed(saver, 7)
    saver.save()
    QTimer.singleShot(50, gate.set)
    assert saver.wait()
    assert on_disk(saver) == 7
    seed(saver, 8)
    assert not saver.wait(), "there are edits that nobody asked to save"


def test_a_place_that_cannot_be_written_is_told_and_nothing_is_clean(saver, qtbot, tmp_path):
    (tmp_path / "file").write_text("in the way")
    seed(saver, 7)
    saver.save(tmp_path / "file" / "x.metagraph.yaml")
    qtbot.waitUntil(lambda: bool(saver.told))
    assert isinstance(saver.told[0], FileError)
    assert saver.document.dirty and saver.document.path.name == "mine.metagraph.yaml"
    assert not saver.wait()


def test_saving_elsewhere_while_edits_go_on_takes_them_along_unsaved(saver, gate, qtbot, tmp_path):
    old = saver.document.path
    seed(saver, 7)
    (tmp_path / "more").mkdir()
    saver.save(tmp_path / "more" / "new.metagraph.yaml")
    seed(saver, 8)
    gate.set()
    qtbot.waitUntil(lambda: not saver.busy)
    document = saver.document
    assert document.path == tmp_path / "more" / "new.metagraph.yaml"
    assert (document.project.name, document.project.settings.seed, on_disk(saver)) == ("new", 8, 7)
    assert next(iter(document.project.clips.values())).path.startswith("../")
    assert document.dirty
    left = read_journal(document.journal_place, document.path)
    assert left.project.settings.seed == 8
    assert not list(old.parent.glob(".*.journal")) and not list(old.parent.glob(".*.lock"))


def test_a_file_that_somebody_else_has_written_is_not_overwritten(saver, qtbot, toy):
    path = saver.document.path
    theirs = edits.set_settings(read_project(path), seed=99)
    writing.Writing(theirs, path, path).write()
    seed(saver, 7)
    saver.save()
    qtbot.waitUntil(lambda: bool(saver.told))
    (changed,) = saver.told
    assert changed.theirs.settings.seed == 99
    assert on_disk(saver) == 99 and saver.document.dirty
    left = read_journal(saver.document.journal_place, path)
    assert left.project.settings.seed == 7 and left.behind, (
        "a crash now loses nothing, though the file is another one"
    )
    saver.save(anyway=True)
    qtbot.waitUntil(lambda: not saver.document.dirty)
    assert on_disk(saver) == 7


def test_a_file_that_already_holds_what_is_saved_is_no_conflict(saver, qtbot):
    path = saver.document.path
    seed(saver, 7)
    writing.Writing(saver.document.project, path, path).write()
    saver.save()
    qtbot.waitUntil(lambda: not saver.document.dirty)
    assert not saver.told


def test_a_file_that_cannot_be_read_any_more_says_why(saver, qtbot):
    saver.document.path.write_text("a: [\n")
    seed(saver, 7)
    saver.save()
    qtbot.waitUntil(lambda: bool(saver.told))
    assert saver.told[0].theirs is None and "YAML" in saver.told[0].why


def test_a_file_that_was_removed_is_written_again(saver, qtbot):
    saver.document.path.unlink()
    seed(saver, 7)
    saver.save()
    qtbot.waitUntil(lambda: not saver.document.dirty)
    assert on_disk(saver) == 7


def test_reloading_is_a_step_that_can_be_undone(saver, toy):
    document = saver.document
    seed(saver, 7)
    theirs = edits.set_settings(document.project, seed=99)
    other = writing.Writing(theirs, document.path, document.path)
    other.write()
    document.reload(theirs, other.digest)
    assert not document.dirty and document.project.settings.seed == 99
    document.undo()
    assert document.dirty and document.project.settings.seed == 7
    left = read_journal(document.journal_place, document.path)
    assert left.project.settings.seed == 7 and not left.behind
