"""`metagraph study`: reports, data for other tools, the published example, simulated people."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from app.cli.parser import main


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    place = tmp_path_factory.mktemp("simulated") / "study"
    assert (
        main(
            ["study", "simulate", str(place), "--participants", "4", "--seed", "3", "--ratio", "5", "--json"]
        )
        == 0
    )
    return place


def test_without_an_action_the_actions_are_listed(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["study"])
    assert "action" in capsys.readouterr().err
    with pytest.raises(SystemExit):
        main(["study", "--help"])
    shown = capsys.readouterr().out
    assert all(name in shown for name in ("report", "export", "example", "simulate"))


def test_a_report_is_written_and_told(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["study", "report", str(folder), "--json"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert data["people"] == 4 and data["simulated"] and data["missing"] == []
    assert data["ratio"]["low"] < 5 < data["ratio"]["high"]
    assert (folder / "report" / "report.html").is_file() and len(data["written"]) == 6
    assert any("cannot reach p = 0.05" in words for words in data["cautions"])
    assert (
        main(["study", "report", str(folder / "study.yaml"), "--no-jumps", "--out", str(folder / "else")])
        == 0
    )
    shown = capsys.readouterr()
    assert "times as long as with the meta-graph" in shown.out and (folder / "else" / "tasks.csv").is_file()


def test_data_are_exported(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["study", "export", str(folder), "--bids", str(folder / "bids")]) == 0
    assert "files" in capsys.readouterr().out
    assert (folder / "bids" / "sub-P01" / "beh").is_dir()


def test_nothing_to_compare_is_told_by_the_exit_code(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    plan = (folder / "study.yaml").read_text()
    for name in ("clips", "small.metagraph.yaml", "large.metagraph.yaml"):
        (tmp_path / name).symlink_to(folder / name)
    (tmp_path / "study.yaml").write_text(plan)
    assert main(["study", "report", str(tmp_path)]) == 3
    shown = capsys.readouterr()
    assert "Nobody has begun a task yet." in shown.out and "note: P01: has not begun." in shown.err


def test_the_published_example_is_recomputed(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["study", "example"]) == 0
    assert "7.88" in capsys.readouterr().out
    assert main(["study", "example", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["ratio"] == pytest.approx(7.875)


def test_errors_name_file_cause_and_remedy(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["study", "report", str(tmp_path)]) == 1
    assert "study.yaml, on opening it: cannot be read" in capsys.readouterr().err
    assert main(["study", "simulate", str(folder), "--json"]) == 1
    assert "is not empty" in json.loads(capsys.readouterr().out)["error"]
    assert main(["study", "simulate", str(tmp_path / "new"), "--ratio", "0"]) == 1
    assert "ratio should be greater than 0" in capsys.readouterr().err
