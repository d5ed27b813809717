"""Variation under control: cooldown, spacing, memory, rest between actions; strokes that land, holds that
last, preparations skipped.
"""

from __future__ import annotations

from collections import Counter
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from metagraph.graph import edits
from metagraph.graph.model import Project
from metagraph.playback.plan import Cue, LayerPlan, MetaRequest, Plan
from metagraph.playback.planner import extend_plan, make_plan
from metagraph.playback.timing.phases import find_phases
from tests.posing import pose_at


@pytest.fixture
def project(toy: Any) -> Project:
    return toy.project()


def arms(
    project: Project, *requests: MetaRequest, end: float = 60.0, seed: int = 1
) -> tuple[LayerPlan, Plan]:
    plan = make_plan(project, end, requests, seed, idle=False)
    return plan.layers["arms"], plan


def every(seconds: float, count: int, **more: Any) -> list[MetaRequest]:
    return [MetaRequest(f"r{n}", "arms", "gesture", n * seconds, **more) for n in range(count)]


def names(plan: LayerPlan) -> list[str]:
    return [cue.action.name for cue in plan.cues]


# --- what plays how often


def test_an_action_that_cools_down_is_not_drawn_before_its_time(project: Project, toy: Any) -> None:
    project = edits.update_actions(project, [toy.id(project, "rest wave rt")], cooldown=12.0)
    cues = [c for c in arms(project, *every(3.0, 40), end=130)[0].cues if c.action.name == "rest wave rt"]
    assert len(cues) > 2
    assert all(b.start - a.end >= 12.0 - 1e-6 for a, b in pairwise(cues))


def test_when_all_are_cooling_down_that_is_said_with_the_time(project: Project) -> None:
    gestures = [a.id for a in project.actions() if a.kind == "gesture"]
    project = edits.update_actions(project, gestures, cooldown=100.0)
    plan, whole = arms(project, *every(3.0, 6))
    assert len(plan.cues) == 4  # each once
    told = [r for r in whole.reports if r.outcome == "cooling"]
    assert [r.request for r in told] == ["r4", "r5"]
    assert f"{plan.cues[0].end + 100:.2f} s" in told[0].message or "cooling down" in told[0].message


def test_an_action_asked_for_by_name_plays_although_it_cools_down(project: Project, toy: Any) -> None:
    ident = toy.id(project, "rest wave rt")
    project = edits.update_actions(project, [ident], cooldown=100.0)
    plan, _ = arms(
        project,
        MetaRequest("a", "arms", "gesture", 0, action=ident),
        MetaRequest("b", "arms", "gesture", 3, action=ident),
    )
    assert names(plan) == ["rest wave rt"] * 2


def test_spacing_puts_other_actions_between_two_uses(project: Project, toy: Any) -> None:
    project = edits.update_actions(project, [toy.id(project, "rest wave rt")], spacing=3)
    places = [
        n
        for n, name in enumerate(names(arms(project, *every(3.0, 60), end=200)[0]))
        if name == "rest wave rt"
    ]
    assert len(places) > 3 and all(b - a > 3 for a, b in pairwise(places))


def test_spacing_of_nothing_lets_one_action_repeat_and_never_twice_does_not(project: Project) -> None:
    gestures = [a.id for a in project.actions() if a.kind == "gesture"]
    played = names(arms(project, *every(3.0, 60), end=200)[0])
    assert all(a != b for a, b in pairwise(played))
    free = edits.update_actions(edits.set_settings(project, alpha=0.0), gestures, spacing=0)
    played = names(arms(free, *every(3.0, 60), end=200)[0])
    assert any(a == b for a, b in pairwise(played))


def test_more_spacing_than_there_are_actions_is_relaxed_not_refused(project: Project) -> None:
    gestures = [a.id for a in project.actions() if a.kind == "gesture"]
    project = edits.update_actions(project, gestures, spacing=30)
    played = names(arms(project, *every(3.0, 40), end=130)[0])
    assert len(played) == 40
    assert all(len(set(played[n : n + 4])) == 4 for n in range(0, 36, 4))  # all four, turn about


