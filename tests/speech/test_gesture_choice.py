"""Gestures of a turn, chosen together."""

from __future__ import annotations

from itertools import pairwise, product
from unittest import mock

import msgspec
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from metagraph.graph.model import Action, Project
from metagraph.playback.planning.running_plan import plan_performance
from metagraph.speech import gesture_choice
from metagraph.speech.delivered import count_delivered
from metagraph.speech.drive import TOLERANCE, drive, find_stroke_times
from metagraph.speech.gesture_choice import (
    ChosenGesture,
    GestureClause,
    choose_gestures,
    find_gesture_family,
)
from tests.speech.test_drive import clause, said


def plain(project: Project) -> list[Action]:
    graph = project.graphs["arms"]
    return [a for a in graph.of(graph.start or "", "gesture") if "beat" in a.tags or "explain" in a.tags]


def spoken(project: Project, peaks: list[float], wanted: list[bool] | None = None) -> list[GestureClause]:
    actions = plain(project)
    return [GestureClause(f"c{n}", p, wanted is None or wanted[n], actions) for n, p in enumerate(peaks)]


def test_nothing_said_and_nothing_to_choose_from_give_nothing(sample: Project) -> None:
    assert choose_gestures(sample, [], 1) == []
    assert choose_gestures(sample, [GestureClause("c", 2.0, True, [])], 1) == []


def test_a_clause_that_begins_too_early_or_ends_too_late_for_any_gesture_gets_none(sample: Project) -> None:
    assert choose_gestures(sample, spoken(sample, [0.05]), 1) == []
    assert choose_gestures(sample, spoken(sample, [9.0]), 1, length=9.5) == []
    assert len(choose_gestures(sample, spoken(sample, [0.05, 5.0, 11.5]), 1, length=12.0)) == 1


def test_clauses_that_none_was_drawn_for_get_none_by_themselves(sample: Project) -> None:
    found = choose_gestures(sample, spoken(sample, [3.0, 9.0, 15.0], [False, True, False]), 1)
    assert [one.clause for one in found] == [1]


def test_two_clauses_too_near_for_two_gestures_share_one(sample: Project) -> None:
    (one,) = choose_gestures(sample, spoken(sample, [3.0, 3.7]), 1)
    assert (one.clause, one.last) == (0, 1)


@pytest.mark.parametrize(
    ("name", "family"),
    [
        ("offer_lf_01", "offer"), ("offer_rt_02", "offer"), ("Beat Small Rt 3", "beat small"), ("01", "01"),
        ("shrug", "shrug"), ("left", "left"), ("point_you", "point you"), ("身振り_右", "身振り 右"),
    ],
)  # fmt: skip
def test_names_that_differ_by_an_arm_or_a_number_are_of_one_family(name: str, family: str) -> None:
    assert find_gesture_family(name) == family


def test_a_gesture_of_the_family_that_another_makes_is_left_to_that_one(sample: Project) -> None:
    offers = [
        a for a in plain(sample) if find_gesture_family(a.name) == find_gesture_family(plain(sample)[0].name)
    ]
    others = [a for a in plain(sample) if a not in offers][:2]
    for seed in range(10):
        heard = GestureClause("c", 4.0, True, [*offers, *others], {find_gesture_family(offers[0].name): 1.0})
        (one,) = choose_gestures(sample, [heard], seed)
        assert one.action in others


def test_what_has_no_room_in_one_turn_is_made_up_for_in_the_next(sample: Project) -> None:
    dense = [2.0 + 0.3 * n for n in range(12)]
    later = [dense[-1] + 8.0 + 2.5 * n for n in range(6)]
    for seed in range(4):
        wanted = [True] * len(dense) + [n == 0 for n in range(len(later))]
        found = choose_gestures(sample, spoken(sample, [*dense, *later], wanted), seed)
        served = {n for one in found for n in range(one.clause, one.last + 1)}
        early = sum(n < len(dense) for n in served)
        assert early < len(dense) and len(served) - early > 1
        alone = choose_gestures(sample, spoken(sample, later, [n == 0 for n in range(len(later))]), seed)
        assert len(alone) < len(served) - early


@settings(max_examples=30, deadline=None)
@given(st.lists(st.tuples(st.floats(0.2, 5.0), st.booleans()), max_size=25), st.integers(0, 2**32 - 1))
def test_none_plays_while_another_does_and_each_clause_is_in_one_at_most(
    sample: Project, said: list[tuple[float, bool]], seed: int
) -> None:
    peaks = np.cumsum([gap for gap, _ in said]).tolist()
    found = choose_gestures(sample, spoken(sample, peaks, [w for _, w in said]), seed)
    for a, b in pairwise(found):
        latest = peaks[b.clause] - gesture_choice._lengths(sample, b.action).least
        assert a.last < b.clause and a.end <= latest + 1e-9
    assert all(one.start <= peaks[one.clause] <= one.end for one in found)


