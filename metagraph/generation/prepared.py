"""Weights as sampling wants them, once a model: transposed and contiguous, what comes from the same input in
one matrix; and LSTMs that go on from moment to moment in place.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.generation.layers import Layers

Array = NDArray[Any]


class Dense:
    """A linear layer. weight: `[in, out]`, bias: `[out]`; dtype: None for their own."""

    def __init__(self, weight: Array, bias: Array, dtype: Any = None) -> None:
        self.weight, self.bias = np.ascontiguousarray(weight, dtype), np.asarray(bias, dtype)
        self._out = np.empty_like(self.bias)

    @classmethod
    def named(cls, w: Layers, name: str) -> Dense:
        """Return the layer of that name."""
        return cls(w[f"{name}.weight"].T, w[f"{name}.bias"])

    def rows(self, x: Array) -> Array:
        """Return `[..., out]` of `[..., in]`, as one product."""
        flat = x if x.ndim == 2 else x.reshape(-1, x.shape[-1])
        out = flat @ self.weight
        out += self.bias
        return np.asarray(out if x.ndim == 2 else out.reshape(*x.shape[:-1], -1))

    def one(self, x: Array) -> Array:
        """Return `[out]` of `[in]` of the same float, which lasts until the next call."""
        x.dot(self.weight, self._out)
        self._out += self.bias
        return self._out


class Cells:
    """LSTMs in layers, moment by moment. own: how many of the first layer's inputs are known at the moment
    alone; what the others do (`told`) can be computed for many moments at once.
    """

    def __init__(self, w: Layers, name: str, layers: int, own: int, dtype: Any = np.float32) -> None:
        units = w[f"{name}.weight_hh_l0"].shape[1]
        # Gates in the order input, forget, output, cell, the cell's state behind them: one tanh is enough for
        # all gates (a sigmoid is one of half its argument), and one product for both terms of the new state.
        order = np.arange(4 * units).reshape(4, units)[[0, 1, 3, 2]].reshape(-1)
        half = np.repeat(np.array([0.5, 0.5, 0.5, 1.0], dtype), units)
        self._matrices: list[Array] = []
        self._biases: list[Array] = []
        for n in range(layers):
            above, back = w[f"{name}.weight_ih_l{n}"], w[f"{name}.weight_hh_l{n}"]
            size = own if n == 0 else units
            matrix = np.empty((size + units, 4 * units), dtype)
            np.multiply(above[order, :size].T, half, out=matrix[:size])
            np.multiply(back[order].T, half, out=matrix[size:])
            self._matrices.append(matrix)
            bias = (w[f"{name}.bias_ih_l{n}"] + w[f"{name}.bias_hh_l{n}"]).astype(dtype)
            self._biases.append(bias[order] * half)
            if n == 0:
                others = np.multiply(above[order, own:].T, half, order="C", dtype=dtype)
                self._others = Dense(others, self._biases[0])
        # [own inputs, hidden of layer 0, of layer 1 ...]: what enters a layer lies in a row.
        self._line = np.zeros(own + layers * units, dtype)
        self.own = self._line[:own]
        self._products = np.empty(2 * units, dtype)
        self._layers = []
        for n in range(layers):
            at = own + n * units
            gates = np.zeros(5 * units, dtype)
            self._layers.append(
                (
                    self._line[0 if n == 0 else at - units : at + units],
                    self._line[at : at + units],
                    gates,
                    gates[: 4 * units],
                    gates[: 3 * units],
                    gates[: 2 * units],
                    gates[2 * units : 3 * units],
                    gates[3 * units :],
                    gates[4 * units :],
                )
            )
        self._first, self._second = self._products[:units], self._products[units:]

    def reset(self) -> None:
        """Begin a sequence."""
        self._line[:] = 0
        for layer in self._layers:
            layer[2][:] = 0

    def told(self, others: Array) -> Array:
        """Return what the first layer's other inputs do `[n, 4N]`. others: `[n, in - own]`."""
        return self._others.rows(others)

    def more(self, others: Array, first: int) -> Array:
        """Return what some of the other inputs add to what `told` gave where they were 0. first: the number
        of the first of them.
        """
        return np.asarray(others @ self._others.weight[first : first + others.shape[-1]])

    def step(self, told: Array) -> Array:
        """Return what the last layer gives `[N]`, which lasts until the next call, with `own` filled before.
        told: `[4N]`, as `told` gives it.
        """
        half, first, second = 0.5, self._first, self._second
        out = self.own
        for n, (into, out, _, gates, opened, both, last, cells, cell) in enumerate(self._layers):
            into.dot(self._matrices[n], gates)
            gates += told if n == 0 else self._biases[n]
            np.tanh(gates, gates)
            opened *= half
            opened += half
            np.multiply(both, cells, self._products)  # input * candidate, forget * cell
            np.add(first, second, cell)
            np.tanh(cell, first)
            np.multiply(last, first, out)
        return out
