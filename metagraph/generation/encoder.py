"""What a network hears of a frame: the window of audio and activity, and the poses before."""

from __future__ import annotations

from math import gcd
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from metagraph.generation.layers import Layers, apply_linear, relu
from metagraph.generation.networks import Control, MatchingSizes
from metagraph.generation.prepared import Dense

Array = NDArray[Any]

BLOCK = 8  # frames that are heard at once, from multiples of it on


class EncoderConvolutions:
    """The layers over audio and activity. share: of what could be known ahead, 0..1."""

    def __init__(self, w: Layers, dilations: tuple[int, ...], share: float) -> None:
        first = w["control.input.weight"][:, :, 0].T
        bias = w["control.input.bias"]
        self._input = Dense(first[:-1], bias + first[-1] * np.asarray(share, bias.dtype))
        self._layers = []
        for n in range(len(dilations)):
            weight = w[f"control.blocks.{n}.weight"]  # [out, in, 3]
            flat = weight.transpose(2, 1, 0).reshape(-1, len(weight))
            self._layers.append(Dense(flat, w[f"control.blocks.{n}.bias"]))
        self.dilations = dilations

    def input(self, features: Array) -> Array:
        """Return `[..., T, width]` of frames `[..., T, inputs]`."""
        out = self._input.rows(features)
        return np.maximum(out, 0, out=out)

    def layer(self, n: int, x: Array, apart: int) -> Array:
        """Return `[..., T - 2 apart, width]` of `[..., T, width]`. apart: rows to its neighbours."""
        left = x.shape[-2] - 2 * apart
        if left < 1:
            raise ValueError(f"{x.shape[-2]} frames are too few for a convolution over {1 + 2 * apart}")
        middle = x[..., apart : apart + left, :]
        out = self._layers[n].rows(np.concatenate([x[..., :left, :], middle, x[..., 2 * apart :, :]], -1))
        np.maximum(out, 0, out=out)
        out += middle
        return out

    def whole(self, features: Array) -> Array:
        """Return `[..., T - 2 sum of dilations, width]` of frames `[..., T, inputs]`."""
        x = self.input(features)
        for n, dilation in enumerate(self.dilations):
            x = self.layer(n, x, dilation)
        return x

    def window(self, features: Array) -> Array:
        """Return `[..., width]` of windows `[..., 2 sum of dilations + 1, inputs]`."""
        x = self.input(features)
        apart = 1  # only what the one result is made of: every second, fourth ... frame
        for n, dilation in enumerate(self.dilations):
            x = self.layer(n, x, dilation // apart)
            if rest := self.dilations[n + 1 :]:
                x = x[..., :: gcd(*rest) // apart, :]
                apart = gcd(*rest)
        return np.asarray(x[..., 0, :])


class Reader(Protocol):
    """Who reads what is heard, by a product whose terms may be computed one after the other."""

    def told(self, heard: Array, /) -> Array:
        """Return what is made of rows `[n, C]` heard at once: `[n, ...]`."""

    def more(self, heard: Array, first: int, /) -> Array:
        """Return what numbers `[m]` of one row, from number `first` on, add where they were 0."""


class EncoderHearing:
    """What is heard of frame after frame, in products of the same shape at the same frames whenever they are
    known, so that the pieces that sound comes in change no bit. lookahead: frames ahead that are known.
    """

    def __init__(self, w: Layers, control: Control, lookahead: int, reader: Reader | None = None) -> None:
        self.control, self.lookahead, self._reader = control, lookahead, reader
        self._layers: EncoderConvolutions | None = None
        if control.kind == "encoder":
            self._layers = EncoderConvolutions(w, control.dilations, _share(lookahead, control.ahead))
        # Convolutions share nothing unless they know all ahead; then a few frames cost hardly more than one.
        # The paper's windows are long: what all of a few frames know already is reported at once.
        shared = lookahead == control.ahead if self._layers else control.before + lookahead >= BLOCK
        self._block = BLOCK if shared else 1
        self._features = np.zeros((control.frames + self._block - 1, control.inputs), np.float32)
        self._from, self._until = 0, -1  # the frames that are known of what was made last
        self._made = np.zeros(0, np.float32)

    def rows(self, windows: Array) -> Array:
        """Return what is heard in windows `[..., frames, inputs]`, each by itself: `[..., C]`."""
        known = mask_after(windows, self.control.before + self.lookahead)
        if self._layers is None:
            return np.asarray(known.reshape(*known.shape[:-2], -1))
        return self._layers.window(known)

    def whole(self, features: Array) -> Array:
        """Return `[T, C]` of frames that know all ahead. features: `[before + T + ahead, inputs]`."""
        if self._layers is None:
            return list_windows(features, self.control.frames).reshape(
                len(features) - self.control.frames + 1, -1
            )
        return self._layers.whole(features)

    def of(self, frame: int, heard: Array) -> Array:
        """Return what the reader made of a frame. heard: features from `before` frames before it on, as many
        as are known, `before + 1 + lookahead` at least.
        """
        assert self._reader is not None
        control, at = self.control, frame % self._block
        first = control.before + self.lookahead + 1  # frames of a window that may be known
        if not self._from <= frame < self._until:
            most = heard[: len(self._features) - at]
            self._features[at : at + len(most)] = most  # what is before or after is of no use, and not used
            if self._block > 1 and self._layers is None:
                told = self.rows(list_windows(mask_after(self._features, first - 1), control.frames))
                ready = self._block
            else:
                told = self.whole(self._features) if self._block > 1 else self.rows(self._features[None])
                ready = at + len(heard) - first + 1
            self._made = self._reader.told(told)
            self._from, self._until = frame, frame - at + min(self._block, ready)
        if self._layers is None and at and self._block > 1:
            late = heard[first - at : first].reshape(-1)  # came after the block's first frame
            return np.asarray(self._made[at] + self._reader.more(late, (first - at) * control.inputs))
        return np.asarray(self._made[at])


def encode_window(w: Layers, control: Control, window: Array, lookahead: int) -> Array:
    """Return what is heard of frames, each with its own window: `[..., width]`, or the window flat. window:
    `[..., frames, inputs]`, standardised. lookahead: how many frames ahead are known, 0..ahead.
    """
    return EncoderHearing(w, control, lookahead).rows(window)


def encode_all(w: Layers, control: Control, features: Array) -> Array:
    """Return what is heard of frames that know all ahead: `[T, width]`. features: `[before + T + ahead,
    inputs]`, standardised, with what was before the first and comes after the last.
    """
    return EncoderHearing(w, control, control.ahead).whole(features)


def encode_past(w: Layers, control: Control, poses: Array) -> Array:
    """Return what is known of the poses before a frame, `[..., width]`, or the poses flat. poses: `[...,
    past, X]`, standardised, oldest first.
    """
    flat = poses.reshape(*poses.shape[:-2], -1)
    if control.kind == "window" or not control.past:
        return np.asarray(flat)
    return apply_linear(w, "past.2", relu(apply_linear(w, "past.0", flat)))


class ChunkHearing:
    """What is heard of a chunk's tokens. lookahead: frames after its first new one that are known."""

    def __init__(self, w: Layers, sizes: MatchingSizes, lookahead: int) -> None:
        self.sizes, self.lookahead, self._w = sizes, lookahead, w
        self._layers = EncoderConvolutions(w, sizes.dilations, _share(lookahead, sizes.most))
        self._token = Dense.named(w, "control.token")

    def of(self, features: Array) -> Array:
        """Return `[2, tokens, hidden]`: with sound, and of who sees who speaks and hears nothing. features:
        `[tokens * frames, inputs]`, standardised.
        """
        s = self.sizes
        known = mask_after(features, s.past * s.frames + self.lookahead)
        both = np.stack([known, known])
        both[1, :, : s.audio] = 0
        x = self._layers.input(both)
        for n, dilation in enumerate(s.dilations):
            edge = np.zeros((2, dilation, s.width), x.dtype)
            x = self._layers.layer(n, np.concatenate([edge, x, edge], 1), dilation)
        told = self._token.rows(x.reshape(2, s.tokens, -1))
        told[1] += self._w["no_sound"]
        return told


def list_windows(features: Array, frames: int) -> Array:
    """Return every `frames` rows in a row, `[T - frames + 1, frames, inputs]`; a view."""
    return np.moveaxis(np.lib.stride_tricks.sliding_window_view(features, frames, axis=0), -1, 1)


def mask_after(window: Array, last: int) -> Array:
    """Return frames `[..., frames, inputs]` with those after number `last` at 0."""
    if last >= window.shape[-2] - 1:
        return window
    out = window.copy()
    out[..., last + 1 :, :] = 0
    return out


def _share(lookahead: int, most: int) -> float:
    """Return how much of what could be known ahead is known, 0..1; 1 if there is nothing to know."""
    return lookahead / most if most else 1.0
