"""What is closed is gone: dialogs, menus, whole windows, and the projects they showed."""

from __future__ import annotations

import gc
import time
from collections.abc import Callable, Iterator
from weakref import ref

import pytest
from PySide6.QtCore import QCoreApplication, QEvent
from PySide6.QtWidgets import QDialog, QMenu

from app.main import make_window
from app.project.files import SAMPLE
from app.project.jobs import Jobs
from metagraph.formats.project import clip_loading
from metagraph.graph import edits
from tests.app.every_dialog import DIALOGS, opened
from tests.app.handles import Handles
from tests.thorough import many

pytestmark = [pytest.mark.window, pytest.mark.gl]
TIMES = many(1, 2)


def settled() -> None:
    """Delete what is to be deleted later, as the window's own loop does, and what only refers to itself."""
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete.value)
    gc.collect()


def open_sample(window: Handles, wait) -> None:
    window.files.open(SAMPLE, template=True)
    wait(lambda: bool(window.document.project.clips) and window.performance.skeleton() is not None)
    wait(lambda: window.compatibility.judged is not None)


def tell_all(window: Handles) -> None:
    """Emit what dialogs listen to."""
    document, project = window.document, window.document.project
    document.edit("Change seed", lambda p: edits.set_settings(p, seed=p.settings.seed + 1))
    document.undo()
    document.state_changed.emit()
    window.session.look.changed.emit()
    window.session.selection.changed.emit()
    window.session.transport.show_changed.emit()
    window.performance.changed.emit()
    window.compatibility.changed.emit()
    window.compatibility.seen.emit(next(project.actions()).id)
    for layer in project.graphs:
        window.compatibility.compared.emit(layer)
    window.problems.changed.emit()
    window.figures.changed.emit()
    window.thumbnails.ready.emit(next(iter(project.clips)))
    window.jobs.changed.emit()


@pytest.fixture
def all_kept() -> Iterator[Callable[[], None]]:
    """What there is by now stays: a look for rubbish after each of many dialogs is one through what came
    since.
    """
    yield gc.freeze
    gc.unfreeze()


@pytest.mark.nightly
def test_a_dialog_that_was_closed_is_gone_and_hears_nothing_more(drive, tmp_path, all_kept):
    open_sample(drive, drive.wait)
    drive.session.transport.set_playing(False)
    all_kept()
    for name, open_it in DIALOGS.items():
        seen: list[ref[QDialog]] = []
        for _ in range(TIMES):
            open_it(drive, tmp_path)
            drive.wait(lambda: bool(opened()))
            seen += [ref(dialog) for dialog in opened()]
            while opened():
                opened()[-1].reject()
        drive.wait(lambda: not drive.jobs.at_work)  # what they began ends by itself
        settled()
        assert len(seen) >= TIMES
        assert not [dialog for dialog in (r() for r in seen) if dialog is not None], name
        tell_all(drive)  # an exception in a slot fails the test


@pytest.mark.nightly
def test_a_menu_that_was_closed_is_gone(drive):
    open_sample(drive, drive.wait)
    project = drive.document.project
    drive.session.selection.select_clips((next(iter(project.clips)),))
    from app.widgets.request_menu import make_request_menu

    def makers():
        yield lambda: drive.library.acts.menu(next(iter(project.clips.values())))
        yield lambda: make_request_menu(drive.timeline, drive.performance, 4.0)

    for make in makers():
        seen: list[ref[QMenu]] = []
        for _ in range(TIMES):
            menu = make()
            menu.popup(drive.window.mapToGlobal(drive.window.rect().center()))
            drive.wait(menu.isVisible)
            menu.close()
            seen.append(ref(menu))
            del menu
        settled()
        assert not any(r() is not None for r in seen)


@pytest.mark.nightly
def test_a_window_that_was_closed_is_gone_with_its_project(qapp, qtbot, monkeypatch):
    # The other tests share the sample's clips, which would live on in what shares them.
    monkeypatch.setattr(clip_loading._Loading, "_fitted", clip_loading._Loading._fitted.__wrapped__)

    def sitting() -> list[ref[object]]:
        window = Handles(make_window())
        window.window.show()
        window.make_late_panels()
        open_sample(window, lambda until: qtbot.waitUntil(until, timeout=20_000))
        window.document.edit("Change seed", lambda p: edits.set_settings(p, seed=77))
        window.document.undo()
        qtbot.wait(300)  # it plays
        project = window.document.project
        found = [
            ref(x)
            for x in (
                window.window, window.document, window.session, window.performance, window.jobs, project,
                *(entry.motion for entry in project.clips.values()),
            )
        ]  # fmt: skip
        window.document.undo_stack.setClean()
        assert window.window.close()
        window.window.deleteLater()
        return found

    found = sitting()
    qtbot.wait(50)
    settled()
    left = [type(x).__name__ for x in (r() for r in found) if x is not None]
    assert not left, f"{len(left)} of {len(found)} are alive: {sorted(set(left))}"


def test_jobs_that_wait_for_their_turn_are_freed_at_closing(qapp, qtbot):
    class Held:
        """What a job's work holds."""

    jobs, started, let_go = Jobs(), [], []

    def slow(job: object) -> None:
        started.append(job)
        while not let_go and not job.cancelled:  # type: ignore[attr-defined]
            time.sleep(0.002)

    for _ in range(2):
        jobs.start("slow", slow)
    qtbot.waitUntil(lambda: len(started) == 2, timeout=5000)
    held = Held()
    seen = ref(held)
    jobs.start("waiting", lambda _, held=held: held, lambda result: None)
    jobs.stop()
    jobs.start("late", lambda _, held=held: held, lambda result: None)
    del held
    settled()
    assert seen() is None
