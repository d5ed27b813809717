"""Which clip can leave and enter which stance without a jump, by hand and on the sample."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.graph import anatomy
from metagraph.graph.model import LAYERS, REACH, Project
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Skeleton
from metagraph.suggest.jumps.compatibility import (
    BLEND,
    LEVEL,
    STEP,
    Statistics,
    blend,
    compute_statistics,
    find_loop_times,
    find_stance_frames,
    fit_clip,
    list_stance_loops,
    make_compatibility_matrix,
    measure_transition_costs,
    propose_times,
)  # fmt: skip
from metagraph.suggest.tracks import RATE
from tests.suggest.test_traits import chain, moved


def slide(speed: float, frames: int = 30, second: float = 0.0, name: str = "slide") -> Clip:
    """Two joints; the second goes straight on, `speed` metres a second from `second`."""
    skeleton = Skeleton(
        ("Root", "Tip"),
        np.array([-1, 0]),
        np.tile([0, 0, 0, 1.0], (2, 1)),
        np.array([[0, 1.0, 0], [0, 0.5, 0]]),
    )
    places = np.zeros((frames, 2, 3))
    places[:, 0, 1] = 1
    places[:, 1] = [0, 0.5, 0]
    places[:, 1, 1] += second + speed * np.arange(frames) / RATE
    return Clip(name, skeleton, RATE, np.tile([0, 0, 0, 1.0], (frames, 2, 1)), places, (0, 1))


def test_without_clips_the_threshold_is_the_least() -> None:
    stats = compute_statistics([], "arms")
    assert stats.distribution is None and stats.threshold > 0 and stats.count == 0


def test_clips_in_which_nothing_moves_have_the_least_threshold() -> None:
    stats = compute_statistics([slide(0.0)], "body", {})
    assert stats.distribution is None and stats.threshold == compute_statistics([], "body").threshold
    assert np.allclose(
        measure_transition_costs(
            stats, slide(0.0), find_stance_frames(stats, [(slide(0.0), 0.0, 1.0)], {}), {}
        ),
        0,
    )


def test_clips_of_one_and_two_frames_say_nothing_and_break_nothing() -> None:
    stats = compute_statistics([slide(1.0, 1), slide(1.0, 2)], "body", {})
    assert stats.count == 0
    stance = find_stance_frames(stats, [(slide(1.0, 1), 0.0, 0.0)], {})
    moving = compute_statistics([slide(1.0)], "body", {})
    for frames in (1, 2):
        cost = measure_transition_costs(moving, slide(1.0, frames), stance, {})
        assert len(cost) == frames and np.isfinite(cost).all()
        found = propose_times(moving, slide(1.0, frames), cost, roles={})
        assert 0 <= found.start <= found.end <= slide(1.0, frames).duration


def test_a_cost_by_hand() -> None:
    # One joint at 0.3 m/s: c_(i, i+3) is the way of 2 frames, 0.02 m, and no difference of velocity.
    stats = compute_statistics([slide(0.3, 60)], "body", {})
    assert stats.threshold == pytest.approx(0.02, rel=1e-3)
    # Beside a stance 0.1 m above, at rest: 0.1 m and w_v * 0.3 m/s.
    cost = measure_transition_costs(
        replace(stats, velocity=0.5),
        slide(0.3, 2),
        find_stance_frames(stats, [(slide(0.0, 1, 0.1), 0.0, 0.0)], {}),
        {},
    )
    assert cost[0] * stats.threshold == pytest.approx(0.1 + 0.5 * 0.3, rel=1e-4)


def test_the_velocity_weighs_as_much_as_the_position(sample: Project) -> None:
    motions = [e.motion for e in list(sample.clips.values())[:20] if e.motion is not None]
    stats = compute_statistics(motions, "arms", anatomy.project_roles(sample))
    assert stats.velocity > 0 and stats.count > 500
    assert stats.share == pytest.approx(LEVEL, abs=0.04)


@given(st.floats(0.05, 3))
def test_the_threshold_grows_with_how_much_moves(factor: float) -> None:
    one, more = (
        compute_statistics([slide(0.2, 40)], "body", {}),
        compute_statistics([slide(0.2 * factor, 40)], "body", {}),
    )
    assert more.threshold == pytest.approx(max(1e-3, factor * one.threshold), rel=0.01)


def test_fingers_and_faces_do_not_count() -> None:
    names = ("Hips", "Spine", "Head", "Jaw", "LeftUpperArm", "LeftLowerArm", "LeftHand", "LeftIndex1")
    skeleton = Skeleton(
        names, np.array([-1, 0, 1, 2, 1, 4, 5, 6]), np.tile([0, 0, 0, 1.0], (8, 1)), np.full((8, 3), 0.1)
    )
    still = np.tile([0, 0, 0, 1.0], (40, 8, 1))
    fingers = still.copy()
    angle = np.sin(np.arange(40))
    for joint in (3, 7):
        fingers[:, joint] = np.stack([np.sin(angle), 0 * angle, 0 * angle, np.cos(angle)], -1)
    assert (
        compute_statistics([Clip("x", skeleton, 30, fingers, np.zeros((40, 1, 3)))], "arms").distribution
        is None
    )


def test_place_and_facing_do_not_count(toy: Any) -> None:
    clip = toy.clip("x", 0.6, 0.0, 0.8)  # short enough to be compared with every frame
    stats = compute_statistics([clip], "arms")
    other = moved(clip, 2.0, (3, 0, -1))
    assert np.allclose(
        measure_transition_costs(stats, other, find_stance_frames(stats, [(clip, 0.0, clip.duration)])),
        0,
        atol=1e-3,
    )


def test_another_skeleton_or_no_frames_cannot_be_entered(toy: Any) -> None:
    clip = toy.clip("x")
    stats = compute_statistics([clip], "arms")
    assert np.isinf(measure_transition_costs(stats, clip, find_stance_frames(stats, []))).all()
    odd = Clip("odd", chain(3), 30, np.tile([0, 0, 0, 1.0], (4, 3, 1)), np.zeros((4, 1, 3)))
    cost = measure_transition_costs(stats, odd, find_stance_frames(stats, [(clip, 0.0, 1.0)]))
    assert np.isinf(cost).all()
    found = propose_times(
        stats,
        clip,
        np.full(len(measure_transition_costs(stats, clip, find_stance_frames(stats, []))), np.inf),
    )
    assert found.reason.startswith("its stance has no resting clip yet") and "inf" not in found.reason
    assert (
        not found.good
        and 0 <= found.start <= found.end <= clip.duration
        and np.isfinite([found.blend_in, found.blend_out]).all()
    )


def test_where_a_clip_fits_by_hand() -> None:
    clip = slide(0.0, 6)
    f = fit_clip(clip, np.array([0.5, 2.0, 3.0, 0.9, 0.2, 4.0]))
    assert f.leave == ((0.0, 0.0), (3 / RATE, 4 / RATE)) and f.leave_at == pytest.approx(4 / RATE)
    # Entering compares with the frame before.
    assert f.enter == ((0.0, 1 / RATE), (4 / RATE, 5 / RATE)) and f.enter_at == pytest.approx(5 / RATE)
    assert (f.enter_cost, f.leave_cost) == (0.2, 0.2)


def test_a_gesture_begins_and_ends_with_its_movement(toy: Any) -> None:
    still, wave = toy.clip("still", 1.0, swing=0.0), toy.clip("wave", 1.0)
    joined = Clip("x", toy.skeleton, 30, np.concatenate([still.rotations, wave.rotations, still.rotations]),
                  np.concatenate([still.translations, wave.translations, still.translations]))  # fmt: skip
    stats = compute_statistics([joined], "arms")
    found = propose_times(
        stats, joined, measure_transition_costs(stats, joined, find_stance_frames(stats, [(still, 0.0, 1.0)]))
    )
    assert found.good and 0.6 < found.start < 1.2 and 1.9 < found.end < 2.5
    assert found.earliest_exit is None or 1.5 < found.earliest_exit < found.end
    assert BLEND[0] <= found.blend_in <= BLEND[1] and BLEND[0] <= found.blend_out <= BLEND[1]


def test_a_clip_that_ends_elsewhere_cannot_be_left(toy: Any) -> None:
    still, away = toy.clip("still", 1.0, swing=0.0), toy.clip("away", 0.6, 0.0, 1.5, 0.0)
    stats = compute_statistics([away, still], "arms")
    found = propose_times(
        stats, away, measure_transition_costs(stats, away, find_stance_frames(stats, [(still, 0.0, 1.0)]))
    )
    assert not found.good and "exit" in found.reason and "jump" in found.reason


def test_a_longer_way_is_blended_longer() -> None:
    assert blend(0.0) == BLEND[0] and blend(1e9) == BLEND[1]
    assert blend(3.0) == pytest.approx(np.pi / 2 * 3 * (STEP - 1) / RATE)


def test_a_loop_without_a_seam_needs_no_overlap(toy: Any) -> None:
    loop, open_ = toy.clip("loop", 2.0, swing=0.2), toy.clip("open", 2.0, 0.0, 0.25, 0.2)
    stats = compute_statistics([loop, open_], "arms")
    assert find_loop_times(stats, loop).blend_in == 0 and find_loop_times(stats, loop).good
    assert find_loop_times(stats, open_).blend_in >= BLEND[0]


@pytest.mark.parametrize("layer", LAYERS)
def test_the_samples_clips_fit_their_stances(sample: Project, layer: Any) -> None:
    m, graph = make_compatibility_matrix(sample, layer), sample.graphs[layer]
    assert m.can_enter.shape == (len(sample.clips), len(graph.stances)) and m.stances == tuple(graph.stances)
    strangers = []
    for action in graph.actions.values():
        row, column = m.clips.index(action.clip), m.stances.index(action.stance)
        assert m.can_enter[row, column], action.name
        assert m.can_leave[row, m.stances.index(action.end_stance or action.stance)], action.name
        if action.kind != "transition":
            strangers += [m.can_enter[row, k] for k in range(len(m.stances)) if k != column]
    assert np.mean(strangers) < 0.1  # a nod from one tilt may pass through another


@pytest.mark.parametrize("layer", LAYERS)
def test_the_samples_timings_are_good(sample: Project, layer: Any) -> None:
    graph, roles = sample.graphs[layer], anatomy.project_roles(sample)
    motions = [m for c in graph.uses if (m := sample.clips[c].motion) is not None]
    stats = compute_statistics(motions, layer, roles, REACH[layer])
    frames = {
        s: find_stance_frames(stats, loops, roles) for s, loops in list_stance_loops(sample, layer).items()
    }
    for action in graph.actions.values():
        clip = sample.clips[action.clip].motion
        assert clip is not None
        if action.kind == "stance":
            found = find_loop_times(stats, clip, roles)
        else:
            into = measure_transition_costs(stats, clip, frames[action.stance], roles)
            out = measure_transition_costs(stats, clip, frames[action.end_stance or action.stance], roles)
            found = propose_times(stats, clip, into, out, action.timing.stroke, roles)
            assert found.end - found.start > 0.4
        assert found.good and 0 <= found.start < found.end <= clip.duration + 1e-9, action.name
        assert found.start + found.blend_in <= found.end - found.blend_out + 1e-9
        if found.earliest_exit is not None:
            assert found.start < found.earliest_exit < found.end


def test_a_matrix_takes_other_stances_and_clips_and_can_be_cancelled(sample: Project) -> None:
    stance, loops = next(iter(list_stance_loops(sample, "head").items()))
    m = make_compatibility_matrix(
        sample, "head", {"mine": loops, "none": []}, clips=["no such clip", *list(sample.clips)[:3]]
    )
    assert m.stances == ("mine", "none") and m.enter_cost.shape == (4, 2)
    assert (
        np.isinf(m.enter_cost[:, 1]).all()
        and np.isinf(m.enter_cost[0]).all()
        and np.isfinite(m.enter_cost[1:, 0]).all()
    )
    assert np.isinf(make_compatibility_matrix(sample, "head", cancelled=lambda: True).enter_cost).all()
    assert stance in sample.graphs["head"].stances


def test_an_empty_project_has_an_empty_matrix() -> None:
    assert make_compatibility_matrix(Project(), "arms").enter_cost.shape == (0, 0)


def test_statistics_are_values(toy: Any) -> None:
    stats = compute_statistics([toy.clip("x")], "arms")
    assert isinstance(stats, Statistics) and stats.weights.dtype == np.float32
