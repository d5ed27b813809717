"""Seeing the plan and changing it in the real window; and driving the character from outside, live."""

from __future__ import annotations

import json
import subprocess
import sys
import threading

import numpy as np
import pytest
from PySide6.QtCore import QEvent, QPoint, Qt
from PySide6.QtGui import QMouseEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QDoubleSpinBox, QMenu, QSpinBox

from app.widgets.lane_geometry import LEFT, place_lanes, split_lane
from metagraph.graph import requests as a
from metagraph.live.server import Options

LEFT_BUTTON = Qt.MouseButton.LeftButton


@pytest.fixture
def stage(drive, toy):
    """The toy project, its performance stopped at the beginning."""
    drive.document.load(toy.project(), None)
    drive.session.place.set_layer("arms")
    drive.session.transport.set_playing(False)
    drive.wait(lambda: len(drive.performance.shown.plan.layers["arms"].cues) > 3)
    drive.session.transport.seek(0.0)
    drive.show("timeline")
    drive.pause(50)
    return drive


def board(drive):
    return drive.timeline.lanes


def spot(drive, seconds: float, lane: str = "arms", upper: bool = True) -> QPoint:
    row = split_lane(place_lanes(board(drive).height())[lane])[0 if upper else 1]
    return QPoint(round(board(drive).scale().x(seconds)), round(row.center().y()))


def popup(drive) -> QMenu:
    drive.wait(lambda: isinstance(QApplication.activePopupWidget(), QMenu))
    return QApplication.activePopupWidget()


def mark(drive, ident: str):
    return next(m for m in board(drive).marks() if m.ask.id == ident)


@pytest.mark.nightly
def test_a_double_click_asks_for_something_there_and_a_drag_moves_it(stage):
    drive = stage
    # The lane is empty at 6 s above the cues: what is chosen is asked for there, and kept in a performance.
    QTest.mouseDClick(board(drive), LEFT_BUTTON, pos=spot(drive, 6.0))
    menu = popup(drive)
    drive.pick(menu, "Go to up")
    menu.close()
    drive.wait(lambda: len(drive.performance.asks) == 1)
    (ask,) = drive.performance.asks
    assert isinstance(ask, a.Go) and ask.at == pytest.approx(6.0, abs=0.1)
    assert drive.timeline.stage.currentText() == "Performance"
    drive.wait(
        lambda: (
            drive.performance.answers().get(ask.id) is not None
            and drive.performance.answers()[ask.id].state != "refused"
        )
    )
    up = drive.performance.document.project.stance(ask.stance).name
    assert up == "up"
    # A real drag in time: nothing changes before the button is let go, then it is one step.
    place = mark(drive, ask.id).rect
    grip = QPoint(round(place.left() + 8), round(place.center().y()))
    to = QPoint(grip.x() + round(3 * board(drive).each), grip.y())
    drive.drag((board(drive), grip), (board(drive), to), lambda: drive.performance.asks[0].at > 8.0)
    assert drive.performance.asks[0].at == pytest.approx(9.0, abs=0.15)
    assert drive.document.undo_stack.undoText() == "Move request"
    drive.document.undo()
    assert drive.performance.asks[0].at == ask.at
    # The arrow keys move it finely, Delete takes it back, undo brings it again.
    drive.session.onstage.select_requests((ask.id,))
    board(drive).setFocus()
    QTest.keyClick(board(drive), Qt.Key.Key_Right)
    assert drive.performance.asks[0].at == pytest.approx(ask.at + 0.1)
    drive.key(Qt.Key.Key_Delete)
    drive.wait(lambda: drive.performance.asks == ())
    drive.document.undo()
    assert len(drive.performance.asks) == 1


