"""The keystroke-level model: how long an expert takes for a sequence of operators (Card, Moran and Newell
1980, "The Keystroke-Level Model for User Performance Time with Interactive Systems").

Where M goes, the rules of that paper in short: before a chain of keys or a pointing that begins a decision of
its own (rule 0), not before what is fully anticipated by the operator before it (rule 1), once for a unit
such as a word or a command (rule 2), not before what ends it (rule 3), and not before a key that ends a fixed
command (rule 4). Here a decision about a clip is such a unit, so is a command.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields


@dataclass(frozen=True)
class OperatorTimes:
    """Seconds an operator takes: K a key, by an average typist; P pointing at a target; B a button pressed or
    released; H a hand to the other device; M a mental preparation; S a scroll or zoom with the wheel to where
    something is, which takes about as long as pointing at it (Hinckley, Cutrell, Bathiche and Muss 2002,
    "Quantitative Analysis of Scrolling Techniques": Fitts' law holds for both). A wait for the system (R) and
    looking at motion (L) are given in seconds by whoever measures them.
    """

    K: float = 0.28
    P: float = 1.10
    B: float = 0.10
    H: float = 0.40
    M: float = 1.35
    S: float = 1.10


USUAL = OperatorTimes()


def predict_seconds(operators: Mapping[str, float], times: OperatorTimes = USUAL) -> float:
    """Return seconds for how many operators of each kind there were; R and L count as seconds themselves.
    Raises ValueError for a kind that there is not.
    """
    known = {f.name: float(getattr(times, f.name)) for f in fields(times)} | {"R": 1.0, "L": 1.0}
    odd = sorted(set(operators) - set(known))
    if odd:
        raise ValueError(f"'{odd[0]}' is no operator; there are {', '.join(known)}")
    return sum(known[name] * count for name, count in operators.items())
