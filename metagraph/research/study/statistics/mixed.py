"""Linear mixed models of small studies: fixed effects, and deviations of groups (people, sites) about them.

y = X b + sum over k of u_k[group of k] + e. Variances by restricted maximum likelihood (Patterson and
Thompson 1971), or by maximum likelihood; degrees of freedom of each effect by Satterthwaite's approximation
(1946), as Fai and Cornelius (1996) compute it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import log, pi, sqrt

import numpy as np
from numpy.typing import NDArray

from metagraph.research.study.statistics.distributions import compute_t_quantile, load_scipy
from metagraph.research.study.statistics.small_samples import LEVEL, Estimate

Array = NDArray[np.float64]
EXACTLY = 1e-12  # of all variance, what is left below which rows fit exactly, and nothing can be estimated
FEW_ROWS = 40  # that share groups, beyond which sums by group are less work than the rows' covariances
NOTHING = 1e-4  # a deviation beside that of the rest below which a group is reported as having none


@dataclass(frozen=True)
class Mixed:
    """What was fitted. effects: by name, with t intervals; df: their degrees of freedom. deviations: of each
    sort of group, then `rest`; standard deviations. left_out: effects that the others already say, or that
    never vary. deviance: minus twice the (restricted) log likelihood. n: rows.
    """

    effects: Mapping[str, Estimate]
    df: Mapping[str, float]
    deviations: Mapping[str, float]
    left_out: tuple[str, ...]
    deviance: float
    n: int


def fit_mixed(
    y: Sequence[float],
    effects: Mapping[str, Sequence[float]],
    groups: Mapping[str, Sequence[object]],
    restricted: bool = True,
    level: float = LEVEL,
) -> Mixed | None:
    """Return the model of y `[n]` by effects (name -> `[n]`, the constant among them) and groups (name ->
    whose each row is, `[n]`). None if there are no more rows than effects, or where these and the groups say
    all. Effects that others already say are left out, the later one of them; so are groups that have a row
    each.
    """
    values = np.asarray(y, np.float64)
    kept, left_out = _independent({k: np.asarray(v, np.float64) for k, v in effects.items()}, len(values))
    x = (
        np.stack([np.asarray(effects[k], np.float64) for k in kept], 1)
        if kept
        else np.zeros((len(values), 0))
    )
    codes = {k: np.unique([str(g) for g in v], return_inverse=True)[1] for k, v in groups.items()}
    codes = {k: c for k, c in codes.items() if 1 < int(c.max(initial=0)) + 1 < len(c)}
    if len(values) <= x.shape[1] or not kept:
        return None
    model = _Model(values, x, list(codes.values()), restricted)
    ratios = model.best()
    scale, beta, cover, deviance = model.solved(ratios)
    if scale <= EXACTLY * max(float(values.var()), 1e-300):
        return None
    there = [k for k, r in zip(codes, ratios, strict=True) if r > NOTHING]
    slim = _Model(values, x, [codes[k] for k in there], restricted)
    freedom = slim.freedom([r for r in ratios.tolist() if r > NOTHING], scale)
    found: dict[str, Estimate] = {}
    for n, name in enumerate(kept):
        value, error = float(beta[n]), sqrt(float(cover[n, n]))
        half = compute_t_quantile((1 + level) / 2, freedom[n]) * error if freedom[n] > 0 else None
        found[name] = (
            Estimate(value, None, None, len(values))
            if half is None
            else Estimate(value, value - half, value + half, len(values))
        )
    spread = {k: float(r) * sqrt(scale) for k, r in zip(codes, ratios, strict=True)}
    return Mixed(
        found,
        dict(zip(kept, freedom, strict=True)),
        {**spread, "rest": sqrt(scale)},
        tuple(left_out),
        deviance,
        len(values),
    )


def _independent(columns: Mapping[str, Array], rows: int) -> tuple[list[str], list[str]]:
    """Return which columns say something that those before do not, and which do not."""
    basis: list[Array] = []
    kept, left_out = [], []
    for name, column in columns.items():
        rest = column.astype(np.float64).copy()
        for b in basis:
            rest -= b * float(b @ rest)
        size, own = float(np.linalg.norm(column)), float(np.linalg.norm(rest))
        if own <= 1e-8 * max(size, 1e-300) or not rows:
            left_out.append(name)
        else:
            basis.append(rest / own)
            kept.append(name)
    return kept, left_out


class _Tall:
    """Many rows that share few groups, as groups that cross do: all that is needed of them is sums by group
    (Woodbury's identity), whose number counts, not the rows'.
    """

    def __init__(self, y: Array, x: Array, codes: Sequence[NDArray[np.intp]]) -> None:
        """y `[m]`, x `[m, p]`, codes: of each sort of group `[m]`."""
        both = np.concatenate([x, y[:, None]], 1)
        columns = [np.unique(c, return_inverse=True)[1] for c in codes]
        z = np.concatenate([np.eye(int(c.max()) + 1)[c] for c in columns], 1)
        self.rows = len(y)
        self.sort = np.concatenate([np.full(int(c.max()) + 1, k) for k, c in enumerate(columns)])
        self.inner, self.across, self.plain = z.T @ z, z.T @ both, both.T @ both

    def sums(self, scale: float, variances: Array) -> tuple[float, Array]:
        """Return log |V|, and [x y]'V^-1 [x y] `[p + 1, p + 1]`."""
        d = np.sqrt(variances[self.sort] / scale)
        low = np.linalg.cholesky(np.eye(len(d)) + d[:, None] * self.inner * d)
        w = np.linalg.solve(low, d[:, None] * self.across)
        logs = self.rows * log(scale) + 2 * float(np.log(np.diagonal(low)).sum())
        return logs, np.asarray((self.plain - w.T @ w) / scale, np.float64)


class _Model:
    """The likelihood of deviations of groups, as ratios to that of the rest. Rows that share no group are
    computed apart, those of as many rows at once.
    """

    def __init__(self, y: Array, x: Array, codes: Sequence[NDArray[np.intp]], restricted: bool) -> None:
        self.n, self.p, self.k, self.restricted = len(y), x.shape[1], len(codes), restricted
        self.pieces: list[tuple[Array, Array, Array]] = []  # y [B, m], x [B, m, p], same group [K, B, m, m]
        self.tall: list[_Tall] = []
        by_size: dict[int, list[NDArray[np.intp]]] = {}
        for rows in _apart(len(y), codes):
            if self.k and sum(len(np.unique(c[rows])) for c in codes) < len(rows) > FEW_ROWS:
                self.tall.append(_Tall(y[rows], x[rows], [c[rows] for c in codes]))
                continue
            by_size.setdefault(len(rows), []).append(rows)
        for blocks in by_size.values():
            at = np.stack(blocks)
            same = np.zeros((self.k, *at.shape, at.shape[1]))
            for k, c in enumerate(codes):
                same[k] = c[at][:, :, None] == c[at][:, None, :]
            self.pieces.append((y[at], x[at], same))

    def sums(self, scale: float, variances: Array) -> tuple[float, Array, Array, float]:
        """Return log |V|, X'V^-1 X, X'V^-1 y and y'V^-1 y of V = scale I + sum of variances same."""
        logs, quad = 0.0, 0.0
        xx, xy = np.zeros((self.p, self.p)), np.zeros(self.p)
        for piece in self.tall:
            log_size, both = piece.sums(scale, variances)
            logs, quad = logs + log_size, quad + float(both[-1, -1])
            xx, xy = xx + both[:-1, :-1], xy + both[:-1, -1]
        for y, x, same in self.pieces:
            v = scale * np.eye(y.shape[1]) + np.tensordot(variances, same, 1)
            low = np.linalg.cholesky(v)
            solved = np.linalg.solve(low, np.concatenate([x, y[:, :, None]], 2))
            a, b = solved[:, :, :-1], solved[:, :, -1]
            logs += 2 * float(np.log(np.diagonal(low, axis1=1, axis2=2)).sum())
            xx += np.einsum("bmp,bmq->pq", a, a)
            xy += np.einsum("bmp,bm->p", a, b)
            quad += float((b * b).sum())
        return logs, xx, xy, quad

    def profiled(self, ratios: Array) -> float:
        """Return the deviance where the rest's deviation is the best one for these ratios."""
        return self.solved(ratios)[3]

    def solved(self, ratios: Array) -> tuple[float, Array, Array, float]:
        """Return the rest's variance, effects `[p]`, their covariances `[p, p]`, the deviance."""
        logs, xx, xy, quad = self.sums(1.0, np.asarray(ratios) ** 2)
        beta: Array = np.asarray(np.linalg.solve(xx, xy), np.float64)
        left = max(quad - float(xy @ beta), 1e-300)
        free = self.n - self.p if self.restricted else self.n
        scale = left / free
        deviance = logs + free * (1 + log(2 * pi * scale))
        if self.restricted:
            deviance += float(np.linalg.slogdet(xx)[1])
        return scale, beta, np.asarray(scale * np.linalg.inv(xx), np.float64), deviance

    def best(self) -> Array:
        """Return the ratios of lowest deviance, none below 0."""
        if not self.k:
            return np.zeros(0)
        starts = [np.full(self.k, s) for s in (0.1, 1.0, 5.0)]
        minimize, closely = load_scipy("optimize").minimize, {"xatol": 1e-8, "fatol": 1e-12}
        tries = [
            minimize(lambda r: self.profiled(np.abs(r)), s, method="Nelder-Mead", options=closely)
            for s in starts
        ]
        ratios: Array = np.abs(min(tries, key=lambda found: float(found.fun)).x)
        least = self.profiled(ratios)
        for k in range(self.k):  # nothing is likelier than next to nothing
            without = ratios.copy()
            without[k] = 0.0
            if ratios[k] < 0.05 and self.profiled(without) <= least + 1e-7:
                ratios = without
        return ratios

    def freedom(self, ratios: Sequence[float], scale: float) -> list[float]:
        """Return Satterthwaite's degrees of freedom of each effect."""
        if not self.k:
            return [float(self.n - self.p)] * self.p
        at = np.array([scale, *(scale * r * r for r in ratios)])

        def lost(v: Array) -> float:
            logs, xx, xy, quad = self.sums(v[0], v[1:])
            out = logs + quad - float(xy @ np.linalg.solve(xx, xy))
            return out + float(np.linalg.slogdet(xx)[1]) if self.restricted else out

        def spreads(v: Array) -> Array:
            return np.asarray(np.diagonal(np.linalg.inv(self.sums(v[0], v[1:])[1])))

        step = 1e-3 * at
        curved = np.empty((len(at), len(at)))
        for i in range(len(at)):
            for j in range(i + 1):
                one, other = np.eye(len(at))[i] * step, np.eye(len(at))[j] * step
                around = lost(at + one + other) + lost(at - one - other)
                around -= lost(at + one - other) + lost(at - one + other)
                curved[i, j] = curved[j, i] = around / (4 * step[i] * step[j])
        slopes = np.stack([(spreads(at + d) - spreads(at - d)) / (2 * d.max()) for d in np.diag(step)])
        try:
            cover = 2 * np.linalg.inv(curved)
        except np.linalg.LinAlgError:
            return [0.0] * self.p
        here = spreads(at)
        out = []
        for n in range(self.p):
            spread = float(slopes[:, n] @ cover @ slopes[:, n])
            out.append(min(float(self.n), 2 * float(here[n]) ** 2 / spread) if spread > 0 else 0.0)
        return out


def _apart(n: int, codes: Sequence[NDArray[np.intp]]) -> list[NDArray[np.intp]]:
    """Return the rows in sets that share no group with each other."""
    label = np.arange(n)
    for _ in range(n):
        before = label.copy()
        for c in codes:
            least = np.full(int(c.max(initial=0)) + 1, n)
            np.minimum.at(least, c, label)
            label = np.minimum(label, least[c])
        if (label == before).all():
            break
    return [np.flatnonzero(label == k) for k in np.unique(label)]
