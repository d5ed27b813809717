"""Labels proposed in the real window: the least certain first, why in words, played when chosen, placed in one step."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

pytestmark = [pytest.mark.window, pytest.mark.gl]


@pytest.fixture
def practice(drive):
    """The practice project, its clips loaded, none placed."""
    from app.files import PRACTICE

    drive.files.open(PRACTICE, template=True)
    drive.wait(lambda: len(drive.document.project.clips) == 152 and drive.performance.skeleton() is not None, 60)
    return drive


def proposed(drive):
    from app.panels.proposals import ProposalsDialog

    drive.actions["propose"].trigger()
    dialog = drive.window.findChildren(ProposalsDialog)[-1]
    drive.wait(lambda: dialog.list.topLevelItemCount() > 0, 60)
    return dialog


def test_the_practice_project_is_labelled_and_can_be_taken_back(practice):
    drive = practice
    dialog = proposed(drive)
    assert dialog.list.topLevelItemCount() == 152
    sure = [dialog.found.proposals[item.data(0, Qt.ItemDataRole.UserRole)].confidence for item in dialog._items()]
    assert sure == sorted(sure)
    dialog.limit.setValue(0)
    assert "152 clips" in dialog.go.text()
    QTest.mouseClick(dialog.go, Qt.MouseButton.LeftButton)
    drive.wait(lambda: sum(1 for _ in drive.document.project.actions()) == 152)
    assert not [p for p in drive.window.problems if p.severity == "error"]
    assert not drive.actions["propose"].isEnabled()
    drive.actions["undo"].trigger()
    assert not list(drive.document.project.actions())


def test_a_row_plays_its_clip_and_says_why(practice):
    drive = practice
    dialog = proposed(drive)
    item = dialog.list.topLevelItem(0)
    spot = dialog.list.visualItemRect(item).center()
    QTest.mouseClick(dialog.list.viewport(), Qt.MouseButton.LeftButton, pos=QPoint(spot.x(), spot.y()))
    drive.pause(50)
    assert drive.window.session.shown == item.data(0, Qt.ItemDataRole.UserRole)
    assert "kind" in dialog.why.text() and "stance" in dialog.why.text()
    dialog.reject()


def test_only_what_is_ticked_is_placed(practice):
    drive = practice
    dialog = proposed(drive)
    dialog.limit.setValue(99)
    before = len(dialog.chosen())
    first = dialog.list.topLevelItem(0)
    first.setCheckState(0, Qt.CheckState.Checked)
    assert len(dialog.chosen()) == before + 1
    for item in dialog._items():
        keep = "hands_at_sides__stance" in item.text(0) or "hands_at_sides__wave" in item.text(0)
        item.setCheckState(0, Qt.CheckState.Checked if keep else Qt.CheckState.Unchecked)
    count = len(dialog.chosen())
    QTest.mouseClick(dialog.go, Qt.MouseButton.LeftButton)
    drive.wait(lambda: sum(1 for _ in drive.document.project.actions()) == count)
    assert {s.name for s in drive.document.project.graphs["arms"].stances.values()} == {"hands at sides"}


def test_what_has_no_resting_clip_stays_with_its_reason(practice):
    drive = practice
    dialog = proposed(drive)
    for item in dialog._items():
        item.setCheckState(0, Qt.CheckState.Checked if "arms_crossed__beat" in item.text(0) else Qt.CheckState.Unchecked)
    wanted = len(dialog.chosen())
    assert wanted
    QTest.mouseClick(dialog.go, Qt.MouseButton.LeftButton)
    drive.pause(100)
    assert dialog.placed == 0 and "no resting clip shows its stance, 'arms crossed'" in dialog.words.text()
    assert dialog.list.topLevelItemCount() == 152
    dialog.reject()
