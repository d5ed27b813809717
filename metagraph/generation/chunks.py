"""Chunks of motion by conditional flow matching on tokens of a few frames (`networks` has the formulas)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.generation.layers import Layers
from metagraph.generation.networks import MatchingSizes
from metagraph.generation.transformer import Velocity
from metagraph.generation.vae import list_spans

Array = NDArray[Any]

STEPS = 8  # of Euler a chunk
GUIDED = 4  # first steps that are guided: what follows settles what was begun, with or without
SPREAD = 1.12  # deviation of the noise at temperature 1: few steps of Euler draw what they make together
RIDGE = 0.02  # deviation of what is chance in a token, where its neighbours tell its frames
GUIDANCE = 1.5  # 0 sees who speaks alone, 1 hears as in training, above follows what is said more closely


def make_tokens(w: Layers, sizes: MatchingSizes, poses: Array) -> Array:
    """Return the whitened tokens `[T // frames, D]` of poses `[T, X]`, standardised."""
    rows = list_spans(poses, sizes.frames)
    return np.asarray((rows - w["tokens.mean"]) @ w["tokens.basis"].T / w["tokens.deviation"])


def join_token_poses(w: Layers, sizes: MatchingSizes, tokens: Array) -> Array:
    """Return the poses `[n frames, X]`, standardised, of tokens `[n, D]`."""
    rows = (tokens * w["tokens.deviation"]) @ w["tokens.basis"] + w["tokens.mean"]
    return np.asarray(rows.reshape(-1, sizes.pose))


class Joining:
    """From tokens to poses, so that pieces meet: each token's frames are given by its neighbours, too, and
    come `delay` frames later than the token. count: tokens at once; arrays of one shape give the same bits.
    """

    def __init__(self, w: Layers, sizes: MatchingSizes, count: int) -> None:
        self.w, self.sizes, self.count = w, sizes, count
        self.delay = sizes.around * sizes.frames
        self._kept: Array | None = None  # tokens whose frames are not told yet, and those before them

    def of(self, tokens: Array) -> Array:
        """Return the poses `[n, X]`, standardised, that `count` more tokens `[count, D]` tell."""
        if not self.delay:
            return join_token_poses(self.w, self.sizes, tokens)
        around, first = self.sizes.around, self._kept is None
        before = np.repeat(tokens[:1], 2 * around, 0) if self._kept is None else self._kept
        row = np.concatenate([before, tokens])
        self._kept = row[-2 * around :]
        poses = self._poses(row)
        return poses[self.delay :] if first else poses

    def rest(self) -> Array:
        """Return the poses that are left: the last token stays."""
        if not self.delay or self._kept is None:
            return np.zeros((0, self.sizes.pose), np.float32)
        last = np.repeat(self._kept[-1:], self.count, 0)
        return self._poses(np.concatenate([self._kept, last]))[: self.delay]

    def _poses(self, row: Array) -> Array:
        told = gather_neighbours(row, self.sizes.around)
        return np.asarray(
            (told @ self.w["tokens.joined"] + self.w["tokens.mean"]).reshape(-1, self.sizes.pose)
        )


def gather_neighbours(tokens: Array, around: int) -> Array:
    """Return `[n - 2 around, (2 around + 1) D]`: every token of `[n, D]` that has neighbours, with them."""
    count = len(tokens) - 2 * around
    return np.concatenate([tokens[k : k + count] for k in range(2 * around + 1)], 1)


def join_by_least_squares(rows: Iterable[tuple[Array, Array]], around: int) -> Array:
    """Return `tokens.joined` by least squares, float32. rows: of each take tokens `[n, D]` and their frames
    less the mean, flat `[n, frames X]`. A little of each token counts as chance: RIDGE.
    """
    inner: Array | float = 0.0
    outer: Array | float = 0.0
    count = 0
    for tokens, frames in rows:
        if len(tokens) > 2 * around:
            told = gather_neighbours(tokens, around).astype(np.float64)
            inner, outer = inner + told.T @ told, outer + told.T @ frames[around : len(frames) - around]
            count += len(told)
    square = np.asarray(inner)
    return np.linalg.solve(square + RIDGE**2 * count * np.eye(len(square)), outer).astype(np.float32)


def make_still_tokens(w: Layers, sizes: MatchingSizes, pose: Array) -> Array:
    """Return the past of somebody who holds a pose `[X]`, standardised: `[past, D]`."""
    return make_tokens(w, sizes, np.repeat(pose[None], sizes.past * sizes.frames, 0))


class TokenDrawing:
    """New tokens from noise, by Euler's steps. guidance: as GUIDANCE, of the first GUIDED; 1 asks for no
    more than what is heard, which is less work. pieces: of how many `pieces` consists.
    """

    def __init__(
        self, w: Layers, sizes: MatchingSizes, guidance: float = GUIDANCE, steps: int = STEPS
    ) -> None:
        self.guidance, self.steps, self.pieces = guidance, steps, steps * sizes.layers
        self._velocity = Velocity(w, sizes, np.arange(steps) / steps)

    def draw(self, noise: Array, past: Array, heard: Array) -> Array:
        """Return new tokens `[new, D]` of noise `[new, D]`. past: tokens `[past, D]`; heard: with and without
        sound, as `encoder.ChunkHearing` gives it; with alone will do for a guidance of 1.
        """
        *_, last = self.drawing(noise, past, heard)
        return last

    def drawing(self, noise: Array, past: Array, heard: Array) -> Iterator[Array]:
        """Do what `draw` does in pieces, for who has no time for all at once: the last one yielded is it."""
        x, guided = noise, 0 if self.guidance == 1 else GUIDED
        for n in range(self.steps):
            count = 2 if n < guided else 1  # with and without sound at once: one batch
            before = np.broadcast_to(past, (count, *past.shape))
            many = np.broadcast_to(x, (count, *x.shape))
            for v in self._velocity.pieces(n, many, before, heard[:count]):
                done = v
                yield x
            v = done[0] if count == 1 else (1 - self.guidance) * done[1] + self.guidance * done[0]
            x = (x + v / self.steps).astype(noise.dtype)
        yield x
