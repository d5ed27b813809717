"""What people show at the edges of turns and while they listen, in a conversation of two.

Long turns mostly begin with a look away and end with one at the other (Kendon 1967; Ho et al. 2015). Who
listens nods where something new was said, some 0.6 s after it (Hale et al. 2020). How often is ours, since no
published rate was found.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import cos, radians, sin

from metagraph.graph.conversation.model import Conversation, Segment, list_other_sides
from metagraph.graph.requests import Look, Nod, Point
from metagraph.playback.planning.choice import uniform
from metagraph.speech.addressing import find_speaking_spans

LONG = 2.0  # seconds from which on a turn is long
AWAY = 0.7  # share of long turns that begin with a look away
AWAY_FIRST = 0.3  # seconds before the turn in which it begins
AWAY_LEAST, AWAY_MORE = 0.9, 0.9  # seconds it lasts at least, and what chance adds
ASIDE, UP = 18.0, 7.0  # degrees beside and above the other's eyes
BACK = 0.8  # share of long turns that end with a look at the other
LONGER = 3.0  # seconds from which on it mostly ends with a look: a short one is hardly over its beginning
LAST = 0.9  # seconds before the end in which the gaze stays
NODS = 0.4  # share of the other's clauses that are answered by a nod
LAG = 0.6  # seconds after the clause, on average
APART = 3.0  # seconds between two nods
LISTEN = "listen"  # tag of nods that only say one listens


def look_at_turns(conversation: Conversation, side: int, partner: str, head: Point) -> Iterator[Look]:
    """Yield looks away where long turns of a side begin and at the other where they end. partner: the name of
    the other's head; head: where it is, metres in this side's space.
    """
    seed, own = conversation.seed, str(side)
    for n, (start, end) in enumerate(find_speaking_spans(conversation.sides[side].segments)):
        if end - start < LONG:
            continue
        if uniform(seed, own, f"turn {n}", "away") < AWAY:
            seconds = AWAY_LEAST + AWAY_MORE * uniform(seed, own, f"turn {n}", "long")
            left = uniform(seed, own, f"turn {n}", "left") < 0.5
            yield Look(
                id=f"turn {n}",
                at=max(0.0, round(start - AWAY_FIRST, 3)),
                to=_beside(head, ASIDE if left else -ASIDE),
                duration=round(min(seconds, (end - start) / 2), 3),
                priority=2,
                amount=0.7,
            )
        if end - start >= LONGER and uniform(seed, own, f"turn {n}", "back") < BACK:
            yield Look(
                id=f"turn end {n}",
                at=round(end - LAST, 3),
                to=partner,
                duration=LAST + 0.3,
                priority=2,
                strict=True,
            )


def _beside(head: Point, degrees: float) -> Point:
    x, y, z = head
    a = radians(degrees)
    far = (x * x + z * z) ** 0.5
    return (
        round(x * cos(a) + z * sin(a), 4),
        round(y + far * sin(radians(UP)), 4),
        round(z * cos(a) - x * sin(a), 4),
    )


def place_clause_nods(conversation: Conversation, side: int, small: bool) -> Iterator[Nod]:
    """Yield the nods of a side that listens to what the others say. small: whether its head has nods with the
    tag "listen".
    """
    busy = find_speaking_spans(conversation.sides[side].segments)
    last = -APART
    for n, clause in enumerate(_clauses(conversation, side)):
        lag = LAG * (0.5 + uniform(conversation.seed, str(side), f"heard {n}", "lag"))
        at = round(clause.end - 0.2 + lag, 3)
        if at < last + APART or any(start - 1.0 < at < end + 0.3 for start, end in busy):
            continue
        if uniform(conversation.seed, str(side), f"heard {n}") < NODS:
            last = at
            yield Nod(id=f"heard {n}", at=at, tags=(LISTEN,) if small else (), late=0.5)


def _clauses(conversation: Conversation, side: int) -> list[Segment]:
    """Return the clauses of all others, by their ends."""
    found = [s for n in list_other_sides(conversation, side) for s in conversation.sides[n].segments]
    return sorted((s for s in found if s.kind == "clause"), key=lambda s: s.end)
