"""Files on other computers that a project names, in the window: asked about once, and the answer kept."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QApplication, QMessageBox

from metagraph.common import network_paths
from metagraph.formats.bvh.file import write_bvh
from metagraph.formats.project.paths import list_closed_paths

pytestmark = [pytest.mark.window, pytest.mark.gl]


@pytest.fixture(autouse=True)
def not_allowed() -> Iterator[None]:
    yield
    network_paths.allow(False)


@pytest.fixture
def project(toy, tmp_path: Path) -> Path:
    """A project whose clip is called as on another computer; on this system two slashes lead here."""
    for folder in ("far", "here"):
        (tmp_path / folder).mkdir()
    write_bvh(toy.clip("walk"), tmp_path / "far" / "walk.bvh")
    path = tmp_path / "here" / "far.metagraph.yaml"
    path.write_text(
        f"metagraph: 1\nname: far\nclips:\n- {{id: c1, name: walk, path: '/{tmp_path}/far/walk.bvh'}}\n"
    )
    return path


class Answer:
    """Presses a button of the question as soon as it is there. asked: what it said."""

    def __init__(self, button: str) -> None:
        self.button, self.asked = button, list[str]()
        self.timer = QTimer(interval=20)
        self.timer.timeout.connect(self._look)
        self.timer.start()

    def _look(self) -> None:
        for box in QApplication.topLevelWidgets():
            if isinstance(box, QMessageBox) and box.isVisible():
                for button in box.buttons():
                    if button.text().replace("&", "") == self.button:
                        self.asked.append(box.informativeText())
                        self.timer.stop()
                        button.click()
                        self.timer.start()


def _opened(drive, path: Path) -> None:
    drive.files.open(path)
    drive.wait(lambda: drive.document.path == path and not drive.window.shell.jobs.running, 30)


@pytest.mark.nightly
def test_they_are_opened_when_the_user_says_so_and_not_asked_about_again(drive, project: Path) -> None:
    answer = Answer("Open them")
    _opened(drive, project)
    drive.wait(lambda: drive.document.project.clips["c1"].motion is not None, 30)
    assert len(answer.asked) == 1 and "walk.bvh" in answer.asked[0]
    assert not list_closed_paths(drive.document.project)
    drive.files.save()
    drive.wait(lambda: not drive.document.dirty, 30)
    assert network_paths.FOLDER not in project.read_text() and "//" in project.read_text()
    drive.files.new()
    _opened(drive, project)
    drive.wait(lambda: drive.document.project.clips["c1"].motion is not None, 30)
    assert len(answer.asked) == 1


@pytest.mark.nightly
def test_they_stay_closed_when_the_user_says_no_and_can_be_opened_later(drive, project: Path) -> None:
    answer = Answer("Keep them closed")
    _opened(drive, project)
    drive.wait(lambda: bool(answer.asked), 30)
    drive.files.new()
    _opened(drive, project)
    assert len(answer.asked) == 1 and drive.document.project.clips["c1"].motion is None
    answer.button = "Open them"
    drive.do("network")
    drive.wait(lambda: drive.document.project.clips["c1"].motion is not None, 30)
    assert len(answer.asked) == 2