def test_a_request_is_changed_in_its_fields_and_says_why_it_does_not_play(stage):
    drive = stage
    drive.performance.requests.ask(a.Gesture(at=3.0))
    (ask,) = drive.performance.asks
    drive.wait(lambda: ask.id in drive.performance.answers())
    QTest.mouseDClick(board(drive), LEFT_BUTTON, pos=mark(drive, ask.id).rect.center().toPoint())
    drive.wait(lambda: QApplication.activeModalWidget() is not None)
    editor = QApplication.activeModalWidget()
    editor.fields["priority"].setValue(7)
    editor.fields["at"].setValue(4.5)
    editor.fields["hold"].setValue(1.5)
    tags = editor.fields["tags"]
    tags.setFocus()
    QTest.keyClicks(tags, "nonsense")
    QTest.keyClick(tags, Qt.Key.Key_Return)
    assert editor.isVisible()
    (changed,) = drive.performance.asks
    assert (changed.priority, changed.at, changed.hold, changed.tags) == (7, 4.5, 1.5, ("nonsense",))
    assert isinstance(editor.fields["priority"], QSpinBox) and isinstance(editor.fields["at"], QDoubleSpinBox)
    drive.wait(lambda: "Does not play" in editor.words.text())
    assert "nonsense" in editor.words.text()
    drive.wait(lambda: mark(drive, ask.id).lost)
    assert drive.timeline.lost.text() == "⚠ 1 not met"
    editor.accept()


@pytest.mark.nightly
def test_the_lost_requests_are_found_by_a_click_and_say_why_without_hovering(stage):
    drive = stage
    panel = drive.timeline
    for at, tags in ((2.0, ()), (9.0, ("nonsense",)), (50.0, ("gibberish",))):
        drive.performance.requests.ask(a.Gesture(at=at, tags=tags))
    drive.wait(lambda: sum(m.lost for m in board(drive).marks()) == 2)
    drive.session.onstage.select_requests(())
    assert "2 requests" in panel.title.words
    for seconds, word in ((9.0, "nonsense"), (50.0, "gibberish"), (9.0, "nonsense")):
        QTest.mouseClick(panel.lost, LEFT_BUTTON)
        (chosen,) = drive.session.onstage.requests
        assert mark(drive, chosen).at == seconds
        assert "Does not play" in panel.title.words and word in panel.title.words
        assert LEFT <= mark(drive, chosen).rect.left() < board(drive).width()
    drive.session.onstage.select_requests((drive.performance.asks[0].id,))
    assert "Plays rest" in panel.title.words and "from 2.0" in panel.title.words
    drive.performance.requests.withdraw()
    drive.wait(lambda: not panel.lost.isVisible())


def test_a_long_sentence_in_the_header_widens_nothing_and_can_be_read_in_full(stage):
    title = stage.timeline.title
    before = stage.timeline.minimumSizeHint().width()
    title.say("word " * 400)
    assert stage.timeline.minimumSizeHint().width() == before
    assert title.text().endswith("…") and title.toolTip() == title.words


def held(drive, ident: str, modifier=Qt.KeyboardModifier.NoModifier, seconds: float = 3.0) -> QPoint:
    """Press on a request and move it with the button down; where it is then."""
    place = mark(drive, ident).rect
    grip = QPoint(round(place.left() + 8), round(place.center().y()))
    to = QPoint(grip.x() + round(seconds * board(drive).each), grip.y())
    QTest.mousePress(board(drive), LEFT_BUTTON, modifier, grip)
    for point in ((grip + to) / 2, to):
        move = QMouseEvent(
            QEvent.Type.MouseMove, point, board(drive).mapToGlobal(point), LEFT_BUTTON, LEFT_BUTTON, modifier
        )
        QApplication.sendEvent(board(drive), move)
    return to


