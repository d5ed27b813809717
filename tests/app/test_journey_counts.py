"""Clicks, keys and drags of ten tasks in the real window: what a task takes is counted here, so that no change
makes it longer unseen.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QPushButton, QWidget

from app.widgets.lane_geometry import place_lanes
from metagraph.formats.gltf.writer import write_glb
from metagraph.formats.project.paths import make_paths_absolute
from metagraph.graph import edits, requests
from metagraph.graph.model import Project
from tests.app.pointer import press
from tests.processes import ROOT

pytestmark = [pytest.mark.window, pytest.mark.gl, pytest.mark.nightly]
CONTROL = Qt.KeyboardModifier.ControlModifier
SHIFT = Qt.KeyboardModifier.ShiftModifier


class CountedHand:
    """A hand whose clicks, keys and drags are counted."""

    def __init__(self, drive: Any) -> None:
        self.drive = drive
        self.top: QWidget | None = None  # the dialog that a window manager would give the keyboard to
        self.clicks = self.keys = self.drags = 0

    @property
    def taken(self) -> tuple[int, int, int]:
        """The clicks, keys and drags so far."""
        return self.clicks, self.keys, self.drags

    def target(self) -> QWidget:
        """Return what keys go to: there is no window manager here that activates a new dialog."""
        top = QApplication.activeModalWidget() or (self.top if self.top and self.top.isVisible() else None)
        if top is not None:
            return top.focusWidget() or top
        return QApplication.focusWidget() or self.drive.window

    def click(self, widget: QWidget, at: QPoint | None = None) -> None:
        self.clicks += 1
        press(self.drive, (widget, at or widget.rect().center()))

    def key(self, key: Qt.Key, held: Qt.KeyboardModifier = Qt.KeyboardModifier.NoModifier) -> None:
        """Press a key where the keyboard is."""
        self.keys += 1
        QTest.keyClick(self.target(), key, held)

    def type(self, words: str) -> None:
        self.keys += len(words)
        QTest.keyClicks(self.target(), words)

    def drag(self, start: Any, end: Any, until: Any) -> None:
        self.drags += 1
        self.drive.drag(start, end, until)


@pytest.fixture
def sample(sample: Project) -> Project:
    """The sample where its files are found."""
    return make_paths_absolute(sample, ROOT / "sample_clips")


@pytest.fixture
def hand(drive: Any, sample: Project) -> CountedHand:
    """The sample in the window, at rest, its graph and character large."""
    drive.document.load(sample, None)
    drive.files.opened.emit()
    drive.wait(lambda: len(drive.performance.shown.plan.layers["arms"].cues) > 1)
    drive.session.transport.set_playing(False)
    drive.workspaces.choose("graph")
    drive.settle()
    drive.canvas.setFocus()
    return CountedHand(drive)


def stance(drive: Any, name: str) -> str:
    return next(
        s.id for g in drive.document.project.graphs.values() for s in g.stances.values() if s.name == name
    )


def unlabelled(drive: Any) -> int:
    project = drive.document.project
    return sum(clip not in project.uses for clip in project.clips)


def without_gestures(hand: CountedHand, sample: Project, count: int) -> None:
    """Let as many gestures of the stance that is shown have no label."""
    drive = hand.drive
    start = sample.graphs["arms"].start
    some = sample.graphs["arms"].of(str(start), "gesture")[:count]
    assert len(some) == count
    drive.document.load(edits.remove_actions(sample, [a.id for a in some]), None)
    drive.files.opened.emit()
    drive.settle()
    assert unlabelled(drive) == count


def test_twenty_one_gestures_of_a_stance_are_labelled_by_a_click_and_two_keys(
    hand: CountedHand, sample: Project
) -> None:
    drive = hand.drive
    without_gestures(hand, sample, 21)
    hand.click(drive.library.chips["unlabelled"])
    drive.library.list.setFocus()
    hand.key(Qt.Key.Key_A, CONTROL)
    hand.key(Qt.Key.Key_2)
    drive.wait(lambda: unlabelled(drive) == 0)
    assert hand.taken == (1, 2, 0)


def test_twenty_one_clips_are_labelled_as_proposed_by_two_keys_and_one_for_each_doubtful(
    hand: CountedHand, sample: Project
) -> None:
    drive = hand.drive
    without_gestures(hand, sample, 21)
    hand.key(Qt.Key.Key_P, CONTROL)
    dialog = wait_for_dialog(drive, "ReviewDialog")
    drive.wait(lambda: dialog.current is not None, 40)
    drive.settle()
    hand.top = dialog
    hand.key(Qt.Key.Key_A)
    doubtful = unlabelled(drive)
    assert doubtful <= 8
    for _ in range(doubtful):
        hand.key(Qt.Key.Key_Return)
        drive.pause(100)
    assert unlabelled(drive) == 0 and hand.taken == (0, 2 + doubtful, 0)
    if dialog.isVisible():
        dialog.close()


def wait_for_dialog(drive: Any, kind: str) -> Any:
    found: list[QWidget] = []

    def look() -> bool:
        found[:] = [w for w in QApplication.topLevelWidgets() if type(w).__name__ == kind and w.isVisible()]
        return bool(found)

    drive.wait(look, 40)
    return found[0]


def test_a_gesture_on_the_wrong_stance_is_mended_by_one_drag(hand: CountedHand) -> None:
    drive = hand.drive
    other = stance(drive, "on hips")
    action = next(a for a in drive.canvas.acts.listed() if a.kind == "gesture")
    assert action.stance != other
    hand.drag(
        drive.row(action.id),
        drive.chip(other),
        lambda: drive.document.project.action(action.id).stance == other,
    )
    assert hand.taken == (0, 0, 1)


def test_a_blend_takes_a_click_and_a_drag(hand: CountedHand) -> None:
    drive = hand.drive
    drive.workspaces.choose("time")
    drive.settle()
    action = next(a for a in drive.canvas.acts.listed() if a.kind == "gesture")
    hand.click(*drive.row(action.id))
    view = drive.shell.panel("timing").view
    drive.wait(lambda: action.id in view.numbers)
    drive.settle()
    view.grab()
    place = view.numbers[action.id]["in"].center().toPoint()
    before = action.timing.blend_in
    hand.drag(
        (view, place),
        (view, place + QPoint(60, 0)),
        lambda: drive.document.project.action(action.id).timing.blend_in > before + 0.05,
    )
    assert hand.taken == (1, 0, 1)


def test_a_certain_gesture_is_requested_by_one_drag(hand: CountedHand) -> None:
    drive = hand.drive
    drive.workspaces.choose("perform")
    drive.settle()
    name = next(a.name for a in drive.document.project.actions() if a.layer == "arms" and a.kind == "gesture")
    clip = next(a.clip for a in drive.document.project.actions() if a.name == name)
    if not drive.library.isVisible():
        drive.places.show("library")
        drive.settle()
    card = drive.card(drive.document.project.clips[clip].name)
    lanes = drive.timeline.lanes
    lane = place_lanes(lanes.height(), lanes.sizes)["arms"]
    there = lanes, QPoint(round(0.7 * lanes.width()), round(lane.center().y()))
    hand.drag(card, there, lambda: bool(drive.performance.asks))
    assert isinstance(drive.performance.asks[0], requests.Play) and hand.taken == (0, 0, 1)


def test_an_export_takes_one_shortcut_and_one_click(hand: CountedHand, tmp_path: Path) -> None:
    drive = hand.drive
    hand.key(Qt.Key.Key_E, CONTROL)
    dialog = wait_for_dialog(drive, "ExportDialog")
    dialog.folder.setText(str(tmp_path / "out"))  # as it was for the last export
    hand.click(dialog.go)
    drive.wait(lambda: dialog.open_button.isEnabled(), 120)
    assert hand.taken == (1, 1, 0) and any((tmp_path / "out").iterdir())
    dialog.reject()


def test_an_own_file_moves_a_character_after_a_drop_a_click_and_a_key(
    drive: Any, toy: Any, tmp_path: Path
) -> None:
    hand = CountedHand(drive)
    names = ("idle", "wave", "point")
    clips = [toy.clip(n, 2.0, 0.0 if n == "idle" else 0.5, swing=0.05 if n == "idle" else 1.0) for n in names]
    write_glb(tmp_path / "mine.glb", clips)
    hand.drags += 1
    assert drive.drop_files((drive.window, QPoint(400, 400)), tmp_path / "mine.glb")
    drive.wait(lambda: len(drive.document.project.clips) == 3)
    offered = lambda: [b for b in drive.window.findChildren(QPushButton) if b.text() == "Label clips…"]  # noqa: E731
    drive.wait(lambda: any(b.isVisible() for b in offered()))
    drive.settle()
    button = next(b for b in offered() if b.isVisible())
    hand.click(button)
    dialog = wait_for_dialog(drive, "ReviewDialog")
    drive.wait(lambda: dialog.current is not None, 40)
    drive.settle()
    hand.top = dialog
    hand.key(Qt.Key.Key_A)
    drive.wait(lambda: bool(drive.names("stance")))
    assert hand.taken == (1, 1, 1)
    dialog.close()
    drive.wait(lambda: drive.preview.drawn is not None)


def test_two_stances_are_merged_by_one_drag(hand: CountedHand) -> None:
    drive = hand.drive
    one, other = stance(drive, "hands clasped"), stance(drive, "on hips")
    hand.drag(drive.chip(one), drive.chip(other), lambda: drive.document.project.stance(one) is None)
    assert hand.taken == (0, 0, 1)


def test_a_stance_of_another_layer_is_found_by_five_keys(hand: CountedHand) -> None:
    drive = hand.drive
    hand.key(Qt.Key.Key_G, CONTROL)
    hand.type("lea")
    hand.key(Qt.Key.Key_Return)
    assert drive.session.place.stance() == stance(drive, "lean forward") and hand.taken == (0, 5, 0)


def test_what_was_done_is_undone_by_one_key(hand: CountedHand) -> None:
    drive = hand.drive
    before = drive.document.project
    drive.document.edit("Remove", lambda p: edits.remove_actions(p, [next(p.actions()).id]))
    hand.key(Qt.Key.Key_Z, CONTROL)
    assert drive.document.project.graphs == before.graphs and hand.taken == (0, 1, 0)


def test_any_command_is_done_by_typing_a_part_of_its_name(hand: CountedHand) -> None:
    drive = hand.drive
    hand.key(Qt.Key.Key_P, CONTROL | SHIFT)
    hand.type("four")
    hand.key(Qt.Key.Key_Return)
    drive.wait(lambda: drive.session.watch.now.panes == 4)
    assert hand.taken == (0, 6, 0)
    drive.session.watch.set(panes=1)
