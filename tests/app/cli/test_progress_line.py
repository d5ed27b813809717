"""A long job says on a terminal how far it is and how long it will take, and nothing anywhere else."""

from __future__ import annotations

import io
from argparse import Namespace

import pytest

from app.cli import progress_line
from app.cli.progress_line import ProgressLine, describe_seconds


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    now = [100.0]
    monkeypatch.setattr(progress_line.time, "monotonic", lambda: now[0])
    return now


def test_it_says_what_how_far_and_how_long(clock: list[float], monkeypatch: pytest.MonkeyPatch) -> None:
    screen = Terminal()
    monkeypatch.setattr("sys.stderr", screen)
    line = ProgressLine(Namespace(json=False), "Reading clips")
    line.tell(1, 1200, "walk.bvh")
    clock[0] += 0.05
    line.tell(2, 1200)  # too soon to look again
    clock[0] += 5.95
    line.tell(300, 1200)
    clock[0] += 18
    line.tell(1200, 1200)
    seen = screen.getvalue().split("\r")
    assert seen[1] == "Reading clips: 1 of 1,200  walk.bvh"
    assert seen[2].startswith("Reading clips: 300 of 1,200, about 18 s left")
    assert seen[3].startswith("Reading clips: 1,200 of 1,200") and seen[3].endswith("\n")
    assert len(seen) == 4
    assert len(seen[3].rstrip("\n")) >= len(seen[2]), "nothing of the longer line is left"


def test_a_line_that_was_begun_can_be_ended(clock: list[float], monkeypatch: pytest.MonkeyPatch) -> None:
    screen = Terminal()
    monkeypatch.setattr("sys.stderr", screen)
    line = ProgressLine(Namespace(), "Making videos")
    line.finish()
    assert screen.getvalue() == ""
    line.tell(0, 4)
    line.finish()
    assert screen.getvalue() == "\rMaking videos: 0 of 4\n"


@pytest.mark.parametrize(("terminal", "json"), [(False, False), (True, True)])
def test_nothing_is_written_where_nobody_reads_it(
    terminal: bool, json: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    screen = Terminal() if terminal else io.StringIO()
    monkeypatch.setattr("sys.stderr", screen)
    line = ProgressLine(Namespace(json=json), "Playing it")
    line.tell(1, 2)
    line.finish()
    assert screen.getvalue() == ""


def test_lengths_of_time_are_rounded_as_estimates_are() -> None:
    assert [describe_seconds(s) for s in (0.2, 42.4, 89, 100, 1500, 9000)] == [
        "1 s", "42 s", "89 s", "2 min", "25 min", "2.5 h",
    ]  # fmt: skip
