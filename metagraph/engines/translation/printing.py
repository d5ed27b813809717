"""What the printers of all languages have in common: names, strength of operators, comments, and a
text growing line by line.
"""

from __future__ import annotations

import re
import textwrap
import tomllib
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path, PurePosixPath
from typing import ClassVar

from metagraph.engines.translation import tree as x
from metagraph.engines.translation.layout import (
    Document,
    Group,
    LineBreak,
    Nest,
    break_lines,
    put_in_brackets,
    put_on_one_line,
)

LANGUAGES = Path(__file__).with_name("languages.toml")
# How strongly operators bind, the same in C-like languages except for bits, which are put in brackets always.
ALONE, UNARY, POWER, TIMES, PLUS, SHIFT, COMPARE, NOT, AND, OR, CHOICE = range(11)
STRENGTH = {
    "*": TIMES, "/": TIMES, "//": TIMES, "%": TIMES, "+": PLUS, "-": PLUS, "<<": SHIFT, ">>": SHIFT,
    "&": SHIFT, "|": SHIFT, "^": SHIFT, "**": POWER,
}  # fmt: skip


class TranslationError(Exception):
    """What a language has no words for yet: the module and what it is."""


def make_camel_case(name: str) -> str:
    """Return `some_name` as `someName`; a leading underscore is left out."""
    first, *rest = name.strip("_").split("_")
    return first + "".join(w[:1].upper() + w[1:] for w in rest)


def make_pascal_case(name: str) -> str:
    """Return `some_name` as `SomeName`."""
    return "".join(w[:1].upper() + w[1:] for w in name.strip("_").split("_"))


