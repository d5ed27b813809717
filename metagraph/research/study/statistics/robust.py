"""Estimates that one odd value does not carry away, and ones that know that a time was cut short.

Hodges and Lehmann (1963), "Estimates of location based on rank tests". Censored values: the likelihood of
Tobin (1958), its interval by the profile, as wide as Student's if nothing is censored.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from functools import lru_cache
from math import exp, floor, inf, log, log1p, pi, sqrt
from statistics import NormalDist, median

import numpy as np

from metagraph.research.study.statistics.distributions import compute_t_quantile, load_scipy
from metagraph.research.study.statistics.small_samples import LEVEL, Estimate, mean

EXACT = 25  # values up to which every way to give ranks signs is counted
MAD = 1.4826  # what makes the median deviation from the median a standard deviation, of normal values
FAR = 3.5  # such deviations beyond which a value is odd (Iglewicz and Hoaglin 1993)
WIDEST = 1000.0  # times the reach of the values beyond which an end of an interval is not known


def compute_hodges_lehmann(values: Sequence[float], level: float = LEVEL) -> Estimate:
    """Return the median of all means of two values, each with itself, too, and the interval of Wilcoxon's
    signed ranks: exact up to EXACT values. No interval where so few cannot have one of that level. Raises
    ValueError without values.
    """
    x = np.asarray(values, np.float64)
    if not x.size:
        raise ValueError("no values have no middle")
    n = len(x)
    i, j = np.triu_indices(n)
    means = np.sort((x[i] + x[j]) / 2)
    value = float(np.median(means))
    least = _rank_quantile(n, (1 - level) / 2)
    if least < 1:
        return Estimate(value, None, None, n)
    return Estimate(value, float(means[least - 1]), float(means[len(means) - least]), n)


@lru_cache(maxsize=256)
def _rank_quantile(n: int, share: float) -> int:
    """Return how many of the ordered means an interval leaves out on a side, and one; 0 where it is none."""
    if n > EXACT:
        spread = sqrt(n * (n + 1) * (2 * n + 1) / 24)
        return max(1, floor(n * (n + 1) / 4 + NormalDist().inv_cdf(share) * spread))
    ways = np.zeros(n * (n + 1) // 2 + 1)
    ways[0] = 1
    for r in range(1, n + 1):
        ways[r:] += ways[:-r].copy()
    below = np.cumsum(ways) / 2.0**n
    return int(np.searchsorted(below, share * (1 - 1e-12)))


def leave_one_out(values: Sequence[float], level: float = LEVEL) -> list[Estimate]:
    """Return the mean without each value in turn, with its t interval; nothing for fewer than 3."""
    if len(values) < 3:
        return []
    return [mean([v for k, v in enumerate(values) if k != n], level) for n in range(len(values))]


def find_odd_ones(values: Sequence[float]) -> list[int]:
    """Return the places of values more than FAR robust deviations from the median; none of fewer than 5, or
    where more than half are alike.
    """
    if len(values) < 5:
        return []
    middle = median(values)
    spread = MAD * median(abs(v - middle) for v in values)
    return [n for n, v in enumerate(values) if spread > 0 and abs(v - middle) > FAR * spread]


# --- values of which only a bound is known


def estimate_censored_mean(
    exact: Sequence[float], above: Sequence[float] = (), below: Sequence[float] = (), level: float = LEVEL
) -> Estimate | None:
    """Return the mean of normal values, some known only to lie above, or below, a bound. Its interval is that
    of the profile likelihood, scaled so that it is Student's where none is censored; an end that the values
    do not bound is infinite. None with fewer than 2 known ones, or where those are all the same.
    """
    x, lows, highs = (np.asarray(v, np.float64) for v in (exact, above, below))
    n = len(x) + len(lows) + len(highs)
    if len(x) < 2 or float(np.ptp(x)) < 1e-12:
        return None

    middle, known = float(x.mean()), len(x)
    around = float(((x - middle) ** 2).sum())
    tails = [(v, 1.0, n) for v, n in Counter(lows.tolist()).items()]
    tails += [(v, -1.0, n) for v, n in Counter(highs.tolist()).items()]

    log_tail = load_scipy("special").log_ndtr

    def lost(mu: float, scale: float) -> float:
        """Return minus twice the log likelihood."""
        out = (around + known * (middle - mu) ** 2) / scale**2 + known * (2 * log(scale) + log(2 * pi))
        for bound, sign, times in tails:
            out -= 2 * times * log_tail(-sign * (bound - mu) / scale)
        return out

    spread = float(x.std(ddof=1))
    reach = max(spread, float(np.ptp(np.concatenate([x, lows, highs]))))

    def best(mu: float) -> float:
        return _lowest(
            lambda s: lost(mu, exp(s)), log(spread) - 6, log(reach + abs(mu - float(x.mean()))) + 3
        )[1]

    if not len(lows) and not len(highs):
        return mean(exact, level)
    low, high = float(x.min()) - 20 * reach, float(x.max()) + 20 * reach
    mu, least = _lowest(best, low, high)
    t = compute_t_quantile((1 + level) / 2, n - 1)
    edge = least + n * log1p(t * t / (n - 1))
    return Estimate(mu, _crossing(best, mu, -reach, edge), _crossing(best, mu, reach, edge), n)


def _lowest(f: Callable[[float], float], low: float, high: float) -> tuple[float, float]:
    """Return where a function of one hollow is lowest, and its value there."""
    found = load_scipy("optimize").minimize_scalar(
        f, bounds=(low, high), method="bounded", options={"xatol": 1e-9}
    )
    return float(found.x), float(found.fun)


def _crossing(f: Callable[[float], float], start: float, step: float, edge: float) -> float:
    """Return where a function that rises from `start` in the direction of step reaches an edge; infinite if
    that is beyond WIDEST steps.
    """
    near, far = start, start + step
    while f(far) < edge:
        near, far = far, far + (far - start)
        if abs(far - start) > abs(WIDEST * step):
            return inf if step > 0 else -inf
    return float(load_scipy("optimize").brentq(lambda x: f(x) - edge, near, far))
