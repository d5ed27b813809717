"""The pilot kit from its command to its data: a scripted participant takes part with real events."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from metagraph.research.study.analysis.reading import collect_study
from metagraph.research.study.logs.log import read_log
from metagraph.research.study.study_plan import read_study
from tests.app.conftest import real_pointer

pytestmark = [pytest.mark.window, pytest.mark.gl, pytest.mark.nightly]
ROOT = Path(__file__).resolve().parents[4]


def test_the_pilot_is_gone_through_from_its_command_to_its_data(tmp_path: Path, qapp: object) -> None:
    if not real_pointer():
        pytest.skip("real drags need X11 and xdotool")
    folder = tmp_path / "pilot"
    env = {
        **os.environ,
        "XDG_DATA_HOME": str(tmp_path / "d"),
        "XDG_CONFIG_HOME": str(tmp_path / "c"),
        "PYTHONPATH": str(ROOT),
    }
    script = Path(__file__).with_name("pilot_sitting.py")
    done = subprocess.run(
        [sys.executable, script, folder], env=env, capture_output=True, text=True, timeout=400
    )
    assert done.returncode == 0, done.stdout + done.stderr
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
