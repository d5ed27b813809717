"""`metagraph reproduce`: the papers' exhibits from the command line."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from app.cli.parser import main
from app.cli.progress_line import describe_seconds
from app.cli.reproduce_command import _estimate
from metagraph.formats.bvh.file import write_bvh
from metagraph.research.exhibits.exhibit import NAMES, MadeExhibit, choose_exhibits
from tests.synthesis.talking import speech, talking
from tests.wavs import wav


def test_it_lists_every_exhibit_with_how_long_it_takes(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["reproduce", "--list"]) == 0
    told = capsys.readouterr().out
    assert all(name in told for name in NAMES) and "table 1" in told and "--full" in told
    assert main(["reproduce", "--list", "generator", "--json"]) == 0
    assert {row["paper"] for row in json.loads(capsys.readouterr().out)} == {"generator"}


@pytest.mark.parametrize(
    ("words", "cause"),
    [
        (["ratings"], "give a folder for the report"),
        (["ratngs", "--into", "x"], "there is no exhibit 'ratngs'"),
        (["ratings", "--into", "x", "--takes", "gone"], "there is no such folder"),
        (["ratings", "--into", "x", "--model", "gone.mgmodel"], "there is no such model"),
        (["ratings", "--into", "x", "--project", "gone.metagraph.yaml"], "gone.metagraph.yaml"),
    ],
)
def test_what_cannot_be_is_refused(
    words: list[str],
    cause: str,
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["reproduce", *words]) == 1
    assert cause in capsys.readouterr().err
    assert not (tmp_path / "x").exists()


def test_a_report_and_its_data_are_written(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    assert main(["reproduce", "ratings", "matrix", "sizes", "--into", str(tmp_path / "out")]) == 0
    told = capsys.readouterr().out
    assert "without responses p = 0.113" in told and "DOES NOT HOLD" in told
    assert "<svg" in (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    data = json.loads((tmp_path / "out" / "report.json").read_bytes())
    assert [e["exhibit"] for e in data["exhibits"]] == ["matrix", "ratings", "sizes"]
    assert data["exhibits"][1]["numbers"]["no constraints"]["exact"] == pytest.approx(0.028, abs=5e-4)


@pytest.mark.nightly
def test_somebodys_own_takes_are_read_and_what_is_odd_is_told(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    takes = tmp_path / "lab"
    takes.mkdir()
    for n in (1, 2):
        for side in (1, 2):
            said = speech(20.0, 10 * n + side)
            write_bvh(talking(f"talk{n}", said, 20.0, side), takes / f"talk{n}_{side}.bvh")
            rows = "".join(f"{s.start}\t{s.end}\t{s.kind}\n" for s in said)
            (takes / f"talk{n}_{side}.tsv").write_text(rows, encoding="utf-8")
        noise = np.random.default_rng(n).standard_normal((20 * 16000, 2)) * 2000
        wav(takes / f"talk{n}.wav", 16000, noise.astype("<i2").tobytes(), 2)
    (takes / "broken_1.bvh").write_bytes(b"HIERARCHY")
    code = main(["reproduce", "rates", "components", "--takes", str(takes), "--into", str(tmp_path / "out")])
    out = capsys.readouterr()
    assert code == 0 and "broken_1" in out.err
    told = json.loads((tmp_path / "out" / "report.json").read_bytes())
    assert all("lab (pairs): 2 conversations" in e["material"] for e in told["exhibits"])
    assert told["exhibits"][0]["tables"][0]["rows"][-1][0].startswith("here")


def test_an_exhibit_that_cannot_be_made_spoils_no_other(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    empty = tmp_path / "empty.metagraph.yaml"
    empty.write_text("metagraph: 1\nname: empty\n", encoding="utf-8")
    code = main(["reproduce", "rates", "ratings", "--project", str(empty), "--into", str(tmp_path / "out")])
    assert code == 3
    told = capsys.readouterr().out
    assert "missing: " in told and "without responses" in told


def test_an_exhibit_that_fails_in_a_way_nobody_foresaw_spoils_no_other(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(_: object) -> None:
        raise KeyError("odd")

    monkeypatch.setattr("metagraph.research.exhibits.planning.exhibit_matrix", broken)
    assert main(["reproduce", "matrix", "ratings", "--into", str(tmp_path / "out")]) == 3
    told = capsys.readouterr().out
    assert "failed (KeyError: 'odd')" in told and "without responses" in told


def test_each_exhibit_is_there_as_soon_as_it_is_made(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def stop(_: object) -> None:
        assert "without responses" in capsys.readouterr().out
        raise KeyboardInterrupt

    monkeypatch.setattr("metagraph.research.exhibits.generated.exhibit_sizes", stop)
    assert main(["reproduce", "ratings", "sizes", "--into", str(tmp_path / "out")]) == 1
    data = json.loads((tmp_path / "out" / "report.json").read_bytes())
    assert [e["exhibit"] for e in data["exhibits"]] == ["ratings"]
    assert "<svg" in (tmp_path / "out" / "report.html").read_text(encoding="utf-8")


def test_what_is_left_follows_what_was_needed_so_far() -> None:
    exhibits = choose_exhibits(["ratings", "matrix", "sizes"])
    usual = [exhibit.seconds[0] for exhibit in exhibits]
    made = [(exhibits[0], MadeExhibit(""), 40 * usual[0])]
    assert _estimate(exhibits, [], False).startswith("1 of 3, about ")
    assert _estimate(exhibits, made, False) == f"2 of 3, about {describe_seconds(40 * sum(usual[1:]))} left"
