"""Long takes are cut where they rest in one stance, so that clips leave it and come back."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from metagraph.generation.poses import find_rig
from metagraph.graph.conversation.model import Segment
from metagraph.motion import rotation
from metagraph.synthesis.cut import (
    explain_uncut,
    find_candidates,
    find_rest_moments,
    measure_pace,
    smooth_speed,
)
from metagraph.synthesis.graph import find_threshold
from metagraph.synthesis.states import SynthesisError, compute_cost_terms, read_states
from tests.synthesis.talking import talking

SAID = [Segment("clause", s, s + 1.0, s + 0.4) for s in (2.0, 6.0, 10.0, 14.5)]
TAKE = talking("long", SAID, 20)


def test_each_stroke_becomes_a_clip_that_begins_and_ends_at_rest() -> None:
    found = find_candidates(TAKE, 0.2)
    for s in SAID:
        mine = [c for c in found if c[0] <= s.start + 0.1 and c[1] >= s.end]
        assert len(mine) == 1, s
    assert all(1.0 <= b - a <= 8.0 and 0 <= score <= 1 for a, b, score in found)
    assert all(b <= after for (_, b, _), (after, _, _) in pairwise(found))


def test_from_every_end_there_is_a_transition_to_every_beginning() -> None:
    states = read_states([TAKE])
    for limit in (0.1, 0.2):
        found = find_candidates(TAKE, limit)
        terms = compute_cost_terms(states, np.array([round(t * 30) for c in found for t in c[:2]]))
        away = np.linalg.norm(terms[:, None] - terms[None], axis=-1).sum(-1)
        assert away.max() <= limit + 1e-4


def test_what_rests_all_the_time_has_nothing_to_cut() -> None:
    assert find_candidates(talking("still", [], 10), 0.5) == ()


def test_lengths_are_kept_and_odd_ones_refused() -> None:
    assert all(4.0 <= b - a <= 6.0 for a, b, _ in find_candidates(TAKE, 0.2, 4.0, 6.0))
    assert find_candidates(TAKE, 0.2, 19.9, 30.0) == ()
    for least, most in ((0.0, 1.0), (3.0, 2.0)):
        with pytest.raises(SynthesisError, match="cannot be"):
            find_candidates(TAKE, 0.2, least, most)


def test_without_a_limit_that_of_the_take_is_taken() -> None:
    states = read_states([TAKE])
    assert (
        find_candidates(TAKE)
        == find_candidates(TAKE, find_threshold(states).limit)
        == find_candidates(TAKE, states=states)
    )


def test_moments_of_rest_are_slow_and_apart() -> None:
    states = read_states([TAKE])
    found = find_rest_moments(states)
    speed = np.linalg.norm(states.velocities, axis=-1).max(-1)
    assert (np.diff(found) >= 8).all() and speed[found].max() < 0.3 * speed.max()


def trembling(by: float):
    """The take, each joint of the upper body shaken by so many radians in each frame."""
    chance, shaken = np.random.default_rng(1), np.array(TAKE.rotations, float)
    for joint in find_rig(TAKE.skeleton).joints:
        turns = chance.normal(0, by, (TAKE.frames, 3))
        shaken[:, joint] = rotation.multiply(shaken[:, joint], rotation.exp(turns))
    return replace(TAKE, rotations=shaken.astype(np.float32))


def test_where_resting_trembles_a_little_each_stroke_becomes_a_clip_all_the_same() -> None:
    found = find_candidates(trembling(0.003))
    for s in SAID:
        assert any(a <= s.start + 0.1 and b >= s.end for a, b, _ in found), s


def test_what_happens_in_a_clip_is_more_than_resting() -> None:
    take = trembling(0.003)
    speeds = smooth_speed(read_states([take]))
    moves = measure_pace(speeds).moves
    assert 0.2 < moves < speeds.max()
    for a, b, _ in find_candidates(take):
        assert speeds[round(a * 30) : round(b * 30) + 1].max() >= moves


def test_speeds_of_one_kind_have_no_rest_of_their_own() -> None:
    chance = np.random.default_rng(2)
    one = np.exp(chance.normal(0, 0.4, 2000))
    two = np.concatenate([0.05 * one, one])
    assert measure_pace(one).moves == 0 and measure_pace(one).rests < 0.4
    assert 0.03 < measure_pace(two).rests < 0.1 and 0.7 < measure_pace(two).moves < 1.4
    assert measure_pace(np.full(100, 0.3)).moves == 0


def test_why_nothing_can_be_cut_is_told_in_words() -> None:
    assert "never rests" in explain_uncut(trembling(0.2))
    assert "never moves" in explain_uncut(talking("still", [], 10), 0.5)
    assert "within 19.9 to 30 s" in explain_uncut(TAKE, 0.2, 19.9, 30.0)
