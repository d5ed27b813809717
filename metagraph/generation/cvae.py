"""The conditional variational autoencoder that the paper compares with: LSTMs from a code per frame to
poses.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.generation.layers import Layers, apply_linear, apply_lstm, make_lstm_state
from metagraph.generation.networks import CvaeSizes
from metagraph.generation.prepared import Cells, Dense

Array = NDArray[Any]


def encode_cvae(w: Layers, sizes: CvaeSizes, poses: Array, context: Array) -> tuple[Array, Array]:
    """Return mean and log variance `[..., T, D]` of each frame's code. poses: `[..., T, X]`, standardised;
    context: `[..., T, C]`.
    """
    state = make_lstm_state(w, "encoder", sizes.layers, poses.shape[:-2])
    hidden, _ = apply_lstm(w, "encoder", np.concatenate([poses, context], -1), state)
    told = apply_linear(w, "encoder_out", hidden)
    return told[..., : sizes.dims], told[..., sizes.dims :]


def decode_cvae(w: Layers, sizes: CvaeSizes, codes: Array, context: Array) -> Array:
    """Return poses `[..., T, X]`, standardised, of codes `[..., T, D]`."""
    state = make_lstm_state(w, "decoder", sizes.layers, codes.shape[:-2])
    hidden, _ = apply_lstm(w, "decoder", np.concatenate([codes, context], -1), state)
    return apply_linear(w, "decoder_out", hidden)


class CvaeDrawing:
    """The decoder, frame by frame."""

    def __init__(self, w: Layers, sizes: CvaeSizes) -> None:
        self._cells = Cells(w, "decoder", sizes.layers, sizes.dims, w["decoder_out.bias"].dtype)
        self._out = Dense.named(w, "decoder_out")
        # What `draw` wants of what is heard, `[n, 4N]` of `[n, C]`; and of the numbers that came later.
        self.told, self.more = self._cells.told, self._cells.more

    def draw(self, code: Array, told: Array) -> Array:
        """Return the next frame's pose `[X]`, standardised, of its code `[D]`; it lasts until the next call.
        told: `[4N]`, as `told` gives it.
        """
        self._cells.own[:] = code
        return self._out.one(self._cells.step(told))
