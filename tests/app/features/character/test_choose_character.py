"""Choosing a character: its file is read beside the window, and what comes too late is dropped."""

from __future__ import annotations

import threading
from dataclasses import replace
from types import SimpleNamespace

import pytest

from app.features.character.character_choice import take_character
from app.project.document import Document
from app.project.jobs import Jobs
from metagraph.formats import characters
from metagraph.formats.characters import CharacterFile
from metagraph.graph.model import Project


@pytest.fixture
def shell(qapp, toy, tmp_path):
    """What choosing a character needs of a window."""
    document, jobs, told = Document(), Jobs(), []
    document.load(toy.project(), None)
    file = tmp_path / "somebody.glb"
    yield SimpleNamespace(document=document, jobs=jobs, widget=None, tell=told.append, told=told, file=file)
    jobs.stop()
    document.close_journal()


def test_a_characters_morph_targets_are_read_beside_the_window(shell, qtbot, monkeypatch):
    threads = []

    def read(path, folder, skeleton):
        threads.append(threading.current_thread())
        return CharacterFile(path, ("jawOpen",))

    monkeypatch.setattr(characters, "look_at", read)
    take_character(shell, shell.file)
    qtbot.waitUntil(lambda: shell.document.project.character is not None)
    assert shell.document.project.character.endswith("somebody.glb")
    assert threads[0] is not threading.main_thread()
    assert shell.document.undo_stack.undoText() == "Choose character"


def test_a_file_that_is_no_character_is_told_and_none_is_chosen(shell, qtbot):
    take_character(shell, shell.file)
    qtbot.waitUntil(lambda: bool(shell.told))
    assert "somebody.glb" in shell.told[0]
    assert shell.document.project.character is None


def test_a_stand_in_is_told_and_not_chosen(shell, qtbot, monkeypatch):
    found = CharacterFile("x", why_not="is 1 triangle, a stand-in")
    monkeypatch.setattr(characters, "look_at", lambda *_: found)
    take_character(shell, shell.file)
    qtbot.waitUntil(lambda: bool(shell.told))
    (words,) = shell.told
    assert "somebody.glb" in words and found.why_not in words
    assert shell.document.project.character is None


def test_what_the_hands_cannot_all_hold_is_hidden_with_the_choice_in_one_step(shell, qtbot, monkeypatch):
    found = CharacterFile("x", hidden=("sword", "bow"))
    monkeypatch.setattr(characters, "look_at", lambda path, *_: replace(found, path=path))
    take_character(shell, shell.file)
    qtbot.waitUntil(lambda: bool(shell.told))
    assert "(sword, bow)" in shell.told[0]
    assert shell.document.project.hidden == ("sword", "bow")
    shell.document.undo()
    assert shell.document.project.hidden == () and shell.document.project.character is None


def test_a_character_chosen_for_a_project_that_was_left_is_dropped(shell, qtbot, monkeypatch, tmp_path):
    monkeypatch.setattr(characters, "look_at", lambda path, *_: CharacterFile(path))
    take_character(shell, shell.file)
    shell.document.load(Project(), tmp_path / "other.metagraph.yaml")
    qtbot.waitUntil(lambda: not shell.jobs.running)
    assert shell.document.project.character is None
