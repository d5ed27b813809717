"""Takes part in a study from its command to its data, with real events in the window.

`python scripted_sitting.py pilot FOLDER` or `... run STUDY --participant P01`: the words of `metagraph study`, on an X
server with xdotool. A scripted participant reads, agrees, practises, wires
the clips of each task without a mistake and answers. One who does not know names goes by what the reference says.
"""

from __future__ import annotations

import os
import sys
import time
import traceback
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

from PySide6.QtCore import QPoint, Qt, QTimer
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from app.cli.parser import main
from app.main import prepare_application
from metagraph.formats.store import read_project
from metagraph.graph.model import Project

LEFT = Qt.MouseButton.LeftButton


class Bot:
    """Waits as pytest-qt does."""

    def waitUntil(self, until: Callable[[], bool], timeout: int) -> None:
        deadline = time.monotonic() + timeout / 1000
        while not until():
            if time.monotonic() > deadline:
                raise TimeoutError("what was waited for did not come")
            QTest.qWait(10)

    def wait(self, milliseconds: int) -> None:
        QTest.qWait(milliseconds)


def wanted(guide: Any, project: Project) -> Project:
    """Return the reference of the task with the clips called as the window calls them."""
    study, phase = guide.study, guide.sitting.phase
    names = {Path(c.path).name: c.name for c in project.clips.values()}
    if phase.names == "hidden":
        found = study.make_clip_numbers(guide.participant, phase.condition, phase.task)
        names = {path.name: names[number] for number, path in found.items()}
    reference = read_project(study.reference(phase.task))
    clips = {i: replace(c, name=names[Path(c.path).name]) for i, c in reference.clips.items()}
    return replace(reference, clips=clips)


def answer(question: Any, n: int) -> None:
    """Choose a number by a click, or put a mark on a line."""
    if hasattr(question, "mark"):
        QTest.mouseClick(question.mark, LEFT, pos=QPoint(question.mark.width() * (3 + n) // 12, 18))
    else:
        QTest.mouseClick(question.group.button(3 if n % 2 == 0 else 1), LEFT)


def take_part() -> None:
    from app.features.study.study_guide import Guide
    from app.shell.window import Window
    from tests.app.conftest import Driver, activate
    from tests.app.features.study.conftest import Participant
    from tests.app.participant import Participant as Worker
    from tests.app.participant import Task

    window = next(w for w in QApplication.topLevelWidgets() if isinstance(w, Window))
    window.resize(1680, 1020)
    drive = Driver(window, Bot())
    drive.wait(lambda: window.findChild(Guide) is not None)
    guide = window.findChild(Guide)
    p = Participant(drive, guide)
    activate(window)
    while not guide.over_already and guide.sitting.phase is not None:
        phase = guide.sitting.phase
        print(phase.index, phase.name, phase.condition or "", phase.task or "", phase.names, flush=True)
        drive.wait(lambda: guide.screen.isVisible() or guide._working)
        if phase.name == "consent":
            p.page.tick.setFocus()
            QTest.keyClick(p.page.tick, Qt.Key.Key_Space)
        elif phase.questionnaire is not None:
            for n, question in enumerate(p.page.questions):
                answer(question, n)
        elif phase.works:
            p.working()
            drive.pause(300)
            if phase.name == "task":
                project = wanted(guide, drive.document.project)
                worker = Worker(drive, Task(project, project))
                worker.act("meta" if phase.condition == "meta" else "manual, every connection")
                worker.hands.stop()
            p.finish()
            drive.wait(lambda before=phase: guide.sitting.phase is not before)
            continue
        p.go()
        drive.pause(50)


def go() -> None:
    try:
        take_part()
        if sys.argv[1] == "run":  # its window stays open for the next participant
            QTimer.singleShot(200, QApplication.quit)
    except BaseException:
        traceback.print_exc()
        sys.stderr.flush()
        os._exit(9)


if __name__ == "__main__":
    prepare_application()
    QTimer.singleShot(1500, go)
    sys.exit(main(["study", *sys.argv[1:]]))
