"""Clips against stances: marks and words, searching and sorting, playing and placing by the real pointer."""

from __future__ import annotations

from math import inf

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QRectF, Qt
from PySide6.QtGui import QColor, QImage, QPainter
from PySide6.QtTest import QTest

from app.features.compatibility.matrix_dialog import MatrixDialog
from app.features.compatibility.matrix_table import (
    CELL,
    CLIP,
    FIRST,
    USES,
    Cell,
    MatrixModel,
    Rows,
    describe_cell,
    describe_half_cell,
    draw_half,
    grade_jump,
)
from app.look.theme import DARK, LIGHT
from app.stage.compatibility_state import extend_matrix
from metagraph.graph import edits
from metagraph.graph.model import Project
from metagraph.suggest.jumps.compatibility import Matrix


def test_half_a_mark_says_how_far_off_it_is():
    assert [grade_jump(c) for c in (0, 1, 1.01, 2.0, 2.01, 1e9, inf)] == [0, 0, 1, 1, 2, 2, 3]
    assert describe_half_cell(0.6, 1.24, "leaves").startswith("leaves at 1.24 s: no jump, 0.6 ")
    assert describe_half_cell(1.8, 0.0, "enters").startswith("enters at 0.00 s: jumps, 1.8 times ")
    assert (
        "does not hide it" in describe_half_cell(4.0, 0.0, "enters")
        and describe_half_cell(inf, 0.0, "enters") == "enters: nothing to compare"
    )


def test_a_cell_is_told_with_what_it_is_placed_as():
    cell = Cell(0.2, 3.0, 0.1, 1.2, ("gesture", "fidget"))
    assert describe_cell(cell, "wave", "idle").split("\n")[0] == "wave  ·  idle"
    assert describe_cell(cell, "wave", "idle").endswith("placed here as gesture and fidget")


@pytest.mark.parametrize("look", [DARK, LIGHT], ids=lambda t: t.name)
def test_marks_tell_by_shape_not_by_colour_alone(look):
    seen = set()
    for side in ("in", "out"):
        for cost in (0.5, 1.5, 5.0, inf):
            image = QImage(32, 32, QImage.Format.Format_RGB32)
            image.fill(QColor(look.field))
            painter = QPainter(image)
            draw_half(painter, look, QRectF(8, 8, 16, 16), side, cost)
            painter.end()
            grey = image.convertToFormat(QImage.Format.Format_Grayscale8)
            ground = QColor(look.field).lightness()
            seen.add(
                tuple(
                    abs(QColor(grey.pixel(x, y)).lightness() - ground) > 40
                    for x in range(32)
                    for y in range(32)
                )
            )
    assert len(seen) == 8


def test_nothing_is_shown_of_nothing(qtbot):
    from PySide6.QtWidgets import QWidget

    parent = QWidget()
    qtbot.addWidget(parent)
    model = MatrixModel(parent)
    assert (model.rowCount(), model.columnCount()) == (0, 0) and model.cell(0, 0) is None
    model.show_rows(Rows.of(Project(), Matrix("arms", (), (), *(np.zeros((0, 0)) for _ in range(4)))))
    assert (model.rowCount(), model.columnCount()) == (0, FIRST)


