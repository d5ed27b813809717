"""Requests that say how late they may come: on time or not at all, and what makes room for them."""

from __future__ import annotations

from typing import Any

import pytest

from metagraph.graph import edits
from metagraph.graph.model import Project
from metagraph.graph.requests import Gesture, Go, Play, make_request
from metagraph.playback.plan import Cue, MetaRequest, Plan, Report
from metagraph.playback.planner import make_plan
from metagraph.playback.planning.extend_performance import answer_asks, hear_asks
from metagraph.playback.timing.phases import find_phases


def stroke_of(project: Project, cue: Cue) -> float:
    return cue.start + find_phases(project, cue.action).stroke - cue.entry


def planned(project: Project, *asks: Any, end: float = 40.0) -> Plan:
    return hear_asks(project, Plan(1, 0.0), 0.0, list(asks), end, idle=False)


def cue_of(plan: Plan, ident: str, layer: str = "arms") -> Cue:
    return next(c for c in plan.layers[layer].cues if c.meta == ident)  # type: ignore[index]


def told(plan: Plan, ident: str) -> list[Report]:
    return [r for r in plan.reports if r.request == ident]


def beat(ident: str, stroke: float, late: float | None = 0.0, tag: str = "beat", **more: Any) -> Gesture:
    return Gesture(id=ident, tags=(tag,), stroke=stroke, late=late, **more)


def test_a_stroke_on_time_is_no_news(sample: Project) -> None:
    plan = planned(sample, beat("a", 5.0))
    assert stroke_of(sample, cue_of(plan, "a")) == pytest.approx(5.0)
    assert told(plan, "a") == []


def test_on_time_or_not_at_all_is_refused_with_by_how_much_and_what_it_waits_for(sample: Project) -> None:
    plan = planned(sample, beat("a", 5.0), beat("b", 5.6))
    assert [c.meta for c in plan.layers["arms"].cues] == ["a"]
    (report,) = told(plan, "b")
    running = cue_of(plan, "a")
    assert report.outcome == "too-late" and not report.played
    assert report.late > 0.1
    assert f"{report.late:.2f} s late" in report.message
    assert f"'{running.action.name}'" in report.message and f"{running.end:.2f} s" in report.message
    assert answer_asks(plan, ["b"])["b"].state == "refused"


def test_a_little_late_plays_and_tells_how_late(sample: Project) -> None:
    first = answer_asks(planned(sample, beat("a", 5.0), beat("b", 5.6)), ["b"])["b"]
    assert first.state == "refused"
    plan = planned(sample, beat("a", 5.0), beat("b", 5.6, 2.0))
    (report,) = told(plan, "b")
    assert report.outcome == "late" and report.played
    assert stroke_of(sample, cue_of(plan, "b")) == pytest.approx(5.6 + report.late)
    assert 0 < report.late <= 2.0
    assert answer_asks(plan, ["b"])["b"].state == "late"


def test_a_stroke_that_its_own_preparation_makes_late_says_so(sample: Project) -> None:
    plan = planned(sample, beat("a", 0.05))
    assert "its own preparation" in told(plan, "a")[0].message
    assert not plan.layers["arms"].cues


@pytest.mark.parametrize("late", [0.0, 0.4])
def test_nothing_comes_later_than_it_may(sample: Project, late: float) -> None:
    asks = [beat(f"g{n}", 2.0 + 0.9 * n, late, "beat" if n % 2 else "explain") for n in range(12)]
    plan = planned(sample, *asks)
    assert len(plan.layers["arms"].cues) >= 5
    for cue in plan.layers["arms"].cues:
        wanted = next(a for a in asks if a.id == cue.meta).stroke
        assert wanted is not None and stroke_of(sample, cue) <= wanted + late + 1e-5
    every = {a.id for a in asks}
    assert {c.meta for c in plan.layers["arms"].cues} | {r.request for r in plan.reports} == every


