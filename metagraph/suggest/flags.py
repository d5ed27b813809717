"""Which proposals somebody should look at: how likely each is wrong, and what makes it so.

One answer for the window, the command line and the report. The chance comes from what the parts of a
proposal say of themselves, weighed by a logistic regression over labelled and made sets:
`tests/benchmarks/fit_flags.py` prints the weights, and how right they are on sets they were not fitted on.
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

ALIKE = 0.3  # of a look's worth, that each other clip of the same words adds
LOOK = 0.2  # chance of being wrong, from which on a look is worth its time
LOST = 0.5  # confidence, below which a stance is hardly known at all
WEIGHTS = (-1.969, 1.036, 0.36, 0.527, 1.967, -2.112, 0.158)  # of `measures`, as `fit_flags.py` prints them


def proposal_measures(p: Proposal) -> Array:
    """Return what a proposal says of itself `[7]`: 1, logits of kind, of layer and of where a transition ends
    (0 of what is none), whether it is an act, a gesture or fidget, which are the hardest to tell apart,
    whether its name says its kind, and whether its stance is hardly known.

    How sure a stance is, whether the sources disagree, and whether it would jump said nothing more about
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
        ]
    )


def chance_wrong(p: Proposal) -> float:
    """Return how likely a proposal is wrong in what decides where its clip goes, 0..1."""
    return 1 / (1 + exp(float(np.clip(proposal_measures(p) @ np.array(WEIGHTS), -30, 30))))


def needs_look(p: Proposal, left: Container[str] = ()) -> bool:
    """Return whether somebody should look at a proposal: it may well be wrong, or was not placed. left: clips
    that were not.
    """
    return p.clip in left or chance_wrong(p) > LOOK


def doubt(p: Proposal) -> str:
    """Return how likely a proposal is wrong and what makes it so, in words."""
    chance = f"{chance_wrong(p):.0%} likely wrong"
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
        return f"{chance}: nothing says its {name}"
    return f"{chance}: its {name} is {least.confidence:.0%} sure, {least.reason}"


def gain(p: Proposal) -> float:
    """Return what a look at a proposal would gain: its chance of being wrong, more where others are called
    alike, which a correction puts right along with it.
    """
    share = p.details.get("likelihood")
    alike = round(1 / share.value) if share is not None and share.value > 0 else 1
    return chance_wrong(p) * (1 + ALIKE * (min(alike, 10) - 1))


def _logit(p: float) -> float:
    p = min(0.995, max(0.005, p))
    return log(p / (1 - p))
