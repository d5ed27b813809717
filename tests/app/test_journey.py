"""A day's work in the real window, on clips nobody here made: import, drop, time, undo, save, crash, reopen,
export.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import jsonschema
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QFileDialog, QMessageBox

from metagraph.engines.export import export_schema_text
from metagraph.engines.reading import read_export
from metagraph.formats.store import open_project
from metagraph.graph import requests as a
from tests.app import recovering
from tests.processes import started

pytestmark = [pytest.mark.window, pytest.mark.gl]
ROOT = Path(__file__).resolve().parents[2]


def export_and_check(drive, folder: Path) -> None:
    """Export through the dialog; the JSON validates, and reads back as the same graph."""
    from app.features.export.export_dialog import ExportDialog

    drive.actions["export"].trigger()
    dialog = drive.window.findChild(ExportDialog)
    dialog.folder.setText(str(folder))
    QTest.mouseClick(dialog.go, Qt.MouseButton.LeftButton)
    drive.wait(lambda: dialog.open_button.isEnabled(), 60)
    dialog.reject()
    written = next(folder.glob("*.json"))
    jsonschema.Draft202012Validator(json.loads(export_schema_text())).validate(
        json.loads(written.read_bytes())
    )
    again, project = read_export(written), drive.document.project
    assert again.graphs == project.graphs
    assert again.base == project.base
    assert again.settings == project.settings


def import_folder(drive, *paths: Path) -> None:
    before = len(drive.document.project.clips)
    drive.importing.import_paths([str(p) for p in paths])
    drive.wait(lambda: len(drive.document.project.clips) > before, 60)
    for box in drive.window.findChildren(QMessageBox):
        box.close()
    drive.pause(300)


def test_the_alien_is_imported_dropped_timed_saved_killed_reopened_and_exported(
    drive, shared_data, tmp_path, monkeypatch
):
    alien = shared_data / "sumerian-hosts" / "glTF" / "animations" / "alien"
    import_folder(drive, alien)
    project = drive.document.project
    assert len(project.clips) == 60
    assert len(project.skeleton) == 93

    # The first stance: a drop in the middle of the arms layer.
    drive.drag(drive.card("stand_idle"), drive.middle(), lambda: drive.names("stance") == ["stand_idle"])
    assert drive.session.place.stance() is not None

    # Three gestures at once.
    drive.library.search.setText("generic")
    drive.pause(100)
    drive.click(drive.card("generic_a"))
    drive.click(drive.card("generic_c"), Qt.KeyboardModifier.ShiftModifier)
    drive.wait(lambda: len(drive.session.selection.clips) == 3)
    drive.drag(drive.card("generic_b"), drive.node("gesture"), lambda: len(drive.names("gesture")) == 3)
    assert len(drive.session.selection.actions) == 3, "what was dropped is selected"

    # A fidget, a second stance, a transition to it.
    drive.library.search.setText("angry")
    drive.pause(100)
    drive.drag(drive.card("angry"), drive.node("fidget"), lambda: drive.names("fidget") == ["angry"])
    drive.library.search.setText("stand_talk")
    drive.pause(100)
    drive.drag(
        drive.card("stand_talk"),
        drive.middle(),
        lambda: drive.names("stance") == ["stand_idle", "stand_talk"],
    )
    first = next(iter(drive.document.project.graphs["arms"].stances))
    QTest.keyClick(drive.window, Qt.Key.Key_1, Qt.KeyboardModifier.ControlModifier)
    drive.wait(lambda: drive.session.place.stance() == first)
    drive.library.search.setText("wave")
    drive.pause(100)
    drive.drag(drive.card("wave"), drive.node("transition"), lambda: drive.names("transition") == ["wave"])
    transition = next(a for a in drive.document.project.actions() if a.kind == "transition")
    assert drive.document.project.stance(transition.end_stance).name == "stand_talk"

    # A nod on the head layer by keys alone: a stance and a gesture.
    drive.library.search.setText("head_")
    drive.pause(100)
    QTest.keyClick(drive.window, Qt.Key.Key_3, Qt.KeyboardModifier.AltModifier)
    assert drive.session.place.layer == "head"
    drive.click(drive.card("head_neutral"))
    QTest.keyClick(drive.library.list, Qt.Key.Key_1)
    drive.wait(lambda: drive.names("stance", "head") == ["head_neutral"])
    drive.click(drive.card("head_d"))
    QTest.keyClick(drive.library.list, Qt.Key.Key_2)
    drive.wait(lambda: drive.names("gesture", "head") == ["head_d"])
    QTest.keyClick(drive.window, Qt.Key.Key_2, Qt.KeyboardModifier.AltModifier)

    # Timing, by dragging the end handle on the plot.
    gesture = next(a for a in drive.document.project.actions() if a.name == "generic_a")
    drive.click(drive.row(gesture.id))
    drive.wait(lambda: drive.properties.action.plot.isVisible())
    drive.pause(200)
    plot = drive.properties.action.plot.plot
    line = drive.properties.action.plot.lines["end"]
    box = plot.plotItem.vb

    def at(seconds: float) -> tuple:
        point = plot.mapFromScene(
            box.mapViewToScene(line.pos().__class__(seconds, box.viewRect().center().y()))
        )
        return plot.viewport(), QPoint(point.x(), point.y())

    whole = drive.document.project.span(gesture)[1]
    undone = drive.document.undo_stack.count()
    drive.drag(
        at(line.value()),
        at(4.0),
        lambda: (
            drive.document.project.action(gesture.id).timing.end is not None and not drive.window.isHidden()
        ),
    )
    drive.wait(lambda: abs((drive.document.project.action(gesture.id).timing.end or whole) - 4.0) < 0.15)
    assert drive.document.undo_stack.count() == undone + 1, "one drag is one step"

    # Undo and redo.
    QTest.keyClick(drive.window, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    assert drive.document.project.action(gesture.id).timing.end is None
    QTest.keyClick(
        drive.window, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier
    )
    assert drive.document.project.action(gesture.id).timing.end is not None

    # The preview runs the plan.
    drive.session.transport.show_plan()
    drive.wait(lambda: len(drive.performance.shown.plan.layers["arms"].cues) > 3)
    before = drive.preview.frames
    drive.wait(lambda: drive.preview.frames > before + 3)

    # Save.
    path = tmp_path / "alien.metagraph.yaml"
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *a, **k: (str(path), ""))
    QTest.keyClick(drive.window, Qt.Key.Key_S, Qt.KeyboardModifier.ControlModifier)
    drive.wait(lambda: not drive.document.dirty)
    assert path.is_file()
    saved = drive.document.project

    # Another window opens it, edits, and is killed.
    drive.document.close_journal()  # as closing this window would
    killed = edit_and_be_killed(path, tmp_path)
    assert killed == gesture.id
    assert open_project(path).project.action(gesture.id).likelihood == 1.0, (
        "what was not saved is not in the file"
    )

    # Reopening offers the edit.
    person = SimpleNamespace(asked=[], next=[("recover",)])
    recovering.answers(monkeypatch, person)
    drive.files.open(path)
    drive.wait(lambda: drive.document.project.action(gesture.id).likelihood == 2.5, 30)
    assert "1 unsaved edit" in person.asked[0]
    assert drive.document.dirty, "recovered edits are not saved yet"
    assert drive.document.project.graphs["head"] == saved.graphs["head"]

    export_and_check(drive, tmp_path / "export")


def edit_and_be_killed(path: Path, tmp_path: Path) -> str:
    """Open the project in a process of its own, make one edit there, kill -9; return the edited action's
    id.
    """
    script = f"""
