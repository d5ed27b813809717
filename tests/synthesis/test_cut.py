"""Long takes are cut where they rest in one stance, so that clips leave it and come back."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from metagraph.graph.conversation import Segment
from metagraph.synthesis.cut import candidates, moments
from metagraph.synthesis.graph import threshold
from metagraph.synthesis.states import SynthesisError, states_of, terms_of
from tests.synthesis.talking import talking

SAID = [Segment("clause", s, s + 1.0, s + 0.4) for s in (2.0, 6.0, 10.0, 14.5)]
TAKE = talking("long", SAID, 20)


def test_each_stroke_becomes_a_clip_that_begins_and_ends_at_rest() -> None:
    found = candidates(TAKE, 0.2)
    for s in SAID:
        mine = [c for c in found if c[0] <= s.start + 0.1 and c[1] >= s.end]
        assert len(mine) == 1, s
    assert all(1.0 <= b - a <= 8.0 and 0 <= score <= 1 for a, b, score in found)
    assert all(b <= after for (_, b, _), (after, _, _) in pairwise(found))


def test_from_every_end_there_is_a_transition_to_every_beginning() -> None:
    states = states_of([TAKE])
    for limit in (0.1, 0.2):
        found = candidates(TAKE, limit)
        terms = terms_of(states, np.array([round(t * 30) for c in found for t in c[:2]]))
        away = np.linalg.norm(terms[:, None] - terms[None], axis=-1).sum(-1)
        assert away.max() <= limit + 1e-4


def test_what_rests_all_the_time_has_nothing_to_cut() -> None:
    assert candidates(talking("still", [], 10), 0.5) == ()


def test_lengths_are_kept_and_odd_ones_refused() -> None:
    assert all(4.0 <= b - a <= 6.0 for a, b, _ in candidates(TAKE, 0.2, 4.0, 6.0))
    assert candidates(TAKE, 0.2, 19.9, 30.0) == ()
    for least, most in ((0.0, 1.0), (3.0, 2.0)):
        with pytest.raises(SynthesisError, match="cannot be"):
            candidates(TAKE, 0.2, least, most)


def test_without_a_limit_that_of_the_take_is_taken() -> None:
    states = states_of([TAKE])
    assert candidates(TAKE) == candidates(TAKE, threshold(states).limit) == candidates(TAKE, states=states)


def test_moments_of_rest_are_slow_and_apart() -> None:
    states = states_of([TAKE])
    found = moments(states)
    speed = np.linalg.norm(states.velocities, axis=-1).max(-1)
    assert (np.diff(found) >= 8).all() and speed[found].max() < 0.3 * speed.max()
