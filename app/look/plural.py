"""Small words that several panels say alike."""

from __future__ import annotations

import re

FRONT = "@|:"  # what studios put between a character's name and an action's
_PART = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+|[^\W\d_a-zA-Z]+")


def many(count: int, noun: str) -> str:
    """Return "1 clip", "2,328 connections"."""
    return f"{count:,} {noun}{'s' if count != 1 else ''}"


def short(name: str, stance: str) -> str:
    """Return an action's name without its stance's name in front, nor what is before that up to one of FRONT:
    what is the same in every row tells nothing. Numbers count as such: "Idle01" is "idle 1".
    """
    wanted, found = parts(stance), parts(name)
    words = [word for word, *_ in wanted]
    for first in range(len(found) - len(words) if words else 0):
        if first and name[found[first][1] - 1] not in FRONT:
            continue
        if [word for word, *_ in found[first : first + len(words)]] == words:
            return name[found[first + len(words)][1] :]
    return name


def parts(name: str) -> list[tuple[str, int, int]]:
    """Return a name's words and numbers, each with where it begins and ends."""
    return [
        (str(int(m[0])) if m[0].isdecimal() else m[0].lower(), m.start(), m.end())
        for m in _PART.finditer(name)
    ]


def clips_words(count: int) -> str:
    """Return "1 clip", "152 clips"."""
    return many(count, "clip")
