"""Layers in NumPy: linear, LSTM; whole sequences at once. Weights are named and shaped
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


def apply_linear(w: Layers, name: str, x: Array) -> Array:
    """Return `[..., out]` of `[..., in]`."""
    weight = w[f"{name}.weight"]
    flat = x.reshape(-1, x.shape[-1]) if x.ndim > 2 else x  # one product, not one for each of a batch
    return np.asarray((flat @ weight.T).reshape(*x.shape[:-1], len(weight)) + w[f"{name}.bias"])


def make_lstm_state(w: Layers, name: str, layers: int, batch: tuple[int, ...] = ()) -> State:
    """Return the state at a sequence's start: zeros."""
    out: State = []
    for n in range(layers):
        weight = w[f"{name}.weight_hh_l{n}"]
        zero = np.zeros((*batch, weight.shape[1]), weight.dtype)
        out.append((zero, zero))
    return out


def apply_lstm(w: Layers, name: str, x: Array, state: State) -> tuple[Array, State]:
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
