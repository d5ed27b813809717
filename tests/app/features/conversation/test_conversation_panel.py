"""Which conversation is on stage, what the panel says, and how its sounds are read."""

from __future__ import annotations

from typing import Any

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from app.features.conversation.segment_view import SegmentView
from metagraph.graph.conversation import edits as conversation_edits
from metagraph.graph.editing import performances as performance_edits
from metagraph.graph.requests import Performance
from tests.app.painted_text import painted, texts

pytestmark = [pytest.mark.window, pytest.mark.gl]


def test_a_conversation_and_a_kept_performance_are_never_on_stage_together(talk: Any) -> None:
    drive, session = talk.drive, talk.drive.session
    ident = session.onstage.conversation
    drive.document.edit("Keep", lambda p: performance_edits.add_performance(p, Performance(name="One"))[0])
    session.onstage.set_performance(next(iter(drive.document.project.performances)))
    assert session.onstage.conversation is None
    session.onstage.set_conversation(ident)
    assert session.onstage.performance is None
    drive.document.edit("Remove", lambda p: conversation_edits.remove_conversation(p, ident))
    assert session.onstage.conversation is None


def test_the_chooser_follows_names_and_an_empty_panel_says_what_to_drop(talk: Any) -> None:
    panel, ident = talk.drive.conversation, talk.drive.session.onstage.conversation
    talk.drive.document.edit(
        "Rename", lambda p: conversation_edits.change_conversation(p, ident, name="Station")
    )
    assert panel.stage.currentText() == "Station"
    talk.drive.wait(lambda: "clause" in panel.legend.text())
    panel.stage.setCurrentIndex(0)
    panel.stage.activated.emit(0)
    assert talk.drive.session.onstage.conversation is None
    talk.drive.document.edit("Remove", lambda p: conversation_edits.remove_conversation(p, ident))
    image = panel.view.grab().toImage()
    colours = {
        image.pixelColor(x, image.height() // 2 - 45).name()
        for x in range(image.width() // 2 - 70, image.width() // 2 + 70)
    }
    assert len(colours) > 2, "a picture of two who talk"


def test_selected_segments_stay_selected_while_they_are_there(talk: Any) -> None:
    talk.editing.select({(0, 2)})
    ident = talk.drive.session.onstage.conversation
    begins = talk.segments()[2].start
    talk.drive.document.edit("Merge", lambda p: conversation_edits.merge_segments(p, ident, 0, 0, 1))
    assert [talk.editing.segment(p).start for p in talk.editing.chosen] == [begins]
    talk.drive.document.undo()
    assert [talk.editing.segment(p).start for p in talk.editing.chosen] == [begins]
    talk.drive.document.edit("Remove", lambda p: conversation_edits.remove_segments(p, ident, {(0, 2)}))
    assert not talk.editing.chosen


@pytest.mark.nightly
def test_reading_that_was_cancelled_is_told_and_begun_anew_when_it_is_chosen_again(talk: Any) -> None:
    drive, sounds = talk.drive, talk.drive.conversation.sounds
    assert all(h.told for h in sounds.heard.values())
    QTest.mouseClick(drive.window.job_line.cancel, Qt.MouseButton.LeftButton)
    drive.wait(lambda: not drive.jobs.running, 60)
    drive.wait(lambda: all(h.missing or not h.told for h in sounds.heard.values()))
    ident = drive.session.onstage.conversation
    drive.session.onstage.set_conversation(None)
    drive.session.onstage.set_conversation(ident)
    talk.read()
    assert not any(h.missing for h in sounds.heard.values())


def test_while_a_machine_is_drawn_the_panel_says_that_it_moves_the_character(talk: Any) -> None:
    panel, drive = talk.drive.conversation, talk.drive
    drive.actions["manual"].trigger()
    drive.wait(lambda: "The manual state machine" in panel.title.words)
    drive.actions["manual"].trigger()
    drive.wait(lambda: "The manual state machine" not in panel.title.words)


def test_sound_dropped_on_the_panel_opens_the_dialog(talk: Any) -> None:
    from app.features.conversation.conversation_dialog import ImportDialog

    panel = talk.drive.conversation
    assert talk.drive.drop_files((panel, QPoint(300, 100)), talk.audio)
    dialog = talk.drive.window.findChild(ImportDialog)
    assert dialog.isVisible()
    assert not talk.drive.drop_files((panel, QPoint(300, 100)), talk.words), "words without sound are nothing"
    dialog.reject()


def test_a_click_on_a_name_shows_that_ones_plan_and_marks_it_and_leaves_the_rest_as_it_is(talk: Any) -> None:
    from app.features.conversation.segment_lanes import place_segment_lanes

    drive, view = talk.drive, talk.view
    talk.editing.select({(0, 2)})
    view.zoom(0.5, 300)
    view.look_at(3.0)

    def mark(side: int) -> str:
        lane = place_segment_lanes(view.width(), view.height())[side]
        return view.grab().toImage().pixelColor(4, round(lane.wave.center().y())).name()

    marked, plain = mark(0), mark(1)
    assert marked != plain
    name = QPoint(30, round(place_segment_lanes(view.width(), view.height())[1].wave.top()) + 10)
    assert "Click to see" in view.tip(name.toPointF())
    drive.click((view, name))
    assert drive.session.onstage.side == 1
    assert drive.timeline.stage.currentText() == "talk: Ben"
    QTest.mouseMove(view, QPoint(300, 3))
    assert (mark(0), mark(1)) == (plain, marked)
    assert talk.editing.chosen == {(0, 2)}
    assert (view.first, view.each) == (3.0, 50.0)
    assert "The Performance panel shows" in view.tip(name.toPointF())


def test_a_playhead_that_is_moved_out_of_sight_is_followed_and_one_in_sight_is_not(talk: Any) -> None:
    view, session = talk.view, talk.drive.session
    session.transport.seek(29.0)
    far = view.first
    assert view.scale().x(29.0) < view.width()
    session.transport.seek(0.0)
    assert view.first == 0.0 < far
    session.transport.seek(view.scale().seconds(view.width() - 5))
    assert view.first == 0.0


def test_the_first_conversation_plays_by_a_click_on_the_empty_stage_and_nothing_is_selected(
    talk: Any,
) -> None:
    drive = talk.drive
    panel, onstage = drive.conversation, drive.session.onstage
    onstage.set_conversation(None)
    drive.wait(panel.play.isVisible)
    name = next(iter(drive.document.project.conversations.values())).name
    assert panel.play.text() == f"Play '{name}'"
    drive.session.transport.set_playing(False)
    QTest.mouseClick(panel.play, Qt.MouseButton.LeftButton)
    drive.pause(50)
    assert onstage.conversation == next(iter(drive.document.project.conversations))
    assert drive.session.transport.playing and not panel.play.isVisible()
    assert not panel.editing.chosen, "Delete would remove it"


@pytest.mark.parametrize("width", [360, 700])
def test_what_an_empty_panel_says_is_never_cut(drive: Any, width: int) -> None:
    view = drive.conversation.findChild(SegmentView)
    view.resize(width, 400)
    words = painted(view)
    assert "TextGrid" in " ".join(w.text for w in words)
    assert all(w.rect.left() >= 0 and w.rect.right() <= width and w.rect.bottom() <= 400 for w in words)


def test_who_has_no_sound_beside_one_who_has_listens_and_names_stay_apart(talk: Any) -> None:
    """A monologue is no mistake."""
    ident = talk.drive.session.onstage.conversation
    for side, name in enumerate(("First speaker of all", "First speaker of them")):
        sound: dict[str, Any] = {"audio": None} if side else {}
        talk.drive.document.edit(
            "Change",
            lambda p, s=side, n=name, more=sound: conversation_edits.change_side(p, ident, s, name=n, **more),
        )
    talk.read()
    said = [text.text for text in texts(talk.view)]
    assert any(words.startswith("Listens.") for words in said)
    assert not any("⚠" in words for words in said)
    names = [words for words in said if "…" in words and words.startswith(("First", "…", "F"))][:2]
    assert len(set(names)) == 2
