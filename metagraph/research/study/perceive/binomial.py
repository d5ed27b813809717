"""Exact inference on shares: counts of choices between two.

The test sums what is at most as likely as what was seen. Intervals: Clopper and Pearson (1934), "The use of
confidence or fiducial limits illustrated in the case of the binomial", Biometrika 26. Fisher's exact test of
two shares in the same way.
"""

from __future__ import annotations

from collections.abc import Callable
from math import ceil, exp
from statistics import NormalDist

import numpy as np

from metagraph.research.study.statistics.distributions import load_scipy
from metagraph.research.study.statistics.small_samples import LEVEL, Estimate

MOST = 100_000  # answers beyond which no study is planned
STEADY = 100  # more answers with which the power must hold, since it goes up and down like a saw
CLOSE = 1 + 1e-7  # what counts as just as likely


def compute_probability_at_most(k: int, n: int, share: float) -> float:
    """Return how likely k of n, or fewer, are where each is with probability `share`, 0..1."""
    if k < 0 or k >= n:
        return 0.0 if k < 0 else 1.0
    return float(load_scipy("special").bdtr(k, n, share))


def compute_two_sided_p(k: int, n: int, share: float = 0.5) -> float | None:
    """Return the p value of k of n against a share, 0 < share < 1; None of nothing. Raises ValueError."""
    _checked(k, n)
    if not n:
        return None
    return float(load_scipy("stats").binomtest(k, n, share).pvalue)


def estimate_exact_share(k: int, n: int, level: float = LEVEL) -> Estimate:
    """Return the share k / n with its exact interval. Raises ValueError for nothing."""
    _checked(k, n)
    if not n:
        raise ValueError("nothing has no share")
    tail = (1 - level) / 2
    edge = load_scipy("special").betaincinv
    low = 0.0 if k == 0 else float(edge(k, n - k + 1, tail))
    high = 1.0 if k == n else float(edge(k + 1, n - k, 1 - tail))
    return Estimate(k / n, low, high, n)


def compute_fisher_p(a: int, n: int, b: int, m: int) -> float | None:
    """Return the p value of a of n being the same share as b of m; None if either has none."""
    _checked(a, n)
    _checked(b, m)
    if not n or not m:
        return None
    return float(load_scipy("stats").fisher_exact([[a, n - a], [b, m - b]]).pvalue)


def share_power(n: int, share: float, alpha: float = 0.05) -> float:
    """Return how likely n answers show a share to be other than a half."""
    if n < 1:
        return 0.0
    below = load_scipy("special").bdtr(np.arange(n + 1), n, 0.5)
    out = np.flatnonzero(2 * below * CLOSE**-1 <= alpha)  # a half is symmetric: twice the lower tail
    if not len(out):
        return 0.0
    edge = int(out[-1])
    return compute_probability_at_most(edge, n, share) + compute_probability_at_most(edge, n, 1 - share)


def count_needed_answers(share: float, chance: float = 0.8, alpha: float = 0.05) -> int | None:
    """Return with how many answers a share is shown to be other than a half with a chance, and with all
    somewhat larger numbers, too; None beyond MOST. Raises ValueError.
    """
    _probability(share, chance, alpha)
    off = abs(share - 0.5)
    if off < 1e-9:
        return None
    z = NormalDist().inv_cdf(1 - alpha / 2) + NormalDist().inv_cdf(chance)
    return _from(ceil((z * 0.5 / off) ** 2), lambda n: share_power(n, share, alpha) >= chance)


def share_equivalence_power(n: int, margin: float, share: float = 0.5, alpha: float = 0.05) -> float:
    """Return how likely the exact interval of level 1 - 2 alpha of n answers lies within a half and a margin
    either way.
    """
    low, high = 0.5 - margin, 0.5 + margin
    counts = [
        k
        for k in range(n + 1)
        if 1 - compute_probability_at_most(k - 1, n, low) < alpha
        and compute_probability_at_most(k, n, high) < alpha
    ]
    if not counts:
        return 0.0
    return compute_probability_at_most(counts[-1], n, share) - compute_probability_at_most(
        counts[0] - 1, n, share
    )


def count_answers_for_equivalence(margin: float, chance: float = 0.8, alpha: float = 0.05) -> int | None:
    """Return with how many answers a true half is shown to be within a margin either way; None beyond MOST.
    Raises ValueError.
    """
    _probability(chance, alpha)
    if not 0 < margin < 0.5:
        raise ValueError(f"a margin lies between 0 and 0.5, not {margin:g}")
    z = NormalDist().inv_cdf(1 - alpha) + NormalDist().inv_cdf((1 + chance) / 2)
    return _from(
        ceil((z * 0.5 / margin) ** 2), lambda n: share_equivalence_power(n, margin, 0.5, alpha) >= chance, 20
    )


def _from(about: int, enough: Callable[[int], bool], steady: int = STEADY) -> int | None:
    """Return the number after the last one for which something does not hold, near and below an estimate."""
    if about > MOST:
        return None
    top = about + max(steady, about // 4)
    while not enough(top):
        top = top * 5 // 4 + 1
        if top > MOST:
            return None
    n = top
    while n > 1 and enough(n - 1):
        n -= 1
        if top - n > steady and n < about // 2:
            break
    # Teeth of the saw may lie below: the first number whose followers all hold is the answer.
    return n


def _checked(k: int, n: int) -> None:
    if not 0 <= k <= n:
        raise ValueError(f"{k} of {n} is no count")


def _probability(*values: float) -> None:
    for v in values:
        if not 0 < v < 1:
            raise ValueError(f"shares and chances lie between 0 and 1, not at {v:g}")


def logistic(x: float) -> float:
    """Return the share of log odds."""
    return 1 / (1 + exp(-x)) if x >= 0 else exp(x) / (1 + exp(x))
