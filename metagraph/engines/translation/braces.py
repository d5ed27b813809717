"""What languages with braces have in common: how statements and blocks are written."""

from __future__ import annotations

from collections.abc import Sequence

from metagraph.engines.translation import tree as x
from metagraph.engines.translation.layout import Document
from metagraph.engines.translation.printing import Printer


class Braces(Printer):
    """Statements end with semicolons, blocks stand in braces.

    OWN_LINE: whether an opening brace has a line of its own. THROW: what an error is raised with, its message
    between.
    """

    OWN_LINE = False
    THROW = ("throw ", "")

    def opened(self, head: Document, beside: str = "") -> None:
        """Begin a block."""
        if self.OWN_LINE:
            self.line(head, beside)
            self.line("{")
        else:
            self.line((head, " {"), beside)

    def braced(
        self, head: Document, body: Sequence[x.Statement], beside: str = "", first: Sequence[Document] = ()
    ) -> None:
        """Write a block with what it is of. first: lines it begins with."""
        self.opened(head, beside)
        self.depth += 1
        for one in first:
            self.line(one)
        self.depth -= 1
        self.block(body)
        self.line("}")

    def statement(self, node: x.Statement) -> None:
        self.comments(node.comments)
        beside = node.beside
        match node:
            case x.Declare():
                self.declaration(node)
            case x.Assign():
                self.assignment(node)
            case x.Unpack():
                self.unpacked(node)
            case x.Do():
                self.line((self.plain(node.value), ";"), beside)
            case x.Return():
                self.line(
                    ("return", "" if node.value is None else (" ", self.plain(node.value)), ";"), beside
                )
            case x.Raise():
                self.line((self.THROW[0], self.plain(node.message), self.THROW[1], ";"), beside)
            case x.Leave():
                self.line(f"{node.word};", beside)
            case x.If():
                self.conditional(node, "if ")
            case x.While():
                self.braced(("while (", self.plain(node.test), ")"), node.body, beside)
            case x.ForEach():
                self.each(node)

    def conditional(self, node: x.If, lead: str) -> None:
        """Write `if`, `else if` and `else`."""
        self.opened((lead, "(", self.plain(node.test), ")"), node.beside)
        self.block(node.then)
        other = node.other
        between = "" if self.OWN_LINE else "} "
        if self.OWN_LINE:
            self.line("}")
        if len(other) == 1 and isinstance(other[0], x.If) and not other[0].comments:
            self.conditional(other[0], f"{between}else if ")
            return
        if other:
            self.opened(f"{between}else")
            self.block(other)
        if other or not self.OWN_LINE:
            self.line("}")

    def assignment(self, node: x.Assign) -> None:
        self.line((self.target(node.target), f" {node.operator}= ", self.plain(node.value), ";"), node.beside)

    def target(self, node: x.Expression) -> Document:
        """Return what is assigned to."""
        return self.plain(node)

    def declaration(self, node: x.Declare) -> None:
        raise NotImplementedError

    def unpacked(self, node: x.Unpack) -> None:
        raise NotImplementedError

    def each(self, node: x.ForEach) -> None:
        raise NotImplementedError
