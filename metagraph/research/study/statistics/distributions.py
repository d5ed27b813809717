"""Distributions and methods that statistics of studies need, from SciPy: an extra, installed when a study is
first reported or planned.

What SciPy lacks is ours: mixed models with Satterthwaite's degrees of freedom, crossed effects of people and
items on choices, intervals of signed ranks, Holm's correction.
"""

from __future__ import annotations

from functools import lru_cache
from importlib import import_module
from importlib.metadata import version
from math import isfinite, sqrt
from typing import Any, Literal

from metagraph.common.extra_steps import bring_extra
from metagraph.common.wording import phrase


@lru_cache(maxsize=8)
def load_scipy(part: Literal["special", "stats", "optimize"]) -> Any:
    """Return a module of SciPy, which is installed first where it is not there. Raises ExtraError."""
    bring_extra("studies", phrase("A study's analysis"))
    return import_module(f"scipy.{part}")


def describe_software() -> str:
    """Return which methods of a report are SciPy's, and which are Metagraph's own, in words."""
    load_scipy("special")
    return (
        f"SciPy {version('scipy')}: Student's t, also noncentral, chi-squared, exact binomial and Fisher's "
        "tests, Clopper and Pearson's intervals, and the minimisers of likelihoods. Metagraph's own, because "
        "SciPy has none: mixed models with Satterthwaite's degrees of freedom, choices with people and items "
        "that cross, intervals of signed ranks, likelihoods of censored times, Holm's correction."
    )


def compute_t_two_sided(t: float, df: float) -> float:
    """Return how likely a t at least as far from 0 is; df > 0."""
    return float(2 * load_scipy("special").stdtr(df, -abs(t)))


def compute_t_cdf(t: float, df: float) -> float:
    """Return the share of Student's distribution up to t."""
    return float(load_scipy("special").stdtr(df, t))


def compute_t_quantile(share: float, df: float) -> float:
    """Return the t that a share of Student's distribution does not exceed. Raises ValueError unless 0 < share
    < 1 and df > 0.
    """
    if not 0 < share < 1 or not df > 0:
        raise ValueError(f"there is no t of a share of {share} with {df} degrees of freedom")
    return float(load_scipy("special").stdtrit(df, share))


def compute_t_noncentral(t: float, df: float, shift: float) -> float:
    """Return the share of the noncentral t distribution up to t: of (Z + shift) / S, with S^2 a chi-squared
    over df.
    """
    found = float(load_scipy("special").nctdtr(df, shift, t))
    return found if isfinite(found) else float(t > shift)  # SciPy 1.17 has no value beyond 8 deviations or so


def find_t_shift(t: float, df: float, share: float) -> float:
    """Return the noncentrality at which a share of the noncentral t distribution is up to t."""
    width = 5 * sqrt(1 + t * t / (2 * df))
    return float(
        load_scipy("optimize").brentq(
            lambda shift: compute_t_noncentral(t, df, shift) - share, t - width, t + width, xtol=1e-12
        )
    )


def compute_chi_squared_cdf(x: float, df: float) -> float:
    """Return the share of the chi-squared distribution up to x."""
    return float(load_scipy("special").chdtr(df, max(0.0, x)))


def compute_chi_squared_quantile(share: float, df: float) -> float:
    """Return the value a share of the chi-squared distribution does not exceed."""
    return float(load_scipy("special").chdtri(df, 1 - share))
