"""The text form of Universal Scene Description (`.usda`), as far as a character with its clips needs it.

Written by hand so that an export needs no USD library; what is written is read back by Pixar's in the tests.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph.ids import derive_id

Array = NDArray[Any]

_ESCAPES = {"\\": "\\\\", '"': '\\"', "\n": "\\n", "\r": "\\r", "\t": "\\t"}


@dataclass
class Prim:
    """A prim. kind: its schema, "" for none. name: an identifier, see `Names`. metadata, properties: lines as
    they are written, without indentation, each a whole statement.
    """

    kind: str
    name: str
    metadata: list[str] = field(default_factory=list)
    properties: list[str] = field(default_factory=list)
    children: list[Prim] = field(default_factory=list)

    def lines(self, indent: str = "") -> Iterable[str]:
        """Yield its text."""
        head = f'{indent}def {self.kind + " " if self.kind else ""}"{self.name}"'
        if self.metadata:
            yield f"{head} ("
            yield from (f"{indent}    {line}" for line in self.metadata)
            yield f"{indent})"
        else:
            yield head
        yield f"{indent}{{"
        yield from (f"{indent}    {line}" for line in self.properties)
        for child in self.children:
            yield from child.lines(indent + "    ")
        yield f"{indent}}}"


class Names:
    """Identifiers for things of any name: letters, digits and `_` of ASCII, none twice.

    A name that other characters are in, and one that is there already, has the thing's id behind it, or else
    digits that derive from the name, so that no other thing changes them.
    """

    def __init__(self) -> None:
        self._taken: set[str] = set()

    def of(self, text: str, otherwise: str = "unnamed", ident: str = "") -> str:
        """Return an identifier that no other name here got. ident: of the thing, if it has one."""
        plain = re.sub(r"[^A-Za-z0-9_]+", "_", text)
        plain = plain if plain.strip("_") else otherwise
        plain = f"_{plain}" if plain[0].isdigit() else plain
        mark = re.sub(r"\W", "_", ident, flags=re.ASCII)
        plain = plain if text.isascii() else f"{plain}_{mark or derive_id('', text)}"
        name, count = plain, 1
        while name in self._taken:
            count += 1
            name = f"{plain}_{mark if mark and count == 2 else count}"
        self._taken.add(name)
        return name


def format_usda_string(value: str) -> str:
    """Return a string's literal."""
    out = "".join(
        _ESCAPES.get(c, c if c >= " " and c != "\x7f" else f"\\x{ord(c):02x}") for c in value
    ).encode("utf-8", "replace")
    return f'"{out.decode()}"'


def format_usda_strings(values: Iterable[str]) -> str:
    """Return an array of strings or tokens."""
    return f"[{', '.join(map(format_usda_string, values))}]"


def format_usda_number(value: float) -> str:
    """Return a number with the nine digits that tell single precision apart."""
    return f"{float(value):.9g}"


def format_usda_numbers(values: Any) -> str:
    """Return an array of numbers."""
    flat = np.asarray(values).reshape(-1)
    form = "%d" if flat.dtype.kind in "iu" else "%.7g"
    return f"[{', '.join([form] * len(flat)) % tuple(flat.tolist())}]"


def write_tuples(values: Array) -> str:
    """Return an array of tuples, of `values [N, n]`; seven digits."""
    return f"[{', '.join(write_each_tuple(values))}]"


def write_each_tuple(values: Array) -> list[str]:
    """Return the tuples of `values [N, n]` one by one."""
    count, size = values.shape
    form = f"({', '.join(['%.7g'] * size)})"
    return ("\n".join([form] * count) % tuple(values.reshape(-1).tolist())).split("\n") if count else []


def write_matrices(values: Array) -> str:
    """Return an array of matrices, of `values [N, 4, 4]` for columns: USD's are for rows."""
    out = []
    for matrix in np.asarray(values, np.float64).transpose(0, 2, 1):
        rows = (f"({', '.join(f'{x + 0.0:.12g}' for x in row)})" for row in matrix)
        out.append(f"( {', '.join(rows)} )")
    return f"[{', '.join(out)}]"


def write_time_samples(times: Sequence[float], values: Iterable[str]) -> str:
    """Return time samples, times in time codes."""
    inside = ", ".join(f"{format_usda_number(t)}: {v}" for t, v in zip(times, values, strict=True))
    return f"{{{inside}}}"


def write_usd_layer(metadata: Sequence[str], roots: Sequence[Prim]) -> bytes:
    """Return a file's content."""
    out = ["#usda 1.0", "(", *(f"    {line}" for line in metadata), ")", ""]
    for root in roots:
        out += [*root.lines(), ""]
    return "\n".join(out).encode()
