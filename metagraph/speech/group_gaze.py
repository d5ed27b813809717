"""Who looks at whom where three or more talk.

Over four-person conversations, of all looks at somebody's face 88 % were at the one listened to and 77 % at
the one spoken to (Vertegaal, Slagter, van der Veer and Nijholt 2001); who speaks to all shares looks out
among them (ibid.; Auer 2018). Over 70 % of long utterances ended with the speaker looking up at the listener
(Kendon 1967), and the last look of a turn chooses who is next (Auer 2018; in conversations of three: Jokinen,
Furukawa, Nishida and Yamamoto 2013). Listeners who are not addressed often look at the next speaker before
the turn ends (Holler and Kendrick 2015). How long single looks last, and reactions, are ours.

This says at whose face one looks, if at any: how often and how far gaze leaves it is life's
(`metagraph.playback.life`). Every stretch is drawn by a key of its own, so an edit of one leaves the others.
"""

from __future__ import annotations

from bisect import bisect_left
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from metagraph.graph.conversation.model import EVERYBODY, Conversation, list_other_sides
from metagraph.playback.planning.choice import uniform
from metagraph.speech.addressing import (
    ANSWER,
    OVERLAP,
    AddressedTurn,
    Role,
    list_addressed_turns,
    list_side_roles,
)

AT_SPEAKER, AT_ADDRESSEE = 0.88, 0.77  # of looks at faces, listening and speaking (Vertegaal et al. 2001)
GLANCE = (0.6, 0.6)  # seconds a look at somebody else lasts: at least, and what chance adds
SHARED = (1.2, 1.6)  # seconds one of all who are spoken to is looked at
QUIET = (2.5, 2.5)  # seconds, while nobody speaks
END = 0.7  # seconds before a turn's end from which on the next speaker is looked at
NOTICED = (0.15, 0.4)  # seconds after somebody begins until listeners look there
FORESEEN = (-0.3, 0.7)  # the same where that one was spoken to
LEAST = 0.3  # seconds a look lasts: shorter ones are left out
ASIDE = 2  # times as likely as anybody else the one who is spoken to is glanced at by who listens aside
Draw = Callable[..., float]


@dataclass(frozen=True, slots=True)
class LookAtFace:
    """From `at` seconds on the face of a side is looked at."""

    at: float
    side: int


def list_looks(conversation: Conversation, side: int) -> tuple[LookAtFace, ...]:
    """Return whose face a side looks at from when on, by time; the first at 0."""
    others = list_other_sides(conversation, side)
    if len(others) == 1:
        return (LookAtFace(0.0, others[0]),)
    roles, turns = list_side_roles(conversation, side), list_addressed_turns(conversation)
    seen: Counter[str] = Counter()
    found: list[LookAtFace] = []
    before: AddressedTurn | None = None
    for n, role in enumerate(roles):
        name = f"{role.part} {role.turn.side} {role.turn.text[:60]}" if role.turn is not None else role.part
        seen[name] += 1
        draw = _draw(conversation.seed, side, f"looks {name} {seen[name]}")
        start = role.start
        if role.part in ("addressed", "aside") and n and role.turn is not None:
            least, more = FORESEEN if before is not None and before.to == role.turn.side else NOTICED
            start = max(0.0, min(start + least + more * draw("lag"), role.end))
        while found and found[-1].at >= start:  # it looks there sooner
            found.pop()
        last = found[-1].side if found else _first(roles, others)
        found += [LookAtFace(at, whom) for at, whom in _during(role, start, last, others, turns, draw)]
        before = role.turn or before
    return tuple(_lasting(found, conversation.length))


def _draw(seed: int, side: int, key: str) -> Draw:
    return lambda *what: uniform(seed, str(side), key, *map(str, what))


def _first(roles: Sequence[Role], others: Sequence[int]) -> int:
    """Return whom one looks at before anybody has spoken: who will, or will be spoken to."""
    return next((r.whom for r in roles if r.whom is not None and r.whom in others), others[0])


