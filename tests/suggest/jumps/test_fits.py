"""Distributions fitted to costs."""

from __future__ import annotations

import numpy as np
import pytest

from metagraph.suggest.jumps.fits import fit_distributions

DRAWS = {
    "log-normal": lambda rng, n: rng.lognormal(0.3, 0.6, n),
    "Weibull": lambda rng, n: 2.0 * rng.weibull(1.4, n),
    "gamma": lambda rng, n: rng.gamma(2.5, 0.7, n),
    "beta": lambda rng, n: 0.5 + 3 * rng.beta(2.0, 5.0, n),
}


@pytest.mark.parametrize("values", [[], [1.0] * 50, [0.1, 0.2, 0.3], [np.nan] * 20])
def test_too_few_values_or_all_alike_fit_nothing(values: list[float]) -> None:
    assert fit_distributions(values, 0.95) == ()


@pytest.mark.parametrize("name", DRAWS)
def test_what_was_drawn_from_a_distribution_is_near_to_it(name: str) -> None:
    x = DRAWS[name](np.random.default_rng(4), 20_000)
    found = {f.name: f for f in fit_distributions(x, 0.95)}
    assert found[name].distance < 0.02
    assert found[name].limit == pytest.approx(np.quantile(x, 0.95), rel=0.02)
    assert found[name].likelihood >= max(f.likelihood for f in found.values()) - 0.01


@pytest.mark.parametrize("name", DRAWS)
def test_limits_and_distances_are_those_of_scipy(name: str) -> None:
    stats = pytest.importorskip("scipy.stats")
    x = DRAWS[name](np.random.default_rng(1), 3000)
    found = {f.name: f for f in fit_distributions(x, 0.9)}
    for other, kind in (
        ("log-normal", stats.lognorm),
        ("Weibull", stats.weibull_min),
        ("gamma", stats.gamma),
    ):
        theirs = kind(*kind.fit(x, floc=0))
        assert found[other].limit == pytest.approx(theirs.ppf(0.9), rel=2e-3)
        assert found[other].distance == pytest.approx(stats.kstest(x, theirs.cdf).statistic, abs=2e-3)
        assert found[other].likelihood == pytest.approx(theirs.logpdf(x).mean(), abs=2e-3)
