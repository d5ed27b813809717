"""The window started from the command line: its checks of what commands write are not the window's."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from app.cli import window_command
from app.cli.parser import main
from app.project.document import Document
from metagraph.formats.locking import Lock, make_owner
from metagraph.formats.store import SUFFIX, read_project, save_project
from metagraph.graph import edits
from metagraph.graph.model import Project


def seeded(document: Document, seed: int) -> None:
    document.edit("Change seed", lambda p: edits.set_settings(p, seed=seed))


@pytest.mark.parametrize("given", [True, False], ids=["a file that is opened", "a file that is made"])
@pytest.mark.parametrize("command", [("window",), ()], ids=["by its name", "without one"])
def test_a_project_is_saved_as_often_as_the_user_wants(
    given: bool, command: tuple[str, ...], qapp: Any, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    path = tmp_path / f"mine{SUFFIX}"
    if given:
        save_project(Project(), path)

    def use(project: Path | None, sample: bool, clip: str | None, clips: object) -> int:
        document = Document()
        document.lock = Lock(path, make_owner())
        document.lock.acquire()
        document.load(read_project(path) if project else Project(), project, lock=document.lock)
        for seed in (7, 8, 9):
            seeded(document, seed)
            document.save(path)
        document.close_journal()
        return 0

    monkeypatch.setattr("app.main.run_window", use)
    monkeypatch.setattr(window_command, "has_screen", lambda: True)
    assert main([*command, *([str(path)] if given else [])]) == 0
    assert read_project(path).settings.seed == 9
    assert read_project(path.with_name(f"{path.name}.1")).settings.seed == 8


def test_clips_without_a_screen_are_refused_with_what_to_do(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Else the demo of the sample would run, and nobody would see what became of the clips."""
    monkeypatch.setattr(window_command, "has_screen", lambda: False)
    monkeypatch.delenv("QT_QPA_PLATFORM", raising=False)
    assert main([str(tmp_path)]) == 1
    assert f"metagraph label {tmp_path}" in capsys.readouterr().err
