"""A Python module as mypy has understood it, with its comments."""

from __future__ import annotations

import io
import tokenize
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from mypy import nodes as m
from mypy import types as t


class SubsetError(Exception):
    """What cannot be translated: file, line, cause, remedy."""


@dataclass
class SourceModule:
    """A Python module as mypy has it. only: the parts that are meant, all where empty.
    without: methods that are not. alone:
    comments by their line, those that have it for themselves; beside: those at the end of one.
    """

    tree: m.MypyFile
    types: dict[m.Expression, t.Type]
    path: Path
    only: tuple[str, ...] = ()
    without: tuple[str, ...] = ()
    alone: dict[int, str] = field(default_factory=dict)
    beside: dict[int, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        text = self.path.read_text(encoding="utf-8")
        for token in tokenize.generate_tokens(io.StringIO(text).readline):
            if token.type != tokenize.COMMENT:
                continue
            words = token.string.lstrip("# ").rstrip()
            if words.startswith(("fmt:", "type:", "noqa")):
                continue
            place = self.beside if token.line[: token.start[1]].strip() else self.alone
            place[token.start[0]] = words


def unwrap_docstring(body: Sequence[m.Statement]) -> str:
    """Return a docstring in one paragraph a line."""
    if not body or not isinstance(body[0], m.ExpressionStmt) or not isinstance(body[0].expr, m.StrExpr):
        return ""
    paragraphs = body[0].expr.value.strip().split("\n\n")
    return "\n\n".join(" ".join(p.split()) for p in paragraphs)


def list_defined(node: m.Statement) -> list[str]:
    """Return the names that a piece of a module makes."""
    if isinstance(node, m.FuncDef | m.ClassDef):
        return [node.name]
    targets = node.lvalues if isinstance(node, m.AssignmentStmt) else []
    return [one.name for one in targets if isinstance(one, m.NameExpr)]


def join_full_name(node: m.Expression) -> str:
    full = node.fullname if isinstance(node, m.RefExpr) else ""
    return full.replace("_bisect.", "bisect.") if full else ""
