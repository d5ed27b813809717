"""Models frame by frame: what a sampler asks for the next poses. Each moment is reckoned by itself and in
arrays of the same shape, so that it does not matter in which pieces the sound came.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.generation import chunks, cvae, vae
from metagraph.generation.encoder import encode_chunk, encode_past, encode_window
from metagraph.generation.flow import Flow
from metagraph.generation.layers import lstm_state
from metagraph.generation.networks import CvaeSizes, FlowSizes, MatchingSizes, Sizes, Weights
from metagraph.generation.noise import noise
from metagraph.generation.poses import FURTHEST

Array = NDArray[Any]


class Generator(ABC):
    """A model that goes on and on. before, ahead: frames of features that are given beside the first one
    made. made: frames that `step` makes. needed: frames after the first that must be known, the others may be
    anything. pieces: of how many `steps` consists.
    """

    before: int
    ahead: int
    made: int
    needed: int
    pieces: int = 1

    @abstractmethod
    def step(self, heard: Array, seed: int, take: int, frame: int) -> Array:
        """Return the next poses `[made, X]`, standardised. heard: features `[before + 1 + ahead, audio + 4]`,
        standardised. frame: the number of the first one made.
        """

    def steps(self, heard: Array, seed: int, take: int, frame: int) -> Iterator[Array | None]:
        """Do what `step` does in pieces of about a millisecond: yields None after each, the poses at last."""
        yield self.step(heard, seed, take, frame)


class FlowGenerator(Generator):
    """The Flow-VAE, and MoGlow. lookahead: frames ahead that are known, 0..ahead. first: the pose `[X]`
    before, standardised.
    """

    def __init__(
        self, w: Weights, sizes: FlowSizes, first: Array, temperature: float, lookahead: int | None
    ) -> None:
        control = sizes.control
        self.w, self.sizes, self.temperature = w, sizes, np.float32(temperature)
        self.lookahead = control.ahead if lookahead is None else min(max(lookahead, 0), control.ahead)
        self.before, self.ahead, self.made = control.before, control.ahead, sizes.span
        self.needed = self.lookahead
        self.flow = Flow(w, sizes)
        self.state = self.flow.start()
        self.past = np.repeat(first[None], max(1, control.past), 0)

    def step(self, heard: Array, seed: int, take: int, frame: int) -> Array:
        control = self.sizes.control
        context = encode_window(self.w, control, heard, self.lookahead)
        if control.past:
            past = encode_past(self.w, control, self.past[-control.past :])
            context = np.concatenate([past, context])
        z = noise(seed, take, frame, self.sizes.dims) * self.temperature
        with np.errstate(over="ignore", invalid="ignore"):
            code, self.state = self.flow.draw(z, context, self.state)
        if not np.isfinite(code).all():  # a flow that ran away begins anew
            code, self.state = np.zeros_like(code), self.flow.start()
        flat = vae.decode(self.w, self.sizes, code)
        poses = np.clip(flat.reshape(self.sizes.span, -1), -FURTHEST, FURTHEST)
        self.past = np.concatenate([self.past, poses])[-max(1, control.past) :]
        return poses


class CvaeGenerator(Generator):
    """The paper's CVAE."""

    def __init__(self, w: Weights, sizes: CvaeSizes, temperature: float, lookahead: int | None) -> None:
        control = sizes.control
        self.w, self.sizes, self.temperature = w, sizes, np.float32(temperature)
        self.lookahead = control.ahead if lookahead is None else min(max(lookahead, 0), control.ahead)
        self.before, self.ahead, self.made, self.needed = control.before, control.ahead, 1, self.lookahead
        self.state = lstm_state(w, "decoder", sizes.layers)

    def step(self, heard: Array, seed: int, take: int, frame: int) -> Array:
        context = encode_window(self.w, self.sizes.control, heard, self.lookahead)
        code = noise(seed, take, frame, self.sizes.dims) * self.temperature
        pose, self.state = cvae.draw(self.w, code, context, self.state)
        return np.clip(pose[None], -FURTHEST, FURTHEST)


class MatchingGenerator(Generator):
    """Flow matching on tokens. lookahead: frames after a chunk's first one that are known. keep: tokens of a
    chunk that are kept before the next one is drawn: fewer follow what is heard sooner, and cost more.
    """

    def __init__(
        self,
        w: Weights,
        sizes: MatchingSizes,
        first: Array,
        temperature: float,
        lookahead: int | None,
        guidance: float = chunks.GUIDANCE,
        keep: int | None = None,
    ) -> None:
        self.w, self.sizes, self.temperature = w, sizes, np.float32(temperature)
        self.lookahead = sizes.most if lookahead is None else min(max(lookahead, 0), sizes.most)
        # What is kept is not made long before it is heard.
        kept = min(sizes.new, max(1, (self.lookahead + 1) // sizes.frames)) if keep is None else keep
        if not 1 <= kept <= sizes.new:
            raise ValueError(f"{kept} of {sizes.new} tokens cannot be kept")
        self.guidance, self.kept = guidance, kept
        self.before, self.ahead = sizes.past * sizes.frames, sizes.most
        self.made, self.needed, self.pieces = kept * sizes.frames, self.lookahead, chunks.STEPS + 1
        self.past = chunks.still_tokens(w, sizes, first)

    def step(self, heard: Array, seed: int, take: int, frame: int) -> Array:
        *_, last = self.steps(heard, seed, take, frame)
        assert last is not None
        return last

    def steps(self, heard: Array, seed: int, take: int, frame: int) -> Iterator[Array | None]:
        sizes = self.sizes
        told = encode_chunk(self.w, sizes, heard, self.lookahead)
        deaf = told if self.guidance == 1 else encode_chunk(self.w, sizes, heard, self.lookahead, False)
        yield None
        z = noise(seed, take, frame, sizes.new * sizes.dims).reshape(sizes.new, sizes.dims)
        tokens = z * self.temperature
        guided = chunks.drawing(self.w, sizes, tokens, self.past, told, deaf, self.guidance)
        for n, drawn in enumerate(guided, 1):
            tokens = drawn
            if n < chunks.STEPS:
                yield None
        tokens = np.clip(tokens[: self.kept], -FURTHEST, FURTHEST)
        self.past = np.concatenate([self.past, tokens])[-sizes.past :]
        yield np.clip(chunks.poses_of(self.w, sizes, tokens), -FURTHEST, FURTHEST)


def generator(
    w: Weights,
    sizes: Sizes,
    first: Array,
    temperature: float = 1.0,
    lookahead: int | None = None,
    guidance: float = chunks.GUIDANCE,
) -> Generator:
    """Return a model that begins anew. first: the pose `[X]`, standardised, that it goes on from. lookahead:
    frames ahead that are known, None for all it can use.
    """
    if isinstance(sizes, FlowSizes):
        return FlowGenerator(w, sizes, first, temperature, lookahead)
    if isinstance(sizes, CvaeSizes):
        return CvaeGenerator(w, sizes, temperature, lookahead)
    return MatchingGenerator(w, sizes, first, temperature, lookahead, guidance)
