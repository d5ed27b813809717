"""Commands found by typing, and done from there; and the list of their keys."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.features.help.command_finder import CommandFinder, Entry
from metagraph.graph import edits

pytestmark = [pytest.mark.window, pytest.mark.gl]


def opened(drive, command: str) -> CommandFinder:
    drive.do(command)
    dialog = drive.window.findChildren(CommandFinder)[-1]
    drive.wait(dialog.search.hasFocus)
    return dialog


@pytest.mark.nightly
def test_every_command_is_found_by_its_words_in_any_order(toys):
    dialog = opened(toys, "palette")
    every = {e.words for e in dialog.listed()}
    shown = [c for c in toys.actions.commands if c.fill is None and toys.actions[c.id].isVisible()]
    assert {c.plain for c in shown} <= every
    assert {"Problems", "Models"} <= every, "panels are found, too"
    dialog.search.setText("theme  LIGHT")
    assert [e.words for e in dialog.listed()] == ["Light theme"]
    dialog.search.setText("no such thing")
    assert not dialog.listed() and dialog.none.isVisible()
    QTest.keyClick(dialog.search, Qt.Key.Key_Return)
    assert dialog.isVisible(), "there is nothing to do"
    dialog.close()


def test_enter_does_what_is_chosen_and_gives_the_keyboard_back(toys):
    toys.canvas.setFocus()
    toys.wait(toys.canvas.hasFocus)
    dialog = opened(toys, "palette")
    QTest.keyClicks(dialog.search, "layer")
    QTest.keyClick(dialog.search, Qt.Key.Key_Down)
    wanted = dialog.tree.currentItem().text(0)
    QTest.keyClick(dialog.search, Qt.Key.Key_Return)
    toys.wait(lambda: f"{toys.session.place.layer.capitalize()} layer" == wanted)
    toys.wait(toys.canvas.hasFocus)


def test_what_cannot_be_done_now_is_shown_but_not_done(drive):
    dialog = opened(drive, "palette")
    dialog.search.setText("compatibility")
    (found,) = [e for e in dialog.listed() if e.words == "Compatibility"]
    assert not found.enabled
    QTest.keyClick(dialog.search, Qt.Key.Key_Return)
    assert dialog.isVisible()
    dialog.close()


def test_the_shortcuts_stand_in_groups(toys):
    dialog = opened(toys, "keys")
    assert all(e.keys for e in dialog.listed())
    groups = list(dict.fromkeys(e.group for e in dialog.listed()))
    assert groups[:3] == ["File", "Edit", "Graph"] and groups[-1] == "In a conversation"
    dialog.search.setText("ctrl+e")
    assert next(e.words for e in dialog.listed()).startswith("Export")
    dialog.close()


@pytest.mark.parametrize(
    ("typed", "first"),
    [("export", "Export"), ("undo", "Undo"), ("save", "Save"), ("frame", "Frame the character")],
)
def test_the_command_with_just_that_name_is_first(toys, typed, first):
    toys.document.edit("Change seed", lambda p: edits.set_settings(p, seed=p.settings.seed + 1))
    dialog = opened(toys, "palette")
    dialog.search.setText(typed)
    assert dialog.tree.currentItem().text(0).startswith(first)
    assert dialog.listed()[0].words.startswith(first)
    dialog.close()


def test_what_was_done_last_comes_before_equal_matches(qapp):
    made = [Entry("View", words, run=lambda: None) for words in ("light theme", "light room", "lights")]
    assert [e.words for e in made if e.rank("light") == 1] == ["light theme", "light room"]
    dialog = CommandFinder("Commands", made, None, ["light room"])
    dialog.search.setText("light")
    assert [e.words for e in dialog.listed()] == ["light room", "light theme", "lights"]
    dialog.search.setText("lro")
    assert [e.words for e in dialog.listed()] == ["light room"], "letters in order find it, too"
    dialog.deleteLater()


@pytest.mark.nightly
def test_stances_and_actions_are_gone_to_by_their_names(toys):
    toys.do("palette")
    finder = toys.window.findChild(CommandFinder)
    assert not any(e.by_name for e in finder.listed()), "thousands of them would hide the commands"
    finder.search.setText("wave")
    assert [(e.words, e.group) for e in finder.listed() if e.by_name] == [("rest wave rt", "Gesture, Arms")]
    next(e for e in finder.listed() if e.by_name).run()
    assert toys.session.selection.actions == (toys.id("rest wave rt"),)
    finder.search.setText("far")
    QTest.keyClick(finder.search, Qt.Key.Key_Return)
    toys.wait(lambda: toys.session.place.stance() == toys.id("far"))


def test_a_panel_that_a_command_shows_is_listed_once(toys):
    dialog = opened(toys, "palette")
    every = [e.words for e in dialog.listed()]
    assert every.count("History") == every.count("Table") == 1 and "Problems" in every
    dialog.close()
