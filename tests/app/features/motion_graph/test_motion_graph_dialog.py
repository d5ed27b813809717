"""The motion graph's window: takes are chosen, new motion is found and kept, long takes are cut, with real
events.
"""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path

import msgspec
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from app.features.motion_graph.cooccurrence_rates import CooccurrenceDialog
from app.features.motion_graph.motion_graph_dialog import MotionGraphDialog
from app.features.motion_graph.synthesis_jobs import FOLDER, LEAST, MOST
from metagraph.formats.project.paths import make_paths_absolute
from metagraph.formats.store import save_project
from metagraph.graph.conversation.model import Conversation, Rates, Segment, Side
from metagraph.graph.model import Project

ROOT = Path(__file__).parents[4]


@pytest.fixture
def shown(drive, sample, tmp_path):
    """The dialog on a saved project of the sample's stances, with a conversation whose first side has a
    take.
    """
    whole = make_paths_absolute(sample, ROOT / "sample_clips")
    some = {i: e for i, e in whole.clips.items() if "stance" in e.name or "arms_crossed__beat" in e.name}
    project = Project(name="some", clips=some, skeleton=whole.skeleton)
    take = next(e.id for e in project.clips.values() if e.name == "hand_to_chin__stance")
    ada = Side(name="Ada", take=take, segments=(Segment("clause", 1.0, 2.0, 1.5),))
    project = replace(
        project, conversations={"v9000": Conversation(name="talk", length=7.0, sides=(ada, Side(name="Ben")))}
    )
    save_project(project, tmp_path / "copy.metagraph.yaml")
    drive.files.open(tmp_path / "copy.metagraph.yaml")
    drive.wait(lambda: drive.document.folder == tmp_path and drive.document.project.skeleton is not None)
    drive.do("motion_graph")
    dialog = drive.window.findChild(MotionGraphDialog)
    drive.wait(lambda: dialog.limit is not None)
    yield drive, dialog
    dialog.close()


def press(button) -> None:
    QTest.mouseClick(button, Qt.MouseButton.LeftButton, pos=button.rect().center())


def colours(widget) -> int:
    """How many colours a widget shows: one if nothing is painted."""
    image = widget.grab().toImage()
    return len({image.pixel(x, y) for x in range(0, image.width(), 3) for y in range(0, image.height(), 3)})


@pytest.mark.nightly
def test_long_clips_are_chosen_and_what_was_heard_is_shown(shown):
    _, dialog = shown
    names = {dialog.document.project.clips[i].name for i in dialog.picked.chosen()}
    assert "hand_to_chin__stance" in names and not any("beat" in n for n in names)
    row = next(
        r
        for r in range(dialog.picked.list.rowCount())
        if dialog.picked.list.item(r, 0).text() == "hand_to_chin__stance"
    )
    assert dialog.picked.list.item(row, 2).text().startswith("talk: Ada")
    assert "0." in dialog.words.text() and colours(dialog.plot) > 3


@pytest.mark.nightly
def test_k_and_level_move_the_threshold(shown):
    drive, dialog = shown
    before = dialog.limit.limit
    dialog.k.setFocus()
    QTest.keyClick(dialog.k, Qt.Key.Key_Up)
    drive.wait(lambda: dialog.limit.limit > before)
    higher = dialog.limit.limit
    dialog.level.setValue(80)
    drive.wait(lambda: dialog.limit.limit < higher)


@pytest.mark.nightly
def test_a_take_that_is_unchecked_is_left_out(shown):
    drive, dialog = shown
    before = len(dialog.takes.ids)
    cell = dialog.picked.list.visualItemRect(dialog.picked.list.item(0, 0))
    QTest.mouseClick(
        dialog.picked.list.viewport(),
        Qt.MouseButton.LeftButton,
        pos=QPoint(cell.left() + 14, cell.center().y()),
    )
    drive.wait(lambda: len(dialog.takes.ids) == before - 1)


@pytest.mark.nightly
def test_the_table_is_filled(shown):
    drive, dialog = shown
    press(dialog.count_button)
    assert not dialog.count_button.isEnabled() and dialog.stop.isVisible()
    drive.wait(lambda: dialog.table.item(0, 1).text() != "–", 120)
    kept = [int(dialog.table.item(row, 2).text().replace(",", "")) for row in range(3)]
    assert kept[0] < kept[1] < kept[2]
    drive.wait(dialog.count_button.isEnabled)


