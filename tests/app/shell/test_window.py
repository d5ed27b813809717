"""The real window: everything by keyboard, drags and drops, many at once, dialogs, themes, closing."""

from __future__ import annotations

from dataclasses import replace

import pytest
from PySide6.QtCore import QEvent, QSize, Qt
from PySide6.QtGui import QHelpEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import (
    QAbstractButton,
    QApplication,
    QComboBox,
    QDialog,
    QFileDialog,
    QInputDialog,
    QLineEdit,
    QMessageBox,
    QPushButton,
    QSlider,
    QSpinBox,
    QToolButton,
    QToolTip,
)

from app.features.problems import ProblemButton
from app.shell.window import fit_screen
from metagraph.formats.bvh.file import write_bvh
from metagraph.formats.store import save_project
from metagraph.graph import edits

pytestmark = [pytest.mark.window, pytest.mark.gl]
KEY, CTRL, ALT, SHIFT = (
    Qt.Key,
    Qt.KeyboardModifier.ControlModifier,
    Qt.KeyboardModifier.AltModifier,
    Qt.KeyboardModifier.ShiftModifier,
)


@pytest.fixture
def folder(toy, tmp_path):
    """A folder of clip files: two that rest and three that move."""
    place = tmp_path / "clips"
    place.mkdir()
    for n, name in enumerate(("idle", "up idle", "beat", "cough", "raise")):
        clip = toy.clip(
            name,
            0.8,
            0.8 if n == 1 else 0.0,
            end=0.8 if n in (1, 4) else 0.0,
            swing=0.0 if n < 2 else 0.3 + n / 10,
        )
        write_bvh(clip, place / f"{name}.bvh")
    return place


def activate(box: QComboBox, place: int) -> None:
    """Choose an entry as a user does."""
    box.setCurrentIndex(place)
    box.activated.emit(place)


def count(drive) -> int:
    return drive.document.undo_stack.count()


def test_the_whole_job_by_keyboard_alone(drive, folder, tmp_path, monkeypatch):
    monkeypatch.setattr(QFileDialog, "getExistingDirectory", lambda *a, **k: str(folder))
    drive.key(KEY.Key_I, CTRL)
    drive.wait(lambda: len(drive.document.project.clips) == 5)

    # Find the clips: the search, then the list, then arrows.
    drive.key(KEY.Key_F, CTRL)
    drive.wait(lambda: QApplication.focusWidget() is drive.library.search)
    QTest.keyClicks(drive.library.search, "2 idle")
    assert drive.library.search.text() == "2 idle", "keys 1 to 4 are typed, not obeyed"
    assert not drive.names()
    drive.key(KEY.Key_Escape, widget=drive.library.search)
    assert drive.library.search.text() == ""
    QTest.keyClicks(drive.library.search, "idle")
    drive.key(KEY.Key_Down, widget=drive.library.search)
    assert QApplication.focusWidget() is drive.library.list
    listed = drive.library.list

    # Label: two stances, then a gesture, a fidget and a transition of the first.
    drive.key(KEY.Key_1, widget=listed)
    drive.wait(lambda: drive.names("stance") == ["idle"])
    drive.key(KEY.Key_F, CTRL)
    QTest.keyClicks(drive.library.search, "up")
    drive.library.search.setText("up")
    drive.key(KEY.Key_Return, widget=drive.library.search)
    drive.key(KEY.Key_Home, CTRL, widget=listed)
    drive.wait(lambda: len(drive.session.selection.clips) == 1)
    drive.key(KEY.Key_1, widget=listed)
    drive.wait(lambda: drive.names("stance") == ["idle", "up idle"])
    drive.key(KEY.Key_1, CTRL)
    first = next(iter(drive.document.project.graphs["arms"].stances))
    assert drive.session.place.stance() == first
    drive.library.search.setText("")
    for name, key, kind in (
        ("beat", KEY.Key_2, "gesture"),
        ("cough", KEY.Key_3, "fidget"),
        ("raise", KEY.Key_4, "transition"),
    ):
        row = next(r for r in range(5) if drive.library.rows.index(r, 0).data() == name)
        listed.setFocus()
        while listed.currentIndex().row() != row:
            drive.key(KEY.Key_Right if listed.currentIndex().row() < row else KEY.Key_Left, widget=listed)
        drive.key(key, widget=listed)
        drive.wait(lambda k=kind, n=name: drive.names(k) == [n])

    # The canvas: arrows go through the nodes and change the likelihood, Enter plays in context, Esc comes
    # back.
    drive.canvas.setFocus()
    gesture, fidget, transition = (
        next(a for a in drive.document.project.actions() if a.kind == k)
        for k in ("gesture", "fidget", "transition")
    )
    seen = []
    for _ in range(3):
        drive.key(KEY.Key_Down, widget=drive.canvas)
        seen.append(drive.session.selection.actions)
    assert {*seen} >= {(fidget.id,), (transition.id,)}
    for _ in range(3):
        drive.key(KEY.Key_Up, widget=drive.canvas)
    assert drive.session.selection.selected_actions()[0].kind == "stance", (
        "above the rows are the stance's loops"
    )
    drive.key(KEY.Key_Down, widget=drive.canvas)
    assert drive.session.selection.actions == (gesture.id,)
    steps = count(drive)
    drive.key(KEY.Key_Right, widget=drive.canvas)
    drive.key(KEY.Key_Right, widget=drive.canvas)
    assert drive.document.project.action(gesture.id).likelihood == 1.2
    drive.key(KEY.Key_Left, widget=drive.canvas)
    assert drive.document.project.action(gesture.id).likelihood == 1.1
    assert count(drive) == steps + 3
    drive.key(KEY.Key_Return, widget=drive.canvas)
    assert (drive.session.transport.show, drive.session.transport.shown) == ("context", gesture.id)
    drive.key(KEY.Key_Escape)
    assert drive.session.transport.show == "plan"

    # Layers and stances.
    for key, layer in ((KEY.Key_1, "body"), (KEY.Key_3, "head"), (KEY.Key_2, "arms")):
        drive.key(key, ALT)
        assert drive.session.place.layer == layer
    drive.key(KEY.Key_2, CTRL)
    assert drive.session.place.stance() != first
    drive.key(KEY.Key_9, CTRL)
    assert drive.session.place.stance() != first, "there is no ninth stance"
    drive.key(KEY.Key_1, CTRL)

    # Rename: the clip, the action, the stance, each when it is what is selected.
    monkeypatch.setattr(QInputDialog, "getText", lambda *a, **k: ("  hands   at sides ", True))
    drive.session.selection.select_actions(())
    drive.key(KEY.Key_F2)
    assert drive.document.project.stance(first).name == "hands at sides"
    drive.session.selection.select_actions((gesture.id,))
    drive.key(KEY.Key_F2)
    field = drive.properties.action.name
    assert QApplication.focusWidget() is field
    QTest.keyClicks(field, "small beat")
    drive.key(KEY.Key_Return, widget=field)
    assert drive.document.project.action(gesture.id).name == "small beat"
    drive.key(KEY.Key_Z, CTRL, widget=field)
    assert drive.document.project.action(gesture.id).name == "beat", (
        "what was taken over is undone by the window's undo"
    )

    # Remove, undo, redo, and save.
    drive.canvas.setFocus()
    drive.key(KEY.Key_Delete)
    assert drive.document.project.action(gesture.id) is None
    drive.key(KEY.Key_Z, CTRL)
    assert drive.document.project.action(gesture.id) is not None
    drive.key(KEY.Key_Y, CTRL)
    assert drive.document.project.action(gesture.id) is None
    drive.key(KEY.Key_Z, CTRL)
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *a, **k: (str(tmp_path / "by keys"), ""))
    drive.key(KEY.Key_S, CTRL)
    drive.wait(lambda: "by keys" in drive.window.windowTitle())
    assert (tmp_path / "by keys.metagraph.yaml").is_file()


