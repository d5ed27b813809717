"""A preregistration says what the report does, tells what is there already, and cannot change unnoticed."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from app.cli.parser import main
from metagraph.errors import FileError
from metagraph.research.study.plan.planning import assume_without_pilot, sample_size
from metagraph.research.study.plan.preregistration import FOLDER, Aims, list_departures, preregister
from metagraph.research.study.study_plan import read_study

FOUND = assume_without_pilot(2.3, 0.5)
AIMS = Aims(FOUND, sample_size(FOUND, 1.25), 1.25, 1.25, 0.8)


def test_both_forms_are_filled_in_and_frozen(tiny: Path) -> None:
    study = read_study(tiny)
    assert list_departures(study) == []
    record, osf, predicted = preregister(study, AIMS, None)
    assert preregister(study, AIMS, None)[0] == record, "the same once more changes nothing"
    text = osf.read_text()
    for heading in (
        "Hypotheses",
        "Stopping rule",
        "Sample size rationale",
        "Data exclusion",
        "Statistical models",
    ):
        assert f"### {heading}" in text, heading
    assert "No data " in text and "Two nods (limit 5 minutes)" in text
    assert predicted.read_text().count("### ") == 9
    assert list_departures(study) == []
    osf.write_text(text + "And one more hypothesis.")
    (words,) = list_departures(study)
    assert f"'{FOLDER}/osf.md'" in words
    other = Aims(FOUND, sample_size(FOUND, 1.5), 1.5, 1.25, 0.8)
    with pytest.raises(FileError, match="preregistration already"):
        preregister(study, other, None)
    preregister(study, other, None, force=True)
    assert list_departures(study) == []
    tiny.write_text(tiny.read_text().replace("own free will", "own will"))
    (words,) = list_departures(read_study(tiny))
    assert "study" in words and FOLDER not in words


def test_data_that_are_there_are_told(tiny: Path) -> None:
    study = read_study(tiny)
    study.log("P01").parent.mkdir(parents=True)
    study.log("P01").touch()
    assert "Data of 1 " in preregister(study, AIMS, None)[1].read_text()


def test_a_concealed_study_is_planned_allocated_and_checked(
    tiny: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    tiny.write_text(tiny.read_text() + "order: concealed\nsmallest: 1.3\n")
    words = ["study", "plan", str(tiny), "--ratio", "2.3", "--spread", "0.5", "--json"]
    assert main([*words, "--allocate", "--preregister"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["smallest"] == 1.3 and told["needed"]["show"] >= 6 and len(told["commitment"]) == 64
    assert told["commitment"] in (tiny.parent / FOLDER / "osf.md").read_text()
    assert main(["study", "check", str(tiny)]) == 3, "it has no reference"
    shown = capsys.readouterr().out
    assert "drawn at the start" in shown and "preregistered" not in shown
    tiny.write_text(tiny.read_text().replace("own free will", "own will"))
    main(["study", "check", str(tiny)])
    assert "preregistered" in capsys.readouterr().out


def test_what_is_not_assumed_is_asked_for(tiny: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["study", "plan", "--ratio", "2"]) == 1
    assert "--spread" in capsys.readouterr().err
    assert main(["study", "plan", "--ratio", "2", "--spread", "0.5", "--preregister"]) == 1
    assert main(["study", "plan", "--ratio", "2", "--spread", "0.5", "--dropouts", "1"]) == 1
    assert main(["study", "plan", "--pilot", str(tiny)]) == 1
    assert "a pilot needs 3 people" in capsys.readouterr().err
