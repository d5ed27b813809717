"""`metagraph export`: targets by name, vectors, and writing again whenever the project is saved."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from app.cli.parser import main
from metagraph.engines import vectors
from metagraph.engines.vectors import check_vectors, list_cases
from tests.processes import metagraph, started, until

ROOT = Path(__file__).resolve().parents[3]
SAMPLE = ROOT / "sample_clips" / "sample.metagraph.yaml"


def test_the_targets_are_listed(capsys):
    assert main(["export", "--targets"]) == 0
    out = capsys.readouterr().out
    assert "playcanvas" in out and "(experimental)" in out


def test_a_target_is_written_and_its_losses_are_told(few, tmp_path, capsys):
    assert (
        main(["export", str(few), "--target", "xstate", "--out", str(tmp_path), "--no-mesh", "--json"]) == 0
    )
    shown = capsys.readouterr()
    data = json.loads(shown.out)
    assert data["target"] == "xstate" and all(Path(path).is_file() for path in data["files"])
    assert data["losses"] and f"loses: {data['losses'][0]}" in shown.err


@pytest.mark.nightly
def test_vectors_are_written_beside_the_graph_they_are_of(few, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(vectors, "list_cases", lambda project: list(list_cases(project))[::8])
    assert main(["export", str(few), "-o", str(tmp_path), "--vectors", "--no-mesh"]) == 0
    assert check_vectors(tmp_path).failures == [] and "vectors" not in capsys.readouterr().err
    assert main(["export", str(few), "-o", str(tmp_path / "x"), "--vectors", "-t", "bml"]) == 0
    assert "vectors" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (["export"], 2, "give a project and a folder"),
        (["export", str(SAMPLE)], 2, "give a project and a folder"),
        (["export", str(SAMPLE), "-o", "x", "-t", "godott"], 1, "did you mean 'godot'"),
        (["export", str(SAMPLE), "-o", "x", "--serve"], 2, "--serve needs --target web"),
    ],
)
def test_what_is_missing_or_misspelt_is_told(arguments, code, words, capsys):
    assert main(arguments) == code
    assert words in capsys.readouterr().err


@pytest.mark.nightly
@pytest.mark.skipif(os.name == "nt", reason="is stopped by a signal")
def test_watching_writes_again_after_each_saving_and_survives_a_broken_project(few, tmp_path):
    project = tmp_path / "sample.metagraph.yaml"
    for name in ("clips", "lines", "ada.glb", "ben.glb"):
        (tmp_path / name).symlink_to(few.with_name(name))
    text = few.read_text()
    project.write_text(text)
    command = [
        sys.executable,
        "-m",
        "app.cli",
        "export",
        str(project),
        "-t",
        "bml",
        "-o",
        str(tmp_path / "out"),
        "--watch",
    ]
    with started(*command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE) as running:
        written = tmp_path / "out" / "sample.vocabulary.json"
        until(written.exists, "the export")
        project.write_text("metagraph: [broken")
        time.sleep(0.8)
        assert running.poll() is None
        project.write_text(text.replace("name: hands at sides", "name: hands down"))
        until(lambda: "hands down" in written.read_text(), "the export of what was saved")
        running.send_signal(signal.SIGINT)
        _, told = running.communicate(timeout=20)
    assert running.returncode == 0
    assert "error:" in told and "stopped" in told


@pytest.fixture
def nothing_fetched(tmp_path: Path) -> dict[str, str]:
    """An environment in which three.js cannot be kept, so that npm is not asked for it: a page loads it."""
    blocked = tmp_path / "no cache"
    blocked.write_text("a file where the folder would be")
    return {**os.environ, "XDG_CACHE_HOME": str(blocked)}


@pytest.mark.nightly
@pytest.mark.skipif(os.name == "nt", reason="is stopped by a signal")
def test_the_web_page_is_served_until_it_is_stopped(few, tmp_path, nothing_fetched):
    import urllib.request

    command = [
        sys.executable,
        "-m",
        "app.cli",
        "export",
        str(few),
        "-t",
        "web",
        "-o",
        str(tmp_path / "page"),
        "--serve",
        "--no-mesh",
    ]
    with started(*command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, env=nothing_fetched) as running:
        line = next(line for line in running.stderr if "the page is at" in line)
        url = line.split("the page is at ")[1].split()[0]
        with urllib.request.urlopen(url + "sample.json", timeout=10) as answer:
            assert json.loads(answer.read())["glb"] == "sample.glb"
        running.send_signal(signal.SIGINT)
        running.communicate(timeout=20)
    assert running.returncode == 0


@pytest.mark.nightly
@pytest.mark.skipif(os.name == "nt", reason="is stopped by a signal")
@pytest.mark.parametrize(
    ("how", "number"),
    [
        ("watch", signal.SIGTERM),
        ("serve", signal.SIGTERM),
        ("live", signal.SIGTERM),
        ("watch", signal.SIGINT),
    ],
)
def test_what_goes_on_is_stopped_where_interrupts_are_ignored(how, number, few, tmp_path, nothing_fetched):
    """As a background job of a script is: Python installs no handler of its own there, and a wait would be
    for ever.
    """
    words = {
        "watch": ("export", few, "-t", "bml", "-o", tmp_path / "out", "--watch", "--no-mesh"),
        "serve": ("export", few, "-t", "web", "-o", tmp_path / "out", "--serve", "--no-mesh"),
        "live": ("live", few, "--json", "--port", "0", "--osc-port", "0", "--no-stdin"),
    }[how]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "env": nothing_fetched}
    with started(*metagraph(*words), ignored=True, **pipes) as running:
        if how == "serve":
            assert any("the page is at" in line for line in running.stderr)
        else:
            assert running.stdout.readline()
        running.send_signal(number)
        _, told = running.communicate(timeout=20)
    assert running.returncode == 0, told
    assert "Traceback" not in told
