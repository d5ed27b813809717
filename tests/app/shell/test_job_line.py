"""The running job in the status bar."""

from __future__ import annotations

import threading
from types import SimpleNamespace

import pytest

from app.project.jobs import Jobs, WindowJob
from app.shell import job_line
from app.shell.job_line import JobLine, describe_time_left


def test_many_steps_move_the_bar_a_few_times_and_the_last_is_shown(qtbot) -> None:
    jobs = Jobs()
    line = JobLine(jobs)
    qtbot.addWidget(line)
    shown: list[int] = []
    line.bar.valueChanged.connect(shown.append)
    enough = threading.Event()

    def work(job: WindowJob) -> None:
        for n in range(1, 2001):
            job.tell(n, 2000, f"step {n}")
        enough.wait(30)

    jobs.start("Counting", work, None)
    try:
        qtbot.waitUntil(lambda: line.bar.value() == 2000, timeout=30_000)
        assert line.label.text() == "Counting: step 2000" and line.isVisibleTo(None)
        assert len(shown) < 200
    finally:
        enough.set()
    qtbot.waitUntil(lambda: line.isHidden(), timeout=30_000)
    jobs.stop()


def test_it_says_how_long_a_job_will_still_take(qtbot, monkeypatch: pytest.MonkeyPatch) -> None:
    now = [100.0]
    monkeypatch.setattr(job_line, "time", SimpleNamespace(monotonic=lambda: now[0]))
    jobs = Jobs()
    line = JobLine(jobs)
    qtbot.addWidget(line)
    shown = []
    steps, enough = [threading.Event() for _ in range(5)], threading.Event()
    told = ((0, 400, 100.0), (10, 400, 101.0), (100, 400, 110.0), (1, 30, 120.0), (10, 30, 129.0))

    def work(job: WindowJob) -> None:
        for step, (done, total, _) in zip(steps, told, strict=True):
            step.wait(30)
            job.tell(done, total)
        enough.wait(30)

    jobs.start("Counting", work, None)
    for step, (done, _, at) in zip(steps, told, strict=True):
        now[0] = at
        step.set()
        qtbot.waitUntil(lambda done=done: line.bar.value() == done and line._latest is None, timeout=30_000)
        shown.append(line.label.text())
    enough.set()
    qtbot.waitUntil(lambda: line.isHidden(), timeout=30_000)
    jobs.stop()
    assert shown[:3] == ["Counting", "Counting", "Counting: about 30 s left"]
    assert shown[4] == "Counting: about 20 s left"  # of the second part alone
    assert describe_time_left(300) == "about 5 min left"
