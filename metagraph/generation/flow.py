"""A normalising flow with LSTMs: from codes to noise and back, with the exact likelihood (`networks` has the
formulas).
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.generation.layers import Layers, State, apply_linear, apply_lstm, make_lstm_state, sigmoid
from metagraph.generation.networks import FlowSizes
from metagraph.generation.prepared import Cells, Dense

Array = NDArray[Any]
FlowState = list[State]  # one for each step
LEAST = 1e-6  # what a coupling scales by at least


class FlowWeights:
    """A flow's weights, ready for both directions. dtype: what is computed in."""

    def __init__(self, weights: Layers, sizes: FlowSizes, dtype: Any = np.float32) -> None:
        self.dims, self.half, self.layers = sizes.dims, sizes.dims // 2, sizes.layers
        self.steps = [f"flow.steps.{k}" for k in range(sizes.steps)]
        self.dtype = dtype
        used: dict[str, Array] = {
            name: value.astype(dtype, copy=False)
            for name, value in weights.items()
            if name.startswith("flow.")
        }
        self.weights = used
        self._matrices: list[Array] = []
        self._inverses: list[Array] = []
        self._logs: list[float] = []
        for step in self.steps:
            matrix = build_flow_matrix(weights, f"{step}.linear")
            self._matrices.append(matrix.astype(dtype))
            self._inverses.append(np.linalg.inv(matrix).astype(dtype))
            logs = weights[f"{step}.actnorm.logs"].astype(np.float64)
            self._logs.append(float(logs.sum() + weights[f"{step}.linear.log_s"].astype(np.float64).sum()))

    def start(self, batch: tuple[int, ...] = ()) -> FlowState:
        """Return the state at a sequence's start."""
        return [make_lstm_state(self.weights, f"{step}.lstm", self.layers, batch) for step in self.steps]

    def forward(
        self, codes: Array, context: Array, state: FlowState | None = None
    ) -> tuple[Array, Array, FlowState]:
        """Return noise `[..., T, D]`, the logarithm of the determinant of each moment `[..., T]`, and the
        state after them. codes: `[..., T, D]`; context: `[..., T, C]`; state: None at a sequence's start.
        """
        z: Array = np.asarray(codes, self.dtype)
        context = np.asarray(context, self.dtype)
        before = self.start(z.shape[:-2]) if state is None else state
        total: Array = np.full(z.shape[:-1], sum(self._logs), self.dtype)
        after: FlowState = []
        for k, step in enumerate(self.steps):
            w = self.weights
            z = (z + w[f"{step}.actnorm.bias"]) * np.exp(w[f"{step}.actnorm.logs"])
            z = z @ self._matrices[k].T
            a, b = z[..., : self.half], z[..., self.half :]
            hidden, next_state = apply_lstm(w, f"{step}.lstm", np.concatenate([a, context], -1), before[k])
            shift, scale = self._coupling(step, hidden)
            z = np.concatenate([a, (b + shift) * scale], -1)
            total = total + np.log(scale).sum(-1)
            after.append(next_state)
        return z, total, after

    def inverse(
        self, noise: Array, context: Array, state: FlowState | None = None
    ) -> tuple[Array, FlowState]:
        """Return codes `[..., T, D]` of noise, with a context `[..., T, C]` known beforehand, and the state
        after them.
        """
        z: Array = np.asarray(noise, self.dtype)
        context = np.asarray(context, self.dtype)
        before = self.start(z.shape[:-2]) if state is None else state
        after: FlowState = []
        for k in reversed(range(len(self.steps))):
            a = z[..., : self.half]
            hidden, next_state = apply_lstm(
                self.weights, f"{self.steps[k]}.lstm", np.concatenate([a, context], -1), before[k]
            )
            z = self._undone(k, z, hidden)
            after.insert(0, next_state)
        return z, after

    def log_likelihood(self, codes: Array, context: Array, state: FlowState | None = None) -> Array:
        """Return ln p of each moment's code `[..., T]`, natural logarithm, given those before it."""
        z, logs, _ = self.forward(codes, context, state)
        return np.asarray(logs - 0.5 * (z * z + np.log(2 * np.pi)).sum(-1))

    def _coupling(self, step: str, hidden: Array) -> tuple[Array, Array]:
        """Return what the second half is shifted and scaled by, `[..., D - D // 2]` each."""
        told = apply_linear(self.weights, f"{step}.out", hidden)
        count = self.dims - self.half
        return told[..., :count], sigmoid(told[..., count:] + 2) + np.asarray(LEAST, self.dtype)

    def _undone(self, k: int, z: Array, hidden: Array) -> Array:
        w, step = self.weights, self.steps[k]
        shift, scale = self._coupling(step, hidden)
        z = np.concatenate([z[..., : self.half], z[..., self.half :] / scale - shift], -1)
        z = z @ self._inverses[k].T
        return np.asarray(z * np.exp(-w[f"{step}.actnorm.logs"]) - w[f"{step}.actnorm.bias"])


