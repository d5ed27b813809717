"""From dropped sound to segments that are edited, saved, opened again and exported, in the real window."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import soundfile
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QFileDialog

from app.features.conversation.conversation_commands import ask_for_conversation
from app.features.conversation.conversation_dialog import ImportDialog
from app.features.conversation.conversation_settings import SideRatesDialog
from app.features.conversation.sides_dialog import SidesDialog
from app.features.conversation.word_lists import WordsDialog
from metagraph.formats.conversations.files import read_conversation
from tests.speech.talk import make_conversation

pytestmark = [pytest.mark.window, pytest.mark.gl]


def dialog_of(drive: Any) -> ImportDialog:
    found = [d for d in drive.window.findChildren(ImportDialog) if d.isVisible()]
    assert len(found) == 1
    return found[0]


def wait_read(drive: Any, dialog: ImportDialog) -> None:
    drive.wait(lambda: not dialog.busy, 240)


def test_two_who_talk_are_dropped_edited_saved_reopened_and_exported(
    drive: Any, tmp_path: Path, monkeypatch: Any
) -> None:
    audio, words = make_conversation(tmp_path)
    assert drive.drop_files((drive.window.statusBar(), QPoint(200, 8)), audio, words)
    dialog = dialog_of(drive)
    assert not dialog.go.isEnabled()
    wait_read(drive, dialog)
    assert dialog.go.isEnabled(), dialog.notes.text()
    assert "channel 1" in dialog.cards[0].sound.text()
    responses = dialog.cards[1].segments.text()
    dialog.cards[0].name.setFocus()
    QTest.keyClicks(dialog.cards[0].name, "Ann")
    dialog.lists.edits[0].setPlainText("yeah")  # fewer responses, then
    drive.wait(lambda: dialog.job is not None)
    wait_read(drive, dialog)
    assert dialog.cards[1].segments.text() != responses
    assert dialog.cards[0].name.text() == "Ann"
    QTest.mouseClick(dialog.go, Qt.MouseButton.LeftButton)
    document, session = drive.document, drive.session
    assert document.undo_stack.index() == 1
    ident = session.onstage.conversation
    assert ident in document.project.conversations
    assert len(document.project.timelines[ident].cuts) > 1  # it is filmed

    def now() -> Any:
        return document.project.conversations[ident]

    imported = now()
    assert [s.name for s in imported.sides] == ["Ann", ""]
    assert imported.responses == ("yeah",)
    view, editing = drive.conversation.view, drive.conversation.editing
    assert view.isVisible()
    session.transport.set_playing(False)
    drive.pause(100)

    from app.features.conversation.segment_lanes import place_segment_lanes

    def at(seconds: float) -> tuple[Any, QPoint]:
        return view, QPoint(
            round(view.scale().x(seconds)),
            round(place_segment_lanes(view.width(), view.height())[0].segments.center().y()),
        )

    first, second = imported.sides[0].segments[:2]
    drive.drag(at(first.end - 0.015), at(first.end - 0.25), lambda: now() != imported)
    drive.click(at((second.start + second.end) / 2))
    QTest.keyClick(view, Qt.Key.Key_2)
    QTest.keyClick(view, Qt.Key.Key_M)  # with the third
    QTest.keyClick(view, Qt.Key.Key_S)  # at the pointer
    assert document.undo_stack.index() == 5
    edited = now()
    assert edited.sides[0].segments[0].end < first.end
    for _ in range(4):
        drive.actions["undo"].trigger()
    assert now() == imported
    for _ in range(4):
        drive.actions["redo"].trigger()
    assert now() == edited

    place = tmp_path / "saved" / "duet.metagraph.yaml"
    place.parent.mkdir()
    document.save(place)
    kept = now()
    assert kept.sides[0].segments == edited.sides[0].segments
    session.onstage.set_conversation(None)
    drive.files.open(place)
    drive.wait(lambda: not drive.jobs.running)
    assert document.project.conversations[ident] == kept
    drive.conversation.stage.setCurrentIndex(1)
    drive.conversation.stage.activated.emit(1)
    assert session.onstage.conversation == ident
    sounds = drive.conversation.sounds
    drive.wait(lambda: bool(sounds.heard) and not any(h.told for h in sounds.heard.values()), 90)
    assert not any(h.missing for h in sounds.heard.values()), (
        "the sound is found from where the project is now"
    )

    for name in ("duet.eaf", "duet.TextGrid"):
        target = tmp_path / name
        monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_, t=target, **__: (str(t), ""))
        drive.actions["write_segments"].trigger()
        again = read_conversation([audio], [target])
        for side in (0, 1):
            assert [(s.kind, s.text) for s in again.conversation.sides[side].segments] == [
                (s.kind, s.text) for s in kept.sides[side].segments
            ]
            assert [s.start for s in again.conversation.sides[side].segments] == pytest.approx(
                [s.start for s in kept.sides[side].segments], abs=0.002
            )
    drive.actions["remove_conversation"].trigger()
    assert not document.project.conversations
    assert session.onstage.conversation is None
    editing.select({(0, 0)})
    drive.actions["undo"].trigger()
    assert document.project.conversations[ident] == kept


def test_a_failed_read_says_why_and_keeps_the_dialog(drive: Any, tmp_path: Path) -> None:
    loud = np.random.default_rng(1).standard_normal((16000, 9)) * 0.1
    soundfile.write(str(tmp_path / "three.wav"), loud, 16000)
    ask_for_conversation(drive.shell, (tmp_path / "three.wav",))
    dialog = dialog_of(drive)
    wait_read(drive, dialog)
    assert "9 channels" in dialog.notes.text()
    assert not dialog.go.isEnabled()
    assert dialog.isVisible()
    assert dialog.again.isVisible()
    dialog.reject()
    assert not drive.document.project.conversations


@pytest.mark.nightly
def test_many_notes_leave_the_names_as_high_as_they_are(drive: Any, tmp_path: Path) -> None:
    audio, _ = make_conversation(tmp_path)
    words = tmp_path / "over.srt"
    words.write_text(
        "1\n00:00:01,000 --> 00:00:05,000\nhello there you\n\n2\n00:00:03,000 --> 00:00:06,000\nand over it\n"
    )
    ask_for_conversation(drive.shell, (audio, words))
    dialog = dialog_of(drive)
    wait_read(drive, dialog)
    assert dialog.notes.text().count("⚠") >= 4
    drive.pause(50)
    for field in (dialog.name, *(c.name for c in dialog.cards)):
        assert field.height() >= field.sizeHint().height()
    dialog.reject()


@pytest.mark.nightly
def test_reading_can_be_stopped_and_taken_up_again(drive: Any, tmp_path: Path) -> None:
    audio, words = make_conversation(tmp_path)
    ask_for_conversation(drive.shell, (audio,))
    dialog = dialog_of(drive)
    assert dialog.transcripts == (words,), "words that lie beside a sound are found"
    QTest.mouseClick(dialog.stop, Qt.MouseButton.LeftButton)
    assert dialog.told.text() == "Stopped."
    drive.wait(lambda: not drive.jobs.running, 60)
    assert dialog.read is None
    QTest.mouseClick(dialog.no_words, Qt.MouseButton.LeftButton)
    assert not dialog.transcripts
    wait_read(drive, dialog)
    assert "loudness" in dialog.notes.text()
    sounds = [c.sound.text() for c in dialog.cards]
    QTest.mouseClick(dialog.swap, Qt.MouseButton.LeftButton)
    assert [c.sound.text() for c in dialog.cards] == sounds[::-1]
    assert [s.channel for s in dialog.made().sides] == [1, 0]
    dialog.reject()


def test_a_single_sound_of_one_channel_is_a_line_of_dialogue(drive: Any, tmp_path: Path) -> None:
    soundfile.write(str(tmp_path / "hello.wav"), np.sin(np.arange(16000) / 20) * 0.2, 16000)
    assert drive.drop_files((drive.window.statusBar(), QPoint(200, 8)), tmp_path / "hello.wav")
    drive.wait(lambda: "hello" in drive.document.project.lines, 60)
    assert not [d for d in drive.window.findChildren(ImportDialog) if d.isVisible()]


@pytest.mark.nightly
def test_rates_lists_names_and_the_stage(talk: Any) -> None:
    drive = talk.drive
    drive.actions["rates"].trigger()
    dialog = drive.window.findChild(SideRatesDialog)
    assert not dialog.delivered.isVisible()  # nobody moves
    dialog.take(1, type(talk.conversation.sides[1].rates)(clause=0.62, response=0.53, hesitation=0.35))
    QTest.mouseClick(dialog.go, Qt.MouseButton.LeftButton)
    assert talk.conversation.sides[1].rates.clause == 0.62
    assert talk.conversation.sides[0].rates.clause == 0.75
    drive.actions["word_lists"].trigger()
    dialog = drive.window.findChild(WordsDialog)
    dialog.lists.edits[1].setPlainText("uh, uh-huh")
    QTest.mouseClick(dialog.go, Qt.MouseButton.LeftButton)
    assert talk.conversation.hesitations == ("uh", "uh-huh")
    assert [s.kind for s in talk.segments() if s.text == "um"] == ["clause"]
    drive.actions["side_sounds"].trigger()
    dialog = drive.window.findChild(SidesDialog)
    dialog.names[1].setText("Bea")
    QTest.mouseClick(dialog.go, Qt.MouseButton.LeftButton)
    assert talk.conversation.sides[1].name == "Bea"
    assert talk.conversation.sides[1].channel == 1
    assert drive.document.undo_stack.index() == 4
    drive.actions["render"]  # the window's other commands are as they were
    assert not drive.conversation.view.editing.chosen
    drive.session.onstage.set_conversation(None)
    drive.actions.refresh()
    assert not drive.actions["rates"].isEnabled()
