"""Statistics of small samples, against values that SciPy and statsmodels gave."""

from __future__ import annotations

from math import exp, inf, log, sqrt

import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.research.study.statistics import small_samples as s
from metagraph.research.study.statistics.distributions import (
    compute_t_cdf,
    compute_t_noncentral,
    compute_t_quantile,
    compute_t_two_sided,
)

# Reference values: SciPy 1.17.1, statsmodels 0.15.0 (power, Holm, least squares).
A = [412.0, 388.5, 951.25, 604.0, 277.75, 720.5, 333.0, 515.5]
B = [51.5, 60.25, 98.0, 88.5, 45.0, 71.75, 66.0, 52.25]
CLOSE = 1e-9


def close(value: float) -> object:
    return pytest.approx(value, rel=CLOSE, abs=CLOSE)


def triple(found: s.Estimate | None) -> tuple[float | None, float | None, float | None]:
    assert found is not None
    return found.value, found.low, found.high


# --- edge cases


def test_nobody_has_no_mean() -> None:
    with pytest.raises(ValueError, match="no values"):
        s.mean([])


def test_one_person_has_a_mean_but_no_interval_and_no_test() -> None:
    assert triple(s.compute_geometric_mean([20.0])) == (pytest.approx(20.0), None, None)
    assert s.compute_paired_t([2.0], [1.0]).p is None
    assert s.compute_effect_size([2.0], [1.0]) is None
    assert not s.compute_geometric_mean([1.0]).holds(1.0)


def test_no_time_has_no_logarithm() -> None:
    for bad in (0.0, -1.0, inf, float("nan")):
        with pytest.raises(ValueError, match="has no logarithm"):
            s.compute_geometric_mean([1.0, bad])


def test_pairs_need_as_many_of_both() -> None:
    with pytest.raises(ValueError, match="not 2 and 1"):
        s.estimate_ratio([1.0, 2.0], [1.0])


def test_people_who_are_all_alike_have_an_interval_without_width() -> None:
    assert triple(s.estimate_ratio([8.0, 8.0, 8.0], [1.0, 1.0, 1.0])) == (pytest.approx(8.0),) * 3
    assert s.compute_paired_t([3.0, 3.0], [1.0, 1.0]).p == 0.0
    assert s.compute_paired_t([3.0, 3.0], [3.0, 3.0]).p == 1.0
    found, test = s.compute_welch([1.0, 1.0], [3.0, 3.0])
    assert (triple(found), test.p, test.statistic) == ((-2.0, -2.0, -2.0), 0.0, -inf)
    assert s.compute_effect_size([3.0, 3.0, 3.0], [1.0, 1.0, 1.0]) is None


def test_a_group_of_one_has_no_interval() -> None:
    found, test = s.compute_welch([1.0], [2.0, 3.0])
    assert (triple(found), test.p) == ((-1.5, None, None), None)


# --- by hand


def test_a_ratio_by_hand() -> None:
    # Ratios 2, 4, 4, 8: 1, 2, 2, 3 doublings, mean 2, deviation sqrt(2/3), error sqrt(1/6); t of 3 degrees of
    # freedom 3.182446.
    found = s.estimate_ratio([2.0, 8.0, 4.0, 16.0], [1.0, 2.0, 1.0, 2.0])
    half = 3.182446305283708 * sqrt(1 / 6)
    assert triple(found) == (close(4.0), close(2 ** (2 - half)), close(2 ** (2 + half)))
    assert found.n == 4


def test_holm_by_hand() -> None:
    assert s.apply_holm([0.01, None, 0.04, 0.03, 0.005]) == [
        close(0.03),
        None,
        close(0.06),
        close(0.06),
        close(0.02),
    ]
    assert s.apply_holm([]) == []
    assert s.apply_holm([0.9, 0.8]) == [1.0, 1.0]


def test_the_practice_of_a_perfect_learner_is_found() -> None:
    found = s.fit_power_law([100 * n**-0.4 for n in range(1, 20)])
    assert found is not None
    slope, first = found
    assert triple(slope) == (close(-0.4),) * 3
    assert first == close(100.0)
    assert s.fit_power_law([2.0, 1.0]) is None


def test_order_is_told_from_the_condition() -> None:
    # The manual way takes 8 times as long, a second sitting half as long as a first, and those who began by
    # hand are 3 times as slow.
    began_above = [(8.0 * 3 * k, 0.5 * 3 * k) for k in (1.0, 1.1)]
    began_below = [(4.0 * k, 1.0 * k) for k in (1.0, 1.1)]
    found = s.order_effects(began_above, began_below)
    assert found is not None
    assert (found.adjusted.value, found.second.value, found.carried.value) == (
        close(8.0),
        close(0.5),
        close(3.0),
    )
    assert found.first.value == close(24.0), "of other people each, so their pace is in it"
    assert s.order_effects(began_above, began_below[:1]) is None


