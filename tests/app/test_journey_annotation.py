"""From an annotated video to a character that does the same: import, look, change a number, perform - in the
real window.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QFileDialog, QMessageBox

from app.features.models.annotation_dialog import AnnotateDialog, open_annotation
from app.project.files import SAMPLE
from metagraph.formats.store import open_project
from metagraph.graph import edits

pytestmark = [pytest.mark.window, pytest.mark.gl]
EAF = Path(__file__).resolve().parents[2] / "sample_clips" / "annotation" / "conversation.eaf"


def dialog_of(drive) -> AnnotateDialog:
    drive.wait(lambda: drive.window.findChild(AnnotateDialog) is not None)
    dialog = drive.window.findChild(AnnotateDialog)
    drive.wait(dialog.isVisible)
    return dialog


def choose(drive, table, row: int, words: str) -> None:
    """Open a row's field with a click and choose from the menu with the keyboard's help."""
    field = table.visualRect(table.model().index(row, table.last)).center()
    QTest.mouseClick(table.viewport(), Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, field)
    drive.wait(lambda: QApplication.activePopupWidget() is not None)
    drive.pick(QApplication.activePopupWidget(), words)
    if QApplication.activePopupWidget() is not None:
        QApplication.activePopupWidget().close()
    drive.pause(30)


@pytest.mark.nightly
def test_an_annotation_is_imported_learned_changed_and_performed(drive, tmp_path, monkeypatch):
    drive.files.open(SAMPLE, template=True)
    drive.wait(
        lambda: (
            len(drive.document.project.clips) == 152
            and bool(drive.performance.shown.plan.layers["arms"].cues)
        ),
        60,
    )

    # While its tab lies behind another it works nothing out and leaves the dock as low as it is.
    height = drive.docks["timeline"].height()
    assert drive.models.heat.model is None
    drive.show("models")
    drive.wait(lambda: drive.models.heat.model is not None)
    drive.wait(lambda: drive.docks["models"].height() > height)

    # The panel teaches, and its link opens what it speaks of; here the menu's command with the file chosen.
    assert drive.models.teach.isVisible()
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *a, **k: (str(EAF), ""))
    drive.actions["annotate"].trigger()
    dialog = dialog_of(drive)

    # The guesses are right; one label is said otherwise and back, one tier left out and back.
    names = [row.cells[0] for row in dialog.tiers.rows]
    choose(drive, dialog.tiers, names.index("Right arm"), "Ignore")
    assert "right" not in {a.limb for a in dialog.strip.acts["arms"]}
    choose(drive, dialog.tiers, names.index("Right arm"), "Right arm")
    labels = [(row.cells[1], row.cells[0]) for row in dialog.labels.rows]
    choose(drive, dialog.labels, labels.index(("arms", "fidget")), "Ignore")
    assert "fidget" not in {a.kind for a in dialog.strip.acts["arms"]}
    choose(drive, dialog.labels, labels.index(("arms", "fidget")), "◆ fidget")
    QTest.mouseClick(dialog.as_states, Qt.MouseButton.LeftButton)
    dialog.called.selectAll()
    QTest.keyClicks(dialog.called, "casual talk")
    before = drive.document.undo_stack.count()
    QTest.mouseClick(dialog.go, Qt.MouseButton.LeftButton)
    drive.wait(lambda: drive.window.findChild(AnnotateDialog) is None)
    assert drive.document.undo_stack.count() == before + 1
    project = drive.document.project
    assert set(project.markov) == {"body", "arms", "head"} and project.markov["head"].tags == (
        "positive",
        "negative",
        "",
    )

    # The heat map shows what was learned, beside what was seen.
    panel = drive.models
    assert panel.heat.model is project.markov["arms"] and len(panel.heat.model.states) == 7
    assert panel.chooser.currentText() == "casual talk"
    drive.wait(lambda: panel.plot.found is not None and panel.plot.found.observed is not None)

    # It is performed as it was seen: the same kinds at the same times, other actions with another seed.
    kept = drive.performance.requests.kept
    assert kept is not None and kept.name == "casual talk"
    drive.wait(
        lambda: (
            drive.performance.shown.length == kept.length
            and bool(drive.performance.shown.plan.layers["head"].cues)
        ),
        30,
    )
    cues = drive.performance.shown.plan.layers["head"].cues
    assert len(cues) == 46
    assert (
        np.median(
            [
                abs(c.start - a.at)
                for c, a in zip(cues, (x for x in kept.asks if x.layer == "head"), strict=True)
            ]
        )
        < 0.3
    )
    names = [c.action.name for c in cues]
    drive.document.edit("Change seed", lambda p: edits.set_settings(p, seed=77))
    drive.wait(lambda: [c.action.name for c in drive.performance.shown.plan.layers["head"].cues] != names, 30)
    assert [c.action.kind for c in drive.performance.shown.plan.layers["head"].cues] == [
        c.action.kind for c in cues
    ]

    # A cell is dragged upward: one step, the row evens out, and undo brings the number back.
    heat, steps = panel.heat, drive.document.undo_stack.count()
    old = heat.model.matrix[2][3]
    middle = heat.grid().cell(2, 3).center().toPoint()
    drive.drag(
        (heat, middle),
        (heat, middle - QPoint(0, 64)),
        lambda: drive.document.project.markov["arms"].matrix[2][3] > old + 0.3,
    )
    drive.wait(lambda: drive.models._before is None)
    assert drive.document.undo_stack.count() == steps + 1
    row = drive.document.project.markov["arms"].matrix[2]
    assert row[3] == pytest.approx(old + 0.4, abs=0.03) and sum(row) == pytest.approx(1)
    assert heat.model.matrix[2] == row
    QTest.keyClick(drive.window, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    assert drive.document.project.markov["arms"].matrix[2][3] == old
    QTest.keyClick(
        drive.window, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier
    )

    # A number is typed: shortcuts of the window (1 labels as stance) do not get in the way.
    drive.click((heat, heat.grid().cell(0, 0).center().toPoint()))
    QTest.keyClick(heat, Qt.Key.Key_1)
    QTest.keyClicks(heat.field, "5")
    QTest.keyClick(heat.field, Qt.Key.Key_Return)
    assert drive.document.project.markov["arms"].matrix[0][0] == 0.15

    # Without a performance on stage the changed models improvise: rest, then what the matrix says.
    drive.session.onstage.set_performance(None)
    drive.wait(
        lambda: (
            drive.performance.requests.kept is None
            and any(m.written for m in drive.performance.shown.plan.layers["arms"].metas)
        ),
        30,
    )
    known = set(drive.document.project.markov["arms"].states)
    assert {
        (m.request.limb, m.request.kind)
        for m in drive.performance.shown.plan.layers["arms"].metas
        if m.written
    } <= known

    # All of it is saved.
    path = tmp_path / "talk.metagraph.yaml"
    drive.document.save(path)
    again = open_project(path).project
    assert again.markov == drive.document.project.markov
    assert again.performances == drive.document.project.performances
    assert again.tiers["Left arm"] == "left arm"


def test_an_annotation_that_is_dropped_on_the_window_opens_the_dialog(drive):
    assert drive.drop_files((drive.canvas, QPoint(200, 200)), EAF)
    dialog = dialog_of(drive)
    assert dialog.windowTitle() == "Import annotation"
    dialog.reject()
    assert drive.document.project.clips == {}


def test_a_file_that_is_no_annotation_is_told_and_nothing_opens(drive, tmp_path, monkeypatch):
    broken, told = tmp_path / "talk.eaf", []
    broken.write_text("<svg/>")
    monkeypatch.setattr(QMessageBox, "warning", lambda *a, **k: told.append(a[2]))
    open_annotation(drive.shell, str(broken))
    drive.wait(lambda: bool(told))
    assert "talk.eaf, line 1" in told[0] and "'svg'" in told[0]
    assert drive.window.findChild(AnnotateDialog) is None
