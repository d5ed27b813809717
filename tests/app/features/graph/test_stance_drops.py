"""Stances in their strip: reordered, found, and marked as one posture with those of other layers."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, QPointF, QSizeF, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from app.features.graph.graph_layout import MANY, GraphHit, lay_out_canvas
from app.features.graph.stance_drops import EDGE, drop_stance_at
from app.features.graph.stance_finder import StanceFinder
from metagraph.graph import edits


def at(chip, part: float) -> QPointF:
    return QPointF(chip.rect.left() + part * chip.rect.width(), chip.rect.center().y())


def test_the_middle_of_a_chip_merges_and_its_edges_reorder(toy):
    project = toy.project()
    rest, up, far = (toy.id(project, n) for n in ("rest", "up", "far"))
    layout = lay_out_canvas(project, "arms", rest, QSizeF(900, 700))
    chips = {c.stance: c for c in layout.chips}
    drop, hit, mark = drop_stance_at(project, layout, far, at(chips[rest], 0.5))
    assert drop.possible and not drop.reorder and hit.ident == rest and mark is None
    drop, hit, mark = drop_stance_at(project, layout, far, at(chips[rest], EDGE / 2))
    assert (drop.reorder, drop.before, drop.words) == (True, rest, "move *far* before *rest*")
    assert mark is not None and mark.right() < chips[rest].rect.left()
    drop, _, mark = drop_stance_at(project, layout, rest, at(chips[far], 1 - EDGE / 2))
    assert (drop.before, drop.words) == (None, "move *rest* to the end") and mark.left() > chips[
        far
    ].rect.right()
    drop, _, mark = drop_stance_at(project, layout, rest, at(chips[up], EDGE / 2))
    assert not drop.possible and drop.words == "already here" and mark is None
    drop, _, mark = drop_stance_at(project, layout, rest, QPointF(400, 500))
    assert not drop.possible and mark is None


def test_more_stances_than_keys_have_a_chip_that_finds_one(toy):
    project = toy.project()
    for n in range(MANY - 3):
        project = edits.add_stance(project, "arms", f"more {n}")
    size = QSizeF(700, 700)
    few = lay_out_canvas(project, "arms", None, size)
    assert not any(c.finds for c in few.chips)
    many = lay_out_canvas(edits.add_stance(project, "arms", "tenth"), "arms", None, size)
    chip = many.chips[-1]
    assert chip.finds and many.hit(chip.rect.center()) == GraphHit("find")
    assert many.hit(many.chips[-2].rect.center()) == GraphHit("add")
    assert chip.rect.right() <= size.width()


@pytest.mark.window
@pytest.mark.gl
def test_a_stance_dragged_between_two_is_listed_there_in_one_step(toys):
    drive = toys
    rest, up, far = (drive.id(name) for name in ("rest", "up", "far"))
    stances = lambda: list(drive.document.project.graphs["arms"].stances)  # noqa: E731
    steps = drive.document.undo_stack.count()
    rect = next(c.rect for c in drive.canvas.layout_now().chips if c.stance == rest)
    left = drive.canvas, QPoint(round(rect.left() + 3), round(rect.center().y()))
    drive.drag(drive.chip(far), left, lambda: stances() == [far, rest, up])
    assert drive.document.undo_stack.count() == steps + 1
    assert drive.canvas.mark is None and drive.canvas.arrow is None and drive.canvas.drop is None
    drive.do("list_stance_later")  # of far, which the press has shown
    assert stances() == [rest, far, up]
    drive.document.undo()
    drive.document.undo()
    assert stances() == [rest, up, far]


@pytest.mark.window
@pytest.mark.gl
def test_a_stance_is_found_by_typing_and_shown(toys):
    drive = toys
    for n in range(12):
        drive.document.edit("more", lambda p, n=n: edits.add_stance(p, "head", f"tilt {n}"))
    drive.do("find_stance")
    finder = QApplication.activeModalWidget()
    assert isinstance(finder, StanceFinder) and finder.list.count() == 15
    QTest.keyClicks(finder.search, "tilt 1")
    assert finder.list.count() == 3, "tilt 1, tilt 10, tilt 11"
    QTest.keyClick(finder.search, Qt.Key.Key_Down)
    QTest.keyClick(finder.search, Qt.Key.Key_Return)
    assert drive.session.place.layer == "head" and drive.session.place.stance() == drive.id("tilt 10")
    drive.do("find_stance")
    finder = QApplication.activeModalWidget()
    assert isinstance(finder, StanceFinder)
    QTest.keyClicks(finder.search, "nothing is called so")
    assert not finder.list.isVisible() and finder.none.isVisible()
    QTest.keyClick(finder.search, Qt.Key.Key_Return)
    assert finder.isVisible(), "there is nowhere to go"
    finder.reject()


@pytest.mark.window
@pytest.mark.gl
def test_a_stance_marked_as_the_same_is_shown_with_it_on_both_layers(toys):
    from app.features.graph.graph_menus import make_menu_for

    drive = toys
    drive.document.edit("more", lambda p: edits.add_stance(p, "body", "sitting"))
    drive.document.edit("more", lambda p: edits.add_stance(p, "body", "standing"))
    sitting, far = drive.id("sitting"), drive.id("far")
    drive.session.place.set_layer("arms")
    menu = make_menu_for(drive.canvas.acts, GraphHit("chip", far), [])
    same = next(a.menu() for a in menu.actions() if a.text() == "Same as")
    entry = next(a for a in same.actions() if a.text() == "Body: sitting")
    assert not entry.isChecked()
    entry.trigger()
    menu.close()
    assert drive.document.project.stance(far).name == "sitting"
    chip = next(c for c in drive.canvas.layout_now().chips if c.stance == far)
    assert chip.same == "+ body"
    drive.session.place.set_stance(drive.id("standing"))
    drive.session.place.set_layer("arms")
    drive.click(drive.chip(far))
    assert drive.session.place.layer == "arms" and drive.session.place.stance() == far
    assert drive.session.place.stance("body") == sitting
