"""Statistics of small studies: estimates with intervals first, tests beside them. Times are compared on logs,
as ratios.

Seconds of work are skewed and multiply rather than add (a person who is twice as slow is so at everything),
so means of times are geometric, and conditions are compared by their ratio (Sauro and Lewis 2010, "Average
task times in usability tests").
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import exp, inf, isfinite, lgamma, log, sqrt

import numpy as np

from metagraph.research.study.statistics.distributions import (
    compute_t_noncentral,
    compute_t_quantile,
    compute_t_two_sided,
    find_t_shift,
)

LEVEL = 0.95
FEWEST_RANKED = 6  # pairs below which signed ranks give no interval of 95 %: 2 / 2^5 = 0.0625
MOST_PEOPLE = 10_000  # beyond which no study is planned


@dataclass(frozen=True, slots=True)
class Estimate:
    """A value with its interval; low and high are None if n is too small for one."""

    value: float
    low: float | None
    high: float | None
    n: int

    def holds(self, value: float) -> bool:
        """Whether the interval includes a value; False without an interval."""
        return self.low is not None and self.high is not None and self.low <= value <= self.high

    def exp(self) -> Estimate:
        """Return the estimate of logs as one of ratios."""
        return Estimate(
            _exp(self.value),
            None if self.low is None else _exp(self.low),
            None if self.high is None else _exp(self.high),
            self.n,
        )

    def __neg__(self) -> Estimate:
        return Estimate(
            -self.value,
            None if self.high is None else -self.high,
            None if self.low is None else -self.low,
            self.n,
        )


@dataclass(frozen=True, slots=True)
class Test:
    """A two-sided test. df: degrees of freedom. p: None if it cannot be told. n: pairs, or people of both
    groups.
    """

    name: str
    statistic: float | None
    df: float | None
    p: float | None
    n: int


def mean(values: Sequence[float], level: float = LEVEL) -> Estimate:
    """Return the mean with its t interval. Raises ValueError without values."""
    x = _array(values)
    m = float(x.mean())
    if len(x) < 2:
        return Estimate(m, None, None, len(x))
    half = compute_t_quantile((1 + level) / 2, len(x) - 1) * float(x.std(ddof=1)) / sqrt(len(x))
    return Estimate(m, m - half, m + half, len(x))


def compute_geometric_mean(values: Sequence[float], level: float = LEVEL) -> Estimate:
    """Return the geometric mean with the interval of its logs. Raises ValueError for what is not > 0."""
    return mean(take_logs(values), level).exp()


def estimate_ratio(above: Sequence[float], below: Sequence[float], level: float = LEVEL) -> Estimate:
    """Return the ratio of geometric means of pairs with its interval: the mean of the logs' differences."""
    return mean(_paired(take_logs(above), take_logs(below)), level).exp()


def compute_paired_t(a: Sequence[float], b: Sequence[float]) -> Test:
    """Return Student's test that the differences a - b are 0 on average."""
    d = np.array(_paired(a, b))
    n = len(d)
    if n < 2:
        return Test("paired t", None, None, None, n)
    spread = float(d.std(ddof=1))
    if spread == 0:
        same = float(d.mean()) == 0
        return Test(
            "paired t", 0.0 if same else float(np.sign(d.mean())) * inf, n - 1, 1.0 if same else 0.0, n
        )
    t = float(d.mean()) / spread * sqrt(n)
    return Test("paired t", t, n - 1, compute_t_two_sided(t, n - 1), n)


