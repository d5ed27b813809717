"""Reading Praat's TextGrid files: both text formats, UTF-8 or UTF-16, intervals and points.

Praat reads a text file as a row of free-standing numbers, quoted texts and `<flags>`; whatever else stands
there is for people. So the long and the short format are one. (Praat's manual, "TextGrid file formats".)
"""

from __future__ import annotations

import codecs
import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from metagraph.common.budgets import MARKS, MARKS_FILE
from metagraph.common.files import guard_reader, read_file
from metagraph.common.wording import phrase
from metagraph.errors import FileError

_TOKEN = re.compile(
    r'"(?:[^"]|"")*"|<[a-z]+>|(?<![^\s=])[+-]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?%?(?!\S)'
)
_REMEDY = phrase("In Praat, save it as a text file or a short text file.")


@dataclass(frozen=True, slots=True)
class GridInterval:
    """What is said from `start` to `end` seconds; "" for nothing. A point has no length."""

    start: float
    end: float
    text: str


@dataclass(frozen=True, slots=True)
class GridTier:
    name: str
    intervals: tuple[GridInterval, ...]
    points: bool = False


@dataclass(frozen=True, slots=True)
class TextGrid:
    """start, end: seconds."""

    start: float
    end: float
    tiers: tuple[GridTier, ...]


@guard_reader
def read_textgrid(path: str | Path) -> TextGrid:
    """Read a TextGrid. Raises FileError naming the line."""
    path = Path(path)
    return _Reader(path, _text(path)).grid()


def _text(path: Path) -> str:
    data = read_file(path, MARKS_FILE)
    if data.startswith(b"ooBinaryFile"):
        raise FileError(path, phrase("is a binary Praat file"), remedy=_REMEDY)
    utf16 = data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE))
    try:
        return data.decode("utf-16" if utf16 else "utf-8-sig")
    except UnicodeDecodeError:
        return data.decode(
            "utf-16" if utf16 else "latin-1", "replace"
        )  # Praat once wrote the system's own encoding


class _Reader:
    def __init__(self, path: Path, text: str) -> None:
        self.path, self.text = path, text
        self.at = self.marks = 0
        self.tokens = self._tokens()

    def _tokens(self) -> Iterator[str]:
        for found in _TOKEN.finditer(self.text):
            self.at = found.start()
            yield found.group()
        self.at = len(self.text)

    def fail(self, cause: str) -> FileError:
        line = self.text.count("\n", 0, self.at) + 1
        return FileError(self.path, cause, phrase("line {line}", line=line), _REMEDY)

    def word(self, what: str) -> str:
        token = next(self.tokens, None)
        if token is None:
            raise self.fail(phrase("ends before its {what}", what=what))
        if not token.startswith('"'):
            raise self.fail(phrase("has {token} instead of its {what}", token=token[:20], what=what))
        return token[1:-1].replace('""', '"')

    def number(self, what: str) -> float:
        token = next(self.tokens, None)
        if token is None:
            raise self.fail(phrase("ends before its {what}", what=what))
        try:
            value = float(token)
        except ValueError:
            raise self.fail(
                phrase("has {token} instead of its {what}", token=token[:20], what=what)
            ) from None
        if not abs(value) < 1e7:
            raise self.fail(phrase("{what} is {token}", what=what, token=token[:20]))
        return value

    def count(self, what: str) -> int:
        value = self.number(what)
        if value < 0 or value != math.floor(value):
            raise self.fail(phrase("{what} is {value:g}", what=what, value=value))
        return int(value)

    def grid(self) -> TextGrid:
        kind = self.word("file type")
        what = self.word("object class")
        if kind != "ooTextFile" or not what.startswith("TextGrid"):
            raise self.fail(
                phrase("it is not a TextGrid but {kind!r}, {what!r}", kind=kind[:20], what=what[:20])
            )
        start, end = self.number("start"), self.number("end")
        exists = next(self.tokens, "")
        tiers = (
            tuple(self.tier() for _ in range(self.count("number of tiers"))) if exists == "<exists>" else ()
        )
        return TextGrid(start, end, tiers)

    def tier(self) -> GridTier:
        kind = self.word("tier's class")
        if kind not in ("IntervalTier", "TextTier"):
            raise self.fail(phrase("there is no tier of class {kind!r}", kind=kind[:20]))
        name = self.word("tier's name")
        self.number("tier's start")
        self.number("tier's end")
        out: list[GridInterval] = []
        for _ in range(self.count("number of intervals")):
            self.marks += 1
            if self.marks > MARKS:
                raise self.fail(phrase("it has more than {most:,} intervals", most=MARKS))
            start = self.number("interval's start")
            end = self.number("interval's end") if kind == "IntervalTier" else start
            if end < start:
                raise self.fail(
                    phrase(
                        "an interval ends at {end:g} s, before it starts at {start:g} s", end=end, start=start
                    )
                )
            out.append(GridInterval(start, end, self.word("interval's text").strip()))
        return GridTier(name, tuple(out), kind == "TextTier")
