"""Programs edit in the window: a command lets them, a button shows it and forbids it, each edit is seen."""

from __future__ import annotations

import shutil
import subprocess
import sys
import threading
from pathlib import Path

import pytest
from PySide6.QtCore import QCoreApplication

from app.authoring.door_key import find_key
from app.features.agents import AgentsButton
from metagraph.formats.store import save_project
from metagraph.graph.model import Project

ROOT = Path(__file__).parents[4]
SCRIPT = ROOT / "docs" / "clients" / "author_folder.py"
AUTHOR = (sys.executable, "-c", "from app.cli.parser import main; raise SystemExit(main())", "author")


@pytest.fixture
def named_as_the_program():
    """What the window and the command call themselves, so that they find each other."""
    names = QCoreApplication.organizationName(), QCoreApplication.applicationName()
    QCoreApplication.setOrganizationName("Metagraph")
    QCoreApplication.setApplicationName("Metagraph")
    yield
    QCoreApplication.setOrganizationName(names[0])
    QCoreApplication.setApplicationName(names[1])


def find_button(drive) -> AgentsButton:
    (button,) = drive.window.findChildren(AgentsButton)
    return button


@pytest.mark.window
def test_agents_are_let_in_by_a_command_and_sent_away_by_a_button(drive, few, tmp_path) -> None:
    path = Path(shutil.copytree(few.parent, tmp_path / "few")) / few.name
    drive.shell.actions.refresh()
    assert not drive.shell.actions["agents"].isEnabled()  # there is no file yet
    drive.files.open(path)
    drive.wait(lambda: drive.document.path == path)
    assert not find_button(drive).isVisible() and find_key(path) is None
    drive.do("agents")
    assert find_key(path) is not None and find_button(drive).isVisible()
    drive.shell.actions.refresh()
    assert drive.shell.actions["agents"].isChecked()
    drive.settle()
    drive.click((find_button(drive), find_button(drive).rect().center()))
    assert find_key(path) is None and not find_button(drive).isVisible()
    drive.do("agents")
    drive.do("agents")
    assert find_key(path) is None


@pytest.mark.window
@pytest.mark.nightly
def test_a_script_takes_a_folder_to_an_export_in_the_open_window(
    drive, tmp_path, named_as_the_program
) -> None:
    every = sorted((ROOT / "sample_clips" / "clips").glob("*.glb"))
    (tmp_path / "clips").mkdir()
    for number, clip in enumerate(every[1::2][:76]):
        shutil.copy(clip, tmp_path / "clips" / f"clip_{number:03}.glb")
    path = tmp_path / "new.metagraph.yaml"
    save_project(Project(name="new"), path)
    drive.files.open(path)
    drive.wait(lambda: drive.document.path == path)
    drive.do("agents")
    command = [sys.executable, str(SCRIPT), str(tmp_path / "clips"), str(path), *AUTHOR]
    done: list[subprocess.CompletedProcess[str]] = []
    thread = threading.Thread(
        target=lambda: done.append(
            subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=280)
        )
    )
    thread.start()
    drive.wait(lambda: bool(done), 290)
    assert done[0].returncode == 0, done[0].stderr[-2000:]
    assert "files 3 of 3 are as they were written" in done[0].stdout
    stack = drive.document.undo_stack
    steps = [stack.text(n) for n in range(stack.count())]
    assert steps[:2] == ["Import clips (agent)", "Label the folder (agent)"] and len(steps) <= 5
    paths = {clip.path for clip in drive.document.project.clips.values()}  # a held pose has its clip's path
    assert len(paths) == 76 and drive.document.dirty
    assert (tmp_path / "game" / "new.glb").is_file()
    while stack.canUndo():
        drive.document.undo()
    assert not drive.document.project.clips
