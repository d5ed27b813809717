"""Models frame by frame: what a sampler asks for the next poses. Each moment is computed in arrays of the
same shape and at the same place in them, so that it does not matter in which pieces the sound came.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from math import isfinite
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.generation import chunks, cvae, vae
from metagraph.generation.encoder import BLOCK, ChunkHearing, EncoderHearing
from metagraph.generation.flow import FlowDrawing
from metagraph.generation.networks import (
    ACTIVITY,
    Control,
    CvaeSizes,
    FlowSizes,
    MatchingSizes,
    Sizes,
    Weights,
)
from metagraph.generation.noise import Noise, draw_noise
from metagraph.generation.poses import FURTHEST
from metagraph.generation.prepared import Dense

Array = NDArray[Any]


class Generator(ABC):
    """A model that goes on and on. before, ahead: frames of features that it hears beside the first one made.
    made: frames that `step` makes. needed: frames after the first that must be known. most: frames of
    features that are of use at once. pieces: of how many `steps` consists. delay: frames by which poses come
    out later than they are made: `step` gives fewer of them at first.
    """

    before: int
    ahead: int
    made: int
    needed: int
    most: int
    pieces: int = 1
    delay: int = 0

    @abstractmethod
    def step(self, heard: Array, seed: int, take: int, frame: int) -> Array:
        """Return the next poses `[made, X]`, standardised. heard: features `[n, audio + 4]`, standardised,
        from `before` frames before the first one made on, as many as are known: `before + 1 + needed` at
        least, more save time. frame: the number of the first one made, `made` further each time.
        """

    def steps(self, heard: Array, seed: int, take: int, frame: int) -> Iterator[Array | None]:
        """Do what `step` does in pieces of less than a millisecond: yields None after each, then poses."""
        yield self.step(heard, seed, take, frame)

    def rest(self) -> Array | None:
        """Return the poses `[delay, X]` that are left when no more are made, None if none are."""
        return None

    def _hears(self, control: Control, lookahead: int | None) -> None:
        self.before, self.ahead = control.before, control.ahead
        self.needed = control.ahead if lookahead is None else min(max(lookahead, 0), control.ahead)
        self.most = control.before + BLOCK + control.ahead


class FlowGenerator(Generator):
    """The Flow-VAE, and MoGlow. lookahead: frames ahead that are known, 0..ahead, at least those of the
    piece that is made. first: the pose `[X]` before, standardised. guidance: as `chunks.GUIDANCE`, of a
    model that has learned to be guided.
    """

    def __init__(
        self,
        w: Weights,
        sizes: FlowSizes,
        first: Array,
        temperature: float,
        lookahead: int | None,
        guidance: float = 1.0,
    ) -> None:
        control = sizes.control
        self._hears(control, None if lookahead is None else max(lookahead, sizes.span - 1))
        self.made, self.temperature = sizes.span, np.float32(temperature)
        self.flow, self.decoder, self.noise = FlowDrawing(w, sizes), vae.Decoder(w, sizes), Noise(sizes.dims)
        self.hearing = EncoderHearing(w, control, self.needed, self.flow)
        self.guidance = np.float32(guidance if sizes.guided else 1.0)
        self.deaf: FlowDrawing | None = None  # the same flow without sound, with memory of its own
        if self.guidance != 1:
            self.deaf = FlowDrawing(w, sizes)
            self.without = EncoderHearing(w, control, self.needed, self.deaf)
        self.guess = vae.Guess(w) if sizes.guess else None
        self.length = 0.0  # of what the guess lacked of the last code, as it was drawn
        held = first[None].astype(np.float32)
        if sizes.guess:
            held = vae.encode_spans(w, sizes, np.tile(held, sizes.span)).astype(np.float32)
        self.past = np.repeat(held, control.past, 0)  # codes where there is a guess, else poses
        self.summary: list[Dense] = []  # what is known of the past poses
        if control.kind == "encoder" and control.past:
            self.summary = [Dense.named(w, "past.0"), Dense.named(w, "past.2")]

    def step(self, heard: Array, seed: int, take: int, frame: int) -> Array:
        told = self.hearing.of(frame, heard)
        before = past = self.past.reshape(-1)
        for n, layer in enumerate(self.summary):
            past = layer.one(np.maximum(past, 0, out=past) if n else past)
        z = self.noise.of(seed, take, frame) * self.temperature
        with np.errstate(over="ignore", invalid="ignore"):
            code = self.flow.draw(z, past, told)
            if self.deaf is not None:
                code = self._guided(code, self.deaf.draw(z, past, self.without.of(frame, _unheard(heard))))
            if not isfinite(code @ code):  # a flow that ran away begins again
                code[:] = 0
                self.flow.reset()
                if self.deaf is not None:
                    self.deaf.reset()
        if self.guess is not None:
            self.length = float(np.sqrt(code @ code))
            code = _near(
                self.guess.one(before, code * np.float32(self.guess.lengths.find_share(self.length)))
            )
            self.past = np.concatenate([self.past, code[None]])[-len(self.past) :]
        poses = _near(self.decoder.one(code)).reshape(self.made, -1)
        if self.guess is None and len(self.past):
            self.past = np.concatenate([self.past, poses])[-len(self.past) :]
        return poses

    def _guided(self, code: Array, without: Array) -> Array:
        """Return a code further from what the same noise gives without sound."""
        return np.asarray(without + self.guidance * (code - without), np.float32)


class CvaeGenerator(Generator):
    """The paper's CVAE."""

    made = 1

    def __init__(self, w: Weights, sizes: CvaeSizes, temperature: float, lookahead: int | None) -> None:
        self._hears(sizes.control, lookahead)
        self.decoder, self.noise = cvae.CvaeDrawing(w, sizes), Noise(sizes.dims)
        self.hearing = EncoderHearing(w, sizes.control, self.needed, self.decoder)
        self.temperature = np.float32(temperature)

    def step(self, heard: Array, seed: int, take: int, frame: int) -> Array:
        told = self.hearing.of(frame, heard)
        return _near(self.decoder.draw(self.noise.of(seed, take, frame) * self.temperature, told))[None]


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
        self.needed = sizes.most if lookahead is None else min(max(lookahead, 0), sizes.most)
        # What is kept is not made long before it is heard.
        kept = min(sizes.new, max(1, (self.needed + 1) // sizes.frames)) if keep is None else keep
        if not 1 <= kept <= sizes.new:
            raise ValueError(f"{kept} of {sizes.new} tokens cannot be kept")
        self.kept, self.made = kept, kept * sizes.frames
        self.before, self.ahead = sizes.past * sizes.frames, sizes.most
        self.most = self.before + 1 + self.ahead
        self.hearing, self.drawing = (
            ChunkHearing(w, sizes, self.needed),
            chunks.TokenDrawing(w, sizes, guidance),
        )
        self.pieces = self.drawing.pieces + 2
        self.past = chunks.make_still_tokens(w, sizes, first)
        self._joining = chunks.Joining(w, sizes, kept)
        self.delay = self._joining.delay

    def step(self, heard: Array, seed: int, take: int, frame: int) -> Array:
        *_, last = self.steps(heard, seed, take, frame)
        assert last is not None
        return last

    def steps(self, heard: Array, seed: int, take: int, frame: int) -> Iterator[Array | None]:
        sizes = self.sizes
        window = np.zeros((self.most, heard.shape[1]), heard.dtype)
        window[: len(heard)] = heard[: self.most]
        told = self.hearing.of(window)
        yield None
        z = draw_noise(seed, take, frame, sizes.new * sizes.dims).reshape(sizes.new, sizes.dims)
        tokens = z * (chunks.SPREAD * self.temperature)
        for n, drawn in enumerate(self.drawing.drawing(tokens, self.past, told)):
            tokens = drawn
            if n < self.drawing.pieces:
                yield None
        tokens = _near(tokens[: self.kept])
        self.past = np.concatenate([self.past, tokens])[-sizes.past :]
        yield _near(self._joining.of(tokens))

    def rest(self) -> Array | None:
        return _near(self._joining.rest()) if self.delay else None


def _unheard(heard: Array) -> Array:
    """Return features `[n, audio + 4]` of which only who speaks is left."""
    out = np.zeros_like(heard)
    out[:, -ACTIVITY:] = heard[:, -ACTIVITY:]
    return out


def _near(poses: Array) -> Array:
    """Return poses of which no number is further than FURTHEST."""
    return np.asarray(np.minimum(np.maximum(poses, -FURTHEST), FURTHEST))


def make_generator(
    w: Weights,
    sizes: Sizes,
    first: Array,
    temperature: float = 1.0,
    lookahead: int | None = None,
    guidance: float = chunks.GUIDANCE,
) -> Generator:
    """Return a model that begins again. first: the pose `[X]`, standardised, that it goes on from. lookahead:
    frames ahead that are known, None for all it can use.
    """
    if isinstance(sizes, FlowSizes):
        return FlowGenerator(w, sizes, first, temperature, lookahead, guidance)
    if isinstance(sizes, CvaeSizes):
        return CvaeGenerator(w, sizes, temperature, lookahead)
    return MatchingGenerator(w, sizes, first, temperature, lookahead, guidance)
