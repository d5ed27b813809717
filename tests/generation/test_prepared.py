"""Layers that are prepared for sampling, against those that are not."""

from __future__ import annotations

import numpy as np
import pytest

from metagraph.generation import layers
from metagraph.generation.networks import list_lstm_shapes
from metagraph.generation.prepared import Cells, Dense

CHANCE = np.random.default_rng(2)


def _weights(shapes):
    return {name: CHANCE.standard_normal(shape) * 0.4 for name, shape in shapes.items()}


@pytest.mark.parametrize("own", [0, 2, 5])
@pytest.mark.parametrize("depth", [1, 3])
def test_an_lstm_moment_by_moment_is_the_whole(own, depth):
    w = _weights(list_lstm_shapes("l", 5, 7, depth))
    x = CHANCE.standard_normal((11, 5))
    whole, _ = layers.apply_lstm(w, "l", x, layers.make_lstm_state(w, "l", depth))
    cells = Cells(w, "l", depth, own, np.float64)
    told = cells.told(x[:, own:])
    for _ in range(2):
        for t in range(11):
            cells.own[:] = x[t, :own]
            assert np.abs(cells.step(told[t]) - whole[t]).max() < 1e-12
        cells.reset()


def test_an_lstms_gates_are_input_forget_cell_output():
    w = {name: np.zeros(shape) for name, shape in list_lstm_shapes("l", 1, 1, 1).items()}

    def outs(*biases):
        cells = Cells(w, "l", 1, 0, np.float64)
        made = []
        for bias in biases:
            w["l.bias_ih_l0"] = np.array(bias)
            made.append(float(cells.step(Cells(w, "l", 1, 0, np.float64).told(np.zeros((1, 1)))[0])[0]))
        return made

    taken = [50.0, -50.0, 0.5, 50.0]  # takes in, forgets, tanh(0.5), lets out
    kept = [-50.0, 50.0, 9.0, 50.0]
    shut = [-50.0, 50.0, 9.0, -50.0]
    inner = np.tanh(np.tanh(0.5))
    assert outs(taken, kept, taken, shut, kept) == pytest.approx([inner, inner, inner, 0, inner])


def test_a_linear_layer_is_one_for_rows_and_for_one():
    dense = Dense(CHANCE.standard_normal((3, 2)).astype(np.float32), np.ones(2, np.float32))
    x = CHANCE.standard_normal((4, 5, 3)).astype(np.float32)
    assert dense.rows(x).shape == (4, 5, 2)
    assert np.abs(dense.rows(x)[2, 3] - dense.one(x[2, 3])).max() < 1e-6
    assert dense.rows(x).dtype == dense.one(x[0, 0]).dtype == np.float32
