"""Orders are balanced, and stay the same."""

from __future__ import annotations

from collections import Counter
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.research.study.plan.order import make_williams_design, order_conditions, shuffle_by_seed


def test_no_treatment_has_no_order() -> None:
    with pytest.raises(ValueError, match="at least one"):
        make_williams_design(0)


def test_one_treatment_comes_first() -> None:
    assert make_williams_design(1) == ((0,),)


def test_two_treatments_come_in_both_orders() -> None:
    assert make_williams_design(2) == ((0, 1), (1, 0))


@pytest.mark.parametrize("count", range(2, 10))
def test_each_treatment_is_as_often_in_each_place_and_after_each_other(count: int) -> None:
    rows = make_williams_design(count)
    assert len(rows) == (count if count % 2 == 0 else 2 * count)
    assert all(sorted(row) == list(range(count)) for row in rows)
    places = Counter((place, x) for row in rows for place, x in enumerate(row))
    assert set(places.values()) == {len(rows) // count}
    follows = Counter(pair for row in rows for pair in pairwise(row))
    assert set(follows.values()) == {1 if count % 2 == 0 else 2}
    assert len(follows) == count * (count - 1)


@given(st.integers(0, 0xFFFFFFFF), st.integers(1, 12))
def test_an_even_number_of_participants_has_conditions_and_two_tasks_balanced(seed: int, pairs: int) -> None:
    orders = [order_conditions(["meta", "manual"], ["ten", "twenty"], n, seed) for n in range(2 * pairs)]
    firsts = Counter(order[0][0] for order in orders)
    assert firsts == {"meta": pairs, "manual": pairs}
    for condition in ("meta", "manual"):
        tasks = Counter(tasks[0] for order in orders for c, tasks in order if c == condition)
        assert tasks == {"ten": pairs, "twenty": pairs}


def test_four_participants_see_every_order_of_two_conditions_and_two_tasks() -> None:
    assert len({order_conditions(["meta", "manual"], ["ten", "twenty"], n, 7) for n in range(4)}) == 4


def test_orders_are_the_same_for_ever() -> None:
    assert shuffle_by_seed("abcdef", 0) == list("dcbafe")
    assert shuffle_by_seed("abcdef", 1) == list("cfeabd")
    assert order_conditions(["meta", "manual"], ["a", "b", "c"], 5, 11) == (
        ("meta", ("b", "a", "c")),
        ("manual", ("b", "c", "a")),
    )


def test_a_seed_moves_all_but_loses_none() -> None:
    assert len({tuple(shuffle_by_seed(range(5), seed)) for seed in range(400)}) > 100
    assert all(sorted(shuffle_by_seed(range(5), seed)) == list(range(5)) for seed in range(50))
