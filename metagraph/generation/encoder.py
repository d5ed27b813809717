"""What a network hears of a frame: the window of audio and activity, and the poses before."""

from __future__ import annotations

from math import gcd
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.generation.layers import Layers, conv1d, linear, relu
from metagraph.generation.networks import Control, MatchingSizes

Array = NDArray[Any]


def encode_window(w: Layers, control: Control, window: Array, lookahead: int) -> Array:
    """Return what is heard of frames, each with its own window: `[..., width]`, or the window flat. window:
    `[..., frames, inputs]`, standardised. lookahead: how many frames ahead are known, 0..ahead.
    """
    window = masked(window, control.before + lookahead)
    if control.kind == "window":
        return np.asarray(window.reshape(*window.shape[:-2], -1))
    x = relu(conv1d(w, "control.input", _told(window, _share(lookahead, control.ahead))))
    apart = 1  # only what the one result is made of: every second, fourth ... frame
    for n, dilation in enumerate(control.dilations):
        step = dilation // apart
        x = x[..., step:-step, :] + relu(conv1d(w, f"control.blocks.{n}", x, step))
        if rest := control.dilations[n + 1 :]:
            x = x[..., :: gcd(*rest) // apart, :]
            apart = gcd(*rest)
    return np.asarray(x[..., 0, :])


def encode_all(w: Layers, control: Control, features: Array) -> Array:
    """Return what is heard of frames that know all ahead: `[T, width]`. features: `[before + T + ahead,
    inputs]`, standardised, with what was before the first and comes after the last.
    """
    if control.kind == "window":
        return windows(features, control.frames).reshape(len(features) - control.frames + 1, -1)
    x = relu(conv1d(w, "control.input", _told(features, 1.0)))
    for n, dilation in enumerate(control.dilations):
        x = x[..., dilation:-dilation, :] + relu(conv1d(w, f"control.blocks.{n}", x, dilation))
    return np.asarray(x)


def encode_past(w: Layers, control: Control, poses: Array) -> Array:
    """Return what is known of the poses before a frame, `[..., width]`, or the poses flat. poses: `[...,
    past, X]`, standardised, oldest first.
    """
    flat = poses.reshape(*poses.shape[:-2], -1)
    if control.kind == "window" or not control.past:
        return np.asarray(flat)
    return linear(w, "past.2", relu(linear(w, "past.0", flat)))


def encode_chunk(
    w: Layers, sizes: MatchingSizes, features: Array, lookahead: int, sound: bool = True
) -> Array:
    """Return what is heard of each token `[..., tokens, hidden]`. features: `[..., tokens * frames, inputs]`,
    standardised. lookahead: frames after the chunk's first new one that are known, 0..most. sound: False for
    who sees who speaks and hears nothing.
    """
    if not sound:
        features = features.copy()
        features[..., : sizes.audio] = 0
    known = masked(features, sizes.past * sizes.frames + lookahead)
    x = relu(conv1d(w, "control.input", _told(known, _share(lookahead, sizes.most))))
    for n, dilation in enumerate(sizes.dilations):
        edge = [(0, 0)] * (x.ndim - 2) + [(dilation, dilation), (0, 0)]
        x = x + relu(conv1d(w, f"control.blocks.{n}", np.pad(x, edge), dilation))
    told = linear(w, "control.token", x.reshape(*x.shape[:-2], sizes.tokens, -1))
    return told if sound else told + w["no_sound"]


def windows(features: Array, frames: int) -> Array:
    """Return every `frames` rows in a row, `[T - frames + 1, frames, inputs]`; a view."""
    return np.moveaxis(np.lib.stride_tricks.sliding_window_view(features, frames, axis=0), -1, 1)


def masked(window: Array, last: int) -> Array:
    """Return frames `[..., frames, inputs]` with those after number `last` at 0."""
    if last >= window.shape[-2] - 1:
        return window
    out = window.copy()
    out[..., last + 1 :, :] = 0
    return out


def _share(lookahead: int, most: int) -> float:
    """Return how much of what could be known ahead is known, 0..1; 1 where there is nothing to know."""
    return lookahead / most if most else 1.0


def _told(features: Array, share: float) -> Array:
    """Return frames with the look-ahead as one input more."""
    told = np.full((*features.shape[:-1], 1), share, features.dtype)
    return np.concatenate([features, told], -1)
