"""Cuts of a conversation's camera that follow who speaks: over the listener's shoulder at each new speaker,
closer where somebody speaks long, to a listener who answers in passing or has long been out of the picture,
to somebody who thinks before an answer, and to all speakers at the beginning, now and then, in a long silence
and where several speak at once. The rules are those any editor of dialogue begins with; the numbers are ours.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import ceil

from metagraph.graph.conversation.edits import add_conversation
from metagraph.graph.conversation.model import Conversation, Segment
from metagraph.graph.model import Project
from metagraph.graph.timeline import Cut, Shot
from metagraph.graph.timeline_edits import change_timeline

OPENING = 2.0  # seconds at least that all are seen at the beginning
SHORTEST = 1.6  # seconds a picture is seen at least
JOINED = 1.2  # seconds of silence over which one goes on speaking
BRIEF = 0.8  # seconds below which what is said is an answer in passing and no turn
EARLY = 0.12  # seconds before the first sound at which it is cut to who speaks
HELD = 0.4  # seconds that the last speaker is still seen in a longer pause
MUSING = 1.2  # seconds before the first sound, at most, that somebody is seen who thinks before an answer
AGAIN = 40.0  # seconds after which a short turn is used to show all again
SHORT_TURN = 4.0  # seconds
LONG = 7.0  # seconds at most of one picture of a speaker, after which it goes closer, or back
CLOSE = 6.0  # and of one from near, in which little moves
SILENCE = 3.0  # seconds without a word in which all are seen
REACTION = 1.8  # seconds that a listener is seen
ANSWER = 0.35  # seconds before its answer at which it is cut to a listener
ANSWERED = 0.8  # seconds at least, from an answer between two turns of one speaker, that it is seen
BEFORE = 2.0  # seconds that a speaker is seen before it is cut to a listener's answer
UNSEEN = 12.0  # seconds of one speaker after which the listener is seen without an answer


@dataclass(frozen=True, slots=True)
class FloorTurn:
    """side: who speaks."""

    side: int
    start: float
    end: float


def list_turns(conversation: Conversation) -> list[FloorTurn]:
    """Return who has the floor, by start: stretches of what one side says, joined over short silences,
    without answers in passing.
    """
    some: list[FloorTurn] = []
    for n, side in enumerate(conversation.sides):
        held: list[list[Segment]] = []
        for s in side.segments:
            if held and s.start - held[-1][-1].end < JOINED:
                held[-1].append(s)
            else:
                held.append([s])
        some += [
            FloorTurn(n, group[0].start, group[-1].end)
            for group in held
            if group[-1].end - group[0].start >= BRIEF and any(s.kind != "response" for s in group)
        ]
    return sorted(some, key=lambda t: (t.start, t.end))


def make_automatic_cuts(conversation: Conversation) -> tuple[Cut, ...]:
    """Return the cuts, by time; the first at 0."""
    found = list_turns(conversation)
    cuts = [Cut(at=0.0, shot="two")]

    def cut(at: float, shot: Shot, side: int) -> None:
        last = cuts[-1]
        if (last.shot, last.side) == (shot, side) or at >= conversation.length - SHORTEST / 2:
            return
        least = OPENING if len(cuts) == 1 else SHORTEST
        if at - last.at >= least - 0.005:
            cuts.append(Cut(at=round(at, 2), shot=shot, side=side))

    until = shown = 0.0  # when the last word ends so far, and when all were last seen
    for n, turn in enumerate(found):
        side = turn.side
        if turn.start - until > SILENCE:
            cut(until + 1.0, "two", 0)
        after = found[n + 1].start if n + 1 < len(found) else conversation.length
        both = any(
            t.side != turn.side and t.start < turn.end - 1.0 and t.end > turn.start + 1.0 for t in found
        )
        early = max(EARLY, min(MUSING, turn.start - until - HELD)) if n else EARLY
        begin = max(turn.start - early, cuts[-1].at + (OPENING if len(cuts) == 1 else SHORTEST))
        long = turn.end - turn.start
        together = (both and long < LONG) or (begin - shown > AGAIN and long < SHORT_TURN)
        if begin < turn.end - SHORTEST / 2:
            cut(begin, "two" if together else "over", 0 if together else side)
            shown = begin if together else shown
        if not both:  # who spoke before, and goes on, has been seen for longer
            seen = min(begin, cuts[-1].at) if (cuts[-1].shot, cuts[-1].side) == ("over", side) else begin
            _cut_within(conversation, turn, (begin, seen), min(turn.end, after), cut)
        until = max(until, turn.end)
        if n + 1 < len(found) and found[n + 1].side == side:
            _cut_to_answer(conversation, turn, after, cut)
    said = [(s.start, s.end, n) for n, of in enumerate(conversation.sides) for s in of.segments]
    after_all = min((s for s in said if s[0] > until), default=None)
    if after_all is not None:  # a last answer in passing
        start, _, side = after_all
        cut(start - EARLY, "over", side)
        until = max(end for _, end, _ in said)
    if conversation.length - until > SILENCE:
        cut(until + 1.0, "two", 0)
    return tuple(cuts)


def _cut_to_answer(
    conversation: Conversation, turn: FloorTurn, after: float, cut: Callable[[float, Shot, int], None]
) -> None:
    """Cut to who answers in passing before the same speaker goes on. after: when that is."""
    answers = sorted(
        (s.start - EARLY, n)
        for n, side in enumerate(conversation.sides)
        if n != turn.side
        for s in side.segments
        if s.kind == "response" and turn.end - 0.5 <= s.start and s.start + ANSWERED < after
    )
    if answers:
        cut(answers[0][0], "over", answers[0][1])


def _cut_within(
    conversation: Conversation,
    turn: FloorTurn,
    begin: tuple[float, float],
    end: float,
    cut: Callable[[float, Shot, int], None],
) -> None:
    """Cut within a long turn: closer and back, and to who listens. begin: when the turn begins, and since
    when its speaker is seen.
    """
    answers = sorted(
        (s.start - ANSWER, n)
        for n, side in enumerate(conversation.sides)
        if n != turn.side
        for s in side.segments
        if s.kind == "response"
    )
    listener = 1 - turn.side if len(conversation.sides) == 2 else None
    shots: tuple[Shot, Shot] = ("close", "over")
    seen, last, place = begin[0], begin[1], 0  # when a listener was last seen, the last cut, the next shot
    while True:
        most = LONG if place % 2 == 0 else CLOSE
        if end - last <= most:
            return
        # Pictures of one length: none that is left over is too short to be seen, nor added to the last.
        at, who = max(last + (end - last) / ceil((end - last) / most), begin[0]), turn.side
        from_now = max(last + BEFORE, begin[0])
        answer = next((a for a in answers if from_now <= a[0] <= last + most), None)
        unseen = max(at, seen + UNSEEN)
        if answer is not None and answer[0] < end - REACTION - SHORTEST:
            at, who = answer
        elif listener is not None and unseen <= last + most and unseen < end - REACTION - BEFORE - SHORTEST:
            at, who = unseen, listener
        if who == turn.side:
            last = min(_between_words(conversation, turn.side, at), end - SHORTEST)
            cut(last, shots[place % 2], who)
        else:
            cut(at, "close", who)
            seen = last = at + REACTION
            cut(last, shots[place % 2], turn.side)
        place += 1


def keep_filmed_conversation(project: Project, conversation: Conversation) -> tuple[Project, str]:
    """Keep a conversation with automatic cuts; return the project and the conversation's id. One side alone
    is not cut.
    """
    project, ident = add_conversation(project, conversation)
    if len(conversation.sides) < 2:
        return project, ident
    return change_timeline(project, ident, cuts=make_automatic_cuts(conversation)), ident


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
