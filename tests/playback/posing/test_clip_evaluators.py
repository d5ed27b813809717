"""Clips and live motion as evaluators: what they show at many times is what they show at each."""

from __future__ import annotations

import numpy as np
import pytest

from metagraph.graph.model import Project
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Pose
from metagraph.playback.evaluator import Evaluator, Poses
from metagraph.playback.planner import make_plan
from metagraph.playback.posing.clip_evaluators import (
    ClipEvaluator,
    GeneratedEvaluator,
    MovedEvaluator,
    OverlaidEvaluator,
)
from metagraph.playback.posing.overlay import Overlay, make_clip_overlay

TIMES = np.array([0.1, 1.4, 0.7, 5.0])


@pytest.fixture(scope="module")
def clip(sample: Project) -> Clip:
    found = next(a for a in sample.actions() if a.name == "open_palms_bt_01")
    motion = sample.clips[found.clip].motion
    assert motion is not None
    return motion


def evaluators(sample: Project, clip: Clip) -> dict[str, Poses]:
    plan = make_plan(sample, 8.0)

    def over(time: float) -> Overlay | None:
        return make_clip_overlay(sample, clip, np.array([time])) if time < 4.0 else None

    return {
        "a clip": ClipEvaluator(sample, clip),
        "a clip that moves the body": MovedEvaluator(plan, sample, clip),
        "a generated clip": GeneratedEvaluator(plan, sample, clip),
        "live motion": OverlaidEvaluator(plan, sample, over),
        "a plan": Evaluator(plan, sample),
    }


def apart(one: Pose, other: Pose) -> float:
    turned = np.abs(one.rotations - other.rotations).max(initial=0.0)
    return float(max(turned, np.abs(one.translations - other.translations).max(initial=0.0)))


def test_many_times_at_once_show_what_each_shows(sample: Project, clip: Clip) -> None:
    for name, poses in evaluators(sample, clip).items():
        whole, faces = poses.at(TIMES), poses.faces_at(TIMES)
        for n, time in enumerate(TIMES.tolist()):
            one = poses.at(time)
            assert apart(one, Pose(whole.rotations[n], whole.translations[n])) < 1e-6, (name, time)
            assert poses.morphs_at(time) == pytest.approx(faces[n], abs=1e-6), (name, time)
        assert poses.at(TIMES[:0]).rotations.shape[0] == 0 and poses.faces_at(TIMES[:0]) == [], name


def test_live_motion_shows_where_it_lies_over_the_plan_and_nowhere_else(sample: Project, clip: Clip) -> None:
    found = evaluators(sample, clip)
    live, plan = found["live motion"].at(TIMES), found["a plan"].at(TIMES)
    generated = found["a generated clip"].at(TIMES)
    own = [apart(Pose(live.rotations[n], live.translations[n]), Pose(p.rotations[n], p.translations[n]))
           for n, p in ((1, generated), (3, plan))]  # fmt: skip
    assert max(own) < 1e-6
    assert np.abs(live.rotations[1] - plan.rotations[1]).max() > 0.01
