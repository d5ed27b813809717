"""`metagraph study`: reports, data for other tools, the published example, simulated people."""

from __future__ import annotations

import json
import os
import re
from pathlib import Path

import pytest

from app.cli.parser import main

# Papers are drawn by Qt; whoever opens windows later in this process needs its application.
pytestmark = pytest.mark.usefixtures("qapp")


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


@pytest.mark.nightly
def test_a_report_is_written_and_told(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["study", "report", str(folder), "--json"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert data["people"] == 4 and data["simulated"] and data["missing"] == []
    assert data["ratio"]["low"] < 5 < data["ratio"]["high"]
    assert (folder / "report" / "report.html").is_file() and len(data["written"]) == 8 + 2 * 7 + 2
    assert any("no interval by ranks" in words for words in data["cautions"])
    assert (
        main(["study", "report", str(folder / "study.yaml"), "--no-jumps", "--out", str(folder / "else")])
        == 0
    )
    shown = capsys.readouterr()
    assert "times as long as with the meta-graph" in shown.out and (folder / "else" / "tasks.csv").is_file()


@pytest.mark.nightly
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
    assert "Nobody" in shown.out and "(P01, P02, P03, P04)" in shown.err


def test_the_published_example_is_recomputed(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["study", "example"]) == 0
    assert "7.88" in capsys.readouterr().out
    assert main(["study", "example", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["ratio"] == pytest.approx(7.875)


def test_errors_name_file_cause_and_remedy(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["study", "report", str(tmp_path)]) == 1
    assert "study.yaml" in capsys.readouterr().err
    assert main(["study", "simulate", str(folder), "--json"]) == 1
    assert "is not empty" in json.loads(capsys.readouterr().out)["error"]
    assert main(["study", "simulate", str(tmp_path / "new"), "--ratio", "0"]) == 1
    assert "ratio" in capsys.readouterr().err


def copied(folder: Path, tmp_path: Path) -> Path:
    import shutil

    return Path(
        shutil.copytree(folder, tmp_path / "study", ignore=shutil.ignore_patterns("report*", "else", "bids"))
    )


@pytest.mark.nightly
def test_figures_of_the_same_data_are_the_same_papers(folder: Path, tmp_path: Path) -> None:
    for name in ("one", "two"):
        assert (
            main(["study", "report", str(folder), "--no-jumps", "--out", str(tmp_path / name), "--json"]) == 0
        )
    papers = sorted(p.relative_to(tmp_path / "one") for p in (tmp_path / "one").rglob("*.pdf"))
    assert len(papers) == 7
    for path in papers:
        content = (tmp_path / "one" / path).read_bytes()
        assert content.startswith(b"%PDF") and content == (tmp_path / "two" / path).read_bytes(), path


def test_what_is_frozen_and_changed_is_refused_unless_told_why(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    study = copied(folder, tmp_path)
    assert main(["study", "freeze", str(study), "--json"]) == 0
    first = json.loads(capsys.readouterr().out)
    assert main(["study", "freeze", str(study), "--json"]) == 0, "nothing changed"
    assert json.loads(capsys.readouterr().out) == first
    clip = next((study / "clips").iterdir())
    clip.write_bytes(clip.read_bytes() + b"\n")
    assert main(["study", "freeze", str(study)]) == 1
    assert f"clips/{clip.name}" in capsys.readouterr().err
    assert main(["study", "freeze", str(study), "--force", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["seal"] != first["seal"]
    kept = json.loads((study / "study.frozen.json").read_text())
    assert kept["earlier"][0]["seal"] == first["seal"]
    (study / "study.frozen.json").write_text(json.dumps({**kept, "seal": "0"}))
    assert main(["study", "freeze", str(study)]) == 1
    assert "was changed by hand" in capsys.readouterr().err


@pytest.mark.nightly
def test_who_withdraws_is_left_out_and_who_asks_is_deleted(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    study = copied(folder, tmp_path)
    assert main(["study", "report", str(study), "--no-jumps"]) == 0
    assert main(["study", "withdraw", str(study), "P02", "--why", "by mail"]) == 0
    assert "report.html" in capsys.readouterr().err
    assert main(["study", "report", str(study), "--no-jumps", "--json"]) == 0
    shown = capsys.readouterr()
    assert json.loads(shown.out)["ratio"]["n"] == 3 and "P02: withdrew" in shown.err
    assert main(["study", "delete", str(study), "P02", "--json"]) == 1, "it is asked first"
    assert (study / "data" / "P02").is_dir()
    capsys.readouterr()
    lock = study / "data" / "P02" / "sitting.lock"
    lock.write_text(f"{os.getpid()}\n")
    assert main(["study", "delete", str(study), "P02", "--yes"]) == 1, "a window has it open"
    assert "has this sitting open" in capsys.readouterr().err
    lock.unlink()
    assert main(["study", "delete", str(study), "P02", "--yes"]) == 0
    assert not (study / "data" / "P02").exists()
    (note,) = [json.loads(line) for line in (study / "deletions.jsonl").read_text().splitlines()]
    assert note.keys() == {"deleted", "participant", "files", "version"} and note["participant"] == "P02"
    assert main(["study", "delete", str(study), "P02", "--yes"]) == 1
    assert "P02" in capsys.readouterr().err
    assert main(["study", "report", str(study), "--no-jumps"]) == 0
    assert re.search(r"P02: .*deleted", capsys.readouterr().err)
    assert main(["study", "withdraw", str(study), "nobody"]) == 1
