"""A transcript's file as readers get it: what is in it, and the sound that it belongs to."""

from __future__ import annotations

import json
import re
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import Element, TreeBuilder
from xml.parsers import expat

from metagraph.common.budgets import MARKS, NESTING
from metagraph.common.wording import phrase
from metagraph.errors import FileError

_JSON = re.compile(r"\{|\[\s*(?:[\[{\"\]]|$)")  # "[00:01:02] Ann: so" is none
_ROOT = re.compile(r"<\s*([A-Za-z_][\w.-]*)")
_SKIPPED = re.compile(r"<!--.*?-->|<\?.*?\?>|<!DOCTYPE[^>\[]*(?:\[.*?\])?[^>]*>", re.DOTALL)


@dataclass(frozen=True)
class TranscriptSound:
    """What a transcript was made of, as far as it is known. seconds: its length. names: of its files."""

    seconds: float | None = None
    names: tuple[str, ...] = ()


UNKNOWN_SOUND = TranscriptSound()


@dataclass(frozen=True)
class TranscriptSource:
    """A transcript's file. text: its content; raw: its bytes. sound: what it was made of."""

    path: Path
    text: str
    raw: bytes = b""
    sound: TranscriptSound = field(default=UNKNOWN_SOUND)

    @cached_property
    def head(self) -> str:
        """What it begins with, without blanks before it."""
        return self.text.lstrip("\ufeff \t\n")[:4000]

    @cached_property
    def data(self) -> Any:
        """What it holds as JSON: of several values, as a program writes one a line, the list of them; None
        if it is no JSON. Raises FileError if it begins like some and is broken.
        """
        if _JSON.match(self.head) is None:
            return None
        try:
            return json.loads(self.text)
        except json.JSONDecodeError as error:
            values = self._values() if error.msg == "Extra data" else None
            if values is not None:
                return values
            raise FileError(
                self.path,
                phrase("is not JSON ({msg})", msg=error.msg),
                phrase("line {lineno}, column {colno}", lineno=error.lineno, colno=error.colno),
                phrase("Save the transcript again."),
            ) from None
        except (RecursionError, ValueError):
            raise FileError(
                self.path,
                phrase("its lists are nested too deep, or its numbers are too long"),
                "",
                phrase("Save the transcript again."),
            ) from None

    def _values(self) -> list[Any] | None:
        decoder, at = json.JSONDecoder(), 0
        out: list[Any] = []
        while (at := _not_blank(self.text, at)) < len(self.text):
            try:
                value, at = decoder.raw_decode(self.text, at)
            except (json.JSONDecodeError, RecursionError, ValueError):
                return None
            if not isinstance(value, dict) or len(out) > MARKS:
                return None
            out.append(value)
        return out

    @cached_property
    def keys(self) -> frozenset[str]:
        """The names of what a JSON object holds; of a list, of its first object. Empty without any."""
        first = self.data[0] if isinstance(self.data, list) and self.data else self.data
        return frozenset(first) if isinstance(first, dict) else frozenset()

    @cached_property
    def root(self) -> str:
        """The name of its outermost XML element; "" where it is no XML."""
        if not self.head.startswith("<"):
            return ""
        found = _ROOT.match(_SKIPPED.sub("", self.head).lstrip())
        return found[1] if found is not None else ""

    def xml(self) -> Element:
        """Return its outermost XML element. Raises FileError; for XML that defines entities, too."""
        remedy = phrase("Save it again in the program that made it.")
        builder, parser = TreeBuilder(), expat.ParserCreate()
        parser.buffer_text = True
        depth = 0

        def place() -> str:
            return phrase("line {lineno}", lineno=parser.CurrentLineNumber)

        def begin(name: str, at: dict[str, str]) -> None:
            nonlocal depth
            depth += 1
            if depth > NESTING:
                raise FileError(
                    self.path,
                    phrase("its elements are nested more than {most} levels deep", most=NESTING),
                    place(),
                    remedy,
                )
            builder.start(name, at)

        def end(name: str) -> None:
            nonlocal depth
            depth -= 1
            builder.end(name)

        def entity(*_: object) -> None:
            raise FileError(
                self.path,
                phrase("it defines its own XML entities, which no annotation program does"),
                place(),
                remedy,
            )

        parser.StartElementHandler, parser.EndElementHandler = begin, end
        parser.CharacterDataHandler, parser.EntityDeclHandler = builder.data, entity
        try:
            parser.Parse(self.raw or self.text.encode(), True)
        except expat.ExpatError as error:
            cause = expat.errors.messages[error.code]
            raise FileError(
                self.path,
                phrase("it is not well-formed XML ({cause})", cause=cause),
                phrase("line {lineno}, column {offset}", lineno=error.lineno, offset=error.offset + 1),
                remedy,
            ) from None
        except (LookupError, ValueError) as error:  # an encoding nobody knows
            raise FileError(
                self.path, phrase("its text cannot be decoded ({error})", error=error), "", remedy
            ) from None
        return builder.close()


def _not_blank(text: str, at: int) -> int:
    while at < len(text) and text[at] in " \t\n\r\ufeff":
        at += 1
    return at
