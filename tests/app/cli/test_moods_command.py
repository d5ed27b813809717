"""`metagraph moods`: the moods of a character and its lines, told, set, and heard in voices."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from app.cli.parser import main
from metagraph.formats.store import open_project


def run(capsys: pytest.CaptureFixture[str], *words: object) -> tuple[int, Any]:
    code = main(["moods", *map(str, words), "--json"])
    out = capsys.readouterr().out
    return code, json.loads(out) if out else None


def test_a_mood_is_set_kept_and_told(few: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    import shutil

    folder = shutil.copytree(few.parent, tmp_path / "few")
    project = folder / few.name
    code, told = run(capsys, project, "--mood", "sad", "--intensity", "1.5")
    assert code == 0 and (told["valence"], told["arousal"], told["intensity"]) == (-0.71, -0.37, 1.5)
    assert open_project(project).project.life.arousal == -0.37
    before = project.read_bytes()
    assert run(capsys, project)[1]["intensity"] == 1.5 and project.read_bytes() == before
    assert run(capsys, project, "--mood", "0.5,-0.25")[1]["valence"] == 0.5


@pytest.mark.parametrize("word", ["blue", "1", "2,0", "a,b"])
def test_what_is_no_mood_is_refused_with_those_there_are(
    few: Path, word: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["moods", str(few), "--mood", word]) == 1
    assert "excited" in capsys.readouterr().err