class FlowDrawing:
    """A flow from noise to codes, moment by moment. The context is in two parts: of the past poses, and of
    what is heard, which can be computed beforehand.
    """

    def __init__(self, weights: Layers, sizes: FlowSizes, dtype: Any = np.float32) -> None:
        self.half, self._count = sizes.dims // 2, sizes.dims - sizes.dims // 2
        own = self.half + sizes.control.of_past(sizes.told)
        self._steps = []
        for k in reversed(range(sizes.steps)):
            step = f"flow.steps.{k}"
            cells = Cells(weights, f"{step}.lstm", sizes.layers, own, dtype)
            # As in `Cells`, a sigmoid is a tanh of half its argument; the scale's is one of 2 more.
            half = np.ones(2 * self._count)
            half[self._count :] = 0.5
            bias = weights[f"{step}.out.bias"] * half
            bias[self._count :] += 1
            out = Dense(weights[f"{step}.out.weight"].T * half, bias, dtype)
            inverse = np.linalg.inv(build_flow_matrix(weights, f"{step}.linear"))
            logs = weights[f"{step}.actnorm.logs"].astype(np.float64)
            back = Dense(inverse.T * np.exp(-logs), -weights[f"{step}.actnorm.bias"], dtype)
            self._steps.append((cells, out, back))
        self.dtype = dtype

    def reset(self) -> None:
        """Begin a sequence."""
        for cells, _, _ in self._steps:
            cells.reset()

    def told(self, heard: Array) -> Array:
        """Return what `draw` wants of what is heard: `[n, K, 4N]` of `[n, C]`."""
        return np.stack([cells.told(heard) for cells, _, _ in self._steps], 1)

    def more(self, heard: Array, first: int) -> Array:
        """Return what some of the numbers heard add where they were 0: `[K, 4N]` of `[m]`, from number
        `first` on.
        """
        return np.stack([cells.more(heard, first) for cells, _, _ in self._steps])

    def draw(self, noise: Array, past: Array, told: Array) -> Array:
        """Return the next moment's code `[D]`, which lasts until the next call. noise: `[D]`; past: what is
        known of the poses before, flat; told: `[K, 4N]`, as `told` gives it.
        """
        z, half, count = np.array(noise, self.dtype), self.half, self._count
        for (cells, out, back), heard in zip(self._steps, told, strict=True):
            a, b = z[:half], z[half:]
            cells.own[:half] = a
            cells.own[half:] = past
            u = out.one(cells.step(heard))
            scale = u[count:]
            np.tanh(scale, scale)
            scale *= 0.5
            scale += 0.5 + LEAST
            b /= scale
            b -= u[:count]
            z = back.one(z)
        return z


def build_flow_matrix(weights: Layers, name: str) -> Array:
    """Return W = P L (U + diag(s)) `[D, D]`, float64, of an invertible linear layer."""
    p, lower, upper, sign, log_s = (
        weights[f"{name}.{part}"].astype(np.float64) for part in ("p", "lower", "upper", "sign", "log_s")
    )
    left = np.tril(lower, -1) + np.eye(len(p))
    return np.asarray(p @ left @ (np.triu(upper, 1) + np.diag(sign * np.exp(log_s))))
