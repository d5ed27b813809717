"""What who listens takes up of the moods and the laughter of who talks with it, as asks for its mood.

Of two it takes up the other's mood, weakly and a moment later, and laughs along; of more it laughs along
with whoever laughs. How much and how often its rates say.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from metagraph.graph.conversation.model import Conversation, Side
from metagraph.graph.requests import Feel
from metagraph.playback.life.sympathy import Laugh, laughs_along, moods_taken_up
from metagraph.playback.life.wanted import moods_of
from metagraph.playback.plan import Plan
from metagraph.playback.planning.mood import MoodFrom
from metagraph.speech.mirroring import Mover

LAUGHING = "laugh"  # tag of actions that laugh
_LAUGHED = re.compile(
    r"^\W*[hj]+[aeiou]+(?:(?:h*[\s-])?[hj]+[aeiou]+)+h*\W*$|^\W*(w{3,}|哈{2,}|ha|笑|ㅋ{2,}|ㅎ{2,})\W*$", re.I
)
_APART = 0.5  # seconds between words up to which they are one laugh


def find_laughs(side: Side, plan: Plan) -> list[Laugh]:
    """Return a side's laughs, by start: words that spell one ("haha"), and actions tagged `laugh`."""
    spans = [(w.start, w.end) for w in side.words if _LAUGHED.match(w.text)]
    for layer in plan.layers.values():
        spans += [(cue.start, cue.end) for cue in layer.cues if LAUGHING in cue.action.tags]
    out: list[Laugh] = []
    for start, end in sorted(spans):
        if out and start <= out[-1].end + _APART:
            out[-1] = Laugh(out[-1].start, max(out[-1].end, end))
        else:
            out.append(Laugh(start, end))
    return out


def list_sympathies(conversation: Conversation, own: Mover, others: Sequence[Mover]) -> Iterator[Feel]:
    """Yield what a side is asked to feel for the others' moods and laughs."""
    rates = conversation.sides[own.side].rates
    mine = moods_of(own.project.life, own.plan.track)
    seed = conversation.seed + own.side
    told: list[MoodFrom] = []
    for other in others:
        who = f"side {other.side + 1}"
        theirs = moods_of(other.project.life, other.plan.track)
        if len(others) == 1 and rates.mood > 0:
            told += moods_taken_up(mine, theirs, conversation.length, rates.mood, seed, who)
        laughs = find_laughs(conversation.sides[other.side], other.plan)
        told += laughs_along(mine, laughs, rates.laugh, seed, who)
    for one in sorted(told, key=lambda m: m.start):
        if one.start < min(one.end, conversation.length) and one.valence is not None:
            yield Feel(
                id=one.id,
                at=round(one.start, 3),
                mood=(round(one.valence, 4), round(one.arousal or 0.0, 4)),
                duration=round(min(one.end, conversation.length) - one.start, 3),
            )