@pytest.mark.nightly
def test_new_motion_is_found_kept_as_a_file_and_played_and_one_undo_takes_it_back(shown, tmp_path):
    drive, dialog = shown
    count = len(drive.document.project.clips)
    assert dialog.wishes.speech.currentText() == "talk: Ada"
    dialog.wishes.speech.setCurrentIndex(0)
    dialog.wishes.length.setValue(4.0)
    press(dialog.wishes.go)
    drive.wait(lambda: len(drive.document.project.clips) == count + 1, 180)
    assert "cost" in dialog.said.text()
    made = drive.document.project.clips[drive.session.selection.clips[0]]
    assert (tmp_path / made.path).parent.name == FOLDER and (tmp_path / made.path).is_file()
    assert drive.session.transport.show == "clip" and drive.session.transport.shown == made.id
    drive.wait(lambda: drive.performance.shown.clip == made.id)
    drive.document.undo_stack.undo()
    assert len(drive.document.project.clips) == count


@pytest.mark.nightly
def test_new_motion_can_move_the_speaker_of_a_conversation_until_the_graph_does_again(shown):
    drive, dialog = shown
    for box in dialog.wishes.kinds.values():
        box.setChecked(False)
    dialog.wishes.peaks.setChecked(False)
    dialog.wishes.whole.setChecked(True)
    assert not dialog.wishes.start.isEnabled() and not dialog.wishes.length.isEnabled()
    press(dialog.wishes.go)
    drive.wait(lambda: drive.document.project.conversations["v9000"].sides[0].motion is not None, 180)
    made = drive.document.project.clips[drive.document.project.conversations["v9000"].sides[0].motion]
    assert made.duration == pytest.approx(7.0, abs=0.1) and drive.session.onstage.conversation == "v9000"
    drive.wait(lambda: drive.performance.shown.motion == made.id, 60)
    assert made.name in drive.timeline.title.words
    drive.actions["graph_again"].trigger()
    drive.wait(lambda: bool(drive.performance.shown.others) and drive.performance.shown.motion is None, 60)
    drive.document.undo_stack.undo()
    drive.document.undo_stack.undo()
    assert made.id not in drive.document.project.clips
    assert drive.document.project.conversations["v9000"].sides[0].motion is None


@pytest.mark.nightly
def test_a_long_wait_is_explained_and_the_words_give_way_to_what_comes_of_it(shown):
    drive, dialog = shown
    dialog._start("A wait", lambda job: time.sleep(0.4), lambda _: dialog.said.setText("done"))
    dialog._long.start(0)
    drive.wait(lambda: "compiled" in dialog.said.text())
    drive.wait(lambda: dialog.said.text() == "done")
    assert not dialog._long.isActive()


@pytest.mark.nightly
def test_what_no_motion_goes_with_is_given_up_and_that_is_said(shown):
    drive, dialog = shown
    project = drive.document.project
    talk = project.conversations["v9000"]
    never = msgspec.structs.replace(talk.sides[1], segments=(Segment("response", 1.0, 6.0),))
    sides = (talk.sides[0], never)
    drive.document.edit(
        "test", lambda p: replace(p, conversations={"v9000": msgspec.structs.replace(talk, sides=sides)})
    )
    dialog.wishes.speech.setCurrentIndex(2)
    dialog.wishes.length.setValue(6.0)
    drive.wait(lambda: dialog.limit is not None and not dialog.busy)
    count = len(drive.document.project.clips)
    press(dialog.wishes.go)
    drive.wait(lambda: not dialog.busy and bool(dialog.said.text()), 120)
    assert "Dropped: responses" in dialog.said.text() and "response at 1.0 s" in dialog.said.text()
    assert len(drive.document.project.clips) == count + 1


