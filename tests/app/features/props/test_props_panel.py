"""The props panel: files come in, props are moved with mouse, keys and numbers, carried and removed."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import trimesh
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QFileDialog

from metagraph.formats.store import open_project
from metagraph.graph.editing.props import add_prop
from metagraph.graph.prop import Prop
from metagraph.graph.seats import find_seat

pytestmark = [pytest.mark.window, pytest.mark.gl]


@pytest.fixture
def box(tmp_path: Path) -> Path:
    path = tmp_path / "box.stl"
    path.write_bytes(trimesh.creation.box((0.6, 0.6, 0.4)).export(file_type="stl"))
    return path


@pytest.fixture
def panel(toys):
    toys.shell.show("props")
    out = toys.shell.panel("props")
    yield out
    toys.docks["props"].close()


def only(panel) -> Prop:
    (prop,) = panel.document.project.props.values()
    return prop


def put(toys, panel, box: Path) -> Prop:
    panel.add([box])
    toys.wait(lambda: bool(panel.document.project.props))
    toys.wait(lambda: bool(panel.figures.props.meshes.meshes) and panel.plan.width() > 100)
    return only(panel)


def drag(plan, start: QPointF, end: QPointF, modifier=Qt.KeyboardModifier.NoModifier) -> None:
    middle = (start + end) / 2
    QTest.mousePress(plan, Qt.MouseButton.LeftButton, modifier, start.toPoint())
    for at in (middle, end):
        move(plan, at, modifier)
    QTest.mouseRelease(plan, Qt.MouseButton.LeftButton, modifier, end.toPoint())


def move(plan, at: QPointF, modifier) -> None:
    from PySide6.QtCore import QEvent
    from PySide6.QtGui import QMouseEvent
    from PySide6.QtWidgets import QApplication

    everywhere = plan.mapToGlobal(at.toPoint())
    event = QMouseEvent(
        QEvent.Type.MouseMove,
        at,
        QPointF(everywhere),
        Qt.MouseButton.NoButton,
        Qt.MouseButton.LeftButton,
        modifier,
    )
    QApplication.sendEvent(plan, event)


def test_files_are_added_as_one_step_and_bad_ones_are_said(toys, panel, box, tmp_path, monkeypatch):
    bad = tmp_path / "bad.obj"
    bad.write_text("nothing", "utf-8")
    monkeypatch.setattr(QFileDialog, "getOpenFileNames", lambda *_: ([str(box), str(bad), str(box)], "Props"))
    assert panel.empty.isVisibleTo(panel) and not panel.list.isVisibleTo(panel)
    toys.do("prop")
    toys.wait(lambda: len(panel.document.project.props) == 2)
    toys.wait(lambda: any("bad.obj" in words for words in toys.told))
    first, second = panel.document.project.props.values()
    assert first.name == "box" and first.at != second.at, "one does not hide the other"
    assert panel.document.undo_stack.undoText() == "Add 2 props"
    panel.document.undo()
    assert panel.document.project.props == {} and panel.empty.isVisibleTo(panel)


def test_a_file_dropped_on_the_window_is_a_prop(toys, panel, box):
    assert toys.drop_files((toys.window, QPoint(400, 300)), box)
    toys.wait(lambda: bool(panel.document.project.props))
    assert only(panel).name == "box"


def test_a_prop_is_dragged_over_the_floor_and_is_one_step(toys, panel, box):
    prop = put(toys, panel, box)
    steps = panel.document.undo_stack.count()
    start = panel.plan.to_pixels(prop.at[0], prop.at[2])
    end = panel.plan.to_pixels(-0.512, 0.731)
    drag(panel.plan, start, end)
    assert only(panel).at == pytest.approx((-0.5, 0, 0.75), abs=0.051), "it snaps to 5 cm"
    assert only(panel).at[0] % 0.05 == pytest.approx(0, abs=1e-6) or only(panel).at[
        0
    ] % 0.05 == pytest.approx(0.05)
    assert panel.document.undo_stack.count() == steps + 1
    panel.document.undo()
    assert only(panel) == prop


def test_the_dot_turns_a_prop_and_alt_does_not_snap(toys, panel, box):
    prop = put(toys, panel, box)
    outline = panel.plan.find_outline(prop)
    assert outline.handle.y() > outline.corners.boundingRect().bottom(), "its front is towards the viewer"
    right = panel.plan.to_pixels(prop.at[0] + 0.5, prop.at[2] + 0.02)
    drag(panel.plan, outline.handle, right)
    assert only(panel).turn == (0, 90, 0)
    drag(
        panel.plan,
        panel.plan.find_outline(only(panel)).handle,
        panel.plan.to_pixels(prop.at[0] + 0.3, prop.at[2] + 0.4),
        Qt.KeyboardModifier.AltModifier,
    )
    assert 30 < only(panel).turn[1] < 45 and only(panel).turn[1] % 15 != 0


def test_escape_ends_a_drag_with_the_prop_where_it_was(toys, panel, box):
    prop = put(toys, panel, box)
    start = panel.plan.to_pixels(prop.at[0], prop.at[2])
    QTest.mousePress(panel.plan, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, start.toPoint())
    move(panel.plan, start + QPointF(60, 40), Qt.KeyboardModifier.NoModifier)
    assert only(panel).at != prop.at
    QTest.keyClick(panel.plan, Qt.Key.Key_Escape)
    assert only(panel).at == prop.at


def test_arrow_keys_move_the_chosen_prop_by_five_centimetres(toys, panel, box):
    prop = put(toys, panel, box)
    QTest.keyClick(panel.plan, Qt.Key.Key_Left)
    QTest.keyClick(panel.plan, Qt.Key.Key_Down)
    assert only(panel).at == pytest.approx((prop.at[0] - 0.05, 0, prop.at[2] + 0.05))


def test_numbers_place_turn_and_resize_it(toys, panel, box):
    put(toys, panel, box)
    panel.numbers["at", 1].setValue(0.75)
    panel.numbers["turn", 1].setValue(45)
    panel.numbers["scale", 0].setValue(0.5)
    prop = only(panel)
    assert (prop.at[1], prop.turn[1], prop.scale) == (0.75, 45, 0.5)
    assert panel.document.undo_stack.undoText() == "Resize box"


def test_a_joint_carries_it_from_its_palm_and_it_is_put_down_again(toys, panel, box):
    put(toys, panel, box)
    joint = panel.joint.itemData(1)
    panel.joint.setCurrentIndex(1)
    panel.joint.activated.emit(1)
    assert only(panel).joint == joint and panel.document.undo_stack.undoText() == "Carry box"
    assert panel.plan.props == {}, "what is carried is not on the floor"
    panel.joint.setCurrentIndex(0)
    panel.joint.activated.emit(0)
    assert only(panel).joint == "" and only(panel).at[1] == 0


def test_a_cup_that_is_dragged_onto_a_desk_lies_on_it_and_off_it_on_the_floor(toys, panel, box, tmp_path):
    put(toys, panel, box)  # 0.6 m high, its origin in its middle
    cup = tmp_path / "cup.stl"
    cup.write_bytes(trimesh.creation.box((0.1, 0.1, 0.1)).export(file_type="stl"))
    panel.add([cup])
    toys.wait(lambda: len(panel.document.project.props) == 2)
    toys.wait(lambda: len(panel.figures.props.meshes.meshes) == 2)
    desk, small = panel.document.project.props
    plan = panel.plan
    at, there = (panel.document.project.props[ident].at for ident in (small, desk))
    drag(plan, plan.to_pixels(at[0], at[2]), plan.to_pixels(there[0], there[2]))
    assert panel.document.project.props[small].at[1] == pytest.approx(0.3, abs=0.001)
    drag(plan, plan.to_pixels(there[0], there[2]), plan.to_pixels(-0.8, 0.5))
    assert panel.document.project.props[small].at[1] == 0
    drag(plan, plan.to_pixels(there[0], there[2]), plan.to_pixels(-0.8, 0.5))
    assert panel.document.project.props[desk].at[1] == 0, "what is larger does not climb onto what is smaller"


def test_props_that_are_added_together_stand_beside_the_character_and_each_other(toys, panel, box):
    panel.add([box, box, box])
    toys.wait(lambda: len(panel.document.project.props) == 3)
    places = [prop.at[0] for prop in panel.document.project.props.values()]
    assert places[0] - 0.3 >= 0.5 and all(b - a >= 0.69 for a, b in pairwise(places))


def test_remove_takes_the_chosen_prop_away(toys, panel, box):
    put(toys, panel, box)
    QTest.mouseClick(panel.remove_button, Qt.MouseButton.LeftButton)
    assert panel.document.project.props == {}
    panel.document.undo()
    assert only(panel).name == "box"


def test_what_lies_on_a_desk_is_chosen_before_the_desk(toys, panel, box):
    put(toys, panel, box)
    large = panel.current
    panel.add([box])
    toys.wait(lambda: len(panel.document.project.props) == 2)
    small = panel.current
    panel.numbers["scale", 0].setValue(0.2)
    prop = panel.document.project.props[large]
    panel.numbers["at", 0].setValue(prop.at[0])
    assert panel.plan.find_prop(panel.plan.to_pixels(prop.at[0], prop.at[2])) == small
    assert panel.plan.find_prop(QPointF(2, 2)) == ""


def test_props_are_drawn_after_the_project_was_saved_in_another_folder(toys, panel, box, tmp_path):
    put(toys, panel, box)
    for name in ("one", "two"):
        place = tmp_path / name / "p.metagraph.yaml"
        place.parent.mkdir()
        panel.document.save(place)
        assert only(panel).path == "../box.stl"
        toys.wait(lambda: count_drawn(toys) == 1)


def count_drawn(drive) -> int:
    """The props in the picture."""
    return sum(actor.figure.skeleton.names == ("Prop",) for actor in drive.preview.scene().actors)


def test_a_prop_whose_file_is_gone_is_said_without_the_panel_and_marked_in_it(toys, tmp_path):
    project, _ = add_prop(toys.document.project, Prop(name="lamp", path=str(tmp_path / "gone.obj")))
    told = []
    toys.shell.stage.figures.props.told.connect(told.append)
    toys.document.load(project, None)
    toys.wait(lambda: any("gone.obj" in words for words in told))
    assert "gone.obj" in toys.window.statusBar().currentMessage()
    toys.shell.show("props")
    panel = toys.shell.panel("props")
    assert panel.list.item(0).text() == "lamp: cannot be drawn" and "gone.obj" in panel.list.item(0).toolTip()
    toys.docks["props"].close()


def test_a_file_that_is_added_is_read_once(toys, panel, box, monkeypatch):
    import metagraph.formats.props.reader as reader

    read, times = reader.read_prop, []
    monkeypatch.setattr(reader, "read_prop", lambda path: times.append(path) or read(path))
    put(toys, panel, box)
    toys.settle()
    assert len(times) == 1


def test_a_chair_below_who_sits_says_how_it_fits_and_is_fitted_as_one_step(toys):
    samples = Path(__file__).resolve().parents[4] / "sample_clips"
    project = open_project(samples / "seated.metagraph.yaml").project
    seat = find_seat(project)
    assert seat is not None
    chair = Prop(name="chair", path=str(samples / "props" / "chair.glb"), at=(0, 0, seat.at[2]), scale=1.2)
    project, ident = add_prop(replace(project, character=str(samples / "ben.glb")), chair)
    toys.document.load(project, None)
    toys.shell.show("props")
    panel = toys.shell.panel("props")
    toys.wait(lambda: "sinks" in panel.seat_words.text())
    assert panel.seat_button.isVisibleTo(panel) and panel.seat_button.isEnabled()
    QTest.mouseClick(panel.seat_button, Qt.MouseButton.LeftButton)
    assert panel.seat_words.text() == "The body sits on chair" and not panel.seat_button.isEnabled()
    assert 0.8 < panel.document.project.props[ident].scale < 1.2
    assert panel.document.undo_stack.undoText().startswith("Fit chair to who sits")
    panel.numbers["at", 0].setValue(2.0)
    assert panel.seat_words.text() == "" and not panel.seat_button.isVisibleTo(panel)
    toys.docks["props"].close()


def test_props_outside_the_folder_are_said_and_copied_into_it_as_one_step(toys, panel, box, tmp_path):
    put(toys, panel, box)
    assert not panel.copy_button.isVisibleTo(panel), "a project without a file has no folder yet"
    place = tmp_path / "show" / "p.metagraph.yaml"
    place.parent.mkdir()
    panel.document.save(place)
    panel.refresh()
    assert "box.stl" in panel.outside.text() and panel.copy_button.isVisibleTo(panel)
    QTest.mouseClick(panel.copy_button, Qt.MouseButton.LeftButton)
    toys.wait(lambda: only(panel).path == "props/box.stl")
    assert (place.parent / "props" / "box.stl").read_bytes() == box.read_bytes()
    assert not panel.copy_button.isVisibleTo(panel) and not panel.outside.isVisibleTo(panel)
    assert panel.document.undo_stack.undoText().startswith("Copy 1 prop")
    toys.wait(lambda: count_drawn(toys) == 1)
    panel.document.undo()
    assert only(panel).path == "../box.stl"


def test_a_desk_says_how_far_hands_pass_below_it_is_fitted_and_the_view_follows_each_step(toys):
    samples = Path(__file__).resolve().parents[4] / "sample_clips"
    project = open_project(samples / "seated.metagraph.yaml").project
    desk = Prop(name="desk", path=str(samples / "props" / "desk.glb"), at=(0, 0.2, 0.07))
    project, ident = add_prop(replace(project, character=str(samples / "ben.glb")), desk)
    toys.document.load(project, None)
    toys.shell.show("props")
    panel, stage = toys.shell.panel("props"), toys.shell.stage
    toys.wait(lambda: "Hands pass" in panel.seat_words.text())
    assert panel.seat_button.text() == "Fit to the hands" and panel.seat_button.isEnabled()
    QTest.mouseClick(panel.seat_button, Qt.MouseButton.LeftButton)
    assert panel.seat_words.text() == "Hands rest on desk" and not panel.seat_button.isEnabled()
    assert panel.document.undo_stack.undoText().startswith("Fit desk to the hands")
    assert panel.document.project.props[ident].at[1] < 0.1
    toys.wait(lambda: stage.performance.shown.tops != ())
    times = np.arange(0, 20, 0.5)

    def rests() -> bool:
        """Whether props change what is shown."""
        shown = stage.performance.shown
        return not np.array_equal(shown.pose(times).rotations, shown.without_props.at(times).rotations)

    toys.wait(rests)
    panel.numbers["at", 2].setValue(3.0)
    toys.wait(lambda: not rests())
    assert panel.seat_words.text() == "" and not panel.seat_button.isVisibleTo(panel)
    panel.document.undo()
    toys.wait(rests)
    panel.remove()
    toys.wait(lambda: not rests())
    toys.docks["props"].close()


def test_what_is_added_keeps_the_digest_of_its_file(toys, panel, box):
    from metagraph.formats.clips import digest

    assert put(toys, panel, box).sha256 == digest(box)
