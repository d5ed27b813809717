"""Asks at any level, all at once or as they come in: the same performance, and an answer to each."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from metagraph.graph import requests as a
from metagraph.graph.model import LAYERS, Layer, Project
from metagraph.playback.plan import Cue, Plan
from metagraph.playback.planning.cue_shapes import STOPPED
from metagraph.playback.planning.extend_performance import answer_ask, drop_ended, hear_asks
from metagraph.playback.planning.running_plan import plan_performance
from metagraph.research.exhibits.paper_planner import plan_as_in_paper
from tests import thorough
from tests.posing import pose_at

END = 30.0
_SAMPLE: list[Project] = []


@pytest.fixture(autouse=True, scope="module")
def _sample(sample: Project) -> None:
    _SAMPLE[:] = [sample]


def shown(plan: Plan) -> Any:
    return {layer: (plan.layers[layer].cues, plan.layers[layer].rests) for layer in LAYERS}, plan.life


some_asks = st.lists(
    st.one_of(
        st.builds(
            a.Gesture,
            layer=st.sampled_from(LAYERS),
            tags=st.sampled_from([(), ("positive",), ("beat",)]),
            at=st.floats(0, 25).map(lambda x: round(x, 2)),
            priority=st.integers(0, 3),
            hold=st.sampled_from([None, 0.0, 2.5]),
            prepare=st.booleans(),
            resume=st.booleans(),
            duration=st.sampled_from([None, 4.0]),
        ),
        st.builds(
            a.Gesture,
            stroke=st.floats(0, 25).map(lambda x: round(x, 2)),
            limb=st.sampled_from([None, "left", "right"]),
        ),
        st.builds(
            a.Go,
            stance=st.sampled_from(["on hips", "arms crossed", "head tilt left", "weight left"]),
            at=st.floats(0, 25).map(lambda x: round(x, 2)),
            priority=st.integers(1, 2),
        ),
        st.builds(a.Nod, at=st.floats(0, 25).map(lambda x: round(x, 2))),
        st.builds(
            a.Say, text=st.just("Well, I would not say so."), at=st.floats(0, 25).map(lambda x: round(x, 2))
        ),
        st.builds(
            a.Look,
            to=st.just((1.0, 1.2, 2.0)),
            at=st.floats(0, 25).map(lambda x: round(x, 2)),
            duration=st.just(2.0),
        ),
    ),
    max_size=8,
)


def in_ticks(
    project: Project,
    asks: list[Any],
    end: float,
    tick: float,
    ahead: float = 8.0,
    forget: float | None = None,
) -> list[Plan]:
    """Play live: the plan at every tick, asks heard when they are reported."""
    waiting = sorted(((ask.told or 0.0), n, ask) for n, ask in enumerate(asks))
    plan, out, now = Plan(project.settings.seed, 0.0), [], 0.0
    for n in range(math.ceil(end / tick) + 1):
        now = n * tick
        groups: dict[float, list[Any]] = {}
        while waiting and waiting[0][0] <= now:
            told, k, ask = waiting.pop(0)
            groups.setdefault(told, []).append(a.msgspec.structs.replace(ask, id=ask.id or f"ask{k}"))
        for told, some in groups.items():
            plan = hear_asks(project, plan, told, some, max(plan.end, told + ahead))
        if plan.end < now + ahead:
            plan = hear_asks(project, plan, now, [], now + ahead)
        if forget is not None:
            plan = drop_ended(plan, now - forget)
        out.append(plan)
    return out


@pytest.mark.nightly
@settings(max_examples=thorough.many(6, 50))
@given(some_asks, st.sampled_from([0.016, 0.2, 1.7]))
def test_live_in_ticks_gives_what_one_plan_gives(asks: list[Any], tick: float) -> None:
    project = _SAMPLE[0]
    whole = plan_performance(project, asks, END + 8)
    last = in_ticks(project, asks, END, tick)[-1]
    for layer in LAYERS:
        one, many = whole.layers[layer], last.layers[layer]
        assert [c for c in many.cues if c.start < END] == [c for c in one.cues if c.start < END]
        assert [r for r in many.rests if r.start < END] == [r for r in one.rests if r.start < END]
    times = [0.0, 3.3, END / 2, END - 0.01]
    assert (pose_at(last, project, times).rotations == pose_at(whole, project, times).rotations).all()


@pytest.mark.nightly
@settings(max_examples=thorough.many(6, 50))
@given(some_asks, st.lists(st.floats(0, 20).map(lambda x: round(x, 2)), min_size=8, max_size=8))
def test_what_was_told_on_the_way_replays_as_it_was_heard(asks: list[Any], told: list[float]) -> None:
    project = _SAMPLE[0]
    heard = [a.msgspec.structs.replace(ask, told=t) for ask, t in zip(asks, told, strict=False)]
    live = in_ticks(project, heard, END, 0.1)[-1]
    again = plan_performance(project, heard, END + 8)
    for layer in LAYERS:
        assert [c for c in live.layers[layer].cues if c.start < END] == [
            c for c in again.layers[layer].cues if c.start < END
        ]


@pytest.mark.nightly
@settings(max_examples=thorough.many(4, 8))
@given(some_asks, st.sampled_from([0.0, 60.0]))
def test_forgetting_the_past_changes_nothing_to_come(asks: list[Any], memory: float) -> None:
    project = replace(_SAMPLE[0], settings=replace(_SAMPLE[0].settings, memory=memory))
    kept = in_ticks(project, asks, 150.0, 0.7)[-1]
    cut = in_ticks(project, asks, 150.0, 0.7, forget=70.0)[-1]
    for layer in LAYERS:
        assert [c for c in kept.layers[layer].cues if c.end > 85] == [
            c for c in cut.layers[layer].cues if c.end > 85
        ]
        assert len(cut.layers[layer].cues) < len(kept.layers[layer].cues)
        assert all(m.end > 70 for m in cut.layers[layer].metas)
    assert (
        pose_at(kept, project, [100.0, 149.0]).rotations == pose_at(cut, project, [100.0, 149.0]).rotations
    ).all()


def test_what_is_before_now_and_the_lookahead_stays(sample: Project) -> None:
    project = replace(sample, settings=replace(sample.settings, lookahead=2.0))
    plan = plan_performance(project, [], 20)
    after = hear_asks(project, plan, 5.0, [a.Gesture(id="x", priority=9)], 20)
    for layer in LAYERS:
        assert [c for c in plan.layers[layer].cues if c.start < 7] == [
            c for c in after.layers[layer].cues if c.start < 7
        ]
    assert answer_ask(after, "x").at >= 7.0


def test_the_past_is_planned_from_nothing_when_nothing_was_shown(sample: Project) -> None:
    assert shown(hear_asks(sample, Plan(1, 0.0), 0.0, [], 20)) == shown(
        plan_performance(sample, [], 20, seed=1)
    )


# --- answers


def test_an_answer_says_when_and_what(sample: Project) -> None:
    plan = plan_performance(sample, [a.Gesture(id="g", tags=("positive",), at=2.1, priority=3)], 20)
    said = answer_ask(plan, "g")
    assert (
        said.state == "planned"
        and said.at == pytest.approx(2.1)
        and said.until > said.at
        and len(said.what) == 1
    )


def test_an_answer_says_why_not(sample: Project) -> None:
    plan = plan_performance(sample, [a.Gesture(id="g", tags=("nonsense",), at=2.0)], 20)
    said = answer_ask(plan, "g")
    assert said.state == "refused" and "nonsense" in said.why


def test_words_nobody_knows_are_refused_with_a_hint(sample: Project) -> None:
    plan = plan_performance(
        sample,
        [a.Go(id="g", stance="arms crosed"), a.Play(id="p", action="shrug"), a.Say(id="s", line="279")],
        5,
    )
    assert "'arms crossed'" in answer_ask(plan, "g").why
    assert "shrug" in answer_ask(plan, "p").why
    assert (
        "'279'" in answer_ask(plan, "s").why and "hello, happy, maybe, you_first" in answer_ask(plan, "s").why
    )


def test_going_where_one_is_is_done_already(sample: Project) -> None:
    plan = plan_performance(sample, [a.Go(id="g", stance="hands at sides", at=0.1)], 5)
    assert answer_ask(plan, "g").state == "done"


def test_far_asks_are_planned_but_not_chosen_yet(sample: Project) -> None:
    said = answer_ask(plan_performance(sample, [a.Gesture(id="g", at=500.0)], 20), "g")
    assert (said.state, said.at) == ("planned", 500.0)


def test_far_asks_that_must_wait_for_others_are_late_not_refused(sample: Project) -> None:
    plan = plan_performance(sample, [a.Gesture(id="g", at=500.5), a.Gesture(id="h", at=500.0)], 20)
    said = answer_ask(plan, "g")
    assert (said.state, said.at) == ("late", 501.0) and "waits" in said.why


def test_withdrawing_among_thousands_takes_back_what_belongs_together(sample: Project) -> None:
    asks = [a.Nod(id=f"n{n}", at=100.0 + n) for n in range(500)] + [
        a.Nod(id=f"n7.{n}", at=900.0 + n) for n in range(1, 3)
    ]
    plan = plan_performance(sample, asks, 20, idle=False)
    gone = hear_asks(
        sample, plan, 1.0, [a.Withdraw(id=f"w{n}", what=f"n{n}") for n in range(400)], 20, idle=False
    )
    assert {r.id for r in gone.requests} == {f"n{n}" for n in range(400, 500)}


def test_layers_that_an_ask_has_nothing_to_do_with_are_left_as_they_are(sample: Project) -> None:
    plan = plan_performance(
        sample, [a.Gesture(id="g", at=8.0), a.Go(id="s", stance="head tilt left", at=9.0, stay=True)], 20
    )
    for ask, touched in (
        (a.Place(id="p", name="user", point=(0.0, 1.0, 2.0)), set()),
        (a.Blink(id="b"), set()),
        (a.Say(id="w", text="hello"), set(LAYERS)),  # who talks moves differently
        (a.Behave(id="m", mode="listening"), set(LAYERS)),
        (a.Nod(id="n"), {"head"}),
        (a.Withdraw(id="x", what="g"), {"arms"}),
        (a.Withdraw(id="x", what="s"), {"head"}),
        (a.Fidget(id="g", layer="body"), {"arms", "body"}),
        (a.Withdraw(id="x"), {"arms", "head"}),
    ):
        after = hear_asks(sample, plan, 2.0, [ask], 20)
        assert {x for x in LAYERS if after.layers[x] is not plan.layers[x]} == touched, ask
        again = hear_asks(sample, after, 2.0, [], 20)  # everything is planned again, and comes out the same
        assert shown(again)[0] == shown(after)[0]


def test_a_withdrawn_ask_does_not_play_and_one_that_plays_goes_on(sample: Project) -> None:
    asks = [
        a.Gesture(id="early", at=1.0, priority=2),
        a.Gesture(id="late", at=12.0, priority=2),
        a.Look(id="look", to="user", at=15.0),
    ]
    plan = plan_performance(sample, asks, 20, idle=False)
    after = hear_asks(sample, plan, 1.5, [a.Withdraw(id="w")], 20, idle=False)
    assert [c.meta for c in after.layers["arms"].cues] == ["early"]
    assert not after.track.looks, "it has not begun"
    one = hear_asks(sample, plan, 1.5, [a.Withdraw(id="w", what="late")], 20, idle=False)
    assert [c.meta for c in one.layers["arms"].cues] == ["early"] and len(one.track.looks) == 1


def test_a_withdrawn_action_is_left_from_where_it_is_and_a_change_of_stance_is_not(sample: Project) -> None:
    asks = [a.Gesture(id="g", at=1.0), a.Go(id="go", at=1.0, stance="head tilt left", layer="head")]
    plan = plan_performance(sample, asks, 20, idle=False)
    (change, *_), (gesture,) = plan.layers["head"].cues, plan.layers["arms"].cues
    after = hear_asks(sample, plan, 1.3, [a.Withdraw(id="w")], 20, idle=False)
    (left,) = after.layers["arms"].cues
    assert left.end == pytest.approx(1.3 + sample.settings.lookahead + STOPPED) and left.end < gesture.end
    assert (left.blend_in, left.blend_out) == (gesture.blend_in, STOPPED)
    assert after.layers["head"].cues[0] == change


def test_what_is_said_takes_the_gestures_along_that_were_made_for_it(sample: Project) -> None:
    said = [
        a.Say(id="s", text="It rains all day, so take a coat.", at=1.0),
        *(a.Gesture(id=f"s/{n}", at=2.0 + 4 * n) for n in range(2)),
        a.Gesture(id="s/x", at=11.0),
    ]
    plan = plan_performance(sample, said, 20, idle=False)
    gone = hear_asks(sample, plan, 3.0, [a.Withdraw(id="w", what="s")], 20, idle=False)
    assert [c.meta for c in gone.layers["arms"].cues] == ["s/0", "s/x"]
    anew = hear_asks(sample, plan, 3.0, [a.Say(id="s", words=(["Stop", 0.0, 0.5],))], 20, idle=False)
    assert [c.meta for c in anew.layers["arms"].cues] == ["s/0", "s/x"]
    more = hear_asks(sample, plan, 3.0, [a.Say(id="s", text="And boots.")], 20, idle=False)
    assert [c.meta for c in more.layers["arms"].cues] == ["s/0", "s/1", "s/x"]
    first, second = more.track.speeches
    assert second.start == first.end and first.length is None


def test_the_same_id_again_replaces_what_was_asked(sample: Project) -> None:
    plan = plan_performance(sample, [a.Gesture(id="g", at=5.0)], 20, idle=False)
    after = hear_asks(sample, plan, 1.0, [a.Fidget(id="g", at=8.0)], 20, idle=False)
    assert [(c.meta, c.action.kind, c.start) for c in after.layers["arms"].cues] == [("g", "fidget", 8.0)]


def test_a_line_brings_its_own_asks_and_withdraws_them_with_it(sample: Project) -> None:
    line = a.Line(text="No, no.", duration=3.0, asks=(a.Shake(at=0.2), a.Gesture(at=0.5, tags=("negative",))))
    project = replace(sample, lines={"279": line})
    plan = plan_performance(project, [a.Say(id="s", line=279, at=4.0)], 20, idle=False)
    assert [(c.meta, round(c.start, 3)) for c in plan.layers["head"].cues] == [("s.1", 4.2)]
    assert [(c.meta, round(c.start, 3)) for c in plan.layers["arms"].cues] == [("s.2", 4.5)]
    assert [(x.start, x.end, x.line) for x in plan.track.speeches] == [(4.0, 7.0, "279")]
    said = answer_ask(plan, "s")
    assert said.state == "planned" and set(said.what) >= {"speech"} and len(said.what) == 3
    gone = hear_asks(project, plan, 1.0, [a.Withdraw(id="w", what="s")], 20, idle=False)
    assert not gone.layers["head"].cues and not gone.track.speeches
    without = plan_performance(project, [a.Say(id="s", line="279", at=4.0, gestures=False)], 20, idle=False)
    assert not without.layers["arms"].cues and without.track.speeches


def test_a_nod_is_a_gesture_tagged_or_called_so(sample: Project) -> None:
    cue = plan_performance(sample, [a.Nod(id="n", at=1.0)], 10, idle=False).layers["head"].cues[0]
    assert cue.action.name.startswith("nod")
    with_tags = plan_performance(sample, [a.Nod(id="n", at=1.0, tags=("nonsense",))], 10, idle=False)
    assert answer_ask(with_tags, "n").state == "refused"


def test_speech_interrupts_speech_of_the_same_weight_but_not_more_important_one(sample: Project) -> None:
    first = a.Say(id="1", text="one two three", at=1.0, duration=5.0)
    plan = plan_performance(sample, [first, a.Say(id="2", text="stop", at=2.0, duration=1.0)], 10)
    assert [(s.id, s.start, s.end) for s in plan.track.speeches] == [("1", 1.0, 2.0), ("2", 2.0, 3.0)]
    first = a.msgspec.structs.replace(first, priority=3)
    plan = plan_performance(sample, [first, a.Say(id="2", text="stop", at=2.0, duration=1.0)], 10)
    assert [s.id for s in plan.track.speeches] == ["1"]


# --- staying


def _left(plan: Plan, layer: Layer) -> list[Cue]:
    return [c for c in plan.layers[layer].cues if c.then != c.stance]


def test_the_models_leave_a_stance_that_is_to_be_kept_alone(sample: Project) -> None:
    project = plan_as_in_paper(sample)
    free = plan_performance(project, [a.Go(id="g", stance="arms crossed", at=1.0)], 120)
    kept = plan_performance(project, [a.Go(id="g", stance="arms crossed", at=1.0, stay=True)], 120)
    assert len(_left(free, "arms")) > 2
    assert [c.then for c in _left(kept, "arms") if c.start >= 1.0] == ["s159"]
    assert len(kept.layers["arms"].cues) > 10  # gestures and fidgets go on
    assert _left(kept, "body") == _left(free, "body")


def test_staying_ends_with_the_next_stance_that_is_asked_for_or_when_it_is_taken_back(
    sample: Project,
) -> None:
    go = a.Go(id="g", stance="arms crossed", at=1.0, stay=True)
    other = plan_performance(sample, [go, a.Go(id="h", stance="on hips", at=20.0, told=20.0)], 160)
    back = plan_performance(sample, [go, a.Withdraw(id="w", what="g", told=20.0)], 160)
    for plan in (other, back):
        assert len([c for c in _left(plan, "arms") if c.start < 19]) == 1
        assert len([c for c in _left(plan, "arms") if c.start > 22]) > 1
    assert [s.on for s in other.track.stays] == [True, False]


def test_where_nothing_is_to_be_kept_stances_leave_no_trace_in_the_track(sample: Project) -> None:
    assert plan_performance(sample, [a.Go(id="g", stance="arms crossed", at=1.0)], 20).track.stays == ()


def test_being_there_already_is_answered_as_before_when_it_is_to_be_kept(sample: Project) -> None:
    plan = plan_performance(sample, [a.Go(id="g", stance="hands at sides", at=0.0, stay=True)], 60)
    assert answer_ask(plan, "g").state == "done"
    assert _left(plan, "arms") == []


def test_what_is_to_be_kept_is_not_forgotten_with_the_past(sample: Project) -> None:
    plan = plan_performance(sample, [a.Go(id="g", stance="arms crossed", at=1.0, stay=True)], 60)
    whole = hear_asks(sample, plan, 40.0, [], 160)
    cut = hear_asks(sample, drop_ended(plan, 40.0), 40.0, [], 160)
    assert [c.start for c in cut.layers["arms"].cues] == [
        c.start for c in whole.layers["arms"].cues if c.end >= 40
    ]
    assert _left(cut, "arms") == []


@pytest.mark.nightly
def test_poses_are_bit_for_bit_the_same_live_in_ticks_of_16_ms_scrubbed_and_baked() -> None:
    """Each pose is taken at its tick from the plan as it was then; later the whole is planned at once and
    posed in any order.
    """
    project = replace(
        _SAMPLE[0], lines={"1": a.Line(text="Well, I would not say so.", duration=2.0, asks=(a.Nod(at=0.4),))}
    )
    heard = [
        a.Gesture(tags=("positive",), told=0.9, priority=3),
        a.Say(line="1", told=2.3),
        a.Look(to=(1.0, 1.4, 1.5), duration=1.5, told=4.0),
        a.Go(stance="on hips", told=5.0),
        a.Gesture(hold=1.5, told=7.7),
        a.Behave(mode="listening", told=8.5),
        a.Blink(told=9.0),
    ]
    end, tick = 12.0, 0.016
    plans = in_ticks(project, heard, end, tick, ahead=4.0, forget=3.0)
    live = [pose_at(plan, project, n * tick) for n, plan in enumerate(plans)]
    whole = plan_performance(
        project, [a.msgspec.structs.replace(x, id=f"ask{n}") for n, x in enumerate(heard)], end + 8
    )
    times = np.arange(len(plans)) * tick
    baked = pose_at(whole, project, times)
    shuffled = np.random.default_rng(3).permutation(len(times))
    scrubbed = {int(n): pose_at(whole, project, times[n]) for n in shuffled[:200]}
    for n, pose in enumerate(live):
        assert (pose.rotations == baked.rotations[n]).all() and (
            pose.translations == baked.translations[n]
        ).all(), n * tick
        if n in scrubbed:
            assert (pose.rotations == scrubbed[n].rotations).all()
    assert np.abs(np.diff(baked.rotations, axis=0)).max() > 1e-3, "it moves"
