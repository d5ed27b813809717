"""From poses to codes and back: the frame's autoencoder, or principal components."""

from __future__ import annotations

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
    code = apply_linear(w, "encode.2", relu(apply_linear(w, "encode.0", poses)))
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
        elif sizes.code == "autoencoder":
            first = w["decode.0.weight"].T
            inner = Dense(w["code.deviation"][:, None] * first, w["decode.0.bias"] + w["code.mean"] @ first)
            self._layers = [inner, Dense.named(w, "decode.2")]

    def one(self, code: Array) -> Array:
        """Return the poses `[span X]` of a code `[D]`, as `decode` does; they last until the next call."""
        for n, layer in enumerate(self._layers):
            code = layer.one(np.maximum(code, 0, out=code) if n else code)
        return code


def list_spans(poses: Array, span: int) -> Array:
    """Return `[T // span, span X]`: every `span` frames in a row, flat; what is over at the end is left
    out.
    """
    count = len(poses) // span
    return np.asarray(poses[: count * span].reshape(count, -1))


def principal(rows: Array, dims: int, prefix: str) -> Weights:
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
