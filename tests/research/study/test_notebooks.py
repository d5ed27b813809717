"""The notebooks beside a report draw every figure again, from its tables alone."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from metagraph.research.study.analysis.reading import collect_study
from metagraph.research.study.analysis.results import Results, analyse_study
from metagraph.research.study.report import draw_study_figures, write_study_report
from metagraph.research.study.simulation.files import write_study
from metagraph.research.study.simulation.people import Truth

# Papers are drawn by Qt; whoever opens windows later in this process needs its application.
pytestmark = pytest.mark.usefixtures("qapp")

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> Results:
    folder = write_study(tmp_path_factory.mktemp("made") / "study", Truth(participants=6)).folder
    shutil.rmtree(folder / "data" / "P06")
    return analyse_study(collect_study(folder, jumps=False))


@pytest.mark.nightly
def test_python_draws_every_figure_as_the_report_has_it(results: Results, tmp_path: Path) -> None:
    write_study_report(results, tmp_path / "report")
    cells = json.loads((tmp_path / "report" / "notebooks" / "figures.ipynb").read_text())["cells"]
    program = "\n\n".join("".join(c["source"]) for c in cells if c["cell_type"] == "code")
    env = {
        **os.environ,
        "PYTHONPATH": str(ROOT),
        "TABLES": str(tmp_path / "report"),
        "OUT": str(tmp_path / "again"),
    }
    done = subprocess.run(
        [sys.executable, "-c", program], env=env, capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 0, done.stderr
    for name in draw_study_figures(results):
        one, other = ((tmp_path / where / f"{name}.svg").read_text() for where in ("report/figures", "again"))
        assert [*unlike(one, other)] == [], name


def unlike(one: str, other: str):
    """Yield numbers that differ by more than a pixel's fifth; all else is to be the same."""
    number = r"-?\d+\.?\d*"
    assert re.sub(number, "#", one) == re.sub(number, "#", other)
    for a, b in zip(re.findall(number, one), re.findall(number, other), strict=True):
        if abs(float(a) - float(b)) > 0.21:
            yield a, b


@pytest.mark.skipif(shutil.which("Rscript") is None, reason="R is not installed")
def test_r_draws_every_figure(results: Results, tmp_path: Path) -> None:
    write_study_report(results, tmp_path / "report")
    script = tmp_path / "report" / "notebooks" / "figures.R"
    done = subprocess.run(
        ["Rscript", str(script), str(tmp_path / "report"), str(tmp_path / "again")],
        capture_output=True, text=True, timeout=300,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert {p.stem for p in (tmp_path / "again").glob("*.pdf")} == set(draw_study_figures(results))
    assert f"ratio {results.time.ratio.value:.3f}" in done.stdout if results.time else True
