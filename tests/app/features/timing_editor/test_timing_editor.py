"""The timing editor in the window: what it shows, and what the mouse and the keys do."""

from __future__ import annotations

from dataclasses import replace

import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QWheelEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from app.stage.playback_source import LEAD
from metagraph.graph import edits
from metagraph.graph.editing.retiming import keep_hand
from metagraph.graph.requests import Line, Play
from metagraph.playback.timing.handles import EDGES, handle_times

pytestmark = [pytest.mark.window, pytest.mark.gl]


@pytest.fixture(scope="module")
def wide(toy):
    project = edits.add_clips(toy.project(), [("wide.glb", 0, "", toy.clip("wide", 2.4, swing=2.4))])
    project = edits.place_clips(
        project, [toy.id(project, "wide")], "arms", "gesture", toy.id(project, "rest")
    )
    return edits.update_actions(
        project,
        [toy.id(project, "wide")],
        timing={"start": 0.1, "end": 1.5, "blend_out": 0.05, "ready": 0.5, "stroke_end": 0.9, "relax": 1.2},
    )


@pytest.fixture
def editor(toys, toy, wide):
    drive = toys
    drive.document.load(wide, None)
    drive.files.opened.emit()
    drive.wait(lambda: drive.compatibility.judged is not None)
    drive.show("timing")
    drive.session.jump(action=toy.id(wide, "wide"))
    drive.ident = toy.id(wide, "wide")
    drive.panel = drive.shell.panel("timing")
    drive.view = drive.panel.view
    drive.wait(lambda: facts(drive) is not None and facts(drive).seen is not None)
    drive.settle()
    drive.view.grab()  # numbers have their places once they were painted
    return drive


def facts(drive):
    return drive.panel.subject.facts().get(drive.ident)


def timing(drive):
    return drive.document.project.action(drive.ident).timing


def at(drive, seconds: float, row: str = "speed") -> QPoint:
    rows = drive.view.tracks()[0]
    box = rows.rows[row] if row != "ruler" else None
    y = box.center().y() if box is not None else 10
    return QPoint(round(drive.view.axis.x(seconds)), round(y))


def pull(drive, start: QPoint, end: QPoint, modifier=Qt.KeyboardModifier.NoModifier, let_go=True):
    """Press, move in steps, and let go."""
    left = Qt.MouseButton.LeftButton
    QTest.mousePress(drive.view, left, modifier, start)
    for n in range(1, 6):
        point = start + (end - start) * n / 5
        event_at = QPointF(point)
        from PySide6.QtCore import QEvent
        from PySide6.QtGui import QMouseEvent

        QApplication.sendEvent(
            drive.view,
            QMouseEvent(
                QEvent.Type.MouseMove,
                event_at,
                drive.view.mapToGlobal(event_at),
                Qt.MouseButton.NoButton,
                left,
                modifier,
            ),
        )
    if let_go:
        QTest.mouseRelease(drive.view, left, modifier, end)


ALT = Qt.KeyboardModifier.AltModifier
SHIFT = Qt.KeyboardModifier.ShiftModifier


@pytest.mark.nightly
def test_it_is_wide_beside_the_character_and_says_what_the_problems_say(editor):
    editor.workspaces.choose("time")
    editor.settle()
    panel, window = editor.panel, editor.window
    assert panel.isVisible() and panel.width() > 0.6 * window.width()
    assert panel.view.height() >= panel.view.minimumHeight()
    shown = facts(editor)
    assert not shown.fine and "ends" in shown.verdict and panel.verdict.words == shown.verdict
    assert editor.properties.action.plot.verdict.text() == shown.verdict, "one verdict everywhere"


def test_a_handle_is_dragged_by_its_line_and_comes_to_rest_with_a_reason_in_one_step(editor):
    before = editor.document.undo_stack.count()
    goal = facts(editor).seen.proposed.end
    near = goal - 4 / editor.view.axis.each
    pull(editor, at(editor, 1.5), at(editor, near), let_go=False)
    assert timing(editor).end == pytest.approx(goal, abs=0.002) or timing(editor).end is None
    assert editor.view.snapped is not None and "without a jump" in editor.view.snapped.why
    assert editor.view.held.startswith("end ")
    assert editor.session.transport.shown == editor.document.project.action(editor.ident).clip
    QTest.mouseRelease(
        editor.view, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, at(editor, near)
    )
    assert editor.view.snapped is None and editor.view.held == ""
    assert editor.document.undo_stack.count() == before + 1
    editor.document.undo_stack.undo()
    assert timing(editor).end == 1.5