@pytest.mark.nightly
def test_single_keys_yield_to_typing_and_to_focused_buttons(toys):
    drive = toys
    drive.session.jump(action=drive.id("rest beat lf"))
    drive.session.transport.set_playing(False)
    drive.key(KEY.Key_Space)
    assert drive.session.transport.playing
    before = drive.document.project
    tags, start, seed = drive.properties.action.tags, drive.properties.action.start, drive.timeline.seed
    tags.setFocus()
    QTest.keyClicks(tags, "1 2,3.4 fblm")
    assert tags.text() == "1 2,3.4 fblm"
    assert (drive.session.transport.playing, drive.document.project) == (True, before)
    drive.key(KEY.Key_Escape, widget=tags)
    assert tags.text() == "", "Esc takes back what was typed"
    for box, typed in ((start, "0.25"), (seed, "123")):
        box.setFocus()
        box.selectAll()
        QTest.keyClicks(box, typed + " fblm")
        drive.key(KEY.Key_Return, widget=box)
    assert drive.action("rest beat lf").timing.start == 0.25
    assert drive.document.project.settings.seed == 123
    assert drive.session.transport.playing
    assert not drive.places.wanted("machine")
    # The space bar presses the button that Tab came to.
    drive.library.chips["labelled"].setFocus(Qt.FocusReason.TabFocusReason)
    drive.key(KEY.Key_Space, widget=drive.library.chips["labelled"])
    assert drive.library.chips["labelled"].isChecked()
    assert drive.session.transport.playing
    drive.canvas.setFocus()
    drive.key(KEY.Key_Space, widget=drive.canvas)
    assert not drive.session.transport.playing
    seconds = drive.session.transport.seconds
    drive.key(KEY.Key_Period)
    assert drive.session.transport.seconds == pytest.approx(seconds + 1 / 30)
    drive.key(KEY.Key_Home)
    assert drive.session.transport.seconds == 0.0
    for key, state in (
        (KEY.Key_L, lambda: drive.session.transport.loop),
        (KEY.Key_B, lambda: drive.preview.bones),
        (KEY.Key_M, lambda: drive.machine.isVisible()),
    ):
        was = state()
        drive.key(key)
        assert state() is not was
        drive.key(key)
        assert state() is was


