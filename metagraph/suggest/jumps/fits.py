"""Distributions that are fitted to what neighbouring frames cost, beside Johnson's S_B: log-normal, Weibull,
gamma and beta.

Yang et al. (section 6) take S_B without saying why; how far each is off stands beside what it says. Shapes
are the likeliest, found by Newton's method; shares are integrals over a fine grid.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import lgamma, log, pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

from metagraph.suggest.jumps.johnson import JohnsonSB, fit_johnson

Array = NDArray[np.float64]

GRID = 20_001  # places at which a density is added up
STEPS = 60  # of Newton's method at most
MARGIN = 0.02  # of the values' range: bounds lie so far beyond them


@dataclass(frozen=True, slots=True)
class DistributionFit:
    """name: of the distribution. limit: the value that the asked share does not exceed. distance: the
    greatest difference of its shares and those of the values (Kolmogorov and Smirnov's D), 0..1. likelihood:
    mean log density of the values.
    """

    name: str
    limit: float
    distance: float
    likelihood: float


def fit_distributions(values: ArrayLike, level: float) -> tuple[DistributionFit, ...]:
    """Return what each distribution makes of values, the nearest first. level: the share asked for, 0..1.
    None if there are fewer than ten values or all are alike.
    """
    x = np.sort(np.asarray(values, np.float64).ravel())
    x = x[np.isfinite(x)]
    low, high = (float(x[0]), float(x[-1])) if len(x) else (0.0, 0.0)
    if len(x) < 10 or high - low < 1e-9:
        return ()
    margin = MARGIN * (high - low)
    begin, end = max(0.0, low - margin), high + margin
    positive = np.maximum(x, 1e-6 * high)
    inside = np.clip((x - begin) / (end - begin), 1e-6, 1 - 1e-6)
    tail = end + 3 * (high - low)
    grids = {
        "Johnson S_B": (begin, end, _johnson(fit_johnson(x, begin, end))),
        "log-normal": (0.0, tail, _log_normal(positive)),
        "Weibull": (0.0, tail, _weibull(positive)),
        "gamma": (0.0, tail, _gamma(positive)),
        "beta": (begin, end, _beta(inside, begin, end)),
    }
    out = [_told(name, x, level, *rest) for name, rest in grids.items()]
    return tuple(sorted(out, key=lambda f: f.distance))


def _told(
    name: str, x: Array, level: float, low: float, high: float, density: Callable[[Array], Array]
) -> DistributionFit:
    grid = np.linspace(low, high, GRID)
    middle = (grid[1:] + grid[:-1]) / 2
    parts = np.exp(density(middle)) * np.diff(grid)
    shares = np.concatenate([[0.0], np.cumsum(parts)])
    shares /= shares[-1]
    own = np.interp(x, grid, shares)
    n = len(x)
    distance = max(np.max(np.arange(1, n + 1) / n - own), np.max(own - np.arange(n) / n))
    likelihood = float(np.mean(density(np.clip(x, middle[0], middle[-1]))))
    return DistributionFit(name, float(np.interp(level, shares, grid)), float(distance), likelihood)


def _johnson(found: JohnsonSB) -> Callable[[Array], Array]:
    def density(x: Array) -> Array:
        u = np.clip((x - found.low) / (found.high - found.low), 1e-9, 1 - 1e-9)
        z = found.gamma + found.delta * (np.log(u) - np.log1p(-u))
        scale = log(found.delta / (found.high - found.low)) - 0.5 * log(2 * pi)
        return np.asarray(scale - np.log(u) - np.log1p(-u) - z * z / 2)

    return density


def _log_normal(x: Array) -> Callable[[Array], Array]:
    logs = np.log(x)
    mean, spread = float(logs.mean()), max(float(logs.std()), 1e-6)
    scale = -log(spread) - 0.5 * log(2 * pi)
    return lambda v: np.asarray(scale - np.log(v) - ((np.log(v) - mean) / spread) ** 2 / 2)


def _weibull(x: Array) -> Callable[[Array], Array]:
    logs = np.log(x)
    shape = 1.2 / max(float(logs.std()), 1e-6)
    for _ in range(STEPS):  # of the likelihood's slope by the shape
        powers = np.exp(shape * (logs - logs.max()))
        ratio = float((powers * logs).sum() / powers.sum())
        square = float((powers * logs * logs).sum() / powers.sum())
        step = (ratio - 1 / shape - float(logs.mean())) / (square - ratio * ratio + 1 / shape**2)
        shape = max(shape - step, shape / 3)
        if abs(step) < 1e-10 * shape:
            break
    scale = float(logs.max() + np.log(np.mean(np.exp(shape * (logs - logs.max())))) / shape)
    return lambda v: np.asarray(
        log(shape) - scale + (shape - 1) * (np.log(v) - scale) - np.exp(shape * (np.log(v) - scale))
    )


def _gamma(x: Array) -> Callable[[Array], Array]:
    gap = log(float(x.mean())) - float(np.log(x).mean())
    shape = (3 - gap + ((gap - 3) ** 2 + 24 * gap) ** 0.5) / (12 * max(gap, 1e-12))
    for _ in range(STEPS):
        step = (log(shape) - _digamma(shape) - gap) / (1 / shape - _trigamma(shape))
        shape = max(shape - step, shape / 3)
        if abs(step) < 1e-10 * shape:
            break
    scale = float(x.mean()) / shape
    rest = -shape * log(scale) - lgamma(shape)
    return lambda v: np.asarray(rest + (shape - 1) * np.log(v) - v / scale)


def _beta(u: Array, low: float, high: float) -> Callable[[Array], Array]:
    mean, spread = float(u.mean()), max(float(u.var()), 1e-12)
    first = max(mean * (1 - mean) / spread - 1, 1e-2)
    a, b = max(mean * first, 1e-2), max((1 - mean) * first, 1e-2)
    ups, downs = float(np.log(u).mean()), float(np.log1p(-u).mean())
    for _ in range(STEPS):
        slope = np.array([ups - _digamma(a) + _digamma(a + b), downs - _digamma(b) + _digamma(a + b)])
        both = _trigamma(a + b)
        bend = np.array([[both - _trigamma(a), both], [both, both - _trigamma(b)]])
        step = np.linalg.solve(bend, slope)
        a, b = max(a - float(step[0]), a / 3), max(b - float(step[1]), b / 3)
        if np.abs(step).max() < 1e-10 * max(a, b):
            break
    rest = lgamma(a + b) - lgamma(a) - lgamma(b) - log(high - low)

    def density(v: Array) -> Array:
        share = np.clip((v - low) / (high - low), 1e-9, 1 - 1e-9)
        return np.asarray(rest + (a - 1) * np.log(share) + (b - 1) * np.log1p(-share))

    return density


def _digamma(x: float) -> float:
    """The slope of log gamma: by its recurrence and, from 10 on, its asymptotic series (Abramowitz and
    Stegun, 6.3.18).
    """
    out = 0.0
    while x < 10:
        out -= 1 / x
        x += 1
    y = 1 / (x * x)
    return out + log(x) - 0.5 / x - y * (1 / 12 - y * (1 / 120 - y * (1 / 252 - y / 240)))


def _trigamma(x: float) -> float:
    """Its second derivative (6.4.12)."""
    out = 0.0
    while x < 10:
        out += 1 / (x * x)
        x += 1
    y = 1 / (x * x)
    return out + 1 / x + y / 2 + y / x * (1 / 6 - y * (1 / 30 - y * (1 / 42 - y / 30)))