class Printer:
    """Prints a module in one language. Subclasses say how each piece of tree is written.

    How each `Builtin` is written is given in `languages.toml`.
    """

    STEP = "  "
    WIDTH = 120
    COMMENT = "//"
    LANGUAGE = ""
    LOGIC: ClassVar[Mapping[str, str]] = {"and": "&&", "or": "||", "not": "!"}

    def __init__(
        self, module: x.Module, known: Callable[[str], str], record_of: Callable[[x.Type], x.RecordClass],
        constant_of: Callable[[x.Global], x.Expression],
    ) -> None:  # fmt: skip
        """known: the word of a module's file. record_of: a translated record by its type. constant_of: what a
        module's constant is.
        """
        self.module, self.known = module, known
        self.record_of, self.constant_of = record_of, constant_of
        spoken = tomllib.loads(LANGUAGES.read_text(encoding="utf-8"))[self.LANGUAGE]
        self.keywords = frozenset(spoken["keywords"].split())
        self.operations: Mapping[str, str] = spoken["operations"]
        self.out: list[str] = []
        self.depth = 0
        self.used: dict[str, set[str]] = {}  # modules and what of them is named here
        self.helpers: set[str] = set()

    # --- lines

    def line(self, document: Document = "", beside: str = "") -> None:
        text = f"  {self.COMMENT} {beside}" if beside else ""
        indent = self.STEP * self.depth
        if not put_on_one_line(document) and not text:
            self.out.append("")
            return
        made = break_lines(document, self.depth, self.STEP, self.WIDTH, len(indent.expandtabs(4)))
        if (
            len(put_on_one_line(document)) + len(text) + len(indent.expandtabs(4)) > self.WIDTH
            and text
            and len(made) == 1
        ):
            self.out.append(indent + f"{self.COMMENT} {beside}")
            text = ""
        self.out += [indent + made[0], *made[1:]]
        self.out[-1] += text.replace("  ", " ", 1) if self.COMMENT == "//" else text

    def comments(self, texts: Iterable[str]) -> None:
        for text in texts:
            self.line(f"{self.COMMENT} {text}")

    def wrapped(self, text: str, lead: str, less: int = 0) -> list[str]:
        width = self.WIDTH - len((self.STEP * self.depth).expandtabs(4)) - len(lead) - less
        out: list[str] = []
        for n, paragraph in enumerate(text.split("\n\n")):
            out += [lead.rstrip()] if n else []
            out += [lead + one for one in textwrap.wrap(paragraph, width, break_on_hyphens=False)]
        return out

    def block(self, body: Sequence[x.Statement]) -> None:
        self.depth += 1
        for one in body:
            self.statement(one)
        self.depth -= 1

    # --- names

    def word(self, name: str) -> str:
        return name + "_" if name in self.keywords else name

    def source(self) -> str:
        path = PurePosixPath(*self.module.name.split("."))
        return f"Translated from {path}.py; change that, and translate anew."

    # --- expressions

    def strong(self, node: x.Expression, least: int) -> Document:
        """Return an expression, in brackets where it binds less than it must."""
        text, strength = self.expression(node)
        return text if strength <= least else ("(", text, ")")

    def plain(self, node: x.Expression) -> Document:
        return self.expression(node)[0]

    def expression(self, node: x.Expression) -> tuple[Document, int]:
        """Return an expression and how strongly it binds."""
        match node:
            case x.Logic():
                level = AND if node.operator == "and" else OR
                word = self.LOGIC[node.operator]
                parts = [self.strong(p, NOT if isinstance(p, x.Logic) else level) for p in node.parts]
                joined: list[Document] = [parts[0]]
                for part in parts[1:]:
                    joined += [LineBreak(" "), f"{word} ", part]
                return Group(Nest(tuple(joined))), level
            case x.Negated(operator="not"):
                inner = node.of
                if isinstance(inner, x.Builtin) and f"not {inner.name}" in self.operations:
                    return self.operation(x.Builtin(x.BOOL, f"not {inner.name}", inner.arguments))
                return (self.LOGIC["not"], self.strong(inner, UNARY)), UNARY
            case x.Negated():
                return (node.operator, self.strong(node.of, UNARY)), UNARY
            case x.Binary():
                own = f"{node.operator}:{node.left.type.bare.kind}"
                if own in self.operations or node.operator in self.operations:
                    return self.operation(x.Builtin(node.type, node.operator, (node.left, node.right)))
                return self.binary(node)
            case x.Builtin():
                return self.operation(node)
        raise TranslationError(f"{self.module.name}: {type(node).__name__}")

    def binary(self, node: x.Binary) -> tuple[Document, int]:
        level = STRENGTH[node.operator]
        right = level - 1  # numbers with fractions: a + (b + c) is not (a + b) + c
        left = level - 1 if level == SHIFT else level
        parts = (
            self.strong(node.left, left),
            LineBreak(" "),
            f"{node.operator} ",
            self.strong(node.right, right),
        )
        return Group(Nest(parts)), level

    def operation(self, node: x.Builtin) -> tuple[Document, int]:
        """Return a builtin by its pattern: `{0}` stands for the first argument, `{0!}` for it in brackets
        where it does not stand alone, `{*}` for all with commas, `{&}` for two and two of them, one in the
        other. What a kind of first argument has of its own ("len:map") comes first.
        """
        kind = f"{node.name}:{node.arguments[0].type.bare.kind}" if node.arguments else node.name
        pattern = self.operations.get(kind, self.operations.get(node.name))
        if pattern is None:
            raise TranslationError(
                f"{self.module.name}: '{node.name}' of {[a.type.kind for a in node.arguments]}"
            )
        self.helpers |= set(re.findall(r"\$(\w+)", pattern))
        level = ALONE
        pattern, _, binds = pattern.partition(" @")
        if binds:
            level = {"compare": COMPARE, "choice": CHOICE}[binds]
        parts: list[Document] = []
        for piece in re.split(r"(\{[^}]*\})", pattern):
            if piece == "{*}":
                parts.append(put_in_brackets("(", [self.plain(a) for a in node.arguments], ")"))
            elif piece == "{&}":
                parts = [self.paired(tuple(parts), node.arguments)]
            elif piece[:1] == "{":
                place = int(piece[1])
                parts.append(
                    self.strong(node.arguments[place], ALONE)
                    if "!" in piece
                    else self.plain(node.arguments[place])
                )
            elif piece:
                parts.append(self.helper(piece))
        return tuple(parts), level

    def paired(self, word: Document, arguments: Sequence[x.Expression]) -> Document:
        """Return calls of what takes two: `most(a, most(b, c))`."""
        out = self.plain(arguments[-1])
        for one in reversed(arguments[:-1]):
            out = (word, put_in_brackets("(", [self.plain(one), out], ")"))
        return out

    def helper(self, text: str) -> str:
        """Return a piece of a pattern with `$name` as this language calls its helpers."""
        return text.replace("$", "")

    def statement(self, node: x.Statement) -> None:
        raise NotImplementedError

    def text(self) -> str:
        """Return the whole module."""
        raise NotImplementedError