def test_tab_goes_round_and_gets_stuck_nowhere(toys):
    drive = toys
    drive.session.jump(action=drive.id("rest beat lf"))
    drive.library.search.setFocus()
    seen = []
    for _ in range(160):  # stops, when all panels are shown, are some 80
        drive.key(KEY.Key_Tab, widget=QApplication.focusWidget())
        seen.append(QApplication.focusWidget())
        if seen[-1] is drive.library.search:
            break
    assert seen[-1] is drive.library.search, "Tab never came back"
    for widget in (
        drive.library.list,
        drive.canvas,
        drive.preview.play_button,
        drive.properties.action.name,
        drive.properties.action.tags,
        drive.timeline.seed,
    ):
        assert widget in seen, f"Tab never came to {widget.accessibleName() or widget}"


def test_every_control_says_what_it_is(toys):
    drive = toys
    for page, select in (
        (1, lambda: drive.session.jump(action=drive.id("rest to up"))),
        (0, lambda: drive.session.selection.select_actions(())),
    ):
        select()
        assert drive.properties.pages.currentIndex() == page
        for widget in drive.window.findChildren(QAbstractButton):
            if widget.isVisible() and not widget.objectName().startswith(
                ("qt_", "ScrollLeft", "ScrollRight")
            ):
                assert widget.text() or widget.accessibleName(), (
                    f"a button without a name in {widget.parent()}: {widget.toolTip()}"
                )
                assert widget.toolTip() or widget.text(), widget
        for kind in (QLineEdit, QComboBox, QSpinBox, QSlider):
            for widget in drive.window.findChildren(kind):
                if widget.isVisible() and not widget.objectName().startswith("qt_"):
                    assert widget.accessibleName(), f"{widget} in {widget.parent()} has no name"
                    assert widget.toolTip(), f"{widget.accessibleName()} has no tooltip"
    for action in drive.actions.by_id.values():
        assert action.toolTip()
    keys = [k.toString() for a in drive.actions.by_id.values() for k in a.shortcuts()]
    assert len(keys) == len(set(keys)), "a shortcut that stands for two commands does neither"


@pytest.mark.nightly
def test_twenty_clips_are_dropped_at_once(drive, toy):
    project = edits.add_clips(
        toy.project(),
        [(f"many {n:02}.glb", 0, "", toy.clip(f"many {n:02}", 0.5, swing=n / 40)) for n in range(20)],
    )
    drive.document.load(project, None)
    drive.files.opened.emit()
    drive.library.search.setText("many")
    drive.library.list.setFocus()
    drive.key(KEY.Key_A, CTRL, widget=drive.library.list)
    drive.wait(lambda: len(drive.session.selection.clips) == 20)
    steps, fidgets = count(drive), len(drive.names("fidget"))
    drive.drag(
        drive.card("many 00"), drive.node("fidget"), lambda: len(drive.names("fidget")) == fidgets + 20
    )
    assert count(drive) == steps + 1
    assert len(drive.session.selection.actions) == 20
    drive.key(KEY.Key_Z, CTRL)
    assert len(drive.names("fidget")) == fidgets


@pytest.mark.nightly
def test_rows_are_dragged_to_another_node_and_to_another_stance(toys):
    drive = toys
    beat, cough, up = drive.id("rest beat lf"), drive.id("rest cough"), drive.id("up")
    drive.drag(drive.row(beat), drive.node("fidget"), lambda: drive.action("rest beat lf").kind == "fidget")
    assert drive.session.selection.actions == (beat,)
    drive.click(drive.row(cough), CTRL)
    assert set(drive.session.selection.actions) == {beat, cough}
    steps = count(drive)
    drive.drag(drive.row(beat), drive.chip(up), lambda: drive.action("rest cough").stance == up)
    assert [
        (drive.document.project.action(i).stance, drive.document.project.action(i).kind)
        for i in (beat, cough)
    ] == [(up, "fidget")] * 2
    assert count(drive) == steps + 1
    assert drive.session.place.stance() == up, "the window goes where they went"


@pytest.mark.nightly
def test_a_refused_drop_says_why_and_changes_nothing(drive, folder, monkeypatch):
    drive.importing.import_paths([str(folder)])
    drive.wait(lambda: len(drive.document.project.clips) == 5)
    drive.pause(50)
    drive.drag(drive.card("idle"), drive.middle(), lambda: drive.names("stance") == ["idle"])
    before, steps = drive.document.project, count(drive)
    seen, what = [], drive.canvas.acts.what

    def noted(*args):
        seen.append(what(*args))
        return seen[-1]

    monkeypatch.setattr(drive.canvas.acts, "what", noted)
    drive.drag(drive.card("raise"), drive.node("transition"), lambda: bool(seen))
    drive.wait(lambda: drive.canvas.drop is None)
    assert any(not d.possible and "ends in" in d.words for d in seen)
    assert drive.document.project is before
    assert count(drive) == steps
    # The same by key, in the status bar.
    drive.session.selection.select_clips((next(iter(before.clips)),))
    drive.key(KEY.Key_4)
    assert drive.told[-1].startswith("first choose the stance")
    assert drive.window.statusBar().currentMessage() == drive.told[-1]


