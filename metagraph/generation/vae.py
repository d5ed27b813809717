"""From poses to codes and back: a variational autoencoder, or principal components; and what comes next of
codes by a linear guess.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.generation.layers import Layers, apply_linear, relu
from metagraph.generation.networks import FlowSizes, Weights
from metagraph.generation.prepared import Dense

Array = NDArray[Any]
FLOOR = 1e-6  # deviation of a component at least


def encode_spans(w: Layers, sizes: FlowSizes, poses: Array) -> Array:
    """Return codes `[..., D]` as the flow sees them. poses: `[..., span X]`, standardised."""
    if sizes.code == "none":
        return poses
    if sizes.code == "pca":
        return np.asarray((poses - w["code.mean"]) @ w["code.basis"].T / w["code.deviation"])
    code = apply_linear(w, "encode.2", relu(apply_linear(w, "encode.0", poses)))[..., : sizes.dims]
    return np.asarray((code - w["code.mean"]) / w["code.deviation"])


def decode_spans(w: Layers, sizes: FlowSizes, codes: Array) -> Array:
    """Return poses `[..., span X]`, standardised, of codes `[..., D]` as the flow gives them."""
    if sizes.code == "none":
        return codes
    code = codes * w["code.deviation"]
    if sizes.code == "pca":
        return np.asarray(code @ w["code.basis"] + w["code.mean"])
    return apply_linear(w, "decode.2", relu(apply_linear(w, "decode.0", code + w["code.mean"])))


class Decoder:
    """From codes to poses, frame by frame."""

    def __init__(self, w: Layers, sizes: FlowSizes) -> None:
        self._layers: list[Dense] = []
        if sizes.code == "pca":
            self._layers = [Dense(w["code.deviation"][:, None] * w["code.basis"], w["code.mean"])]
        elif sizes.code != "none":
            first = w["decode.0.weight"].T
            inner = Dense(w["code.deviation"][:, None] * first, w["decode.0.bias"] + w["code.mean"] @ first)
            self._layers = [inner, Dense.named(w, "decode.2")]

    def one(self, code: Array) -> Array:
        """Return the poses `[span X]` of a code `[D]`, as `decode` does; they last until the next call."""
        for n, layer in enumerate(self._layers):
            code = layer.one(np.maximum(code, 0, out=code) if n else code)
        return code


class Lengths:
    """How long what a guess lacks is as a flow draws it, and in takes (`calibration`). A length between two
    knots is brought to between theirs, one beyond all is made longer as the last one is.
    """

    def __init__(self, drawn: Array, true: Array) -> None:
        self.used = bool(len(drawn)) and float(drawn[0]) > 0  # else nothing is known yet
        zero = np.zeros(1)
        self._drawn, self._true = (np.concatenate([zero, x]).astype(np.float64) for x in (drawn, true))

    def find_share(self, length: float) -> float:
        """Return what numbers that are so long as drawn are multiplied by."""
        if not self.used or length <= 0:
            return 1.0
        if length >= self._drawn[-1]:
            return float(self._true[-1] / self._drawn[-1])
        return float(np.interp(length, self._drawn, self._true) / length)

    def undo(self, lacked: Array) -> tuple[Array, Array]:
        """Return what a flow would have drawn `[..., D]` for numbers as takes have them, and the natural
        logarithm of the determinant of the way back `[...]`.
        """
        if not self.used:
            return lacked, np.zeros(lacked.shape[:-1], lacked.dtype)
        long = np.linalg.norm(lacked.astype(np.float64), axis=-1)
        n = np.clip(np.searchsorted(self._true, long, side="right"), 1, len(self._true) - 1)
        steep = (self._drawn[n] - self._drawn[n - 1]) / (self._true[n] - self._true[n - 1])
        beyond = long >= self._true[-1]
        last = self._drawn[-1] / self._true[-1]
        drawn = np.where(beyond, long * last, self._drawn[n - 1] + (long - self._true[n - 1]) * steep)
        steep = np.where(beyond, last, steep)
        share = drawn / np.maximum(long, 1e-12)
        logs = (lacked.shape[-1] - 1) * np.log(np.maximum(share, 1e-12)) + np.log(steep)
        return np.asarray(lacked * share[..., None], lacked.dtype), np.asarray(logs, lacked.dtype)


class Guess:
    """What comes next by a linear guess from past codes, and what it lacks."""

    def __init__(self, w: Layers, dtype: Any = np.float32) -> None:
        spread = np.tril(w["guess.spread"]).astype(np.float64)
        self._next = Dense.named(w, "guess")
        self._lacked = Dense(spread.T, np.zeros(len(spread)), dtype)
        self._weight, self._bias = w["guess.weight"].T, w["guess.bias"]
        self._inverse = np.linalg.inv(spread).T.astype(dtype)
        none = np.zeros(0)
        self.lengths = Lengths(w.get("guess.drawn", none), w.get("guess.true", none))
        self.log_spread = float(np.log(np.abs(np.diag(spread))).sum())

    def one(self, past: Array, lacked: Array) -> Array:
        """Return the next code `[D]`, which lasts until the next call. past: `[past D]`; lacked: `[D]`, as
        the flow gives it.
        """
        code = self._next.one(past)
        code += self._lacked.one(lacked)
        return code

    def find_lacked(self, codes: Array, past: Array) -> Array:
        """Return what the guess lacks `[..., D]` of codes `[..., D]`. past: `[..., past D]`."""
        return np.asarray((codes - past @ self._weight - self._bias) @ self._inverse)


def fit_guess(takes: Iterable[Array], past: int, ridge: float) -> Weights:
    """Return the guess by least squares, float32. takes: codes `[n, D]` in a row; past: how many a guess
    goes on from; ridge: deviation of the noise that each of them counts as having, without which a guess
    would trust what is lost. Raises ValueError if they are too few.
    """
    told, wanted = [], []
    for codes in takes:
        if len(codes) > past:
            told.append(join_past(codes, past))
            wanted.append(codes[past:])
    count = sum(map(len, wanted))
    if not count or count <= past * wanted[0].shape[1]:
        raise ValueError(f"{count} stretches are too few for a guess from {past} codes: give more takes")
    x, y = np.concatenate(told).astype(np.float64), np.concatenate(wanted).astype(np.float64)
    mean_x, mean_y = x.mean(0), y.mean(0)
    x, y = x - mean_x, y - mean_y
    weight = np.linalg.solve(x.T @ x + ridge**2 * len(x) * np.eye(x.shape[1]), x.T @ y)
    lacked = y - x @ weight
    spread = np.linalg.cholesky(lacked.T @ lacked / len(y) + FLOOR * np.eye(y.shape[1]))
    parts = {"weight": weight.T, "bias": mean_y - mean_x @ weight, "spread": spread}
    return {f"guess.{name}": part.astype(np.float32) for name, part in parts.items()}


def join_past(codes: Array, past: int) -> Array:
    """Return the codes before each of `[n, D]` but the first `past`, flat, oldest first: `[n - past, past
    D]`.
    """
    count = len(codes) - past
    return np.concatenate([codes[k : k + count] for k in range(past)], 1)


def count_effective_dimensions(codes: Array) -> float:
    """Return how many numbers of codes `[n, D]` vary by themselves, 1..D: e to the entropy of the shares
    that the eigenvalues of their covariance have of its trace.
    """
    values = np.linalg.eigvalsh(np.cov(codes, rowvar=False).reshape(codes.shape[1], -1))
    shares = np.maximum(values, 1e-12) / np.maximum(values, 1e-12).sum()
    return float(np.exp(-(shares * np.log(shares)).sum()))


def list_spans(poses: Array, span: int) -> Array:
    """Return `[T // span, span X]`: every `span` frames in a row, flat; what is over at the end is left
    out.
    """
    count = len(poses) // span
    return np.asarray(poses[: count * span].reshape(count, -1))


def find_principal_components(rows: Array, dims: int, prefix: str) -> Weights:
    """Return mean, basis and deviation of the first principal components, in closed form, float32. rows: `[N,
    M]`. Signs are such that each component's largest number is positive, so that the same rows give the same
    basis. Raises ValueError if there are fewer rows than components.
    """
    if len(rows) <= dims:
        raise ValueError(f"{len(rows)} stretches are too few for {dims} components: give more takes")
    rows = np.asarray(rows, np.float64)
    mean = rows.mean(0)
    variances, vectors = np.linalg.eigh(
        np.cov(rows - mean, rowvar=False, bias=True).reshape(rows.shape[1], -1)
    )
    basis = vectors[:, ::-1][:, :dims].T
    largest = np.take_along_axis(basis, np.abs(basis).argmax(1)[:, None], 1)
    basis = basis * np.where(largest < 0, -1.0, 1.0)
    deviation = np.sqrt(np.maximum(variances[::-1][:dims], FLOOR**2))
    parts = {"mean": mean, "basis": basis, "deviation": deviation}
    return {f"{prefix}.{name}": part.astype(np.float32) for name, part in parts.items()}
