"""Joints chosen on a figure: a click takes what hangs on a joint, a drag what lies within, and the list agrees."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QWheelEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QPushButton
from shiboken6 import isValid

from app.widgets.joint_figure import JointFigure
from app.widgets.joint_mask import MaskDialog
from metagraph.motion.skeleton import Skeleton

pytestmark = pytest.mark.window


def at(figure: JointFigure, joint: str) -> QPoint:
    return figure.place_of(joint).toPoint()


@pytest.fixture
def dialog(toys):
    action = next(a for a in toys.document.project.actions() if a.kind == "gesture")
    toys.session.selection.select_actions((action.id,))
    dialog = MaskDialog(toys.document, toys.session, toys.window)
    dialog.open()  # as the panel does
    QTest.qWaitForWindowExposed(dialog)
    yield dialog
    if isValid(dialog):
        dialog.reject()


def below(skeleton: Skeleton, joint: str) -> set[str]:
    out = {joint}
    for n, parent in enumerate(skeleton.parents):
        if parent >= 0 and skeleton.names[parent] in out:
            out.add(skeleton.names[n])
    return out


@pytest.mark.nightly
def test_a_click_unticks_a_joint_and_what_hangs_on_it_and_a_second_ticks_them_again(toys, dialog):
    skeleton = toys.document.project.skeleton
    arm = next(n for n in skeleton.names if n.endswith("Arm"))
    every = set(skeleton.names)
    QTest.mouseClick(dialog.figure, Qt.MouseButton.LeftButton, pos=at(dialog.figure, arm))
    assert set(dialog.joints()) == every - below(skeleton, arm)
    assert dialog.tree.currentItem() is dialog.items[arm]
    QTest.mouseClick(dialog.figure, Qt.MouseButton.LeftButton, pos=at(dialog.figure, arm))
    assert dialog.joints() == ()


def drag(figure, first: QPoint, last: QPoint, button=Qt.MouseButton.LeftButton) -> None:
    QTest.mousePress(figure, button, pos=first)
    QTest.mouseMove(figure, (first + last) / 2)
    QTest.mouseMove(figure, last)
    QTest.mouseRelease(figure, button, pos=last)


def test_a_drag_takes_the_joints_within_alone(toys, dialog):
    figure, size = dialog.figure, dialog.figure.size()
    drag(figure, QPoint(1, 1), QPoint(size.width() - 2, size.height() - 2), Qt.MouseButton.RightButton)
    assert all(i.checkState(0) == Qt.CheckState.Unchecked for i in dialog.items.values())
    skeleton = toys.document.project.skeleton
    top = max(skeleton.names, key=lambda n: -figure.place_of(n).y())
    corner = QPoint(6, 6)
    drag(figure, at(figure, top) - corner, at(figure, top) + corner)
    assert top in dialog.joints() and len(dialog.joints()) < 4
    dialog.accept()
    (action,) = toys.session.selection.selected_actions()
    assert action.joints == dialog.joints()


def test_ticks_in_the_list_and_the_buttons_show_on_the_figure(toys, dialog):
    next(b for b in dialog.findChildren(QPushButton) if b.text() == "&None").click()
    assert not any(dialog.figure._weights.values())
    name = next(reversed(dialog.items))
    dialog.items[name].setCheckState(0, Qt.CheckState.Checked)
    assert {n for n, weight in dialog.figure._weights.items() if weight} == {name}


def arm_of(dialog) -> str:
    return next(n for n in dialog.items if n.endswith("Arm"))


def test_the_strength_is_what_a_click_gives_and_a_second_click_takes_it(toys, dialog):
    skeleton, arm = toys.document.project.skeleton, arm_of(dialog)
    dialog.strength.setValue(0.25)
    assert dialog.slider.value() == 25
    QTest.mouseClick(dialog.figure, Qt.MouseButton.LeftButton, pos=at(dialog.figure, arm))
    assert {n for n, w in dialog.weights.now.items() if w == 0.25} == below(skeleton, arm)
    item = dialog.items[arm]
    assert item.checkState(0) == Qt.CheckState.PartiallyChecked and item.text(1) == "0.25"
    dialog.accept()
    (action,) = toys.session.selection.selected_actions()
    assert action.joints == () and {*action.joint_weights} == {(n, 0.25) for n in below(skeleton, arm)}
    assert "partly" in toys.properties.action.joints.text()


def turn(figure, point: QPoint, notches: int) -> None:
    at_ = QPointF(point)
    event = QWheelEvent(
        at_,
        QPointF(figure.mapToGlobal(point)),
        QPoint(),
        QPoint(0, 120 * notches),
        Qt.MouseButton.NoButton,
        Qt.KeyboardModifier.NoModifier,
        Qt.ScrollPhase.NoScrollPhase,
        False,
    )
    QApplication.sendEvent(figure, event)


def test_the_wheel_changes_the_joint_under_it_alone_and_elsewhere_the_strength(toys, dialog):
    arm = arm_of(dialog)
    turn(dialog.figure, at(dialog.figure, arm), -3)
    assert {n for n, w in dialog.weights.now.items() if w < 1} == {arm}
    assert dialog.weights.now[arm] == pytest.approx(0.85)
    turn(dialog.figure, QPoint(1, 1), -4)
    assert dialog.strength.value() == pytest.approx(0.8) and len(dialog.weights.now) == len(dialog.items)
    turn(dialog.figure, at(dialog.figure, arm), -40)
    assert arm not in dialog.joints() and dialog.joints()


def test_one_click_makes_a_soft_edge_at_the_foot_of_the_spine_and_undo_takes_it_back(toys, dialog):
    soft = next(b for b in dialog.findChildren(QPushButton) if b.text() == "Soft &edge")
    QTest.mouseClick(soft, Qt.MouseButton.LeftButton)
    weights = dict(dialog.weights.now)
    assert 0 < weights["Spine"] < 1 and weights["Hips"] == 1
    assert not dialog.redo_button.isEnabled()
    QTest.keyClick(dialog, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    assert set(dialog.weights.now.values()) == {1.0}
    QTest.mouseClick(dialog.redo_button, Qt.MouseButton.LeftButton)
    assert dict(dialog.weights.now) == weights
    dialog.accept()
    (action,) = toys.session.selection.selected_actions()
    toys.session.selection.select_actions((action.id,))
    again = MaskDialog(toys.document, toys.session, toys.window)
    assert dict(again.weights.now) == weights, "what was kept is shown again"
    again.reject()


def test_by_keys_alone_chosen_joints_are_ticked_and_move_farther_or_less_far(toys, dialog):
    arm = arm_of(dialog)
    dialog.tree.setFocus()
    dialog.tree.setCurrentItem(dialog.items[arm])
    for _ in range(3):
        QTest.keyClick(dialog.tree, Qt.Key.Key_Minus)
    QTest.keyClick(dialog.tree, Qt.Key.Key_Plus)
    assert dialog.weights.now[arm] == pytest.approx(0.9)
    QTest.keyClick(dialog.tree, Qt.Key.Key_Space)
    assert dialog.weights.now[arm] == 1
    dialog.strength.setValue(0.5)
    QTest.keyClick(
        next(b for b in dialog.findChildren(QPushButton) if "selected" in b.text()), Qt.Key.Key_Space
    )
    assert dialog.weights.now[arm] == 0.5


def test_every_control_of_the_weights_has_a_name(toys, dialog):
    for control in (dialog.tree, dialog.figure, dialog.strength, dialog.slider, dialog.over):
        assert control.accessibleName()
    for button in dialog.findChildren(QPushButton):
        assert button.text() or button.accessibleName()


def test_the_figure_is_drawn_with_numbers_and_shades(toys, dialog):
    before = dialog.figure.grab().toImage()
    dialog.weights.change({arm_of(dialog): 0.5})
    dialog._show()
    assert dialog.figure.grab().toImage() != before


def test_a_skeleton_without_extent_is_drawn(qapp):
    point = Skeleton(("a", "b"), np.array([-1, 0]), np.tile([0.0, 0, 0, 1], (2, 1)), np.zeros((2, 3)))
    figure = JointFigure(point, "dark")
    figure.resize(100, 100)
    assert not figure.grab().isNull() and figure.place_of("a").x() == 50


def test_only_a_dotted_line_leads_to_a_rigs_helpers(qtbot):
    offsets = np.array([[0, 1.0, 0], [0, 0.5, 0], [0.4, 0, 0]])
    inked = []
    for name in ("arm", "control-arm-ik"):
        parents, turns = np.array([-1, 0, 0]), np.tile([0.0, 0, 0, 1], (3, 1))
        skeleton = Skeleton(("hips", "spine", name), parents, turns, offsets)
        figure = JointFigure(skeleton, "dark")
        qtbot.addWidget(figure)
        figure.resize(300, 300)
        figure.show_weights({})
        picture = figure.grab().toImage()
        start, end = figure.place_of(skeleton.names[0]), figure.place_of(skeleton.names[2])
        middle = [start + (end - start) * share for share in np.linspace(0.3, 0.7, 40)]
        empty = picture.pixel(2, 2)
        inked.append(sum(picture.pixel(at.toPoint()) != empty for at in middle))
    assert inked[0] == 40 > inked[1] > 0