def _during(
    role: Role, start: float, last: int, others: Sequence[int], turns: Sequence[AddressedTurn], draw: Draw
) -> Iterator[tuple[float, int]]:
    """Yield from when on who is looked at. start: when the first look begins. last: who was looked at."""
    if role.part == "idle" or role.whom is None:
        yield start, last
        yield from _in_turn(start + _long(QUIET, draw("still")), role.end, last, others, QUIET, draw)
    elif role.part != "speaks":
        rest = [n for n in others if n != role.whom]
        to = role.turn.to if role.turn is not None else EVERYBODY
        rest += [to] * (ASIDE - 1) if to in rest else []
        late = max(0.0, start - role.start) if last != role.whom else 0.0  # somebody else is looked at then
        share = _left(1 - AT_SPEAKER, role.end - role.start, late, role.end - start)
        yield from _alternating(start, role.end, role.whom, rest, share, draw)
    else:
        end = max(role.start, role.end - END)
        if role.whom == EVERYBODY:
            yield from _in_turn(start, end, last, others, SHARED, draw)
        else:
            rest = [n for n in others if n != role.whom]
            share = _left(1 - AT_ADDRESSEE, role.end - role.start, 0.0, end - start)
            yield from _alternating(start, end, role.whom, rest, share, draw)
        following = _next(role, turns)
        if following is not None or role.whom != EVERYBODY:
            yield end, role.whom if following is None else following


def _left(share: float, whole: float, spent: float, left: float) -> float:
    """Return what share of the time that is left others are to be looked at, so that it comes to a share of
    the whole; at most half.
    """
    return min(0.5, max(0.0, share * whole - spent) / left) if left > 0 else 0.0


def _next(role: Role, turns: Sequence[AddressedTurn]) -> int | None:
    """Return who speaks next, where somebody else does soon after a turn, or into its end."""
    if role.turn is None or role.end < role.turn.end:
        return None
    for t in turns[bisect_left(turns, role.end - OVERLAP, key=lambda t: t.start) :]:
        if t.start > role.end + ANSWER:
            break
        if t.side != role.turn.side:
            return t.side
    return None


def _alternating(
    start: float, end: float, main: int, rest: Sequence[int], away: float, draw: Draw
) -> Iterator[tuple[float, int]]:
    """Yield looks at one with glances at others, which take a share `away` of the time on average however
    short it is: what goes on at the start has begun before.
    """
    glance = GLANCE[0] + GLANCE[1] / 2
    glancing, at, n = draw("begins") < away, start, 0
    while at < end:
        if glancing:
            yield at, rest[int(draw("whom", n) * len(rest))]
            lasts = _long(GLANCE, draw("long", n))
        else:
            yield at, main
            lasts = glance * (1 - away) / away * (0.5 + draw("long", n)) if away > 0 else end - start
        at += lasts * (draw("begun") if n == 0 else 1.0)
        glancing, n = not glancing, n + 1


def _in_turn(
    start: float, end: float, last: int, others: Sequence[int], lasts: tuple[float, float], draw: Draw
) -> Iterator[tuple[float, int]]:
    """Yield looks at one after another, never twice at the same."""
    at, n = start, 0
    while at < end:
        rest = [x for x in others if x != last]
        last = rest[int(draw("whom", n) * len(rest))]
        yield at, last
        at += _long(lasts, draw("long", n))
        n += 1


def _long(span: tuple[float, float], chance: float) -> float:
    return span[0] + span[1] * chance


def _lasting(looks: Sequence[LookAtFace], length: float) -> Iterator[LookAtFace]:
    """Yield looks that last, each at another face than the one before."""
    last: int | None = None
    for n, look in enumerate(looks):
        after = looks[n + 1].at if n + 1 < len(looks) else length
        if (after - look.at >= LEAST or last is None) and look.side != last:
            last = look.side
            yield LookAtFace(round(look.at, 3) if n else 0.0, look.side)
