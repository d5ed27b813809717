"""A conversation's cameras in the real window: cut by keys and mouse, by who speaks, seen and written; captions."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QEvent, QPoint, QPointF, Qt
from PySide6.QtGui import QMouseEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from app.stage.caption_paint import add_captions
from app.stage.cutting import Cutting
from app.widgets.lane_geometry import place_lanes
from metagraph.graph.conversation.edits import add_conversation
from metagraph.graph.conversation.model import Conversation, Segment, Side, Word
from metagraph.graph.timeline import Cut
from metagraph.speech.captions import Caption

pytestmark = [pytest.mark.window, pytest.mark.gl]


@pytest.fixture
def talking(toys):
    toys.session.transport.set_playing(False)
    words = tuple(
        Word(text=w, start=1.0 + n / 2, end=1.4 + n / 2) for n, w in enumerate(["so", "it", "was", "told"])
    )
    sides = (
        Side(name="Ada", words=words, segments=(Segment("clause", 3.0, 6.0),)),
        Side(name="Bo", segments=(Segment("clause", 7.0, 10.0),)),
    )
    made = ""

    def edit(project):
        nonlocal made
        project, made = add_conversation(project, Conversation(name="Talk", length=12.0, sides=sides))
        return project

    toys.document.edit("Talk", edit)
    toys.session.onstage.set_conversation(made)
    toys.wait(lambda: bool(toys.performance.shown.others))
    toys.wait(lambda: all(toys.figures.of(one) is not None for one in toys.performance.shown.everyone))
    yield toys
    toys.session.onstage.set_conversation(None)
    toys.preview.frame_all()


def lane(view):
    return place_lanes(view.height(), view.sizes)["cameras"]


def test_keys_cut_at_the_playhead_and_the_preview_follows(talking):
    view, timeline, preview = talking.timeline.lanes, talking.performance.timeline, talking.preview
    preview.view.grab()
    free = preview.view.camera
    talking.session.transport.seek(4.0)
    view.setFocus()
    QTest.keyClick(view, Qt.Key.Key_5)
    assert [(c.at, c.shot, c.side) for c in timeline.now.cuts] == [(0.0, "two", 0), (4.0, "close", 1)]
    preview.view.grab()
    assert preview.view.camera.distance < 2 and preview.view.camera.target[1] > 0.5 * free.target[1]
    close = preview.view.camera
    talking.session.transport.seek(1.0)
    preview.view.grab()
    assert preview.view.camera != close
    for _ in range(2):
        talking.document.undo() if timeline.now.cuts else None
    preview.view.grab()
    # It is framed on the poses of another second, so nearly as before.
    assert timeline.now.cuts == () and preview.view.camera.distance == pytest.approx(free.distance, rel=0.1)


def test_a_moved_camera_is_the_hand_s_until_it_is_framed_again(talking):
    preview = talking.preview
    talking.do("automatic_cuts")
    talking.session.transport.seek(4.0)
    preview.view.grab()
    cut = preview.view.camera
    preview.view.camera = cut.orbit(0.3, 0.1)
    preview.view.moved_by_hand = True
    preview.view.grab()
    assert preview.view.camera != cut
    talking.do("frame")
    preview.view.grab()
    assert preview.view.camera == cut


def test_cuts_by_who_speaks_are_dragged_and_taken_away(talking):
    view, timeline = talking.timeline.lanes, talking.performance.timeline
    talking.do("automatic_cuts")
    assert [(c.shot, c.side) for c in timeline.now.cuts] == [("two", 0), ("over", 0), ("over", 1)]
    view.each, view.first = 60.0, 0.0
    y = lane(view).center().y()
    start = QPointF(view.scale().x(timeline.now.cuts[2].at), y)
    QTest.mousePress(view, Qt.MouseButton.LeftButton, pos=start.toPoint())
    for end in (start + QPointF(20, 0), start + QPointF(45, 0)):
        event = QMouseEvent(
            QEvent.Type.MouseMove, end, view.mapToGlobal(end), Qt.MouseButton.NoButton, Qt.MouseButton.LeftButton,
            Qt.KeyboardModifier.ShiftModifier,
        )  # fmt: skip
        QApplication.sendEvent(view, event)
    QTest.mouseRelease(view, Qt.MouseButton.LeftButton, pos=end.toPoint())
    assert timeline.now.cuts[2].at == pytest.approx(6.4 + 0.75, abs=0.04)
    assert "Over the shoulder of Bo" in view.tip(QPointF(view.scale().x(9.0), y))
    menu = view.cameras.menu(QPointF(view.scale().x(9.0), y))
    next(x for x in menu.actions() if x.text().startswith("Remove this cut")).trigger()
    assert len(timeline.now.cuts) == 2
    next(x for x in menu.actions() if x.text() == "No cuts").trigger()
    assert timeline.now.cuts == () and talking.document.project.timelines == {}


@pytest.mark.nightly
def test_captions_stand_over_the_preview_and_go_with_the_words(talking):
    label = talking.preview.directing.label
    talking.do("captions")
    talking.session.transport.seek(1.5)
    talking.preview.view.grab()
    assert [c.text for c in label.shown] == ["Ada: so it was told"] and not label.isHidden()
    talking.session.transport.seek(8.0)
    talking.preview.view.grab()
    assert label.shown == [] and label.isHidden()
    talking.do("captions")
    assert not talking.performance.timeline.now.captions


@pytest.mark.parametrize("size", [(640, 360), (360, 640), (240, 135)])
def test_captions_are_painted_inside_the_safe_area(qapp, size):
    width, height = size
    plain = np.full((height, width, 4), 90, np.uint8)
    plain[..., 3] = 255
    long = "and nobody was at the door so I just walked\nin and all of the lights came on as if they"
    drawn = add_captions(plain.copy(), [Caption(0.0, 1.0, long), Caption(0.0, 1.0, "really", 1)])
    rows, columns = np.nonzero((drawn != plain).any(-1))
    assert rows.max() <= height * 0.95 and rows.min() > height * 0.3
    assert columns.min() >= width * 0.03 and columns.max() <= width * 0.97
    assert add_captions(plain, []) is plain


def test_what_is_written_is_cut_and_captioned_like_the_preview(talking, monkeypatch):
    from app.cli import render_command

    cuts = (Cut(at=0.0, shot="two"), Cut(at=2.0, shot="close", side=1))
    seen = [(talking.figures.of(one), one) for one in talking.performance.shown.everyone]
    cameras = []

    def pictures(seen, times, size, look, camera, into, seat, props):
        for at in times:
            cameras.append(camera(float(at)).camera)
            yield np.full((size[1], size[0], 4), 255, np.uint8)

    monkeypatch.setattr(render_command, "render_pictures", pictures)
    captions = (Caption(1.0, 1.5, "so it was"),)
    times = np.array([0.5, 1.2, 2.5])
    drawn = list(render_command.render_directed(seen, times, (320, 180), "dark", (cuts, captions)))
    assert cameras[0] == cameras[1] != cameras[2] and cameras[2].distance < cameras[0].distance
    assert [bool((p != 255).any()) for p in drawn] == [False, True, False]
    talking.session.transport.seek(2.5)
    talking.performance.timeline.set_cuts("Cut", cuts)
    talking.preview.view.grab()
    aspect = talking.preview.view.width() / talking.preview.view.height()
    filmed = Cutting().camera(seen, cuts, 2.5, aspect)
    assert (talking.preview.view.camera, talking.preview.scene().lamp) == filmed


def test_the_titles_leave_the_cameras_alone(talking):
    view = talking.timeline.lanes
    place = QPoint(20, round(lane(view).center().y()))
    QTest.mouseClick(view, Qt.MouseButton.LeftButton, pos=place)
    assert talking.performance.muted == frozenset()
