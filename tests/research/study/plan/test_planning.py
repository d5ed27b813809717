"""Sample sizes beside textbooks and tables: power, precision, equivalence."""

from __future__ import annotations

from math import exp, log, sqrt

import numpy as np
import pytest

from metagraph.research.study.plan.planning import (
    assume_without_pilot,
    compute_half_width,
    compute_precision_chance,
    compute_ratio_equivalence_power,
    from_pilot,
    judge_equivalence,
    sample_size,
)
from metagraph.research.study.statistics.small_samples import count_pairs_needed


def test_what_cannot_be_is_refused() -> None:
    for ratio, spread in ((0.0, 0.3), (2.0, 0.0), (float("nan"), 0.3)):
        with pytest.raises(ValueError, match="greater than 0"):
            assume_without_pilot(ratio, spread)
    with pytest.raises(ValueError, match="smallest"):
        sample_size(assume_without_pilot(2.0, 0.5), 1.0)
    with pytest.raises(ValueError, match="3 people at least"):
        from_pilot([2.0, 3.0])
    with pytest.raises(ValueError, match="do not differ"):
        from_pilot([2.0, 2.0, 2.0])
    assert sample_size(assume_without_pilot(1.0, 0.5), 1.25).show is None, (
        "nothing shows an effect that is none"
    )


def test_paired_tests_need_what_cohen_tables_say() -> None:
    """Cohen (1988) and G*Power 3.1, two-sided, alpha 0.05, power 0.8: d_z 0.2, 0.5, 0.8."""
    assert [count_pairs_needed(d) for d in (0.2, 0.5, 0.8)] == [199, 34, 15]
    found = sample_size(assume_without_pilot(exp(0.5 * 0.4), 0.4), exp(0.8 * 0.4))
    assert (found.show, found.smallest) == (34, 15)


@pytest.mark.parametrize(
    ("cv", "ratio", "n", "power"),
    [(0.2, 0.95, 20, 0.834680), (0.3, 0.95, 40, 0.815845), (0.25, 0.95, 28, 0.807439)],
)
def test_equivalence_has_the_power_of_the_published_tables(
    cv: float, ratio: float, n: int, power: float
) -> None:
    """Cross-over of two periods, 0.80 to 1.25, alpha 0.05: Diletti, Hauschke and Steinijans (1991), table; the
    power as PowerTOST computes it.
    """
    spread = sqrt(2) * sqrt(log(cv * cv + 1))
    found = compute_ratio_equivalence_power(n, log(ratio), spread, log(0.8), log(1.25), 0.05, n - 2)
    assert found == pytest.approx(power, abs=2e-5)
    assert compute_ratio_equivalence_power(n - 2, log(ratio), spread, log(0.8), log(1.25), 0.05, n - 4) < 0.8


def test_equivalence_happens_as_often_as_its_power_says() -> None:
    rng = np.random.default_rng(1)
    n, spread, bound = 12, 0.25, log(1.25)
    shown = sum(
        found is not None and found.verdict == "equivalent"
        for _ in range(3000)
        if (found := judge_equivalence(rng.normal(0.02, spread, n).tolist(), exp(bound))) is not None
    )
    assert shown / 3000 == pytest.approx(
        compute_ratio_equivalence_power(n, 0.02, spread, -bound, bound), abs=0.03
    )


def test_intervals_are_as_narrow_as_planned_as_often_as_planned() -> None:
    from scipy import stats as scipy

    n = sample_size(assume_without_pilot(2.0, 0.4), 1.25, within=1.25).precise
    assert n is not None and compute_half_width(n, 0.4) < log(1.25)
    rng = np.random.default_rng(2)
    drawn = rng.normal(0, 0.4, (4000, n)).std(axis=1, ddof=1)
    narrow = scipy.t.ppf(0.975, n - 1) * drawn / sqrt(n) <= log(1.25)
    assert narrow.mean() == pytest.approx(compute_precision_chance(n, 0.4, log(1.25)), abs=0.03)
    assert (
        compute_precision_chance(n, 0.4, log(1.25)) >= 0.8 > compute_precision_chance(n - 1, 0.4, log(1.25))
    )


def test_a_pilot_is_reckoned_with_as_less_sure_than_it_looks() -> None:
    from scipy import stats as scipy

    found = from_pilot([2.0, 2.5, 1.8, 3.0, 2.2])
    logs = np.log([2.0, 2.5, 1.8, 3.0, 2.2])
    assert found.ratio == pytest.approx(np.exp(logs.mean())) and found.spread == pytest.approx(
        logs.std(ddof=1)
    )
    assert found.worst == pytest.approx(found.spread * sqrt(4 / scipy.chi2.ppf(0.2, 4)))
    assert "5" in found.source


def test_verdicts_say_what_the_interval_allows() -> None:
    for mean, verdict in ((0.0, "equivalent"), (0.8, "larger"), (-0.8, "smaller"), (0.2, "not told")):
        found = judge_equivalence([mean + d for d in (-0.05, 0.0, 0.05, 0.02, -0.02)], 1.25)
        assert found is not None and found.verdict == verdict, mean
    assert judge_equivalence([1.0], 1.25) is None
    flat = judge_equivalence([0.1, 0.1, 0.1], 1.25)
    assert flat is not None and flat.verdict == "equivalent" and flat.test.p == 0


def test_the_two_one_sided_tests_are_those_of_scipy() -> None:
    from scipy import stats as scipy

    x = [0.05, 0.12, -0.03, 0.2, 0.01, 0.08]
    found = judge_equivalence(x, 1.25)
    theirs = max(
        scipy.ttest_1samp(x, -log(1.25), alternative="greater").pvalue,
        scipy.ttest_1samp(x, log(1.25), alternative="less").pvalue,
    )
    assert found is not None and found.test.p == pytest.approx(theirs)
