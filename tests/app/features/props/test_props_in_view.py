"""Props are chosen, moved, turned and resized with the mouse in the view of the character."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh
from PySide6.QtCore import QEvent, QPoint, QPointF, Qt
from PySide6.QtGui import QMouseEvent, QWheelEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from metagraph.graph.editing.props import add_prop
from metagraph.graph.prop import Prop

pytestmark = [pytest.mark.window, pytest.mark.gl]
NONE, LEFT = Qt.KeyboardModifier.NoModifier, Qt.MouseButton.LeftButton
SHIFT, CTRL, ALT = (
    Qt.KeyboardModifier.ShiftModifier,
    Qt.KeyboardModifier.ControlModifier,
    Qt.KeyboardModifier.AltModifier,
)
AT = (0.7, 0.0, 0.2)


class Room:
    """The view, with a box that stands beside the character."""

    def __init__(self, drive, path: Path) -> None:
        self.drive = drive
        project, self.ident = add_prop(drive.document.project, Prop(name="box", path=str(path), at=AT))
        drive.document.load(project, None)
        self.view = drive.preview.view
        drive.wait(lambda: any(a.figure.skeleton.names == ("Prop",) for a in drive.preview.scene().actors))
        self.view.camera = self.view.camera.facing(0.3, 0.35).zoom(-4)
        self.view.moved_by_hand = True
        self.view.grab()
        self.feature = next(child for child in drive.preview.children() if type(child).__name__ == "PropHand")

    @property
    def prop(self) -> Prop:
        return self.drive.document.project.props[self.ident]

    @property
    def chosen(self) -> str:
        return self.feature.placing.ident

    def see(self, *point: float) -> QPointF:
        found = self.feature.to_pixels(point)
        assert found is not None
        return found

    def click(self, at: QPointF) -> None:
        QTest.mouseClick(self.view, LEFT, NONE, at.toPoint())

    def press(self, at: QPointF, modifier=NONE) -> None:
        QTest.mousePress(self.view, LEFT, modifier, at.toPoint())

    def move(self, at: QPointF, modifier=NONE) -> None:
        event = QMouseEvent(
            QEvent.Type.MouseMove,
            at,
            QPointF(self.view.mapToGlobal(at.toPoint())),
            Qt.MouseButton.NoButton,
            LEFT,
            modifier,
        )
        QApplication.sendEvent(self.view, event)

    def drag(self, start: QPointF, end: QPointF, modifier=NONE) -> None:
        self.press(start, modifier)
        for at in ((start + end) / 2, end):
            self.move(at, modifier)
        QTest.mouseRelease(self.view, LEFT, modifier, end.toPoint())

    @property
    def steps(self) -> int:
        return self.drive.document.undo_stack.count()


@pytest.fixture
def room(toys, tmp_path):
    box = trimesh.creation.box((0.5, 0.5, 0.4))
    box.apply_translation((0, 0.25, 0))
    (tmp_path / "box.stl").write_bytes(box.export(file_type="stl"))
    toys.preview.bones = False
    return Room(toys, tmp_path / "box.stl")


def test_a_click_chooses_a_prop_and_a_click_beside_it_none(room):
    assert room.chosen == "" and not room.feature.marks.isVisibleTo(room.view)
    plain = room.view.grab().toImage()
    camera = room.view.camera
    room.click(room.see(0.7, 0.25, 0.2))
    assert room.chosen == room.ident and room.feature.marks.isVisibleTo(room.view)
    assert room.view.grab().toImage() != plain, "its box and handles are drawn"
    assert room.view.camera == camera and room.steps == 0
    room.click(QPointF(4, 4))
    assert room.chosen == "" and not room.feature.marks.isVisibleTo(room.view)


def test_a_drag_over_a_prop_that_is_not_chosen_moves_the_camera(room):
    camera, start = room.view.camera, room.see(0.7, 0.25, 0.2)
    room.drag(start, start + QPointF(60, 0))
    assert room.view.camera != camera and room.prop.at == AT and room.chosen == ""


def test_a_drag_moves_the_chosen_prop_along_the_floor_and_is_one_step(room):
    camera = room.view.camera
    room.click(room.see(0.7, 0.25, 0.2))
    room.drag(room.see(0.7, 0.5, 0.2), room.see(-0.31, 0.5, 0.62))
    assert room.prop.at == pytest.approx((-0.3, 0.0, 0.6), abs=0.051), "what is taken stays below the mouse"
    assert np.allclose(np.array(room.prop.at) / 0.05, np.round(np.array(room.prop.at) / 0.05), atol=1e-3)
    assert room.steps == 1 and room.view.camera == camera
    assert room.drive.document.undo_stack.undoText().startswith("Move box")
    drawn = next(a for a in room.drive.preview.scene().actors if a.figure.skeleton.names == ("Prop",))
    np.testing.assert_allclose(drawn.positions[0], room.prop.at, atol=1e-6)
    room.drag(room.see(*(np.add(room.prop.at, (0, 0.5, 0)))), room.see(0.517, 0.5, 0.333), ALT)
    assert room.steps == 2 and room.prop.at[0] % 0.05 > 1e-3, "Alt: no snapping"
    room.drive.document.undo()
    room.drive.document.undo()
    assert room.prop.at == AT


def test_escape_takes_a_drag_back_and_leaves_no_step(room):
    room.click(room.see(0.7, 0.25, 0.2))
    room.press(room.see(0.7, 0.5, 0.2))
    room.move(room.see(0.2, 0.5, 0.9))
    assert room.prop.at != AT
    QTest.keyClick(room.view, Qt.Key.Key_Escape)
    assert room.prop.at == AT and room.steps == 0 and room.chosen == room.ident
    room.move(room.see(0.0, 0.5, 0.9))
    assert room.prop.at == AT
    QTest.mouseRelease(room.view, LEFT, NONE, QPoint(5, 5))


def test_shift_or_the_dot_turns_it(room):
    room.click(room.see(0.7, 0.25, 0.2))
    room.drag(room.see(0.7, 0.1, 0.4), room.see(1.1, 0.1, 0.2), SHIFT)
    assert room.prop.turn[1] % 15 == 0 and 60 <= room.prop.turn[1] <= 120 and room.prop.at == AT
    assert room.drive.document.undo_stack.undoText().startswith("Turn box")
    before = room.prop.turn[1]
    room.drag(room.feature.find_handles()["turn"], room.see(0.7, 0.0, 0.9))
    assert room.prop.turn[1] == pytest.approx(before - 90, abs=16) and room.steps == 2


def test_ctrl_the_square_and_the_wheel_resize_it(room):
    room.click(room.see(0.7, 0.25, 0.2))
    start = room.see(0.7, 0.25, 0.2)
    room.drag(start, start + QPointF(60, -60), CTRL)
    assert room.prop.scale == pytest.approx(2.0) and room.steps == 1
    start = room.feature.find_handles()["scale"]
    room.drag(start, start + QPointF(-40, 80))
    assert room.prop.scale == pytest.approx(1.0) and room.steps == 2
    camera = room.view.camera
    for _ in range(2):
        turn_wheel(room.view, room.see(0.7, 0.25, 0.2), 120, CTRL)
    assert room.prop.scale == pytest.approx(1.05**2, abs=1e-3) and room.view.camera == camera
    assert room.steps == 3, "notches in a row are one step"
    turn_wheel(room.view, room.see(0.7, 0.25, 0.2), 120, NONE)
    assert room.view.camera != camera and room.prop.scale == pytest.approx(1.05**2, abs=1e-3)


def test_what_is_dragged_onto_a_larger_prop_lies_on_it(room, tmp_path):
    (tmp_path / "cup.stl").write_bytes(trimesh.creation.box((0.1, 0.1, 0.1)).export(file_type="stl"))
    document = room.drive.document
    project, cup = add_prop(
        document.project, Prop(name="cup", path=str(tmp_path / "cup.stl"), at=(0.1, 0.0, 0.8))
    )
    document.load(project, None)
    room.drive.wait(lambda: len(room.feature.meshes.meshes) == 2)
    room.view.grab()
    room.click(room.see(0.1, 0.0, 0.8))
    assert room.chosen == cup
    room.drag(room.see(0.1, 0.0, 0.8), room.see(0.7, 0.0, 0.25))
    assert document.project.props[cup].at == pytest.approx((0.7, 0.5, 0.25), abs=0.051)


def test_the_panel_and_the_view_choose_the_same_prop(room):
    room.drive.shell.show("props")
    panel = room.drive.shell.panel("props")
    room.click(room.see(0.7, 0.25, 0.2))
    assert panel.current == room.ident
    QTest.mouseClick(panel.remove_button, LEFT)
    assert room.chosen == "" and not room.feature.marks.isVisibleTo(room.view)
    room.drive.document.undo()
    room.drive.docks["props"].close()


def test_a_prop_behind_the_character_is_not_taken_through_it(room):
    document = room.drive.document
    behind = document.project.props[room.ident]
    import msgspec

    from metagraph.graph.editing.props import set_prop

    document.edit(
        "x",
        lambda p: set_prop(p, room.ident, msgspec.structs.replace(behind, at=(0, 0, -1.5), scale=4.0)),
    )
    room.view.grab()
    _, _, places = room.drive.preview.drawn
    chest = places[len(places) // 2]
    joints = [room.see(*place) for place in (places.mean(0), chest)]
    far = room.see(-0.8, 1.0, -0.7)
    assert room.feature.find_prop(far) == room.ident
    assert any(room.feature.find_prop(at) == "" for at in joints)


def turn_wheel(view, at: QPointF, angle: int, modifier) -> None:
    event = QWheelEvent(
        at,
        QPointF(view.mapToGlobal(at.toPoint())),
        QPoint(),
        QPoint(0, angle),
        Qt.MouseButton.NoButton,
        modifier,
        Qt.ScrollPhase.NoScrollPhase,
        False,
    )
    QApplication.sendEvent(view, event)
