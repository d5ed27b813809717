"""Who is where, from logs that grow."""

from __future__ import annotations

import os
from datetime import UTC, datetime, timedelta
from pathlib import Path

from metagraph.research.study.logs.watching import LOCK, is_open, tabulate_participants, watch_participants
from metagraph.research.study.sitting import Sitting
from metagraph.research.study.study_plan import read_study
from tests.sittings import ended


def test_everybody_is_where_the_log_says(tiny: Path) -> None:
    study = read_study(tiny)
    one = Sitting(study, "P01")
    for _ in range(2):
        one.begin()
        one.end()
    one.begin()
    one.writer.add("error", what="refused", words="no")
    one.writer.add("pause", state="begin")
    two = Sitting(study, "P02")
    two.begin()
    two.decline()
    two.close()
    (study.data("P01") / LOCK).write_text(f"{os.getpid()}\nmetagraph\nhere\n")
    study.data("P03").mkdir(parents=True)
    study.log("P03").write_text("{}\n")
    found = {s.participant: s for s in watch_participants(study, datetime.now(UTC) + timedelta(seconds=90))}
    one.close()
    assert found["P01"].words.startswith("Practice:") and found["P01"].live and found["P01"].paused
    assert found["P01"].troubles == 1 and found["P01"].quiet is not None and found["P01"].quiet > 80
    assert found["P01"].place is not None and found["P01"].place[0] == 3
    assert (found["P02"].words, found["P02"].live) == ("declined", False)
    assert found["P03"].words.startswith("before: A tiny study") and found["P04"].words == "not begun"
    lines = tabulate_participants(list(found.values()))
    assert lines[1].startswith("●  P01") and "(paused)" in lines[1] and "1:30" in lines[1]


def test_a_lock_that_a_crash_left_is_nobody_s(tmp_path: Path) -> None:
    assert not is_open(tmp_path / LOCK)
    (tmp_path / LOCK).write_text(f"{ended()}\nmetagraph\n")
    assert not is_open(tmp_path / LOCK)
    (tmp_path / LOCK).write_text("what")
    assert not is_open(tmp_path / LOCK)
