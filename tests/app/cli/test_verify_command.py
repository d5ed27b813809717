"""`metagraph verify` prints one page, and its exit code says whether all is whole."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from app.cli.parser import main
from metagraph.formats.store import SUFFIX, save_project
from metagraph.graph.model import Project


@pytest.fixture
def project(tmp_path: Path) -> Path:
    save_project(Project("show"), tmp_path / f"show{SUFFIX}")
    return tmp_path / f"show{SUFFIX}"


def test_a_whole_project_ends_with_0_and_says_so(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["verify", str(project)]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == f"{project} (project)" and lines[-1] == "Everything is intact."
    assert "  versions    none" in lines, "one line a part, aligned"


def test_what_is_not_whole_ends_with_3_and_is_counted(
    project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    project.with_name(f"{project.name}.1").write_text("nonsense")
    assert main(["verify", str(project)]) == 3
    lines = capsys.readouterr().out.splitlines()
    assert lines[-1] == "1 thing is not whole."
    (at,) = (n for n, line in enumerate(lines) if line.startswith(f"    {project.name}.1"))
    assert lines[at - 1].strip() == "versions    0 of 1 can be opened" and lines[at + 1].startswith("      ")


def test_json_says_the_same(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["verify", "--json", str(project)]) == 0
    assert json.loads(capsys.readouterr().out)["whole"] is True
    project.write_text("metagraph: 2\nclips: [")
    assert main(["verify", "--json", str(project)]) == 3
    found = json.loads(capsys.readouterr().out)
    (checked,) = found["checked"]
    problems = [problem for part in checked["parts"] for problem in part["problems"]]
    assert not found["whole"] and not checked["whole"] and checked["kind"] == "project"
    assert problems and all({"place", "message", "remedy"} == {*problem} for problem in problems)


def test_no_such_file_ends_with_1_and_no_path_with_2(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["verify", str(tmp_path / f"none{SUFFIX}")]) == 1
    assert "No such file" in capsys.readouterr().err
    with pytest.raises(SystemExit) as caught:
        main(["verify"])
    assert caught.value.code == 2
