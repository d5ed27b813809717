"""Keyed randomness: the same everywhere, even, and steady when other candidates come and go."""

from __future__ import annotations

import math
from collections import Counter

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.playback.planning.choice import chance_of, key32, keyed, pick, picked, uniform
from metagraph.playback.planning.hashing import mix

CASES = [(0,), (1,), (0, ""), (1, "a", "b"), (1, "ab"), (4294967295, "ä", "x"), (7, "auto/arms/0", "state")]
KEYS = [2872998923, 3987542849, 91794203, 1418986408, 2281871870, 3040681498, 2718527135]
MIXED = [0, 0x514E28B7, 0x81F16F39]  # MurmurHash3's published finaliser

weights = st.dictionaries(
    st.text("abc123", min_size=1, max_size=4), st.floats(0.01, 50), min_size=1, max_size=8
)


def fnv(seed: int, *words: str) -> int:
    """The rule as its documentation states it, written again."""
    h = 0x811C9DC5 ^ mix(seed)
    for word in words:
        for byte in [*word.encode(), 0]:
            h = ((h ^ byte) * 0x01000193) % 2**32
    return mix(h)


def test_known_vectors() -> None:
    assert [mix(x) for x in (0, 1, 0xFFFFFFFF)] == MIXED
    assert [key32(*case) for case in CASES] == KEYS
    assert uniform(1, "a") == (key32(1, "a") + 0.5) / 2**32


@given(st.integers(0, 2**32 - 1), st.lists(st.text(max_size=6), max_size=4))
def test_the_hash_is_fnv_over_words_closed_by_zero_bytes(seed: int, words: list[str]) -> None:
    assert key32(seed, *words) == fnv(seed, *words)
    assert 0 < uniform(seed, *words) < 1


def test_words_are_kept_apart() -> None:
    assert (
        len({key32(1, "ab"), key32(1, "a", "b"), key32(1, "", "ab"), key32(1, "ab", ""), key32(2, "ab")}) == 5
    )


def test_draws_are_even_over_seeds_and_keys() -> None:
    for draws in (
        [uniform(s, "r1", "action") for s in range(20000)],
        [uniform(1, f"r{n}", "action") for n in range(20000)],
    ):
        counts = np.histogram(draws, 50, (0, 1))[0]
        assert ((counts - 400) ** 2 / 400).sum() < 100  # chi-square of 49 degrees: beyond 100 once in 30,000


def test_nothing_to_choose_from_is_refused() -> None:
    for nothing in ({}, {"a": 0.0}, {"a": -1.0}, {"a": float("nan")}):
        with pytest.raises(ValueError, match="nothing to choose from"):
            pick(1, "k", "action", nothing)


@pytest.mark.parametrize(
    "weighted", [{"a1": 1.0, "a2": 1.0, "a3": 1.0}, {"a1": 0.1, "a2": 3.0, "a3": 1.0, "a4": 0.0}, {"a": 1.0}]
)
def test_each_is_picked_as_often_as_its_weight_says(weighted: dict[str, float]) -> None:
    counts = Counter(pick(7, f"r{n}", "action", weighted) for n in range(12000))
    total = sum(weighted.values())
    chi = sum(
        (counts[k] - 12000 * w / total) ** 2 / (12000 * w / total) for k, w in weighted.items() if w > 0
    )
    assert chi < 22  # at most 2 degrees of freedom: beyond 22 once in 60,000
    assert not any(counts[k] for k, w in weighted.items() if w == 0)


@given(st.integers(0, 2**32 - 1), weights, st.data())
def test_taking_away_one_that_lost_changes_nothing(
    seed: int, weighted: dict[str, float], data: st.DataObject
) -> None:
    chosen = pick(seed, "k", "action", weighted)
    others = [k for k in weighted if k != chosen]
    if others:
        gone = data.draw(st.sampled_from(others))
        assert pick(seed, "k", "action", {k: w for k, w in weighted.items() if k != gone}) == chosen


@given(st.integers(0, 2**32 - 1), weights, st.randoms())
def test_the_order_of_candidates_and_the_scale_of_weights_do_not_matter(
    seed: int, weighted: dict[str, float], random: object
) -> None:
    chosen = pick(seed, "k", "action", weighted)
    assert pick(seed, "k", "action", dict(reversed(weighted.items()))) == chosen
    assert pick(seed, "k", "action", {k: w * 4 for k, w in weighted.items()}) == chosen


def test_more_weight_never_loses_a_race_it_had_won() -> None:
    for seed in range(200):
        if pick(seed, "k", "action", {"a": 1.0, "b": 1.0}) == "a":
            assert pick(seed, "k", "action", {"a": 2.0, "b": 1.0}) == "a"


def test_the_race_is_the_shortest_exponential_time() -> None:
    weighted = {"a1": 1.0, "a2": 2.5}
    times = {k: -math.log(uniform(3, "r1", "action", k)) / w for k, w in weighted.items()}
    assert pick(3, "r1", "action", weighted) == min(times, key=times.__getitem__)


@given(st.integers(0, 2**32 - 1), st.lists(st.text(max_size=6), max_size=3), st.text(max_size=6))
def test_a_key_that_is_kept_gives_what_its_words_give(seed: int, words: list[str], purpose: str) -> None:
    assert chance_of(keyed(seed, *words), purpose) == uniform(seed, *words, purpose)
    weights = {"a": 1.0, "b": 2.0, "c": 0.5}
    assert picked(keyed(seed, "key"), purpose, weights) == pick(seed, "key", purpose, weights)
