"""Estimates that one odd value does not carry away, beside textbooks and SciPy."""

from __future__ import annotations

from math import inf

import numpy as np
import pytest

from metagraph.research.study.statistics.robust import (
    compute_hodges_lehmann,
    estimate_censored_mean,
    find_odd_ones,
    leave_one_out,
)
from metagraph.research.study.statistics.small_samples import mean
from tests.thorough import many

# Hollander and Wolfe, "Nonparametric Statistical Methods", table 3.1: depression before and after.
BEFORE = (1.83, 0.50, 1.62, 2.48, 1.68, 1.88, 1.55, 3.06, 1.30)
AFTER = (0.878, 0.647, 0.598, 2.05, 1.06, 1.29, 1.06, 3.14, 1.29)


def test_nothing_has_no_middle_and_one_value_no_interval() -> None:
    with pytest.raises(ValueError, match="no values"):
        compute_hodges_lehmann([])
    assert compute_hodges_lehmann([3.0]).low is None
    assert compute_hodges_lehmann([1.0, 2.0, 3.0, 4.0, 5.0]).low is None, "five pairs cannot reach 95 %"
    six = compute_hodges_lehmann([1.0, 2.0, 3.0, 4.0, 5.0, 6.0])
    assert (six.low, six.value, six.high) == (1.0, 3.5, 6.0), "the whole range"


def test_the_middle_of_all_means_is_that_of_the_textbook() -> None:
    found = compute_hodges_lehmann([b - a for a, b in zip(BEFORE, AFTER, strict=True)])
    assert (found.value, found.low, found.high) == (
        pytest.approx(-0.46),
        pytest.approx(-0.786),
        pytest.approx(-0.010),
    )


def test_many_values_use_the_normal_distribution_of_ranks() -> None:
    rng = np.random.default_rng(2)
    few = compute_hodges_lehmann((x := rng.normal(0, 1, 25)).tolist())
    more = compute_hodges_lehmann([*x.tolist(), float(np.median(x))])
    assert few.low is not None and more.low is not None and abs(few.low - more.low) < 0.05


def test_one_odd_value_moves_the_mean_and_not_the_middle() -> None:
    values = [0.8 + 0.02 * k for k in range(15)] + [4.0]
    assert find_odd_ones(values) == [15]
    assert compute_hodges_lehmann(values).value == pytest.approx(0.95, abs=0.02)
    assert mean(values).value > 1.1
    without = leave_one_out(values)
    assert min(w.value for w in without) == without[15].value == pytest.approx(0.94)
    assert find_odd_ones([1.0] * 9 + [2.0]) == [] and find_odd_ones([1, 2, 3, 99]) == []
    assert leave_one_out([1.0, 2.0]) == []


def test_without_censored_values_the_interval_is_students() -> None:
    values = [1.0, 2.0, 4.0, 4.5]
    assert estimate_censored_mean(values) == mean(values)
    near = estimate_censored_mean(values, above=[-30.0])  # a bound that says nothing
    assert near is not None and near.value == pytest.approx(mean(values).value, abs=1e-4)


def test_censored_values_agree_with_scipy() -> None:
    from scipy import stats as scipy

    drawn = np.random.default_rng(3).normal(1, 0.5, 30)
    exact, above = [v for v in drawn if -0.1 < v < 1.3], [1.3] * int((drawn >= 1.3).sum())
    below = [-0.1] * int((drawn <= -0.1).sum())
    found = estimate_censored_mean(exact, above, below)
    told = scipy.norm.fit(scipy.CensoredData(uncensored=exact, right=above, left=below))
    assert found is not None and found.value == pytest.approx(told[0], abs=2e-3)
    assert found.low is not None and found.high is not None and found.low < 1 < found.high


@pytest.mark.nightly
def test_intervals_of_censored_values_hold_the_truth_as_often_as_they_promise() -> None:
    rng, held = np.random.default_rng(5), 0
    studies = many(100, 200)
    for _ in range(studies):
        drawn = rng.normal(0.8, 0.3, 14)
        found = estimate_censored_mean([v for v in drawn if v < 1.0], [1.0] * int((drawn >= 1.0).sum()))
        held += found is not None and found.holds(0.8)
    # Of 100 or 200 with 95 % each, fewer or more are less likely than 1 in 100.
    assert many(88, 180) <= held <= many(99, 198), held


def test_what_cannot_be_told_is_none_and_what_is_not_bounded_infinite() -> None:
    assert estimate_censored_mean([], [1.0, 2.0]) is None
    assert estimate_censored_mean([1.0, 1.0], [2.0]) is None
    loose = estimate_censored_mean([0.9, 1.1], [1.2] * 30)
    assert loose is not None and (loose.high is None or loose.high > 3 or loose.high == inf)
