"""Transitions pointed at another stance: what it would do in words, then by the real pointer."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, QPointF, QSizeF, Qt
from PySide6.QtTest import QTest

from app.features.graph.graph_layout import GraphHit, lay_out_canvas
from app.features.graph.repoint import repoint_at
from metagraph.graph import edits
from metagraph.graph.model import Project


def test_nothing_is_pointed_at_nothing():
    assert not repoint_at(Project(), ["a1"], GraphHit("nothing")).possible
    assert not repoint_at(Project(), [], GraphHit("chip", "s1")).possible


def test_what_letting_go_does_is_said(toy):
    project = toy.project()
    up, far, rest = (toy.id(project, n) for n in ("up", "far", "rest"))
    way = toy.id(project, "rest to up")
    drop = repoint_at(project, [way], GraphHit("chip", far))
    assert (drop.possible, drop.end) == (True, far) and "*far*" in drop.words
    assert repoint_at(project, [way], GraphHit("chip", up)).words == "already ends in *up*"
    refused = repoint_at(project, [way], GraphHit("chip", rest))
    assert not refused.possible and "another stance" in refused.words
    assert not repoint_at(project, [way], GraphHit("node", None, "gesture")).possible
    two = [way, toy.id(project, "far to up")]
    assert not repoint_at(project, two, GraphHit("chip", far)).possible, "one of them starts there"
    assert repoint_at(
        project, [toy.id(project, "up to far"), toy.id(project, "up to rest")], GraphHit("chip", rest)
    ).words.startswith("release to end 2 transitions")


def test_only_transitions_have_an_arrow_to_drag(toy):
    project = toy.project()
    layout = lay_out_canvas(project, "arms", toy.id(project, "rest"), QSizeF(1000, 800))
    for node in layout.nodes.values():
        for row in node.rows:
            at = QPointF(row.rect.left() + 8, row.rect.center().y())
            assert layout.hit(at).area == ("head" if node.kind == "transition" else "row")
            assert layout.hit(at, dragging=True).area == "row", "a drop on it is a drop on the row"
            assert layout.hit(QPointF(row.rect.left() + 40, row.rect.center().y())).area == "row"


def head(drive, action: str) -> tuple:
    rect = drive.canvas.layout_now().row(action).head
    return drive.canvas, QPoint(round(rect.center().x()), round(rect.center().y()))


@pytest.mark.nightly
@pytest.mark.window
@pytest.mark.gl
def test_an_arrow_dragged_onto_a_stance_ends_there_in_one_step(toys):
    drive = toys
    drive.session.place.set_stance(drive.id("rest"))
    way, far = drive.id("rest to up"), drive.id("far")
    drive.pause(100)
    steps = drive.document.undo_stack.count()
    drive.drag(
        head(drive, way), drive.chip(far), lambda: drive.document.project.action(way).end_stance == far
    )
    assert drive.document.undo_stack.count() == steps + 1
    assert drive.document.project.action(way).stance == drive.id("rest")
    assert drive.canvas.arrow is None and drive.canvas.drop is None
    drive.document.undo()
    assert drive.document.project.action(way).end_stance == drive.id("up")


@pytest.mark.nightly
@pytest.mark.window
@pytest.mark.gl
def test_all_selected_transitions_follow_and_a_stance_that_cannot_be_the_end_is_refused(toys):
    drive = toys
    project = edits.place_clips(
        drive.document.project,
        [drive.action("up to far").clip],
        "arms",
        "transition",
        drive.id("up"),
        drive.id("far"),
    )
    drive.document.load(project, None)
    drive.session.place.set_stance(drive.id("up"))
    ways = [a.id for a in project.graphs["arms"].of(drive.id("up"), "transition")]
    assert len(ways) == 3
    drive.pause(100)
    for way in ways:
        drive.click(drive.row(way), Qt.KeyboardModifier.ControlModifier)
    assert set(drive.session.selection.actions) == set(ways)
    rest = drive.id("rest")
    ends = lambda: {drive.document.project.action(w).end_stance for w in ways}  # noqa: E731
    widget, start = head(drive, ways[0])
    # Onto the stance they start in: refused in words, nothing happens.
    QTest.mousePress(widget, Qt.MouseButton.LeftButton, pos=start)
    QTest.mouseMove(widget, drive.chip(drive.id("up"))[1])
    drive.pause(30)
    assert not drive.canvas.drop.possible and drive.canvas.arrow is not None
    QTest.mouseRelease(widget, Qt.MouseButton.LeftButton, pos=drive.chip(drive.id("up"))[1])
    assert len(drive.told) == 1 and "another stance" in drive.told[0]
    assert drive.document.undo_stack.count() == 0
    for way in ways:
        if way not in drive.session.selection.actions:
            drive.click(drive.row(way), Qt.KeyboardModifier.ControlModifier)
    drive.drag(head(drive, ways[0]), drive.chip(rest), lambda: ends() == {rest})
    assert drive.document.undo_stack.count() == 1


@pytest.mark.window
@pytest.mark.gl
def test_escape_gives_a_drag_up_and_a_click_on_the_arrow_plays(toys):
    drive = toys
    drive.session.place.set_stance(drive.id("rest"))
    way = drive.id("rest to up")
    drive.pause(100)
    widget, start = head(drive, way)
    QTest.mousePress(widget, Qt.MouseButton.LeftButton, pos=start)
    QTest.mouseMove(widget, drive.chip(drive.id("far"))[1])
    drive.pause(30)
    assert drive.canvas.drop is not None and "*far*" in drive.canvas.drop.words
    QTest.keyClick(widget, Qt.Key.Key_Escape)
    assert drive.canvas.drop is None and drive.canvas.hand.gesture is None
    QTest.mouseRelease(widget, Qt.MouseButton.LeftButton, pos=drive.chip(drive.id("far"))[1])
    assert drive.document.project.action(way).end_stance == drive.id("up")
    drive.click(head(drive, way))
    assert drive.session.transport.show == "context" and drive.session.transport.shown == way


@pytest.mark.window
@pytest.mark.gl
def test_the_properties_repoint_several_transitions_at_once(toys):
    drive = toys
    ways = tuple(a.id for a in drive.document.project.graphs["arms"].of(drive.id("up"), "transition"))
    drive.session.selection.select_actions(ways)
    box = drive.properties.action.ends
    assert box.isVisibleTo(drive.properties)
    place = next(n for n in range(box.count()) if box.itemData(n) == drive.id("far"))
    box.activated.emit(place)
    assert {drive.document.project.action(w).end_stance for w in ways} == {drive.id("far")}
    assert drive.document.undo_stack.count() == 1
