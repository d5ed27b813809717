"""Lines from sound files and lists: each with what lies beside it, one bad file spoiling no other; and the
panel that holds them.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import soundfile
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QLineEdit

from app.features.lines.line_files import add_lines, read_lines
from metagraph.graph import requests as a
from metagraph.graph.model import Project


def sound(path: Path, seconds: float = 0.6) -> Path:
    soundfile.write(path, 0.4 * np.sin(np.arange(round(16000 * seconds)) * 0.2), 16000)
    return path


def test_a_sound_becomes_a_line_with_the_text_beside_it(tmp_path):
    one = sound(tmp_path / "good_morning.wav")
    (tmp_path / "good_morning.txt").write_text("Good morning,\n  all.")
    read = read_lines([one, sound(tmp_path / "no_text.flac")], tmp_path)
    assert read.lines["good_morning"] == a.Line(text="Good morning, all.", audio="good_morning.wav")
    assert read.lines["no_text"].text == "no text"
    assert read.voices["good_morning"].duration == pytest.approx(0.6, abs=0.01) and not read.notes


def test_one_bad_file_spoils_no_other_and_says_what_is_wrong(tmp_path):
    bad = tmp_path / "bad.wav"
    bad.write_bytes(b"no sound")
    read = read_lines(
        [bad, tmp_path / "gone.wav", tmp_path / "x.exe", sound(tmp_path / "fine.wav")], tmp_path
    )
    assert list(read.voices) == ["fine"]
    assert any("bad.wav" in n for n in read.notes) and any("x.exe" in n for n in read.notes)


@pytest.mark.parametrize(
    ("text", "ids"),
    [
        ("id,text\n279,Hello\n280,\"Yes, well\"\n", ["279", "280"]),
        ("279\tHello\n280\tYes, well\n", ["279", "280"]),
        ("279;Hallo, du;\n\n280;Ja;\n", ["279", "280"]),
        ("\ufeff1,Größe\n", ["1"]),
        ("1,a\n1,b\n", ["1", "1 2"]),
        ("", []),
    ],
)  # fmt: skip
def test_a_list_is_read_whatever_is_between_its_columns(tmp_path, text, ids):
    path = tmp_path / "lines.csv"
    path.write_bytes(text.encode())
    read = read_lines([path], tmp_path)
    assert list(read.lines) == ids and not read.notes
    if len(ids) > 1 and ids[1] == "280":
        assert read.lines["280"].text in ("Yes, well", "Ja")


@pytest.mark.parametrize(
    ("text", "wrong"), [("279\n", "row 1"), ("a,b\n,c\n", "row 2"), ("1,a,gone.wav\n", "gone.wav")]
)
def test_a_list_that_is_none_says_where(tmp_path, text, wrong):
    path = tmp_path / "lines.csv"
    path.write_text(text)
    read = read_lines([path], tmp_path)
    assert not read.lines and wrong in read.notes[0] and "lines.csv" in read.notes[0]


def test_a_list_names_sounds_beside_it(tmp_path):
    sound(tmp_path / "hi.wav")
    (tmp_path / "lines.csv").write_text("1,Hi there,hi.wav\n")
    read = read_lines([tmp_path / "lines.csv"], tmp_path)
    assert read.lines["1"] == a.Line(text="Hi there", audio="hi.wav") and "1" in read.voices


def test_a_line_read_again_keeps_what_is_asked_with_it():
    from app.features.lines.line_files import Lines

    before = Project(lines={"1": a.Line(text="old", asks=(a.Nod(at=0.1),))})
    after = add_lines(before, Lines({"1": a.Line(text="new"), "2": a.Line(text="more")}, {}))
    assert after.lines["1"] == a.Line(text="new", asks=(a.Nod(at=0.1),)) and list(after.lines) == ["1", "2"]


# --- the panel


@pytest.mark.nightly
def test_sounds_dropped_on_the_panel_can_be_edited_said_and_removed(drive, toy, tmp_path):
    drive.document.load(toy.project(), None)
    drive.show("lines")
    panel = drive.lines
    drive.wait(panel.empty.isVisible)
    assert drive.drop_files(
        (panel, panel.rect().center()), sound(tmp_path / "one.wav"), sound(tmp_path / "two.wav", 1.2)
    )
    drive.wait(lambda: panel.table.rowCount() == 2)
    assert [panel.table.item(n, 3).text() for n in range(2)] == ["0.6 s", "1.2 s"]
    assert drive.document.undo_stack.undoText() == "Add 2 lines"
    # The words are typed in place.
    panel.table.setCurrentCell(1, 1)
    panel.table.editItem(panel.table.item(1, 1))
    editor = panel.table.findChild(QLineEdit)
    editor.selectAll()
    QTest.keyClicks(editor, "Second words")
    QTest.keyClick(editor, Qt.Key.Key_Return)
    drive.wait(lambda: drive.document.project.lines["two"].text == "Second words")
    # An id that is taken is refused in words, another is taken over.
    panel.table.item(1, 0).setText("one")
    assert list(drive.document.project.lines) == ["one", "two"] and panel.table.item(1, 0).text() == "two"
    panel.table.item(1, 0).setText("279")
    assert list(drive.document.project.lines) == ["one", "279"] and "279" in drive.document.project.voices
    # Said now: the character speaks it.
    drive.session.transport.set_playing(False)
    drive.session.transport.seek(1.0)
    panel.table.selectRow(1)
    panel.say()
    drive.wait(lambda: bool(drive.performance.shown.plan.track.speeches))
    speech = drive.performance.shown.plan.track.speeches[0]
    assert speech.line == "279" and speech.end - speech.start == pytest.approx(1.2, abs=0.01)
    panel.search.setText("second")
    assert [panel.table.isRowHidden(n) for n in range(2)] == [True, False]
    panel.search.clear()
    panel.table.selectRow(0)
    panel.table.setFocus()
    QTest.keyClick(panel.table, Qt.Key.Key_Delete)
    assert list(drive.document.project.lines) == ["279"]
    drive.document.undo()
    assert list(drive.document.project.lines) == ["one", "279"]


def test_what_was_looked_for_in_one_project_hides_no_lines_of_the_next(drive, toy):
    drive.document.load(toy.project(), None)
    drive.show("lines")
    drive.lines.search.setText("hello")
    drive.document.load(toy.project(), None)
    assert drive.lines.search.text() == ""


def test_words_without_sound_are_a_line_too(drive, toy):
    drive.document.load(toy.project(), None)
    drive.show("lines")
    drive.lines.add_words()
    assert drive.document.project.lines["1"].text == "Hello"
    drive.wait(lambda: drive.lines.table.findChild(QLineEdit) is not None)


def test_an_edit_of_one_line_among_many_writes_one_row_and_keeps_the_selection(drive, toy, monkeypatch):
    from metagraph.graph.editing import performances as performance_edits

    def many(project: Project) -> Project:
        for n in range(40):
            project = performance_edits.set_line(project, f"l{n}", a.Line(text=f"line {n}"))
        return project

    drive.document.load(toy.project(), None)
    drive.show("lines")
    panel = drive.lines
    assert not panel.say_button.isEnabled()
    drive.document.edit("Add lines", many)
    panel.table.setFocus()
    panel.table.selectAll()
    assert panel.say_button.isEnabled()
    written: list[int] = []
    row = panel._row
    monkeypatch.setattr(panel, "_row", lambda n, *more: (written.append(n), row(n, *more)))
    drive.document.edit("Change line", lambda p: performance_edits.set_line(p, "l5", a.Line(text="another")))
    assert written == [5] and panel.table.item(5, 1).text() == "another"
    assert len(panel.chosen()) == 40
    # What is added while a search hides everything is seen.
    panel.search.setText("another")
    panel.add_words()
    assert not panel.table.isRowHidden(40)


@pytest.mark.nightly
def test_a_line_that_is_removed_while_it_is_asked_for_says_so_and_comes_back_with_undo(drive, toy):
    from metagraph.graph.editing import performances as performance_edits

    drive.document.load(performance_edits.set_line(toy.project(), "hi", a.Line(text="Hello there")), None)
    drive.performance.requests.ask(a.Say(line="hi", at=1.0))
    (ask,) = drive.performance.asks
    drive.wait(
        lambda: ask.id in drive.performance.answers() and drive.performance.answers()[ask.id].at is not None
    )
    drive.document.edit("Remove line", lambda p: performance_edits.set_line(p, "hi", None))
    drive.wait(lambda: drive.performance.answers()[ask.id].state == "refused")
    drive.session.onstage.select_requests((ask.id,))
    assert "hi" in drive.timeline.title.words and "Does not play" in drive.timeline.title.words
    drive.document.undo()
    drive.wait(lambda: drive.performance.answers()[ask.id].at is not None)
    assert "Said from 1.00" in drive.timeline.title.words
