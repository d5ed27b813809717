"""Joints chosen on a figure: a click takes what hangs on a joint, a drag what lies within, and the list agrees."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
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
    dialog.show()
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
    dialog._all(False)
    assert not dialog.figure._moving
    name = next(reversed(dialog.items))
    dialog.items[name].setCheckState(0, Qt.CheckState.Checked)
    assert dialog.figure._moving == {name}


def test_a_skeleton_without_extent_is_drawn(qapp):
    point = Skeleton(("a", "b"), np.array([-1, 0]), np.tile([0.0, 0, 0, 1], (2, 1)), np.zeros((2, 3)))
    figure = JointFigure(point, "dark")
    figure.resize(100, 100)
    assert not figure.grab().isNull() and figure.place_of("a").x() == 50
