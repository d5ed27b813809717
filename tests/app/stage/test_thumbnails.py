"""Pictures of clips: bounded in memory, and drawn on when the process that draws them has ended."""

from __future__ import annotations

import time

import pytest
from PySide6.QtGui import QImage

from app.project.document import Document
from app.project.jobs import Jobs
from app.stage import thumbnails as module
from app.stage.figures import Figures
from app.stage.session import Session
from app.stage.thumbnails import Thumbnails
from metagraph.graph import edits


@pytest.fixture
def pictures(qapp, toy):
    document = Document()
    jobs = Jobs()
    made = Thumbnails(document, Session(document), Figures(document, jobs))
    made.kept.ask = made._wait_in_line  # nothing is on the disk
    document.load(toy.project(), None)
    yield made
    made.stop()
    jobs.stop()
    document.close_journal()


def drawn(pictures: Thumbnails, clip: str, side: int = 100) -> None:
    """Let a picture come, as from the process."""
    pictures.picture(clip)
    number = next(n for n, (key, _) in pictures._orders.items() if key[0] == clip)
    pictures._keep(number, [QImage(side, side, QImage.Format.Format_ARGB32)])


def test_the_pictures_that_were_not_seen_for_longest_go_and_are_drawn_again(pictures, monkeypatch):
    monkeypatch.setattr(module, "MOST", 3 * 40_000)
    asked = []
    monkeypatch.setattr(
        pictures, "_order", lambda key, motion: (asked.append(key[0]), _number(pictures, key, motion))
    )
    clips = list(pictures.document.project.clips)[:4]
    for clip in clips[:3]:
        drawn(pictures, clip)
    assert pictures.picture(clips[0]) is not None, "seen: now the second was not seen for longest"
    drawn(pictures, clips[3])
    assert pictures.bytes <= 3 * 40_000
    assert pictures.picture(clips[0]) is not None and pictures.picture(clips[1]) is None
    assert asked.count(clips[1]) == 2, "it is drawn again"


def _number(pictures: Thumbnails, key, motion) -> None:
    pictures._number += 1
    pictures._orders[pictures._number] = (key, motion)


def test_a_clip_that_is_removed_takes_its_pictures_along(pictures, monkeypatch):
    monkeypatch.setattr(pictures, "_order", lambda key, motion: _number(pictures, key, motion))
    clips = list(pictures.document.project.clips)[:2]
    for clip in clips:
        drawn(pictures, clip)
    pictures.document.edit("Remove", lambda p: edits.remove_clips(p, clips[:1]))
    assert pictures.bytes == 40_000
    assert {key[0] for key in pictures._pictures} == {clips[1]}


@pytest.mark.gl
def test_a_process_that_ends_is_started_anew_and_draws_the_rest(pictures, qtbot):
    first, second = list(pictures.document.project.clips)[:2]
    pictures.picture(first)
    qtbot.waitUntil(lambda: pictures.picture(first) is not None, timeout=30000)
    pictures._process.kill()
    pictures.picture(second)
    qtbot.waitUntil(lambda: pictures.picture(second) is not None, timeout=30000)


def test_a_picture_over_which_the_process_ended_is_not_tried_again(pictures, qtbot, monkeypatch):
    monkeypatch.setattr(pictures, "_order", lambda key, motion: _number(pictures, key, motion))
    first, second = list(pictures.document.project.clips)[:2]
    for clip in (first, second):
        pictures.picture(clip)
    process = _Gone()
    pictures._process = process
    pictures._keep(1, None)
    pictures._restart(process)
    assert [key[0] for key, _ in pictures._orders.values()] == [second]
    pictures.picture(first)
    assert [key[0] for key, _ in pictures._orders.values()] == [second]


def test_a_process_that_never_draws_is_given_up(pictures, qtbot, monkeypatch):
    started = []

    def start() -> None:
        started.append(time.monotonic())
        pictures._process = _Gone()

    monkeypatch.setattr(pictures, "_start", start)
    first, second = list(pictures.document.project.clips)[:2]
    pictures.picture(first)
    while pictures._process is not None:
        pictures._restart(pictures._process)
    assert len(started) == module.TRIES
    pictures.picture(second)
    assert len(started) == module.TRIES


class _Gone:
    """A process that has ended."""

    def wait(self, seconds: float) -> int:
        return 1

    def kill(self) -> None:
        """There is nothing to end."""


def test_a_process_without_orders_goes_home_and_the_next_order_starts_another(pictures, monkeypatch):
    started = []

    def start() -> None:
        started.append(_Gone())
        pictures._process = started[-1]

    monkeypatch.setattr(pictures, "_start", start)
    first, second = list(pictures.document.project.clips)[:2]
    pictures.picture(first)
    pictures._send_home()
    assert pictures._process is started[0], "it still draws"
    pictures._keep(1, [QImage(8, 8, QImage.Format.Format_ARGB32)])
    queue = pictures._queue
    pictures._send_home()
    assert pictures._process is None and queue.get() is not None and queue.get() is None
    pictures._restart(started[0])
    assert len(started) == 1, "that it has ended is no reason for another"
    pictures.picture(second)
    assert len(started) == 2
