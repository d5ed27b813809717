"""In which stance a side's arms are when: people keep a posture while they speak, and shift where a turn is
over and another begins (Cassell et al. 2001).

How often is ours. Gestures of a turn are then chosen among those of the stance that it is spoken in.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from metagraph.graph.conversation.model import Conversation
from metagraph.graph.model import MetaGraph
from metagraph.playback.planning.choice import pick, uniform
from metagraph.speech.addressing import find_speaking_spans

SHIFTS = 0.6  # share of the pauses between turns that are long enough in which the arms change their stance
PAUSE = 4.5  # seconds of such a pause at least
KEPT = 10.0  # seconds that a stance is kept at least
AFTER, LATER = 0.6, 1.5  # seconds after a turn in which they begin to: at least, and what chance adds
BEFORE = 3.0  # seconds before the next turn from which on they no longer do


@dataclass(frozen=True, slots=True)
class ArmStances:
    """starts: from when on the arms are in each of `stances`, ascending; the first from 0."""

    starts: Sequence[float]
    stances: Sequence[str]

    def at(self, seconds: float) -> str:
        """Return the stance at a time; "" for none."""
        place = bisect_right(self.starts, seconds) - 1
        return self.stances[place] if place >= 0 else ""


def place_arm_stances(conversation: Conversation, side: int, graph: MetaGraph) -> ArmStances:
    """Return in which stance of the arms a side is when. graph: of its arms."""
    home = graph.start if graph.start is not None else next(iter(graph.stances), "")
    starts, stances = [0.0], [home]
    turns = find_speaking_spans(s for s in conversation.sides[side].segments if s.kind != "response")
    edges = [(0.0, 0.0), *turns, (conversation.length, conversation.length)]
    for n, ((_, end), (following, _)) in enumerate(pairwise(edges)):
        key = f"arms {n}"
        chance = uniform(conversation.seed, str(side), key)
        at = end + AFTER + LATER * uniform(conversation.seed, str(side), key, "when")
        at = round(min(at, following - BEFORE), 3)
        if following - end < PAUSE or at - starts[-1] < KEPT or chance >= SHIFTS:
            continue
        weights = _weigh_stances(graph, stances[-1])
        if weights:
            stances.append(pick(conversation.seed, f"{side} {key}", "stance", weights))
            starts.append(at)
    return ArmStances(starts, stances)


def _weigh_stances(graph: MetaGraph, stance: str) -> dict[str, float]:
    """Return the stances that a transition leads to from a stance, each with as much weight as it has
    gestures.
    """
    out: dict[str, float] = {}
    for action in graph.of(stance, "transition"):
        end = action.end_stance
        if end is None or action.likelihood <= 0 or end not in graph.stances or not graph.of(end, "stance"):
            continue
        gestures = [a for a in graph.of(end, "gesture") if a.likelihood > 0]
        if gestures:
            out[end] = float(len(gestures))
    return out
