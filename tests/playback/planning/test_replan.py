"""Temporal replanning: every case of the paper's section 6.1."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from metagraph.graph.model import Settings
from metagraph.playback.plan import MetaAction, MetaRequest, Report
from metagraph.playback.planning.replan import delay, replan

SETTINGS = Settings(shortest=0.4, wait=4.0)


def meta(
    ident: str, start: float, end: float, priority: int = 1, resume: bool = False, written: bool = False
) -> MetaAction:
    request = MetaRequest(ident, "arms", "gesture", start, end - start, priority=priority, resume=resume)
    return MetaAction(request, start, end, written=written)


def run(*metas: MetaAction) -> tuple[list[tuple[str, float, float]], dict[str, list[str]]]:
    """What was placed as (key, start, end), and the outcomes reported about each request."""
    placed, reports = replan(metas, SETTINGS)
    told: dict[str, list[str]] = {}
    for report in reports:
        assert report.message
        told.setdefault(report.request, []).append(report.outcome)
    return [(m.key, round(m.start, 6), round(m.end, 6)) for m in placed], told


def test_nothing_gives_nothing() -> None:
    assert run() == ([], {})


def test_what_does_not_overlap_stays_as_it_is_in_order_of_start() -> None:
    assert run(meta("b", 3, 4), meta("a", 0, 1), meta("c", 1, 3)) == (
        [("a", 0, 1), ("c", 1, 3), ("b", 3, 4)],
        {},
    )


def test_of_equal_importance_the_later_is_delayed() -> None:
    assert run(meta("a", 0, 2), meta("b", 1, 2)) == ([("a", 0, 2), ("b", 2, 3)], {"b": ["late"]})


def test_what_would_come_much_too_late_is_reported_instead() -> None:
    placed, told = run(meta("a", 0, 9), meta("b", 1, 2))
    assert placed == [("a", 0, 9)] and told == {"b": ["covered"]}
    _, [report] = replan([meta("a", 0, 9), meta("b", 1, 2)], SETTINGS)
    assert not report.played and "'a'" in report.message


def test_a_long_action_is_cut_by_a_more_important_one_and_dropped() -> None:
    assert run(meta("long", 0, 10), meta("nod", 3, 4, 2)) == (
        [("long", 0, 3), ("nod", 3, 4)],
        {"long": ["cut"]},
    )


def test_a_long_action_is_cut_and_goes_on_with_its_remainder() -> None:
    placed, told = run(meta("long", 0, 10, resume=True), meta("nod", 3, 4, 2))
    assert placed == [("long", 0, 3), ("nod", 3, 4), ("long+1", 4, 10)] and told == {"long": ["resumed"]}


def test_a_remainder_is_cut_again() -> None:
    placed, told = run(meta("long", 0, 10, resume=True), meta("a", 2, 3, 2), meta("b", 5, 6, 3))
    assert placed == [("long", 0, 2), ("a", 2, 3), ("long+1", 3, 5), ("b", 5, 6), ("long+2", 6, 10)]
    assert told == {"long": ["resumed", "resumed"]}


def test_a_remainder_too_short_to_be_worth_it_is_dropped() -> None:
    assert run(meta("long", 0, 4.3, resume=True), meta("nod", 3, 4, 2))[0] == [("long", 0, 3), ("nod", 3, 4)]


def test_a_beginning_too_short_to_be_worth_it_gives_way_and_what_is_left_keeps_its_name() -> None:
    placed, told = run(meta("long", 0, 10, resume=True), meta("nod", 0.2, 1, 2))
    assert placed == [("nod", 0.2, 1), ("long", 1, 10)] and told == {"long": ["resumed"]}
    assert run(meta("long", 0, 10), meta("nod", 0.2, 1, 2)) == ([("nod", 0.2, 1)], {"long": ["covered"]})


def test_a_more_important_one_may_reach_back_over_two() -> None:
    placed, _ = run(meta("a", 0, 1), meta("b", 1, 2), meta("king", 0.5, 3, 5))
    assert placed[0] == ("a", 0, 0.5) and placed[1] == ("king", 0.5, 3)


def test_something_less_important_is_delayed_past_something_more_important() -> None:
    assert run(meta("king", 0, 2, 5), meta("b", 1, 2)) == ([("king", 0, 2), ("b", 2, 3)], {"b": ["late"]})


def test_of_equal_start_the_more_important_goes_first() -> None:
    assert run(meta("a", 0, 1, 1), meta("b", 0, 1, 2))[0] == [("b", 0, 1), ("a", 1, 2)]


def test_of_equal_start_and_importance_the_id_decides_whatever_the_order() -> None:
    a, b, c = meta("a", 0, 1), meta("b", 0, 1), meta("c", 0, 1)
    assert run(a, b, c) == run(c, b, a) == run(b, c, a)
    assert [k for k, *_ in run(c, a, b)[0]] == ["a", "b", "c"]


def test_two_that_are_the_same_in_everything_do_not_confuse_it() -> None:
    assert [k for k, *_ in run(meta("a", 0, 1), meta("a", 0, 1))[0]] == ["a", "a"]


def test_what_nobody_asked_for_keeps_what_is_left_of_its_time_or_gives_way() -> None:
    asked = meta("a", 0, 2)
    assert run(asked, meta("auto", 1, 3, 0, written=True))[0] == [("a", 0, 2), ("auto", 2, 3)]
    assert run(asked, meta("auto", 1, 2.3, 0, written=True)) == ([("a", 0, 2)], {"auto": ["covered"]})
    assert run(meta("auto", 0, 3, 0, written=True), meta("a", 1, 2)) == (
        [("auto", 0, 1), ("a", 1, 2)],
        {"auto": ["cut"]},
    )


def test_a_request_of_no_duration_fits_anywhere() -> None:
    assert run(meta("a", 1, 1), meta("b", 1, 1), meta("c", 0, 1))[0] == [
        ("c", 0, 1),
        ("a", 1, 1),
        ("b", 1, 1),
    ]


# --- the running action


def test_new_requests_wait_for_the_running_action() -> None:
    metas, [report] = delay([meta("a", 1, 2), meta("b", 5, 6)], 3.0, SETTINGS)
    assert [(m.start, m.end) for m in metas] == [(3, 4), (5, 6)]
    assert (report.request, report.outcome, report.played) == ("a", "late", True)


def test_a_request_from_too_long_ago_is_past() -> None:
    metas, [report] = delay([meta("a", 1, 2)], 5.5, SETTINGS)
    assert metas == [] and (report.outcome, report.played) == ("past", False) and "4.5 s" in report.message


def test_a_request_that_waits_exactly_as_long_as_allowed_plays() -> None:
    assert len(delay([meta("a", 1, 2)], 5.0, SETTINGS)[0]) == 1


@pytest.mark.parametrize("field", ["start", "duration"])
@pytest.mark.parametrize("bad", [float("nan"), float("inf")])
def test_times_that_are_not_numbers_are_refused_at_the_door(field: str, bad: float) -> None:
    times: dict[str, Any] = {"start": 0.0, "duration": 1.0, field: bad}
    with pytest.raises(ValueError, match="finite"):
        MetaRequest("a", "arms", "gesture", **times)


# --- whatever comes

requests = st.lists(
    st.tuples(
        st.floats(0, 20).map(lambda x: round(x, 2)),
        st.one_of(st.just(0.0), st.floats(0.1, 12).map(lambda x: round(x, 2))),
        st.integers(0, 3),
        st.booleans(),
        st.booleans(),
    ),
    max_size=14,
)


def build(rows: list[tuple[float, float, int, bool, bool]]) -> list[MetaAction]:
    return [meta(f"r{n}", s, s + d, p, r, w and p == 0) for n, (s, d, p, r, w) in enumerate(rows)]


@pytest.mark.nightly
@given(requests)
@settings(max_examples=300)
def test_the_result_never_overlaps_and_no_request_is_silently_lost(
    rows: list[tuple[float, float, int, bool, bool]],
) -> None:
    metas = build(rows)
    placed, reports = replan(metas, SETTINGS)
    assert all(a.end <= b.start for a, b in pairwise(placed))
    assert all(m.end >= m.start for m in placed)
    assert len({m.key for m in placed}) == len(placed), "two remainders would share their draws"
    there = {m.request.id for m in placed}
    told: dict[str, list[Report]] = {}
    for report in reports:
        told.setdefault(report.request, []).append(report)
    for one in metas:
        assert one.request.id in there or any(not r.played for r in told.get(one.request.id, [])), one
    for m in placed:
        assert m.start >= m.request.start
        original = next(o for o in metas if o.request.id == m.request.id)
        changed = (m.start, m.end) != (original.start, original.end)
        assert not changed or m.written or m.request.id in told


@given(requests)
def test_planning_a_meta_plan_again_changes_nothing(rows: list[tuple[float, float, int, bool, bool]]) -> None:
    placed, _ = replan(build(rows), SETTINGS)
    assert replan(placed, SETTINGS) == (placed, [])


@given(requests, st.randoms(use_true_random=False))
def test_the_order_in_which_requests_arrive_does_not_matter(
    rows: list[tuple[float, float, int, bool, bool]], random: Any
) -> None:
    metas = build(rows)
    shuffled = list(metas)
    random.shuffle(shuffled)
    assert replan(metas, SETTINGS) == replan(shuffled, SETTINGS)


@given(requests)
def test_the_most_important_are_never_cut_and_start_on_time_unless_their_equals_are_in_the_way(
    rows: list[Any],
) -> None:
    metas = build(rows)
    top = max((m.request.priority for m in metas), default=0)
    kings = [m for m in metas if m.request.priority == top]
    placed, reports = replan(metas, SETTINGS)
    if len(kings) == 1 and not kings[0].written:
        assert kings[0] in placed
        assert not [r for r in reports if r.request == kings[0].request.id]


@pytest.mark.nightly
@given(requests)
@settings(max_examples=200)
def test_placing_again_changes_nothing(rows: list[tuple[float, float, int, bool, bool]]) -> None:
    """What was asked for in its place, and what the models wrote as they wrote it, come out as before."""
    metas = build(rows)
    placed, _ = replan(metas, SETTINGS)
    asked = [m for m in placed if not m.written]
    again, _ = replan([*asked, *(m for m in metas if m.written)], SETTINGS)
    assert again == placed
    assert replan(placed, SETTINGS)[0] == placed


def test_what_a_model_wrote_never_moves_what_is_asked_for_however_little_it_matters() -> None:
    assert run(meta("auto", 0, 3, 0, written=True), meta("a", 1, 2, -5))[0] == [("auto", 0, 1), ("a", 1, 2)]


def test_what_a_model_wrote_waits_for_what_runs_if_enough_is_left_of_it() -> None:
    written = [meta("auto", 1, 3, 0, written=True), meta("late", 4, 5, 0, written=True)]
    assert [(m.start, m.end) for m in replan(written, SETTINGS, busy=2.0)[0]] == [(2.0, 3), (4, 5)]
    assert [m.key for m in replan(written, SETTINGS, busy=2.9)[0]] == ["late"]