def test_rows_are_searched_narrowed_and_sorted_by_fit(toy, qtbot):
    from PySide6.QtWidgets import QWidget

    parent = QWidget()
    qtbot.addWidget(parent)
    project = edits.add_clips(toy.project(), [("free.glb", 0, "", toy.clip("free wave", 1.0, 1.4))])
    model = MatrixModel(parent)
    model.show_rows(Rows.of(project, extend_matrix(project, "arms", None)))
    proxy = model
    assert proxy.rowCount() == len(project.clips)
    proxy.narrow("wave", "all")
    assert proxy.rowCount() == 2
    proxy.narrow("", "free")
    assert [proxy.index(0, CLIP).data()] == ["free wave"] and proxy.rowCount() == 1
    proxy.narrow("", "placed")
    assert proxy.rowCount() == len(project.clips) - 1
    proxy.narrow("", "all")
    far = next(
        c
        for c in range(FIRST, model.columnCount())
        if model.headerData(c, Qt.Orientation.Horizontal) == "far"
    )
    proxy.sort(far, Qt.SortOrder.AscendingOrder)
    cells = [proxy.index(r, far).data(CELL) for r in range(proxy.rowCount())]
    fits = [max(cell.enter, cell.leave) for cell in cells]
    assert fits == sorted(fits) and fits[0] <= 1 < fits[-1]
    assert "far loop" in [proxy.index(r, CLIP).data() for r in range(4)]
    model.sort(far, Qt.SortOrder.DescendingOrder)
    assert max(model.cell(0, far).enter, model.cell(0, far).leave) == fits[-1]
    cell = model.index(toy_row(model, project, "far loop"), far).data(CELL)
    assert cell.here == ("stance",)


def toy_row(model, project, name):
    return next(r for r in range(model.rowCount()) if project.clips[model.clip(r)].name == name)


def test_only_new_clips_are_compared_again(toy, monkeypatch):
    from metagraph.suggest.jumps import compatibility

    project = toy.project()
    first = extend_matrix(project, "arms", None)
    asked = []
    real = compatibility.make_compatibility_matrix
    monkeypatch.setattr(
        compatibility,
        "make_compatibility_matrix",
        lambda *a, **k: (asked.append(list(k["clips"])), real(*a, **k))[1],
    )
    more = edits.add_clips(project, [("free.glb", 0, "", toy.clip("free", 1.0, 1.4))])
    clip = {e.name: e.id for e in more.clips.values()}
    fewer = edits.remove_clips(more, [clip["rest long"]])
    second = extend_matrix(fewer, "arms", first)
    assert asked == [[clip["free"]]]
    assert second.clips == tuple(fewer.clips) and second.enter_cost.shape == (len(fewer.clips), 3)
    row, old = second.clips.index(clip["up beat"]), first.clips.index(clip["up beat"])
    assert (second.leave_cost[row] == first.leave_cost[old]).all()


@pytest.fixture
def opened(toys, toy):
    drive = toys
    project = edits.add_clips(drive.document.project, [("free.glb", 0, "", toy.clip("free wave", 1.0, 0.8))])
    drive.document.load(project, None)
    drive.session.place.set_stance(drive.id("rest"))
    drive.wait(lambda: drive.compatibility.judged is not None)
    drive.actions["compatibility"].trigger()
    dialog = drive.window.findChild(MatrixDialog)
    drive.wait(lambda: dialog.model.rows is not None and dialog.model.rowCount() == len(project.clips))
    drive.pause(100)
    drive.dialog = dialog
    return drive


def spot(dialog, project, name, stance):
    model = dialog.model
    column = next(
        c
        for c in range(FIRST, model.columnCount())
        if model.headerData(c, Qt.Orientation.Horizontal) == stance
    )
    index = model.index(toy_row(model, project, name), column)
    dialog.table.scrollTo(index)
    return dialog.table.viewport(), dialog.table.visualRect(index).center()


