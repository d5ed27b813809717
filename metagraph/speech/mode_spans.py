"""What a side of a conversation does when: it talks, listens, thinks before an answer, reacts to what it
heard, or idles.

Speakers look away from 1.3 s before they speak (Andrist et al. 2013), and while they hesitate. The other
times are ours.
"""

from __future__ import annotations

from collections.abc import Iterator

from metagraph.graph.conversation.model import Conversation, Segment, list_other_sides
from metagraph.graph.model import Mode
from metagraph.speech.addressing import find_speaking_spans

QUIET = 2.0  # seconds of everyone's silence after which a side idles
MUSES = 1.3  # seconds before the first word that somebody thinks, at most
AFTER = 0.3  # seconds after the other's last word before which nobody does
PAUSE = 0.4  # seconds of one's own silence after a hesitation that make it one of thought
LEAST = 0.5  # seconds of thought below which none is shown
REACTS, STAYS = 0.2, 0.9  # seconds before and after an answer in passing that somebody reacts

Span = tuple[float, float]


def list_modes(conversation: Conversation, side: int) -> Iterator[tuple[float, Mode]]:
    """Yield from when on a side talks, listens, thinks, reacts or idles. Short silences count to the previous
    speaker.
    """
    segments = conversation.sides[side].segments
    own = find_speaking_spans(segments)
    other = [
        span
        for n in list_other_sides(conversation, side)
        for span in find_speaking_spans(conversation.sides[n].segments)
    ]
    thinks, reacts = list(_thinking(segments, other)), list(_reacting(segments, conversation.length))
    states: tuple[tuple[Mode, list[Span]], ...] = (
        ("talking", own),
        ("thinking", thinks),
        ("reacting", reacts),
    )
    edges = sorted({0.0, *(x for start, end in (*own, *other, *thinks, *reacts) for x in (start, end))})
    last: Mode | None = None
    for at in edges:
        near = any(start <= at < end + QUIET for start, end in (*own, *other))
        mode: Mode = "listening" if near else "idle"
        for name, spans in states:
            if any(start <= at < end for start, end in spans):
                mode = name
        if mode != last:
            yield round(at, 3), mode
            last = mode


def _thinking(segments: tuple[Segment, ...], other: list[Span]) -> Iterator[Span]:
    """Yield when a side thinks: before it answers after a pause, and where it hesitates and is silent."""
    ends = sorted(end for _, end in other)
    own = 0.0
    for n, s in enumerate(segments):
        heard = max((end for end in ends if end <= s.start), default=-1.0)
        begin = max(heard + AFTER, own, s.start - MUSES)
        if heard > own and s.start - begin >= LEAST:
            yield begin, s.start
        after = segments[n + 1].start if n + 1 < len(segments) else s.end
        if s.kind == "hesitation" and PAUSE <= after - s.end < QUIET:
            yield s.start, after
        own = s.end


def _reacting(segments: tuple[Segment, ...], length: float) -> Iterator[Span]:
    """Yield when a side reacts: with its answers in passing, unless it goes on to speak."""
    for n, s in enumerate(segments):
        if s.kind == "response":
            until = segments[n + 1].start if n + 1 < len(segments) else length
            yield max(0.0, s.start - REACTS), min(s.end + STAYS, until)
