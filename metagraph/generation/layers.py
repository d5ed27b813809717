"""Layers in NumPy: linear, convolution over time, LSTM, layer norm, attention. Weights are named and shaped
as `networks` says; each function takes them with the name of its layer. Whatever float the weights are, sums
are made in.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]
Layers = Mapping[str, Array]
State = list[tuple[Array, Array]]  # hidden and cell of each layer, `[..., N]`


def relu(x: Array) -> Array:
    return np.maximum(x, 0)


def sigmoid(x: Array) -> Array:
    """Return 1 / (1 + e^-x), without overflow."""
    return np.asarray(0.5 * np.tanh(0.5 * x) + 0.5, x.dtype)


def silu(x: Array) -> Array:
    return np.asarray(x * sigmoid(x))


def gelu(x: Array) -> Array:
    """Return the Gaussian error linear unit, as approximated by tanh."""
    inner = np.asarray(0.7978845608028654, x.dtype) * (x + np.asarray(0.044715, x.dtype) * x * x * x)
    return np.asarray(np.asarray(0.5, x.dtype) * x * (1 + np.tanh(inner)))


def linear(w: Layers, name: str, x: Array) -> Array:
    """Return `[..., out]` of `[..., in]`."""
    weight = w[f"{name}.weight"]
    flat = x.reshape(-1, x.shape[-1]) if x.ndim > 2 else x  # one product, not one for each of a batch
    return np.asarray((flat @ weight.T).reshape(*x.shape[:-1], len(weight)) + w[f"{name}.bias"])


def conv1d(w: Layers, name: str, x: Array, dilation: int = 1) -> Array:
    """Return `[..., T - (width - 1) dilation, out]` of `[..., T, in]`: a convolution over time, unpadded."""
    weight = w[f"{name}.weight"]
    width = weight.shape[2]
    left = x.shape[-2] - (width - 1) * dilation
    if left < 1:
        raise ValueError(
            f"{x.shape[-2]} frames are too few for a convolution over {1 + (width - 1) * dilation}"
        )
    near = [x[..., k * dilation : k * dilation + left, :] for k in range(width)]
    flat = np.stack(near, -1).reshape(*x.shape[:-2], left, -1)
    return np.asarray(flat @ weight.reshape(len(weight), -1).T + w[f"{name}.bias"])


def layer_norm(x: Array, eps: float = 1e-5) -> Array:
    """Return `[..., N]` with mean 0 and variance 1 over the last axis."""
    centred = x - x.mean(-1, keepdims=True)
    return np.asarray(
        centred / np.sqrt((centred * centred).mean(-1, keepdims=True) + np.asarray(eps, x.dtype))
    )


def lstm_state(w: Layers, name: str, layers: int, batch: tuple[int, ...] = ()) -> State:
    """Return the state at a sequence's start: zeros."""
    out: State = []
    for n in range(layers):
        weight = w[f"{name}.weight_hh_l{n}"]
        zero = np.zeros((*batch, weight.shape[1]), weight.dtype)
        out.append((zero, zero))
    return out


def lstm_step(w: Layers, name: str, x: Array, state: State) -> tuple[Array, State]:
    """Return what the last layer gives `[..., N]` for one moment's input `[..., in]`, and the next state."""
    after: State = []
    for n, (hidden, cell) in enumerate(state):
        gates = (
            x @ w[f"{name}.weight_ih_l{n}"].T
            + hidden @ w[f"{name}.weight_hh_l{n}"].T
            + (w[f"{name}.bias_ih_l{n}"] + w[f"{name}.bias_hh_l{n}"])
        )
        x, cell = _gated(gates, cell)
        after.append((x, cell))
    return x, after


def lstm(w: Layers, name: str, x: Array, state: State) -> tuple[Array, State]:
    """Return `[..., T, N]` for a sequence `[..., T, in]`, and the state after it."""
    after: State = []
    for n, (hidden, cell) in enumerate(state):
        above = x @ w[f"{name}.weight_ih_l{n}"].T + (w[f"{name}.bias_ih_l{n}"] + w[f"{name}.bias_hh_l{n}"])
        back = w[f"{name}.weight_hh_l{n}"].T
        out = np.empty((*above.shape[:-1], hidden.shape[-1]), above.dtype)
        for t in range(x.shape[-2]):
            hidden, cell = _gated(above[..., t, :] + hidden @ back, cell)
            out[..., t, :] = hidden
        x = out
        after.append((hidden, cell))
    return x, after


def _gated(gates: Array, cell: Array) -> tuple[Array, Array]:
    """Return hidden and cell; gates: input, forget, cell, output `[..., 4N]`."""
    count = cell.shape[-1]
    opened = sigmoid(gates)
    cell = opened[..., count : 2 * count] * cell + opened[..., :count] * np.tanh(
        gates[..., 2 * count : 3 * count]
    )
    return opened[..., 3 * count :] * np.tanh(cell), cell


def attention(q: Array, k: Array, v: Array, heads: int) -> Array:
    """Return `[..., T, N]`: each place's mean of the values `[..., T, N]`, by how its query fits the keys."""
    *batch, places, width = q.shape
    each = width // heads

    def apart(x: Array) -> Array:
        return np.moveaxis(x.reshape(*batch, places, heads, each), -2, -3)

    fit = apart(q) @ np.swapaxes(apart(k), -1, -2) * np.asarray(1 / np.sqrt(each), q.dtype)
    fit = np.exp(fit - fit.max(-1, keepdims=True))
    out = (fit / fit.sum(-1, keepdims=True)) @ apart(v)
    return np.asarray(np.moveaxis(out, -3, -2).reshape(*batch, places, width))


def transformer_block(w: Layers, name: str, x: Array, condition: Array, heads: int) -> Array:
    """Return `[..., T, N]` of places `[..., T, N]`. condition: what scales and shifts both norms, after silu,
    `[..., F]`.
    """
    s1, b1, s2, b2 = np.split(linear(w, f"{name}.modulation", condition)[..., None, :], 4, -1)
    q, k, v = np.split(linear(w, f"{name}.qkv", layer_norm(x) * (1 + s1) + b1), 3, -1)
    x = x + linear(w, f"{name}.proj", attention(q, k, v, heads))
    inner = gelu(linear(w, f"{name}.mlp.0", layer_norm(x) * (1 + s2) + b2))
    return np.asarray(x + linear(w, f"{name}.mlp.2", inner))
