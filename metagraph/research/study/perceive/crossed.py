"""Logistic mixed models of choices by participant and item, whose deviations cross.

log odds = X b + u[participant] + v[item], u and v normal. The likelihood by Laplace's approximation, as
Breslow and Clayton (1993), "Approximate inference in generalized linear mixed models", describe it; intervals
from its curvature, with degrees of freedom by Satterthwaite's formula over the parts of an effect's variance,
so that five items are not taken for five hundred.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import inf, isfinite, lgamma, sqrt

import numpy as np
from numpy.typing import NDArray

from metagraph.research.study.statistics.distributions import compute_t_quantile, compute_t_two_sided
from metagraph.research.study.statistics.small_samples import LEVEL, Estimate

Array = NDArray[np.float64]
NOTHING = 0.02  # a deviation of log odds below which a group is reported as having none
FARTHEST = 12.0  # log odds beyond which a share is 0 or 1, and no model has an end


@dataclass(frozen=True)
class Crossed:
    """What was fitted. effects: by name, on log odds, with intervals; errors: their standard errors by the
    likelihood's curvature alone; p: of each being 0, two-sided; df: degrees of freedom. deviations: of
    participants and items, standard deviations of log odds. share: what the first effect says of all
    participants and items together, 0..1. deviance: minus twice the log likelihood. n: rows.
    """

    effects: Mapping[str, Estimate]
    errors: Mapping[str, float]
    p: Mapping[str, float]
    df: Mapping[str, float]
    deviations: Mapping[str, float]
    share: Estimate
    deviance: float
    n: int


def fit_crossed(
    chosen: Sequence[float],
    effects: Mapping[str, Sequence[float]],
    participants: Sequence[object],
    items: Sequence[object],
    tries: Sequence[float] | None = None,
    level: float = LEVEL,
) -> Crossed | None:
    """Return the model of `chosen` `[n]` of `tries` `[n]` (1 each unless told) by effects (name -> `[n]`, the
    constant first). None if all or none were chosen, where effects say the same, or where the likelihood has
    no end.
    """
    y = np.asarray(chosen, np.float64)
    m = np.ones(len(y)) if tries is None else np.asarray(tries, np.float64)
    x = np.stack([np.asarray(v, np.float64) for v in effects.values()], 1) if effects else np.zeros((0, 0))
    if not len(y) or not 0 < y.sum() < m.sum() or np.linalg.matrix_rank(x) < x.shape[1]:
        return None
    codes = [np.unique([str(g) for g in v], return_inverse=True)[1] for v in (participants, items)]
    model = _Model(y, m, x, codes)
    found = model.best()
    if found is None:
        return None
    at, deviance, free = found
    size = x.shape[1]
    cover = model.cover(at, free)
    if cover is None:
        return None
    beta, spread = at[:size], np.abs(at[size:])
    out, p, dfs = {}, {}, {}
    for n, name in enumerate(effects):
        variance, df = model.freedom(x[:, n], float(cover[n, n]), spread)
        error = sqrt(variance)
        half = compute_t_quantile((1 + level) / 2, df) * error
        value = float(beta[n])
        out[name] = Estimate(value, value - half, value + half, len(y))
        p[name], dfs[name] = compute_t_two_sided(value / error, df), df
    first = next(iter(out.values()))
    total = float(np.hypot(*spread))
    assert first.low is not None and first.high is not None
    share = Estimate(
        compute_overall_share(first.value, total),
        compute_overall_share(first.low, total),
        compute_overall_share(first.high, total),
        len(y),
    )
    return Crossed(
        out,
        {name: sqrt(float(cover[n, n])) for n, name in enumerate(effects)},
        p,
        dfs,
        {"participants": float(spread[0]), "items": float(spread[1])},
        share,
        deviance + model.constant,
        len(y),
    )


def compute_overall_share(value: float, spread: float) -> float:
    """Return the share of all together where log odds are normal about a value (Gauss and Hermite)."""
    nodes, weights = _nodes()
    return float((weights / (1 + np.exp(-(value + spread * nodes)))).sum() / weights.sum())


@lru_cache(maxsize=1)
def _nodes() -> tuple[Array, Array]:
    nodes, weights = np.polynomial.hermite_e.hermegauss(40)
    return np.asarray(nodes, np.float64), np.asarray(weights, np.float64)


class _Model:
    """Minus twice the log likelihood of effects and two deviations."""

    def __init__(self, y: Array, m: Array, x: Array, codes: Sequence[NDArray[np.intp]]) -> None:
        self.y, self.m, self.x, self.codes = y, m, x, codes
        self.sizes = [int(c.max(initial=0)) + 1 for c in codes]
        self.start: tuple[Array, Array] = (np.zeros(self.sizes[0]), np.zeros(self.sizes[1]))
        self.constant = -2 * float(sum(_log_ways(int(a), int(b)) for a, b in zip(y, m, strict=True)))

    def deviance(self, at: Array) -> float:
        """Return it by Laplace, without the constant; at: effects, then both deviations."""
        fixed = self.x @ at[: self.x.shape[1]]
        s, t = (float(v) for v in at[self.x.shape[1] :])
        (a, b), (p, i) = self.codes, self.sizes
        u, v = self.start
        before, step, old_u, old_v = inf, 1.0, u, v
        for _ in range(60):
            eta = fixed + s * u[a] + t * v[b]
            lost = self._lost(eta, u, v)
            if lost > before + 1e-9 and step > 1e-6:  # too far: half way back
                step /= 2
                u, v = (u + old_u) / 2, (v + old_v) / 2
                continue
            done, before, step = before - lost < 1e-11 * (1 + abs(lost)), lost, 1.0
            mu = 1 / (1 + np.exp(-np.clip(eta, -40, 40)))
            w, r = self.m * mu * (1 - mu), self.y - self.m * mu
            top = s * s * np.bincount(a, w, p) + 1
            low = t * t * np.bincount(b, w, i) + 1
            across = s * t * np.bincount(a * i + b, w, p * i).reshape(p, i)
            g, h = s * np.bincount(a, r, p) - u, t * np.bincount(b, r, i) - v
            schur = np.diag(low) - across.T @ (across / top[:, None])
            if done:
                break
            dv = np.linalg.solve(schur, h - across.T @ (g / top))
            old_u, old_v = u, v
            u, v = u + (g - across @ dv) / top, v + dv
        self.start = u, v
        return lost + float(np.log(top).sum()) + float(np.linalg.slogdet(schur)[1])

    def _lost(self, eta: Array, u: Array, v: Array) -> float:
        likely = self.y * eta - self.m * np.logaddexp(0, eta)
        return float(-2 * likely.sum() + u @ u + v @ v)

    def best(self) -> tuple[Array, float, list[int]] | None:
        """Return where it is lowest, how low, and which of its places are free: a deviation that is none is
        not. None if it has no end.
        """
        size = self.x.shape[1]
        there = [k for k, n in enumerate(self.sizes) if 1 < n < len(self.y) or (n > 1 and self.m.max() > 1)]
        at = np.concatenate([np.linalg.lstsq(self.x, self._rough(), rcond=None)[0], [0.0, 0.0]])
        free = [*range(size), *(size + k for k in there)]
        at[[size + k for k in there]] = 0.5
        found = _descend(self.deviance, at, free)
        for k in there:
            if abs(found[0][size + k]) < 10 * NOTHING:
                bare = found[0].copy()
                bare[size + k] = 0.0
                less = _descend(self.deviance, bare, [n for n in free if n != size + k])
                if less[1] <= found[1] + 1e-4 or abs(found[0][size + k]) < NOTHING:
                    found, free = less, [n for n in free if n != size + k]
        if not isfinite(found[1]) or float(np.abs(found[0]).max()) > FARTHEST:
            return None
        return found[0], found[1], free

    def _rough(self) -> Array:
        """Return log odds to begin from."""
        return np.asarray(np.log((self.y + 0.5) / (self.m - self.y + 0.5)), np.float64)

    def cover(self, at: Array, free: Sequence[int]) -> Array | None:
        """Return covariances of the effects; None if the likelihood is flat."""
        _, curved = _slopes(self.deviance, at, free)
        try:
            out = np.asarray(2 * np.linalg.inv(curved), np.float64)
        except np.linalg.LinAlgError:
            return None
        size = self.x.shape[1]
        return out[:size, :size] if bool((np.diag(out)[:size] > 0).all()) else None

    def freedom(self, column: Array, variance: float, spread: Array) -> tuple[float, float]:
        """Return an effect's variance and degrees of freedom. It is made of what participants, items and
        single answers do, each known from as many as there are; the likelihood takes the first two for
        smaller than they are, by one of their number. What changes within a group alone owes it nothing.
        """
        parts: list[tuple[float, float]] = []
        for code, count, s in zip(self.codes, self.sizes, spread.tolist(), strict=True):
            if s <= 0 or count < 2:
                continue
            sums = np.bincount(code, column * self.m, count)
            weigh = float((sums * sums).sum()) / max(float((column * column * self.m).sum()) ** 2, 1e-300)
            parts.append((s * s * weigh, count - 1.0))
        known = sum(v for v, _ in parts)
        if known > variance:  # an approximation: no more than all of it
            parts, known = [(v * variance / known, d) for v, d in parts], variance
        rest = (variance - known, max(1.0, float(self.m.sum()) - self.x.shape[1]))
        parts = [*((v * (d + 1) / d, d) for v, d in parts), rest]
        total = sum(v for v, _ in parts)
        return total, max(1.0, total**2 / max(sum(v * v / d for v, d in parts), 1e-300))


def _log_ways(k: int, n: int) -> float:
    return lgamma(n + 1) - lgamma(k + 1) - lgamma(n - k + 1)


STEP = 2e-3  # of a finite difference, log odds


def _slopes(f: Callable[[Array], float], at: Array, free: Sequence[int]) -> tuple[Array, Array]:
    """Return slopes and curvature by central differences, along the free places."""
    size = len(free)
    moves = np.eye(len(at))[list(free)] * STEP
    here = f(at)
    ends = [(f(at + d), f(at - d)) for d in moves]
    slopes = np.array([(a - b) / (2 * STEP) for a, b in ends])
    curved = np.diag([(a + b - 2 * here) / STEP**2 for a, b in ends])
    for i in range(size):
        for j in range(i):
            both = f(at + moves[i] + moves[j]) - 2 * here + f(at - moves[i] - moves[j])
            one = ends[i][0] + ends[i][1] + ends[j][0] + ends[j][1] - 4 * here
            curved[i, j] = curved[j, i] = (both - one) / (2 * STEP**2)
    return slopes, np.asarray(curved, np.float64)


def _descend(f: Callable[[Array], float], start: Array, free: Sequence[int]) -> tuple[Array, float]:
    """Return where a function is lowest along the free places, and how low; by Newton's steps, shortened
    where they lead up.
    """
    at, low, damp = start.copy(), f(start), 1e-3
    for _ in range(40):
        slopes, curved = _slopes(f, at, free)
        values, vectors = np.linalg.eigh(curved)
        for _ in range(12):
            step = vectors @ ((vectors.T @ slopes) / (np.abs(values) + damp))
            tried = at.copy()
            tried[list(free)] -= np.clip(step, -1.5, 1.5)
            new = f(tried)
            if new < low:
                break
            damp = max(damp * 8, 1e-2)
        else:
            break
        gained, at, low, damp = low - new, tried, new, damp / 8
        if gained < 1e-8 or float(np.abs(at).max()) > 2 * FARTHEST:
            break
    return at, low
