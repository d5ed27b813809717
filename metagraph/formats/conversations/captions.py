"""Conversations as captions, for players and for programs that read subtitles: WebVTT and SubRip.

A caption holds the words of one speaker up to a pause or a length; WebVTT says when each word begins.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

from metagraph.common.wording import phrase
from metagraph.common.xml_text import escape
from metagraph.errors import FileError
from metagraph.formats.atomic import write_atomically
from metagraph.graph.conversation.model import Conversation, Word, get_side_name

LONGEST, MOST = 6.0, 84  # seconds and letters of a caption: two lines of 42, as broadcasters write
PAUSE = 0.7  # seconds without a word, after which another caption begins
_BLINK = 0.001  # seconds: what a caption or word lasts at least


def write_webvtt(conversation: Conversation, path: str | Path) -> None:
    """Write captions with their speakers, and a time for each word. Raises FileError."""
    out = ["WEBVTT", ""]
    for name, words in _captions(conversation, Path(path)):
        out.append(f"{_clock(words[0].start, '.')} --> {_clock(_end(words), '.')}")
        text = escape(words[0].text)
        for before, word in pairwise(words):
            mark = f"<{_clock(word.start, '.')}>" if word.start > before.start else ""
            text += f" {mark}{escape(word.text)}"
        out += [f"<v {escape(' '.join(name.replace('>', ' ').split()))}>{text}</v>", ""]
    write_atomically(Path(path), "\n".join(out).encode())


def write_subrip(conversation: Conversation, path: str | Path) -> None:
    """Write subtitles, `Name: words` where more than one speaks. Raises FileError."""
    several = sum(bool(side.words) for side in conversation.sides) > 1
    out: list[str] = []
    for number, (name, words) in enumerate(_captions(conversation, Path(path)), 1):
        text = " ".join(word.text for word in words)
        times = f"{_clock(words[0].start, ',')} --> {_clock(_end(words), ',')}"
        out += [str(number), times, f"{name}: {text}" if several else text, ""]
    write_atomically(Path(path), "\n".join(out).encode())


def _captions(conversation: Conversation, path: Path) -> list[tuple[str, list[Word]]]:
    """Return speakers and the words of each caption, by their start. Raises FileError without words."""
    found = [
        (get_side_name(conversation, n), words)
        for n, side in enumerate(conversation.sides)
        for words in _pieces(sorted(side.words, key=lambda word: word.start))
    ]
    if not found:
        raise FileError(
            path,
            phrase("captions are words, and this conversation has none"),
            "",
            phrase("Add a transcript, or write .eaf, .TextGrid or .json."),
        )
    return sorted(found, key=lambda item: item[1][0].start)


def _pieces(words: list[Word]) -> Iterator[list[Word]]:
    """Yield the words of one caption after the other."""
    piece: list[Word] = []
    for word in words:
        if not word.text.strip():
            continue
        if piece and (
            word.start - piece[-1].end > PAUSE
            or word.end - piece[0].start > LONGEST
            or sum(len(w.text) + 1 for w in piece) + len(word.text) > MOST
        ):
            yield piece
            piece = []
        piece.append(word)
    if piece:
        yield piece


def _end(words: list[Word]) -> float:
    return max(max(word.end for word in words), words[0].start + _BLINK)


def _clock(seconds: float, point: str) -> str:
    whole = round(1000 * max(0.0, seconds))
    return (
        f"{whole // 3_600_000:02}:{whole // 60_000 % 60:02}:{whole // 1000 % 60:02}{point}{whole % 1000:03}"
    )