def test_a_short_memory_forgets_what_was_used(project: Project, toy: Any) -> None:
    """One action is used ten times by name; with a memory of 20 s it is as likely as the others a minute
    later.
    """
    ident = toy.id(project, "rest wave rt")
    used = [MetaRequest(f"u{n}", "arms", "gesture", 2.0 * n, action=ident) for n in range(10)]

    def drawn(memory: float) -> int:
        changed = edits.set_settings(project, memory=memory, never_twice=False, variety=0.0)
        first = [
            arms(changed, *used, MetaRequest("x", "arms", "gesture", 80.0), end=100, seed=seed)[0].cues[-1]
            for seed in range(200)
        ]
        return sum(c.action.id == ident for c in first)

    assert drawn(0.0) < 15 < 30 < drawn(20.0)


def test_actions_of_a_layer_are_as_far_apart_as_the_settings_say(project: Project) -> None:
    project = edits.set_settings(project, rest=1.5)
    plan, _ = arms(project, *[MetaRequest(f"r{n}", "arms", "gesture", n * 0.8) for n in range(12)])
    assert len(plan.cues) > 3
    assert all(b.start - a.end >= 1.5 - 1e-9 for a, b in pairwise(plan.cues))


def test_rest_holds_across_extensions(project: Project) -> None:
    project = edits.set_settings(project, rest=1.5)
    plan = make_plan(project, 10, [MetaRequest("a", "arms", "gesture", 1.0)], idle=False)
    plan = extend_plan(
        project,
        plan,
        plan.layers["arms"].cues[0].end + 0.1,
        [MetaRequest("b", "arms", "gesture", 2.0)],
        20,
        idle=False,
    )
    first, second = plan.layers["arms"].cues
    assert second.start == pytest.approx(first.end + 1.5)


# --- phases used


def test_a_stroke_lands_where_it_is_asked_for(sample: Project) -> None:
    for seed in range(12):
        request = MetaRequest("x", "arms", "gesture", 2.0, stroke=4.25)
        cue = make_plan(sample, 20, [request], seed, idle=False).layers["arms"].cues[0]
        assert cue.clip_seconds(4.25) == pytest.approx(find_phases(sample, cue.action).stroke)


def test_a_stroke_that_is_nearly_too_late_cuts_the_preparation_and_one_too_late_comes_late(toy: Any) -> None:
    project = toy.project()
    ident = toy.id(project, "rest long")
    project = edits.update_actions(
        project, [ident], timing={"ready": 1.0, "stroke": 1.2, "stroke_end": 1.4, "relax": 1.6}
    )
    for asked, entry in ((1.2, 0.0), (0.8, 0.4), (0.45, 0.75), (0.2, 0.75)):
        request = MetaRequest("x", "arms", "gesture", 0.0, action=ident, stroke=asked)
        cue = make_plan(project, 10, [request], idle=False).layers["arms"].cues[0]
        assert (cue.start, cue.entry) == (0.0, pytest.approx(entry)), asked


def test_a_hold_lasts_as_long_as_asked_and_the_rest_keeps_its_speed(sample: Project) -> None:
    action = next(x for x in sample.actions() if x.name == "open_palms_bt_01" and x.limb == "both")
    found, (start, end) = find_phases(sample, action), sample.span(action)
    natural = found.relax - found.stroke_end
    assert natural > 0.2
    for asked in (natural, 1.0, 4.0):
        request = MetaRequest("x", "arms", "gesture", 1.0, action=action.id, hold=asked)
        cue = make_plan(sample, 20, [request], idle=False).layers["arms"].cues[-1]
        assert cue.end - cue.start == pytest.approx(end - start - natural + asked)
        times = np.linspace(cue.start, cue.end, 400)
        clip = cue.clip_seconds(times)
        assert (
            clip[0] == pytest.approx(start) and clip[-1] == pytest.approx(end) and (np.diff(clip) > 0).all()
        )
        outside = (clip < found.stroke_end - 0.02) | (clip > found.relax + 0.02)
        rate = np.gradient(clip, times)
        assert rate[outside] == pytest.approx(1.0, abs=1e-6)


