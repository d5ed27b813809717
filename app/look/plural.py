"""Small words that several panels say alike."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import lru_cache

from app.translation import tr, tr_plural

FRONT = "@|:"  # what studios put between a character's name and an action's
_RUN = re.compile(r"[^\W\d_]+|\d+")  # of letters, or of digits


def list_in_words(words: Sequence[str]) -> str:
    """Return "Ann", "Ann and Ben", "Ann, Ben and Cleo"."""
    return tr(" and ").join(filter(None, (", ".join(words[:-1]), *words[-1:])))


def strip_stance(name: str, stance: str) -> str:
    """Return an action's name without its stance's name in front, nor what is before that up to one of FRONT:
    what is the same in every row tells nothing. Numbers count as such: "Idle01" is "idle 1".
    """
    words, told = split_name(stance), split_name(name)
    if not words or words[0] not in told:
        return name
    found = split_name_at(name)
    for first in range(len(found) - len(words)):
        if first and name[found[first][1] - 1] not in FRONT:
            continue
        if told[first : first + len(words)] == words:
            return name[found[first + len(words)][1] :]
    return name


@lru_cache(maxsize=16384)
def split_name(name: str) -> tuple[str, ...]:
    """Return a name's words and numbers."""
    return tuple(word for word, *_ in split_name_at(name))


@lru_cache(maxsize=16384)  # each name is looked at beside each stance, whenever cards are painted
def split_name_at(name: str) -> tuple[tuple[str, int, int], ...]:
    """Return a name's words and numbers, each with where it begins and ends."""
    out = []
    for run in _RUN.finditer(name):
        if run[0].isdecimal():
            out.append((str(int(run[0])), run.start(), run.end()))
            continue
        ends = [i for i in range(run.start() + 1, run.end()) if _begins_word(name, i)]
        for begin, end in zip([run.start(), *ends], [*ends, run.end()], strict=True):
            out.append((name[begin:end].lower(), begin, end))
    return tuple(out)


def _begins_word(name: str, i: int) -> bool:
    """Return whether a letter after another begins a word: "IdleBack", "HTTPServer", or in another script."""
    before, letter, after = name[i - 1], name[i], name[i + 1 : i + 2]
    if (before.lower() != before.upper()) != (letter.lower() != letter.upper()):
        return True
    return letter.isupper() and (not before.isupper() or after.islower())


def count_clips(count: int) -> str:
    """Return "1 clip", "152 clips"."""
    return tr_plural("{count:,} clip", "{count:,} clips", count)
