"""The conditional variational autoencoder that the paper compares with: LSTMs from a code per frame to
poses.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.generation.layers import Layers, State, linear, lstm, lstm_state, lstm_step
from metagraph.generation.networks import CvaeSizes

Array = NDArray[Any]


def encode(w: Layers, sizes: CvaeSizes, poses: Array, context: Array) -> tuple[Array, Array]:
    """Return mean and log variance `[..., T, D]` of each frame's code. poses: `[..., T, X]`, standardised;
    context: `[..., T, C]`.
    """
    state = lstm_state(w, "encoder", sizes.layers, poses.shape[:-2])
    hidden, _ = lstm(w, "encoder", np.concatenate([poses, context], -1), state)
    told = linear(w, "encoder_out", hidden)
    return told[..., : sizes.dims], told[..., sizes.dims :]


def decode(w: Layers, sizes: CvaeSizes, codes: Array, context: Array) -> Array:
    """Return poses `[..., T, X]`, standardised, of codes `[..., T, D]`."""
    state = lstm_state(w, "decoder", sizes.layers, codes.shape[:-2])
    hidden, _ = lstm(w, "decoder", np.concatenate([codes, context], -1), state)
    return linear(w, "decoder_out", hidden)


def start(w: Layers, sizes: CvaeSizes) -> State:
    """Return the decoder's state at a recording's start."""
    return lstm_state(w, "decoder", sizes.layers)


def draw(w: Layers, code: Array, context: Array, state: State) -> tuple[Array, State]:
    """Return one frame's pose `[X]`, standardised, of its code `[D]`, and the next state."""
    hidden, after = lstm_step(w, "decoder", np.concatenate([code, context]), state)
    return linear(w, "decoder_out", hidden), after
