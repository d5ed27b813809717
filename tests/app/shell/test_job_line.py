"""The running job in the status bar."""

from __future__ import annotations

import threading

from app.project.jobs import Jobs, WindowJob
from app.shell.job_line import JobLine


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
