"""The page that compares our state machine with the engines': its seconds are those of its operators."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from metagraph.research.study.machines.klm import predict_seconds

PAGE = Path(__file__).resolve().parents[3] / "docs" / "researchers" / "manual-machine-beside-engines.md"
CELL = re.compile(r"((?:\d*[MPBK] ?)+)= ([\d.]+) s")


def test_seconds_follow_from_operators_and_ours_are_never_more() -> None:
    rows = [
        line for line in PAGE.read_text(encoding="utf-8").splitlines() if CELL.search(line) and "|" in line
    ]
    assert len(rows) == 7
    for row in rows:
        found = CELL.findall(row)
        seconds = []
        for operators, told in found:
            counts = {name: float(count or 1) for count, name in re.findall(r"(\d*)([MPBK])", operators)}
            seconds.append(predict_seconds(counts))
            assert seconds[-1] == pytest.approx(float(told), abs=0.006), row
        assert seconds[0] == min(seconds), row
