"""Planning on from what is near alone gives the plan that planning on from all of it gives."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from metagraph.graph import edits
from metagraph.graph.life import Life
from metagraph.graph.model import Project
from metagraph.playback import planner
from metagraph.playback.plan import MetaRequest, Plan
from metagraph.playback.planner import Revision, extend_plan, make_plan
from metagraph.playback.planning import plan_head, strand
from metagraph.playback.planning.strand import Strand
from metagraph.research.exhibits.paper_planner import plan_as_in_paper
from tests.posing import pose_at

PROJECT = Project()


@pytest.fixture(autouse=True, scope="module")
def _project(toy: Any) -> None:
    global PROJECT
    PROJECT = plan_as_in_paper(toy.project())
    for clip in ("rest scratch", "rest cough"):  # a stance with several loops
        of = PROJECT.action(toy.id(PROJECT, clip)).clip
        PROJECT = edits.place_clips(PROJECT, [of], "arms", "stance", toy.id(PROJECT, "rest"))


def from_all(*words: Any, **named: Any) -> Plan:
    """Extend a plan looking at all of it."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(planner, "find_plan_head", lambda *_: None)
        return extend_plan(*words, **named)


def grown(project: Project, end: float, seed: int = 3, step: float = 20.0) -> Plan:
    plan = make_plan(project, step, seed=seed)
    while plan.end < end:
        plan = extend_plan(project, plan, plan.end - 5, (), plan.end + step)
    return plan


asks = st.lists(
    st.tuples(
        st.sampled_from(["a", "b", "c", "d", ""]),
        st.sampled_from(["gesture", "fidget", "transition"]),
        st.floats(-3, 15),
        st.one_of(st.none(), st.floats(0.2, 6)),
        st.sampled_from([1, 1, 2]),
        st.booleans(),
    ),
    max_size=4,
)


def _ask(ident: str, kind: str = "gesture", at: float = 0.0) -> tuple[Any, ...]:
    return ident, kind, at, None, 1, False


# What is requested by the name of what has been played does not take the time that lies between.
AGAIN = [
    ([], 14.0),
    ([_ask("a"), _ask("d", "transition"), _ask("a"), _ask("a")], 3.0),
    ([], 25.0),
    ([_ask("a"), _ask("a", at=14.0)], 23.0),
    ([], 3.0),
]


# A name that was played 25 s ago is given again, twice, and then nothing is requested.
REUSED = [
    ([_ask("a"), _ask("b")], 3.0),
    ([], 24.0),
    ([_ask("a"), _ask("a", at=1.0), _ask("b"), _ask("b", at=1.0)], 4.0),
    ([], 3.0),
]


@pytest.mark.nightly
@example(AGAIN, 0, False)
@example(REUSED, 0, False)
@given(st.lists(st.tuples(asks, st.floats(3, 25)), min_size=4, max_size=12), st.integers(0, 9), st.booleans())
@settings(max_examples=40, deadline=None)
def test_whatever_is_asked_meanwhile_and_again(steps: list[Any], seed: int, remembers: bool) -> None:
    project = PROJECT
    if remembers:
        project = replace(PROJECT, settings=replace(PROJECT.settings, memory=45.0, alpha=1.5))
    plan = whole = make_plan(project, 20.0, seed=seed)
    now = 0.0
    for n, (rows, step) in enumerate(steps):
        now += step
        wanted = [
            MetaRequest(
                ident or f"new{n}.{k}", "arms" if k % 2 else "body", kind, max(0.0, now + at), length,
                priority=priority, resume=resume,
            )
            for k, (ident, kind, at, length, priority, resume) in enumerate(rows)
        ]  # fmt: skip
        gone = frozenset({"c"} if n % 5 == 4 else ())
        plan = extend_plan(project, plan, now, wanted, now + 20, revision=Revision(gone))
        whole = from_all(project, whole, now, wanted, now + 20, revision=Revision(gone))
        assert plan == whole


def test_what_lies_far_back_is_not_looked_at(monkeypatch: Any) -> None:
    seen: list[int] = []
    draft = planner.draft

    def looked(*words: Any) -> Any:
        seen.append(len(words[4].metas) + len(words[4].cues) + len(words[4].rests))
        return draft(*words)

    plan = grown(PROJECT, 1000.0)
    monkeypatch.setattr(planner, "draft", looked)
    extend_plan(PROJECT, plan, 995.0, (), 1020.0)
    early, seen[:] = max(seen), []
    extend_plan(PROJECT, grown(PROJECT, 200.0), 195.0, (), 220.0)
    assert early < 4 * max(seen[-3:]) and early < sum(len(of.cues) for of in plan.layers.values()) / 3


