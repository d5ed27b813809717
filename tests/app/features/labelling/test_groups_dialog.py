"""Going through proposals group by group in the real window: what does not belong is clicked away, the rest is
accepted together, corrected together, and taken back together.
"""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QImage
from PySide6.QtTest import QTest

from metagraph.suggest.flags import estimate_chance_wrong
from tests.app.features.labelling.test_review_dialog import begun, practice

__all__ = ["practice"]
pytestmark = [pytest.mark.window, pytest.mark.gl]
K = Qt.Key


def grouped(drive):
    """The groups of a review, opened by its key."""
    from app.features.labelling.groups_dialog import GroupsDialog

    review = begun(drive)
    QTest.keyClick(review, K.Key_G)
    drive.wait(lambda: bool(review.findChildren(GroupsDialog)))
    return review, review.findChildren(GroupsDialog)[-1]


def press(groups, *keys):
    """Press keys as a person does: whatever has the focus gets them."""
    for key in keys:
        QTest.keyClick(groups.focusWidget(), key)


def click(sheet, number, double=False):
    place = sheet.card_rect(number).center()
    (QTest.mouseDClick if double else QTest.mouseClick)(sheet, Qt.MouseButton.LeftButton, pos=place)


def test_a_group_is_accepted_without_what_was_clicked_away_and_taken_back_in_one_step(practice):
    drive = practice
    review, groups = grouped(drive)
    assert groups.groups[0].kind == "stance" and sum(len(g.clips) for g in groups.groups) == 152
    QTest.keyClick(groups, K.Key_Return)
    row = next(n for n, g in enumerate(groups.groups) if g.kind == "gesture" and len(g.clips) > 4)
    groups.list.setCurrentRow(row)
    group = groups.group
    assert groups.heading.text().startswith(group.title) and len(groups.sheet.cards) == len(group.clips)
    chances = [
        estimate_chance_wrong(review.work.review.found.proposals[card.clip]) for card in groups.sheet.cards
    ]
    assert chances == sorted(chances, reverse=True), "what is likely wrong stands first"
    click(groups.sheet, 1)
    out = group.clips[1]
    assert groups.sheet.left_out == {out} and groups.go.text() == f"Accept {len(group.clips) - 1} clips"
    before = set(review.work.waiting())
    QTest.mouseClick(groups.go, Qt.MouseButton.LeftButton)
    assert before - set(review.work.waiting()) == set(group.clips) - {out}
    assert groups.group.key != group.key, "the next group is shown"
    assert any(g.clips == (out,) for g in groups.groups), "what was left out waits"
    QTest.keyClick(groups, K.Key_Backspace)
    assert set(review.work.waiting()) == before


@pytest.mark.nightly
def test_more_that_is_left_out_than_the_next_group_has_is_not_accepted_by_pressing_enter_again(practice):
    review, groups = grouped(practice)
    press(groups, K.Key_Return)
    group = max((g for g in groups.groups if g.kind == "gesture"), key=lambda g: len(g.clips))
    groups.list.setCurrentRow(groups.groups.index(group))
    out = set(group.clips[1:])
    for number in range(1, len(group.clips)):
        click(groups.sheet, number)
    press(groups, K.Key_Return)
    assert groups.group.key != group.key
    while set(review.work.waiting()) > out:
        waiting = len(review.work.waiting())
        press(groups, K.Key_Return)
        if len(review.work.waiting()) == waiting:
            break
    assert out <= set(review.work.waiting()), "what was clicked away is still waiting"


@pytest.mark.nightly
def test_what_was_left_out_stays_so_while_the_rest_is_proposed_anew(practice):
    review, groups = grouped(practice)
    click(groups.sheet, 0)
    out = groups.sheet.cards[0].clip
    review.work.changed.emit()
    assert groups.sheet.left_out == {out}
    press(groups, K.Key_Down, K.Key_Up)
    assert groups.sheet.left_out == {out}, "also after a look at another group"
    click(groups.sheet, 0)
    assert not groups.sheet.left_out and groups.sheet.chosen == list(groups.group.clips)


