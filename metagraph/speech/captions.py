"""The words of who speaks, by time, and the captions they make: what stands at the bottom of a picture.

How much a caption holds and how long it stands follows what broadcasters ask for (Netflix's Timed Text Style
Guide, general requirements: 42 characters a line, two lines, from 5/6 to 7 seconds); at which pause a new one
begins is ours.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from metagraph.errors import FileError
from metagraph.graph.conversation.model import Conversation, Word
from metagraph.graph.requests import Line
from metagraph.playback.life.items import Speech
from metagraph.speech.textgrid import TextGrid, read_textgrid

LINE, LINES = 42, 2  # characters of a line, and lines
BRIEFEST, LONGEST = 5 / 6, 7.0  # seconds a caption stands
PAUSE = 0.7  # seconds of silence after which a new caption begins; ours
_SENTENCE = re.compile(r"[.!?…。！？][\"'”’»]?$")
_WORDS = re.compile(r"word|ort|transcript|text|utter|phrase")
_SILENT = frozenset(("", "sil", "sp", "spn", "_", "<p>", "<p:>"))


@dataclass(frozen=True, slots=True)
class Caption:
    """text: lines, parted by line breaks. side: who says it, from 0."""

    start: float
    end: float
    text: str
    side: int = 0


def read_caption_words(grid: TextGrid) -> tuple[Word, ...]:
    """Return the words of a TextGrid, by start; none where it has no tier of words."""
    tier = next((t for t in grid.tiers if not t.points and _WORDS.search(t.name.casefold())), None)
    some = tier.intervals if tier is not None else ()
    return tuple(
        Word(text=i.text.strip(), start=i.start, end=i.end)
        for i in sorted(some, key=lambda i: i.start)
        if i.text.strip().casefold() not in _SILENT and i.start >= 0
    )


def describe_line(line: Line, folder: Path) -> tuple[Word, ...]:
    """Return the words of a line whose times are given in its TextGrid; none where they are not. folder: what
    its path begins at.
    """
    if line.phones is None:
        return ()
    path = folder / line.phones
    try:
        return _words_of(path, path.stat().st_mtime_ns)
    except (FileError, OSError):  # who reads the line's voice tells that
        return ()


@lru_cache(maxsize=1024)
def _words_of(path: Path, written: int) -> tuple[Word, ...]:
    return read_caption_words(read_textgrid(path))


def list_timed_words(speech: Speech, lines: Mapping[str, Sequence[Word]]) -> tuple[Word, ...]:
    """Return the words of something said as far as their times are known, in the plan's time. lines: the
    words of lines, from their start.
    """
    if speech.timing is not None and speech.timing.words:
        told = speech.timing.words
        nexts = [w.start for w in told[1:]] + [speech.end - speech.start]
        some: list[tuple[str, float, float]] = [
            (w.text, w.start, w.end if w.end is not None else max(w.start, n))
            for w, n in zip(told, nexts, strict=True)
        ]
    else:
        some = [(w.text, w.start, w.end) for w in lines.get(speech.line or "", ())]
    placed = (
        (text, speech.start + first, min(speech.start + last, speech.end)) for text, first, last in some
    )
    return tuple(Word(text=text, start=first, end=last) for text, first, last in placed if first < speech.end)


def make_captions(words: Iterable[Word], side: int = 0) -> list[Caption]:
    """Return captions of words with their times: a new one after a sentence, a pause, or where it is full."""
    out: list[Caption] = []
    held: list[Word] = []

    def close() -> None:
        if held:
            out.append(Caption(held[0].start, held[-1].end, _lines([w.text for w in held]), side))
            held.clear()

    for word in sorted(words, key=lambda w: w.start):
        if held:
            long = len(_lines([*(w.text for w in held), word.text]).split("\n")) > LINES
            if long or word.start - held[-1].end > PAUSE or word.end - held[0].start > LONGEST:
                close()
        held.append(word)
        if _SENTENCE.search(word.text):
            close()
    close()
    return _standing(out)


def make_captions_of_text(speech: Speech, text: str, side: int = 0) -> list[Caption]:
    """Return captions of a text whose words' times are not known: each has its share by its letters."""
    words, whole = text.split(), max(1, sum(len(w) + 1 for w in text.split()))
    each, at = max(0.0, speech.end - speech.start) / whole, speech.start
    timed = []
    for word in words:
        end = at + each * (len(word) + 1)
        timed.append(Word(text=word, start=at, end=end))
        at = end
    return make_captions(timed, side)


def make_conversation_captions(conversation: Conversation) -> tuple[Caption, ...]:
    """Return the captions of all who talk, by start."""
    some = (c for n, side in enumerate(conversation.sides) for c in make_captions(side.words, n))
    return tuple(sorted(some, key=lambda c: c.start))


def find_captions_at(captions: Iterable[Caption], seconds: float) -> list[Caption]:
    """Return what is to be read at a time, who began first above."""
    return [c for c in captions if c.start <= seconds < c.end]


def _standing(captions: list[Caption]) -> list[Caption]:
    """Return captions that stand long enough to be seen, as far as the next leaves the time."""
    nexts = [*(c.start for c in captions[1:]), float("inf")][: len(captions)]
    return [
        Caption(c.start, max(c.end, min(c.start + BRIEFEST, n)), c.text, c.side)
        for c, n in zip(captions, nexts, strict=True)
    ]


def _lines(words: Sequence[str]) -> str:
    """Break words into lines, two of them where they are most alike in length."""
    out = [""]
    for word in words:
        if out[-1] and len(out[-1]) + 1 + len(word) > LINE:
            out.append(word)
        else:
            out[-1] = f"{out[-1]} {word}".strip()
    if len(out) == 2:
        halves = [(" ".join(words[:n]), " ".join(words[n:])) for n in range(1, len(words))]
        out = list(min(halves, key=lambda h: max(map(len, h))))
    return "\n".join(out)
