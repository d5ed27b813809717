"""Beliefs together: agreement makes surer, conflict unsure and told, silence changes nothing."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.suggest.estimate import Belief
from metagraph.suggest.vote_fusion import LEAST, MOST, combine


def says(value: str, confidence: float, reason: str = "") -> Belief[str]:
    return Belief(value, confidence, reason or f"says {value}")


def test_nobody_says_nothing() -> None:
    assert combine([], 4) is None


def test_one_source_is_believed_as_far_as_it_believes_itself() -> None:
    found = combine([says("gesture", 0.8)], 4)
    assert found is not None and found.belief.value == "gesture" and not found.conflict
    assert found.belief.confidence == pytest.approx(0.8)


def test_two_that_agree_are_surer_than_each() -> None:
    found = combine([says("gesture", 0.8, "name says 'shrug'"), says("gesture", 0.7, "hands go far")], 4)
    assert found is not None and found.belief.confidence > 0.9
    assert found.belief.reason == "name says 'shrug'; hands go far"


def test_by_hand() -> None:
    # 0.8 * 0.4/3 for one, 0.2/3 * 0.6 for the other, 0.2/3 * 0.4/3 for each of two unnamed.
    found = combine([says("a", 0.8), says("b", 0.6)], 4)
    one, other, unnamed = 0.8 * 0.4 / 3, 0.2 / 3 * 0.6, 0.2 / 3 * 0.4 / 3
    assert found is not None and found.belief.value == "a"
    assert found.belief.confidence == pytest.approx(one / (one + other + 2 * unnamed))


def test_firm_ones_that_disagree_are_a_conflict() -> None:
    found = combine(
        [says("transition", 0.9, "name says 'ToCrossed'"), says("gesture", 0.85, "ends where it begins")], 4
    )
    assert found is not None and found.conflict == "name says 'ToCrossed', but ends where it begins"
    assert found.belief.confidence < 0.75
    meek = combine([says("transition", 0.9), says("gesture", 0.4)], 4)
    assert meek is not None and not meek.conflict


@given(
    st.lists(st.builds(says, st.sampled_from("abcd"), st.floats(0, 1)), min_size=1, max_size=5),
    st.integers(1, 6),
)
def test_any_votes_give_one_of_their_values_and_never_certainty(votes: list[Belief[str]], count: int) -> None:
    found = combine(votes, count)
    assert found is not None
    assert found.belief.value in {v.value for v in votes}
    assert LEAST <= found.belief.confidence <= MOST


@given(st.floats(0.3, 0.99), st.integers(2, 6))
def test_a_second_voice_for_the_same_never_makes_less_sure(confidence: float, count: int) -> None:
    one = combine([says("a", max(confidence, 1 / count))], count)
    two = combine([says("a", max(confidence, 1 / count))] * 2, count)
    assert one is not None and two is not None
    assert two.belief.confidence >= one.belief.confidence - 1e-9