def test_a_plan_that_was_made_at_once_has_a_head_too() -> None:
    plan = make_plan(PROJECT, 400, seed=5)
    head = plan_head.find_plan_head(PROJECT, plan, 395.0, ())
    assert head is not None and head.layers["arms"].cues > 30
    assert extend_plan(PROJECT, plan, 395.0, (), 420.0) == from_all(PROJECT, plan, 395.0, (), 420.0)
    assert (
        extend_plan(PROJECT, plan, 395.0, (), 420.0).layers["arms"].cues
        == make_plan(PROJECT, 420, seed=5).layers["arms"].cues
    )


def test_who_plans_from_earlier_on_again_gets_the_same() -> None:
    plan = grown(PROJECT, 300.0)
    for now in (295.0, 100.0, 10.0, 0.0, 290.0):
        assert extend_plan(PROJECT, plan, now, (), 320.0) == from_all(PROJECT, plan, now, (), 320.0), now


def test_what_is_asked_anew_or_taken_back_long_after_it_played_is_found() -> None:
    ask = MetaRequest("long ago", "arms", "gesture", 3.0)
    plan = extend_plan(PROJECT, make_plan(PROJECT, 30.0, seed=3), 1.0, [ask], 30.0)
    while plan.end < 200:
        plan = extend_plan(PROJECT, plan, plan.end - 5, (), plan.end + 20)
    for fresh, gone in (([replace(ask, start=205.0)], frozenset()), ([], frozenset({"long ago"}))):
        found = extend_plan(PROJECT, plan, 195.0, fresh, 220.0, revision=Revision(gone))
        assert found == from_all(PROJECT, plan, 195.0, fresh, 220.0, revision=Revision(gone))
        assert not any(m.request.id == "long ago" and m.start < 100 for m in found.layers["arms"].metas)


def test_a_stance_that_is_gone_is_found(toy: Any) -> None:
    project = toy.project()
    up = toy.id(project, "up")
    for start in (20.0, 280.0):
        plan = make_plan(project, 300, [MetaRequest("go", "arms", "transition", start, stance=up)], 1)
        without = edits.remove_stance(project, up)
        assert extend_plan(without, plan, 290.0, (), 320.0) == from_all(without, plan, 290.0, (), 320.0)


def test_what_a_long_plan_leaves_as_it_was_is_shared_and_the_same(monkeypatch: Any) -> None:
    project = replace(PROJECT, life=Life(on=True))
    asks, times = [MetaRequest("now", "arms", "gesture", 396.0)], np.linspace(0.0, 410.0, 50)

    def in_three(of: Any) -> tuple[Plan, Plan, Plan]:
        plan = make_plan(project, 300.0, seed=3)
        more = of(project, plan, 295.0, (), 400.0)
        return plan, more, of(project, more, 395.0, asks, 420.0)

    plain = in_three(from_all)
    poses = pose_at(plain[-1], project, times)
    monkeypatch.setattr(strand, "CHUNK", 8)
    monkeypatch.setattr(strand, "LONG", 16)
    made = in_three(extend_plan)
    assert made == plain and plain == made
    assert np.array_equal(pose_at(made[-1], project, times).rotations, poses.rotations)
    for one, other in pairwise(made):
        for a, b in (
            (one.layers["arms"].cues, other.layers["arms"].cues),
            (one.layers["arms"].rests, other.layers["arms"].rests),
            (one.layers["arms"].metas, other.layers["arms"].metas),
            (one.life.blinks.times, other.life.blinks.times),
            (one.life.blinks.rows, other.life.blinks.rows),
        ):
            assert isinstance(a, Strand) and isinstance(b, Strand)
            assert a._chunks[0] is b._chunks[0]


def test_plans_that_are_alike_are_told_apart_without_looking_through_them(monkeypatch: Any) -> None:
    plan = make_plan(PROJECT, 100.0, seed=2)
    again = make_plan(PROJECT, 100.0, seed=2)
    expected = from_all(PROJECT, plan, 90.0, (), 100.0)
    with monkeypatch.context() as patched:
        patched.setattr(Plan, "__eq__", lambda one, other: pytest.fail("two plans were compared"))
        found = extend_plan(PROJECT, plan, 90.0, (), 100.0)
        extend_plan(PROJECT, again, 90.0, (), 100.0)
        further = extend_plan(PROJECT, found, 95.0, (), 100.0)
    assert found == expected
    assert further == from_all(PROJECT, expected, 95.0, (), 100.0)
