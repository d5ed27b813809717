"""Benchmarks do not rot: what they import is there, what they say of themselves is said to whoever measures,
and a small one runs.
"""

from __future__ import annotations

import ast
import runpy
import shutil
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest

from metagraph.engines.export import export_project
from metagraph.formats.store import open_project

ROOT = Path(__file__).resolve().parents[1]
FOLDER = ROOT / "tests" / "benchmarks"
SCRIPTS = sorted(p.name for p in FOLDER.glob("*.py"))
OURS = ("app", "metagraph", "preview", "sample_clips", "tests")
SEPARATE = ("metagraph.generation.training", "tests.generation.training")  # need torch, which is no test's


def imported(source: str) -> set[tuple[str, str]]:
    """Return module and name of whatever of ours is imported, wherever it stands."""
    out = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.ImportFrom) and node.module is not None and not node.level:
            out |= {(node.module, alias.name) for alias in node.names}
        elif isinstance(node, ast.Import):
            out |= {(alias.name, "") for alias in node.names}
    return {found for found in out if found[0].split(".")[0] in OURS and not found[0].startswith(SEPARATE)}


@pytest.mark.parametrize("script", SCRIPTS)
def test_what_a_benchmark_imports_is_there(script, monkeypatch):
    monkeypatch.syspath_prepend(str(FOLDER))  # they import one another
    for module, name in sorted(imported((FOLDER / script).read_text())):
        found = import_module(module)
        if name and not hasattr(found, name):
            import_module(f"{module}.{name}")


@pytest.mark.gl
def test_a_video_is_measured(monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["bench_video.py"])
    runpy.run_path(str(FOLDER / "bench_video.py"))["main"](0.1, 1)
    assert "0.1 s (1 rounds)" in capsys.readouterr().out


@pytest.mark.gl
@pytest.mark.nightly
def test_waits_are_measured(monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["bench_waits.py", "8"])
    assert runpy.run_path(str(FOLDER / "bench_waits.py"))["main"]() == 0
    rows = [line for line in capsys.readouterr().out.splitlines() if line.startswith("| ")]
    assert len(rows) == 10 and all(float(row.split("|")[2]) > 0 for row in rows[1:])
    assert sum(bool(row.split("|")[4].strip()) for row in rows[1:]) == 1, "the first result of label"


SMALL = {
    "bench_graph.py": ("3000",),
    "bench_growth.py": ("100,200", "6,12"),
}


@pytest.mark.parametrize("script", SMALL)
def test_a_benchmark_runs_small(script):
    command = [sys.executable, str(FOLDER / script), *SMALL[script]]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr[-2000:]
    assert len(done.stdout.splitlines()) > 5


@pytest.mark.gl
@pytest.mark.nightly
@pytest.mark.parametrize("script", ("bench_window.py edits proposing 12", "bench_library.py 30"))
def test_a_benchmark_of_the_window_runs_small(script):
    name, *words = script.split()
    screen = ["xvfb-run", "-a"] if shutil.which("xvfb-run") else []
    command = [*screen, sys.executable, str(FOLDER / name), *words]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr[-2000:]


def test_javascript_is_measured_on_an_export_of_today(tmp_path):
    if shutil.which("node") is None or not (ROOT / "tests" / "node_modules" / "three").is_dir():
        pytest.skip("node or three.js is not here")
    project = open_project(ROOT / "sample_clips" / "sample.metagraph.yaml").project
    mesh = ROOT / "sample_clips" / "mannequin.glb"
    export_project(project, tmp_path, character=mesh)
    command = ["node", str(FOLDER / "bench_javascript.mjs"), str(tmp_path), "1", "1"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr[-2000:]
    assert "three.js, one mixer each" in done.stdout


def test_they_are_listed_and_run_by_name(monkeypatch, capsys):
    main = runpy.run_path(str(FOLDER / "__main__.py"))["main"]
    assert main([]) == 0
    told = capsys.readouterr().out
    assert all(
        name.removeprefix("bench_").removesuffix(".py") in told for name in SCRIPTS if name[:6] == "bench_"
    )
    ran = []
    monkeypatch.setattr(
        "subprocess.run", lambda command, **_: ran.append(command[1]) or type("D", (), {"returncode": 3})()
    )
    assert main(["formats", "web"]) == 2 and [Path(x).stem for x in ran] == ["bench_formats", "bench_web"]
    assert main(["none"]) == 2 and "'none'" in capsys.readouterr().err
