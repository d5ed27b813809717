"""Names cut into tokens: runs of letters of one writing, and numbers; and the words that tokens stand for."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final

from metagraph.suggest.words.folded import fold_letters, is_run_together

_PIECES = re.compile(r"\d+[hH](?![^\W_])|\d+|[^\W\d_]+|[\W_]+")
_ARROW = re.compile("[→⇒➔➜]|[-=]+>")
ARROW: Final = "→"  # as a token, whatever arrow it is: "to"
_ELIDED = frozenset((
    "l", "d", "n", "m", "t", "s", "j", "c", "qu", "un", "all", "dell", "nell", "sull", "dall",
    "coll",
))  # fmt: skip


class EnglishWord(str):
    """A word of English that stands for what a name says in another language. written: what that is, small
    letters; "" for all but the first of several that stand for it together. start, end: where in the name.
    """

    written: str
    start: int
    end: int

    def __new__(cls, text: str, written: str = "", start: int = 0, end: int = 0) -> EnglishWord:
        word = super().__new__(cls, text)
        word.written, word.start, word.end = written, start, end
        return word


def as_written(words: Iterable[str]) -> tuple[str, ...]:
    """Return words as their name has them."""
    said = ((w.written if isinstance(w, EnglishWord) else w) for w in words)
    return tuple(w for w in said if w)


@dataclass(frozen=True, slots=True)
class Token:
    """A run of letters of a name, or a number. text: folded, small. shown: as written, small. alone: one
    capital letter. elided: an apostrophe follows.
    """

    text: str
    shown: str
    start: int
    end: int
    alone: bool = False
    elided: bool = False

    @property
    def run(self) -> bool:
        """Whether it is of a writing without blanks between words."""
        return is_run_together(self.text[0])


@dataclass(frozen=True, slots=True)
class TokenBreak:
    """What stands between tokens."""

    text: str


def cut_tokens(text: str, offset: int = 0, whole: str | None = None) -> list[Token | TokenBreak]:
    """Take a text apart at separators, capitals, digits and where the writing changes. offset: of the text in
    the name.
    """
    name = text if whole is None else whole
    letters, places = fold_letters(text)
    out: list[Token | TokenBreak] = []
    for piece in _PIECES.finditer(letters):
        said, at = piece[0], piece.start()
        if not (said[0].isalpha() or said[0].isdecimal()):
            arrow = _ARROW.search(said)
            if arrow is not None and out and piece.end() < len(letters):
                start, stop = (places[at + k] + offset for k in arrow.span())
                out.append(Token(ARROW, letters[slice(*(at + k for k in arrow.span()))], start, stop))
            else:
                out.append(TokenBreak(said))
            continue
        for part in _camel(said) if said[0].isalpha() else [said]:
            end = at + len(part)
            start, stop = places[at] + offset, places[end] + offset
            small = part.lower()
            shown = small if text.isascii() else unicodedata.normalize("NFC", name[start:stop]).lower()
            follows = letters[end : end + 1]
            out.append(Token(
                small, shown, start, stop, len(part) == 1 and part.isupper(),
                follows in ("'", "’") and small in _ELIDED,
            ))  # fmt: skip
            at = end
    return out


def _camel(run: str) -> list[str]:
    cuts = [0]
    for i in range(1, len(run)):
        rises = run[i - 1].islower() and run[i].isupper()
        ends = run[i - 1].isupper() and run[i].isupper() and i + 1 < len(run) and run[i + 1].islower()
        if rises or ends or is_run_together(run[i - 1]) != is_run_together(run[i]):
            cuts.append(i)
    return [run[a:b] for a, b in zip(cuts, [*cuts[1:], len(run)], strict=True)]
