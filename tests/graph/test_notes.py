"""Notes: written, kept in the file, gone with their actions."""

from __future__ import annotations

import pytest

from metagraph.formats.project.data import from_data, to_data
from metagraph.formats.project.journal import find_changes
from metagraph.formats.project.text import to_text
from metagraph.formats.store import parse_project
from metagraph.graph import edits
from metagraph.graph.editing.differences import describe_differences
from metagraph.graph.model import Project
from metagraph.graph.notes import PROJECT, set_note

TEXTS = ["x", "two\nlines: with 'signs' # and more", "- a\n- b\n", "ä – 頷く", "  led by blanks", "null", "1"]


@pytest.mark.parametrize("text", TEXTS)
def test_a_note_comes_back_from_the_file_as_it_was_written(toy, tmp_path, text):
    project = toy.project()
    action = next(iter(project.actions()))
    noted = set_note(set_note(project, action.id, text), PROJECT, text)
    assert parse_project(to_text(to_data(noted)), tmp_path / "a.metagraph.yaml").notes == noted.notes
    assert noted.notes == {action.id: text.rstrip(), PROJECT: text.rstrip()}
    assert find_changes(project, noted) == {"notes": dict(noted.notes)}
    assert any("Notes" in line for line in describe_differences(project, noted))


def test_an_empty_note_is_none_and_changes_nothing(toy):
    project = toy.project()
    assert set_note(project, PROJECT, " \n ") is project
    assert set_note(set_note(project, PROJECT, "x"), PROJECT, "") == project
    assert "notes" not in to_data(project), "files without notes are as they were"
    assert from_data(to_data(Project())).notes == {}


def test_notes_of_actions_that_are_gone_go_with_the_next(toy):
    project = toy.project()
    action = next(a for a in project.actions() if a.kind == "gesture")
    project = edits.remove_actions(set_note(project, action.id, "x"), [action.id])
    assert set_note(project, PROJECT, "y").notes == {PROJECT: "y"}
