"""Benchmarks do not rot: what they import is there, what they say of themselves is said to whoever measures,
and a small one runs.
"""

from __future__ import annotations

import ast
import runpy
import sys
from importlib import import_module
from pathlib import Path

import pytest

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
