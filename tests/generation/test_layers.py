"""Layers, against what they are by definition."""

from __future__ import annotations

import numpy as np
import pytest

from metagraph.generation import layers
from metagraph.generation.networks import linear, lstm

CHANCE = np.random.default_rng(2)


def _weights(shapes):
    return {name: CHANCE.standard_normal(shape) * 0.4 for name, shape in shapes.items()}


def test_an_lstm_step_by_step_is_the_whole():
    w = _weights(lstm("l", 5, 7, 3))
    x = CHANCE.standard_normal((11, 5))
    whole, after = layers.lstm(w, "l", x, layers.lstm_state(w, "l", 3))
    state = layers.lstm_state(w, "l", 3)
    for t in range(11):
        one, state = layers.lstm_step(w, "l", x[t], state)
        assert np.abs(one - whole[t]).max() < 1e-12
    for (h, c), (h2, c2) in zip(after, state, strict=True):
        assert np.abs(h - h2).max() < 1e-12
        assert np.abs(c - c2).max() < 1e-12


def test_an_lstms_gates_are_input_forget_cell_output():
    w = {name: np.zeros(shape) for name, shape in lstm("l", 1, 1, 1).items()}
    w["l.bias_ih_l0"] = np.array([50.0, -50.0, 0.5, 50.0])  # takes in, forgets, tanh(0.5), lets out
    out, _ = layers.lstm_step(w, "l", np.zeros(1), [(np.zeros(1), np.full(1, 9.0))])
    assert out[0] == pytest.approx(np.tanh(np.tanh(0.5)))
    w["l.bias_ih_l0"] = np.array([-50.0, 50.0, 0.5, 50.0])  # keeps
    out, _ = layers.lstm_step(w, "l", np.zeros(1), [(np.zeros(1), np.full(1, 0.7))])
    assert out[0] == pytest.approx(np.tanh(0.7))


@pytest.mark.parametrize("dilation", [1, 2, 5])
def test_a_convolution_is_a_sum_over_dilated_neighbours(dilation):
    w = {"c.weight": CHANCE.standard_normal((4, 3, 3)), "c.bias": CHANCE.standard_normal(4)}
    x = CHANCE.standard_normal((2, 14, 3))
    out = layers.conv1d(w, "c", x, dilation)
    assert out.shape == (2, 14 - 2 * dilation, 4)
    for t in (0, out.shape[1] - 1):
        told = sum(w["c.weight"][:, :, k] @ x[1, t + k * dilation] for k in range(3)) + w["c.bias"]
        assert np.abs(out[1, t] - told).max() < 1e-12


def test_too_few_frames_for_a_convolution_are_told():
    w = {"c.weight": np.zeros((1, 1, 3)), "c.bias": np.zeros(1)}
    with pytest.raises(ValueError, match="4 frames are too few for a convolution over 5"):
        layers.conv1d(w, "c", np.zeros((4, 1)), 2)


def test_attention_to_one_place_gives_its_value():
    k = np.zeros((1, 3, 4))
    k[0, 1] = 40.0
    v = CHANCE.standard_normal((1, 3, 4))
    out = layers.attention(np.full((1, 3, 4), 40.0), k, v, 2)
    assert np.abs(out - v[:, 1:2]).max() < 1e-9


def test_heads_attend_apart():
    q, k, v = (CHANCE.standard_normal((5, 6)) for _ in range(3))
    both = layers.attention(q, k, v, 2)
    assert np.abs(both[:, :3] - layers.attention(q[:, :3], k[:, :3], v[:, :3], 1)).max() < 1e-12
    assert np.abs(both[:, 3:] - layers.attention(q[:, 3:], k[:, 3:], v[:, 3:], 1)).max() < 1e-12


def test_nothing_overflows():
    far = np.array([-1e4, -100.0, 0.0, 100.0, 1e4], np.float32)
    assert layers.sigmoid(far).tolist() == [0, 0, 0.5, 1, 1]
    assert layers.silu(far)[-1] == np.float32(1e4)
    assert np.isfinite(layers.gelu(far)).all()
    assert np.isfinite(layers.layer_norm(np.zeros((2, 3), np.float32))).all()
    assert layers.sigmoid(far).dtype == layers.gelu(far).dtype == np.float32


def test_a_transformer_block_that_is_zero_changes_nothing():
    shapes = {**linear("b.modulation", 3, 32), **linear("b.qkv", 8, 24), **linear("b.proj", 8, 8)}
    w = {n: np.zeros(s) for n, s in (shapes | linear("b.mlp.0", 8, 16) | linear("b.mlp.2", 16, 8)).items()}
    x = CHANCE.standard_normal((2, 5, 8))
    assert (layers.transformer_block(w, "b", x, np.zeros((2, 3)), 2) == x).all()
