"""`metagraph check`: what is wrong with a project, also as it plays."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from app.cli.parser import main
from metagraph.formats.store import SUFFIX, save_project
from metagraph.graph.model import Project
from tests.thorough import THOROUGH

SAMPLE = Path(__file__).parents[3] / "sample_clips" / "sample.metagraph.yaml"


@pytest.fixture
def project(tmp_path: Path) -> Path:
    path = tmp_path / f"empty{SUFFIX}"
    save_project(Project(), path)
    return path


def test_an_empty_project_has_nothing_to_play(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", str(project), "--play", "5", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["problems"] == []


@pytest.mark.parametrize("seconds", ["0", "-1", "nan", "1e9"])
def test_senseless_lengths_are_refused(
    project: Path, capsys: pytest.CaptureFixture[str], seconds: str
) -> None:
    assert main(["check", str(project), "--play", seconds]) == 1
    assert "--play" in capsys.readouterr().err


@pytest.mark.nightly
def test_the_sample_plays_without_an_error(few: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A tenth of its clips, or all of them where asked to be thorough: each is played once."""
    assert main(["check", str(SAMPLE if THOROUGH else few), "--play", "10", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)["problems"]
    assert not [p for p in found if p["severity"] == "error"]
    assert all("moment" in p for p in found)


def test_counts_are_in_words_and_a_folder_is_told(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", str(project)]) == 0
    assert capsys.readouterr().out.rstrip().endswith(("0 hints", "1 hint"))
    assert main(["check", str(project.parent)]) == 1
    assert "is a folder" in capsys.readouterr().err