@pytest.mark.nightly
def test_what_it_should_have_beside_is_asked_for_and_what_cannot_be_is_told(shown):
    drive, dialog = shown
    soft = dialog.wishes.soft
    assert not soft.wish().asks, "at first nothing"
    soft.words.setText("big; round = circle, ball")
    soft.must.setChecked(True)
    wish = soft.wish()
    assert [w.said for w in wish.words] == [("big",), ("round",)] and wish.hard
    soft.words.setText("big; = ball")
    press(dialog.wishes.go)
    assert dialog.said.text().startswith("'= ball' names no word")
    soft.words.setText("big")
    soft.words.setFocus()
    QTest.keyClick(soft.words, Qt.Key.Key_Return)
    drive.wait(lambda: dialog.said.text().startswith("No words of the new speech have times"), 120)
    drive.wait(dialog.wishes.go.isEnabled)
    soft.words.setText("")
    soft.rate.setValue(0.25)
    press(dialog.wishes.go)
    drive.wait(lambda: dialog.said.text().startswith("How fast the speech of the takes was said"), 120)
    drive.wait(dialog.wishes.go.isEnabled)
    soft.rate.setValue(0)
    soft.speed.setValue(15)
    dialog.wishes.length.setValue(3.0)
    press(dialog.wishes.go)
    drive.wait(lambda: "found in" in dialog.said.text(), 120)
    dialog.wishes.speech.setCurrentIndex(0)
    dialog.wishes.speech.activated.emit(0)
    assert not soft.isEnabled(), "nobody speaks"


@pytest.mark.nightly
def test_movements_with_speech_are_counted_and_become_a_sides_rates(shown):
    drive, dialog = shown
    press(dialog.picked.rates_button)
    drive.wait(lambda: dialog.findChild(CooccurrenceDialog) is not None, 60)
    rates = dialog.findChild(CooccurrenceDialog)
    assert [rates.table.item(row, 2).text() for row in range(5)] == ["1", "1", "1", "0", "0"]
    matched = int(rates.table.item(2, 1).text())
    rates.who.setCurrentIndex(1)
    press(rates.go)
    sides = drive.document.project.conversations["v9000"].sides
    assert sides[0].rates == Rates(clause=float(matched)) and sides[1].rates == Rates()
    drive.document.undo_stack.undo()
    assert drive.document.project.conversations["v9000"].sides[0].rates == Rates()


def test_movements_cannot_be_counted_where_nobody_knows_what_was_heard(shown):
    _, dialog = shown
    row = next(
        r
        for r in range(dialog.picked.list.rowCount())
        if dialog.picked.list.item(r, 0).text() == "hand_to_chin__stance"
    )
    dialog.picked.list.item(row, 0).setCheckState(Qt.CheckState.Unchecked)
    press(dialog.picked.rates_button)
    assert "which speaker was heard during it" in dialog.said.text()


@pytest.mark.nightly
def test_who_was_heard_during_a_take_can_be_told_and_undone(shown):
    drive, dialog = shown
    row = next(
        r
        for r in range(dialog.picked.list.rowCount())
        if dialog.picked.list.item(r, 0).text() == "arms_crossed__stance"
    )
    table, menu = dialog.picked.list, dialog.picked.menu
    table.scrollToItem(table.item(row, 2))
    QTest.mouseClick(
        table.viewport(), Qt.MouseButton.LeftButton, pos=table.visualItemRect(table.item(row, 2)).center()
    )
    drive.wait(menu.isVisible)
    assert [a.text() for a in menu.actions()] == [
        "not known",
        "talk: Ada",
        "talk: Ben",
    ] and menu.actions()[0].isChecked()
    for key in (Qt.Key.Key_Up, Qt.Key.Key_Return):  # the last
        QTest.keyClick(menu, key)
    clip = dialog.picked.list.item(row, 0).data(Qt.ItemDataRole.UserRole)
    assert drive.document.project.conversations["v9000"].sides[1].take == clip
    drive.document.undo_stack.undo()
    assert drive.document.project.conversations["v9000"].sides[1].take is None


