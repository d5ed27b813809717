"""What became of rates: asked, drawn, performed."""

from __future__ import annotations

import re

from metagraph.graph.conversation.model import Segment
from metagraph.graph.model import Project
from metagraph.playback.plan import Plan
from metagraph.speech.delivered import count_delivered
from metagraph.speech.drive import drive
from tests.speech.test_drive import clause, clauses, said


def test_of_nothing_said_nothing_is_told(sample: Project) -> None:
    told = count_delivered(said(), 0, sample, Plan(1, 60.0))
    assert [t.count for t in told] == [0, 0, 0]
    assert re.search("clauses .*none", told[0].words())


def test_a_plan_that_does_nothing_performs_nothing_of_what_was_drawn(sample: Project) -> None:
    talk = said(*clauses(4), Segment("response", 30, 30.5, None, "yeah"), clause=1.0, response=1.0)
    told = count_delivered(talk, 0, sample, Plan(1, 60.0))
    assert [(t.drawn, t.performed, t.strokes) for t in told] == [(4, 0, 0), (1, 0, 0), (0, 0, 0)]


def test_gestures_and_nods_that_are_performed_are_counted(sample: Project) -> None:
    own = (clause(2, 3, "a"), clause(2.9 + 3, 6.5, "b"), Segment("response", 20, 20.5, None, "yeah"))
    talk = said(*own, partner=(Segment("hesitation", 30, 30.5),), clause=1.0, response=1.0, hesitation=1.0)
    _, plan = drive(talk, 0, sample)
    told = count_delivered(talk, 0, sample, plan)
    assert [(t.count, t.drawn, t.performed, t.strokes) for t in told] == [
        (2, 2, 2, 2),
        (1, 1, 1, 0),
        (1, 1, 1, 0),
    ]
    for one, numbers in zip(told[:2], ("100 2 2 100 2 100 2", "100 1 1 100 1 100"), strict=True):
        assert re.findall(r"\d+", one.words()) == numbers.split()


def test_a_clause_that_a_hold_lasts_over_is_performed_without_a_stroke_of_its_own(sample: Project) -> None:
    talk = said(clause(3, 3.4, "a"), clause(3.7, 4.1, "b"), clause=1.0)
    _, plan = drive(talk, 0, sample)
    assert (t := count_delivered(talk, 0, sample, plan)[0]).performed == 2 and t.strokes == 1
