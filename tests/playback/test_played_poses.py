"""What is seen of a plan is the same however many processes look, also if one of them ends."""

from __future__ import annotations

import threading
from types import MappingProxyType

import numpy as np
import pytest

from metagraph.common import child_channel
from metagraph.playback import played_poses
from metagraph.playback.own_moves import RATE
from metagraph.playback.planning.running_plan import improvise
from metagraph.playback.played_poses import PlayedPoses, count_chunks, make_read_only, watch_plans


def same(one: PlayedPoses, other: PlayedPoses) -> bool:
    return all(
        np.array_equal(getattr(one, name), getattr(other, name))
        for name in ("times", "places", "lowest", "sits", "inside")
    ) and all(np.array_equal(one.added[name], other.added[name]) for name in one.added)


@pytest.fixture
def plans(toy, monkeypatch):
    monkeypatch.setattr(played_poses, "CHUNK", 60)
    project = toy.project()
    return project, [(improvise(project, 6.0), 6.0), (improvise(project, 3.5), 3.5)]


def test_other_processes_see_what_this_one_sees(plans):
    project, some = plans
    alone, told = watch_plans(project, some, processes=0), []
    together = watch_plans(project, some, lambda: bool(told.append(1)), processes=2)
    assert len(alone) == len(together) == 2 and all(map(same, alone, together))
    assert len(alone[0].times) == 6 * RATE and len(told) == sum(count_chunks(s) for _, s in some)


def test_what_a_process_does_not_return_is_done_here(plans, monkeypatch):
    project, some = plans
    alone, taken = watch_plans(project, some, processes=0), threading.Event()
    watch, sent = played_poses.PoseWatcher.watch, []

    class Dying:
        """It takes a piece, and ends."""

        def __init__(self, module: str) -> None:
            assert module == "metagraph.playback.watching_child"

        def send(self, content: bytes) -> None:
            sent.append(content)
            if len(sent) == 2:
                taken.set()

        def receive(self) -> bytes:
            raise EOFError

        def close(self, patience: float) -> None:
            """It has ended."""

    def after_it_was_taken(self, times):
        assert taken.wait(30)
        return watch(self, times)

    monkeypatch.setattr(child_channel, "Child", Dying)
    monkeypatch.setattr(played_poses.PoseWatcher, "watch", after_it_was_taken)
    assert all(map(same, alone, watch_plans(project, some, processes=1)))
    assert len(sent) == 2


def test_where_no_process_can_be_started_this_one_does_it_all(plans, monkeypatch):
    project, some = plans
    monkeypatch.setattr(child_channel, "start", lambda *_, **__: (_ for _ in ()).throw(OSError("none left")))
    assert len(watch_plans(project, some, processes=3)) == 2


def test_one_who_has_seen_enough_gets_the_plans_that_were_played_whole(plans):
    project, some = plans
    left = iter([False] * 6 + [True])
    assert [len(seen.times) for seen in watch_plans(project, some, lambda: next(left), processes=0)] == [
        6 * RATE
    ]
    assert watch_plans(project, some, lambda: True, processes=0) == []


def test_a_view_stays_one():
    assert isinstance(make_read_only({"a": 1}), MappingProxyType)
