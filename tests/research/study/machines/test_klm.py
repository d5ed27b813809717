"""Operators add up to the times that were published."""

from __future__ import annotations

from collections import Counter

import pytest

from metagraph.research.study.machines.klm import OperatorTimes, predict_seconds


def test_nothing_takes_no_time() -> None:
    assert predict_seconds({}) == 0.0


def test_a_command_by_keys_is_one_thought_and_two_keys() -> None:
    assert predict_seconds(Counter(["M", "K", "K"])) == pytest.approx(1.35 + 2 * 0.28)


def test_a_drag_is_a_reach_two_pointings_and_a_button_down_and_up() -> None:
    assert predict_seconds(Counter(["M", "H", "P", "B", "P", "B"])) == pytest.approx(
        1.35 + 0.4 + 2 * 1.1 + 2 * 0.1
    )


def test_waiting_counts_in_seconds() -> None:
    assert predict_seconds({"R": 2.5, "K": 1}) == pytest.approx(2.78)


def test_other_people_have_other_times() -> None:
    assert predict_seconds({"K": 10}, OperatorTimes(K=0.12)) == pytest.approx(1.2)


def test_an_operator_that_there_is_not_is_named() -> None:
    with pytest.raises(ValueError, match=r"'D'.*K, P, B, H"):
        predict_seconds({"D": 1})
