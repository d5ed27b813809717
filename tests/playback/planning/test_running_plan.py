"""A kept session is performed again as it was played, in time that grows with its length alone."""

from __future__ import annotations

import msgspec
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from metagraph.graph import requests as a
from metagraph.graph.model import LAYERS, Project
from metagraph.playback.plan import Plan
from metagraph.playback.planning.extend_performance import answer_ask, hear_asks
from metagraph.playback.planning.running_plan import AHEAD, RunningPlan, plan_performance
from tests.posing import pose_at
from tests.thorough import many

LENGTH = 150.0


def at_once(project: Project, asks: list[a.AnyRequest], end: float, idle: bool = True) -> Plan:
    """Plan every group of asks to the very end: what performing means, in time that grows with the square of
    the length.
    """
    groups: dict[float, list[a.AnyRequest]] = {0.0: []}
    for ask in asks:
        groups.setdefault(ask.told or 0.0, []).append(ask)
    plan = Plan(project.settings.seed, 0.0)
    for told in sorted(groups):
        plan = hear_asks(project, plan, told, groups[told], end, {}, idle)
    return plan


@st.composite
def session(draw) -> list[a.AnyRequest]:
    """Requests of all kinds, as they may come in over two minutes and a half; some are taken back."""
    out: list[a.AnyRequest] = []
    now = 0.0
    for n in range(draw(st.integers(3, 30))):
        now = round(now + draw(st.sampled_from([0.0, 0.4, 2.0, 9.0, 25.0])), 3)
        if now >= LENGTH:
            break
        ident, other = f"x{n}", f"x{draw(st.integers(0, n))}"
        at = round(now + draw(st.sampled_from([0.2, 1.0, 6.0, 40.0])), 3)
        out.append(
            draw(
                st.sampled_from(
                    [
                        a.Gesture(id=ident, at=at, told=now),
                        a.Gesture(id=ident, tags=("positive",), at=at, told=now, priority=3),
                        a.Nod(id=ident, at=at, told=now),
                        a.Go(id=ident, stance="arms crossed", at=at, told=now),
                        a.Look(id=ident, to="user", at=at, told=now, duration=3.0),
                        a.Say(id=ident, text="so be it then", at=at, told=now),
                        a.Behave(id=ident, mode="listening", at=at, told=now),
                        a.Blink(id=ident, at=at, told=now),
                        a.Withdraw(id=f"w{n}", what=other, told=now),
                        a.Withdraw(id=f"w{n}", what="", told=now),
                    ]
                )
            )
        )
    return out


@pytest.mark.nightly
def test_in_pieces_it_is_what_it_is_at_once(sample):
    @settings(max_examples=many(10, 100))
    @given(asks=session(), idle=st.booleans())
    def same(asks: list[a.AnyRequest], idle: bool) -> None:
        one, other = at_once(sample, asks, LENGTH, idle), plan_performance(sample, asks, LENGTH, idle=idle)
        for layer in LAYERS:
            assert other.layers[layer].cues == one.layers[layer].cues
            assert other.layers[layer].rests == one.layers[layer].rests
        assert other.track == one.track
        for name in ("modes", "breaths", "aversions", "saccades", "blinks", "targets", "end"):
            assert getattr(other.life, name) == getattr(one.life, name), name
        times = np.linspace(0.0, LENGTH - 0.01, 60)
        assert np.array_equal(pose_at(other, sample, times).rotations, pose_at(one, sample, times).rotations)
        for ask in asks:
            assert answer_ask(other, ask.id) == answer_ask(one, ask.id), ask

    same()


def test_what_is_asked_for_at_the_beginning_alone_is_planned_at_once(sample):
    asks: list[a.AnyRequest] = [a.Nod(id="n", at=2.0), a.Gesture(id="g", at=50.0)]
    assert plan_performance(sample, asks, 60.0) == at_once(sample, asks, 60.0)


@pytest.mark.parametrize("end", [0.05, 1.0, AHEAD - 1, AHEAD, AHEAD + 0.1])
def test_a_performance_shorter_than_the_plan_ahead_ends_where_it_should(sample, end):
    asks: list[a.AnyRequest] = [a.Nod(id="n", at=0.02, told=0.01)]
    plan = plan_performance(sample, asks, end)
    assert plan.end == end and plan.layers["head"].cues == at_once(sample, asks, end).layers["head"].cues


@pytest.mark.nightly
def test_the_work_of_an_hour_grows_with_the_hour_and_not_with_its_square(sample, monkeypatch):
    """Cues that were looked at again with every request are what made it the square."""
    import metagraph.playback.planning.running_plan as module

    seen = []
    plain = module.hear_asks

    def counted(project, plan, *arguments):
        seen.append(sum(len(plan.layers[layer].cues) for layer in LAYERS))
        return plain(project, plan, *arguments)

    monkeypatch.setattr(module, "hear_asks", counted)
    counts = []
    for seconds in (300, 900):
        seen.clear()
        plan_performance(
            sample,
            [a.Nod(id=f"n{t}", at=t + 1.0, told=float(t)) for t in range(0, seconds, 4)],
            seconds + 5.0,
        )
        counts.append(sum(seen))
    assert counts[1] < 4 * counts[0], "nine times the work would be the square"


def test_running_on_reaches_ahead_and_hears(sample):
    running = RunningPlan(sample, ahead=10.0)
    assert running.plan.end == 10.0
    running.reach(0.5)
    assert running.plan.end == 10.0, "a little behind is no reason to plan"
    running.reach(5.0)
    assert running.plan.end == 15.0
    running.hear(5.0, [a.Nod(id="n", at=6.0)])
    assert answer_ask(running.plan, "n").state in ("planned", "late")
    before = running.forget(4.0)
    assert before.end == running.plan.end
    assert all(cue.end >= 4.0 for layer in LAYERS for cue in running.plan.layers[layer].cues)


def test_what_came_from_a_file_performs_as_before_it_was_written(sample):
    asks = [a.Nod(id="n", at=40.0, told=3.0), a.Gesture(id="g", at=80.0, told=70.0)]
    again = msgspec.json.decode(msgspec.json.encode(asks), type=list[a.AnyRequest])
    assert plan_performance(sample, again, 100.0) == plan_performance(sample, asks, 100.0)
