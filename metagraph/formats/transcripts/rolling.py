"""Captions that show again what was said: lines that roll up, lines that grow word by word, and sentences
that stand while one word after the other is marked.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

_MARKED = re.compile(r"<(u|b|i|font\b[^<>]{0,100}|c\.[^<>]{1,100})>\s*([^<>]+?)\s*</[a-z]+>", re.I)
_GAP = 0.5  # seconds between cues after which the same words are said again
_STRONG = 2  # cues that add to what they repeat: from as many on, captions roll
_CONTEXT = 0.12  # seconds by which a cue may begin after the one before it has ended, to go on with it


@dataclass(frozen=True)
class ShownText:
    """A cue, when it is shown, and its lines as they stand (`text`) and without tags (`plain`)."""

    line: int
    start: float
    end: float
    text: tuple[str, ...]
    plain: tuple[str, ...]
    timed: tuple[bool, ...]  # whether a line has times inside

    def without(self, lines: int) -> ShownText:
        return replace(self, text=self.text[lines:], plain=self.plain[lines:], timed=self.timed[lines:])


def drop_repeats(cues: Sequence[ShownText]) -> tuple[list[ShownText], int]:
    """Return cues without what they repeat of the ones before, and how many said again what was shown."""
    marked = _one_marked(cues)
    if marked is not None:
        return marked, len(cues) - len(marked)
    timed = any(any(cue.timed) for cue in cues)
    if not timed and not _rolls(cues):
        return list(cues), 0
    out: list[ShownText] = []
    shown, until, repeats = tuple[str, ...](), float("-inf"), 0
    for cue in cues:
        if not cue.plain:
            continue
        near = cue.start - until <= _GAP
        same = _repeated(cue, shown) if near else 0
        kept = cue.without(same)
        if not timed and near and kept.plain and shown and (grown := _grown(kept.plain[0], shown[-1])):
            kept = replace(kept, text=(grown, *kept.text[1:]))
            same += 1
        repeats += same > 0
        shown, until = cue.plain, max(until, cue.end)
        if any(p for p in kept.plain):
            out.append(kept)
    return out, repeats


def _repeated(cue: ShownText, shown: Sequence[str]) -> int:
    """Return how many of a cue's first lines are the last that were shown."""
    for size in range(min(len(cue.plain), len(shown)), 0, -1):
        if cue.plain[:size] == tuple(shown[-size:]) and not any(cue.timed[:size]):
            return size
    return 0


def _grown(line: str, before: str) -> str:
    """Return what a line adds to the one before, "" where it does not begin with that."""
    return line[len(before) :].strip() if before and line.startswith(before + " ") else ""


def _rolls(cues: Sequence[ShownText]) -> bool:
    """Return whether captions without times inside repeat themselves: in half of the cues that follow another
    at once, a part of the text is what was shown, and the rest is new.
    """
    strong = following = 0
    for a, b in pairwise([c for c in cues if c.plain]):
        if b.start - a.end > _CONTEXT:
            continue
        following += 1
        same = _repeated(b, a.plain)
        rest = b.plain[same:]
        strong += bool((same and rest) or (rest and _grown(rest[0], a.plain[-1])))
    return strong >= _STRONG and 2 * strong >= following


def _one_marked(cues: Sequence[ShownText]) -> list[ShownText] | None:
    """Return a cue for each marked word, where the same sentence stands again and again with another word
    marked (Whisper's `--highlight_words`); None for other captions.
    """
    found = [[m for line in cue.text for m in _MARKED.finditer(line)] for cue in cues]
    again = sum(a.plain == b.plain for a, b in pairwise(cues))
    marked = sum(len(m) == 1 for m in found)
    if marked < 2 or 2 * marked < len(cues) or 3 * again < len(cues):
        return None
    out = []
    for n, (cue, some) in enumerate(zip(cues, found, strict=True)):
        if len(some) == 1:
            word = some[0][2]
            out.append(replace(cue, text=(word,), plain=(word,), timed=(False,)))
        elif not any(
            m and c.plain == cue.plain
            for c, m in zip(cues[max(0, n - 3) : n + 4], found[max(0, n - 3) : n + 4], strict=True)
        ):
            out.append(cue)
    return out
