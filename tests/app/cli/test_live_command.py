"""`metagraph live` as programs start it."""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
from argparse import Namespace
from pathlib import Path
from typing import Any

import msgspec
import pytest

from app.cli import live_command
from app.cli.parser import main
from metagraph.errors import FileError
from metagraph.formats import store
from metagraph.formats.store import open_project, read_project
from metagraph.graph.requests import Performance
from metagraph.live.live_session import LiveSession
from tests.processes import started

ROOT = Path(__file__).resolve().parents[3]
FREE = ("--json", "--port", "0", "--osc-port", "0")


def command(project: Path, *words: str) -> list[str]:
    return [sys.executable, "-m", "app.cli", "live", str(project), *words]


def lines(text: str) -> list[Any]:
    return [json.loads(line) for line in text.splitlines()]


@pytest.mark.nightly
def test_lines_in_are_answered_by_lines_out_until_the_end_of_input(few: Path) -> None:
    asked = '{"do":"nod","id":"n"}\nnonsense\n{"do":"gesture","tags":["beat"],"in":2}\n'
    done = subprocess.run(
        command(few, *FREE), input=asked, capture_output=True, text=True, cwd=ROOT, timeout=120
    )
    assert done.returncode == 0, done.stderr
    ready, nod, error, beat = lines(done.stdout)
    assert (
        ready["event"] == "ready"
        and ready["websocket"].startswith("ws://127.0.0.1:")
        and ready["osc"][0] == "127.0.0.1"
    )
    assert (
        nod["id"] == "n"
        and nod["state"] in ("planned", "late")
        and "not JSON" in error["error"]
        and beat["at"] >= 2
    )
    assert done.stderr == ""


@pytest.mark.nightly
def test_people_are_told_in_words_on_standard_error(few: Path) -> None:
    done = subprocess.run(
        command(few, "--port", "0", "--no-osc"),
        input="",
        capture_output=True,
        text=True,
        cwd=ROOT,
        timeout=120,
    )
    assert done.returncode == 0 and done.stdout == ""
    assert "ws://127.0.0.1:" in done.stderr and "OSC" not in done.stderr


@pytest.mark.nightly
@pytest.mark.skipif(os.name == "nt", reason="Windows has no SIGTERM to catch")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupt_ends_it_cleanly(number: signal.Signals, few: Path) -> None:
    with started(
        *command(few, *FREE, "--no-stdin"), stdout=subprocess.PIPE, stderr=subprocess.PIPE, longest=120
    ) as process:
        assert process.stdout is not None and process.stderr is not None
        assert json.loads(process.stdout.readline())["event"] == "ready"
        process.send_signal(number)
        assert process.wait(30) == 0
        assert process.stdout.read() == "" and process.stderr.read() == ""


@pytest.mark.nightly
def test_what_was_asked_can_be_kept_and_performed_again(
    few: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    project = shutil.copytree(few.parent, tmp_path / "own") / few.name
    words = [sys.executable, "-m", "app.cli", "live", str(project), *FREE, "--keep", "talk"]
    done = subprocess.run(
        words, input='{"do":"nod","id":"n","at":1}\n', capture_output=True, text=True, cwd=ROOT, timeout=120
    )
    assert done.returncode == 0 and "saved as 'talk'" in done.stderr
    kept = list(open_project(project).project.performances.values())[-1]
    assert kept.name == "talk" and [type(ask).__name__ for ask in kept.asks] == ["Nod"]
    assert main(["plan", str(project), "--performance", "talk", "-s", "3", "--json"]) == 0
    said = json.loads(capsys.readouterr().out)
    nods = [c for c in said["cues"] if c["layer"] == "head" and "nod" in c["name"]]
    assert [c["start"] for c in nods][:1] == [lines(done.stdout)[1]["at"]]


@pytest.mark.parametrize(
    ("words", "error"),
    [
        (
            ("--host", "0.0.0.0"),
            "needs a token, so that not everyone there can control the character; choose one, for example "
            "--token ",
        ),
        (("--port", "70000"), "from 0 to 65535"),
    ],
)
def test_what_is_not_safe_is_refused_in_words(
    words: tuple[str, ...], error: str, few: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["live", str(few), *words]) == 1
    assert error in capsys.readouterr().err


@pytest.mark.nightly
def test_the_token_may_come_from_the_environment(few: Path) -> None:
    environ = {**os.environ, "METAGRAPH_TOKEN": "secret"}
    done = subprocess.run(
        command(few, *FREE), input="", capture_output=True, text=True, cwd=ROOT, timeout=120, env=environ
    )
    assert lines(done.stdout)[0]["token"] is True


@pytest.fixture
def played(few: Path, tmp_path: Path) -> tuple[LiveSession, Namespace]:
    """A session of a project of its own, about to be kept."""
    project = shutil.copytree(few.parent, tmp_path / "own") / few.name
    session = LiveSession(open_project(project).project)
    session.receive(1, b'{"do":"nod"}')
    session.tick(0.5)
    return session, Namespace(project=project, keep="talk")


def test_a_session_whose_project_was_damaged_meanwhile_is_kept_beside_it(
    played: tuple[LiveSession, Namespace],
) -> None:
    session, options = played
    options.project.write_text("graphs: [")
    with pytest.raises(FileError, match="saved in") as told:
        live_command._keep(session, options)
    place = Path(re.search("saved in '(.*?)'", str(told.value))[1])  # type: ignore[index]
    assert place.parent == options.project.parent and options.project.read_text() == "graphs: ["
    opened = open_project(place)
    assert "talk" in [p.name for p in opened.project.performances.values()] and not opened.notes


def test_a_session_whose_folder_takes_nothing_is_kept_where_passing_files_are(
    played: tuple[LiveSession, Namespace], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    session, options = played
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    shutil.rmtree(options.project.parent)
    options.project.parent.write_text("a file where the folder was")
    with pytest.raises(FileError, match="was saved in"):
        live_command._keep(session, options)
    (place,) = tmp_path.glob("* - talk *.metagraph.yaml")
    assert read_project(place).performances


def test_a_session_that_no_disk_takes_stands_on_standard_output(
    played: tuple[LiveSession, Namespace], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    session, options = played

    def full(*_: object) -> None:
        raise FileError(options.project, "cannot be saved: the disk is full", remedy="Make room.")

    monkeypatch.setattr(store, "encode_project", full)
    with pytest.raises(FileError, match="the disk is full"):
        live_command._keep(session, options)
    kept = msgspec.json.decode(capsys.readouterr().out, type=Performance)
    assert kept.name == "talk" and len(kept.asks) == 1
