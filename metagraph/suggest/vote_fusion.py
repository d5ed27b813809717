"""Combine several beliefs about one thing: each source votes for its value with its confidence, and against
all others with the rest.

For values v and sources i with value x_i and confidence c_i, of `count` possible values,

    p(v) ~ product over i of  c_i where v = x_i, else (1 - c_i) / (count - 1)

so agreement raises the confidence, conflict lowers it, and a source without a vote changes nothing.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import exp, log
from typing import Generic, TypeVar

from metagraph.common.wording import join_phrases, phrase
from metagraph.suggest.estimate import Belief

T = TypeVar("T")

LEAST, MOST = (
    0.02,
    0.995,
)  # nothing is certain: the sources depend on each other, and misjudge their own confidence
FIRM = 0.7  # from here on, two sources that disagree are a conflict to report


@dataclass(frozen=True, slots=True)
class Agreed(Generic[T]):
    """The combined belief of several sources.

    `belief` has the reasons of those that agree. `conflict` says in words where firm ones disagree, else it
    is empty.
    """

    belief: Belief[T]
    conflict: str = ""


def combine(votes: Sequence[Belief[T]], count: int) -> Agreed[T] | None:
    """Return the combined belief of sources about a thing that has `count` possible values; None without
    votes.
    """
    if not votes:
        return None
    values = list(dict.fromkeys(v.value for v in votes))
    others = max(count - 1, len(values) - 1, 1)
    logs = []
    for value in values:
        total = 0.0
        for vote in votes:
            sure = min(MOST, max(LEAST, vote.confidence))
            total += log(sure if vote.value == value else (1 - sure) / others)
        logs.append(total)
    # It may also be a value that no source named.
    unnamed = max(0, others + 1 - len(values))
    rest = sum(log((1 - min(MOST, max(LEAST, v.confidence))) / others) for v in votes)
    top = max([*logs, rest])
    shares = [exp(x - top) for x in logs]
    whole = sum(shares) + unnamed * exp(rest - top)
    best = max(range(len(values)), key=lambda n: (shares[n], -n))
    chosen = values[best]
    agreeing = [v for v in votes if v.value == chosen]
    against = [v for v in votes if v.value != chosen and v.confidence >= FIRM]
    why = dict.fromkeys(v.reason for v in sorted(agreeing, key=lambda v: -v.confidence))
    reason = join_phrases(list(why), "; ")
    conflict = ""
    if against and max(v.confidence for v in agreeing) >= FIRM:
        strongest = max(against, key=lambda v: v.confidence)
        conflict = phrase("{one}, but {other}", one=agreeing[0].reason, other=strongest.reason)
    confidence = min(MOST, max(LEAST, shares[best] / whole))
    return Agreed(Belief(chosen, confidence, reason), conflict)
