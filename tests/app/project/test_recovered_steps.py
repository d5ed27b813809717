"""Undo history after a crash: random sittings, killed and recovered, undone to what was saved and redone to
what was there.
"""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from app.project.document import Document, ProjectPast
from app.project.opening import load_recovered
from metagraph.formats.project.data import to_data
from metagraph.formats.recovery import read_journal
from metagraph.formats.store import read_project, save_project
from metagraph.graph.model import Project
from tests.projects import histories

MADE: list[Document] = []


@contextmanager
def closing() -> Iterator[None]:
    """Close the journals of the documents that were made meanwhile."""
    try:
        yield
    finally:
        while MADE:
            MADE.pop().close_journal()


@pytest.fixture(autouse=True)
def closed() -> Iterator[None]:
    with closing():
        yield


def new_document() -> Document:
    MADE.append(Document())
    return MADE[-1]


def crashed(document: Document, at: Path) -> Path:
    """Leave a copy of the journal, as a killed program does."""
    kept = at.with_name("left.journal")
    shutil.copy(document.journal_place, kept)
    document.close_journal()
    return kept


def recovered(journal: Path, saved: Path | None) -> tuple[Document, int]:
    """Open what a crash left as the window does; return it and how many steps there are."""
    left = read_journal(journal, saved)
    assert left is not None
    opened, steps = load_recovered(left, journal.parent)
    document = new_document()
    common = read_project(saved) if saved is not None else None
    document.load(
        opened.project, saved, ProjectPast((), steps, left.unsaved if steps else left.edits, common)
    )
    return document, len(steps)


def undo_all(document: Document) -> int:
    count = 0
    while document.undo_stack.canUndo():
        document.undo()
        count += 1
    return count


MOVES = st.lists(st.sampled_from(["edit", "edit", "edit", "merge", "undo", "redo", "save"]), max_size=14)


@pytest.mark.nightly
@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(histories(8), MOVES, st.booleans())
def test_undo_leads_back_to_what_was_saved_and_redo_to_what_was_there(
    qapp: Any, states: list[Project], moves: list[str], twice: bool
) -> None:
    with TemporaryDirectory() as folder, closing():
        path = Path(folder) / "p.metagraph.yaml"
        document = new_document()
        document.load(save_project(states[0], path), path)
        saved, rest = states[0], list(states[1:])
        for n, move in enumerate(moves):
            if move in ("edit", "merge") and rest:
                after = rest.pop(0)
                document.edit(f"edit {n}", lambda _, a=after: a, "drag" if move == "merge" else None)
            elif move == "undo":
                document.undo()
            elif move == "redo":
                document.redo()
            elif move == "save":
                document.save()
                saved = document.project
        end = document.project
        if not document.journal_place.exists():
            return
        journal = crashed(document, path)
        if read_journal(journal, path) is None:
            return
        again, count = recovered(journal, path)
        if twice:  # and once more, without an edit between
            again, count = recovered(crashed(again, path), path)
        assert to_data(again.project) == to_data(end)
        # Edits that lead back to what was saved, by other steps than undo, may count as unsaved.
        assert again.dirty or not count or to_data(end) == to_data(saved)
        assert undo_all(again) == count
        if count:
            assert to_data(again.project) == to_data(saved) and not again.dirty
        while again.undo_stack.canRedo():
            again.redo()
        assert to_data(again.project) == to_data(end)


@pytest.fixture
def sitting(qapp: Any, toy: Any, tmp_path: Path) -> tuple[Document, Path]:
    path = tmp_path / "p.metagraph.yaml"
    document = new_document()
    document.load(save_project(toy.project(), path), path)
    return document, path


def test_a_drag_is_one_step_and_its_words_are_kept(sitting: tuple[Document, Path], toy: Any) -> None:
    from metagraph.graph import edits

    document, path = sitting
    beat = toy.id(document.project, "rest beat lf")
    for value in (1.5, 2.0, 2.5):
        document.edit(
            "Set likelihood",
            lambda p, v=value: edits.update_actions(p, (beat,), likelihood=v),
            "likelihood",
        )
    document.edit("Rename the project", lambda p: edits.rename_project(p, "mine"))
    again, count = recovered(crashed(document, path), path)
    assert count == 2 and again.undo_stack.undoText() == "Rename the project"
    again.undo()
    assert again.undo_stack.undoText() == "Likelihood 1 → 2.5, rest beat lf"
    assert again.project.action(beat).likelihood == 2.5
    again.undo()
    assert again.project.action(beat).likelihood == 1.0 and not again.dirty


def test_an_edit_after_the_recovery_is_a_step_on_top(sitting: tuple[Document, Path]) -> None:
    from metagraph.graph import edits

    document, path = sitting
    document.edit("Rename", lambda p: edits.rename_project(p, "one"))
    again, _ = recovered(crashed(document, path), path)
    again.edit("Rename", lambda p: edits.rename_project(p, "two"))
    third, count = recovered(crashed(again, path), path)
    assert count == 2
    names = [third.project.name]
    while third.undo_stack.canUndo():
        third.undo()
        names.append(third.project.name)
    assert names[:2] == ["two", "one"] and len(names) == 3


def test_what_was_never_saved_is_undone_to_nothing(qapp: Any, tmp_path: Path) -> None:
    from metagraph.graph import edits

    document = new_document()
    document.load(Project(), None)
    document.edit("Rename", lambda p: edits.rename_project(p, "one"))
    document.edit("Rename", lambda p: edits.rename_project(p, "two"))
    again, count = recovered(crashed(document, tmp_path / "x"), None)
    assert count == 2 and again.dirty
    assert undo_all(again) == 2 and again.project == Project()


def test_steps_are_kept_when_another_program_writes_the_file(sitting: tuple[Document, Path]) -> None:
    from metagraph.graph import edits

    document, path = sitting
    document.edit("Rename", lambda p: edits.rename_project(p, "one"))
    document.edit("Rename", lambda p: edits.rename_project(p, "two"))
    save_project(edits.rename_project(document.project, "theirs"), path)
    document.keep_all()
    again, count = recovered(crashed(document, path), path)
    assert count == 2 and again.project.name == "two" and again.dirty
    again.undo()
    assert again.project.name == "one"


def test_the_views_follow_a_recovery_once(sitting: tuple[Document, Path]) -> None:
    from metagraph.graph import edits

    document, path = sitting
    for n in range(5):
        document.edit("Rename", lambda p, n=n: edits.rename_project(p, f"name {n}"))
    journal = crashed(document, path)
    left = read_journal(journal, path)
    assert left is not None
    opened, steps = load_recovered(left, path.parent)
    again, seen = new_document(), []
    again.changed.connect(lambda before, after: seen.append(after))
    again.load(opened.project, path, ProjectPast(steps=steps))
    assert seen == [opened.project] and again.undo_stack.count() == 5
