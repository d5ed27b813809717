"""Decide which proposals a person should check: how likely each is wrong, and why.

The window, the command line and the report all use this. The probability comes from the confidences within a
proposal, weighted by a logistic regression over labelled and made sets. `tests/benchmarks/fit_flags.py`
prints the weights, and how right they are on sets they were not fitted on.
"""

from __future__ import annotations

from collections.abc import Container
from math import exp, log
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.suggest.estimate import Belief
from metagraph.suggest.proposal import Proposal

Array = NDArray[Any]

ALIKE = 0.3  # share of a check's gain that each other clip with the same words adds
LOOK = 0.2  # probability of being wrong; from this on a check is worth its time
PLACED = 0.6  # confidence of a stance or layer; below it, it may be the wrong one, whatever else is certain
FITTING = 0.8  # the same for a clip that would jump in that stance
LOST = 0.5  # confidence below which a stance is almost unknown
UNLIKELY = 0.4  # confidence of a stance; below it a clip is not placed unless somebody says so
WEIGHTS = (
    -2.843,
    0.695,
    0.429,
    1.023,
    1.927,
    -0.313,
    -0.24,
    0.403,
    0.712,
    0.918,
    -4.647,
)  # `fit_flags.py` prints them


def measure_proposal(p: Proposal) -> Array:
    """Return what a proposal says about itself `[11]`: 1, the logits of kind, of layer and of where a
    transition ends (0 for other kinds), whether it is a gesture or fidget, which are the hardest to tell
    apart, whether its name says its kind, whether its stance is almost unknown, the logit of its kind by the
    motion alone (0 if nobody looked at it), whether it is a fidget, whether it is of the body, and of how
    many clips beside it sources disagree.

    The confidence of the stance, its own sources' disagreement and a visible jump said nothing more about
    right and wrong on the sets that the weights were fitted on.
    """
    end = p.end_stance.confidence if p.end_stance is not None else 0.02
    return np.array(
        [
            1.0,
            _logit(p.kind.confidence),
            _logit(p.layer.confidence),
            _logit(end) if p.kind.value == "transition" else 0.0,
            float(p.kind.value in ("gesture", "fidget")),
            float(p.said),
            float(p.stance is None or p.stance.confidence < LOST),
            _logit(p.seen) if p.seen is not None else 0.0,
            float(p.kind.value == "fidget"),
            float(p.layer.value == "body"),
            p.disputed,
        ]
    )


def _fitted_chance(p: Proposal) -> float:
    """Return how likely a proposal is wrong by the regression, 0..1."""
    return 1 / (1 + exp(float(np.clip(measure_proposal(p) @ np.array(WEIGHTS), -30, 30))))


def needs_look(p: Proposal, left: Container[str] = ()) -> bool:
    """Return whether somebody should check a proposal: it may well be wrong, nobody can be sure where it
    belongs, or it was not placed. `left` are the clips that were not placed.
    """
    return p.clip in left or estimate_chance_wrong(p) > LOOK


def is_unlikely(p: Proposal) -> bool:
    """Return whether the stance of a proposal, or the one that a transition ends in, is so unlikely that only
    a person can place its clip. A resting clip is itself what its stance looks like.
    """
    return p.kind.value != "stance" and _least_certain_stance(p) < UNLIKELY


def _least_certain_stance(p: Proposal) -> float:
    where = [p.stance, p.end_stance] if p.kind.value == "transition" else [p.stance]
    return min(belief.confidence if belief is not None else 0.0 for belief in where)


def estimate_chance_wrong(p: Proposal) -> float:
    """Return how likely a proposal is wrong in what decides where its clip goes, 0..1. It is also wrong if
    nobody can be sure of its stance, or of the one that a transition ends in: a clip that begins 40 cm from
    its stance belongs elsewhere, whatever its name says. A clip that would jump there has to be more certain.
    The same holds for its layer.
    """
    stance, layer = _least_certain_stance(p), p.layer.confidence
    return max(
        _fitted_chance(p),
        1 - stance if stance < (FITTING if p.good is False else PLACED) else 0.0,
        1 - layer if layer < PLACED else 0.0,
    )


def explain_doubt(p: Proposal) -> str:
    """Return how likely a proposal is wrong and why, in words."""
    chance = f"wrong with a probability of {100 * estimate_chance_wrong(p):.0f} %"
    if p.conflicts:
        return f"{chance}: {p.conflicts[0]}"
    beliefs: list[tuple[str, Belief[Any] | None]] = [
        ("kind", p.kind),
        ("layer", p.layer),
        ("stance", p.stance),
    ]
    if p.kind.value == "transition":
        beliefs.append(("end", p.end_stance))
    name, least = min(beliefs, key=lambda x: x[1].confidence if x[1] is not None else 0.0)
    if least is None:
        return f"{chance}: there is no evidence of its {name}"
    return f"{chance}: its {name} is {100 * least.confidence:.0f} % certain, {least.reason}"


def estimate_gain(p: Proposal) -> float:
    """Return what checking a proposal would gain: its probability of being wrong, more if other clips have
    the same words, because a correction corrects them, too.
    """
    share = p.details.get("likelihood")
    alike = round(1 / share.value) if share is not None and share.value > 0 else 1
    return estimate_chance_wrong(p) * (1 + ALIKE * (min(alike, 10) - 1))


def _logit(p: float) -> float:
    p = min(0.995, max(0.005, p))
    return log(p / (1 - p))
