"""Chunks of motion by conditional flow matching on tokens of a few frames (`networks` has the formulas)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.generation.layers import Layers, layer_norm, linear, silu, transformer_block
from metagraph.generation.networks import MatchingSizes
from metagraph.generation.vae import spans

Array = NDArray[Any]

STEPS = 8  # of Euler a chunk
GUIDANCE = 2.0  # 0 sees who speaks alone, 1 hears as in training, above follows what is said more closely
SMOOTH = 1.5  # frames: deviation of the Gaussian over the rotations' numbers


def tokens_of(w: Layers, sizes: MatchingSizes, poses: Array) -> Array:
    """Return the whitened tokens `[T // frames, D]` of poses `[T, X]`, standardised."""
    rows = spans(poses, sizes.frames)
    return np.asarray((rows - w["tokens.mean"]) @ w["tokens.basis"].T / w["tokens.deviation"])


def poses_of(w: Layers, sizes: MatchingSizes, tokens: Array) -> Array:
    """Return the poses `[n frames, X]`, standardised, of tokens `[n, D]`."""
    rows = (tokens * w["tokens.deviation"]) @ w["tokens.basis"] + w["tokens.mean"]
    return np.asarray(rows.reshape(-1, sizes.pose))


def still_tokens(w: Layers, sizes: MatchingSizes, pose: Array) -> Array:
    """Return the past of somebody who holds a pose `[X]`, standardised: `[past, D]`."""
    return tokens_of(w, sizes, np.repeat(pose[None], sizes.past * sizes.frames, 0))


def velocity(
    w: Layers, sizes: MatchingSizes, noisy: Array, moment: Array, past: Array | None, heard: Array
) -> Array:
    """Return the velocity `[..., new, D]` at x_t `[..., new, D]`. moment: t `[...]`, 0..1. past: tokens
    `[..., past, D]`, None without. heard: of every place `[..., tokens, hidden]`, as `encoder.encode_chunk`
    gives it.
    """
    batch, dtype = noisy.shape[:-2], noisy.dtype
    x = np.zeros((*batch, sizes.tokens, sizes.hidden), dtype)
    x += heard + w["place"]
    x[..., : sizes.past, :] += w["no_past"] if past is None else linear(w, "embed_past", past)
    x[..., sizes.past : sizes.past + sizes.new, :] += linear(w, "embed_new", noisy)
    condition = silu(_moments(w, sizes, np.asarray(moment, dtype)))
    for n in range(sizes.layers):
        x = transformer_block(w, f"blocks.{n}", x, condition, sizes.heads)
    scale, shift = np.split(linear(w, "final.modulation", condition)[..., None, :], 2, -1)
    new = x[..., sizes.past : sizes.past + sizes.new, :]
    return linear(w, "final.out", layer_norm(new) * (1 + scale) + shift)


def draw_chunk(
    w: Layers,
    sizes: MatchingSizes,
    noise: Array,
    past: Array,
    heard: Array,
    deaf: Array,
    guidance: float = GUIDANCE,
    steps: int = STEPS,
) -> Array:
    """Return new tokens `[new, D]` of noise `[new, D]`, by Euler's steps. heard, deaf: with and without
    sound, as `encoder.encode_chunk` gives it.
    """
    *_, last = drawing(w, sizes, noise, past, heard, deaf, guidance, steps)
    return last


def drawing(
    w: Layers,
    sizes: MatchingSizes,
    noise: Array,
    past: Array,
    heard: Array,
    deaf: Array,
    guidance: float = GUIDANCE,
    steps: int = STEPS,
) -> Iterator[Array]:
    """Yield what noise `[new, D]` has become after each of Euler's steps, tokens after the last: for who has
    no time for all of them at once.
    """
    x, t = noise, np.zeros(1 if guidance == 1 else 2, noise.dtype)
    # With and without sound at once: one batch of two.
    if guidance != 1:
        both = np.stack([heard, deaf])
        before = np.broadcast_to(past, (2, *past.shape))
    for n in range(steps):
        if guidance == 1:
            v = velocity(w, sizes, x[None], t + n / steps, past[None], heard[None])[0]
        else:
            own, free = velocity(w, sizes, np.stack([x, x]), (t + n / steps).astype(x.dtype), before, both)
            v = (1 - guidance) * free + guidance * own
        x = (x + v / steps).astype(noise.dtype)
        yield x


def _moments(w: Layers, sizes: MatchingSizes, moment: Array) -> Array:
    """Return how t `[...]` is told, `[..., time]`."""
    half = sizes.time // 2
    speed = 1000.0 * 10000.0 ** (-np.arange(half) / half)
    angle = moment[..., None] * speed.astype(moment.dtype)
    told = np.concatenate([np.sin(angle), np.cos(angle)], -1)
    return linear(w, "time.2", silu(linear(w, "time.0", told)))


def gaussian(deviation: float) -> Array:
    """Return the weights of a Gaussian over frames, an odd count, sum 1. deviation: frames; 0 gives one."""
    reach = int(np.ceil(3 * deviation)) if deviation > 0 else 0
    at = np.arange(-reach, reach + 1)
    out = np.exp(-0.5 * (at / max(deviation, 1e-9)) ** 2)
    return np.asarray(out / out.sum())


def smoothed(numbers: Array, deviation: float = SMOOTH) -> Array:
    """Return numbers `[T, X]` averaged over frames by a Gaussian; the ends repeat."""
    weights = gaussian(deviation).astype(numbers.dtype)
    reach = len(weights) // 2
    padded = np.pad(numbers, ((reach, reach), (0, 0)), "edge")
    out = np.zeros_like(numbers)
    for n, weight in enumerate(weights):
        out += weight * padded[n : n + len(numbers)]
    return out
