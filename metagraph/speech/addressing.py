"""Who speaks to whom: turns of several who talk, whom each is said to, and what that makes of everyone:
speaker, addressed, or listening aside (the participation framework of Goffman 1981).

Whom a turn is said to is, in this order,

1. what its segments say, where somebody said so (`Segment.to`);
2. who is called by name in it: an address term chooses who speaks next (Sacks, Schegloff and Jefferson 1974);
3. who chose the speaker in one of the first two ways just before: that one is being answered;
4. who answers: starts within `ANSWER` of its end, or in the last `OVERLAP` of it;
5. who spoke just before: last but one is likeliest to be next (Sacks et al. 1974);
6. everybody.

The order from 3 on, and all times, are ours. Turns of responses alone ("yeah") do not take the floor.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import groupby, pairwise
from typing import Literal

from metagraph.graph.conversation.model import EVERYBODY, Conversation, Segment, list_other_sides
from metagraph.graph.vocabulary import split_tokens

TURN = 0.6  # seconds of silence that part two turns of one speaker
ANSWER = 1.5  # seconds after a turn within which who starts answers it
OVERLAP = 1.0  # seconds before its end from which on who starts does
BEFORE = 5.0  # seconds after which who spoke before is no longer spoken to
Part = Literal["speaks", "addressed", "aside", "idle"]


@dataclass(frozen=True, slots=True)
class AddressedTurn:
    """What a side says without a pause, of more than responses. start, end: seconds. to: the side it is said
    to, `EVERYBODY` to all. chosen: whether it says so itself, and is not only inferred. text: its words.
    """

    side: int
    start: float
    end: float
    to: int = EVERYBODY
    chosen: bool = False
    text: str = ""


@dataclass(frozen=True, slots=True)
class Role:
    """What a side is from `start` to `end` seconds. whom: whom it speaks to (`EVERYBODY`: all), or whose turn
    it listens to; None while nobody speaks. turn: the turn it is about.
    """

    start: float
    end: float
    part: Part
    whom: int | None = None
    turn: AddressedTurn | None = None


def find_speaking_spans(segments: Iterable[Segment]) -> list[tuple[float, float]]:
    """Return when someone speaks, with pauses shorter than `TURN` closed."""
    out: list[tuple[float, float]] = []
    for s in segments:
        if out and s.start - out[-1][1] < TURN:
            out[-1] = (out[-1][0], s.end)
        else:
            out.append((s.start, s.end))
    return out


def list_addressed_turns(conversation: Conversation) -> tuple[AddressedTurn, ...]:
    """Return the turns of all sides, by start, each with whom it is said to."""
    found = sorted(
        (t for side in range(len(conversation.sides)) for t in _turns(conversation, side)),
        key=lambda t: (t.start, t.side),
    )
    if len(conversation.sides) == 2:
        return tuple(replace(t, to=1 - t.side) for t in found)
    groups = [list(some) for _, some in groupby(found, key=lambda t: t.side)]
    out: list[AddressedTurn] = []
    for n, group in enumerate(groups):
        before = out[-1] if out else None
        after = groups[n + 1][0] if n + 1 < len(groups) else None
        to = _inferred(group, before, after)
        out += [t if t.chosen else replace(t, to=to) for t in group]
    return tuple(out)


def _inferred(
    group: Sequence[AddressedTurn], before: AddressedTurn | None, after: AddressedTurn | None
) -> int:
    """Return whom turns of one side are said to that do not tell, by who speaks before and after."""
    first, last = group[0], group[-1]
    told = next((t.to for t in reversed(group) if t.chosen), None)
    if told is not None:
        return told
    recent = before is not None and first.start - before.end <= BEFORE
    if recent and before is not None and before.chosen and before.to == first.side:
        return before.side
    if after is not None and last.end - OVERLAP <= after.start <= last.end + ANSWER:
        return after.side
    return before.side if recent and before is not None else EVERYBODY


def _turns(conversation: Conversation, side: int) -> Iterable[AddressedTurn]:
    """Yield a side's turns: parted where it says that it speaks to somebody else."""
    segments = conversation.sides[side].segments
    names = {n: split_tokens(conversation.sides[n].name) for n in list_other_sides(conversation, side)}
    ends = iter([end for _, end in find_speaking_spans(segments)])
    end = next(ends, 0.0)
    some: list[Segment] = []
    for s in segments:
        if s.start >= end:
            yield from _parted(side, some, names)
            some = []
            end = next(ends)
        some.append(s)
    yield from _parted(side, some, names)


def _parted(
    side: int, segments: Sequence[Segment], names: dict[int, tuple[str, ...]]
) -> Iterable[AddressedTurn]:
    if all(s.kind == "response" for s in segments):
        return
    for given, some in groupby(segments, key=lambda s: s.to):
        own = list(some)
        text = " ".join(s.text for s in own if s.text)
        to = given if given is not None else _called(text, names)
        yield AddressedTurn(
            side, own[0].start, own[-1].end, EVERYBODY if to is None else to, to is not None, text
        )


def _called(text: str, names: dict[int, tuple[str, ...]]) -> int | None:
    """Return whose name comes last in a text: the whole, or its first word where no other is called so."""
    said = split_tokens(text)
    found: list[tuple[int, int]] = []
    for n, name in names.items():
        firsts = [other[:1] for m, other in names.items() if m != n]
        for form in {name, name[:1]} if name[:1] not in firsts else {name}:
            at = [k for k in range(len(said) - len(form) + 1) if form and said[k : k + len(form)] == form]
            found += [(at[-1] + len(form), n)] if at else []
    return max(found)[1] if found else None


def find_floor_holders(turns: Iterable[AddressedTurn]) -> tuple[tuple[float, float, AddressedTurn], ...]:
    """Return from when to when which of some turns holds the floor: of those at once the one that began
    first. By start; nothing while nobody speaks.
    """
    given = sorted(turns, key=lambda t: (t.start, t.side))
    out: list[tuple[float, float, AddressedTurn]] = []
    at = 0.0
    for t in given:
        if t.end > max(at, t.start):
            out.append((max(at, t.start), t.end, t))
            at = t.end
    return tuple(out)


def list_side_roles(conversation: Conversation, side: int) -> tuple[Role, ...]:
    """Return what a side is from 0 to the conversation's length, without gaps."""
    every = list_addressed_turns(conversation)
    own = find_floor_holders(t for t in every if t.side == side)
    theirs = find_floor_holders(t for t in every if t.side != side)
    edges = sorted(
        {0.0, conversation.length, *(x for part in (own, theirs) for a, b, _ in part for x in (a, b))}
    )
    out: list[Role] = []
    places = [0, 0]
    for a, b in pairwise(edges):
        if a >= conversation.length:
            break
        held: list[AddressedTurn | None] = [None, None]
        for k, part in enumerate((own, theirs)):
            while places[k] < len(part) and part[places[k]][1] <= a:
                places[k] += 1
            if places[k] < len(part) and part[places[k]][0] <= a:
                held[k] = part[places[k]][2]
        role = _role(a, min(b, conversation.length), side, held[0], held[1])
        if out and (out[-1].part, out[-1].whom, out[-1].turn) == (role.part, role.whom, role.turn):
            out[-1] = replace(out[-1], end=role.end)
        else:
            out.append(role)
    return tuple(out)


def _role(
    start: float, end: float, side: int, own: AddressedTurn | None, other: AddressedTurn | None
) -> Role:
    if own is not None:
        return Role(start, end, "speaks", own.to, own)
    if other is None:
        return Role(start, end, "idle")
    return Role(start, end, "addressed" if other.to in (side, EVERYBODY) else "aside", other.side, other)
