"""How many people a study needs: to show an effect, to tell it precisely, and to tell that there is none
worth mentioning. Times are compared within people, on logs, as ratios.

Power of the paired t test from the noncentral t distribution. Equivalence by two one-sided tests (Schuirmann
1987); their power is integrated over the standard deviation that is drawn (Owen 1965, as Phillips 1990 uses
it).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import erfc, exp, inf, isfinite, lgamma, log, sqrt
from statistics import stdev
from typing import Literal

import numpy as np

from metagraph.research.study.statistics import small_samples as stats
from metagraph.research.study.statistics.distributions import (
    compute_chi_squared_cdf,
    compute_chi_squared_quantile,
    compute_t_cdf,
    compute_t_quantile,
)
from metagraph.research.study.statistics.small_samples import MOST_PEOPLE, Estimate, Test

Verdict = Literal["larger", "equivalent", "smaller", "not told"]


@dataclass(frozen=True)
class Assumed:
    """What is assumed of people: the ratio of times, and the standard deviation of the logs of their ratios.
    source: where that comes from, in words. worst: the deviation that is computed with to be careful: of a
    pilot, the upper end of its one-sided 80 % interval.
    """

    ratio: float
    spread: float
    source: str
    worst: float

    def __post_init__(self) -> None:
        for name in ("ratio", "spread", "worst"):
            value = getattr(self, name)
            if not (isfinite(value) and value > 0):
                raise ValueError(f"{name} should be greater than 0, not {value:g}")


@dataclass(frozen=True)
class SampleSize:
    """People needed for each aim; None if more than MOST_PEOPLE are. show: the assumed ratio. smallest: the
    smallest that matters. precise: an interval no wider than `within` times either way, with that chance.
    equivalent: to show that a ratio of 1 is within what matters.
    """

    show: int | None
    smallest: int | None
    precise: int | None
    equivalent: int | None


def assume_without_pilot(ratio: float, spread: float) -> Assumed:
    """Return what is assumed without a pilot. Raises ValueError."""
    return Assumed(ratio, spread, "assumed", spread)


def from_pilot(ratios: Sequence[float], source: str = "a pilot") -> Assumed:
    """Return what a pilot's people's ratios say; small pilots flatter, so that the deviation to compute with
    is the upper end of a one-sided 80 % interval (Browne 1995). Raises ValueError for fewer than 3.
    """
    if len(ratios) < 3:
        raise ValueError(f"a pilot needs 3 people at least, who did both, not {len(ratios)}")
    logs = stats.take_logs(ratios)
    spread = stdev(logs)
    if spread <= 0:
        raise ValueError("the people of the pilot do not differ at all; assume a deviation")
    n = len(logs)
    worst = spread * sqrt((n - 1) / compute_chi_squared_quantile(0.2, n - 1))
    return Assumed(exp(sum(logs) / n), spread, f"{source} of {n}", worst)


def sample_size(
    found: Assumed,
    smallest: float,
    within: float = 1.25,
    chance: float = 0.8,
    alpha: float = 0.05,
    families: int = 1,
) -> SampleSize:
    """Return how many people are needed, for a chance of each aim. smallest: the smallest ratio that matters,
    > 1. within: the factor by which the interval may reach beyond the ratio, > 1. families: how many tests
    share alpha, corrected as Bonferroni does, which Holm never does worse than. Raises ValueError.
    """
    for name, value in (("smallest", smallest), ("within", within)):
        if not (isfinite(value) and value > 1):
            raise ValueError(f"{name} should be a ratio greater than 1, not {value:g}")
    if not 0 < chance < 1 or not 0 < alpha < 1:
        raise ValueError("chance and alpha are between 0 and 1")
    spread, share = found.worst, alpha / max(1, families)
    bound = log(smallest)
    return SampleSize(
        stats.count_pairs_needed(log(found.ratio) / spread, chance, share),
        stats.count_pairs_needed(bound / spread, chance, share),
        _fewest(lambda n: compute_precision_chance(n, spread, log(within), alpha) >= chance),
        _fewest(lambda n: compute_ratio_equivalence_power(n, 0.0, spread, -bound, bound, alpha) >= chance),
    )


def _fewest(enough: Callable[[int], bool]) -> int | None:
    """Return the least number of people from 2 for which something holds that holds for more, too."""
    low, high = 1, 2
    while not enough(high):
        low, high = high, 2 * high
        if low >= MOST_PEOPLE:
            return None
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if enough(middle) else (middle, high)
    return high


def compute_half_width(n: int, spread: float, alpha: float = 0.05) -> float:
    """Return the half width of the interval of a mean of n logs, where their deviation is as assumed."""
    return compute_t_quantile(1 - alpha / 2, n - 1) * spread / sqrt(n)


def compute_precision_chance(n: int, spread: float, half: float, alpha: float = 0.05) -> float:
    """Return how likely the interval of n logs is no wider than `half` either way, deviation and all
    drawn.
    """
    if n < 2:
        return 0.0
    edge = half * sqrt(n) / compute_t_quantile(1 - alpha / 2, n - 1) / spread
    return compute_chi_squared_cdf((n - 1) * edge * edge, n - 1)


# --- equivalence


def compute_ratio_equivalence_power(
    n: int,
    effect: float,
    spread: float,
    low: float,
    high: float,
    alpha: float = 0.05,
    df: float | None = None,
) -> float:
    """Return how likely two one-sided tests of n pairs show that a mean lies between low and high. effect,
    spread: of the differences; df: n - 1 unless told.
    """
    freedom = n - 1 if df is None else df
    if n < 2 or freedom <= 0 or low >= high:
        return 0.0
    error = spread / sqrt(n)
    t = compute_t_quantile(1 - alpha, freedom)
    most = (
        (high - low) / 2 / (t * error)
    )  # of the drawn deviation beside the true one; beyond, nothing is shown
    nodes, weights = np.polynomial.legendre.leggauss(64)
    edge = min(most, 1 + 10 / sqrt(2 * freedom))
    start = max(0.0, min(1 - 10 / sqrt(2 * freedom), edge))
    s = start + (edge - start) * (nodes + 1) / 2
    w = (edge - start) * weights / 2
    dense = np.exp(
        log(2)
        + freedom / 2 * log(freedom / 2)
        - lgamma(freedom / 2)
        + (freedom - 1) * np.log(s)
        - freedom * s * s / 2
    )
    inner = [
        _normal((high - effect) / error - t * v) - _normal((low - effect) / error + t * v) for v in s.tolist()
    ]
    return float(min(1.0, max(0.0, (w * dense * np.maximum(inner, 0.0)).sum())))


def _normal(z: float) -> float:
    return erfc(-z / sqrt(2)) / 2


@dataclass(frozen=True)
class Equivalence:
    """Whether a ratio is within what does not matter. interval: of the ratio, of 1 - 2 alpha. test: the one
    of the two one-sided tests that says less. verdict: `larger` or `smaller` where all of the interval is
    beyond the smallest that matters, `equivalent` where all of it is within.
    """

    smallest: float
    interval: Estimate
    test: Test
    verdict: Verdict


def judge_equivalence(logs: Sequence[float], smallest: float, alpha: float = 0.05) -> Equivalence | None:
    """Return what people's log ratios say of a smallest ratio that matters, > 1. None for fewer than 2."""
    if len(logs) < 2:
        return None
    found = stats.mean(logs, 1 - 2 * alpha)
    assert found.low is not None and found.high is not None
    bound, n = log(smallest), len(logs)
    error = (found.high - found.low) / 2 / compute_t_quantile(1 - alpha, n - 1)
    above, below = found.value + bound, bound - found.value  # how far inside of either end
    t = min(above, below) / error if error > 0 else (inf if min(above, below) > 0 else -inf)
    p = 1 - compute_t_cdf(t, n - 1) if isfinite(t) else float(t < 0)
    verdict: Verdict = "not told"
    if -bound < found.low and found.high < bound:
        verdict = "equivalent"
    elif found.low > bound:
        verdict = "larger"
    elif found.high < -bound:
        verdict = "smaller"
    return Equivalence(smallest, found.exp(), Test("two one-sided t", t, n - 1, p, n), verdict)
