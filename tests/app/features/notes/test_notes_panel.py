"""Notes as they are typed, undone and shown."""

from __future__ import annotations

import pytest
from PySide6.QtTest import QTest

from app.features.graph.graph_words import describe_graph_hit
from metagraph.graph import edits
from metagraph.graph.notes import PROJECT

pytestmark = [pytest.mark.window, pytest.mark.gl]


@pytest.mark.nightly
def test_a_note_is_written_on_what_is_selected_and_is_one_step(toys):
    drive = toys
    drive.workspaces.choose("graph")
    panel = drive.shell.panel("notes")
    gesture, other = [a for a in drive.document.project.actions() if a.kind == "gesture"][:2]
    drive.session.selection.select_actions((gesture.id,))
    drive.do("note")
    drive.wait(panel.text.hasFocus)
    QTest.keyClicks(panel.text, "too fast 1 2")
    assert drive.document.project.notes == {gesture.id: "too fast 1 2"}, "numbers are typed, not obeyed"
    drive.session.selection.select_actions((other.id,))
    assert panel.text.toPlainText() == ""
    QTest.keyClicks(panel.text, "fine")
    drive.session.selection.clear()
    assert panel.about == PROJECT and panel.title.words == "On the project"
    QTest.keyClicks(panel.text, "for the fair")
    assert drive.document.project.notes == {
        gesture.id: "too fast 1 2",
        other.id: "fine",
        PROJECT: "for the fair",
    }
    for left in (2, 1, 0):
        drive.document.undo()
        assert len(drive.document.project.notes) == left
    drive.document.redo()
    drive.session.selection.select_actions((gesture.id,))
    assert panel.text.toPlainText() == "too fast 1 2"
    layout = drive.canvas.layout_now()
    hit = layout.hit(layout.row(gesture.id).rect.center())
    assert "too fast" in describe_graph_hit(drive.document.project, layout, hit, None, {})
    drive.docks["notes"].close()


def test_a_note_on_an_action_that_is_removed_is_not_written_to(toys):
    drive = toys
    panel = drive.shell.panel("notes")
    gesture = next(a for a in drive.document.project.actions() if a.kind == "gesture")
    drive.session.selection.select_actions((gesture.id,))
    panel.text.setPlainText("gone soon")
    drive.document.edit("Remove", lambda p: edits.remove_actions(p, [gesture.id]))
    assert panel.about == PROJECT
    panel.text.setPlainText("still here")
    assert drive.document.project.notes == {PROJECT: "still here"}
