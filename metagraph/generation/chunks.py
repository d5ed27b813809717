"""Chunks of motion by conditional flow matching on tokens of a few frames (`networks` has the formulas)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.generation.layers import Layers
from metagraph.generation.networks import MatchingSizes
from metagraph.generation.transformer import Velocity
from metagraph.generation.vae import spans

Array = NDArray[Any]

STEPS = 8  # of Euler a chunk
GUIDED = 4  # first steps that are guided: what follows settles what was begun, with or without
GUIDANCE = 1.75  # 0 sees who speaks alone, 1 hears as in training, above follows what is said more closely


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


class Drawing:
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