def test_a_dragged_request_is_given_up_with_escape_and_copied_with_ctrl(stage):
    drive = stage
    drive.performance.requests.ask(a.Gesture(at=2.0))
    (ask,) = drive.performance.asks
    drive.wait(lambda: ask.id in drive.performance.answers())
    board(drive).setFocus()
    to = held(drive, ask.id)
    assert mark(drive, ask.id).at == pytest.approx(5.0, abs=0.05)
    drive.key(Qt.Key.Key_Escape, widget=board(drive))
    QTest.mouseRelease(board(drive), LEFT_BUTTON, pos=to)
    assert drive.performance.asks == (ask,) and mark(drive, ask.id).at == 2.0
    ctrl = Qt.KeyboardModifier.ControlModifier
    drive.session.onstage.select_requests(())
    to = held(drive, ask.id, ctrl)
    assert [round(m.at) for m in board(drive).marks()] == [2, 5]
    QTest.mouseRelease(board(drive), LEFT_BUTTON, ctrl, to)
    first, copy = drive.performance.asks
    assert (
        first == ask
        and copy.at == pytest.approx(5.0, abs=0.05)
        and drive.session.onstage.requests == (copy.id,)
    )
    assert drive.document.undo_stack.undoText() == "Copy 1 request"
    drive.document.undo()
    assert drive.performance.asks == (ask,)
    # Nothing is dragged to before the beginning, and a click with Ctrl alone selects and unselects.
    QTest.mouseRelease(board(drive), LEFT_BUTTON, pos=held(drive, ask.id, seconds=-4.0))
    assert drive.performance.asks[0].at == 0.0
    place = mark(drive, ask.id).rect.center().toPoint()
    QTest.mouseClick(board(drive), LEFT_BUTTON, ctrl, place)
    assert drive.session.onstage.requests == ()
    QTest.mouseClick(board(drive), LEFT_BUTTON, ctrl, place)
    assert drive.session.onstage.requests == (ask.id,)


@pytest.mark.nightly
def test_all_of_it_works_from_the_keyboard(stage):
    drive = stage
    key = lambda k, m=Qt.KeyboardModifier.NoModifier: QTest.keyClick(board(drive), k, m)  # noqa: E731
    drive.session.transport.seek(4.0)
    board(drive).setFocus(Qt.FocusReason.TabFocusReason)
    key(Qt.Key.Key_Insert)
    menu = popup(drive)
    drive.pick(menu, "Arms", "A gesture")
    menu.close()
    assert [x.at for x in drive.performance.asks] == [4.0]
    key(Qt.Key.Key_D, Qt.KeyboardModifier.ControlModifier)
    assert [x.at for x in drive.performance.asks] == [4.0, 5.0]
    key(Qt.Key.Key_Right, Qt.KeyboardModifier.ShiftModifier)
    assert [x.at for x in drive.performance.asks] == [4.0, 6.0]
    one, two = (x.id for x in drive.performance.asks)
    for press, chosen in (
        (Qt.Key.Key_Up, one),
        (Qt.Key.Key_Up, one),
        (Qt.Key.Key_Down, two),
        (Qt.Key.Key_Down, two),
    ):
        key(press)
        assert drive.session.onstage.requests == (chosen,)
    key(Qt.Key.Key_Escape)
    assert drive.session.onstage.requests == ()
    before = board(drive).each
    key(Qt.Key.Key_Plus)
    assert board(drive).each > before
    board(drive).setFocus()
    key(Qt.Key.Key_Tab)
    assert QApplication.focusWidget() is not board(drive), "the keyboard can leave"


@pytest.mark.nightly
def test_while_it_plays_only_the_playhead_is_painted_anew(stage):
    drive = stage
    drive.performance.requests.ask(a.Gesture(at=2.0))
    drive.wait(lambda: len(drive.performance.answers()) == 1)
    drive.settle()
    before = board(drive).painted
    for n in range(20):
        drive.session.transport.seek(0.1 * n)
        board(drive).repaint()
    assert board(drive).painted == before
    drive.session.onstage.select_requests(())
    board(drive).repaint()
    assert board(drive).painted == before + 1


@pytest.mark.nightly
def test_a_request_that_vanishes_while_its_fields_are_open_says_so(stage):
    drive = stage
    drive.performance.requests.ask(a.Gesture(at=3.0))
    (ask,) = drive.performance.asks
    drive.wait(lambda: ask.id in drive.performance.answers())
    board(drive).edit(ask.id)
    editor = QApplication.activeModalWidget()
    drive.performance.requests.withdraw(ask.id)
    drive.wait(lambda: "no longer exists" in editor.words.text())
    assert not editor.fields["at"].isEnabled() and not editor.remove.isEnabled()
    drive.document.undo()
    drive.wait(lambda: editor.fields["at"].isEnabled())
    editor.accept()


