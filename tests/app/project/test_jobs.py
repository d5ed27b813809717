"""Long jobs: progress, failure, cancelling; results come on the window's thread."""

from __future__ import annotations

import gc
import threading
import weakref

import pytest
from PySide6.QtCore import QThreadPool

from app.project.jobs import Jobs, WindowJob


@pytest.fixture
def jobs(qapp):
    jobs = Jobs()
    yield jobs
    jobs.stop()


def test_a_result_is_delivered_on_the_windows_thread(jobs, qtbot):
    seen = []

    def work(job):
        return threading.current_thread()

    def done(result):
        seen.append((result, threading.current_thread()))

    job = jobs.start("work", work, done)
    assert jobs.running == [job]
    qtbot.waitUntil(lambda: not jobs.running)
    (worker, here) = seen[0]
    assert here is threading.main_thread()
    assert worker is not here


def test_progress_comes_in_order_before_the_result(jobs, qtbot):
    seen, going = [], threading.Event()

    def work(job):
        assert going.wait(10)
        for n in range(5):
            job.tell(n, 5, f"file {n}")
        return "all"

    job = jobs.start("work", work, seen.append)
    job.progress.connect(lambda *a: seen.append(a))
    going.set()
    qtbot.waitUntil(lambda: not jobs.running)
    assert seen == [*((n, 5, f"file {n}") for n in range(5)), "all"]


def test_a_failure_carries_the_exception_and_where_it_was(jobs, qtbot):
    seen, done = [], []

    def work(job):
        raise ValueError("no such luck")

    jobs.start("work", work, done.append, seen.append)
    qtbot.waitUntil(lambda: not jobs.running)
    assert not done
    assert str(seen[0]) == "no such luck"
    assert "in work" in seen[0].__notes__[0]


@pytest.mark.parametrize("fails", [False, True])
def test_nothing_is_delivered_after_cancelling(jobs, qtbot, fails):
    going, seen, ended = threading.Event(), [], []

    def work(job):
        assert going.wait(10)
        if fails:
            raise ValueError("too late")
        return job.cancelled

    job = jobs.start("work", work, seen.append, seen.append)
    job.ended.connect(lambda: ended.append(True))
    job.cancel()
    going.set()
    qtbot.waitUntil(lambda: bool(ended))
    assert seen == []
    assert jobs.running == []


def test_a_result_already_on_its_way_is_not_delivered_after_cancelling(jobs, qtbot):
    finished, seen = threading.Event(), []

    def work(job):
        finished.set()
        return "result"

    job = jobs.start("work", work, seen.append)
    assert finished.wait(10)
    for pool in jobs.findChildren(QThreadPool):
        pool.waitForDone(5000)  # the result waits in this thread's queue
    job.cancel()
    qtbot.waitUntil(lambda: not jobs.running)
    assert seen == []


def test_quick_jobs_are_not_shown_and_are_not_held_up_by_long_ones(jobs, qtbot):
    going, seen = threading.Event(), []
    for _ in range(4):
        jobs.start("long", lambda job: going.wait(10))
    jobs.start("quick", lambda job: "here", seen.append, quick=True)
    qtbot.waitUntil(lambda: seen == ["here"])
    assert len(jobs.running) == 4
    going.set()
    qtbot.waitUntil(lambda: not jobs.running)


def test_changed_tells_when_a_job_starts_and_ends(jobs, qtbot):
    counts = []
    jobs.changed.connect(lambda: counts.append(len(jobs.running)))
    jobs.start("work", lambda job: None)
    qtbot.waitUntil(lambda: not jobs.running)
    assert counts == [1, 0]


def test_stopping_cancels_and_waits(qapp):
    jobs, seen, going = Jobs(), [], threading.Event()

    def work(job):
        while not job.cancelled and not going.wait(0.005):
            pass
        return "never"

    job = jobs.start("work", work, seen.append)
    jobs.stop()
    assert job.cancelled
    qapp.processEvents()
    assert seen == []


def test_after_stop_nothing_starts_any_more(qtbot):
    jobs, ran = Jobs(), []
    jobs.stop()
    jobs.start("late", lambda job: ran.append(1))
    jobs.start("late and quick", lambda job: ran.append(2), quick=True)
    qtbot.wait(50)
    assert ran == []


class Heavy:
    """Stands for a project."""


@pytest.mark.nightly
@pytest.mark.parametrize("quick", [False, True])
@pytest.mark.parametrize("way", ["done", "failed", "cancelled"])
def test_a_job_that_is_over_is_freed_with_all_it_holds(jobs, qtbot, quick, way):
    alive, ended = [], []

    def start() -> None:
        heavy, result = Heavy(), Heavy()

        def work(job):
            assert heavy is not None
            if way == "failed":
                raise ValueError("no luck")
            return result

        job = jobs.start("work", work, lambda _: heavy, lambda _: heavy, quick)
        job.ended.connect(lambda: ended.append(1))
        if way == "cancelled":
            job.cancel()
        alive.extend(weakref.ref(x) for x in (job, heavy, result))

    for _ in range(100):
        start()
    qtbot.waitUntil(lambda: len(ended) == 100)
    qtbot.wait(20)
    gc.collect()
    assert sum(ref() is not None for ref in alive) == 0


def test_a_job_is_not_freed_while_its_thread_is_still_handing_over(qapp, qtbot):
    job, gone = WindowJob("work", lambda job: None), []
    job.destroyed.connect(lambda: gone.append(True))
    job.handing_over = True
    job.forget()
    qtbot.wait(30)
    assert not gone
    job.handing_over = False
    qtbot.waitUntil(lambda: bool(gone))