@pytest.mark.nightly
def test_with_alt_it_rests_nowhere_and_escape_takes_it_back(editor):
    near = min(facts(editor).seen.snaps("end")) + 4 / editor.view.axis.each
    pull(editor, at(editor, 1.5), at(editor, near), ALT)
    assert timing(editor).end == pytest.approx(near, abs=0.01)
    before = editor.document.undo_stack.index()
    pull(editor, at(editor, timing(editor).start), at(editor, 0.4), let_go=False)
    assert timing(editor).start == pytest.approx(0.4, abs=0.03)
    editor.view.setFocus()
    editor.key(Qt.Key.Key_Escape, widget=editor.view)
    assert timing(editor).start == 0.1 and editor.document.undo_stack.index() == before


@pytest.mark.nightly
def test_what_gave_way_comes_back_within_one_drag(editor):
    pull(editor, at(editor, 1.5), at(editor, 0.7), ALT, let_go=False)
    assert timing(editor).relax < 0.8
    pull(editor, at(editor, 0.7), at(editor, 0.7), ALT)  # another press breaks the first off
    assert timing(editor).relax == 1.2 and timing(editor).end == 1.5


@pytest.mark.nightly
def test_a_phase_is_dragged_as_a_block_and_with_shift_all_of_it(editor):
    pull(editor, at(editor, 0.7, "phases"), at(editor, 0.8, "phases"), ALT)
    found = handle_times(editor.document.project, editor.document.project.action(editor.ident))
    assert [found[e] for e in EDGES] == pytest.approx([0.1, 0.6, 1.0, 1.2, 1.5], abs=0.01)
    pull(editor, at(editor, 0.8, "phases"), at(editor, 1.0, "phases"), ALT | SHIFT)
    found = handle_times(editor.document.project, editor.document.project.action(editor.ident))
    assert [found[e] for e in EDGES] == pytest.approx([0.3, 0.8, 1.2, 1.4, 1.7], abs=0.02)


@pytest.mark.nightly
def test_the_edge_between_two_phases_is_dragged_alone(editor):
    pull(editor, at(editor, 0.9, "phases"), at(editor, 1.05, "phases"), ALT)
    assert timing(editor).stroke_end == pytest.approx(1.05, abs=0.01)
    assert (timing(editor).ready, timing(editor).relax) == (0.5, 1.2)


@pytest.mark.nightly
def test_a_number_is_taken_like_its_line_and_typed_after_a_double_click(editor):
    box = editor.view.numbers[editor.ident]["out"]
    place = box.center().toPoint()
    QTest.mouseDClick(editor.view, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, place)
    assert editor.panel.number.isVisible()
    editor.panel.number.setValue(0.3)
    assert timing(editor).blend_out == pytest.approx(0.3)
    editor.view.grab()
    place = editor.view.numbers[editor.ident]["out"].center().toPoint()
    pull(editor, place, place - QPoint(40, 0), ALT)
    assert timing(editor).blend_out == pytest.approx(0.3 + 40 / editor.view.axis.each, abs=0.01)


def test_the_character_is_scrubbed_and_a_part_of_the_clip_is_looped(editor):
    pull(editor, at(editor, 0.2, "ruler"), at(editor, 1.0, "ruler"))
    transport = editor.session.transport
    assert transport.seconds == pytest.approx(1.0, abs=0.02) and not transport.playing
    assert (
        editor.panel.subject.playhead() is None
        or editor.wait(lambda: editor.panel.subject.playhead() is not None) is None
    )
    pull(editor, at(editor, 0.4, "ruler"), at(editor, 0.8, "ruler"), SHIFT)
    assert transport.part[1:] == pytest.approx((0.4, 0.8), abs=0.02)
    transport.seek(0.79)
    transport.set_playing(True)
    editor.playhead.advance(0.05)
    assert 0.4 <= transport.seconds < 0.5
    transport.set_playing(False)
    QTest.mouseDClick(
        editor.view, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, at(editor, 0.6, "ruler")
    )
    assert transport.part is None


@pytest.mark.nightly
def test_the_wheel_zooms_about_the_pointer(editor):
    point = at(editor, 0.9)
    seconds, each = editor.view.axis.seconds(point.x()), editor.view.axis.each
    QApplication.sendEvent(
        editor.view,
        QWheelEvent(
            QPointF(point),
            editor.view.mapToGlobal(QPointF(point)),
            QPoint(),
            QPoint(0, 480),
            Qt.MouseButton.NoButton,
            Qt.KeyboardModifier.NoModifier,
            Qt.ScrollPhase.NoScrollPhase,
            False,
        ),
    )
    assert editor.view.axis.each > 1.9 * each
    assert editor.view.axis.x(seconds) == pytest.approx(point.x(), abs=0.5)
    editor.key(Qt.Key.Key_0, widget=editor.view)
    assert editor.view.axis.is_whole


