"""Keep of a language model's text what is to be said: no thinking, code, addresses or marks of Markdown; a
break of SSML is a pause.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass

from metagraph.common.wording import Phrase, phrase

LONGEST_BREAK = 10.0  # seconds, as SSML's own engines allow
THINKING = phrase("thinking")
CODE = phrase("code")
ADDRESSES = phrase("addresses")
PICTURES = phrase("pictures")
_INSIDE = "\0"  # stands before what does not begin a line
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
_EMPHASIS = re.compile(r"(?<!\w)[*_~]{1,3}(?=\S)|(?<=\S)[*_~]{1,3}(?!\w)")
# What has begun at the end of a text and may go on: everything from there on waits.
_OPEN = (
    re.compile(r"\S+\Z"),
    re.compile(rf"<(?:{_THINKS})\b[^<>]*>(?:(?!</(?:{_THINKS})>).)*\Z", re.IGNORECASE | re.DOTALL),
    re.compile(r"```(?:(?!```).)*\Z", re.DOTALL),
    re.compile(r"<[A-Za-z/][^<>\n]*\Z|<\Z"),
    re.compile(r"`[^`\n]*\Z"),
    re.compile(r"!?\[[^\]\n]*\Z|!?\[[^\]\n]*\]\([^)\n]*\Z|!?\[[^\]\n]*\]\Z"),
    re.compile(r"(?m)^[ \t]*[#>*+`-]*[ \t]*\Z"),
)


_BEFORE_MARK = re.compile(r" ([.,;:!?…])(?=\s|$)")  # a blank that something left out has left


@dataclass(frozen=True)
class SpokenPart:
    """A part of a text to say, and the seconds of silence after it."""

    text: str
    pause: float = 0.0


class SpokenText:
    """Takes a text in pieces, and returns what of it is to be said. `left_out` names what was not."""

    def __init__(self) -> None:
        self.left_out: list[Phrase] = []
        self._waiting = ""
        self._begins = True  # whether what comes next begins a line

    def take(self, piece: str, over: bool = False) -> list[SpokenPart]:
        """Take in the next piece; return the parts of the text that are certain by now. `over` tells that the
        text ends here; thinking or code that has not ended by then is left out.
        """
        text = self._waiting + piece
        end = len(text) if over else _certain(text)
        if len(text) - end > _HELD:
            end = len(text)
        self._waiting = text[end:]
        parts = self._parts(text[:end] if self._begins else _INSIDE + text[:end])
        self._begins = text[end - 1] == "\n" if end else self._begins
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
        return [part for part in out if part.text.strip() or part.pause > 0]

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
    line = ""
    for n, part in enumerate(parts):
        said = part.text.strip()
        if n and line and said:
            comma = parts[n - 1].pause > 0 and line[-1].isalnum()
            line += ", " if comma else " "
        line += said
    return _BEFORE_MARK.sub(r"\1", " ".join(line.split())), left_out


def _certain(text: str) -> int:
    """Return up to if nothing that comes later changes what is to be said."""
    end, before = len(text), -1
    while end != before:
        before = end
        for pattern in _OPEN if end == len(text) else _OPEN[1:]:
            found = pattern.search(text[:end])
            end = found.start() if found is not None else end
    return end


def _plain(text: str) -> str:
    """Return a text without tags and marks of Markdown."""
    text = _TAG.sub("", text)
    text = _RULES.sub("", text)
    text = _LINE_MARKS.sub("", text)
    text = text.replace("`", "")
    return _EMPHASIS.sub("", text).replace(_INSIDE, "")


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
