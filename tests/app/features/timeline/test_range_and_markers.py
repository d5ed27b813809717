"""The range that is played again and again, markers, snapping, zoom, locks and heights: by mouse and keys."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, QPointF, QSettings, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QInputDialog

from app.features.timeline.snapping import SnapLine, find_nearest_line
from app.widgets.lane_geometry import LEFT, NUMBERS, RULER, place_lanes
from metagraph.graph import requests as a

LEFT_BUTTON, NONE, SHIFT = (
    Qt.MouseButton.LeftButton,
    Qt.KeyboardModifier.NoModifier,
    Qt.KeyboardModifier.ShiftModifier,
)
STRIP = (NUMBERS + RULER) // 2


@pytest.fixture
def stage(toys):
    toys.session.transport.set_playing(False)
    toys.timeline.new()
    for ask in (a.Gesture(at=2.0), a.Nod(at=4.0), a.Gesture(at=9.0)):
        toys.performance.requests.ask(ask)
    toys.session.onstage.select_requests(())
    toys.session.transport.show_plan()
    toys.wait(lambda: toys.performance.shown.clip is None and len(toys.performance.answers()) == 3)
    lanes_ = toys.timeline.lanes
    lanes_.each, lanes_.first = 40.0, 0.0
    yield toys
    lanes_.magnet.set_on(True)
    lanes_.set_sizes(type(lanes_.sizes)())
    toys.performance.requests.ripple = False


def drag(view, start, end, modifiers=NONE):
    QTest.mousePress(view, LEFT_BUTTON, modifiers, start)
    for n in (1, 2, 3):
        view.hand  # noqa: B018
        QTest.mouseMove(view, start + (end - start) * n / 3)
        _move(view, start + (end - start) * n / 3, modifiers)
    QTest.mouseRelease(view, LEFT_BUTTON, modifiers, end)


def _move(view, at, modifiers):
    """A move with the button and keys held, which QTest's does not tell."""
    from PySide6.QtCore import QEvent
    from PySide6.QtGui import QMouseEvent
    from PySide6.QtWidgets import QApplication

    event = QMouseEvent(
        QEvent.Type.MouseMove,
        QPointF(at),
        view.mapToGlobal(QPointF(at)),
        Qt.MouseButton.NoButton,
        LEFT_BUTTON,
        modifiers,
    )
    QApplication.sendEvent(view, event)


def x(view, seconds, y=STRIP):
    return QPoint(round(view.scale().x(seconds)), round(y))


def test_a_range_is_dragged_on_the_ruler_and_played_again_and_again(stage):
    view, timeline = stage.timeline.lanes, stage.performance.timeline
    drag(view, x(view, 3.0), x(view, 6.02))
    assert timeline.range == pytest.approx((3.0, 6.0), abs=0.03)
    drag(view, x(view, 6.0), x(view, 7.0))
    assert timeline.range[1] == pytest.approx(7.0, abs=0.03), "its end alone"
    stage.session.transport.seek(6.9)
    stage.session.transport.set_playing(True)
    stage.playhead.advance(0.25)
    stage.session.transport.set_playing(False)
    assert stage.session.transport.seconds == pytest.approx(timeline.range[0] + 0.15, abs=0.06)
    stage.document.undo()
    stage.document.undo()
    assert timeline.range is None


def test_i_and_o_set_the_range_and_what_is_beyond_it_plays_on(stage):
    timeline, transport = stage.performance.timeline, stage.session.transport
    transport.seek(2.0)
    stage.do("range_in")
    transport.seek(5.0)
    stage.do("range_out")
    assert timeline.range == (2.0, 5.0)
    transport.seek(8.0)
    transport.set_playing(True)
    stage.playhead.advance(0.2)
    transport.set_playing(False)
    assert transport.seconds == pytest.approx(8.2, abs=0.01)
    stage.do("range_clear")
    assert timeline.range is None and stage.document.project.timelines == {}