@pytest.mark.nightly
def test_keys_step_and_begin_and_end_the_action_at_the_playhead(editor):
    transport = editor.session.transport
    transport.scrub(editor.document.project.action(editor.ident).clip, 0.3)
    editor.wait(lambda: editor.panel.subject.playhead() is not None)
    editor.view.setFocus()
    editor.key(Qt.Key.Key_Right, widget=editor.view)
    assert transport.seconds == pytest.approx(0.3 + 1 / 30, abs=0.002)
    editor.key(Qt.Key.Key_I, widget=editor.view)
    assert timing(editor).start == pytest.approx(transport.seconds, abs=0.002)
    transport.seek(1.3)
    editor.key(Qt.Key.Key_O, widget=editor.view)
    assert timing(editor).end == pytest.approx(1.3, abs=0.002)


@pytest.mark.nightly
def test_before_and_after_are_compared_on_the_stage_and_nothing_is_changed(editor):
    project = editor.document.project
    pull(editor, at(editor, 1.5), at(editor, 1.9), ALT)
    changed = editor.document.project
    editor.panel.compare.click()
    assert editor.performance.before is project and editor.panel.subject.before_facts()
    editor.panel.compare.click()
    assert editor.performance.before is None and editor.document.project is changed


@pytest.mark.nightly
def test_the_key_a_shows_them_as_they_were_and_again_as_they_are(editor):
    project = editor.document.project
    pull(editor, at(editor, 1.5), at(editor, 1.9), ALT)
    editor.view.setFocus()
    assert editor.session.transport.show == "clip", "the handle is watched on the clip alone"
    editor.key(Qt.Key.Key_A, widget=editor.view)
    assert editor.session.transport.show == "context", "where the two differ"
    assert editor.performance.before is project and editor.panel.compare.text() == "A: before"
    editor.wait(lambda: editor.performance.shown.beside is not None)
    character = editor.shell.panel("character")
    editor.wait(character.looking.trails.isVisible)
    assert not character.looking.trailing, "the paths go with the comparison"
    assert character.overlays.ghosts.isVisible() or not character.overlays.ghosts._labels
    shown = editor.performance.shown
    assert shown.project is project and shown.beside.project is editor.document.project
    editor.key(Qt.Key.Key_A, widget=editor.view)
    assert editor.performance.before is None and editor.panel.compare.text() == "A/B"
    editor.wait(lambda: editor.performance.shown.beside is None)
    editor.wait(lambda: not character.looking.trails.isVisible())


@pytest.mark.nightly
@pytest.mark.parametrize("handle", ["in", "out"])
def test_a_blend_that_was_dragged_plays_between_its_stances(editor, handle):
    shown = facts(editor)
    where = shown.handle(handle).at
    by = 0.1 if handle == "in" else -0.1
    pull(editor, at(editor, where), at(editor, where + by), ALT, let_go=False)
    transport = editor.session.transport
    assert transport.show == "clip" and not transport.playing, "while it is dragged, its moment is seen"
    QTest.mouseRelease(
        editor.view, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, at(editor, where + by)
    )
    assert (transport.show, transport.shown) == ("context", editor.ident) and transport.playing
    begin, end = editor.document.project.span(editor.document.project.action(editor.ident))
    out = LEAD + end - begin - timing(editor).blend_out
    assert transport.seconds < (LEAD if handle == "in" else out)
    assert transport.seconds >= (0 if handle == "in" else out - 1)


@pytest.mark.nightly
def test_onion_skin_shows_start_stroke_and_end(editor):
    editor.panel.onion.click()
    moments = [at for at, _ in editor.session.onion.skin.moments]
    shown = facts(editor)
    assert sorted(moments) == pytest.approx(sorted([0.1, 1.5, shown.handle("stroke").at]))
    editor.session.transport.scrub(shown.action.clip, 0.7)
    editor.wait(lambda: editor.performance.shown.clip is not None)
    assert len(editor.preview.scene().actors) == 4
    editor.panel.onion.click()
    assert editor.session.onion.skin is None and len(editor.preview.scene().actors) == 1


