"""`metagraph study pilot`: the kit, who is next, and what is written; a sitting is driven in
tests/app/features/study.
"""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from app.cli import study_pilot
from app.cli.parser import main
from metagraph.research.study.sitting import Sitting, list_phases
from metagraph.research.study.study_plan import Study, read_study
from sample_clips.make.study import PILOT, pilot_text


def test_the_kit_is_its_makers_and_lasts_at_most_twenty_minutes_of_work() -> None:
    assert (PILOT / "study.yaml").read_text(encoding="utf-8") == pilot_text()
    study = read_study(PILOT)
    assert study.problems() == []
    work = [p.minutes for p in list_phases(study, "P01") if p.works]
    assert len(work) == 6 and sum(work) == 20


def test_the_kit_is_written_whole_and_only_into_an_empty_folder(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "pilot"
    assert main(["study", "pilot", str(folder), "--make", "--json"]) == 0
    assert Path(json.loads(capsys.readouterr().out)["study"]).parent == folder.resolve()
    study = read_study(folder)
    assert study.problems() == []
    assert all(p.parent == folder / "clips" for t in study.plan.tasks for p in study.clips(t.clips))
    other = tmp_path / "other"
    other.mkdir()
    (other / "mine.txt").write_text("mine")
    assert main(["study", "pilot", str(other), "--make"]) == 1
    assert "is not empty" in capsys.readouterr().err


def test_the_next_participant_is_led_and_everything_is_written_then(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    led = []

    def lead(study: Study, participant: str) -> None:
        led.append(participant)
        sitting = Sitting(study, participant)
        while sitting.phase is not None and not sitting.phase.works:
            sitting.begin()
            sitting.end()
        sitting.close()

    monkeypatch.setattr(study_pilot, "_lead", lead)
    folder = tmp_path / "pilot"
    assert main(["study", "pilot", str(folder)]) == study_pilot.INCOMPLETE
    assert main(["study", "pilot", str(folder), "--participant", "P03"]) == study_pilot.INCOMPLETE
    assert led == ["P01", "P03"]
    assert "report.html" in capsys.readouterr().out
    assert (folder / "bids" / "dataset_description.json").is_file()
    assert main(["study", "pilot", str(folder), "--participant", "nobody"]) == 1
    assert "'nobody' does not take part" in capsys.readouterr().err
