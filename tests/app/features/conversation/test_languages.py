"""The language of a conversation: found, chosen, remembered and undone, with its lists, of both or of each."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from app.features.conversation.conversation_dialog import ImportDialog
from app.features.conversation.word_lists import WordsDialog, name_language
from metagraph.graph.conversation.model import get_word_lists
from metagraph.speech.language_packs import list_language_packs
from tests.speech import talk as maker
from tests.speech.dialogues import TALKS, spoken

pytestmark = pytest.mark.window
DE, EN = list_language_packs()["de"], list_language_packs()["en"]


def write(folder: Path, text: str, voice: str) -> tuple[Path, Path]:
    samples, of = spoken(text, voice)
    maker.write_sound(folder / "talk.wav", samples, maker.RATE)
    rows = [
        {"word": w.text, "start": w.start, "end": w.end, "speaker": "AB"[side]}
        for side in (0, 1)
        for w in of.words[side]
    ]
    (folder / "talk.json").write_text(json.dumps({"words": sorted(rows, key=lambda r: float(r["start"]))}))
    return folder / "talk.wav", folder / "talk.json"


def imported(drive: Any, files: tuple[Path, Path]) -> ImportDialog:
    assert drive.drop_files((drive.window.statusBar(), QPoint(200, 8)), *files)
    (dialog,) = [d for d in drive.window.findChildren(ImportDialog) if d.isVisible()]
    wait(drive, dialog)
    return dialog


def wait(drive: Any, dialog: ImportDialog) -> None:
    drive.wait(lambda: not dialog.busy, 240)


def choose(box: Any, code: str) -> None:
    box.setCurrentIndex(box.findData(code))
    box.activated.emit(box.currentIndex())


def test_codes_have_names() -> None:
    assert [name_language(c) for c in ("de", "", "sv")] == ["German", "", "'sv'"]
    assert name_language("und") == "language not known"


@pytest.mark.nightly
def test_the_language_is_found_shown_chosen_remembered_and_undone(drive: Any, tmp_path: Path) -> None:
    dialog = imported(drive, write(tmp_path, TALKS["de"], "de"))
    assert dialog.language.currentData() == "auto"
    assert "German" in dialog.cards[0].words.text() and "Both speak German" in dialog.notes.text()
    assert dialog.lists.lists() == (DE.responses, DE.hesitations) and not dialog.others.isVisible()
    answers = dialog.cards[1].segments.text()
    choose(dialog.language, "en")
    wait(drive, dialog)
    assert dialog.lists.lists() == (EN.responses, EN.hesitations)
    assert dialog.cards[1].segments.text() != answers and "look German" in dialog.notes.text()
    choose(dialog.language, "de")
    wait(drive, dialog)
    assert dialog.cards[1].segments.text() == answers and not dialog.notes.isVisible()
    dialog.lists.edits[0].setPlainText("ja")
    wait(drive, dialog)
    assert dialog.lists.lists()[0] == ("ja",) and dialog.cards[1].segments.text() != answers
    choose(dialog.language, "de")  # and back to its lists
    wait(drive, dialog)
    assert dialog.cards[1].segments.text() == answers
    QTest.mouseClick(dialog.go, Qt.MouseButton.LeftButton)
    document = drive.document
    made = next(iter(document.project.conversations.values()))
    assert document.project.language == "de" and [s.language for s in made.sides] == ["de", "de"]
    assert (made.responses, made.hesitations) == (DE.responses, DE.hesitations)
    document.undo_stack.undo()
    assert document.project.language == "auto" and not document.project.conversations
    document.undo_stack.redo()
    again = imported(drive, (tmp_path / "talk.wav", tmp_path / "talk.json"))
    assert again.language.currentData() == "de"
    again.reject()


@pytest.mark.nightly
def test_two_who_speak_different_languages_have_lists_each(drive: Any, tmp_path: Path) -> None:
    german = [x for x in TALKS["de"].strip().splitlines() if x[0] == "A"]
    english = ["B" + x[1:] for x in TALKS["en"].strip().splitlines() if x[0] == "A"]
    both = "\n".join(x for pair in zip(german, english, strict=False) for x in pair)
    dialog = imported(drive, write(tmp_path, both, "de"))
    assert dialog.others.isVisible() and "German" in dialog.whose[0].text()
    assert dialog.others.lists() == (EN.responses, EN.hesitations)
    dialog.move_earlier(1)
    assert dialog.lists.lists() == (EN.responses, EN.hesitations) and "German" in dialog.whose[1].text()
    dialog.move_earlier(1)
    dialog.others.edits[0].setPlainText("yeah")
    wait(drive, dialog)
    assert dialog.others.lists()[0] == ("yeah",) and dialog.lists.lists()[0] == DE.responses
    QTest.mouseClick(dialog.go, Qt.MouseButton.LeftButton)
    ident, made = next(iter(drive.document.project.conversations.items()))
    assert [get_word_lists(made, n)[0] for n in (0, 1)] == [DE.responses, ("yeah",)]
    drive.session.onstage.set_conversation(ident)
    drive.actions.refresh()
    drive.actions["word_lists"].trigger()
    words = drive.window.findChild(WordsDialog)
    assert words.apart.isChecked() and words.rows[1][0].isVisible()
    assert [box.currentData() for _, box, _ in words.rows] == ["de", "en"]
    words.apart.setChecked(False)
    choose(words.rows[0][1], "fr")
    assert words.lists.lists()[0] == list_language_packs()["fr"].responses
    choose(words.rows[0][1], "auto")  # of both together: the more is said in
    assert words.rows[0][1].currentData() in ("de", "en")
    choose(words.rows[0][1], "de")
    QTest.mouseClick(words.go, Qt.MouseButton.LeftButton)
    after = drive.document.project.conversations[ident]
    assert [get_word_lists(after, n)[0] for n in (0, 1)] == [DE.responses] * 2
    assert [s.language for s in after.sides] == ["de", "de"] and after.sides[1].responses is None
