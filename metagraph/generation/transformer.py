"""The transformer that tells the velocity of noisy tokens (`networks` has the formulas), for moments that are
known beforehand: how they scale and shift is computed once a model.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.generation.layers import Layers, apply_linear, silu
from metagraph.generation.networks import MatchingSizes
from metagraph.generation.prepared import Dense

Array = NDArray[Any]


class Velocity:
    """Velocities at the moments t `[M]`, 0..1."""

    def __init__(self, w: Layers, sizes: MatchingSizes, moments: Array) -> None:
        self.sizes, self._place, self._no_past = sizes, w["place"], w["no_past"]
        self._embed_past, self._embed_new = Dense.named(w, "embed_past"), Dense.named(w, "embed_new")
        condition = silu(_moments(w, sizes, np.asarray(moments, self._place.dtype)))
        self._blocks = [_Block(w, f"blocks.{n}", condition, sizes.heads) for n in range(sizes.layers)]
        scale, shift = np.split(apply_linear(w, "final.modulation", condition), 2, -1)
        self._final = _Shifted(Dense.named(w, "final.out"), scale, shift)

    def of(self, n: int, noisy: Array, past: Array | None, heard: Array) -> Array:
        """Return the velocity `[B, new, D]` of x_t `[B, new, D]` at moment number n. past: tokens `[B, past,
        D]`, None without. heard: of every place `[B, tokens, hidden]`, as `encoder.ChunkHearing` gives it.
        """
        *_, last = self.pieces(n, noisy, past, heard)
        return last

    def pieces(self, n: int, noisy: Array, past: Array | None, heard: Array) -> Iterator[Array]:
        """Do what `of` does in as many pieces as there are layers; the last one yielded is the velocity."""
        s = self.sizes
        new = slice(s.past, s.past + s.new)
        x = heard + self._place
        x[:, : s.past] += self._no_past if past is None else self._embed_past.rows(past)
        x[:, new] += self._embed_new.rows(noisy)
        for block in self._blocks[:-1]:
            x = block.of(n, x, slice(None))
            yield x
        x = self._blocks[-1].of(n, x, new)  # nobody asks for the other places any more
        yield self._final.of(n, x)


class _Shifted:
    """A linear layer of norms that are scaled by 1 + `scale [M, in]` and shifted by `shift [M, in]`."""

    def __init__(self, dense: Dense, scale: Array, shift: Array) -> None:
        self._weight, self._scales, self._biases = dense.weight, 1 + scale, dense.rows(shift)

    def of(self, n: int, x: Array) -> Array:
        """Return `[..., out]` of `[..., in]` at moment number n."""
        rows = x.reshape(-1, x.shape[-1])
        count = rows.shape[1]
        centred = rows - np.add.reduce(rows, -1, keepdims=True) / count
        squares = np.einsum("ij,ij->i", centred, centred)[:, None]
        centred *= 1 / np.sqrt(squares / count + 1e-5)
        centred *= self._scales[n]
        out = centred @ self._weight
        out += self._biases[n]
        return np.asarray(out.reshape(*x.shape[:-1], -1))


class _Block:
    """A layer. condition: what the moments scale and shift by, after silu `[M, F]`."""

    def __init__(self, w: Layers, name: str, condition: Array, heads: int) -> None:
        s1, b1, s2, b2 = np.split(apply_linear(w, f"{name}.modulation", condition), 4, -1)
        self.heads = heads
        each = s1.shape[-1] // heads
        both, inner, outer = (Dense.named(w, f"{name}.{part}") for part in ("qkv", "mlp.0", "mlp.2"))
        # What is fixed of attention and gelu is done to the weights: queries by 1 / sqrt(N), and gelu's half.
        fixed = np.repeat(np.array([1 / np.sqrt(each), 1, 1], s1.dtype), heads * each)
        self._qkv = _Shifted(Dense(both.weight * fixed, both.bias * fixed), s1, b1)
        self._proj = Dense.named(w, f"{name}.proj")
        self._inner, self._outer = _Shifted(inner, s2, b2), Dense(outer.weight * 0.5, outer.bias)

    def of(self, n: int, x: Array, places: slice) -> Array:
        """Return `[B, t, N]`, of some places, of all places `[B, T, N]` at moment number n."""
        batch, count, width = x.shape
        q, k, v = np.moveaxis(self._qkv.of(n, x).reshape(batch, count, 3, self.heads, -1), 2, 0)
        heard = attend(q[:, places], k, v)
        x = x[:, places] + self._proj.rows(heard.reshape(batch, -1, width))
        x += self._outer.rows(compute_twice_gelu(self._inner.of(n, x)))
        return x


def attend(q: Array, k: Array, v: Array) -> Array:
    """Return `[B, t, heads, N]`: each place's mean of the values `[B, T, heads, N]`, by how its query `[B, t,
    heads, N]`, scaled already, fits the keys `[B, T, heads, N]`.
    """
    fit = q.transpose(0, 2, 1, 3) @ k.transpose(0, 2, 3, 1)
    fit -= fit.max(-1, keepdims=True)
    np.exp(fit, fit)
    out = fit @ v.transpose(0, 2, 1, 3)
    out /= np.add.reduce(fit, -1, keepdims=True)
    return np.asarray(out.transpose(0, 2, 1, 3))


def compute_twice_gelu(x: Array) -> Array:
    """Return twice the Gaussian error linear unit, as approximated by tanh."""
    inner = x * x
    inner *= 0.044715 * 0.7978845608028654
    inner += 0.7978845608028654
    inner *= x
    np.tanh(inner, inner)
    inner += 1
    inner *= x
    return inner


def _moments(w: Layers, sizes: MatchingSizes, moments: Array) -> Array:
    """Return how t `[M]` is encoded, `[M, time]`."""
    half = sizes.time // 2
    speed = 1000.0 * 10000.0 ** (-np.arange(half) / half)
    angle = moments[:, None] * speed.astype(moments.dtype)
    told = np.concatenate([np.sin(angle), np.cos(angle)], -1)
    return apply_linear(w, "time.2", silu(apply_linear(w, "time.0", told)))