@pytest.mark.nightly
def test_many_actions_stand_below_each_other_and_are_moved_by_the_same(editor, toy):
    project = editor.document.project
    others = [editor.ident, toy.id(project, "rest wave rt"), toy.id(project, "rest loop")]
    editor.session.selection.select_actions(tuple(others))
    editor.settle()
    editor.view.grab()
    assert [t.ident for t in editor.view.tracks()] == others
    starts = {i: project.action(i).timing.start for i in others}
    pull(editor, at(editor, 0.1), at(editor, 0.3), ALT)
    after = editor.document.project
    moved_by = {i: after.action(i).timing.start - starts[i] for i in others}
    assert all(by == pytest.approx(0.2, abs=0.02) for by in moved_by.values()), moved_by
    editor.document.undo_stack.undo()
    assert editor.document.project.action(others[1]).timing.start == starts[others[1]]


@pytest.mark.nightly
def test_the_sheet_of_joints_and_the_joint_whose_speed_is_drawn_are_chosen(editor):
    least = editor.view.minimumHeight()
    editor.panel.subject.show(dope=True)
    assert editor.view.minimumHeight() > least
    sheet = editor.panel.subject.sheet(editor.ident)
    assert "arms" in sheet.names
    chosen = editor.panel.joint.itemData(1)
    editor.panel.subject.show(joint=chosen)
    assert [c.name for c in facts(editor).curves] == [chosen]


@pytest.mark.nightly
def test_nothing_selected_is_said_and_a_new_project_forgets(editor):
    editor.session.selection.clear()
    editor.view.grab()
    assert editor.view.tracks() == () and not editor.panel.joint.isEnabled()
    assert editor.view.hit(QPointF(300, 60)) is None


@pytest.mark.nightly
def test_a_clip_is_slowed_and_held_in_place_and_undone(editor):
    clip = editor.document.project.action(editor.ident).clip
    before = editor.document.project
    editor.panel.speed.setValue(0.5)
    assert editor.document.project.clips[clip].duration == pytest.approx(4.8, abs=0.04)
    assert timing(editor).end == pytest.approx(3.0, abs=0.02)
    assert editor.view.length == pytest.approx(4.8, abs=0.04), "the rows are as long as the clip is now"
    editor.document.undo_stack.undo()
    assert editor.document.project.clips == before.clips and timing(editor).end == 1.5
    editor.session.transport.scrub(clip, 1.0)
    editor.wait(lambda: editor.panel.subject.playhead() == pytest.approx(1.0))
    editor.panel.hold.click()
    (hold,) = editor.document.project.clips[clip].retime.holds
    assert (hold.at, hold.seconds) == (1.0, 0.4)
    assert timing(editor).end == pytest.approx(1.9, abs=0.03)


@pytest.mark.nightly
def test_a_hold_is_dragged_longer_and_to_nothing(editor):
    clip = editor.document.project.action(editor.ident).clip
    editor.session.transport.scrub(clip, 1.0)
    editor.wait(lambda: editor.panel.subject.playhead() == pytest.approx(1.0))
    editor.panel.hold.click()
    count = editor.document.undo_stack.count()
    (stay,) = facts(editor).stays
    middle = at(editor, (stay.first + stay.last) / 2)
    pull(editor, middle, middle + QPoint(100, 0))
    (hold,) = editor.document.project.clips[clip].retime.holds
    assert hold.seconds > 0.45 and editor.document.undo_stack.count() == count + 1
    (stay,) = facts(editor).stays
    middle = at(editor, (stay.first + stay.last) / 2)
    pull(editor, middle, middle - QPoint(900, 0))
    assert editor.document.project.clips[clip].retime.plain


@pytest.mark.nightly
def test_a_hand_is_kept_during_the_looped_part_and_let_go_again(editor):
    clip = editor.document.project.action(editor.ident).clip
    editor.session.transport.set_part((clip, 0.5, 0.9))
    editor.panel.menu.aboutToShow.emit()
    editor.pick(editor.panel.menu, "Pin the right hand here")
    (contact,) = editor.document.project.clips[clip].retime.contacts
    assert (contact.first, contact.last) == pytest.approx((0.5, 0.9), abs=0.01)
    (kept,) = facts(editor).kept
    assert (kept.first, kept.last) == pytest.approx((0.5, 0.9), abs=0.02)
    assert kept.hand == "right hand" and kept.to
    editor.view.grab()
    editor.panel.menu.aboutToShow.emit()
    editor.pick(editor.panel.menu, "Release the hands")
    assert editor.document.project.clips[clip].retime.plain
    editor.session.transport.set_part(None)


