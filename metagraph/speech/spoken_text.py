"""Keep of a language model's text what is to be said: no thinking, code, addresses or marks of Markdown; a
break of SSML is a pause.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from metagraph.common.wording import Phrase, phrase

LONGEST_BREAK = 10.0  # seconds, as SSML's own engines allow
THINKING = phrase("thinking")
CODE = phrase("code")
ADDRESSES = phrase("addresses")
PICTURES = phrase("pictures")
_INSIDE = "\0"  # stands before what does not begin a line,
_IN_WORD = "\u2c76"  # and before what goes on with a word
_HELD = 20_000  # characters of a part that has not ended: more is taken as it is
_STRENGTHS = {"none": 0.0, "x-weak": 0.1, "weak": 0.25, "medium": 0.5, "strong": 0.8, "x-strong": 1.2}
_THINKS = "think|thinking|thought|reasoning|scratchpad|analysis"
_BREAK = re.compile(r"<break\b([^<>]*)>", re.IGNORECASE)
_TAG = re.compile(r"</?[A-Za-z][\w:-]*(?:\s[^<>]*)?/?>")
_ADDRESS = re.compile(
    r"\b(?:https?://|www\.)[^\s<>()\[\]]*[^\s<>()\[\].,;:!?'\"]|\b[\w.+-]+@[\w-]+\.[\w.-]*\w"
)
_LINE_MARKS = re.compile(r"(?m)^[ \t]*(?:#{1,6}[ \t]+|>[ \t]?|[-*+][ \t]+)+")
_RULES = re.compile(r"(?m)^[ \t]*(?:[-*_][ \t]*){3,}$")
_TABLE = re.compile(r"(?m)^[ \t]*\|(.*)\|[ \t]*$")
_EMPHASIS = re.compile(r"(?<!\w)[*_~]{1,3}(?=\S)|(?<=\S)[*_~]{1,3}(?!\w)")
# What has begun at the end of a text and may go on: everything from there on waits.
_OPEN = (
    re.compile(r"\S+\Z"),
    re.compile(rf"<(?:{_THINKS})\b[^<>]*>(?:(?!</(?:{_THINKS})>).)*\Z", re.IGNORECASE | re.DOTALL),
    re.compile(r"```(?:(?!```).)*\Z", re.DOTALL),
    re.compile(r"<[A-Za-z/][^<>\n]*\Z|<\Z"),
    re.compile(r"!?\[[^\]\n]*\Z|!?\[[^\]\n]*\]\([^)\n]*\Z|!?\[[^\]\n]*\]\Z"),
    re.compile(r"(?m)^[ \t]*[#>*+`-]*[ \t]*\Z"),
    re.compile(r"(?m)^[ \t]*\|[^\n]*\Z"),
)
# Where words are said letter by letter as they come, only these of their pieces wait.
_OPEN_IN_WORDS = re.compile(r"\bht(?:t\S*)?\Z|\bwww?\S*\Z|\S+@\S*\Z|[*_~]{1,3}\Z")


_BEFORE_MARK = re.compile(r" ([.,;:!?…])(?=\s|$)")  # a blank that something left out has left


@dataclass(frozen=True)
class SpokenPart:
    """A part of a text to say, and the seconds of silence after it."""

    text: str
    pause: float = 0.0


class SpokenText:
    """Takes a text in pieces, and returns what of it is to be said. `left_out` names what was not. words:
    whether a word is returned when it is whole; else as it comes.
    """

    def __init__(self, words: bool = True) -> None:
        self._words = words
        self._open = _OPEN if words else (_OPEN_IN_WORDS, *_OPEN[1:])
        self.left_out: list[Phrase] = []
        self._waiting = ""
        self._before = ""  # what stands for what came before, where that did not end a line

    def take(self, piece: str, over: bool = False) -> list[SpokenPart]:
        """Take in the next piece; return the parts of the text that are certain by now. `over` tells that the
        text ends here; thinking or code that has not ended by then is left out.
        """
        text, before = self._waiting + piece, self._before
        end = len(text) if over else max(0, _find_certain(before + text, self._open) - len(before))
        if len(text) - end > _HELD:
            end = len(text)
        self._waiting = text[end:]
        parts = self._parts(before + text[:end])
        if end:
            last = text[end - 1]
            self._before = "" if last == "\n" else _IN_WORD if last.isalnum() or last == "_" else _INSIDE
        return parts

    def _parts(self, text: str) -> list[SpokenPart]:
        text = self._without(rf"<({_THINKS})\b[^<>]*>.*?(?:</\1>|\Z)", text, THINKING)
        text = self._without(r"```.*?(?:```|\Z)", text, CODE)
        text = self._without(r"!\[[^\]\n]*\]\([^)\n]*\)", text, PICTURES)
        text = re.sub(r"\[([^\]\n]+)\]\([^)\n]*\)", self._address(lambda m: m[1]), text)
        text = _ADDRESS.sub(self._address(lambda m: ""), text)
        parts, pauses = _BREAK.split(text)[::2], _BREAK.split(text)[1::2]
        out = [
            SpokenPart(_plain(part), _seconds(pause))
            for part, pause in zip(parts, [*pauses, None], strict=True)
        ]
        return [
            part for part in out if part.text.strip() or part.pause > 0 or (part.text and not self._words)
        ]

    def _without(self, pattern: str, text: str, what: Phrase) -> str:
        found = re.sub(pattern, " ", text, flags=re.IGNORECASE | re.DOTALL)
        if found != text:
            self._note(what)
        return found

    def _address(self, kept: Callable[[re.Match[str]], str]) -> Callable[[re.Match[str]], str]:
        def replace(found: re.Match[str]) -> str:
            self._note(ADDRESSES)
            return kept(found)

        return replace

    def _note(self, what: Phrase) -> None:
        if what not in self.left_out:
            self.left_out.append(what)


def read_spoken(text: str) -> tuple[list[SpokenPart], list[Phrase]]:
    """Return the parts of a whole text to say, and what was left out of it."""
    reader = SpokenText()
    return reader.take(text, over=True), reader.left_out


def read_spoken_line(text: str) -> tuple[str, list[Phrase]]:
    """Return what of a text is to be said as one line, pauses as commas, and what was left out of it."""
    parts, left_out = read_spoken(text)
    return join_spoken(parts), left_out


def join_spoken(parts: Sequence[SpokenPart]) -> str:
    """Return parts of a text as one line, pauses as commas."""
    line = ""
    for n, part in enumerate(parts):
        said = part.text.strip()
        if n and line and said:
            comma = parts[n - 1].pause > 0 and line[-1].isalnum()
            line += ", " if comma else " "
        line += said
    return _BEFORE_MARK.sub(r"\1", " ".join(line.split()))


def _find_certain(text: str, open_: Sequence[re.Pattern[str]]) -> int:
    """Return up to where nothing that comes later changes what is to be said."""
    end, before = len(text), -1
    while end != before:
        before = end
        for pattern in open_ if end == len(text) else open_[1:]:
            found = pattern.search(text[:end])
            end = found.start() if found is not None else end
        line = text.rfind("\n", 0, end) + 1
        if text.count("`", line, end) % 2:
            end = text.rfind("`", line, end)
    return end


def _plain(text: str) -> str:
    """Return a text without tags and marks of Markdown."""
    text = _TAG.sub("", text)
    text = _RULES.sub("", text)
    text = _TABLE.sub(_read_row, text)
    text = _LINE_MARKS.sub("", text)
    text = text.replace("`", "")
    return _EMPHASIS.sub("", text).replace(_INSIDE, "").replace(_IN_WORD, "")


def _read_row(row: re.Match[str]) -> str:
    """Return the cells of a table's row as a list; nothing of the line below its head."""
    cells = [cell.strip() for cell in row[1].split("|")]
    return (
        "" if all(re.fullmatch(r":?-+:?", cell) for cell in cells) else ", ".join(c for c in cells if c) + "."
    )


def _seconds(attributes: str | None) -> float:
    """Return how long a break lasts, by its attributes."""
    if attributes is None:
        return 0.0
    time = re.search(r"time\s*=\s*[\"']?\s*([\d.]+)\s*(ms|s)", attributes, re.IGNORECASE)
    if time is not None:
        try:
            value = float(time[1]) / (1000 if time[2].lower() == "ms" else 1)
        except ValueError:
            return _STRENGTHS["medium"]
        return min(value, LONGEST_BREAK)
    strength = re.search(r"strength\s*=\s*[\"']?([\w-]+)", attributes, re.IGNORECASE)
    return _STRENGTHS.get(strength[1].lower(), 0.5) if strength is not None else _STRENGTHS["medium"]