def test_performances_are_made_renamed_and_removed_from_the_panel(stage, monkeypatch):
    from PySide6.QtWidgets import QInputDialog, QMessageBox

    drive = stage
    panel = drive.timeline
    panel.new()
    drive.performance.requests.ask(a.Gesture(at=3.0))
    monkeypatch.setattr(QInputDialog, "getText", lambda *args, **kwargs: ("greeting", True))
    panel.rename()
    assert panel.stage.currentText() == "greeting"
    panel.duplicate()
    assert panel.stage.currentText() == "greeting 2" and len(drive.performance.asks) == 1
    monkeypatch.setattr(QInputDialog, "getDouble", lambda *args, **kwargs: (20.0, True))
    panel.set_length()
    drive.wait(lambda: drive.performance.shown.length == 20.0)
    monkeypatch.setattr(QMessageBox, "question", lambda *args, **kwargs: QMessageBox.StandardButton.Yes)
    panel.remove()
    assert panel.stage.currentText() == "Improvised, talking"
    assert [panel.stage.itemText(n) for n in range(panel.stage.count())] == [
        "Improvised, talking",
        "Improvised, listening",
        "Improvised, idle",
        "greeting",
    ]
    panel.stage.activated.emit(1)
    panel.stage.setCurrentIndex(1)
    assert drive.document.project.performances


@pytest.mark.nightly
def test_a_point_is_put_somewhere_and_looked_at(stage):
    from app.widgets.request_menu import make_request_menu

    drive = stage
    menu = make_request_menu(drive.timeline, drive.performance, 2.0)
    drive.pick(menu, "Look at", "New point…")
    drive.wait(lambda: QApplication.activeModalWidget() is not None)
    editor = QApplication.activeModalWidget()
    QTest.keyClicks(editor.name, "door")
    editor.axes[0].setValue(-2.0)
    editor.buttons.accepted.emit()
    assert drive.document.project.points["door"] == (-2.0, 1.5, 1.2)
    (ask,) = drive.performance.asks
    assert ask.to == "door" and ask.at == 2.0
    drive.wait(lambda: bool(drive.performance.shown.plan.track.looks))


# --- live

CLIENT = """
import json, sys
from websockets.sync.client import connect
with connect(sys.argv[1]) as line:
    for message in json.loads(sys.argv[2]):
        line.send(json.dumps(message))
        print(line.recv(timeout=20), flush=True)
    sys.stdin.read()
"""


def client(drive, *messages: dict) -> tuple[subprocess.Popen, threading.Thread, list[dict]]:
    """Send messages from another process; its replies fill the list, read by a thread since the window must
    not wait.
    """
    address = drive.performance.live.stage.relay.ready.websocket
    words = [sys.executable, "-c", CLIENT, address, json.dumps(messages)]
    process = subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    replies: list[dict] = []
    reader = threading.Thread(target=lambda: replies.extend(map(json.loads, process.stdout)), daemon=True)
    reader.start()
    return process, reader, replies


@pytest.fixture
def live(stage):
    drive = stage
    drive.performance.live.begin(Options(port=0, osc=None))
    drive.wait(
        lambda: (
            drive.performance.live.stage is not None and drive.performance.live.stage.relay.ready is not None
        )
    )
    yield drive
    drive.performance.live.end()


