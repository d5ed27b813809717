"""Student's t distribution and its noncentral form, from the incomplete beta function: what intervals and
power need of SciPy.
"""

from __future__ import annotations

from functools import lru_cache
from math import copysign, erfc, exp, inf, lgamma, log, log1p, pi, sqrt
from statistics import NormalDist

import numpy as np

TINY = 1e-300
STEPS = 20_000  # of the continued fraction; a few dozen are usual
NODES, WEIGHTS = np.polynomial.legendre.leggauss(20)


def compute_incomplete_beta(a: float, b: float, x: float) -> float:
    """Return the regularised incomplete beta function I_x(a, b), 0..1; a, b > 0 (Lentz's continued fraction,
    DLMF 8.17.22).
    """
    if x <= 0 or x >= 1:
        return 0.0 if x <= 0 else 1.0
    front = exp(lgamma(a + b) - lgamma(a) - lgamma(b) + a * log(x) + b * log1p(-x))
    if x > (a + 1) / (a + b + 2):  # there the fraction of the other end converges quickly
        return 1 - front * _fraction(b, a, 1 - x) / b
    return front * _fraction(a, b, x) / a


def _fraction(a: float, b: float, x: float) -> float:
    c, d = 1.0, 1 - (a + b) * x / (a + 1)
    d = 1 / (d if abs(d) > TINY else TINY)
    out = d
    for m in range(1, STEPS):
        for step in (
            m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m)),
            -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1)),
        ):
            d = 1 + step * d
            d = 1 / (d if abs(d) > TINY else TINY)
            c = 1 + step / c
            c = c if abs(c) > TINY else TINY
            out *= d * c
        if abs(d * c - 1) < 1e-16:
            break
    return out


def compute_t_two_sided(t: float, df: float) -> float:
    """Return how likely a t at least as far from 0 is; df > 0."""
    if abs(t) == inf:
        return 0.0
    square = t * t
    return (
        compute_incomplete_beta(df / 2, 0.5, df / (df + square))
        if square > 1
        else 1 - compute_incomplete_beta(0.5, df / 2, square / (df + square))
    )


def compute_t_cdf(t: float, df: float) -> float:
    """Return the share of Student's distribution up to t."""
    tail = compute_t_two_sided(t, df) / 2
    return tail if t < 0 else 1 - tail


@lru_cache(maxsize=4096)
def compute_t_quantile(share: float, df: float) -> float:
    """Return the t that a share of Student's distribution does not exceed. Raises ValueError unless 0 < share
    < 1 and df > 0.
    """
    if not 0 < share < 1 or not df > 0:
        raise ValueError(f"there is no t of a share of {share} with {df} degrees of freedom")
    if share == 0.5:
        return 0.0
    tail = 2 * min(share, 1 - share)
    low, high = 0.0, max(1.0, -NormalDist().inv_cdf(tail / 2))
    while compute_t_two_sided(high, df) > tail:
        low, high = high, 2 * high
    t = (low + high) / 2
    scale = exp(lgamma((df + 1) / 2) - lgamma(df / 2)) / sqrt(pi * df)
    for _ in range(200):
        off = compute_t_two_sided(t, df) - tail
        low, high = (t, high) if off > 0 else (low, t)
        step = t + off / (2 * scale * exp(-(df + 1) / 2 * log1p(t * t / df)))
        after = step if low < step < high else (low + high) / 2
        if abs(after - t) <= 1e-15 * t or high - low <= 1e-15 * high:
            break
        t = after
    return copysign(t, share - 0.5)


def compute_t_noncentral(t: float, df: float, shift: float) -> float:
    """Return the share of the noncentral t distribution up to t: of (Z + shift) / S, with S^2 a chi-squared
    over df.

    The mean over S of the normal share of t S - shift, by Gauss's rule on pieces that hold where it steps.
    """
    width = 12 / sqrt(2 * df)
    edges = {
        max(0.0, 1 - width),
        1.0,
        1 + width,
        *(1 + width * k / 4 for k in range(-3, 4) if 1 + width * k / 4 > 0),
    }
    edges |= {
        s for s in (1e-4, 1e-3, 1e-2, 0.1) if s > 1 - width
    }  # near 0 a broken power of S is no polynomial
    if t != 0:
        edges |= {
            s for k in (-8, -4, -1, 0, 1, 4, 8) if max(0.0, 1 - width) < (s := (shift + k) / t) < 1 + width
        }
    cuts = np.array(sorted(edges))
    middle, half = (cuts[1:] + cuts[:-1]) / 2, np.diff(cuts) / 2
    s = (middle[:, None] + half[:, None] * NODES).ravel()
    w = (half[:, None] * WEIGHTS).ravel()
    dense = np.exp(log(2) + df / 2 * log(df / 2) - lgamma(df / 2) + (df - 1) * np.log(s) - df * s * s / 2)
    below = np.array([erfc((shift - t * v) / sqrt(2)) / 2 for v in s.tolist()])
    return float(min(1.0, max(0.0, (w * dense * below).sum())))
