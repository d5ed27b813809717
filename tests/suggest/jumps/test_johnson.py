"""Johnson's bounded distribution: by hand, against itself, and against SciPy where it is installed."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.suggest.jumps.johnson import JohnsonSB, fit_johnson

shapes = st.builds(JohnsonSB, st.floats(-3, 3), st.floats(0.2, 5), st.floats(-10, 10), st.floats(11, 50))


def test_no_values_cannot_be_fitted() -> None:
    with pytest.raises(ValueError, match="no values"):
        fit_johnson([], 0, 1)


def test_bounds_must_ascend() -> None:
    with pytest.raises(ValueError, match="ascend"):
        fit_johnson([1.0], 2, 2)


def test_values_that_are_all_alike_are_where_the_distribution_is() -> None:
    found = fit_johnson([0.3] * 50, 0, 1)
    assert found.quantile(0.05) == pytest.approx(0.3, abs=1e-4)
    assert found.quantile(0.95) == pytest.approx(0.3, abs=1e-4)


def test_values_on_the_bounds_do_no_harm() -> None:
    found = fit_johnson([0.0, 0.0, 0.5, 1.0, 1.0], 0, 1)
    assert np.isfinite([found.gamma, found.delta]).all()
    assert found.quantile(0.5) == pytest.approx(0.5)


def test_a_fit_by_hand() -> None:
    # u = 1/4, 1/2, 3/4: z = -ln 3, 0, ln 3, whose mean is 0 and whose deviation is ln 3 * sqrt(2 / 3).
    found = fit_johnson([1.0, 2.0, 3.0], 0, 4)
    assert found.gamma == pytest.approx(0.0, abs=1e-12)
    assert found.delta == pytest.approx(1 / (np.log(3) * np.sqrt(2 / 3)))
    # u = 1/4, 3/4 and 9/10: z = -1.0986, 1.0986, 2.1972: mean 0.7324, deviation 1.3698 (of all, not of a
    # sample).
    found = fit_johnson([0.25, 0.75, 0.9], 0, 1)
    assert (found.gamma, found.delta) == (pytest.approx(-0.53452, abs=1e-4), pytest.approx(0.72987, abs=1e-4))


def test_shares_and_values_by_hand() -> None:
    d = JohnsonSB(gamma=0.0, delta=1.0, low=0.0, high=2.0)
    assert float(d.cdf(1.0)) == pytest.approx(0.5)
    # The 97.5 % of the normal distribution is 1.959964: u = 1 / (1 + e^-1.959964) = 0.876533.
    assert d.quantile(0.975) == pytest.approx(2 * 0.876533, abs=1e-5)
    assert d.cdf([-1.0, 0.0, 2.0, 3.0]).tolist() == [0.0, 0.0, 1.0, 1.0]
    assert (d.quantile(0.0), d.quantile(1.0)) == (0.0, 2.0)
    assert d.cdf(np.zeros(0)).shape == (0,)


@given(shapes, st.floats(0.001, 0.999))
def test_a_share_of_a_value_of_a_share_is_that_share(d: JohnsonSB, share: float) -> None:
    value = d.quantile(share)
    assert d.low <= value <= d.high
    assert float(d.cdf(value)) == pytest.approx(share, abs=1e-4)


@given(shapes)
def test_the_share_never_falls(d: JohnsonSB) -> None:
    assert (np.diff(d.cdf(np.linspace(d.low - 1, d.high + 1, 60))) >= 0).all()


def test_what_was_drawn_is_found_again() -> None:
    z = np.random.default_rng(3).normal(size=20_000)
    u = 1 / (1 + np.exp(-(z - 0.8) / 1.3))
    found = fit_johnson(2 + 5 * u, 2, 7)
    assert (found.gamma, found.delta) == (pytest.approx(0.8, abs=0.03), pytest.approx(1.3, abs=0.03))


def test_it_agrees_with_scipy() -> None:
    johnsonsb = pytest.importorskip("scipy.stats", reason="SciPy is not installed").johnsonsb
    x = np.linspace(0.01, 0.99, 25)
    assert np.allclose(JohnsonSB(0.7, 1.4, 0, 1).cdf(x), johnsonsb.cdf(x, 0.7, 1.4), atol=1e-12)
    assert JohnsonSB(0.7, 1.4, 2, 5).quantile(0.95) == pytest.approx(
        float(johnsonsb.ppf(0.95, 0.7, 1.4, 2, 3))
    )
    values = johnsonsb.rvs(0.7, 1.4, size=500, random_state=1)
    a, b, _, _ = johnsonsb.fit(values, floc=0, fscale=1)
    assert (fit_johnson(values, 0, 1).gamma, fit_johnson(values, 0, 1).delta) == (
        pytest.approx(a, rel=0.02),
        pytest.approx(b, rel=0.02),
    )
