"""Problems of one stance are one row that opens, and one press mends them all."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.features.problems.problems_panel import FIX
from metagraph.graph import edits


@pytest.mark.nightly
@pytest.mark.window
@pytest.mark.gl
def test_problems_of_one_stance_are_one_row_that_opens_and_is_mended_with_a_press(toys, toy):
    drive = toys
    project = toy.project()
    ids = [toy.id(project, name) for name in ("rest beat lf", "rest wave rt", "rest long")]
    wrong = edits.update_actions(project, ids, timing={"start": 0.25, "blend_in": 0.0})
    wrong = edits.update_actions(wrong, ids[2:], timing={"start": 0.6})
    drive.document.load(wrong, None)
    drive.files.opened.emit()
    panel, tree = drive.problems_panel, drive.problems_panel.tree
    drive.show("problems")

    def rows():
        return [tree.topLevelItem(n) for n in range(tree.topLevelItemCount())]

    def shared():
        return [row for row in rows() if row.text(0).startswith("rest: 3 actions begin or end ")]

    drive.wait(lambda: bool(shared()) and tree.isVisible())
    (row,) = shared()
    assert row.childCount() == 3 and not row.isExpanded()
    assert {row.child(n).text(0).split("\u200b")[0][:6] for n in range(3)} == {"'rest "}
    tree.scrollToItem(row)
    spot = tree.visualItemRect(row).center()
    QTest.mouseClick(tree.viewport(), Qt.MouseButton.LeftButton, pos=spot)
    assert row.isExpanded()
    QTest.mouseClick(tree.viewport(), Qt.MouseButton.LeftButton, pos=spot)
    assert not row.isExpanded()
    count = len([n for n in range(3) if row.child(n).text(FIX).startswith("Blend ")])
    assert count >= 1 and row.text(FIX).startswith(f"Fix {count} problem")
    cell = tree.visualRect(tree.indexFromItem(row, FIX))
    spot = cell.topLeft()
    spot.setX(spot.x() + 20)
    spot.setY(cell.center().y())
    QTest.mouseClick(tree.viewport(), Qt.MouseButton.LeftButton, pos=spot)
    assert drive.document.undo_stack.count() == 1
    drive.wait(lambda: not shared())
    left = {p.action for p in panel.problems if p.code in ("far-start", "jump-start")}
    assert len(left) == 3 - count