def test_the_range_can_be_written_alone(stage, monkeypatch):
    from app.features.render import render_dialog

    stage.performance.timeline.set_range(2.0, 5.0)
    dialog = render_dialog.RenderDialog(stage.performance, stage.session, stage.jobs, stage.window)
    assert dialog.part.currentText() == "Loop range, 2.00 to 5.00 s" and dialog.seconds.isHidden()
    orders = []
    monkeypatch.setattr(
        render_dialog, "write_rendering", lambda project, folder, order, job: orders.append(order)
    )
    monkeypatch.setattr(dialog, "_done", lambda path: None)
    dialog._write()
    stage.wait(lambda: bool(orders))
    assert (orders[0].start, orders[0].seconds) == (2.0, 3.0)
    dialog.part.setCurrentIndex(0)
    dialog._suffixed()
    assert not dialog.seconds.isHidden()
    stage.wait(lambda: not stage.jobs.running)
    dialog.close()


def test_what_is_written_begins_at_the_start_or_at_the_playhead(stage, monkeypatch):
    from app.features.render import render_dialog

    orders = []
    monkeypatch.setattr(
        render_dialog, "write_rendering", lambda project, folder, order, job: orders.append(order)
    )
    stage.session.transport.seek(4.0)
    dialog = render_dialog.RenderDialog(stage.performance, stage.session, stage.jobs, stage.window)
    monkeypatch.setattr(dialog, "_done", lambda path: None)
    words = [dialog.part.itemText(n) for n in range(dialog.part.count())]
    assert words == ["From the start", "From the playhead, 4.00 s"]
    dialog.seconds.setValue(3.0)
    for place in (0, 1):
        dialog.part.setCurrentIndex(place)
        dialog._write()
        stage.wait(lambda: len(orders) == place + 1)  # noqa: B023
        stage.wait(lambda: not stage.jobs.running)
    assert [(order.start, order.seconds) for order in orders] == [(0.0, 3.0), (4.0, 3.0)]
    dialog.close()


def test_markers_are_added_named_moved_gone_to_and_removed(stage, monkeypatch):
    view, timeline, transport = stage.timeline.lanes, stage.performance.timeline, stage.session.transport
    transport.seek(3.0)
    view.setFocus()
    QTest.keyClick(view, Qt.Key.Key_M)
    assert [m.at for m in timeline.now.markers] == [3.0] and timeline.marker == timeline.now.markers[0].id
    monkeypatch.setattr(QInputDialog, "getText", lambda *_, **__: ("Punch  line", True))
    QTest.mouseDClick(view, LEFT_BUTTON, NONE, x(view, 3.0))
    assert timeline.now.markers[0].name == "Punch line"
    drag(view, x(view, 3.0), x(view, 5.5), SHIFT)
    assert timeline.now.markers[0].at == pytest.approx(5.5, abs=0.03)
    transport.seek(0.5)
    stage.do("marker")
    stage.do("marker_next")
    assert transport.seconds == timeline.now.markers[1].at
    stage.do("marker_before")
    assert transport.seconds == 0.5 and timeline.selected.at == 0.5
    stage.do("delete")
    assert [m.name for m in timeline.now.markers] == ["Punch line"]
    assert "double-click to rename" in view.tip(QPointF(x(view, 5.5)))


def test_a_clip_alone_has_no_markers_and_no_range_and_says_so(stage):
    view, timeline, transport = stage.timeline.lanes, stage.performance.timeline, stage.session.transport
    timeline.add_marker(6.0)
    clip = next(iter(stage.document.project.clips))
    transport.show_clip(clip)
    transport.set_playing(False)
    stage.wait(lambda: stage.performance.shown.clip == clip)
    said = []
    stage.document.failed.connect(said.append)
    machine = stage.actions["machine"].isChecked()
    view.setFocus()
    QTest.keyClick(view, Qt.Key.Key_M)
    assert len(timeline.now.markers) == 1 and "Esc" in said[-1]
    assert stage.actions["machine"].isChecked() == machine, "the key is the timeline's, not the machine's"
    length = stage.performance.shown.length
    QTest.mouseClick(view, LEFT_BUTTON, NONE, x(view, length + 5.0))
    assert transport.seconds == pytest.approx(length)
    assert not any(stage.actions[name].isEnabled() for name in ("range_in", "range_out", "marker"))
    stage.do("marker_next")
    assert transport.show == "plan"
    assert stage.actions["range_in"].isEnabled()


