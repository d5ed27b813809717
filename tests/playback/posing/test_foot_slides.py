"""Which foot is held, steps or is lifted, and how fast one that stands slides."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from metagraph.graph.model import Project
from metagraph.playback.planner import make_plan
from metagraph.playback.posing.composer import find_playable_motion
from metagraph.playback.posing.foot_slides import (
    RATE,
    SLIDES,
    FeetSeen,
    FeetWatch,
    FootState,
    find_feet_joints,
    find_worst_slide,
    measure_slide_speeds,
)
from metagraph.research.exhibits.paper_planner import plan_as_in_paper
from tests.posing import pose_at


def moved(sample: Project, way) -> FeetSeen:
    """What is seen of the body's loop when its root is moved by `way(times)` `[N, 3]`."""
    loop = next(a for a in sample.graphs["body"].actions.values() if a.kind == "stance")
    clip = find_playable_motion(sample, loop)
    assert clip is not None and sample.skeleton is not None
    shift = way(np.arange(clip.frames) / clip.fps)
    translations = np.array(clip.translations)
    translations[:, 0] += shift
    clip = replace(clip, translations=translations.astype(np.float32))
    watch = FeetWatch(
        sample, lambda t: sample.skeleton.globals(clip.pose_at(t))[1], clip.duration, None, clip
    )
    return watch.at(range(int(3 * RATE)))


def drift(speed: float):
    return lambda t: np.stack([speed * t, 0 * t, 0 * t], -1)


def test_feet_that_stand_still_are_held_and_slide_not(sample):
    seen = moved(sample, drift(0.0))
    assert (
        (seen.states == FootState.HELD).all() and not seen.sliding().any() and find_worst_slide(seen) is None
    )


def test_a_slow_drift_is_told_with_its_speed_and_time(sample):
    seen = moved(sample, drift(0.03))
    assert (seen.states == FootState.HELD).all() and seen.sliding().all()
    assert seen.slides[10:-10] == pytest.approx(0.03, abs=0.004)
    time, side, speed = find_worst_slide(seen)
    assert 0 <= time < 3 and side in (0, 1) and speed > SLIDES


def test_what_is_carried_along_quickly_is_on_its_way_and_no_slide(sample):
    seen = moved(sample, drift(0.5))
    assert (seen.states == FootState.STEPPING).all() and not seen.slides.any()


def test_a_jump_lifts_both_feet(sample):
    seen = moved(sample, lambda t: np.stack([0 * t, 0.3 * ((t > 1) & (t < 2)), 0 * t], -1))
    inside = (seen.times > 1.1) & (seen.times < 1.9)
    assert (seen.states[inside] == FootState.LIFTED).all()
    assert (seen.states[seen.times < 0.6] == FootState.HELD).all() and not seen.slides[inside].any()


@pytest.mark.nightly
def test_over_a_performance_nothing_slides_and_what_is_seen_piece_by_piece_is_the_same(sample):
    plan = make_plan(plan_as_in_paper(sample), 30.0, seed=3)

    def places(times):
        return sample.skeleton.globals(pose_at(plan, sample, times))[1]

    whole = FeetWatch(sample, places, 30.0, plan).at(range(int(30 * RATE)))
    assert not whole.sliding().any()
    assert {FootState.HELD, FootState.STEPPING} <= set(np.unique(whole.states).tolist())
    part = FeetWatch(sample, places, 30.0, plan)
    while not part.look(range(240, 300), 7):
        pass
    piece = part.at(range(240, 300))
    assert (piece.states == whole.states[240:300]).all()
    assert piece.slides == pytest.approx(whole.slides[240:300], abs=1e-9)


def test_speeds_are_told_over_a_quarter_of_a_second():
    places = np.zeros((61, 1, 3))
    places[:, 0, 0] = np.arange(61) / 60 * 0.2
    assert (
        measure_slide_speeds(places, 60.0) == pytest.approx(0.2)
        and len(measure_slide_speeds(places, 60.0)) == 46
    )


def test_who_has_no_feet_is_not_watched():
    assert find_feet_joints(Project()) == []
    seen = FeetWatch(Project(), lambda t: np.zeros((len(t), 0, 3)), 1.0).at(range(5))
    assert len(seen.times) == 0 and find_worst_slide(seen) is None
