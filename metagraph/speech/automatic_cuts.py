"""Cuts of a conversation's camera that follow who speaks: over the listener's shoulder at each new speaker,
closer where somebody speaks long, all who talk at the beginning, in a long silence and where several speak at
once. The rules are those any editor of dialogue begins with; the numbers are ours.
"""

from __future__ import annotations

from dataclasses import dataclass

from metagraph.graph.conversation.model import Conversation
from metagraph.graph.timeline import Cut, Shot

OPENING = 2.0  # seconds at least that all are seen at the beginning
SHORTEST = 1.6  # seconds a picture is seen at least
JOINED = 1.2  # seconds of silence over which one goes on speaking
BRIEF = 1.0  # seconds below which what is said is an answer in passing and no turn
EARLY = 0.12  # seconds before the first sound at which it is cut to who speaks
LONG = 7.0  # seconds of one picture of a speaker after which it goes closer, or back
SILENCE = 3.0  # seconds without a word in which all are seen


@dataclass(frozen=True, slots=True)
class FloorTurn:
    """side: who speaks."""

    side: int
    start: float
    end: float


def list_turns(conversation: Conversation) -> list[FloorTurn]:
    """Return who has the floor, by start: stretches of one side's clauses, joined over short silences,
    without answers in passing.
    """
    some: list[FloorTurn] = []
    for n, side in enumerate(conversation.sides):
        held: list[FloorTurn] = []
        for s in side.segments:
            if s.kind == "response":
                continue
            if held and s.start - held[-1].end < JOINED:
                held[-1] = FloorTurn(n, held[-1].start, s.end)
            else:
                held.append(FloorTurn(n, s.start, s.end))
        some += [t for t in held if t.end - t.start >= BRIEF]
    return sorted(some, key=lambda t: (t.start, t.end))


def automatic_cuts(conversation: Conversation) -> tuple[Cut, ...]:
    """Return the cuts, by time; the first at 0."""
    found = list_turns(conversation)
    cuts = [Cut(at=0.0, shot="two")]

    def cut(at: float, shot: Shot, side: int) -> None:
        last = cuts[-1]
        if (last.shot, last.side) == (shot, side) or at >= conversation.length - SHORTEST / 2:
            return
        least = OPENING if len(cuts) == 1 else SHORTEST
        if at - last.at >= least:
            cuts.append(Cut(at=round(at, 2), shot=shot, side=side))

    until = 0.0  # when the last word ends so far
    for n, turn in enumerate(found):
        side = turn.side
        if turn.start - until > SILENCE:
            cut(until + 1.0, "two", 0)
        after = found[n + 1].start if n + 1 < len(found) else conversation.length
        both = any(
            t.side != turn.side and t.start < turn.end - 1.0 and t.end > turn.start + 1.0 for t in found
        )
        begin = max(turn.start - EARLY, cuts[-1].at + (OPENING if len(cuts) == 1 else SHORTEST))
        together = both and turn.end - turn.start < LONG
        if begin < turn.end - SHORTEST / 2:
            cut(begin, "two" if together else "over", 0 if together else side)
        at, close = begin + LONG, True
        while not both and at < min(turn.end, after) - SHORTEST:
            cut(_between_words(conversation, side, at), "close" if close else "over", side)
            at, close = at + LONG, not close
        until = max(until, turn.end)
    if conversation.length - until > SILENCE:
        cut(until + 1.0, "two", 0)
    return tuple(cuts)


def _between_words(conversation: Conversation, side: int, at: float) -> float:
    """Return the beginning of a side's segment that is nearest to a time, within a second and a half."""
    starts = [s.start for s in conversation.sides[side].segments]
    near = min(starts, key=lambda s: abs(s - at), default=at)
    return near - EARLY if abs(near - at) <= 1.5 else at


def cut_at(cuts: tuple[Cut, ...], seconds: float) -> tuple[Cut, float] | None:
    """Return the cut whose picture is seen at a time and when the next begins; None before the first."""
    found = next((n for n in range(len(cuts) - 1, -1, -1) if cuts[n].at <= seconds), None)
    if found is None:
        return None
    return cuts[found], cuts[found + 1].at if found + 1 < len(cuts) else float("inf")
