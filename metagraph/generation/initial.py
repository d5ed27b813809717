"""Weights to begin training with."""

from __future__ import annotations

from math import prod

import numpy as np

from metagraph.generation.networks import MatchingSizes, Sizes, Weights, list_weight_shapes


def make_initial_weights(sizes: Sizes, seed: int = 1) -> Weights:
    """Return weights to begin with, float32: torch's own ranges (uniform within 1 / sqrt(inputs)), rotations
    as the flow's matrices, zero where a layer should begin by doing nothing, as a guess does. What is
    computed from the data (means, deviations, bases, actnorm) leaves it as it is.
    """
    chance = np.random.default_rng(seed)
    out: Weights = {}
    shapes = list_weight_shapes(sizes)
    for name, shape in shapes.items():
        last = name.rsplit(".", 1)[-1]
        if name in out:
            continue
        if last == "p":
            out.update(_rotation(name[: -len("p")], shape[0], chance))
        elif last in ("basis", "spread"):
            out[name] = np.eye(*shape, dtype=np.float32)
        elif last in ("mean", "bias_hh_l0", "logs") or ".actnorm." in name or _silent(name):
            out[name] = np.zeros(shape, np.float32)
        elif last == "deviation":
            out[name] = np.ones(shape, np.float32)
        elif last in ("place", "no_past", "no_sound"):
            out[name] = (0.02 * chance.standard_normal(shape)).astype(np.float32)
        else:
            around = name.replace(".bias", ".weight") if last == "bias" else name
            inputs = prod(shapes[around][1:]) if "_l" not in last else _units(sizes)
            bound = 1 / np.sqrt(max(1, inputs))
            out[name] = chance.uniform(-bound, bound, shape).astype(np.float32)
    return {name: out[name] for name in shapes}


def _units(sizes: Sizes) -> int:
    """Return the units of the LSTMs, 1 if there is none."""
    return 1 if isinstance(sizes, MatchingSizes) else sizes.units


def _silent(name: str) -> bool:
    """Whether a layer begins at zero: the couplings' outputs, the transformer's modulations and its
    result.
    """
    flow = name.startswith("flow.") and ".out." in name
    return flow or ".modulation." in name or "final.out" in name or name.startswith("guess.")


def _rotation(prefix: str, dims: int, chance: np.random.Generator) -> Weights:
    """Return a random rotation taken apart: P L (U + diag(sign exp(log_s)))."""
    wanted = np.linalg.qr(chance.standard_normal((dims, dims)))[0]
    rest, order, lower = wanted.copy(), np.arange(dims), np.eye(dims)
    for n in range(dims):  # with the largest pivot
        best = n + int(np.argmax(np.abs(rest[n:, n])))
        rest[[n, best]], order[[n, best]] = rest[[best, n]], order[[best, n]]
        lower[[n, best], :n] = lower[[best, n], :n]
        lower[n + 1 :, n] = rest[n + 1 :, n] / rest[n, n]
        rest[n + 1 :] -= np.outer(lower[n + 1 :, n], rest[n])
    permutation = np.zeros((dims, dims))
    permutation[order, np.arange(dims)] = 1
    pivots = np.diag(rest)
    parts = {
        "p": permutation,
        "lower": np.tril(lower, -1),
        "upper": np.triu(rest, 1),
        "sign": np.sign(pivots),
        "log_s": np.log(np.abs(pivots)),
    }
    return {prefix + name: part.astype(np.float32) for name, part in parts.items()}