def compute_welch(a: Sequence[float], b: Sequence[float], level: float = LEVEL) -> tuple[Estimate, Test]:
    """Return the difference of two groups' means, a - b, with its interval, and Welch's test that it is 0."""
    x, y = _array(a), _array(b)
    d, n = float(x.mean() - y.mean()), len(x) + len(y)
    if len(x) < 2 or len(y) < 2:
        return Estimate(d, None, None, n), Test("Welch's t", None, None, None, n)
    va, vb = float(x.var(ddof=1)) / len(x), float(y.var(ddof=1)) / len(y)
    error = sqrt(va + vb)
    if error == 0:
        return Estimate(d, d, d, n), Test(
            "Welch's t", 0.0 if d == 0 else float(np.sign(d)) * inf, float(n - 2), 1.0 if d == 0 else 0.0, n
        )
    df = (va + vb) ** 2 / (va**2 / (len(x) - 1) + vb**2 / (len(y) - 1))
    half = compute_t_quantile((1 + level) / 2, df) * error
    return Estimate(d, d - half, d + half, n), Test(
        "Welch's t", d / error, df, compute_t_two_sided(d / error, df), n
    )


# --- sizes of effects, and of studies


def compute_effect_size(a: Sequence[float], b: Sequence[float], level: float = LEVEL) -> Estimate | None:
    """Return Cohen's d_z of pairs, the mean difference beside the differences' deviation, with Hedges'
    correction for small samples (Hedges 1981, its exact form), and the interval of what it estimates, from
    the noncentral t distribution; None if the differences do not vary.
    """
    d = np.array(_paired(a, b))
    n = len(d)
    spread = float(d.std(ddof=1)) if n > 1 else 0.0
    if n < 3 or spread < 1e-12:
        return None
    dz, less = float(d.mean()) / spread, compute_hedges_correction(n - 1)
    t = dz * sqrt(n)
    low, high = (find_t_shift(t, n - 1, (1 + sign * level) / 2) / sqrt(n) for sign in (1, -1))
    return Estimate(less * dz, low, high, n)


def compute_hedges_correction(df: float) -> float:
    """Return Hedges' factor J, that takes the bias from a standardised difference; df > 1."""
    return exp(lgamma(df / 2) - lgamma((df - 1) / 2)) / sqrt(df / 2)


def compute_paired_power(n: int, effect: float, alpha: float = 0.05) -> float:
    """Return how likely a paired t test of n pairs finds an effect d_z."""
    if n < 2:
        return 0.0
    edge = compute_t_quantile(1 - alpha / 2, n - 1)
    shift = abs(effect) * sqrt(n)
    return 1 - compute_t_noncentral(edge, n - 1, shift) + compute_t_noncentral(-edge, n - 1, shift)


def count_pairs_needed(effect: float, wanted: float = 0.8, alpha: float = 0.05) -> int | None:
    """Return how many pairs a paired t test needs to find an effect d_z that likely; None beyond
    MOST_PEOPLE.
    """
    if not isfinite(effect) or effect == 0:
        return None if effect == 0 else 2
    low, high = 1, 2
    while compute_paired_power(high, effect, alpha) < wanted:
        low, high = high, 2 * high
        if low >= MOST_PEOPLE:
            return None
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if compute_paired_power(middle, effect, alpha) >= wanted else (middle, high)
    return high


def apply_holm(chances: Sequence[float | None]) -> list[float | None]:
    """Return p values corrected for how many there are (Holm 1979), in their order; None stays None and is
    not counted.
    """
    there = sorted((p, i) for i, p in enumerate(chances) if p is not None)
    out: list[float | None] = [None] * len(chances)
    most = 0.0
    for rank, (p, i) in enumerate(there):
        most = max(most, min(1.0, (len(there) - rank) * p))
        out[i] = most
    return out


# --- learning, and order


def fit_power_law(seconds: Sequence[float], level: float = LEVEL) -> tuple[Estimate, float] | None:
    """Return the slope of log seconds over log of the how-many-eth, with its interval, and the seconds of the
    first on that line: seconds = first * n^slope (Newell and Rosenbloom 1981). None for fewer than 3.
    """
    y = np.array(take_logs(seconds))
    n = len(y)
    if n < 3:
        return None
    x = np.log(np.arange(1, n + 1))
    xc = x - x.mean()
    slope = float(xc @ y / (xc @ xc))
    first = float(np.mean(y) - slope * x.mean())
    error = sqrt(float(((y - first - slope * x) ** 2).sum()) / (n - 2) / float(xc @ xc))
    half = compute_t_quantile((1 + level) / 2, n - 2) * error
    return Estimate(slope, slope - half, slope + half, n), exp(first)