@pytest.mark.nightly
@pytest.mark.window
@pytest.mark.gl
def test_a_click_plays_a_clip_in_the_context_of_that_stance(opened):
    drive, dialog = opened, opened.dialog
    project = drive.document.project
    clip = next(i for i, e in project.clips.items() if e.name == "free wave")
    widget, at = spot(dialog, project, "free wave", "up")
    QTest.mouseClick(widget, Qt.MouseButton.LeftButton, pos=at)
    assert (drive.session.transport.show, drive.session.transport.shown, drive.session.place.stance()) == (
        "context",
        clip,
        drive.id("up"),
    )
    assert "free wave  ·  up" in dialog.words.text() and "enters at" in dialog.words.text()
    drive.wait(lambda: any(c.action.clip == clip for c in drive.performance.shown.plan.layers["arms"].cues))
    # A clip that is placed elsewhere is tried here as well; where it is placed, its action plays.
    widget, at = spot(dialog, project, "rest wave rt", "far")
    QTest.mouseClick(widget, Qt.MouseButton.LeftButton, pos=at)
    far = drive.id("far")
    drive.wait(lambda: any(c.action.stance == far for c in drive.performance.shown.plan.layers["arms"].cues))
    widget, at = spot(dialog, project, "rest wave rt", "rest")
    QTest.mouseClick(widget, Qt.MouseButton.LeftButton, pos=at)
    assert drive.session.selection.actions == (drive.id("rest wave rt"),) == (drive.session.transport.shown,)
    assert drive.document.undo_stack.count() == 0, "looking changes nothing"


@pytest.mark.nightly
@pytest.mark.window
@pytest.mark.gl
def test_a_double_click_places_with_proposed_times_in_one_step(opened):
    drive, dialog = opened, opened.dialog
    widget, at = spot(dialog, drive.document.project, "free wave", "up")
    QTest.mouseClick(widget, Qt.MouseButton.LeftButton, pos=at)
    QTest.mouseDClick(widget, Qt.MouseButton.LeftButton, pos=at)
    drive.wait(lambda: "free wave" in drive.names("gesture"))
    assert drive.document.undo_stack.count() == 1
    action = drive.action("free wave")
    assert action.stance == drive.id("up") and drive.session.selection.actions == (action.id,)
    drive.wait(lambda: dialog.model.rows.kinds.get((action.clip, action.stance)) == ("gesture",))
    drive.document.undo()
    assert "free wave" not in drive.names()
    # As a transition, by the button, to the stance it leaves to best.
    dialog.kind.setCurrentIndex(dialog.kind.findData("transition"))
    widget, at = spot(dialog, drive.document.project, "free wave", "rest")
    QTest.mouseClick(widget, Qt.MouseButton.LeftButton, pos=at)
    assert "'up'" in dialog.words.text()
    QTest.mouseClick(dialog.go, Qt.MouseButton.LeftButton)
    drive.wait(lambda: "free wave" in drive.names("transition"))
    assert drive.action("free wave").end_stance == drive.id("up")


@pytest.mark.nightly
@pytest.mark.window
@pytest.mark.gl
def test_another_layer_and_no_stance_say_so_and_searching_narrows(opened):
    drive, dialog = opened, opened.dialog
    QTest.keyClicks(dialog.search, "wave")
    assert dialog.model.rowCount() == 2
    dialog.search.clear()
    drive.session.place.set_layer("head")
    assert (
        dialog.model.rows is None
        and "Create a stance first" in dialog.words.text()
        and not dialog.go.isEnabled()
    )
    drive.session.place.set_layer("arms")
    drive.wait(lambda: dialog.model.rows is not None)
    assert dialog.model.index(0, USES).data(CELL) == ("stance",), "what is placed comes first"
    # A click on a stance sorts by fit, and what was chosen stays chosen.
    widget, at = spot(dialog, drive.document.project, "free wave", "up")
    QTest.mouseClick(widget, Qt.MouseButton.LeftButton, pos=at)
    header = dialog.table.horizontalHeader()
    x = header.sectionViewportPosition(FIRST + 2) + 20
    QTest.mouseClick(header.viewport(), Qt.MouseButton.LeftButton, pos=QPoint(x, header.height() // 2))
    assert dialog.model.by == FIRST + 2 and dialog.current()[0] == next(
        i for i, e in drive.document.project.clips.items() if e.name == "free wave"
    )
    drive.session.look.choose("light")
    drive.pause(30)
    drive.actions["compatibility"].trigger()
    assert len(drive.window.findChildren(MatrixDialog)) == 1
    dialog.close()
