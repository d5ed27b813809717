"""A recording mimicked: the same as live, mixed with what else plays."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from metagraph.graph import requests as a
from metagraph.graph.editing.performances import add_performance
from metagraph.graph.model import LAYERS, Project
from metagraph.mimicry.keypoint_layouts import POINTS, KeypointTrack
from metagraph.mimicry.performing import find_goal_stances, mimic_performance, place_requests
from metagraph.playback.planning.extend_performance import answer_ask
from metagraph.playback.planning.running_plan import plan_performance
from sample_clips.make.sample_keypoints import SECONDS, View, played, seen, truth
from tests.mimicry import people


@pytest.fixture(scope="module")
def somebody(toy: Any) -> Project:
    return people.somebody(toy.skeleton)


@pytest.fixture(scope="module")
def talk(sample: Project) -> KeypointTrack:
    times, _, space, sure = seen(*played(sample), "coco", 20.0, SECONDS, View())
    return KeypointTrack(times, space * [1, -1, -1], sure, POINTS, 3)


def shown(project: Project, kinds: list[tuple[str, float]], fps: float = 20.0) -> KeypointTrack:
    points = np.concatenate(
        [np.tile(people.standing(project, kind), (round(seconds * fps), 1, 1)) for kind, seconds in kinds]
    )
    return KeypointTrack(np.arange(len(points)) / fps, points, np.ones(points.shape[:2]), POINTS, 3)


def test_nobody_is_refused(somebody: Project) -> None:
    empty = KeypointTrack(np.zeros(0), np.zeros((0, 17, 3)), np.zeros((0, 17)), POINTS, 3)
    with pytest.raises(ValueError, match="nobody"):
        mimic_performance(somebody, empty)


def test_stances_are_looked_for_in_the_picture_where_depth_was_guessed(somebody: Project) -> None:
    wrong, right = (shown(somebody, [(kind, 4)]) for kind in ("down", "raised"))
    right = replace(right, points=right.points * [1.0, 1.0, 0.0], dims=2)
    found = mimic_performance(somebody, replace(wrong, flat=right), mirror=False)
    assert found.performance.asks == mimic_performance(somebody, right, mirror=False).performance.asks
    arms = {ask.stance for ask in found.performance.asks if ask.layer == "arms"}  # type: ignore[union-attr]
    assert {somebody.stance(stance).name for stance in arms} == {"raised"}  # type: ignore[union-attr]


def test_what_is_seen_is_asked_for_when_it_is_seen(somebody: Project) -> None:
    found = mimic_performance(somebody, shown(somebody, [("down", 3), ("raised", 4)]), mirror=False)
    rows = [(ask.layer, somebody.stance(ask.stance).name) for ask in found.performance.asks]  # type: ignore[union-attr]
    assert sorted(rows) == [("arms", "down"), ("arms", "raised"), ("head", "straight")]
    assert [s.at for s in found.sightings] == [ask.told for ask in found.performance.asks]
    assert found.performance.length == pytest.approx(8.95)


@pytest.mark.nightly
def test_the_performance_goes_through_the_stances_of_the_recording(
    sample: Project, talk: KeypointTrack
) -> None:
    found = mimic_performance(sample, talk, mirror=False)
    plan = plan_performance(sample, found.performance.asks, found.performance.length)
    rows = truth(*played(sample))
    for layer in LAYERS:
        good = total = 0
        for start, end, name in rows[layer]:
            for at in np.arange(
                start + 3.0, end, 0.1
            ):  # the character finishes what it does, then changes over
                total += 1
                good += sample.graphs[layer].stances[plan.layers[layer].stance_at(at)].name == name  # type: ignore[index]
        assert good / total > 0.9, layer


@pytest.mark.nightly
def test_the_models_gesture_on_but_leave_the_stances_alone(sample: Project, talk: KeypointTrack) -> None:
    found = mimic_performance(sample, talk, mirror=False)
    plan = plan_performance(sample, found.performance.asks, found.performance.length)
    for layer in LAYERS:
        changes = [c for c in plan.layers[layer].cues if c.then != c.stance and c.start > 1.0]
        assert changes and not [c for c in changes if c.meta.startswith("auto/")]
    assert [c for c in plan.layers["arms"].cues if c.meta.startswith("auto/")]


@pytest.mark.nightly
def test_kept_and_placed_it_performs_the_same(sample: Project, talk: KeypointTrack) -> None:
    found = mimic_performance(sample, talk)
    project, ident = add_performance(sample, place_requests(sample, found.performance))
    kept = project.performances[ident]
    assert [ask.id for ask in kept.asks] == [ask.id for ask in found.performance.asks]
    assert all(ask.at == pytest.approx(ask.told + sample.settings.lookahead) for ask in kept.asks)
    a_plan, b_plan = (plan_performance(sample, p.asks, p.length) for p in (found.performance, kept))
    for layer in LAYERS:
        assert [(c.action.id, round(c.start, 2)) for c in a_plan.layers[layer].cues] == [
            (c.action.id, round(c.start, 2)) for c in b_plan.layers[layer].cues
        ]


@pytest.mark.nightly
def test_other_requests_are_mixed_in_and_met(sample: Project, talk: KeypointTrack) -> None:
    asks = (a.Gesture(id="g", tags=("positive",), at=2.0, priority=2), a.Nod(at=10.0))
    found = mimic_performance(sample, talk, mirror=False, into=a.Performance(name="mixed", asks=asks))
    plan = plan_performance(sample, found.performance.asks, found.performance.length)
    assert answer_ask(plan, "g").at is not None
    assert found.performance.asks[:2] == asks


@pytest.mark.nightly
def test_what_leads_the_character_away_is_taken_back_by_what_is_seen(
    sample: Project, talk: KeypointTrack
) -> None:
    away = a.Go(id="away", stance="hands clasped", at=10.0, priority=3)
    found = mimic_performance(sample, talk, mirror=False, into=a.Performance(name="mixed", asks=(away,)))
    again = [s for s in found.sightings if s.again]
    assert (
        again
        and sample.graphs["arms"].stances[again[0].stance].name == "on hips"
        and 8.0 < again[0].at < 14.0
    )
    plan = plan_performance(sample, found.performance.asks, found.performance.length)
    assert sample.graphs["arms"].stances[plan.layers["arms"].stance_at(15.0)].name == "on hips"  # type: ignore[index]


def test_goals_are_where_the_character_is_or_goes_and_where_its_own_requests_lead(sample: Project) -> None:
    asks = [a.Go(id="mine1", stance="on hips", at=3.0), a.Go(id="other", stance="arms crossed", at=8.0)]
    plan = plan_performance(sample, asks, 12.0, idle=False)
    hips, crossed = (
        next(s.id for s in sample.graphs["arms"].stances.values() if s.name == n)
        for n in ("on hips", "arms crossed")
    )
    assert find_goal_stances(plan, 0.0, "nobody")["arms"] == sample.graphs["arms"].start
    assert (
        find_goal_stances(plan, 0.0, "mine")["arms"]
        == find_goal_stances(plan, 3.2, "nobody")["arms"]
        == find_goal_stances(plan, 6.0, "mine")["arms"]
        == hips
    )
    assert (
        find_goal_stances(plan, 8.5, "mine")["arms"]
        == find_goal_stances(plan, 11.0, "mine")["arms"]
        == crossed
    )
    assert set(find_goal_stances(plan, 0.0, "mine")) == set(LAYERS)


def test_with_no_models_only_the_person_moves_the_character(somebody: Project) -> None:
    found = mimic_performance(
        somebody,
        shown(somebody, [("down", 2), ("hips", 3)]),
        mirror=False,
        into=a.Performance(name="still", idle=False, length=5),
    )
    assert not found.performance.idle
    plan = plan_performance(somebody, found.performance.asks, 6.0, idle=False)
    assert [c.action.kind for c in plan.layers["arms"].cues] == ["transition"]


@pytest.mark.nightly
def test_a_performance_is_mixed_into_with_its_seed_stances_and_what_was_told_on_the_way(
    sample: Project, talk: KeypointTrack
) -> None:
    crossed = next(s.id for s in sample.graphs["arms"].stances.values() if s.name == "arms crossed")
    asks = (a.Nod(id="n", at=30.0, told=25.0), a.Gesture(id="mimic1", layer="head", at=3.0))
    into = a.Performance(name="talk", asks=asks, seed=7, stances={"arms": crossed}, length=10.0)
    found = mimic_performance(sample, talk, mirror=False, into=into).performance
    assert (found.name, found.seed, found.stances, found.asks[:2]) == ("talk", 7, into.stances, asks)
    assert found.length == pytest.approx(talk.seconds, abs=1e-3)
    ids = [ask.id for ask in found.asks]
    assert len(set(ids)) == len(ids) and ids[2] == "mimicb1"
    plan = plan_performance(sample, found.asks, found.length, found.seed, dict(found.stances))
    assert (
        answer_ask(plan, "n").state in ("planned", "late") and plan.layers["arms"].rests[0].stance == crossed
    )


def test_progress_is_told_and_may_end_it(somebody: Project) -> None:
    told: list[tuple[int, int]] = []
    mimic_performance(
        somebody, shown(somebody, [("down", 6)]), progress=lambda n, total: told.append((n, total))
    )
    assert told == [(0, 120), (50, 120), (100, 120)]

    def stop(n: int, total: int) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        mimic_performance(somebody, shown(somebody, [("down", 6)]), progress=stop)
