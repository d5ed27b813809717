"""How many people a forced choice needs."""

from __future__ import annotations

import numpy as np
import pytest

from metagraph.research.study.perceive import binomial
from metagraph.research.study.perceive.perceive_power import (
    Expected,
    compute_design_effect,
    count_raters_needed,
    draw_study,
    estimate_people,
    simulate_power,
)
from tests import thorough


def test_what_is_expected_is_the_share_of_all_together() -> None:
    expected = Expected(0.7, 1.0, 0.5)
    assert expected.log_odds > np.log(0.7 / 0.3)
    chosen, sides, who, what = draw_study(expected, 400, 50, 50, np.random.default_rng(1))
    assert np.mean(chosen) == pytest.approx(0.7, abs=0.03) and abs(np.mean(sides)) < 0.01
    assert len(set(who)) == 400 and set(np.bincount(what).tolist()) == {400}


@pytest.mark.nightly
def test_where_nobody_and_nothing_differs_simulated_power_is_the_exact_one() -> None:
    found = simulate_power(Expected(0.65, 0, 0), 10, 10, 10, studies=thorough.many(60, 120))
    assert found.low is not None and found.high is not None
    assert found.low - 0.03 < binomial.share_power(100, 0.65) < found.high + 0.03


@pytest.mark.nightly
def test_people_who_differ_need_more_answers() -> None:
    alike, unlike = Expected(0.6, 0, 0.3), Expected(0.6, 1.0, 0.3)
    assert compute_design_effect(alike, 10) == 1 < 3 < compute_design_effect(unlike, 10)
    few, many = estimate_people(alike, 20, 10, 0.8, 0.05), estimate_people(unlike, 20, 10, 0.8, 0.05)
    assert few is not None and many is not None and few < many
    assert (
        estimate_people(Expected(0.52, 0.5, 0.5), 4, 4, 0.8, 0.05) is None
    )  # no crowd makes up for four items


@pytest.mark.nightly
def test_the_fewest_people_show_it_as_often_as_is_wanted() -> None:
    people, found = count_raters_needed(Expected(0.75, 0.3, 0.2), 8, 8, studies=thorough.many(30, 60))
    assert people is not None and found is not None and 4 <= people <= 20 and found.value >= 0.8


@pytest.mark.parametrize(
    "wrong",
    [{"share": 0.0}, {"share": 1.0}, {"share": 0.6, "people": -1.0}, {"share": 0.6, "items": float("nan")}],
)
def test_what_cannot_be_expected_is_refused(wrong: dict[str, float]) -> None:
    with pytest.raises(ValueError, match=r"lies between|deviation"):
        Expected(**wrong)


def test_impossible_studies_are_refused() -> None:
    for people, items, each in ((1, 5, 5), (5, 0, 1), (5, 5, 11), (5, 5, 0), (401, 5, 5)):
        with pytest.raises(ValueError, match="a simulated study has"):
            simulate_power(Expected(0.6), people, items, each)