def test_the_retraction_is_cut_for_the_next_stroke_and_not_where_nothing_follows(sample: Project) -> None:
    alone = cue_of(planned(sample, beat("a", 5.0)), "a")
    plan = planned(sample, beat("a", 5.0), beat("b", 6.6))
    cut, second = cue_of(plan, "a"), cue_of(plan, "b")
    assert cut.end < cut.start + (alone.end - alone.start) - 0.3
    assert cut.blend_out >= 0.4
    found = find_phases(sample, cut.action)
    assert cut.end - cut.blend_out >= cut.start + found.stroke_end - cut.entry - 1e-9  # after its own stroke
    assert second.start >= cut.end and stroke_of(sample, second) == pytest.approx(6.6)
    usual = planned(sample, beat("a", 5.0, None), beat("b", 6.6, None))
    whole = usual.layers["arms"].cues[0]
    start, end = sample.span(whole.action)
    assert whole.end - whole.start == pytest.approx(end - start)
    assert told(usual, "b")[0].outcome in ("late", "queued")  # as without this field


def test_one_gesture_serves_two_strokes_that_nearly_coincide(sample: Project) -> None:
    plan = planned(sample, beat("a", 5.0), beat("b", 5.2, 0.0, "emphasis"))
    (cue,) = plan.layers["arms"].cues
    assert cue.meta == "a" and {"beat", "emphasis"} <= set(cue.action.tags)
    (report,) = told(plan, "b")
    assert (report.outcome, report.by, report.played) == ("shared", "a", True)
    found = answer_asks(plan, ["a", "b"])
    assert found["a"].state == found["b"].state == "planned"
    assert found["b"].what == found["a"].what and found["b"].at == found["a"].at


def test_what_was_served_is_not_played_again_once_it_has_begun(sample: Project) -> None:
    plan = planned(sample, beat("a", 5.0), beat("b", 5.2, 0.0, "emphasis"))
    now = cue_of(plan, "a").start + 0.05
    for step in (now, 5.1, 5.3, 6.0, 9.0):
        plan = hear_asks(sample, plan, step, [], 50.0, idle=False)
        assert [c.meta for c in plan.layers["arms"].cues] == ["a"]
        assert answer_asks(plan, ["b"])["b"].state == "planned"


def test_strokes_that_no_one_clip_has_are_not_shared(sample: Project) -> None:
    plan = planned(sample, beat("a", 5.0), beat("b", 5.2, 0.0, "stop"))
    assert [r.outcome for r in told(plan, "b")] == ["too-late"]
    plan = planned(sample, beat("a", 5.0), beat("b", 5.3, 0.0, "emphasis"))  # too far apart
    assert [r.outcome for r in told(plan, "b")] == ["too-late"]


def test_what_leaves_room_for_the_next_is_preferred(sample: Project) -> None:
    """Of gestures with the tag beat, doubles and triples are longer than 1.6 s at the least."""
    names = set()
    for seed in range(30):
        plan = hear_asks(sample, Plan(seed, 0.0), 0.0, [beat("a", 5.0), beat("b", 6.35)], 20.0, idle=False)
        assert {c.meta for c in plan.layers["arms"].cues} == {"a", "b"}
        names.add(cue_of(plan, "a").action.name)
    assert not any("double" in n or "triple" in n for n in names), names
    assert len(names) > 1  # chance still chooses among those that do


def test_what_a_model_began_is_left_for_a_stroke(sample: Project) -> None:
    plan = hear_asks(sample, Plan(3, 0.0), 0.0, [], 60.0)
    cue = next(c for c in plan.layers["arms"].cues if c.action.kind == "fidget" and c.end - c.start > 2.0)
    now = cue.start + 0.6
    asked = Gesture(id="a", stroke=now + 1.2, late=0.0)
    after = hear_asks(sample, plan, now, [asked], 60.0)
    left = next(c for c in after.layers["arms"].cues if c.start == cue.start)
    assert left.end < cue.end and left.end - left.blend_out >= now + sample.settings.lookahead - 1e-9
    assert stroke_of(sample, cue_of(after, "a")) == pytest.approx(now + 1.2)
    plain = hear_asks(sample, plan, now, [Gesture(id="a", stroke=now + 1.2)], 60.0)
    assert next(c for c in plain.layers["arms"].cues if c.start == cue.start) == cue  # not without `late`


