"""Data for other tools: BIDS names, columns that are described, and times that add up."""

from __future__ import annotations

import csv
import json
import re
import shutil
from pathlib import Path

import pytest

from metagraph.errors import FileError
from metagraph.research.study.analysis.reading import collect_study
from metagraph.research.study.analysis.results import analyse_study
from metagraph.research.study.interchange.bids import write_bids
from metagraph.research.study.logs.log import read_log
from metagraph.research.study.logs.withdrawal import note_withdrawal
from metagraph.research.study.questionnaires import compute_sus_score
from metagraph.research.study.simulation.files import write_study
from metagraph.research.study.simulation.people import Truth
from metagraph.research.study.study_plan import FILE, Study, read_study


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Study:
    return write_study(tmp_path_factory.mktemp("made") / "study", Truth(participants=2))


@pytest.fixture(scope="module")
def out(study: Study) -> Path:
    place = study.folder.parent / "bids"
    write_bids(study, analyse_study(collect_study(study.folder, jumps=False)), place)
    return place


def rows(path: Path) -> list[dict[str, str]]:
    return list(csv.DictReader(path.read_text().splitlines(), delimiter="\t"))


def test_files_are_named_as_bids_names_them(out: Path) -> None:
    names = {p.relative_to(out).as_posix() for p in out.rglob("*") if p.is_file()}
    assert {
        "dataset_description.json",
        "README",
        "participants.tsv",
        "participants.json",
        "task-small_events.json",
        "phenotype/sus.tsv",
        "phenotype/tlx.json",
        "derivatives/metagraph/dataset_description.json",
        "derivatives/metagraph/clips.tsv",
        "derivatives/metagraph/estimates.tsv",
    } <= names
    tasks = [n for n in names if n.startswith("sub-")]
    assert len(tasks) == 2 * 2 * 2 * 3
    assert all(
        re.fullmatch(
            r"(sub-P0\d)/beh/\1_task-(small|large)_acq-(meta|manual)_(events.tsv|beh.tsv|beh.json)", n
        )
        for n in tasks
    )
    assert not [n for n in names if n.endswith(".csv")], "tables are TSV"
    assert json.loads((out / "dataset_description.json").read_text())["BIDSVersion"] == "1.9.0"
    assert "simulated" in (out / "README").read_text()


def test_every_column_is_described(out: Path) -> None:
    for path in out.rglob("*.tsv"):
        own = path.with_suffix(".json")
        root = out / f"{path.name.split('_acq')[0].split('_')[-1]}_events.json"
        told = json.loads((own if own.is_file() else root).read_text())
        found = rows(path)
        assert found and set(found[0]) <= set(told), path.name
    levels = json.loads((out / "task-small_events.json").read_text())["trial_type"]["Levels"]
    assert {r["trial_type"] for path in out.rglob("*_events.tsv") for r in rows(path)} <= set(levels)


def test_what_describes_events_describes_columns_alone(out: Path) -> None:
    """The older validator takes nothing but objects there: what was asked stands beside the task's figures."""
    for path in out.rglob("*_events.json"):
        assert all(isinstance(v, dict) for v in json.loads(path.read_text()).values()), path.name
    told = json.loads(next(out.rglob("*_task-small_*_beh.json")).read_text())
    assert (told["TaskName"], told["Instructions"]) == ("9 clips", "Make them play without a jump.")
    (task,) = rows(next(out.rglob("sub-P01_task-small_acq-meta_beh.tsv")))
    assert float(task["seconds"]) > 0 and task["finished"] == "yes"


def test_questionnaires_have_their_items(study: Study, out: Path) -> None:
    found = rows(out / "phenotype" / "sus.tsv")
    assert [r["participant_id"] for r in found] == ["sub-P01", "sub-P02"]
    answers = {
        (a.condition, a.item): a.value
        for a in read_log(study.log("P01")).answers()
        if a.questionnaire == "sus"
    }
    assert len(answers) == 20
    for (condition, item), value in answers.items():
        assert int(found[0][f"{condition}_{item}"]) == value
    assert float(found[0]["meta_score"]) == compute_sus_score(
        {i: v for (c, i), v in answers.items() if c == "meta"}
    )
    told = json.loads((out / "phenotype" / "sus.json").read_text())
    assert "Brooke" in told["MeasurementToolMetadata"]["Description"]
    assert told["manual_sus1"]["Levels"]["5"] == "Strongly agree"
    assert told["manual_sus1"]["Description"].startswith("I think that I would like to use this system")


def test_who_withdrew_is_in_no_export(study: Study, tmp_path: Path) -> None:
    shutil.copytree(study.folder, tmp_path / "study")
    again = read_study(tmp_path / "study")
    note_withdrawal(again, "P02")
    written = write_bids(again, analyse_study(collect_study(again.folder, jumps=False)), tmp_path / "out")
    assert not [p for p in written if "P02" in p.as_posix() or b"P02" in p.read_bytes()]


def test_onsets_ascend_and_operators_add_up(study: Study, out: Path) -> None:
    for run in read_log(study.log("P01")).tasks():
        found = rows(out / f"sub-P01/beh/sub-P01_task-{run.task}_acq-{run.condition}_events.tsv")
        onsets = [float(r["onset"]) for r in found]
        assert onsets == sorted(onsets) and onsets[0] >= 0
        assert max(o + float(r["duration"]) for o, r in zip(onsets, found, strict=True)) == pytest.approx(
            run.seconds, abs=0.01
        )
        assert sum(int(r["keys"]) for r in found if r["keys"] != "n/a") == run.operators["K"]


def test_time_goes_on_over_a_restart(study: Study, tmp_path: Path) -> None:
    shutil.copytree(study.folder, tmp_path / "study")
    log = tmp_path / "study" / "data" / "P01" / "log.jsonl"
    events = [json.loads(line) for line in log.read_text().splitlines()]
    first = next(n for n, e in enumerate(events) if e["type"] == "ops") + 1
    start = events[first]["mono"]
    for e in events[first:]:
        e["run"], e["mono"] = "second", round(e["mono"] - start, 6)
    log.write_text("".join(json.dumps(e) + "\n" for e in events))
    again = read_study(tmp_path / "study")
    write_bids(again, analyse_study(collect_study(again.folder, jumps=False)), tmp_path / "out")
    path = next((tmp_path / "out" / "sub-P01" / "beh").glob("*_events.tsv"))
    assert all(
        float(a["onset"]) <= float(b["onset"]) for a, b in zip(rows(path), rows(path)[1:], strict=False)
    )


def test_people_who_have_not_begun_are_left_out(study: Study, tmp_path: Path) -> None:
    shutil.copytree(study.folder, tmp_path / "study")
    shutil.rmtree(tmp_path / "study" / "data" / "P02")
    again = read_study(tmp_path / "study")
    write_bids(again, analyse_study(collect_study(again.folder, jumps=False)), tmp_path / "out")
    assert [r["participant_id"] for r in rows(tmp_path / "out" / "participants.tsv")] == ["sub-P01"]


def test_names_that_bids_cannot_tell_apart_are_refused(study: Study, tmp_path: Path) -> None:
    shutil.copytree(study.folder, tmp_path / "study")
    path = tmp_path / "study" / FILE
    path.write_text(path.read_text().replace("participants: 2", "participants: [A-1, A_1]"))
    again = read_study(path)
    with pytest.raises(FileError, match="the same in letters and digits"):
        write_bids(again, analyse_study(collect_study(path, jumps=False)), tmp_path / "out")
