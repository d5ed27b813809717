"""Pictures of clips: bounded in memory, and drawn on when the process that draws them has ended."""

from __future__ import annotations

import contextlib
import os
import pickle
import threading

import numpy as np
import pytest
from PySide6.QtCore import Qt, QTimer

from app.project.document import Document
from app.project.jobs import Jobs
from app.stage import thumbnails as module
from app.stage.figures import Figures
from app.stage.session import StageSession
from app.stage.thumbnails import Thumbnails
from metagraph.graph import edits


class Drawer:
    """A process that draws what a test lets it draw: it is spoken to as the real one, through pipes."""

    def __init__(self) -> None:
        orders, to_it = os.pipe()
        from_it, pictures = os.pipe()
        self.stdin, self.stdout = os.fdopen(to_it, "wb"), os.fdopen(from_it, "rb")
        self._orders, self._pictures = os.fdopen(orders, "rb"), os.fdopen(pictures, "wb")
        self.names: list[str] = []  # of the clips that were ordered
        self.numbers: list[int] = []
        self.sent_home = False
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self) -> None:
        with contextlib.suppress(EOFError, OSError), self._orders as pipe:
            while True:
                order = pickle.load(pipe)
                self.numbers.append(order.number)
                self.names.append(order.clip.name)
        self.sent_home = True

    def tell(self, name: str, side: int | None = 100) -> None:
        """Say that a clip's picture is drawn; side None: that it is begun."""
        number = self.numbers[len(self.names) - 1 - self.names[::-1].index(name)]
        pickle.dump((number, side and [np.zeros((side, side, 4), np.uint8)]), self._pictures)
        self._pictures.flush()

    def kill(self) -> None:
        self._pictures.close()

    def wait(self, seconds: float) -> int:
        return 0


@pytest.fixture
def pictures(qapp, toy):
    document = Document()
    jobs = Jobs()
    made = Thumbnails(document, StageSession(document), Figures(document, jobs))
    made.kept.ask = made.kept.missing.emit  # nothing is on the disk
    document.load(toy.project(), None)
    yield made
    made.stop()
    jobs.stop()
    document.close_journal()


@pytest.fixture
def started(monkeypatch) -> list[Drawer]:
    """The processes that were started, which draw what the test lets them."""
    found: list[Drawer] = []
    monkeypatch.setattr(module, "start", lambda *_, **__: found.append(Drawer()) or found[-1])
    return found


def name(pictures: Thumbnails, clip: str) -> str:
    return pictures.document.project.clips[clip].motion.name


def ordered(started: list[Drawer]) -> list[str]:
    return [name for drawer in started for name in drawer.names]


def drawn(pictures: Thumbnails, started: list[Drawer], clip: str, qtbot, side: int = 100) -> None:
    """Let a picture be asked for and come."""
    count = ordered(started).count(name(pictures, clip))
    pictures.picture(clip)
    qtbot.waitUntil(lambda: ordered(started).count(name(pictures, clip)) > count)
    started[-1].tell(name(pictures, clip), side)
    qtbot.waitUntil(lambda: not pictures.waiting)


def test_the_pictures_that_were_not_seen_for_longest_go_and_are_drawn_again(
    pictures, started, qtbot, monkeypatch
):
    monkeypatch.setattr(module, "MOST", 3 * 40_000)
    clips = list(pictures.document.project.clips)[:4]
    for clip in clips[:3]:
        drawn(pictures, started, clip, qtbot)
    assert pictures.picture(clips[0]) is not None, "seen: now the second was not seen for longest"
    drawn(pictures, started, clips[3], qtbot)
    assert pictures.bytes <= 3 * 40_000
    assert pictures.picture(clips[0]) is not None and pictures.picture(clips[1]) is None
    again = [name(pictures, clips[1])] * 2
    qtbot.waitUntil(lambda: [n for n in ordered(started) if n == again[0]] == again)


def test_a_clip_that_is_removed_takes_its_pictures_along(pictures, started, qtbot):
    clips = list(pictures.document.project.clips)[:2]
    for clip in clips:
        drawn(pictures, started, clip, qtbot)
    assert pictures.bytes == 2 * 40_000
    pictures.document.edit("Remove", lambda p: edits.remove_clips(p, clips[:1]))
    assert pictures.bytes == 40_000
    assert pictures.picture(clips[0]) is None and pictures.picture(clips[1]) is not None


@pytest.mark.nightly
@pytest.mark.gl
def test_a_process_that_ends_is_started_anew_and_draws_the_rest(pictures, qtbot, monkeypatch):
    real, processes = module.start, []
    monkeypatch.setattr(module, "start", lambda *a, **k: processes.append(real(*a, **k)) or processes[-1])
    first, second = list(pictures.document.project.clips)[:2]
    pictures.picture(first)
    qtbot.waitUntil(lambda: pictures.picture(first) is not None, timeout=30000)
    processes[0].kill()
    pictures.picture(second)
    qtbot.waitUntil(lambda: pictures.picture(second) is not None, timeout=30000)


def test_a_picture_over_which_the_process_ended_is_not_tried_again(pictures, started, qtbot):
    first, second = list(pictures.document.project.clips)[:2]
    for clip in (first, second):
        pictures.picture(clip)
    qtbot.waitUntil(lambda: len(ordered(started)) == 2)
    started[0].tell(name(pictures, first), None)
    started[0].kill()
    qtbot.waitUntil(lambda: len(started) == 2 and started[1].names == [name(pictures, second)])
    pictures.picture(first)
    started[1].tell(name(pictures, second))
    qtbot.waitUntil(lambda: not pictures.waiting)
    assert pictures.picture(second) is not None and pictures.picture(first) is None
    assert started[1].names == [name(pictures, second)]


def test_a_process_that_never_draws_is_given_up(pictures, started, qtbot, monkeypatch):
    def ends(*_: object, **__: object) -> Drawer:
        started.append(Drawer())
        started[-1].kill()
        return started[-1]

    monkeypatch.setattr(module, "start", ends)
    first, second = list(pictures.document.project.clips)[:2]
    pictures.picture(first)
    qtbot.waitUntil(lambda: not pictures.waiting)
    assert len(started) == module.TRIES
    pictures.picture(second)
    qtbot.wait(50)
    assert len(started) == module.TRIES and not pictures.waiting


def test_a_process_without_orders_goes_home_and_the_next_order_starts_another(pictures, started, qtbot):
    first, second = list(pictures.document.project.clips)[:2]
    (rest,) = pictures.findChildren(QTimer, options=Qt.FindChildOption.FindDirectChildrenOnly)
    pictures.picture(first)
    qtbot.waitUntil(lambda: len(ordered(started)) == 1)
    rest.start(0)
    qtbot.wait(50)
    assert not started[0].sent_home, "it still draws"
    started[0].tell(name(pictures, first))
    qtbot.waitUntil(lambda: not pictures.waiting)
    rest.start(0)
    qtbot.waitUntil(lambda: started[0].sent_home)
    started[0].kill()
    qtbot.wait(50)
    assert len(started) == 1, "that it has ended is no reason for another"
    pictures.picture(second)
    qtbot.waitUntil(lambda: len(started) == 2 and started[1].names == [name(pictures, second)])
