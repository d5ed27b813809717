"""Which proposals somebody should look at: how likely each is wrong, and what makes it so.

One answer for the window, the command line and the report. The chance comes from what the parts of a
proposal say of themselves, weighed by a logistic regression over labelled and made sets:
`tests/benchmarks/fit_flags.py` prints the weights, and how right they are on sets they were not fitted on.
"""

from __future__ import annotations

from math import exp, log
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.suggest.proposal import Proposal

Array = NDArray[Any]

LOOK = 0.3  # chance of being wrong, from which on a look is worth its time
WEIGHTS = (0.5, 0.6, 0.3, 0.1, 0.0)  # of `measures`


def measures(p: Proposal) -> Array:
    """Return what a proposal says of itself `[5]`: 1, logits of kind, of stance and of where a transition
    ends (0 of what is none), and whether its sources disagree.
    """
    end = p.end_stance.confidence if p.end_stance is not None else 0.02
    return np.array(
        [
            1.0,
            _logit(p.kind.confidence),
            _logit(p.stance.confidence if p.stance is not None else 0.02),
            _logit(end) if p.kind.value == "transition" else 0.0,
            float(bool(p.conflicts)),
        ]
    )


def chance_wrong(p: Proposal) -> float:
    """Return how likely a proposal is wrong in what decides where its clip goes, 0..1."""
    return 1 / (1 + exp(float(np.clip(measures(p) @ np.array(WEIGHTS), -30, 30))))


def _logit(p: float) -> float:
    p = min(0.995, max(0.005, p))
    return log(p / (1 - p))
