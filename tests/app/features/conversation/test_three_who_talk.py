"""Three who talk, in the window: dropped, chosen, on lanes, and whom they speak to."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from app.features.conversation.conversation_dialog import ImportDialog
from app.features.conversation.conversation_settings import SideRatesDialog
from app.features.conversation.segment_lanes import place_segment_lanes
from app.features.conversation.sides_dialog import SidesDialog
from app.features.conversation.word_lists import WordsDialog
from metagraph.graph.conversation import edits as conversation_edits
from metagraph.graph.conversation.model import EVERYBODY, Conversation, Rates
from tests.app.painted_text import faults
from tests.speech.group import NAMES, group, said, spoken
from tests.speech.talk import write_sound, write_words


def dialog_of(drive: Any, kind: Any) -> Any:
    return next(d for d in drive.window.findChildren(kind) if d.isVisible())


def put_on(drive: Any, made: Conversation) -> str:
    drive.document.edit("Add conversation", lambda p: conversation_edits.add_conversation(p, made)[0])
    ident = list(drive.document.project.conversations)[-1]
    drive.show("conversation")
    drive.session.onstage.set_conversation(ident)
    drive.session.transport.set_playing(False)
    drive.pause(50)
    return str(ident)


def three() -> Conversation:
    return group(3, said(0, 1, 2, "so"), said(1, 2.5, 4, "no"), said(2, 5, 6, "aye"), length=9.0)


def test_three_are_dropped_put_in_order_and_one_left_out(drive: Any, tmp_path: Path) -> None:
    talk, audio, words = spoken(), tmp_path / "a.wav", tmp_path / "a.json"
    write_sound(audio, talk.samples, talk.rate)
    write_words(words, talk)
    assert drive.drop_files((drive.window.statusBar(), QPoint(200, 8)), audio, words)
    dialog = dialog_of(drive, ImportDialog)
    drive.wait(dialog.go.isEnabled, 120)
    assert len(dialog.cards) == 3 and not dialog.swap.isVisible()
    assert all(card.isVisible() and card.taken.isVisible() for card in dialog.cards)
    assert not [fault for fault in faults(dialog) if fault.endswith("is cut")]
    for card, name in zip(dialog.cards, NAMES, strict=False):
        card.name.clear()
        QTest.keyClicks(card.name, name)
    QTest.mouseClick(dialog.cards[2].earlier, Qt.MouseButton.LeftButton)
    assert [card.name.text() for card in dialog.cards] == ["Ann", "Cleo", "Ben"]
    QTest.mouseClick(dialog.cards[0].taken, Qt.MouseButton.LeftButton, pos=QPoint(8, 8))
    assert [s.name for s in dialog.made().sides] == ["Cleo", "Ben"] and dialog.go.isEnabled()
    QTest.mouseClick(dialog.cards[1].taken, Qt.MouseButton.LeftButton, pos=QPoint(8, 8))
    assert not dialog.go.isEnabled(), "one alone is no conversation"
    for card in dialog.cards[:2]:
        QTest.mouseClick(card.taken, Qt.MouseButton.LeftButton, pos=QPoint(8, 8))
    QTest.mouseClick(dialog.go, Qt.MouseButton.LeftButton)
    (made,) = drive.document.project.conversations.values()
    assert [s.name for s in made.sides] == ["Ann", "Cleo", "Ben"]
    assert [s.channel for s in made.sides] == [0, 2, 1]


def test_each_has_a_lane_a_name_and_a_plan_of_its_own(drive: Any) -> None:
    put_on(drive, three())
    view, panel = drive.conversation.view, drive.conversation
    places = place_segment_lanes(view.width(), view.height(), 3)
    assert view.minimumHeight() <= view.height() and places[2].whole.bottom() <= view.height()
    drive.wait(lambda: "Ann, Ben and Cleo" in panel.title.words)
    drive.wait(lambda: not faults(panel))  # once its parts have found their places
    for side in (2, 1, 0):
        drive.click((view, QPoint(30, round(places[side].wave.top()) + 6)))
        assert drive.session.onstage.side == side
        assert drive.timeline.stage.currentText() == f"talk: {NAMES[side]}"
    for side in (1, 2, 0):
        drive.actions["other_side"].trigger()
        assert drive.session.onstage.side == side
    panel.editing.select({(0, 0)})
    for key, side in ((Qt.Key.Key_Down, 1), (Qt.Key.Key_Down, 2), (Qt.Key.Key_Down, 2), (Qt.Key.Key_Up, 1)):
        drive.key(key, widget=view)
        assert panel.editing.last == (side, 0)


def test_whom_a_segment_is_said_to_is_told_chosen_and_undone(drive: Any) -> None:
    ident = put_on(drive, three())
    view, editing = drive.conversation.view, drive.conversation.editing

    def tip() -> str:
        lane = place_segment_lanes(view.width(), view.height(), 3)[0]
        return str(view.tip(QPoint(round(view.scale().x(1.5)), round(lane.segments.center().y())).toPointF()))

    assert tip().endswith("To Ben (detected)"), "he answers"
    editing.select({(0, 0)})
    whom = next(a.menu() for a in view.menu(1.5).actions() if a.text() == "Said to")
    assert [a.text() for a in whom.actions()] == ["Automatic", "Everyone", "Ben", "Cleo"]
    assert [a.isChecked() for a in whom.actions()] == [True, False, False, False]
    whom.actions()[3].trigger()
    assert tip().endswith("To Cleo")
    segment = drive.document.project.conversations[ident].sides[0].segments[0]
    assert segment.to == 2
    next(a.menu() for a in view.menu(1.5).actions() if a.text() == "Said to").actions()[1].trigger()
    assert tip().endswith("To everyone") and editing.segment((0, 0)).to == EVERYBODY
    drive.document.undo_stack.undo()
    assert editing.segment((0, 0)).to == 2


def test_of_two_nobody_asks_whom_they_speak_to(drive: Any) -> None:
    put_on(drive, group(2, said(0, 1, 2), length=5.0))
    drive.conversation.editing.select({(0, 0)})
    assert all(a.text() != "Said to" for a in drive.conversation.view.menu(1.5).actions())


def test_names_rates_places_and_lists_of_each_are_set(drive: Any) -> None:
    ident = put_on(drive, three())

    def now() -> Conversation:
        return drive.document.project.conversations[ident]  # type: ignore[no-any-return]

    drive.actions["side_sounds"].trigger()
    sides = dialog_of(drive, SidesDialog)
    assert not faults(sides)
    sides.names[2].setText("Cleopatra")
    own, right, nearer = sides.places[2]
    assert not right.isEnabled()
    own.setChecked(True)
    right.setValue(2.0)
    nearer.setValue(-0.5)
    sides.accept()
    assert [(s.name, s.place) for s in now().sides[1:]] == [("Ben", None), ("Cleopatra", (2.0, -0.5))]
    drive.actions["side_sounds"].trigger()
    before = now()
    dialog_of(drive, SidesDialog).accept()
    assert now() is before, "what is not touched stays as it is"
    drive.actions["rates"].trigger()
    rates = dialog_of(drive, SideRatesDialog)
    assert not faults(rates)
    rates.take(2, Rates(clause=0.2))
    rates.accept()
    assert [round(s.rates.clause, 2) for s in now().sides] == [0.75, 0.75, 0.2]
    drive.actions["word_lists"].trigger()
    words = dialog_of(drive, WordsDialog)
    words.apart.setChecked(True)
    assert all(whole.isVisible() for whole, _, _ in words.rows) and len(words.rows) == 3
    assert not faults(words)
    words.rows[2][2].edits[0].setPlainText("aye")
    words.accept()
    assert now().sides[2].segments[0].kind == "response" and now().sides[0].segments[0].kind == "clause"
