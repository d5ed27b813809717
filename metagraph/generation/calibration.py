"""Calibrate how far a Flow-VAE moves, by the takes that it has learned from.

In training, a flow continues recorded motion. Its own motion has smaller steps, and continuing that makes
them smaller still: gestures come at the right places but are too small. So what the flow adds to the linear
guess is made longer, quantile by quantile, until it is as long as in the takes. Only the longer 40 % change:
if short ones grew, too, hands would never rest.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from metagraph.generation import vae
from metagraph.generation.chunks import GUIDANCE
from metagraph.generation.features import with_edges
from metagraph.generation.generators import FlowGenerator
from metagraph.generation.networks import KNOTS, FlowSizes
from metagraph.generation.stored import Model
from metagraph.generation.takes import Take

Array = NDArray[np.floating]

LEVELS = (0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.85, 0.9, 0.93, 0.96, 0.98, 0.99)
REST = 8  # number of the last level up to which lengths stay as they are drawn
ROUNDS = 3  # what is drawn depends on what came of what was drawn before
MOST = 8  # takes, evenly spread, that are enough
SEED = 1000  # of the first round


def fit_lengths(model: Model, takes: Sequence[Take], rounds: int = ROUNDS) -> Model:
    """Return a model whose longer lengths are brought to those of the takes that it has learned from; the
    same one if it has none.
    """
    sizes = model.card.sizes
    if not isinstance(sizes, FlowSizes) or sizes.knots != KNOTS:
        return model
    some = [t for t in takes[:: max(1, len(takes) // MOST)][:MOST] if len(t.poses) >= 4 * sizes.span]
    if not some:
        return model
    true = _list_quantiles([measure_true_lengths(model, take) for take in some])
    zero = np.zeros(KNOTS, np.float32)  # as it is drawn, to begin with
    own = replace(model, weights={**model.weights, "guess.drawn": zero, "guess.true": zero})
    for n in range(rounds):
        drawn = _list_quantiles([measure_drawn_lengths(own, take, SEED + n) for take in some])
        wanted = _leave_rest(drawn, true)
        own = replace(model, weights={**model.weights, "guess.drawn": drawn, "guess.true": wanted})
    return own


def _leave_rest(drawn: Array, true: Array) -> Array:
    """Return the lengths that drawn ones are brought to: their own up to REST, true ones at the last level,
    in between more and more of the true ones. A length is at least as long as the one before.
    """
    left = np.append(np.ones(REST), np.linspace(1, 0, KNOTS - REST))
    out = np.where(left == 1, drawn, true * (drawn[REST] / true[REST]) ** left)
    return _rising(out)


def measure_true_lengths(model: Model, take: Take) -> Array:
    """Return how long what the guess lacks of a take's codes is `[n]`, each going on from the true ones."""
    sizes = model.card.sizes
    assert isinstance(sizes, FlowSizes)
    rows = vae.list_spans(model.poses.apply(take.poses), sizes.span)
    codes, past = vae.encode_spans(model.weights, sizes, rows), sizes.control.past
    lacked = vae.Guess(model.weights).find_lacked(codes[past:], vae.join_past(codes, past))
    return np.asarray(np.linalg.norm(lacked, axis=1))


def measure_drawn_lengths(model: Model, take: Take, seed: int) -> Array:
    """Return how long what the flow draws to a take's sound is `[n]`, before it is brought to anything."""
    sizes = model.card.sizes
    assert isinstance(sizes, FlowSizes)
    maker = FlowGenerator(model.weights, sizes, np.zeros(sizes.pose, np.float32), 1.0, None, GUIDANCE)
    heard = model.heard(with_edges(take.features, maker.before, maker.most))
    out = []
    for frame in range(0, len(take.features) - sizes.span + 1, sizes.span):
        maker.step(heard[frame : frame + maker.most], seed, 0, frame)
        out.append(maker.length)
    return np.array(out)


def _list_quantiles(lengths: Sequence[Array]) -> Array:
    """Return the lengths at LEVELS, each longer than the one before: float32."""
    return _rising(np.quantile(np.concatenate(lengths), LEVELS))


def _rising(lengths: Array) -> Array:
    return np.asarray(np.maximum.accumulate(lengths) + 1e-4 * np.arange(1, KNOTS + 1), np.float32)
