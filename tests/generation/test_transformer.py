"""The transformer, against what it is by definition."""

from __future__ import annotations

import numpy as np

from metagraph.generation.networks import MatchingSizes
from metagraph.generation.transformer import Velocity, attend, compute_twice_gelu
from tests.generation.makers import shaken, tiny

CHANCE = np.random.default_rng(2)


def test_attention_to_one_place_gives_its_value():
    k = np.zeros((1, 3, 2, 4))
    k[0, 1] = 40.0
    v = CHANCE.standard_normal((1, 3, 2, 4))
    out = attend(np.full((1, 5, 2, 4), 40.0), k, v)
    assert out.shape == (1, 5, 2, 4)
    assert np.abs(out - v[:, 1:2]).max() < 1e-9


def test_heads_attend_apart():
    q, k, v = (CHANCE.standard_normal((1, 5, 2, 3)) for _ in range(3))
    both = attend(q, k, v)
    for head in (slice(0, 1), slice(1, 2)):
        alone = attend(q[:, :, head], k[:, :, head], v[:, :, head])
        assert np.abs(both[:, :, head] - alone).max() < 1e-12


def test_nothing_overflows():
    far = np.array([-1e4, -100.0, 0.0, 100.0, 1e4], np.float32)
    assert np.isfinite(compute_twice_gelu(far)).all()
    assert compute_twice_gelu(far)[-1] == np.float32(2e4)
    assert compute_twice_gelu(far).dtype == np.float32
    assert np.isfinite(attend(*[np.full((1, 2, 1, 1), 1e10)] * 3)).all()


def _layer_norm(x):
    return (x - x.mean(-1, keepdims=True)) / np.sqrt(x.var(-1, keepdims=True) + 1e-5)


def test_a_velocity_is_what_the_formulas_say():
    """Place by place and head by head, as the design note has it."""
    sizes = tiny("matching")
    assert isinstance(sizes, MatchingSizes)
    w = shaken(sizes, dtype=np.float64)
    noisy, past = (CHANCE.standard_normal((n, sizes.dims)) for n in (sizes.new, sizes.past))
    heard = CHANCE.standard_normal((sizes.tokens, sizes.hidden))

    def linear(name, x):
        return x @ w[f"{name}.weight"].T + w[f"{name}.bias"]

    def silu(x):
        return x / (1 + np.exp(-x))

    t, half = 0.625, sizes.time // 2
    angle = t * 1000 / 10000.0 ** (np.arange(half) / half)
    e = linear("time.2", silu(linear("time.0", np.concatenate([np.sin(angle), np.cos(angle)]))))
    x = heard + w["place"]
    x[: sizes.past] += linear("embed_past", past)
    x[sizes.past : sizes.past + sizes.new] += linear("embed_new", noisy)
    for n in range(sizes.layers):
        s1, b1, s2, b2 = np.split(linear(f"blocks.{n}.modulation", silu(e)), 4)
        parts = np.split(linear(f"blocks.{n}.qkv", _layer_norm(x) * (1 + s1) + b1), 3, -1)
        out = []
        for q, k, v in zip(*(np.split(part, sizes.heads, -1) for part in parts), strict=True):
            fit = np.exp(q @ k.T / np.sqrt(q.shape[1]))
            out.append(fit / fit.sum(1, keepdims=True) @ v)
        x = x + linear(f"blocks.{n}.proj", np.concatenate(out, 1))
        inner = linear(f"blocks.{n}.mlp.0", _layer_norm(x) * (1 + s2) + b2)
        gelu = 0.5 * inner * (1 + np.tanh(np.sqrt(2 / np.pi) * (inner + 0.044715 * inner**3)))
        x = x + linear(f"blocks.{n}.mlp.2", gelu)
    s, b = np.split(linear("final.modulation", silu(e)), 2)
    expected = linear("final.out", _layer_norm(x) * (1 + s) + b)[sizes.past : sizes.past + sizes.new]
    own = Velocity(w, sizes, np.array([0.1, t])).of(1, noisy[None], past[None], heard[None])[0]
    assert np.abs(own - expected).max() < 1e-12


def _places(sizes: MatchingSizes):
    w = shaken(sizes, dtype=np.float64)
    heard = CHANCE.standard_normal((1, sizes.tokens, sizes.hidden))
    past, noise = (CHANCE.standard_normal((1, n, sizes.dims)) for n in (sizes.past, sizes.new))
    return w, heard, past, noise


def test_a_velocity_depends_on_all_it_is_given():
    sizes = tiny("matching")
    assert isinstance(sizes, MatchingSizes)
    w, heard, past, noise = _places(sizes)
    velocity = Velocity(w, sizes, np.array([0.3, 0.9]))
    own = velocity.of(0, noise, past, heard)
    assert own.shape == noise.shape
    for other in (
        velocity.of(0, noise + 1, past, heard),
        velocity.of(1, noise, past, heard),
        velocity.of(0, noise, past + 1, heard),
        velocity.of(0, noise, None, heard),
        velocity.of(0, noise, past, heard[:, ::-1]),
    ):
        assert np.abs(other - own).max() > 1e-3
    ahead = heard.copy()
    ahead[:, -1] = -ahead[:, -1]  # the places of the future are heard, too
    assert np.abs(velocity.of(0, noise, past, ahead) - own).max() > 1e-4


def test_chunks_at_once_are_each_by_itself():
    sizes = tiny("matching")
    assert isinstance(sizes, MatchingSizes)
    w, heard, past, noise = _places(sizes)
    velocity = Velocity(w, sizes, np.array([0.8]))
    pairs = [np.concatenate([x, -x]) for x in (noise, past, heard)]
    apart = velocity.of(0, -noise, -past, -heard)
    assert np.abs(velocity.of(0, *pairs)[1] - apart[0]).max() < 1e-12
