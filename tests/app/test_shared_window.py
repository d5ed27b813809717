"""What tests take turns with is, each time, as a window is that nothing was done in."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtCore import QSettings, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QDialog

from metagraph.graph import edits
from tests.app.shared_window import SharedWindow, close, complete_window, empty, reset, stands
from tests.app.window_state import differences, state_of

pytestmark = [pytest.mark.window, pytest.mark.gl]


def edited(drive):
    drive.document.edit("Change seed", lambda p: edits.set_settings(p, seed=7))
    drive.session.jump(action=drive.id("rest beat lf"))


def arranged(drive):
    drive.docks["timeline"].close()
    drive.show("machine")
    drive.docks["life"].raise_()
    drive.wait(drive.machine.isVisible)


def narrowed(drive):
    drive.library.search.setText("beat")
    drive.library.chips["labelled"].click()
    drive.library.narrow("arms", "gesture")
    drive.lines.search.setText("hello")


def played(drive):
    drive.session.transport.set_playing(False)
    drive.preview.speed_box.setCurrentIndex(0)
    drive.preview.speed_box.activated.emit(0)
    drive.preview.toggle_loop()
    drive.preview.toggle_bones()
    drive.sound.set_muted(True)
    drive.timeline.lanes.each, drive.timeline.lanes.first = 90.0, 12.0


def chosen(drive):
    drive.do("theme")
    drive.do("watch")
    drive.do("manual")
    drive.session.place.set_layer("head")
    QSettings().setValue("learn", "false")


def asked(drive):
    drive.do("keys")
    drive.do("skeleton")
    drive.wait(lambda: any(d.isVisible() for d in drive.window.findChildren(QDialog)))
    drive.notice.tell("Look", "at this", lambda: None)
    drive.shell.tell("Something was said")


def reserved(drive):
    drive.files.closed = "Not now."
    drive.learned.paused = True
    drive.actions.allowed = lambda command: False
    drive.actions.refresh()


DONE = (edited, arranged, narrowed, played, chosen, asked, reserved)


@pytest.mark.nightly
@pytest.mark.parametrize("done", [DONE, DONE[::-1]], ids=["forward", "backward"])
def test_a_window_that_was_reset_is_like_one_that_was_just_made(toys, done):
    drive, project = toys, toys.document.project
    drive.window.hide()
    other = complete_window()
    reset(other)
    fresh, stood = state_of(other), stands(other)
    close(other)
    drive.window.show()
    for do in done:
        drive.document.load(project, None)
        do(drive)
        empty(drive.window)
        reset(drive.window, stood)
        assert not differences(fresh, state_of(drive.window)), do.__name__


def moved(drive):
    drive.docks["timeline"].close()


def stretched(drive):
    drive.window.resizeDocks(
        [drive.docks["library"]], [drive.docks["library"].width() + 40], Qt.Orientation.Horizontal
    )
    drive.workspaces.places.proportions.note()


def raised(drive):
    drive.docks["life"].raise_()


def chosen_another(drive):
    drive.workspaces.choose("talk")


def alone(drive):
    drive.workspaces.places.only("graph")


@pytest.mark.nightly
@pytest.mark.parametrize("do", (moved, stretched, raised, chosen_another, alone), ids=lambda do: do.__name__)
def test_docks_that_a_test_has_moved_do_not_stand_as_they_did_and_are_put_back(toys, do):
    stood = stands(toys.window)
    assert stands(toys.window) == stood
    do(toys)
    QTest.qWait(20)
    assert stands(toys.window) != stood
    empty(toys.window)
    reset(toys.window, stood)
    assert toys.workspaces.current == stood[3] and not toys.workspaces.places.alone
    assert toys.workspaces.places.workspace.id == stood[2]


@pytest.mark.nightly
@pytest.mark.parametrize("do", DONE, ids=lambda do: do.__name__)
def test_what_is_done_in_a_window_is_seen_in_its_state(toys, do):
    before = state_of(toys.window)
    do(toys)
    assert differences(before, state_of(toys.window))


@pytest.mark.nightly
def test_nothing_of_a_test_is_in_the_folders_of_the_next(toys, tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "next"))
    reset(toys.window)
    toys.document.edit("Change seed", lambda p: edits.set_settings(p, seed=7))
    place = toys.document.journal_place
    assert tmp_path / "next" in Path(place).parents and place.is_file()


@pytest.mark.nightly
def test_a_window_is_made_anew_where_a_test_failed_closed_it_or_left_something(qapp, drive):
    own = SharedWindow()
    drive.window.hide()
    first = own.take()
    own.give_back(whole=True)
    assert own.take() is first
    own.give_back(whole=False)
    second = own.take()
    second.close()
    own.give_back(whole=True)
    third = own.take()
    third.places.docks["life"].setObjectName("gone")
    own.give_back(whole=True)
    assert own.take() is not third
    assert (own.made, own.taken_back) == (4, 1)
    assert any("life" in what for what in own.spoilt)
    own.throw_away()
    QTest.qWait(1)
    drive.window.show()
