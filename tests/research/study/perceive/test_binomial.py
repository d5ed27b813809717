"""Exact binomials against SciPy, published answers and the edges: none, all, one."""

from __future__ import annotations

import pytest

from metagraph.research.study.perceive import binomial


@pytest.mark.parametrize(
    ("k", "n"), [(0, 1), (1, 1), (0, 5), (5, 5), (3, 10), (108, 193), (94, 201), (500, 1000)]
)
@pytest.mark.parametrize("share", [0.5, 0.2])
def test_p_values_and_intervals_are_those_of_scipy(k: int, n: int, share: float) -> None:
    from scipy.stats import binomtest

    theirs = binomtest(k, n, share)
    assert binomial.compute_two_sided_p(k, n, share) == pytest.approx(theirs.pvalue, abs=1e-10)
    interval, ours = theirs.proportion_ci(), binomial.estimate_exact_share(k, n)
    assert (ours.low, ours.high) == pytest.approx((interval.low, interval.high), abs=1e-9)
    assert ours.holds(k / n) and ours.n == n


@pytest.mark.parametrize(
    ("k", "n", "p"),
    # Four comparisons of Yang et al., section 8.2, whose own tests take complementary shares for two samples.
    [(64, 206, 5.7e-8), (108, 193, 0.113), (94, 201, 0.397), (116, 200, 0.028)],
)
def test_the_published_comparisons_have_these_exact_p_values(k: int, n: int, p: float) -> None:
    assert binomial.compute_two_sided_p(k, n) == pytest.approx(p, rel=0.02)


def test_nothing_has_no_p_and_no_share_and_impossible_counts_are_refused() -> None:
    assert binomial.compute_two_sided_p(0, 0) is None and binomial.compute_fisher_p(0, 0, 1, 2) is None
    with pytest.raises(ValueError, match="nothing"):
        binomial.estimate_exact_share(0, 0)
    for k, n in ((-1, 3), (4, 3)):
        with pytest.raises(ValueError, match="no count"):
            binomial.compute_two_sided_p(k, n)


@pytest.mark.parametrize("table", [(8, 10, 3, 12), (0, 5, 5, 5), (1, 1, 0, 1), (20, 40, 21, 40)])
def test_two_shares_are_compared_as_scipy_does(table: tuple[int, int, int, int]) -> None:
    from scipy.stats import fisher_exact

    a, n, b, m = table
    assert binomial.compute_fisher_p(*table) == pytest.approx(
        fisher_exact([[a, n - a], [b, m - b]])[1], abs=1e-12
    )


@pytest.mark.parametrize(
    ("n", "share", "alpha"), [(1, 0.9, 0.05), (6, 0.99, 0.05), (54, 0.7, 0.05), (80, 0.4, 0.01)]
)
def test_power_is_the_sum_over_all_counts_that_are_shown(n: int, share: float, alpha: float) -> None:
    from scipy.stats import binom, binomtest

    found = sum(binom.pmf(k, n, share) for k in range(n + 1) if binomtest(k, n).pvalue <= alpha)
    assert binomial.share_power(n, share, alpha) == pytest.approx(found, abs=1e-9)


@pytest.mark.parametrize(("share", "chance"), [(0.9, 0.8), (0.7, 0.8), (0.3, 0.8), (0.65, 0.9)])
def test_from_the_number_needed_on_the_power_holds_and_below_it_does_not(share: float, chance: float) -> None:
    n = binomial.count_needed_answers(share, chance)
    assert n is not None and binomial.share_power(n - 1, share) < chance
    assert all(binomial.share_power(m, share) >= chance for m in range(n, n + 60))


def test_a_half_is_never_shown_to_be_another_share_but_can_be_shown_to_be_near_one() -> None:
    assert binomial.count_needed_answers(0.5) is None and binomial.count_needed_answers(0.5005) is None
    n = binomial.count_answers_for_equivalence(0.15)
    assert n is not None and binomial.share_equivalence_power(
        n, 0.15
    ) >= 0.8 > binomial.share_equivalence_power(n - 1, 0.15)
    assert binomial.share_equivalence_power(5, 0.1) == 0
    for wrong in (0.0, 0.5, -1.0):
        with pytest.raises(ValueError, match="margin"):
            binomial.count_answers_for_equivalence(wrong)
    with pytest.raises(ValueError, match="between 0 and 1"):
        binomial.count_needed_answers(0.7, 1.0)


def test_log_odds_of_any_size_have_a_share() -> None:
    assert binomial.logistic(0) == 0.5 and binomial.logistic(800) == 1 and binomial.logistic(-800) == 0