@pytest.mark.nightly
def test_the_plot_in_the_properties_follows_a_clip_that_is_slowed(editor):
    editor.panel.speed.setValue(0.5)
    xs, _ = editor.properties.action.plot.curve.getData()
    assert xs[-1] == pytest.approx(4.8, abs=0.05)


@pytest.mark.nightly
def test_a_drag_of_the_real_pointer_moves_the_end(editor):
    start, end = (editor.view, at(editor, 1.5)), (editor.view, at(editor, 1.9))
    editor.drag(start, end, lambda: (timing(editor).end or 9) > 1.8)
    editor.pause(250)
    assert timing(editor).end == pytest.approx(1.9, abs=0.06)
    assert editor.document.undo_stack.undoText().startswith("End 1.50 → 1.9") and editor.view.held == ""


@pytest.fixture
def kept(editor):
    """A hand that is kept from 0.5 to 0.9 s."""
    clip = editor.document.project.action(editor.ident).clip
    editor.document.edit("Pin hand", lambda p: keep_hand(p, clip, "right", 0.5, 0.9))
    editor.view.grab()
    editor.contacts = lambda: editor.document.project.clips[clip].retime.contacts
    return editor


@pytest.mark.nightly
def test_a_kept_hand_is_dragged_by_its_ends_in_one_step_each(kept):
    count = kept.document.undo_stack.count()
    pull(kept, at(kept, 0.9, "hand 0"), at(kept, 1.1, "hand 0"), ALT, let_go=False)
    assert "0.50 to 1.10 s" in kept.view.held and kept.contacts()[0].last == 0.9
    QTest.mouseRelease(kept.view, Qt.MouseButton.LeftButton, ALT, at(kept, 1.1, "hand 0"))
    assert kept.contacts()[0].last == pytest.approx(1.1, abs=0.01) and kept.contacts()[0].first == 0.5
    assert kept.view.held == "" and kept.view.stretched is None
    pull(kept, at(kept, 0.5, "hand 0"), at(kept, 0.51, "hand 0") - QPoint(60, 0), ALT)
    assert kept.contacts()[0].first < 0.48 and kept.contacts()[0].last == pytest.approx(1.1, abs=0.01)
    assert kept.document.undo_stack.count() == count + 2


@pytest.mark.nightly
def test_a_kept_hand_comes_to_rest_where_the_action_has_something(kept):
    pull(kept, at(kept, 0.9, "hand 0"), at(kept, 1.2, "hand 0") + QPoint(3, 0))
    assert kept.contacts()[0].last == pytest.approx(1.2, abs=0.001), "its retraction begins there"


@pytest.mark.nightly
def test_all_of_a_kept_hand_is_moved_and_escape_and_nothing_let_it_be(kept):
    before = kept.document.project
    pull(kept, at(kept, 0.7, "hand 0"), at(kept, 0.8, "hand 0"), let_go=False)
    kept.view.setFocus()
    kept.key(Qt.Key.Key_Escape, widget=kept.view)
    assert kept.document.project is before and kept.view.stretched is None
    pull(kept, at(kept, 0.7, "hand 0"), at(kept, 0.8, "hand 0"))
    (contact,) = kept.contacts()
    assert (contact.first, contact.last) == pytest.approx((0.6, 1.0), abs=0.02)
    pull(kept, at(kept, contact.last, "hand 0"), at(kept, 0.3, "hand 0"), ALT)
    assert kept.contacts() == ()


@pytest.mark.nightly
def test_the_number_of_a_kept_hands_end_is_typed(kept):
    box = kept.view.numbers[kept.ident]["kept 0 last"]
    place = box.center().toPoint()
    assert "stays at" in kept.view.tip(QPointF(place))
    QTest.mouseDClick(kept.view, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, place)
    assert kept.panel.number.isVisible()
    kept.panel.number.setValue(1.3)
    assert kept.contacts()[0].last == pytest.approx(1.3)


@pytest.mark.nightly
def test_the_line_that_asks_for_an_action_is_seen_before_anything_was_performed(editor):
    line = Line(text="well now", duration=0.8, asks=(Play(action=editor.ident, at=0.1),))
    editor.document.edit("Line", lambda p: replace(p, lines={"l9": line}))
    assert "line" in editor.panel.subject.row_names(0)
    assert editor.panel.subject.said.offset == pytest.approx(timing(editor).start - 0.1)
    editor.document.undo_stack.undo()
    assert "line" not in editor.panel.subject.row_names(0)
