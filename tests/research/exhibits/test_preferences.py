"""The user study of the conversation paper, recomputed from its counts."""

from __future__ import annotations

import pytest

from metagraph.research.exhibits.preferences import compare_two_samples, compute_binomial_p, list_preferences


def test_no_answers_and_more_than_all_are_refused() -> None:
    for chosen, n in ((0, 0), (-1, 5), (6, 5)):
        with pytest.raises(ValueError, match="one answer"):
            compute_binomial_p(chosen, n)
        with pytest.raises(ValueError, match="one answer"):
            compare_two_samples(chosen, 0, n)


def test_as_many_as_not_is_no_preference() -> None:
    assert compute_binomial_p(10, 20) == 1.0 and compare_two_samples(10, 10, 20) == (0.0, 1.0)
    assert compare_two_samples(0, 0, 20) == compare_two_samples(20, 20, 20) == (0.0, 1.0)


def test_the_exact_test_counts_what_is_as_far_off_on_either_side() -> None:
    assert compute_binomial_p(0, 5) == compute_binomial_p(5, 5) == 2 / 32
    assert compute_binomial_p(1, 5) == pytest.approx(2 * 6 / 32)


@pytest.mark.nightly
def test_both_agree_with_an_independent_library() -> None:
    stats = pytest.importorskip("scipy.stats")
    for chosen, n in ((64, 206), (108, 193), (116, 200), (94, 201), (3, 7)):
        assert compute_binomial_p(chosen, n) == pytest.approx(stats.binomtest(chosen, n).pvalue)
        cells = [[chosen, n - chosen], [n - chosen, chosen]]
        found = stats.chi2_contingency(cells, correction=True)
        assert compare_two_samples(chosen, n - chosen, n) == pytest.approx((found.statistic, found.pvalue))


def test_the_published_values_come_of_holding_a_share_against_its_complement() -> None:
    for row in list_preferences():
        assert row.chi == pytest.approx(row.rating.chi, rel=1e-4)
        assert row.p == pytest.approx(row.rating.p, rel=1e-3)


def test_without_responses_is_not_significant_by_the_exact_test_and_no_constraints_is() -> None:
    rows = {r.rating.second: r for r in list_preferences()}
    assert rows["without responses"].exact == pytest.approx(0.113, abs=5e-4)
    assert rows["no constraints"].exact == pytest.approx(0.028, abs=5e-4)
    assert rows["all constraints"].exact < 1e-7
    assert [n for n, r in rows.items() if not r.holds] == ["without responses"]


def test_over_four_tests_only_captured_motion_is_told_apart() -> None:
    assert [r.rating.second for r in list_preferences() if r.corrected < 0.05] == ["all constraints"]
    assert sum(r.rating.answers for r in list_preferences()) == 800
