"""Small words that several panels say alike."""

from __future__ import annotations


def many(count: int, noun: str) -> str:
    """Return "1 clip", "2,328 connections"."""
    return f"{count:,} {noun}{'s' if count != 1 else ''}"


def short(name: str, stance: str) -> str:
    """Return an action's name without its stance's name in front: what is the same in every row tells
    nothing.
    """
    wanted = [c for c in stance.lower() if c.isalnum()]
    place = 0
    for n, c in enumerate(name.lower()):
        if place == len(wanted):
            rest = name[n:].lstrip("_- .@:")
            return rest if rest and not name[n].isalnum() else name
        if c.isalnum():
            if c != wanted[place]:
                return name
            place += 1
    return name


def clips_words(count: int) -> str:
    """Return "1 clip", "152 clips"."""
    return many(count, "clip")
