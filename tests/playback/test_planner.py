"""Planning and extending: what plays stays, nothing asked for is lost, and nothing new changes nothing."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from metagraph.graph import edits
from metagraph.graph.model import LAYERS, Project
from metagraph.playback.plan import MetaRequest, Plan
from metagraph.playback.planner import extend_plan, make_plan

PROJECT = Project()


@pytest.fixture(autouse=True, scope="module")
def _project(toy: Any) -> None:
    global PROJECT
    project = toy.project()
    for clip in ("rest scratch", "rest cough"):  # a stance with several loops
        project = edits.place_clips(
            project, [project.action(toy.id(project, clip)).clip], "arms", "stance", toy.id(project, "rest")
        )
    PROJECT = edits.update_actions(project, [toy.id(project, "rest long")], timing={"earliest_exit": 1.0})


def played(plan: Plan) -> Any:
    return {layer: (plan.layers[layer].cues, plan.layers[layer].rests) for layer in LAYERS}


def told(plan: Plan) -> list[Any]:
    """What was said about requests; what the models wrote is fitted in again each time, and why it was left
    out may be said otherwise.
    """
    return sorted((r for r in plan.reports if not r.written), key=repr)


def test_an_empty_project_plans_nothing_and_does_not_fail() -> None:
    plan = make_plan(Project(), 10, [MetaRequest("r", "arms", "gesture", 1.0)])
    assert all(not plan.layers[layer].cues and not plan.layers[layer].rests for layer in LAYERS)
    assert [r.outcome for r in plan.reports] == ["no-stance"]


def test_no_time_plans_no_cues() -> None:
    assert played(make_plan(PROJECT, 0.0))["arms"][0] == ()


def test_the_same_seed_gives_the_same_plan_and_another_another() -> None:
    assert make_plan(PROJECT, 60, seed=3) == make_plan(PROJECT, 60, seed=3)
    assert played(make_plan(PROJECT, 60, seed=3)) != played(make_plan(PROJECT, 60, seed=4))
    assert make_plan(PROJECT, 60).seed == PROJECT.settings.seed


def test_a_layer_begins_where_it_is_told_to_else_at_its_start_else_where_there_is_a_loop(toy: Any) -> None:
    up, far = toy.id(PROJECT, "up"), toy.id(PROJECT, "far")
    assert make_plan(PROJECT, 5, stances={"arms": up}).layers["arms"].stance_at(0) == up
    assert make_plan(edits.set_start_stance(PROJECT, far), 5).layers["arms"].stance_at(0) == far
    assert make_plan(PROJECT, 5, stances={"arms": "s999"}).layers["arms"].stance_at(0) == toy.id(
        PROJECT, "rest"
    )
    loops = {a.id: None for a in PROJECT.graphs["arms"].of(toy.id(PROJECT, "rest"), "stance")}
    bare = edits.remove_actions(PROJECT, list(loops))
    assert make_plan(bare, 5).layers["arms"].stance_at(0) == up


def test_requests_beyond_the_horizon_wait_for_it() -> None:
    request = MetaRequest("r", "arms", "gesture", 12.0)
    plan = make_plan(PROJECT, 10, [request], idle=False)
    assert not plan.layers["arms"].cues and plan.reports == () and plan.requests == (request,)
    later = extend_plan(PROJECT, plan, 5, (), 20, idle=False)
    assert [(c.meta, c.start) for c in later.layers["arms"].cues] == [("r", 12.0)]


def test_something_important_beyond_the_horizon_is_known_already() -> None:
    near = make_plan(
        PROJECT,
        10,
        [
            MetaRequest("a", "arms", "gesture", 9.5, 0.7),
            MetaRequest("k", "arms", "gesture", 10.2, priority=5),
        ],
        idle=False,
    )
    assert all(c.end <= 10.2 for c in near.layers["arms"].cues)


def test_of_two_requests_of_one_id_the_later_counts() -> None:
    plan = make_plan(
        PROJECT,
        20,
        [MetaRequest("r", "arms", "gesture", 2.0), MetaRequest("r", "arms", "fidget", 5.0)],
        idle=False,
    )
    assert [(c.meta, c.start, c.action.kind) for c in plan.layers["arms"].cues] == [("r", 5.0, "fidget")]
    moved = extend_plan(PROJECT, plan, 1.0, [MetaRequest("r", "arms", "gesture", 8.0)], 20, idle=False)
    assert [(c.meta, c.start) for c in moved.layers["arms"].cues] == [("r", 8.0)] and len(moved.requests) == 1
    gone = extend_plan(PROJECT, plan, 1.0, [MetaRequest("r", "head", "gesture", 8.0)], 20, idle=False)
    assert not gone.layers["arms"].cues, "asked for on another layer, it leaves this one"


# --- extending


def test_the_running_action_is_kept_and_a_new_request_waits_for_it(toy: Any) -> None:
    long = MetaRequest("a", "arms", "gesture", 1.0, action=toy.id(PROJECT, "rest wave rt"))
    plan = make_plan(PROJECT, 20, [long], idle=False)
    then = extend_plan(
        PROJECT, plan, 1.5, [MetaRequest("now", "arms", "gesture", 1.5, priority=9)], 20, idle=False
    )
    cues = then.layers["arms"].cues
    assert cues[0] == plan.layers["arms"].cues[0] and (cues[1].meta, cues[1].start) == ("now", cues[0].end)
    assert [(r.request, r.outcome, r.played) for r in then.reports] == [("now", "late", True)]


def test_a_request_for_the_far_past_is_told_to_be_past() -> None:
    then = extend_plan(
        PROJECT,
        make_plan(PROJECT, 30, idle=False),
        20,
        [MetaRequest("old", "arms", "gesture", 3.0)],
        30,
        idle=False,
    )
    assert not then.layers["arms"].cues and [r.outcome for r in then.reports] == ["past"]


def test_new_requests_are_merged_with_what_was_planned() -> None:
    old = [MetaRequest("a", "arms", "gesture", 5.0), MetaRequest("b", "arms", "gesture", 10.0)]
    plan = extend_plan(
        PROJECT,
        make_plan(PROJECT, 20, old, idle=False),
        1,
        [MetaRequest("c", "arms", "fidget", 7.5)],
        20,
        idle=False,
    )
    assert [c.meta for c in plan.layers["arms"].cues] == ["a", "c", "b"]


def test_a_chain_that_has_begun_is_finished(toy: Any) -> None:
    ask = MetaRequest("go", "arms", "gesture", 1.0, action=toy.id(PROJECT, "up point"))
    plan = make_plan(PROJECT, 20, [ask], idle=False)
    for now in (1.0, 1.1, 1.5, 1.8, 2.0, 3.5):
        assert played(extend_plan(PROJECT, plan, now, (), 20, idle=False)) == played(plan)


def test_a_meta_action_that_waits_for_a_long_clip_is_not_forgotten_meanwhile(toy: Any) -> None:
    asked = [
        MetaRequest("a", "arms", "gesture", 1.0, 0.5, action=toy.id(PROJECT, "rest wave rt")),
        MetaRequest("b", "arms", "gesture", 1.8, 3.0),
    ]
    plan = make_plan(PROJECT, 20, asked, idle=False)
    assert [c.meta for c in plan.layers["arms"].cues] == ["a", "b"] and plan.layers["arms"].cues[
        1
    ].start == pytest.approx(2.2)
    assert played(extend_plan(PROJECT, plan, 2.0, (), 20, idle=False)) == played(plan)


def test_what_was_told_stays_told(toy: Any) -> None:
    asked = [
        MetaRequest("long", "arms", "gesture", 5.0, 9.0, resume=True),
        MetaRequest("king", "arms", "gesture", 7.0, priority=5),
        MetaRequest("lost", "arms", "gesture", 6.0, tags=("none",), priority=2),
        MetaRequest("late", "arms", "gesture", 7.2),
    ]
    plan = make_plan(PROJECT, 30, asked, idle=False)
    assert {r.request for r in plan.reports} >= {"long", "late", "lost"}
    for now in (1.0, 6.5, 20.0):
        plan = extend_plan(PROJECT, plan, now, (), 30, idle=False)
        assert {r.request for r in plan.reports} >= {"long", "late", "lost"} and len(
            set(plan.reports)
        ) == len(plan.reports)


def test_a_stance_that_was_removed_meanwhile_does_not_break_the_plan(toy: Any) -> None:
    plan = make_plan(
        PROJECT, 20, [MetaRequest("go", "arms", "transition", 1.0, stance=toy.id(PROJECT, "up"))], idle=False
    )
    without = edits.remove_stance(PROJECT, toy.id(PROJECT, "up"))
    then = extend_plan(without, plan, 5.0, [MetaRequest("g", "arms", "gesture", 6.0)], 20, idle=False)
    assert then.layers["arms"].cues[-1].action.id in without.graphs["arms"].actions


request_rows = st.lists(
    st.tuples(
        st.floats(0, 40).map(lambda x: round(x, 2)),
        st.one_of(st.none(), st.floats(0, 8).map(lambda x: round(x, 2))),
        st.sampled_from(
            ["gesture", "fidget", "transition", "up", "far", "rest", "point", "impossible", "tag"]
        ),
        st.integers(1, 3),
        st.booleans(),
    ),
    max_size=10,
)


def build(rows: list[tuple[float, float | None, str, int, bool]], prefix: str = "r") -> list[MetaRequest]:
    graph = PROJECT.graphs["arms"]
    stances = {s.name: s.id for s in graph.stances.values()}
    point = next(a.id for a in graph.actions.values() if a.name == "up point")
    out = []
    for n, (start, duration, what, priority, resume) in enumerate(rows):
        more: dict[str, Any] = {}
        kind: Any = what if what in ("gesture", "fidget", "transition") else "gesture"
        if what in stances:
            kind, more = "transition", {"stance": stances[what]}
        elif what == "point":
            more = {"action": point}
        elif what == "impossible":
            more = {"action": "a999"}
        elif what == "tag":
            more = {"tags": ("none",)}
        out.append(
            MetaRequest(
                f"{prefix}{n}", "arms", kind, start, duration, priority=priority, resume=resume, **more
            )
        )
    return out


def assert_sound(plan: Plan, project: Project) -> None:
    """No overlaps; every action starts in the stance the one before left; nothing asked for is silently
    lost.
    """
    for layer in LAYERS:
        lane = plan.layers[layer]
        stance = lane.rests[0].stance if lane.rests else None
        for cue in lane.cues:
            assert cue.stance == stance == cue.action.stance
            assert cue.blend_in + cue.blend_out <= cue.end - cue.start + 1e-9
            stance = cue.then
        assert all(a.end <= b.start for a, b in pairwise(lane.cues))
        assert all(a.fade_start <= b.fade_start for a, b in pairwise(lane.rests))
    shown = {cue.meta.split("+")[0] for layer in LAYERS for cue in plan.layers[layer].cues}
    reported = {r.request for r in plan.reports}
    for request in plan.requests:
        if request.start < plan.end - project.settings.wait - 10:
            assert request.id in shown or request.id in reported, request


@given(request_rows, st.booleans(), st.integers(0, 5))
@settings(max_examples=60, deadline=None)
def test_any_plan_is_sound(rows: list[Any], idle: bool, seed: int) -> None:
    assert_sound(make_plan(PROJECT, 60, build(rows), seed, idle=idle), PROJECT)


@pytest.mark.nightly
@given(request_rows, st.lists(st.floats(0.1, 45), max_size=4), st.integers(0, 3), st.booleans())
@settings(max_examples=100, deadline=None)
def test_extending_with_nothing_new_is_planning_at_once(
    rows: list[Any], moments: list[float], seed: int, idle: bool
) -> None:
    requests = build(rows)
    plan = whole = make_plan(PROJECT, 60, requests, seed, idle=idle)
    for now in sorted(moments):
        plan = extend_plan(PROJECT, plan, now, (), 60, idle=idle)
        assert played(plan) == played(whole)
        assert told(plan) == told(whole)


@given(st.lists(st.floats(0.1, 45), min_size=1, max_size=4), st.integers(0, 3))
@settings(max_examples=30, deadline=None)
def test_a_performance_planned_piece_by_piece_is_the_one_planned_at_once(
    moments: list[float], seed: int
) -> None:
    plan = make_plan(PROJECT, 15, seed=seed)
    end = 15.0
    for moment in sorted(moments):
        now = min(moment, end)  # what would have begun in between can no longer
        end = max(end, now + 15)
        plan = extend_plan(PROJECT, plan, now, (), end)
    whole = make_plan(PROJECT, end, seed=seed)
    assert played(plan)["arms"][0] == played(whole)["arms"][0]


@pytest.mark.nightly
@given(request_rows, request_rows, st.floats(0.1, 40), st.integers(0, 3))
@settings(max_examples=60, deadline=None)
def test_what_started_before_now_stays_exactly_as_it_was(
    rows: list[Any], more: list[Any], now: float, seed: int
) -> None:
    plan = make_plan(PROJECT, 60, build(rows), seed)
    then = extend_plan(PROJECT, plan, now, build(more, "n"), 70)
    for layer in LAYERS:
        kept = [c for c in plan.layers[layer].cues if c.start < now]
        assert list(then.layers[layer].cues[: len(kept)]) == kept
        assert all(c.start >= now for c in then.layers[layer].cues[len(kept) :])
        rests = [r for r in plan.layers[layer].rests if r.fade_start < now]
        assert list(then.layers[layer].rests[: len(rests)]) == rests
    assert_sound(replace(then, end=60.0), PROJECT)
