"""Layers, against what they are by definition."""

from __future__ import annotations

import numpy as np

from metagraph.generation import layers

CHANCE = np.random.default_rng(2)


def _weights(shapes):
    return {name: CHANCE.standard_normal(shape) * 0.4 for name, shape in shapes.items()}


def test_nothing_overflows():
    far = np.array([-1e4, -100.0, 0.0, 100.0, 1e4], np.float32)
    assert layers.sigmoid(far).tolist() == [0, 0, 0.5, 1, 1]
    assert layers.silu(far)[-1] == np.float32(1e4)
    assert layers.sigmoid(far).dtype == np.float32