def test_words_say_when_people_are_too_few() -> None:
    (one,) = s.list_ratio_cautions(s.estimate_ratio([8.0], [1.0]), None)
    assert "no interval" in one
    few = s.list_ratio_cautions(s.estimate_ratio([8.0, 9.0, 7.0], [1.0, 1.0, 1.0]), 5.0)
    assert len(few) == 1 and "3 pairs" in few[0]
    vague = s.list_ratio_cautions(s.Estimate(1.2, 0.9, 1.6, 12), 0.5)
    assert len(vague) == 1 and "includes 1" in vague[0] and "34 people" in vague[0] and "80 %" in vague[0]
    assert "10,000 people" in s.list_ratio_cautions(s.Estimate(1.0, 0.9, 1.1, 12), 0.001)[0]
    assert s.list_ratio_cautions(s.Estimate(2.0, 1.5, 2.5, 12), 3.0) == []


# --- against others


def test_students_t_as_published() -> None:
    assert compute_t_quantile(0.975, 1) == close(12.706204736174694)
    assert compute_t_quantile(0.975, 3) == close(3.1824463052837078)
    assert compute_t_quantile(0.995, 7.5) == close(3.421422688124044)
    assert compute_t_quantile(0.025, 3) == close(-3.1824463052837078)
    assert compute_t_two_sided(3.3, 11) == close(0.007077990164459755)
    assert compute_t_two_sided(40, 5000) == pytest.approx(8.41485047193577e-304, rel=1e-8)
    assert compute_t_cdf(0.0, 4) == 0.5
    assert compute_t_noncentral(2.1, 6, 1.3) == close(0.729203993214758)
    assert compute_t_noncentral(-0.4, 3, 0.5) == close(0.1954083082328511)
    assert compute_t_noncentral(20.0, 9, 18.0) == close(0.6053249088752901)
    assert compute_t_noncentral(-10.5, 3, 7.1) == 0 and compute_t_noncentral(10.5, 3, -7.1) == 1
    with pytest.raises(ValueError, match="there is no t"):
        compute_t_quantile(1.0, 3)


def test_means_ratios_and_their_test_as_scipy_has_them() -> None:
    assert triple(s.compute_geometric_mean(A)) == (
        close(486.90877390478903),
        close(344.93662161640077),
        close(687.315116018961),
    )
    assert triple(s.estimate_ratio(A, B)) == (
        close(7.548711296279018),
        close(6.096019907816753),
        close(9.347581388555296),
    )
    found = s.compute_paired_t(s.take_logs(A), s.take_logs(B))
    assert (found.statistic, found.p, found.df, found.n) == (
        close(22.36258727621612),
        close(9.043502318730145e-08),
        7,
        8,
    )
    assert found.p == pytest.approx(9.043502318730145e-08, rel=1e-9)


def test_welch_as_scipy_has_it() -> None:
    found, test = s.compute_welch(s.take_logs(A), s.take_logs(B[:5]))
    assert (found.low, found.high) == (close(1.5365317930813582), close(2.473735012636729))
    assert (test.statistic, test.df) == (close(9.539222864082475), close(9.960879528444998))
    assert test.p == pytest.approx(2.5178566621217667e-06, rel=1e-9)


def test_sizes_of_effects_and_studies_as_scipy_and_statsmodels_have_them() -> None:
    found = s.compute_effect_size(s.take_logs(A), s.take_logs(B))
    assert triple(found) == (close(7.022459538745655), close(3.816024964508703), close(12.01014228550578))
    for n, effect, wanted in (
        (5, 0.8, 0.2809920635173735),
        (12, 0.5, 0.3528241493273385),
        (34, 0.5, 0.8077775012792737),
        (2, 3.0, 0.26077071422910936),
        (100, 0.2, 0.508264806621038),
    ):
        assert s.compute_paired_power(n, effect) == close(wanted)
    assert [s.count_pairs_needed(e) for e in (0.5, 0.8, 0.2, -2.0)] == [34, 15, 199, 5]
    assert s.count_pairs_needed(0.0) is None
    assert s.compute_paired_power(1, 1.0) == 0.0


def test_practice_as_least_squares_have_it() -> None:
    found = s.fit_power_law([92.0, 71.5, 66.0, 50.25, 55.0, 43.5, 40.0, 44.25])
    assert found is not None
    assert triple(found[0]) == (
        close(-0.394297905169391),
        close(-0.50026785862046),
        close(-0.2883279517183221),
    )
    assert found[1] == close(exp(4.542294121789409))


# --- always


@given(st.floats(0.001, 0.999), st.floats(1, 500))
def test_a_share_of_a_t_of_a_share_is_that_share(share: float, df: float) -> None:
    assert compute_t_cdf(compute_t_quantile(share, df), df) == pytest.approx(share, abs=1e-12)


@given(st.lists(st.tuples(st.floats(1, 1e4), st.floats(1, 1e4)), min_size=2, max_size=12), st.floats(0.1, 10))
def test_units_of_time_do_not_matter_and_the_other_way_round_is_the_inverse(
    pairs: list[tuple[float, float]], unit: float
) -> None:
    a, b = [x for x, _ in pairs], [y for _, y in pairs]
    found, scaled, turned = (
        s.estimate_ratio(a, b),
        s.estimate_ratio([unit * x for x in a], [unit * y for y in b]),
        s.estimate_ratio(b, a),
    )
    assert found.low is not None and turned.high is not None and scaled.low is not None
    assert scaled.value == pytest.approx(found.value) and scaled.low == pytest.approx(found.low)
    assert log(turned.high) == pytest.approx(-log(found.low), abs=1e-9)
