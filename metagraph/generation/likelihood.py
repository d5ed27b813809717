"""How likely recorded motion is to a flow: a whole take at once, each moment given those before it."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.generation import vae
from metagraph.generation.encoder import encode_all, encode_past, encode_window, list_windows
from metagraph.generation.features import with_edges
from metagraph.generation.flow import FlowWeights
from metagraph.generation.networks import FlowSizes
from metagraph.generation.stored import Model

Array = NDArray[Any]


def make_flow_contexts(
    model: Model, sizes: FlowSizes, poses: Array, features: Array, lookahead: int | None = None
) -> Array:
    """Return what enters a flow at each step of time `[T // span, C]`. poses: `[T, X]`, standardised, those
    before the first are the mean pose; features: `[T, audio + 4]`, not standardised.
    """
    return _contexts(model, sizes, poses, features, lookahead)[0]


def _contexts(
    model: Model, sizes: FlowSizes, poses: Array, features: Array, lookahead: int | None
) -> tuple[Array, Array]:
    """Return the contexts, and what the flow knows of the past `[T // span, past, X or D]`."""
    control = sizes.control
    heard = model.heard(with_edges(features, control.before, control.ahead))
    if lookahead is None or lookahead >= control.ahead:
        told = encode_all(model.weights, control, heard)
    else:
        known = max(lookahead, sizes.span - 1)  # as `generators.FlowGenerator` waits for
        told = encode_window(model.weights, control, list_windows(heard, control.frames), known)
    count = len(poses) // sizes.span
    told = told[: count * sizes.span : sizes.span]
    if not control.past:
        return told, np.zeros((count, 0, sizes.told), poses.dtype)
    padded = np.concatenate([np.zeros((sizes.before, poses.shape[1]), poses.dtype), poses])
    if sizes.guess:
        codes = vae.encode_spans(model.weights, sizes, vae.list_spans(padded, sizes.span))
        before = list_windows(codes, control.past)[:count]
    else:
        before = list_windows(padded, control.past)[: count * sizes.span : sizes.span]
    return np.concatenate([encode_past(model.weights, control, before), told], -1), before


def find_noise(
    model: Model, poses: Array, features: Array, lookahead: int | None = None
) -> tuple[Array, Array]:
    """Return the noise `[n, D]` that would have made poses `[T, X]`, not standardised, and the natural
    logarithm of the density of each step's code `[n]`: comparable between models of one code alone.
    features: `[T, audio + 4]`. Raises ValueError for a model without a flow.
    """
    sizes = model.card.sizes
    if not isinstance(sizes, FlowSizes):
        raise ValueError(f"a {model.card.kind} model has no likelihood")
    if len(poses) != len(features):
        raise ValueError(f"{len(poses)} poses cannot go with {len(features)} frames of sound")
    standard = model.poses.apply(poses)
    codes = vae.encode_spans(model.weights, sizes, vae.list_spans(standard, sizes.span))
    context, before = _contexts(model, sizes, standard, features, lookahead)
    spread: Any = 0.0
    if sizes.guess:
        guess = vae.Guess(model.weights)
        lacked = guess.find_lacked(codes, before.reshape(len(before), -1))
        codes, further = guess.lengths.undo(lacked)
        spread = guess.log_spread - further
    z, logs, _ = FlowWeights(model.weights, sizes).forward(codes, context)
    logs = logs - spread
    return z, np.asarray(logs - 0.5 * (z * z + np.log(2 * np.pi)).sum(-1))
