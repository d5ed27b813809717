"""A tiny study, and a hand that goes through it."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest


def _tiny_text(folder: Path) -> str:
    spec = importlib.util.spec_from_file_location(
        "tiny_study", Path(__file__).resolve().parents[3] / "research" / "study" / "conftest.py"
    )
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.tiny_text(folder)


@pytest.fixture
def tiny(tmp_path: Path) -> Path:
    """The study file of a tiny study, the meta-graph first."""
    path = tmp_path / "study" / "study.yaml"
    path.parent.mkdir()
    text = _tiny_text(path.parent)
    given = (
        "order: {given: {P01: [meta, manual], P02: [manual, meta], P03: [meta, manual], P04: [manual, "
        "meta]}}\n"
    )
    path.write_text(text + given, encoding="utf-8")
    return path


class Participant:
    """Goes through a sitting by its buttons."""

    def __init__(self, drive, guide) -> None:
        self.drive, self.guide = drive, guide

    @property
    def page(self):
        return self.guide.screen.page

    def titled(self, title: str) -> None:
        self.drive.wait(lambda: self.guide.screen.isVisible() and self.page.title.text() == title)

    def go(self) -> None:
        QTest.mouseClick(self.page.go, Qt.MouseButton.LeftButton)

    def working(self) -> None:
        self.drive.wait(lambda: self.guide._working and not self.guide.screen.isVisible())

    def press(self, words: str) -> None:
        """Press one of the page's buttons."""
        from PySide6.QtWidgets import QPushButton

        QTest.mouseClick(
            next(b for b in self.page.findChildren(QPushButton) if b.text() == words),
            Qt.MouseButton.LeftButton,
        )

    def finish(self) -> None:
        """Say that the task is done."""
        QTest.mouseClick(self.guide.bar.done, Qt.MouseButton.LeftButton)
        self.titled("Are you done?")
        self.go()


@pytest.fixture
def takes_part(drive, tiny):
    """Begin, or go on with, a participant's sitting."""
    from app.features.study.study_chooser import begin_sitting
    from metagraph.research.study.study_plan import read_study

    guides = []

    def start(participant: str = "P01") -> Participant:
        guide = begin_sitting(drive.shell, read_study(tiny), participant)
        assert guide is not None
        guide.over.connect(lambda: guides.remove(guide))
        guides.append(guide)
        return Participant(drive, guide)

    yield start
    for guide in list(guides):
        guide.leave()
