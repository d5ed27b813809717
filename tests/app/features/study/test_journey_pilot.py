"""The pilot kit and the example study from their commands to their data: a scripted participant takes part
with real events.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from metagraph.research.study.analysis.reading import collect_study
from metagraph.research.study.logs.log import read_log
from metagraph.research.study.sitting import list_phases
from metagraph.research.study.study_plan import read_study
from tests.app.conftest import real_pointer

pytestmark = [pytest.mark.window, pytest.mark.gl, pytest.mark.nightly]
ROOT = Path(__file__).resolve().parents[4]


def take_part(tmp_path: Path, *words: object) -> str:
    """Let the script take part in a study; return what it printed."""
    env = {
        **os.environ,
        "XDG_DATA_HOME": str(tmp_path / "d"),
        "XDG_CONFIG_HOME": str(tmp_path / "c"),
        "PYTHONPATH": str(ROOT),
    }
    command = [sys.executable, str(Path(__file__).with_name("scripted_sitting.py")), *map(str, words)]
    done = subprocess.run(command, env=env, capture_output=True, text=True, timeout=400)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_the_example_studys_20_pages_are_gone_through_to_the_end(tmp_path: Path, qapp: object) -> None:
    if not real_pointer():
        pytest.skip("real drags need X11 and xdotool")
    shutil.copytree(ROOT / "sample_clips" / "study", tmp_path / "study")
    for name in ("clips", "mannequin.glb", "ada.glb"):
        (tmp_path / name).symlink_to(ROOT / "sample_clips" / name)
    told = take_part(tmp_path, "run", tmp_path / "study", "--participant", "P01")
    study = read_study(tmp_path / "study")
    pages = list_phases(study, "P01")
    assert len(pages) == 20 and f"{pages[-1].index} end" in told
    log = read_log(study.log("P01"))
    assert log.complete and log.problems == ()
    rows = collect_study(study.folder).rows
    assert len(rows) == 4
    assert all(r.done and r.score is not None and r.score.f1 == 1.0 for r in rows)
    assert {a.questionnaire for a in log.answers()} == {"sus", "tlx"}


def test_the_pilot_is_gone_through_from_its_command_to_its_data(tmp_path: Path, qapp: object) -> None:
    if not real_pointer():
        pytest.skip("real drags need X11 and xdotool")
    folder = tmp_path / "pilot"
    take_part(tmp_path, "pilot", folder)
    study = read_study(folder)
    assert read_log(study.log("P01")).complete
    rows = collect_study(folder).rows
    assert {(r.run.condition, r.run.names) for r in rows} == {
        (c, n) for c in ("meta", "manual") for n in ("shown", "hidden")
    }
    assert all(r.done and r.score is not None and r.score.f1 == 1.0 for r in rows)
    odd = {(m.what, r.run.names) for r in rows for m in r.score.mistakes}
    assert odd <= {("mask", "hidden"), ("jump", "hidden"), ("jump", "shown")}  # no name says which arm moves
    assert (folder / "report" / "report.html").is_file()
    assert len(list((folder / "bids").rglob("*_events.tsv"))) == 4
    assert (folder / "bids" / "phenotype" / "sus.tsv").is_file()