def test_poses_up_to_now_stay_when_something_is_left_early(sample: Project) -> None:
    from tests.posing import pose_at

    plan = hear_asks(sample, Plan(3, 0.0), 0.0, [], 60.0)
    cue = next(c for c in plan.layers["arms"].cues if c.action.kind == "fidget" and c.end - c.start > 2.0)
    now = cue.start + 0.6
    after = hear_asks(sample, plan, now, [Gesture(id="a", stroke=now + 1.2, late=0.0)], 60.0)
    assert after.layers["arms"].cues != plan.layers["arms"].cues
    for t in (now - 0.3, now, now + sample.settings.lookahead - 1e-6):
        a, b = pose_at(plan, sample, t), pose_at(after, sample, t)
        assert a.rotations == pytest.approx(b.rotations, abs=1e-6)


def test_without_a_stroke_the_start_counts(sample: Project) -> None:
    plan = planned(sample, Gesture(id="a", at=2.0), Gesture(id="b", at=2.5, late=0.3))
    assert [r.outcome for r in told(plan, "b")] == ["too-late"]
    assert told(plan, "b")[0].late == pytest.approx(cue_of(plan, "a").end - 2.5)


def test_transitions_on_the_way_count(sample: Project) -> None:
    far = next(
        a for a in sample.graphs["arms"].actions.values() if a.kind == "gesture" and a.stance == "s159"
    )
    plan = planned(sample, Play(id="a", action=far.id, at=2.0, late=0.2))
    (report,) = told(plan, "a")
    assert report.outcome == "too-late" and not plan.layers["arms"].cues
    plan = planned(sample, Play(id="a", action=far.id, at=2.0, late=10.0))
    assert [c.action.kind for c in plan.layers["arms"].cues] == ["transition", "gesture"]
    assert told(plan, "a")[0].late == pytest.approx(plan.layers["arms"].cues[1].start - 2.0)


def test_going_to_a_stance_may_set_off_late_or_not(sample: Project) -> None:
    plan = planned(
        sample, Gesture(id="a", at=2.0), Go(id="b", at=2.5, stance="on hips", layer="arms", late=0.0)
    )
    assert [r.outcome for r in told(plan, "b")] == ["too-late"]
    plan = planned(sample, Go(id="b", at=2.5, stance="on hips", layer="arms", late=0.0))
    assert [c.meta for c in plan.layers["arms"].cues] == ["b"]


def test_planning_in_steps_tells_it_once(sample: Project) -> None:
    plan = planned(sample, beat("a", 5.0), beat("b", 5.6, 2.0), beat("c", 12.0), beat("d", 12.5))
    whole = [(r.request, r.outcome) for r in plan.reports]
    for now in (0.5, 2.0, 4.0, 5.0, 7.0, 9.0, 11.9):
        plan = hear_asks(sample, plan, now, [], 50.0, idle=False)
    assert [(r.request, r.outcome) for r in plan.reports] == whole
    assert len(whole) == len(set(whole)) == 2


def test_more_important_ones_still_come_first(sample: Project) -> None:
    plan = planned(sample, beat("a", 5.0), Gesture(id="b", at=5.3, priority=5))
    assert cue_of(plan, "b").start == pytest.approx(5.3)


def test_plans_without_the_field_stay_as_they_were(sample: Project) -> None:
    asks = [MetaRequest(f"r{n}", "arms", "gesture", 2.0 + n, stroke=3.0 + n) for n in range(6)]
    plan = make_plan(sample, 30.0, asks, idle=False)
    assert not {r.outcome for r in plan.reports} & {"too-late", "shared"}
    assert all(r.late == 0 and r.by == "" for r in plan.reports)


@pytest.mark.parametrize("late", [-1, 601, "soon"])
def test_a_lateness_that_is_none_is_refused_by_name(late: object) -> None:
    with pytest.raises(ValueError, match="late"):
        make_request({"do": "gesture", "late": late})


def test_cooling_down_refuses_what_may_be_late_too(sample: Project) -> None:
    (one,) = (
        a for a in sample.graphs["arms"].actions.values() if a.name == "shrug_bt_01" and a.stance == "s157"
    )
    project = edits.update_actions(sample, [one.id], cooldown=20.0)
    plan = planned(project, beat("a", 5.0, 0.0, "unsure"), beat("b", 12.0, 5.0, "unsure"))
    assert [r.outcome for r in told(plan, "b")] == ["cooling"]
