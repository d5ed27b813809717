"""In which stance a side's arms are when."""

from __future__ import annotations

from itertools import pairwise

import pytest

from metagraph.graph.model import MetaGraph, Project
from metagraph.graph.requests import Go
from metagraph.speech.addressing import find_speaking_spans
from metagraph.speech.arm_stances import BEFORE, KEPT, PAUSE, place_arm_stances
from metagraph.speech.drive import drive
from tests.speech.test_drive import clause, said

TALK = [clause(14.0 * n + 1, 14.0 * n + 5, f"words {n}") for n in range(20)]


def test_without_a_transition_the_arms_stay_where_they_begin() -> None:
    found = place_arm_stances(said(*TALK, length=290.0), 0, MetaGraph("arms"))
    assert (list(found.starts), list(found.stances)) == ([0.0], [""])


def test_a_stance_is_changed_in_some_pauses_that_are_long_enough_and_kept_while_one_speaks(
    sample: Project,
) -> None:
    talk, graph = said(*TALK, length=290.0), sample.graphs["arms"]
    found = place_arm_stances(talk, 0, graph)
    assert 5 <= len(found.starts) <= 18 and found.stances[0] == graph.start
    assert all(b - a >= KEPT for a, b in pairwise(found.starts))
    assert all(a != b for a, b in pairwise(found.stances)), "each leads elsewhere"
    spans = find_speaking_spans(talk.sides[0].segments)
    for at in found.starts[1:]:
        assert not any(start - BEFORE < at < end for start, end in spans)
        assert found.at(at) == found.stances[list(found.starts).index(at)]
    assert found.at(-1.0) == ""


@pytest.mark.parametrize("pause", [0.8, PAUSE - 0.1])
def test_short_pauses_change_nothing(sample: Project, pause: float) -> None:
    some = [clause(1 + n * (3 + pause), 4 + n * (3 + pause), f"w{n}") for n in range(20)]
    talk = said(*some, length=some[-1].end + 1)
    assert len(place_arm_stances(talk, 0, sample.graphs["arms"]).starts) == 1


def test_gestures_are_of_the_stance_that_a_turn_is_spoken_in(sample: Project) -> None:
    talk = said(*TALK, length=290.0, clause=1.0)
    stances = place_arm_stances(talk, 0, sample.graphs["arms"])
    performance, plan = drive(talk, 0, sample)
    assert sum(isinstance(ask, Go) for ask in performance.asks) == len(stances.starts) - 1
    gestures = [c for c in plan.layers["arms"].cues if c.action.kind == "gesture"]
    assert len(gestures) > 12
    assert all(c.stance == stances.at(c.start + 0.5) for c in gestures)
    assert len({c.stance for c in gestures}) > 1