@pytest.mark.parametrize(
    ("room", "size"), [((1280, 720), (1276, 680)), ((1920, 1080), (1680, 1020)), ((1536, 864), (1532, 824))]
)
def test_a_new_window_and_its_frame_fit_the_screen(room, size):
    assert fit_screen(QSize(*room)).toTuple() == size


@pytest.mark.nightly
def test_a_key_changes_the_kind_of_actions_of_several_stances_and_nothing_else(toys):
    drive = toys
    chosen = tuple(drive.id(name) for name in ("rest beat lf", "up beat"))
    before, steps = [drive.document.project.action(i) for i in chosen], count(drive)
    drive.session.selection.select_actions(chosen)
    drive.canvas.setFocus()
    drive.key(KEY.Key_3, widget=drive.canvas)
    after = [drive.document.project.action(i) for i in chosen]
    assert [a.kind for a in after] == ["fidget", "fidget"] and count(drive) == steps + 1
    assert [a.stance for a in after] == [a.stance for a in before]
    assert drive.session.selection.actions == chosen
    chooser = drive.properties.action.chosen_kind
    assert chooser.currentData() == "fidget"
    chooser.setCurrentIndex(chooser.findData("gesture"))
    chooser.activated.emit(chooser.currentIndex())
    assert [drive.document.project.action(i) for i in chosen] == before


@pytest.mark.nightly
def test_a_likelihood_bar_is_dragged_in_one_step_and_escape_takes_it_back(toys):
    drive = toys
    beat = drive.id("rest beat lf")
    drive.session.selection.select_actions((beat, drive.id("rest short")))
    steps = count(drive)
    canvas, at = drive.bar(beat, 0.5)

    def pull(*parts: float) -> None:
        QTest.mousePress(canvas, Qt.MouseButton.LeftButton, pos=at)
        for part in parts:
            QTest.mouseMove(canvas, drive.bar(beat, part)[1])
            QTest.qWait(5)

    pull(0.6, 0.8, 1.0)
    QTest.mouseRelease(canvas, Qt.MouseButton.LeftButton, pos=drive.bar(beat, 1.0)[1])
    assert drive.action("rest beat lf").likelihood == pytest.approx(3.0, abs=0.1)
    assert drive.action("rest short").likelihood == drive.action("rest beat lf").likelihood, (
        "what is selected goes along"
    )
    assert count(drive) == steps + 1
    drive.key(KEY.Key_Z, CTRL)
    assert drive.action("rest beat lf").likelihood == 1.0
    pull(0.7, 0.0)
    assert drive.action("rest beat lf").likelihood < 1.0
    drive.key(KEY.Key_Escape, widget=canvas)
    QTest.mouseRelease(canvas, Qt.MouseButton.LeftButton, pos=at)
    assert drive.action("rest beat lf").likelihood == 1.0
    assert count(drive) == steps
    assert drive.session.transport.show == "plan"


@pytest.mark.nightly
def test_many_actions_are_edited_at_once_and_show_what_differs(toys):
    drive, p = toys, toys.properties.action
    beat, wave, short = drive.id("rest beat lf"), drive.id("rest wave rt"), drive.id("rest short")
    drive.document.edit(
        "Tag", lambda q: edits.update_actions(q, (beat,), tags=("positive",), timing={"earliest_exit": 0.4})
    )
    drive.session.selection.select_actions((beat, wave))
    assert p.name.text() == "2 actions"
    assert p.name.isReadOnly()
    assert p.end.text() == "mixed"
    assert p.tags.placeholderText() == "mixed"
    assert p.leave.checkState() == Qt.CheckState.PartiallyChecked
    assert not any(p.limb.button(n).isChecked() for n in range(3))
    assert not p.plot.isVisible()

    def both(read) -> list:
        return [read(drive.document.project.action(i)) for i in (beat, wave)]

    p.end.setFocus()
    p.end.selectAll()
    QTest.keyClicks(p.end, "0.5")
    QTest.keyClick(p.end, KEY.Key_Return)
    assert both(lambda a: a.timing.end) == [0.5, 0.5]
    QTest.mouseClick(p.limb.button(2), Qt.MouseButton.LeftButton)
    assert both(lambda a: a.limb) == ["both", "both"]
    QTest.mouseClick(p.leave, Qt.MouseButton.LeftButton, pos=p.leave.rect().center() * 0.2)
    assert all(both(lambda a: a.timing.earliest_exit is not None))
    assert both(lambda a: a.timing.earliest_exit)[0] == 0.4, "what was set is kept"
    QTest.mouseClick(p.leave, Qt.MouseButton.LeftButton, pos=p.leave.rect().center() * 0.2)
    assert both(lambda a: a.timing.earliest_exit) == [None, None]
    p.tags.setFocus()
    QTest.keyClicks(p.tags, "Greeting, positive, greeting")
    QTest.keyClick(p.tags, KEY.Key_Return)
    assert both(lambda a: a.tags) == [("greeting", "positive")] * 2
    p.likelihood.stepBy(-1)
    assert both(lambda a: a.likelihood) == [0.9, 0.9]
    activate(p.stance, p.stance.findText("up"))
    assert both(lambda a: a.stance) == [drive.id("up")] * 2
    assert drive.session.place.stance() == drive.id("up")
    # One alone: numbers out of the clip are kept in it, and said.
    drive.session.jump(action=short)
    p.start.setValue(50.0)
    start, end = drive.document.project.span(drive.action("rest short"))
    assert 0 < start < end
    assert p.start.value() == pytest.approx(start, abs=0.01)
    p.blend_in.setValue(9.0)
    assert drive.action("rest short").timing.blend_in <= end - start + 1e-9
    p.blend_out.stepBy(-100)
    assert p.blend_out.text() == "0.00 s"
    # Transitions: an end that is its own start is refused, and shown as it was.
    drive.session.jump(action=drive.id("rest to up"))
    activate(p.ends, p.ends.findText("rest"))
    assert "another stance" in drive.told[-1]
    assert p.ends.currentText() == "up"