@pytest.mark.nightly
def test_a_correction_is_of_every_clip_shown_but_those_left_out(practice):
    review, groups = grouped(practice)
    row = next(n for n, g in enumerate(groups.groups) if g.kind == "gesture" and len(g.clips) > 4)
    groups.list.setCurrentRow(row)
    clips = groups.group.clips
    click(groups.sheet, 2)
    groups.kind.setCurrentIndex(groups.kind.findData("fidget"))
    groups.kind.activated.emit(groups.kind.currentIndex())
    kinds = {clip: review.work.review.value(clip, "kind") for clip in clips}
    assert kinds == {clip: "gesture" if clip == clips[2] else "fidget" for clip in clips}
    assert next(g for g in groups.groups if clips[2] in g.clips).kind == "gesture"
    assert not list(practice.document.project.actions())
    QTest.keyClick(groups, K.Key_Backspace)
    assert {review.work.review.value(clip, "kind") for clip in clips} == {"gesture"}, "a step of its own"
    assert not review.work.can_undo


@pytest.mark.nightly
def test_taking_a_correction_back_leaves_what_came_after_it(practice):
    review, groups = grouped(practice)
    work = review.work
    group = next(g for g in groups.groups if g.kind == "gesture" and len(g.clips) > 4)
    groups.list.setCurrentRow(groups.groups.index(group))
    press(groups, K.Key_3)
    other = next(clip for clip in work.waiting() if clip not in group.clips)
    work.tell(other, "tags", ("mine",))
    work.undo()
    assert work.review.value(group.clips[0], "kind") == "gesture"
    assert work.review.said[other]["tags"] == ("mine",)


@pytest.mark.nightly
def test_nothing_that_is_told_is_no_step(practice):
    review, groups = grouped(practice)
    review.work.tell_all([], "kind", "fidget")
    review.work.tell_all(list(groups.group.clips), "kind", groups.group.kind)
    assert not review.work.can_undo


@pytest.mark.nightly
def test_what_was_corrected_is_placed_with_times_of_its_new_kind(practice):
    review, groups = grouped(practice)
    work = review.work
    press(groups, K.Key_Return)
    group = next(g for g in groups.groups if g.kind == "gesture" and len(g.clips) > 4)
    work.tell_all([group.clips[0]], "kind", "fidget")
    timed = work.review.timed(practice.document.project, group.clips[0])
    work.place([group.clips[0]], "at once", None)
    (action,) = practice.document.project.uses[group.clips[0]]
    assert action.kind == "fidget" and timed.timing
    assert (action.timing.start, action.timing.end) == (timed.timing["start"], timed.timing["end"])


@pytest.mark.nightly
def test_what_is_of_several_stances_has_no_field_for_one(practice):
    _, groups = grouped(practice)
    for row, group in enumerate(groups.groups):
        groups.list.setCurrentRow(row)
        assert groups.stance.isVisible() == (group.kind in ("gesture", "fidget"))


@pytest.mark.nightly
def test_by_keyboard_alone_a_clip_is_left_out_and_escape_goes_back_to_the_review(practice):
    review, groups = grouped(practice)
    press(groups, K.Key_Right, K.Key_Space)
    assert groups.sheet.left_out == {groups.sheet.cards[1].clip}
    review.work.changed.emit()
    assert groups.sheet.current == 1
    press(groups, K.Key_Escape)
    practice.wait(lambda: not groups.isVisible())
    assert review.isVisible() and review.current in review.work.waiting()


@pytest.mark.nightly
def test_a_double_click_looks_at_a_clip_by_itself(practice):
    review, groups = grouped(practice)
    clip = groups.sheet.cards[2].clip
    click(groups.sheet, 2, double=True)
    practice.wait(lambda: not groups.isVisible())
    assert review.current == clip


@pytest.mark.nightly
def test_pictures_move(practice, monkeypatch):
    _, groups = grouped(practice)
    sheet = groups.sheet
    frames = [QImage(8, 8, QImage.Format.Format_RGB32) for _ in range(3)]
    for frame, color in zip(frames, ("red", "lime", "blue"), strict=True):
        frame.fill(color)
    monkeypatch.setattr(sheet.thumbnails, "scrub", lambda clip: frames)
    seen = set()

    def all_seen():
        seen.add(sheet.grab().toImage().pixelColor(sheet.card_rect(0).center()).name())
        return len(seen & {"#ff0000", "#00ff00", "#0000ff"}) == 3

    practice.wait(all_seen)
