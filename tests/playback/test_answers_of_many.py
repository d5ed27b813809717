"""What became of many asks is given in one pass over the plan."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from metagraph.graph import requests as a
from metagraph.graph.model import Project
from metagraph.playback.planning.extend_performance import answer_ask, answer_asks
from metagraph.playback.planning.running_plan import plan_performance


class Counted(tuple[Any, ...]):
    """A tuple that knows how often it was gone through."""

    passes = 0

    def __iter__(self) -> Any:
        Counted.passes += 1
        return super().__iter__()


def some(sample: Project) -> list[Any]:
    line = next(iter(sample.lines))
    return [
        a.Gesture(id="g", at=1.0),
        a.Gesture(id="none", at=2.0, tags=("nonsense",)),
        a.Say(id="s", line=line, at=3.0),
        a.Say(id="s.1", text="hello", at=9.0),
        a.Look(id="l", at=4.0),
        a.Go(id="there", stance=next(iter(sample.graphs["arms"].stances)), at=0.0),
        a.Gesture(id="far", at=90.0),
    ]


def test_many_answers_are_the_same_as_one_at_a_time(sample: Project) -> None:
    asks = some(sample)
    plan = plan_performance(sample, asks, 20.0)
    many = answer_asks(plan, [x.id for x in asks])
    assert many == {x.id: answer_ask(plan, x.id) for x in asks}
    assert {x.state for x in many.values()} >= {"planned", "refused", "done"}


def test_the_plan_is_gone_through_as_often_for_many_as_for_one(sample: Project) -> None:
    asks = some(sample)
    plan = replace(plan := plan_performance(sample, asks, 20.0), reports=Counted(plan.reports))
    passes = []
    for idents in ([asks[0].id], [x.id for x in asks]):
        Counted.passes = 0
        answer_asks(plan, idents)
        passes.append(Counted.passes)
    assert passes == [2, 2]  # once for what serves others, once for all else