def test_ticking_repeats_repeats_actions_in_one_step_and_only_what_can_repeat_has_the_row(toys):
    drive, p = toys, toys.properties.action
    beat, wave = drive.id("rest beat lf"), drive.id("rest wave rt")
    drive.session.selection.select_actions((beat, wave))
    steps = count(drive)

    def both() -> list[float]:
        return [drive.document.project.action(i).timing.repeat for i in (beat, wave)]

    assert p.form.isRowVisible(p.repeat_row) and not p.repeat.isEnabled()
    QTest.mouseClick(p.repeats, Qt.MouseButton.LeftButton, pos=p.repeats.rect().center() * 0.2)
    assert both() == pytest.approx([2.7, 2.4]) and count(drive) == steps + 1
    assert p.repeat.isEnabled() and p.repeat.text() == "mixed"
    p.repeat.setValue(1.6)
    assert both() == [1.6, 1.6] and count(drive) == steps + 2
    drive.session.selection.select_actions((beat,))
    assert p.repeats.text() == "2 times, for about"
    p.repeat.setValue(0.1)
    assert both() == [0.9, 1.6] and p.repeats.text() == "1 time, for about", "its part plays at least once"
    drive.key(KEY.Key_Z, CTRL)
    drive.key(KEY.Key_Z, CTRL)
    drive.key(KEY.Key_Z, CTRL)
    assert both() == [0.0, 0.0] and p.repeats.checkState() == Qt.CheckState.Unchecked
    drive.session.selection.select_actions((drive.id("rest to up"),))
    assert not p.form.isRowVisible(p.repeat_row)


def test_the_layer_page_sets_weights_rest_and_base_pose(toys):
    drive, p = toys, toys.properties.layer
    drive.session.selection.select_actions(())
    assert drive.properties.pages.currentIndex() == 0
    p.weights["head"].setValue(0.5)
    assert drive.document.project.graphs["arms"].weight("head") == 0.5
    p.weights["head"].stepBy(-50)
    assert p.weights["head"].text() == "0.00"
    p.gap.setValue(4.0)
    assert drive.document.project.markov["arms"].gap == 4.0
    activate(p.base, 0)
    assert drive.document.project.base.clip is None
    assert not p.base_frame.isEnabled()
    # From the clip being looked at, this frame.
    wave = next(c.id for c in drive.document.project.clips.values() if c.name == "rest wave rt")
    drive.session.transport.show_clip(wave)
    drive.session.transport.set_playing(False)
    drive.session.transport.seek(0.5)
    drive.pick(
        drive.library.acts.menu(drive.document.project.clips[wave]), "Use this frame (15) as base pose"
    )
    assert (drive.document.project.base.clip, drive.document.project.base.frame) == (wave, 15)
    assert "rest wave rt, frame 15" in drive.preview.base.text()
    assert p.base.currentText() == "rest wave rt"
    assert p.base_frame.value() == 15
    drive.document.undo()
    assert p.base.currentText() == "Rest pose of the skeleton"