@pytest.mark.nightly
def test_takes_are_cut_into_clips_that_wait_to_be_labelled(shown):
    drive, dialog = shown
    count = len(drive.document.project.clips)
    press(dialog.picked.cut_button)
    drive.wait(lambda: not dialog.busy and bool(dialog.said.text()), 120)
    assert "not labelled yet" in dialog.said.text(), "the stances rest, leave and come back"
    new = [e for e in drive.document.project.clips.values() if e.path.startswith(FOLDER)]
    assert new and len(new) == len(drive.document.project.clips) - count
    assert all(e.id not in drive.document.project.uses for e in new)
    assert all(LEAST <= e.duration <= MOST for e in new)
    assert all((drive.document.folder / e.path).is_file() for e in new)
    assert drive.session.selection.clips == tuple(e.id for e in new), "they are selected, to be labelled"
    drive.document.undo_stack.undo()
    assert len(drive.document.project.clips) == count


@pytest.mark.nightly
def test_what_was_counted_of_other_takes_is_not_shown_any_more(shown):
    drive, dialog = shown
    press(dialog.count_button)
    drive.wait(lambda: dialog.table.item(0, 1).text() != "–" and dialog.count_button.isEnabled(), 120)
    dialog.k.setValue(4)
    assert dialog.table.item(0, 1).text() != "–", "the table is of each k"
    dialog.picked.list.item(0, 0).setCheckState(Qt.CheckState.Unchecked)
    assert dialog.table.item(0, 1).text() == "–"


@pytest.mark.nightly
def test_what_is_found_for_one_project_is_not_put_into_the_next(shown, tmp_path):
    drive, dialog = shown
    dialog.wishes.speech.setCurrentIndex(0)
    press(dialog.wishes.go)
    drive.document.load(Project("next"), None)
    drive.wait(lambda: not dialog.busy and not drive.jobs.running, 60)
    drive.pause(100)
    assert not drive.document.project.clips and not dialog.said.text()
    drive.wait(lambda: "Import long recordings" in dialog.words.text())
    press(dialog.wishes.go)
    assert "Choose takes first" in dialog.said.text()


def only(dialog, wanted: int) -> None:
    for row in range(dialog.picked.list.rowCount()):
        state = Qt.CheckState.Checked if row == wanted else Qt.CheckState.Unchecked
        dialog.picked.list.item(row, 0).setCheckState(state)


def asked(drive, dialog) -> str:
    """Ask for more motion than there is, without speech; return what is said."""
    dialog.wishes.speech.setCurrentIndex(0)
    dialog.wishes.length.setValue(200)
    drive.pause(300)
    drive.wait(
        lambda: not dialog.busy and dialog.states is not None and dialog.states[0] == dialog.takes.clips
    )
    press(dialog.wishes.go)
    drive.wait(lambda: not dialog.busy and bool(dialog.said.text()), 120)
    return dialog.said.text()


@pytest.mark.nightly
def test_a_graph_of_which_nothing_is_left_is_said_with_a_remedy(shown):
    drive, dialog = shown
    only(dialog, 0)
    dialog.k.setValue(2)
    dialog.level.setValue(50)
    count = len(drive.document.project.clips)
    assert "level" in asked(drive, dialog)
    assert len(drive.document.project.clips) == count


@pytest.mark.nightly
def test_takes_too_short_to_compare_are_told_and_what_was_known_of_others_is_not_used(shown):
    drive, dialog = shown
    long = drive.document.project.clips[dialog.takes.ids[0]]
    short = replace(long, id="c9500", name="two frames", motion=long.motion.trimmed(0, 2), frames=2)
    drive.document.edit("test", lambda p: replace(p, clips={**p.clips, "c9500": short}))
    rows = range(dialog.picked.list.rowCount())
    only(dialog, next(r for r in rows if dialog.picked.list.item(r, 0).text() == "two frames"))
    drive.wait(lambda: "no take has more than 3 frames" in dialog.said.text().lower())
    assert dialog.limit is None
    press(dialog.wishes.go)
    assert "cannot be compared" in dialog.said.text()


@pytest.mark.nightly
def test_an_unsaved_project_is_asked_to_be_saved_first(toys):
    toys.do("motion_graph")
    dialog = toys.window.findChild(MotionGraphDialog)
    toys.wait(lambda: dialog.limit is not None or bool(dialog.words.text()))
    press(dialog.wishes.go)
    assert "Save the project first" in dialog.said.text()
    dialog.close()