@dataclass(frozen=True, slots=True)
class PeriodOrder:
    """Whether it mattered who began with what, of pairs in two orders (Grizzle 1965, for a cross-over of two
    periods).

    adjusted: the ratio with both orders weighing the same. second: the seconds of a second sitting beside a
    first, as a ratio. carried: the seconds of all sittings of those who began with the one beside those who
    began with the other; unlike 1, something carried over, or the groups were unlike. first: the ratio by
    first sittings alone, of other people each. tests: of second and carried being 1.
    """

    adjusted: Estimate
    second: Estimate
    carried: Estimate
    first: Estimate
    second_test: Test
    carried_test: Test


def order_effects(
    above_first: Sequence[tuple[float, float]],
    below_first: Sequence[tuple[float, float]],
    level: float = LEVEL,
) -> PeriodOrder | None:
    """Return what the order did. Each group's (above, below) seconds, in one those who began with `above`.
    None with fewer than 2 in a group.
    """
    if len(above_first) < 2 or len(below_first) < 2:
        return None
    one, other = ([(log(a), log(b)) for a, b in group] for group in (above_first, below_first))
    d_one, d_other = [a - b for a, b in one], [a - b for a, b in other]
    # Those who began with `above` have it in their first sitting: their difference is that of the conditions
    # less that of the sittings.
    gap, gap_test = compute_welch(d_other, d_one, level)
    both, _ = compute_welch(d_one, [-d for d in d_other], level)
    sums, sums_test = compute_welch([(a + b) / 2 for a, b in one], [(a + b) / 2 for a, b in other], level)
    first, _ = compute_welch([a for a, _ in one], [b for _, b in other], level)
    return PeriodOrder(_half(both).exp(), _half(gap).exp(), sums.exp(), first.exp(), gap_test, sums_test)


# --- words


def list_ratio_cautions(found: Estimate, effect: float | None) -> list[str]:
    """Return what a ratio of n pairs does not allow to say. effect: its d_z, uncorrected, None if it is not
    known.
    """
    n = found.n
    if n < 2:
        return ["One person's ratio has no interval: it says nothing about other people."] if n else []
    out = []
    if n < FEWEST_RANKED:
        out.append(
            f"With {n} pairs there is no interval by ranks, which needs at least {FEWEST_RANKED}: the one "
            "told here rests on logs of ratios being normal."
        )
    if found.holds(1.0):
        words = "The interval of the ratio includes 1: these people do not show that either way is faster."
        needed = count_pairs_needed(effect) if effect is not None else None
        if needed is not None and needed > n:
            words += (
                f" If the effect is as large as it was here, about {needed} people give an 80 % chance "
                "to show it."
            )
        elif effect is not None and needed is None:
            words += f" An effect as small as here would not be shown by {MOST_PEOPLE:,} people."
        out.append(words)
    return out


# --- small ones


def take_logs(values: Sequence[float]) -> list[float]:
    """Return natural logs. Raises ValueError for what is not a number > 0."""
    bad = [v for v in values if not (isfinite(v) and v > 0)]
    if bad:
        raise ValueError(f"{bad[0]} has no logarithm: times are greater than 0")
    return [log(v) for v in values]


def _exp(x: float) -> float:
    return exp(x) if x < 700 else inf


def _half(found: Estimate) -> Estimate:
    return Estimate(
        found.value / 2,
        None if found.low is None else found.low / 2,
        None if found.high is None else found.high / 2,
        found.n,
    )


def _array(values: Sequence[float]) -> np.ndarray:
    x = np.asarray(values, np.float64)
    if not x.size:
        raise ValueError("no values have no mean")
    return x


def _paired(a: Sequence[float], b: Sequence[float]) -> list[float]:
    if len(a) != len(b):
        raise ValueError(f"pairs need as many of both, not {len(a)} and {len(b)}")
    return [x - y for x, y in zip(a, b, strict=True)]