@pytest.mark.nightly
def test_problems_are_found_shown_and_jumped_to(toys):
    drive = toys
    drive.document.edit(
        "Break", lambda q: edits.update_actions(q, (drive.id("up point"),), timing={"start": 5.0, "end": 6.0})
    )
    panel = drive.problems_panel
    drive.wait(lambda: any(q.action == drive.id("up point") for q in panel.problems))
    assert "No problems" not in drive.window.findChild(ProblemButton).text()
    drive.click(
        (drive.window.findChild(ProblemButton), drive.window.findChild(ProblemButton).rect().center())
    )
    drive.wait(panel.tree.isVisible)
    row = next(n for n, q in enumerate(panel.problems) if q.action == drive.id("up point"))
    item = panel.tree.topLevelItem(row)
    panel.tree.scrollToItem(item)
    QTest.mouseClick(
        panel.tree.viewport(), Qt.MouseButton.LeftButton, pos=panel.tree.visualItemRect(item).center()
    )
    assert drive.session.selection.actions == (drive.id("up point"),)
    assert drive.session.place.stance() == drive.id("up")
    assert drive.properties.action.trouble.text()
    drive.document.undo()
    drive.wait(lambda: not any(q.action == drive.id("up point") for q in panel.problems))
    assert drive.properties.action.trouble.text() == ""


@pytest.mark.nightly
def test_machine_theme_and_the_character_alone_come_and_go(toys):
    drive = toys
    drive.key(KEY.Key_M)
    assert drive.machine.isVisible()
    assert next(b for b in drive.header.findChildren(QToolButton) if b.text() == "Machine").isChecked()
    drive.wait(lambda: bool(drive.machine._places))
    at = drive.machine._places[drive.id("rest beat lf")].toPoint()
    drive.click((drive.machine, at))
    assert drive.session.selection.actions == (drive.id("rest beat lf"),)
    drive.click(
        (
            next(b for b in drive.header.findChildren(QToolButton) if b.text() == "Machine"),
            next(b for b in drive.header.findChildren(QToolButton) if b.text() == "Machine").rect().center(),
        )
    )
    assert not drive.machine.isVisible()
    drive.actions["theme"].trigger()
    assert drive.session.look.name == "light"
    drive.pause(50)
    drive.actions["theme"].trigger()
    assert drive.session.look.name == "dark"
    shown = {k: d.isVisible() for k, d in drive.docks.items()}
    drive.key(KEY.Key_F11)
    drive.wait(lambda: not drive.centre.isVisible())
    assert [k for k, d in drive.docks.items() if d.isVisible()] == ["character"]
    drive.key(KEY.Key_F11)
    drive.wait(drive.centre.isVisible)
    assert {k: d.isVisible() for k, d in drive.docks.items()} == shown
    drive.docks["timeline"].close()
    size = drive.window.size()
    drive.actions["arrange"].trigger()
    drive.pause(50)
    assert drive.docks["timeline"].isVisible() and drive.window.size() == size


@pytest.mark.nightly
def test_menus_say_how_things_are(toys):
    drive = toys
    drive.preview.loop_button.click()
    menu = drive.menus["&Play"]
    menu.aboutToShow.emit()
    assert not drive.actions["loop"].isChecked()
    drive.key(KEY.Key_Escape)
    menu.aboutToShow.emit()
    assert drive.actions["show_plan"].isChecked()
    assert not drive.actions["delete"].isEnabled()
    drive.session.jump(action=drive.id("rest beat lf"))
    assert drive.actions["delete"].isEnabled()
    assert not drive.actions["stance_4"].isVisible()
    assert drive.actions["stance_2"].text() == "up"
    drive.menus["&File"].aboutToShow.emit()
    recent = drive.actions["recent"].menu()
    recent.aboutToShow.emit()
    assert recent.actions()
    drive.preview.scrub.setFocus()
    drive.session.transport.seek(0.0)
    drive.pause(50)
    QTest.keyClick(drive.preview.scrub, KEY.Key_PageUp)
    assert drive.session.transport.seconds > 1.0, "the slider's keys move the playhead"


@pytest.mark.nightly
def test_files_are_dropped_on_the_library_and_on_a_node(drive, folder, tmp_path):
    library = drive.library.list.viewport()
    assert not drive.drop_files((drive.canvas, drive.node("gesture")[1]), folder / "beat.bvh"), (
        "without a stance there is no gesture"
    )
    assert drive.drop_files(drive.middle(), folder / "idle.bvh")
    drive.wait(lambda: drive.names("stance") == ["idle"])
    assert drive.drop_files(drive.node("gesture"), folder / "beat.bvh", folder / "cough.bvh")
    drive.wait(lambda: drive.names("gesture") == ["beat", "cough"])
    drive.wait(lambda: drive.library.list.isVisible())
    assert drive.drop_files((library, library.rect().center()), folder)
    drive.wait(lambda: len(drive.document.project.clips) == 5)
    (tmp_path / "notes.txt").write_text("no clip")
    assert not drive.drop_files((library, library.rect().center()), tmp_path / "notes.txt")
    assert not drive.drop_files(drive.middle(), tmp_path / "notes.txt")