@pytest.mark.nightly
def test_a_client_drives_a_gesture_that_is_seen_in_the_preview(live):
    """An agent in another process asks for an action by its name; the character in the window makes it."""
    drive = live
    assert drive.timeline.live.isChecked() and "ws://127.0.0.1:" in drive.performance.live.stage.words()
    drive.wait(lambda: drive.performance.live.stage.now > 1.0)
    before = drive.performance.pose()
    long = {"do": "action", "action": "rest long", "id": "w", "priority": 5}
    process, reader, replies = client(drive, long, {"do": "gesture", "tags": ["none"]})
    try:
        arms = lambda: drive.performance.shown.plan.layers["arms"].cues  # noqa: E731
        drive.wait(lambda: any(c.action.name == "rest long" and c.meta.endswith("/w") for c in arms()))
        drive.wait(lambda: len(replies) == 2)
        said, refused = replies
        assert said["id"] == "w" and said["state"] in ("planned", "late") and said["actions"] == ["rest long"]
        assert refused["state"] == "refused" and "none" in refused["why"]
        cue = next(c for c in arms() if c.meta.endswith("/w"))
        arm = drive.document.project.skeleton.index("LeftUpperArm")
        turned = lambda: np.abs(drive.performance.pose().rotations[arm] - before.rotations[arm]).max()  # noqa: E731
        # The arm is up in the picture. Between two looks more than half of it may pass, where the machine is
        # busy.
        drive.wait(lambda: bool(cue.start < drive.session.transport.seconds < cue.end and turned() > 0.1))
        painted = drive.preview.frames
        drive.wait(lambda: drive.preview.frames > painted + 2)
        drive.wait(lambda: any(m.ask.id.endswith("/w") for m in board(drive).marks()))
        assert next(m for m in board(drive).marks() if m.ask.id.endswith("/w")).answer.state != "refused"
        assert "1 client" in drive.performance.live.stage.words()
    finally:
        process.stdin.close()
        process.wait(20)
        reader.join(5)
        process.stdout.close()
    drive.wait(lambda: "no clients" in drive.performance.live.stage.words())


@pytest.mark.nightly
def test_the_past_of_a_live_session_can_be_scrubbed_and_now_is_found_again(live):
    drive = live
    drive.wait(lambda: drive.performance.live.stage.now > 1.5)
    assert drive.session.transport.seconds == pytest.approx(drive.performance.live.stage.now, abs=0.3)
    assert not drive.timeline.now.isVisible()
    QTest.mouseClick(board(drive), LEFT_BUTTON, pos=QPoint(LEFT + 30, 8))
    past = drive.session.transport.seconds
    assert past < 1.2
    drive.pause(300)
    assert drive.session.transport.seconds == past and drive.timeline.now.isVisible()
    QTest.mouseClick(drive.timeline.now, LEFT_BUTTON)
    drive.pause(100)
    assert drive.session.transport.seconds == pytest.approx(drive.performance.live.stage.now, abs=0.3)


@pytest.mark.nightly
def test_what_was_played_live_is_kept_and_plays_again_as_it_was(live):
    drive = live
    drive.wait(lambda: drive.performance.live.stage.now > 0.5)
    drive.performance.requests.ask(a.Gesture())
    arms = lambda: drive.performance.shown.plan.layers["arms"].cues  # noqa: E731
    drive.wait(lambda: any(not c.meta.startswith("auto") for c in arms()))
    drive.wait(lambda: drive.performance.live.stage.now > 3.0)
    now, played = drive.performance.live.stage.now, drive.performance.shown.plan.layers["arms"].cues
    drive.performance.live.end()
    assert drive.performance.live.last is not None
    drive.timeline.more_menu.aboutToShow.emit()
    drive.pick(drive.timeline.more_menu, "Keep the live session")
    assert drive.timeline.stage.currentText() == "Live session"
    drive.wait(
        lambda: (
            drive.performance.requests.kept is not None
            and drive.performance.shown.length == drive.performance.requests.kept.length
        )
    )
    again = drive.performance.shown.plan.layers["arms"].cues
    assert [c for c in again if c.start < now] == [c for c in played if c.start < now]
    assert not drive.performance.live.stage


def test_an_edit_while_live_changes_what_comes(live, toy):
    from metagraph.graph import edits

    drive = live
    gone = toy.id(drive.document.project, "rest long")
    drive.document.edit("Remove", lambda p: edits.remove_actions(p, [gone]))
    drive.wait(lambda: drive.performance.shown.project.action(gone) is None)
    now = drive.performance.live.stage.now + 1
    assert all(c.action.id != gone for c in drive.performance.shown.plan.layers["arms"].cues if c.start > now)