def test_markers_are_moved_and_renamed_and_layers_locked_by_keys(stage, monkeypatch):
    view, timeline = stage.timeline.lanes, stage.performance.timeline
    timeline.add_marker(3.0)
    view.setFocus()
    for key, held in ((Qt.Key.Key_Right, NONE), (Qt.Key.Key_Right, SHIFT), (Qt.Key.Key_Left, NONE)):
        QTest.keyClick(view, key, held)
    assert timeline.now.markers[0].at == pytest.approx(4.0)
    monkeypatch.setattr(QInputDialog, "getText", lambda *_, **__: ("Turn", True))
    stage.do("rename")
    assert timeline.now.markers[0].name == "Turn"
    stage.document.undo()
    stage.document.undo()
    assert timeline.now.markers[0].at == 3.0, "a run of keys is one step"
    layer = stage.session.place.layer
    stage.do("lock_layer")
    assert timeline.now.locked == (layer,)
    stage.do("lane_taller")
    assert view.sizes.factor(layer) == pytest.approx(1.3)
    stage.do("lane_lower")
    assert view.sizes.factor(layer) == 1.0


def test_a_dragged_request_holds_to_a_marker_and_shift_lets_it_go(stage):
    view, timeline = stage.timeline.lanes, stage.performance.timeline
    timeline.add_marker(6.13)
    timeline.select(None)
    mark = next(m for m in view.marks() if m.at == 4.0)
    start = QPoint(round(mark.rect.left()) + 4, round(mark.rect.center().y()))
    by = round((6.2 - 4.0) * view.each)
    drag(view, start, start + QPoint(by, 0))
    ident = mark.ask.id
    at = lambda: next(x.at for x in stage.performance.asks if x.id == ident)  # noqa: E731
    assert at() == 6.13
    stage.document.undo()
    drag(view, start, start + QPoint(by, 0), SHIFT)
    assert at() == pytest.approx(6.2, abs=0.02) and at() != 6.13
    assert view.magnet.line is None


def test_the_nearest_line_is_held_to_and_seconds_only_where_nothing_else_is():
    lines = [SnapLine(2.0, "2 s", True), SnapLine(2.2, "stroke"), SnapLine(5.0, "word")]
    assert find_nearest_line(2.05, lines, 0.2).what == "stroke"
    assert find_nearest_line(1.9, lines, 0.2).what == "2 s"
    assert find_nearest_line(3.5, lines, 0.2) is None and find_nearest_line(3.5, [], 9.0) is None


def test_the_timeline_zooms_to_all_and_to_what_is_selected(stage):
    view = stage.timeline.lanes
    view.zoom_all()
    assert view.first == 0 and view.scale().x(stage.performance.shown.length) <= view.width()
    stage.session.onstage.select_requests(tuple(m.ask.id for m in view.marks() if m.at < 5))
    stage.do("timeline_selection")
    scale = view.scale()
    assert scale.seconds(LEFT) <= 2.0 and scale.seconds(view.width()) >= 4.0 and view.each > 40