@settings(max_examples=15, deadline=None)
@given(st.lists(st.tuples(st.floats(0.3, 2.6), st.booleans()), min_size=1, max_size=4), st.integers(0, 99))
def test_the_choice_is_worth_as_much_as_the_best_of_all(
    sample: Project, some: list[tuple[float, bool]], seed: int
) -> None:
    """Every combination is tried, of three gestures a clause; none makes up for another."""
    peaks = np.cumsum([gap for gap, _ in some]).tolist()
    actions = plain(sample)[:3]
    clauses = [
        GestureClause(f"c{n}", p, w, actions) for n, (p, (_, w)) in enumerate(zip(peaks, some, strict=True))
    ]
    known = {a.id: gesture_choice._lengths(sample, a) for a in actions}
    choices: list[list[tuple[ChosenGesture, float] | None]] = [
        [
            None,
            *(x for a in actions for x in gesture_choice._options(clauses, n, a, known[a.id], seed, np.inf)),
        ]
        for n in range(len(clauses))
    ]

    def worth(path: list[tuple[ChosenGesture, float]]) -> float:
        total, before = 0.0, None
        for one, value in path:
            lengths = known[one.action.id]
            room = clauses[one.clause].peak - (0.0 if before is None else before.end + sample.settings.rest)
            if room < lengths.least or (before is not None and before.last >= one.clause):
                return -np.inf
            spare = max(lengths.lead - lengths.least, 1e-9)
            total += value - gesture_choice.CUT * min(max((lengths.lead - room) / spare, 0), 1)
            total -= gesture_choice.AGAIN * (before is not None and before.action.id == one.action.id)
            before = one
        return total

    best = max(worth([x for x in path if x is not None]) for path in product(*choices))
    values = {
        (o.clause, o.action.id, o.hold): v for row in choices for x in row if x is not None for o, v in [x]
    }
    with (
        mock.patch.object(gesture_choice, "UNASKED", gesture_choice.UNASKED[:1]),
        mock.patch.object(gesture_choice, "RETRIES", 0),
    ):
        chosen = choose_gestures(sample, clauses, seed)
    found = [(o, values[o.clause, o.action.id, o.hold]) for o in chosen]
    assert worth(found) == pytest.approx(max(best, 0.0), abs=1e-9)


@pytest.mark.nightly
def test_as_many_clauses_are_performed_as_are_asked_for_within_five_points(sample: Project) -> None:
    """Clauses as near to each other as people say them; each gesture's stroke on a peak."""
    rng = np.random.default_rng(5)
    for rate in (0.5, 0.75):
        asked, performed, drawn = [], [], []
        for seed in range(6):
            gaps = rng.choice([0.45, 0.8, 1.1, 1.6, 5.5], 40, p=[0.2, 0.25, 0.25, 0.15, 0.15])
            starts = np.cumsum(gaps).round(3).tolist()
            some = tuple(clause(a, round(a + 0.4, 3), f"w{n}") for n, a in enumerate(starts))
            talk = msgspec.structs.replace(said(*some, length=starts[-1] + 4, clause=rate), seed=seed)
            performance, plan = drive(talk, 0, sample)
            told = count_delivered(talk, 0, sample, plan)[0]
            asked.append(told.asked)
            drawn.append(told.drawn / told.count)
            performed.append(told.performed / told.count)
            peaks = np.array([s.peak for s in some])
            at = np.array(list(find_stroke_times(sample, plan).values()))
            assert np.abs(at[:, None] - peaks).min(1).max() <= TOLERANCE
            again = plan_performance(
                sample, performance.asks, performance.length, performance.seed, idle=False
            )
            assert again.layers == plan.layers
        assert np.mean(performed) == pytest.approx(rate, abs=0.05), (rate, np.mean(drawn))


def test_gestures_asked_for_one_by_one_come_to_less(sample: Project) -> None:
    starts = np.cumsum(np.tile([0.5, 0.9, 1.2, 3.0], 8)).round(3).tolist()
    some = tuple(clause(a, round(a + 0.4, 3), f"w{n}") for n, a in enumerate(starts))
    talk = said(*some, length=starts[-1] + 4, clause=0.75)
    each = [count_delivered(talk, 0, sample, drive(talk, 0, sample, together=t)[1])[0] for t in (False, True)]
    assert each[0].drawn == each[1].drawn and each[0].performed < 0.85 * each[1].performed
    assert each[0].strokes <= each[1].strokes
