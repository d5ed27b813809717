"""Texts that break where they are too long: Wadler's pretty printer, in little.

A document is a text, several documents, or a group: on one line where it fits, else broken at all its
own breaks.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain


@dataclass(frozen=True)
class LineBreak:
    """A new line where the group is broken, else `flat`."""

    flat: str = ""


@dataclass(frozen=True)
class Nest:
    """What is indented by a step where its group is broken."""

    of: Document


@dataclass(frozen=True)
class Group:
    of: Document
    tail: str = ""  # what is written before the last break where it is broken: a comma


@dataclass(frozen=True)
class Tail:
    """A text written only where the group is broken."""

    text: str


Document = str | LineBreak | Nest | Group | Tail | tuple["Document", ...]


def put_in_brackets(opening: str, items: Sequence[Document], closing: str, trailing: str = "") -> Document:
    """Return items in brackets, with commas between. trailing: after the last where each has its own line."""
    if not items:
        return opening + closing
    between: list[Document] = []
    for n, item in enumerate(items):
        between += [item] if n == 0 else [",", LineBreak(" "), item]
    return Group((opening, Nest((LineBreak(), *between)), Tail(trailing), LineBreak(), closing))


def put_on_one_line(document: Document) -> str:
    """Return a document on one line."""
    if isinstance(document, str):
        return document
    if isinstance(document, LineBreak):
        return document.flat
    if isinstance(document, Tail):
        return ""
    if isinstance(document, tuple):
        return "".join(put_on_one_line(d) for d in document)
    return put_on_one_line(document.of)


def break_lines(document: Document, indent: int, step: str, width: int, before: int = 0) -> list[str]:
    """Return a document as lines, the first without its indent. indent: in steps. before: characters in
    front of the first on its line.
    """
    out = [""]

    def place() -> int:
        return len(out[-1].expandtabs(4)) + (before if len(out) == 1 else 0)

    def put(d: Document, depth: int, broken: bool, after: int) -> None:
        """after: characters that must fit behind it on its last line."""
        if isinstance(d, str):
            out[-1] += d
        elif isinstance(d, LineBreak):
            if broken:
                out[-1] = out[-1].rstrip(" ")
                out.append(step * depth)
            else:
                out[-1] += d.flat
        elif isinstance(d, Tail):
            out[-1] += d.text if broken else ""
        elif isinstance(d, Nest):
            put(d.of, depth + 1 if broken else depth, broken, after)
        elif isinstance(d, Group):
            fits = place() + len(put_on_one_line(d)) + after <= width
            put(d.of, depth, not fits, after)
        else:
            for n, one in enumerate(d):
                rest = chain.from_iterable([] if isinstance(r, tuple) else [r] for r in d[n + 1 :])
                near = 0
                for r in rest:
                    if isinstance(r, LineBreak) and broken:
                        break
                    near += len(put_on_one_line(r))
                    if isinstance(r, Group):
                        near -= len(put_on_one_line(r))
                        break
                else:
                    near += after
                put(one, depth, broken, near)

    put(document, indent, True, 0)
    return out