@pytest.mark.nightly
@pytest.mark.fresh_window
def test_closing_asks_about_changes_and_windows_follow_each_other(toys, qtbot, monkeypatch):
    from app.main import make_window

    drive, asked = toys, []
    answers = [QMessageBox.StandardButton.Cancel, QMessageBox.StandardButton.Discard]
    monkeypatch.setattr(QMessageBox, "question", lambda *a, **k: (asked.append(a[2]), answers.pop(0))[1])
    drive.document.edit("Change seed", lambda q: edits.set_settings(q, seed=5))
    assert not drive.window.close()
    assert drive.window.isVisible()
    assert drive.window.close()
    assert len(asked) == 2
    second = make_window()
    second.show()
    second.load_late_panels_soon()
    qtbot.waitUntil(lambda: second.places.ready, timeout=15000)
    assert not second.shell.document.project.clips
    assert second.close()
    second.deleteLater()


@pytest.mark.nightly
def test_a_skeletons_correction_is_an_edit_like_any_other(toys):
    from app.features.skeleton.skeleton_dialog import SkeletonDialog

    drive = toys
    drive.actions["skeleton"].trigger()
    dialog = drive.window.findChild(SkeletonDialog)
    box = dialog.roles["Spine"]
    before = drive.document.project
    place = box.findData("chest")
    box.setCurrentIndex(place)
    box.activated.emit(place)
    assert drive.document.project.roles == {"chest": "Spine"}
    part = dialog.parts["Neck"]
    part.setCurrentText("spine")
    part.activated.emit(part.currentIndex())
    assert drive.document.project.parts == {"Neck": "spine"}
    drive.document.undo()
    assert dialog.parts["Neck"].currentText() == "head", "the dialog follows"
    drive.document.undo()
    assert drive.document.project is before
    dialog.reject()
    drive.pause(20)
    drive.document.redo()  # nobody listens who is gone
    drive.document.undo()


def test_an_actions_joints_are_ticked_in_a_tree(toys):
    from app.widgets.joint_mask import MaskDialog

    drive = toys
    drive.session.jump(action=drive.id("rest beat lf"))
    drive.properties.action.joints.click()
    dialog = drive.window.findChild(MaskDialog)
    next(b for b in dialog.findChildren(QPushButton) if b.text() == "&None").click()
    dialog.accept()
    assert "at least one joint" in drive.told[-1]
    dialog.items["LeftUpperArm"].setCheckState(0, Qt.CheckState.Checked)
    dialog.accept()
    assert set(drive.action("rest beat lf").joints) == {"LeftUpperArm", "LeftLowerArm", "LeftHand"}
    assert drive.properties.action.joints.text() == "3 joints only"
    drive.pause(50)  # painted with its joints marked


@pytest.mark.nightly
def test_an_export_that_fails_says_why(toys, tmp_path):
    from app.features.export.export_dialog import ExportDialog

    drive = toys
    drive.actions["export"].trigger()
    dialog = drive.window.findChild(ExportDialog)
    (tmp_path / "file").write_text("in the way")
    dialog.folder.setText(str(tmp_path / "file" / "out"))
    if dialog.go.isEnabled():
        QTest.mouseClick(dialog.go, Qt.MouseButton.LeftButton)
        drive.wait(dialog.go.isEnabled)
    assert dialog.trouble.text()
    assert not dialog.open_button.isEnabled()
    dialog.folder.setText(str(tmp_path / "out"))
    QTest.mouseClick(dialog.go, Qt.MouseButton.LeftButton)
    drive.wait(dialog.open_button.isEnabled)
    assert list((tmp_path / "out").glob("*.json"))
    dialog.reject()


@pytest.mark.nightly
def test_a_project_whose_character_is_missing_opens_as_the_default_body(drive, toy, folder, tmp_path):
    drive.importing.import_paths([str(folder)])
    drive.wait(lambda: len(drive.document.project.clips) == 5)
    clips = list(drive.document.project.clips)
    project = edits.add_stance(
        edits.set_character(drive.document.project, "nobody.glb"), "arms", "idle", clips[:1]
    )
    path = tmp_path / "lost.metagraph.yaml"
    save_project(project, path)
    drive.document.load(type(project)(), None)
    drive.files.open(path)
    drive.wait(lambda: any("character cannot be drawn" in words for words in drive.told))
    drive.wait(lambda: drive.figures.figure(drive.document.project.skeleton) is not None)
    frames = drive.preview.frames
    drive.wait(lambda: drive.preview.frames > frames + 2)