def test_a_hold_is_never_hurried_beyond_twice_its_speed(sample: Project) -> None:
    action = next(x for x in sample.actions() if x.name == "open_palms_bt_01")
    natural = find_phases(sample, action).relax - find_phases(sample, action).stroke_end
    cue = (
        make_plan(
            sample, 20, [MetaRequest("x", "arms", "gesture", 1.0, action=action.id, hold=0.0)], idle=False
        )
        .layers["arms"]
        .cues[-1]
    )
    assert cue.hold == pytest.approx(natural / 2)


def test_a_held_pose_does_not_stop_dead_or_jump(sample: Project) -> None:
    """Hands move at most as fast as the clip moves them, before, in and after a stretched hold."""
    action = next(x for x in sample.actions() if x.name == "open_palms_bt_01")
    hands = [sample.skeleton.names.index(n) for n in sample.skeleton.names if n.endswith("Hand")]

    def fastest(hold: float | None) -> float:
        plan = make_plan(
            sample, 20, [MetaRequest("x", "arms", "gesture", 1.0, action=action.id, hold=hold)], idle=False
        )
        cue = plan.layers["arms"].cues[-1]
        times = np.arange(cue.start - 0.5, cue.end + 0.5, 1 / 60)
        _, places = sample.skeleton.globals(pose_at(plan, sample, times, alive=False))
        return float(np.linalg.norm(np.diff(places[:, hands], axis=0), axis=-1).max() * 60)

    assert fastest(3.0) <= fastest(None) * 1.05


def test_a_preparation_is_skipped_and_blended_over(toy: Any) -> None:
    project = toy.project()
    ident = toy.id(project, "rest long")
    project = edits.update_actions(project, [ident], timing={"ready": 1.0, "stroke": 1.2})
    cue = (
        make_plan(
            project, 10, [MetaRequest("x", "arms", "gesture", 1.0, action=ident, prepare=False)], idle=False
        )
        .layers["arms"]
        .cues[0]
    )
    assert (
        cue.entry == pytest.approx(0.75)
        and cue.blend_in >= 0.25
        and cue.end - cue.start == pytest.approx(2.4 - 0.75)
    )


def test_holds_and_skips_mean_nothing_to_fidgets_and_transitions(toy: Any) -> None:
    project = toy.project()
    up = toy.id(project, "up")
    asked = [
        MetaRequest("f", "arms", "fidget", 1.0, hold=3.0, prepare=False),
        MetaRequest("t", "arms", "transition", 4.0, stance=up, hold=3.0),
    ]
    plan = make_plan(project, 10, asked, idle=False).layers["arms"]
    assert [c.hold for c in plan.cues] == [0.0, 0.0] and all(
        c.entry == project.span(c.action)[0] for c in plan.cues
    )


@settings(max_examples=20)
@given(st.floats(0, 8), st.booleans(), st.one_of(st.none(), st.floats(0, 12)), st.integers(0, 50))
def test_whatever_is_asked_of_the_phases_cues_stay_apart_and_within_their_clips(
    sample: Project, hold: float, prepare: bool, stroke: float | None, seed: int
) -> None:
    requests = [
        MetaRequest(f"r{n}", "arms", "gesture", 1.3 * n, hold=hold, prepare=prepare, stroke=stroke)
        for n in range(6)
    ]
    cues: tuple[Cue, ...] = make_plan(sample, 40, requests, seed).layers["arms"].cues
    assert all(a.end <= b.start + 1e-9 for a, b in pairwise(cues))
    for cue in cues:
        start, end = sample.span(cue.action)
        assert start - 1e-6 <= cue.entry and cue.last <= end + 1e-6 and cue.end > cue.start
        assert cue.blend_in + cue.blend_out <= cue.end - cue.start + 1e-9


def test_draws_follow_likelihood_over_uses(project: Project, toy: Any) -> None:
    project = edits.update_actions(
        edits.set_settings(project, alpha=0.0, never_twice=False, variety=0.0),
        [toy.id(project, "rest short")],
        likelihood=3.0,
    )
    counted = Counter(names(arms(project, *every(3.0, 600), end=2000)[0]))
    assert counted["rest short"] / 600 == pytest.approx(0.5, abs=0.07)
