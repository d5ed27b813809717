"""Dialogs that are closed while a job of theirs runs: nothing fails, files are written all the same, and the status
bar says how it ended.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from PySide6.QtCore import QCoreApplication, QEvent, QObject, Qt
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QDialog, QLabel
from shiboken6 import isValid

from app import faults
from app.project.jobs import Jobs, is_alive
from tests.app.every_dialog import DIALOGS, opened

pytestmark = pytest.mark.window

WAYS: dict[str, Callable[[QDialog], object]] = {
    "reject": lambda dialog: dialog.reject(),
    "escape": lambda dialog: dialog.keyPressEvent(
        QKeyEvent(QEvent.Type.KeyPress, Qt.Key.Key_Escape, Qt.KeyboardModifier.NoModifier)
    ),
    "close": lambda dialog: dialog.close(),
}


def _export(dialog, folder: Path) -> None:
    dialog.folder.setText(str(folder / "out"))
    dialog.folder.textEdited.emit(str(folder / "out"))
    dialog.go.click()


def _render(dialog, folder: Path) -> None:
    dialog.kind.setCurrentIndex(dialog.kind.findData(".bvh"))
    dialog.file.setText(str(folder / "out.bvh"))
    dialog.part.setCurrentIndex(dialog.part.findData(None))
    dialog.seconds.setValue(1.0)
    dialog.go.click()


def _graph(dialog, folder: Path) -> None:
    dialog._start(
        "Working", lambda job: job.tell(1, 2, "half") or 1, lambda made: dialog.said.setText("made")
    )


def _moved(dialog, folder: Path) -> None:
    page = next(p for p in dialog.findChildren(QObject) if hasattr(p, "move_button"))
    page._start("Working", lambda job: job.tell(1, 2, "half") or 1, lambda made: page._enable())


def _nothing(dialog, folder: Path) -> None:
    """It begins by itself."""


# Dialogs that have jobs, and how one is started.
AT_WORK: dict[str, Callable[[QDialog, Path], None]] = {
    "export": _export,
    "render": _render,
    "motion graph": _graph,
    "generate motion": _moved,
    "compatibility": _nothing,
    "label": _nothing,
    "conversation": _nothing,
}


@pytest.fixture
def told(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Faults that were reported."""
    out: list[str] = []
    monkeypatch.setattr(
        faults, "report_error", lambda error, where: out.append(f"{type(error).__name__}: {error}")
    )
    return out


@pytest.mark.nightly
@pytest.mark.gl
@pytest.mark.parametrize("way", list(WAYS))
@pytest.mark.parametrize("name", list(AT_WORK))
def test_a_dialog_is_closed_at_once(toys, told: list[str], tmp_path: Path, name: str, way: str) -> None:
    drive = toys
    said: list[str] = []
    drive.window.shell.jobs.outlived.connect(
        lambda title, error, stands: said.append(f"{title} {error} {stands}")
    )
    DIALOGS[name](drive, tmp_path)
    drive.wait(lambda: bool(opened()), 30)
    (dialog,) = opened()
    AT_WORK[name](dialog, tmp_path)
    WAYS[way](dialog)
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    drive.wait(lambda: not opened(), 10)
    drive.wait(lambda: not drive.window.shell.jobs.at_work, 90)
    assert not told
    if name == "export":
        drive.wait(lambda: (tmp_path / "out").is_dir(), 10)
        assert list((tmp_path / "out").glob("*.json")) and said == ["Exporting None True"]
    if name == "render":
        assert (tmp_path / "out.bvh").is_file() and said == ["Writing the performance None True"]
    if name in ("motion graph", "generate motion") and not isValid(dialog):
        assert all(line == "Working None False" for line in said)


@pytest.mark.parametrize("error", [None, ValueError("no disk")])
def test_who_is_gone_is_not_called_and_how_it_ended_is_told(qtbot, error: Exception | None) -> None:
    jobs, heard, label = Jobs(), [], QLabel()
    jobs.outlived.connect(lambda *words: heard.append(words))

    def work(job: object) -> int:
        if error is not None:
            raise error
        return 1

    def show(value: object) -> None:
        label.setText(str(value))

    jobs.start("Writing", work, show, show, stands=True)
    label.deleteLater()
    QCoreApplication.sendPostedEvents(label, QEvent.Type.DeferredDelete)
    qtbot.waitUntil(lambda: not jobs.running, timeout=5000)
    assert heard == [("Writing", error, True)]
    jobs.stop()


def test_a_callback_is_alive_as_long_as_all_that_it_was_made_with(qtbot) -> None:
    label = QLabel()

    def inner() -> None:
        label.clear()

    callbacks = [label.setText, lambda: label, lambda: inner(), inner, print, len]
    assert all(is_alive(one) for one in callbacks)
    label.deleteLater()
    QCoreApplication.sendPostedEvents(label, QEvent.Type.DeferredDelete)
    assert [is_alive(one) for one in callbacks] == [False, False, False, False, True, True]
