"""Conversations of several for tests, made of segments alone, and one spoken by eSpeak NG."""

from __future__ import annotations

import random

from metagraph.graph.conversation.model import Conversation, Segment, Side
from sample_clips.make.talk import SpeakingVoice
from tests.speech.talk import Talk, Turn, speak

NAMES = ("Ann", "Ben", "Cleo", "Dora", "Emil", "Fay", "Gus", "Hal")
VOICES: tuple[SpeakingVoice, ...] = (("en-us", 38, 165), ("en-us+m3", 30, 170), ("en-us+f3", 60, 175))
TURNS = (
    Turn(0, 0.5, ("who wants to *start*",)),
    Turn(1, 0.3, ("hesitation: um",)),
    Turn(1, 0.3, ("I would take the *boat*", "down the *river*")),
    Turn(2, -0.3, ("response: really",)),
    Turn(2, 0.5, ("the *boat* is full of holes",)),
    Turn(0, 0.4, ("and what do *you* think Ben",)),
    Turn(1, 0.4, ("it was only the *pump*",)),
)


def said(side: int, start: float, end: float, text: str = "", to: int | None = None) -> tuple[int, Segment]:
    """A clause of a side."""
    return side, Segment("clause", start, end, (start + end) / 2, text, to)


def group(count: int, *rows: tuple[int, Segment], length: float = 30.0, seed: int = 1) -> Conversation:
    """A conversation of so many, of segments with whose they are."""
    sides = tuple(
        Side(name=NAMES[n], segments=tuple(s for side, s in rows if side == n)) for n in range(count)
    )
    return Conversation(name="talk", length=length, sides=sides, seed=seed)


def made_up(count: int, seed: int, length: float = 60.0) -> Conversation:
    """A lively conversation: turns of one to four clauses, pauses and some words into each other."""
    chance, rows, at, last = random.Random(seed), [], 0.5, -1
    while at < length - 12:
        last = chance.choice([n for n in range(count) if n != last])
        for _ in range(chance.randint(1, 4)):
            lasts = chance.uniform(0.8, 2.0)
            rows.append(said(last, round(at, 3), round(at + lasts, 3), f"w{len(rows)}"))
            at += lasts + chance.uniform(0, 0.3)
        at += chance.choice((0.2, 0.4, 0.8, 2.0))
    return group(count, *rows, length=length, seed=seed)


def spoken() -> Talk:
    """Three who talk, each in a channel of its own. Skips the test where eSpeak NG is not there."""
    return speak(TURNS, voices=VOICES)