def test_what_is_on_a_locked_layer_stays_and_the_padlock_opens_it(stage):
    view, requests = stage.timeline.lanes, stage.performance.requests
    lock = QPoint(LEFT - 8, round(place_lanes(view.height(), view.sizes)["arms"].center().y()))
    QTest.mouseClick(view, LEFT_BUTTON, NONE, lock)
    assert stage.performance.timeline.now.locked == ("arms",) and "is locked" in view.tip(QPointF(lock))
    gesture = next(m for m in view.marks() if m.at == 2.0)
    start = QPoint(round(gesture.rect.left()) + 4, round(gesture.rect.center().y()))
    before = stage.performance.asks
    drag(view, start, start + QPoint(120, 0))
    stage.session.onstage.select_requests((gesture.ask.id,))
    stage.do("delete")
    assert stage.performance.asks == before and "locked" in stage.told[-1]
    requests.withdraw(*(x.id for x in before))
    assert [type(x).__name__ for x in stage.performance.asks] == ["Gesture", "Gesture"]
    QTest.mouseClick(view, LEFT_BUTTON, NONE, lock)
    requests.withdraw(gesture.ask.id)
    assert len(stage.performance.asks) == 1
    stage.told.clear()


def test_a_lane_is_made_taller_by_its_border_or_its_menu_and_stays_so(stage):
    view = stage.timeline.lanes
    before = place_lanes(view.height(), view.sizes)["arms"].height()
    bottom = round(place_lanes(view.height(), view.sizes)["arms"].bottom())
    drag(view, QPoint(30, bottom), QPoint(30, bottom + 18))
    after = place_lanes(view.height(), view.sizes)["arms"]
    assert after.bottom() == pytest.approx(bottom + 18, abs=2) and after.height() > before + 15
    assert "arms" in str(QSettings().value("timeline/heights"))
    compact = next(x for x in view.titles.menu("arms").actions() if x.text() == "Compact")
    compact.trigger()
    assert place_lanes(view.height(), view.sizes)["arms"].height() < before
    view.titles.size(None, 1.0)
    assert place_lanes(view.height(), view.sizes)["arms"].height() == pytest.approx(before)


def test_ripple_moves_and_closes_up_in_one_step(stage):
    view, requests = stage.timeline.lanes, stage.performance.requests
    times = lambda: [x.at for x in stage.performance.asks]  # noqa: E731
    stage.timeline.ripple.setChecked(True)
    nod = next(m for m in view.marks() if m.at == 4.0)
    start = QPoint(round(nod.rect.left()) + 4, round(nod.rect.center().y()))
    drag(view, start, start + QPoint(40, 0), SHIFT)
    assert times() == pytest.approx([2.0, 5.0, 10.0], abs=0.02)
    stage.document.undo()
    assert times() == [2.0, 4.0, 9.0]
    stage.timeline.ripple.setChecked(False)
    cues = [c for of in stage.performance.shown.plan.layers.values() for c in of.cues]
    gesture = next(m for m in view.marks() if m.at == 2.0)
    cue = next(c for c in cues if c.meta.partition("+")[0] == gesture.ask.id)
    stage.session.onstage.select_requests((gesture.ask.id,))
    view.setFocus()
    QTest.keyClick(view, Qt.Key.Key_Delete, SHIFT)
    gone = cue.end - min(2.0, cue.start)
    assert times() == pytest.approx([max(2.0, 4.0 - gone), 9.0 - gone], abs=0.01)
    stage.document.undo()
    assert times() == [2.0, 4.0, 9.0] and not requests.ripple


def test_depth_of_field_is_written_only_with_something_behind_the_character(stage, monkeypatch):
    from app.features.render import render_dialog

    dialog = render_dialog.RenderDialog(stage.performance, stage.session, stage.jobs, stage.window)
    orders = []
    monkeypatch.setattr(
        render_dialog, "write_rendering", lambda project, folder, order, job: orders.append(order)
    )
    monkeypatch.setattr(dialog, "_done", lambda path: None)
    dialog.blurred.setChecked(True)
    for kind in (".mp4", ".mov"):
        dialog.kind.setCurrentIndex(dialog.kind.findData(kind))
        dialog._suffixed()
        dialog._write()
        stage.wait(lambda: not stage.jobs.running)
    assert [order.blurred for order in orders] == [True, False]
    assert not dialog.blurred.isEnabled()
    dialog.close()