@pytest.mark.nightly
def test_requests_and_another_seed_change_the_performance(toys):
    from app.widgets.request_menu import make_request_menu

    drive = toys
    arms = lambda: drive.performance.shown.plan.layers["arms"].cues  # noqa: E731
    drive.wait(lambda: len(arms()) > 3)
    before = [c.action.id for c in arms()]
    drive.timeline.seed.setValue(4242)
    drive.wait(lambda: [c.action.id for c in arms()] != before)
    assert drive.document.undo_stack.undoText() == "Seed 1 → 4242"
    drive.key(KEY.Key_Z, CTRL)
    assert drive.timeline.seed.value() == 1
    drive.wait(lambda: [c.action.id for c in arms()] == before)
    far = drive.id("far")
    drive.pick(make_request_menu(drive.timeline, drive.performance, 4.0), "Arms", "Go to far")
    drive.wait(lambda: any(c.then == far and c.start < 8 for c in arms()))
    drive.pick(make_request_menu(drive.timeline, drive.performance, None), "Withdraw all requests")
    drive.wait(lambda: [c.action.id for c in arms()] == before)
    # A click on a cue selects its action, a double click plays it in context.
    from app.widgets.lane_geometry import place_lanes, split_lane

    board = drive.timeline.lanes
    drive.session.transport.set_playing(False)
    drive.session.transport.seek(0.0)
    cue = next(c for c in arms() if board.scale().x(c.end) < board.width())
    at = split_lane(place_lanes(board.height())["arms"])[1].center().toPoint()
    at.setX(round(board.scale().x((cue.start + cue.end) / 2)))
    drive.click((board, at))
    assert drive.session.selection.actions == (cue.action.id,)
    QTest.mouseDClick(board, Qt.MouseButton.LeftButton, pos=at)
    assert drive.session.transport.shown == cue.action.id


def test_a_missing_clip_can_be_looked_at_without_harm(toys):
    drive = toys
    action = drive.action("rest beat lf")
    clips = {
        **drive.document.project.clips,
        action.clip: replace(drive.document.project.clips[action.clip], motion=None),
    }
    drive.document.load(replace(drive.document.project, clips=clips), None)
    for show in (
        lambda: drive.session.transport.show_clip(action.clip),
        lambda: drive.session.show_context(action.id),
        drive.session.transport.show_plan,
    ):
        show()
        drive.pause(60)
    drive.session.jump(action=action.id)
    drive.pause(60)
    drive.session.jump(clip=action.clip)
    assert "missing" in drive.properties.clip.words.text()
    drive.pause(60)


@pytest.mark.nightly
@pytest.mark.parametrize(
    "command", ["keys", "patterns", "skeleton", "compatibility", "render", "export", "repairs"]
)
def test_a_dialog_opens_over_the_window_and_closes(toys, command):
    drive = toys
    before = set(drive.window.findChildren(QDialog))
    drive.actions[command].trigger()
    drive.wait(lambda: any(d.isVisible() for d in drive.window.findChildren(QDialog) if d not in before))
    for dialog in drive.window.findChildren(QDialog):
        dialog.close()
    drive.pause(30)


@pytest.mark.parametrize("width", [1280, 1092, 870])
def test_a_narrow_windows_header_still_has_all_its_parts(toys, width):
    """At 1092 pixels, a laptop's screen at 125 %, Export was gone."""
    header = toys.window.header
    more = next(b for b in header.findChildren(QToolButton) if b.objectName() == "qt_toolbar_ext_button")
    problems = header.findChild(ProblemButton)
    wide = header.name.text(), problems.toolButtonStyle()
    toys.window.resize(width, 680)
    toys.pause(50)
    assert toys.window.width() == width and not more.isVisible()
    parts = (header.widgetForAction(a) for a in header.actions() if a.isVisible())
    assert all(part.isVisible() for part in parts)
    at = problems.rect().center()
    QApplication.sendEvent(problems, QHelpEvent(QEvent.Type.ToolTip, at, problems.mapToGlobal(at)))
    unsaid = problems.toolButtonStyle() == Qt.ToolButtonStyle.ToolButtonIconOnly
    assert (problems.text() in problems.toolTip()) == unsaid
    QToolTip.hideText()
    toys.window.resize(1680, 1020)
    toys.pause(50)
    assert (header.name.text(), problems.toolButtonStyle()) == wide and header.name.isVisible()


def test_where_the_header_is_narrow_a_dot_says_unsaved_and_no_part_is_pressed_together(drive, sample):
    header = drive.window.header
    drive.document.load(edits.update_each(sample, {}), None)
    drive.files.opened.emit()
    drive.window.resize(1900, 1000)
    drive.settle()
    assert "unsaved" in header.name.text()
    others = header.sizeHint().width() - header.name.sizeHint().width()
    drive.window.resize(others + header.name.sizeHint().width() - 10, 1000)
    drive.settle()
    assert "unsaved" not in header.name.text() and "•" in header.name.text()
    assert "unsaved" in header.name.toolTip()
    assert header.sizeHint().width() <= header.width()
    drive.window.resize(1680, 1020)
    drive.settle()
    assert "unsaved" in header.name.text()


def test_undo_names_what_it_undoes_and_stands_alone_where_there_is_nothing(drive, sample):
    drive.document.load(edits.update_each(sample, {}), None)
    drive.files.opened.emit()
    drive.settle()
    assert drive.actions["undo"].text() == "&Undo"
    clip = next(iter(drive.document.project.clips))
    drive.document.edit("Rename clip", lambda p: edits.rename_clip(p, clip, "another"))
    drive.settle()
    assert drive.actions["undo"].text() == "&Undo Rename clip"
