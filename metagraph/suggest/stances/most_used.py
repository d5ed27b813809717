"""Choose the stance of clips that nothing assigns to one: that in which most clips of their layer are."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import replace

from metagraph.common.wording import phrase
from metagraph.suggest.estimate import Belief
from metagraph.suggest.proposal import Proposal, StancePlace

UNKNOWN = 0.4  # confidence of the most used stance if nothing is known of a clip's pose
BELONGS = 0.6  # how likely a clip that begins in none of the stances belongs to one of them all the same


def assign_most_used(
    proposals: Mapping[str, Proposal], places: dict[str, StancePlace], astray: Mapping[str, float]
) -> dict[str, Proposal]:
    """Return proposals. Those without a stance get the stance that most clips of their layer are in; one is
    made if there is none. `astray` has the metres from the nearest stance of clips that begin in none: for
    those, the share of clips that a stance has says how likely it is.
    """
    used = Counter(p.stance.value for p in proposals.values() if p.stance is not None)
    out = {}
    for clip, p in proposals.items():
        if p.stance is None:
            layer = p.layer.value
            mine = [key for key, place in places.items() if place.layer == layer]
            key = max(mine, key=lambda k: used[k]) if mine else f"new {layer} rest"
            places.setdefault(key, StancePlace(key, layer, "rest"))
            p = replace(p, stance=_believed(key, mine, used, astray.get(clip)))
        out[clip] = p
    return out


def _believed(key: str, mine: list[str], used: Counter[str], away: float | None) -> Belief[str]:
    """Return how far a stance can be believed of the stances `mine` of a layer."""
    if not mine:
        return Belief(key, UNKNOWN, phrase("no stance is named, and there is no other"))
    if away is None:
        return Belief(key, UNKNOWN, phrase("no stance is named; most clips are in this one"))
    share = used[key] / max(1, sum(used[k] for k in mine))
    words = phrase("begins {length:.0f} cm from every stance; most clips are in this one", length=100 * away)
    return Belief(key, BELONGS * share, words)