import sys
sys.path.insert(0, {str(ROOT)!r})
from pathlib import Path
from PySide6.QtCore import QTimer
from app.main import prepare_application
app = prepare_application()
from app.main import make_window
from metagraph.graph import edits
window = make_window()
window.show()
window.shell.files.open(Path({str(path)!r}))
def edit():
    action = next((a for a in window.shell.document.project.actions() if a.name == "generic_a"), None)
    if action is None:
        QTimer.singleShot(50, edit)
        return
    window.shell.document.edit("Change likelihood", lambda p: edits.update_actions(p, (action.id,), likelihood=2.5))
    print(action.id, flush=True)
QTimer.singleShot(50, edit)
app.exec()
"""
    environment = {
        **os.environ,
        "XDG_DATA_HOME": str(tmp_path / "other"),
        "XDG_CONFIG_HOME": str(tmp_path / "other"),
    }
    with started(sys.executable, "-c", script, stdout=subprocess.PIPE, env=environment) as process:
        told = process.stdout.readline().strip()
        process.send_signal(signal.SIGKILL)
        process.wait(10)
        return told


@pytest.mark.nightly
def test_sitting_down_and_standing_up_are_transitions_between_two_stances(
    drive, shared_data, tmp_path, monkeypatch
):
    import_folder(drive, shared_data / "kaykit-rogue")
    QTest.keyClick(drive.window, Qt.Key.Key_1, Qt.KeyboardModifier.AltModifier)
    assert drive.session.place.layer == "body"
    drive.library.search.setText("idle")
    drive.pause(100)
    drive.drag(drive.card("Unarmed_Idle"), drive.middle(), lambda: drive.names("stance") == ["Unarmed_Idle"])
    drive.drag(
        drive.card("Sit_Chair_Idle"),
        drive.middle(),
        lambda: drive.names("stance") == ["Unarmed_Idle", "Sit_Chair_Idle"],
    )
    sitting = drive.session.place.stance()
    drive.library.search.setText("sit_chair")
    drive.pause(100)
    drive.drag(
        drive.card("Sit_Chair_StandUp"),
        drive.node("transition"),
        lambda: drive.names("transition") == ["Sit_Chair_StandUp"],
    )
    QTest.keyClick(drive.window, Qt.Key.Key_1, Qt.KeyboardModifier.ControlModifier)
    drive.wait(lambda: drive.session.place.stance() != sitting)
    drive.drag(
        drive.card("Sit_Chair_Down"), drive.node("transition"), lambda: len(drive.names("transition")) == 2
    )
    drive.library.search.setText("cheer")
    drive.pause(100)
    drive.drag(drive.card("Cheer"), drive.node("gesture"), lambda: drive.names("gesture") == ["Cheer"])
    drive.library.search.setText("interact")
    drive.pause(100)
    drive.drag(drive.card("Interact"), drive.node("fidget"), lambda: drive.names("fidget") == ["Interact"])

    # Asked to sit, the character sits.
    drive.performance.requests.ask(a.Go(stance=sitting, at=1.0))
    drive.wait(
        lambda: any(
            c.action.name == "Sit_Chair_Down" for c in drive.performance.shown.plan.layers["body"].cues
        )
    )

    drive.document.save(tmp_path / "rogue.metagraph.yaml")
    export_and_check(drive, tmp_path / "export")
