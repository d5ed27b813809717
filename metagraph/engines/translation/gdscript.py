"""Prints modules as GDScript that Godot 3 and 4 both read: no types, no lambdas, records as inner classes."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import ClassVar

from metagraph.engines.translation import tree as x
from metagraph.engines.translation.layout import (
    Document,
    Group,
    LineBreak,
    Nest,
    put_in_brackets,
    put_on_one_line,
)
from metagraph.engines.translation.lifting import lift_comprehensions
from metagraph.engines.translation.printing import (
    ALONE,
    CHOICE,
    COMPARE,
    NOT,
    PLUS,
    UNARY,
    Printer,
    TranslationError,
    make_pascal_case,
)  # fmt: skip


class GDScript(Printer):
    """One module, `name.gd`: static functions, constants, and a class inside it for each record."""

    STEP = "\t"
    WIDTH = 130
    COMMENT = "#"
    LOGIC: ClassVar[Mapping[str, str]] = {"and": "and", "or": "or", "not": "not "}
    LANGUAGE = "gdscript"

    serial = 0  # of values taken apart in a function
    in_record = False

    def text(self) -> str:
        for part in self.module.parts:
            if isinstance(part, x.Constant):
                self.constant(part)
            elif isinstance(part, x.RecordClass):
                self.record(part)
            else:
                self.out += ["", ""]
                self.function(part)
        body = self.out
        self.out = []
        self.documented(self.module.about)
        self.line("#")
        self.line(f"# {self.source()}")
        self.out.append("")
        modules = [m for m in self.used if m != self.module.name]
        for module in sorted(modules):
            self.line(f'const {make_pascal_case(self.known(module))} = preload("{self.known(module)}.gd")')
        if any(h == "Util" for h in self.helpers):
            self.line('const Util = preload("util.gd")')
        return "\n".join([*self.out, *body]).strip() + "\n"

    # --- declarations

    def constant(self, node: x.Constant) -> None:
        self.comments(node.comments)
        if self.made(node.value):  # an instance is no constant here
            self.out += ["", ""]
            self.line(f"static func {self.word(node.name)}():", node.beside)
            self.depth += 1
            self.line(("return ", self.plain(node.value)))
            self.depth -= 1
            return
        self.line((f"const {node.name} = ", self.plain(node.value)), node.beside)

    def made(self, node: x.Expression) -> bool:
        return any(isinstance(n, x.New) for n in x.walk(node))

    def record(self, node: x.RecordClass) -> None:
        self.out += ["", ""]
        self.documented(node.about)
        self.line(f"class {node.name}:")
        self.depth += 1
        computed = [m for m in node.methods if m.property and not node.changes]
        for f in node.fields:
            self.line(f"var {self.word(f.name)}")
        for m in computed:
            self.line(f"var {self.word(m.name)}", m.about)
        self.out.append("")
        given = [self.parameter(f, "_") for f in node.fields]
        self.line(("func _init", put_in_brackets("(", given, ")"), ":"))
        self.depth += 1
        for f in node.fields:
            name = f"{f.name}_"
            late = f.default is not None and not isinstance(f.default, x.Value | x.Negated | x.Global)
            value: Document = (
                (f"{name} if {name} != null else ", self.plain(f.default)) if late and f.default else name
            )
            self.line((f"self.{self.word(f.name)} = ", value))
        for m in computed:
            (back,) = m.body
            assert isinstance(back, x.Return) and back.value is not None
            self.line((f"self.{self.word(m.name)} = ", self.plain(back.value)))
        self.depth -= 1
        self.in_record = True
        for m in node.methods:
            if m not in computed:
                self.out.append("")
                self.function(m, "func ")
        self.in_record = False
        self.depth -= 1

    def function(self, node: x.Function, lead: str = "static func ") -> None:
        node = lift_comprehensions(node)
        self.serial = 0
        self.comments(node.comments)
        self.documented(node.about)
        self.line(
            (
                f"{lead}{self.word(node.name)}",
                put_in_brackets("(", [self.parameter(p) for p in node.parameters], ")"),
                ":",
            )
        )
        self.depth += 1
        for p in node.parameters:
            if p.default is not None and self.late(p.default):
                self.line(f"if {self.word(p.name)} == null:")
                self.depth += 1
                self.line((f"{self.word(p.name)} = ", self.plain(p.default)))
                self.depth -= 1
        self.depth -= 1
        self.block(node.body)
        if not node.body:
            self.depth += 1
            self.line("pass")
            self.depth -= 1

    def late(self, default: x.Expression) -> bool:
        if isinstance(default, x.Global):
            return self.made(self.constant_of(default))
        return not isinstance(default, x.Value | x.Negated)

    def parameter(self, node: x.Parameter, tail: str = "") -> Document:
        name = f"{node.name}{tail}" if tail else self.word(node.name)
        if node.default is None:
            return name
        return f"{name} = null" if self.late(node.default) else (f"{name} = ", self.plain(node.default))

    def documented(self, about: str) -> None:
        for one in self.wrapped(about, "# ") if about else []:
            self.line(one)

    # --- statements

    def statement(self, node: x.Statement) -> None:
        self.comments(node.comments)
        beside = node.beside
        match node:
            case x.Declare():
                value: Document = "" if node.value is None else (" = ", self.held(node.value))
                self.line((f"var {self.word(node.variable.name)}", value), beside)
            case x.Assign():
                self.line((self.plain(node.target), f" {node.operator}= ", self.held(node.value)), beside)
            case x.Unpack():
                self.serial += 1
                name = "both" if self.serial == 1 else f"both{self.serial}"
                self.line((f"var {name} = ", self.plain(node.value)), beside)
                for n, target in enumerate(node.targets):
                    self.line(("var " if node.new else "", self.plain(target), f" = {name}[{n}]"))
            case x.Do():
                self.line(self.plain(node.value), beside)
            case x.Return():
                self.line(("return", "" if node.value is None else (" ", self.held(node.value))), beside)
            case x.Raise():
                self.line(("push_error(", self.plain(node.message), ")"), beside)
                self.line("return null")
            case x.Leave():
                self.line(node.word, beside)
            case x.If():
                self.conditional(node, "if ")
            case x.While():
                self.line(("while ", self.within(node.test), ":"), beside)
                self.body(node.body)
            case x.ForEach():
                self.each(node)

    def within(self, test: x.Expression) -> Document:
        """A test, in brackets where it must be broken over lines."""
        found = self.plain(test)
        room = self.WIDTH - 4 * self.depth - 12
        return found if len(put_on_one_line(found)) <= room else ("(", found, ")")

    def held(self, value: x.Expression) -> Document:
        """A value, in brackets where it must be broken over lines and has none of its own."""
        broken = isinstance(value, x.Logic | x.Comparison | x.Binary)
        return self.within(value) if broken else self.plain(value)

    def body(self, body: tuple[x.Statement, ...]) -> None:
        self.block(body)
        if not body:
            self.depth += 1
            self.line("pass")
            self.depth -= 1

    def conditional(self, node: x.If, lead: str) -> None:
        self.line((lead, self.within(node.test), ":"), node.beside)
        self.body(node.then)
        if len(node.other) == 1 and isinstance(node.other[0], x.If) and not node.other[0].comments:
            self.conditional(node.other[0], "elif ")
        elif node.other:
            self.line("else:")
            self.body(node.other)

    def each(self, node: x.ForEach) -> None:
        words = [self.word(n.name) for n in node.names]
        over = node.over
        if isinstance(over, x.Builtin) and over.name == "map_items":
            key, value = words
            of = self.strong(over.arguments[0], ALONE)
            self.line((f"for {key} in ", self.plain(over.arguments[0]), ":"), node.beside)
            self.depth += 1
            self.line((f"var {value} = ", of, f"[{key}]"))
            self.depth -= 1
        elif isinstance(over, x.Builtin) and over.name == "enumerate":
            place, one = words
            of = self.strong(over.arguments[0], ALONE)
            self.line((f"for {place} in range(", of, ".size()):"), node.beside)
            self.depth += 1
            self.line((f"var {one} = ", of, f"[{place}]"))
            self.depth -= 1
        elif isinstance(over, x.Builtin) and over.name == "zip":
            first, second = (self.strong(a, ALONE) for a in over.arguments)
            place = "n" if "n" not in words else "place"
            self.line((f"for {place} in range(", first, ".size()):"), node.beside)
            self.depth += 1
            self.line((f"var {words[0]} = ", first, f"[{place}]"))
            self.line((f"var {words[1]} = ", second, f"[{place}]"))
            self.depth -= 1
        elif len(words) == 1:
            self.line((f"for {words[0]} in ", self.plain(over), ":"), node.beside)
        else:
            one = "pair" if "pair" not in words else "item"
            self.line((f"for {one} in ", self.plain(over), ":"), node.beside)
            self.depth += 1
            for n, word in enumerate(words):
                if word != "_":
                    self.line(f"var {word} = {one}[{n}]")
            self.depth -= 1
        self.body(node.body)

    # --- expressions

    def expression(self, node: x.Expression) -> tuple[Document, int]:
        if isinstance(node, x.Named):
            return self.named(node)
        match node:
            case x.Call():
                return (
                    self.strong(node.function, ALONE),
                    put_in_brackets("(", [self.plain(a) for a in node.arguments], ")"),
                ), ALONE
            case x.New():
                return (
                    self.class_of(node.type),
                    ".new",
                    put_in_brackets("(", [self.plain(a) for a in node.arguments], ")"),
                ), ALONE
            case x.Replaced():
                changes = dict(node.changes)
                of = self.strong(node.of, ALONE)
                given: list[Document] = [
                    self.plain(changes[f.name]) if f.name in changes else (of, f".{self.word(f.name)}")
                    for f in self.record_of(node.type).fields
                ]
                return (self.class_of(node.type), ".new", put_in_brackets("(", given, ")")), ALONE
            case x.Comparison():
                word = {"is": "==", "is not": "!="}.get(node.operator, node.operator)
                if node.left.type.bare.kind in ("list", "tuple", "map", "record") and node.operator in (
                    "==",
                    "!=",
                ):
                    raise TranslationError(
                        f"{self.module.name}: whether two {node.left.type.kind}s are equal"
                    )
                parts = (
                    self.strong(node.left, PLUS),
                    LineBreak(" "),
                    f"{word} ",
                    self.strong(node.right, PLUS),
                )
                return Group(Nest(parts)), COMPARE
            case x.Either():
                test, then = self.strong(node.test, NOT), self.strong(node.then, NOT)
                return (then, " if ", test, " else ", self.strong(node.other, NOT)), CHOICE
            case x.ItemOf():
                return (self.strong(node.of, ALONE), "[", self.plain(node.place), "]"), ALONE
            case x.Slice():
                self.helpers.add("Util")
                of = self.plain(node.of)
                first = "0" if node.first is None else self.plain(node.first)
                last: Document = (
                    (self.strong(node.of, ALONE), ".size()") if node.last is None else self.plain(node.last)
                )
                return ("Util.part", put_in_brackets("(", [of, first, last], ")")), ALONE
            case x.Gathered():
                return self.gathered(node)
            case x.Mapped():
                pairs: list[Document] = [(self.plain(k), ": ", self.plain(v)) for k, v in node.items]
                return put_in_brackets("{", pairs, "}"), ALONE
            case x.Formatted():
                return self.formatted(node), PLUS
        return super().expression(node)

    def named(self, node: x.Named) -> tuple[Document, int]:
        match node:
            case x.Value():
                return self.literal(node), ALONE if not str(node.value).startswith("-") else UNARY
            case x.Local():
                return self.word(node.name), ALONE
            case x.Global():
                return self.reached(node), ALONE
            case x.This():
                return "self", ALONE
            case x.KnownValue():
                return self.expression(node.of)
            case x.Member():
                # A value's properties are worked out when it is made; those of what changes are functions.
                call = "()" if node.computed and self.record_of(node.of.type.bare).changes else ""
                return (self.strong(node.of, ALONE), f".{self.word(node.name)}{call}"), ALONE

    def reached(self, node: x.Global) -> str:
        name = self.word(node.name)
        if node.type.kind != "function" and self.made(self.constant_of(node)):
            name += "()"
        if node.module == self.module.name:
            if self.in_record and node.type.kind == "function":
                raise TranslationError(
                    f"{node.module}: a method calls '{node.name}' of its own module, which GDScript "
                    "cannot reach from a class; move it to another module"
                )
            return name
        self.used.setdefault(node.module, set()).add(node.name)
        return f"{make_pascal_case(self.known(node.module))}.{name}"

    def class_of(self, kind: x.Type) -> str:
        if kind.module == self.module.name:
            return kind.name
        self.used.setdefault(kind.module, set()).add(kind.name)
        return f"{make_pascal_case(self.known(kind.module))}.{kind.name}"

    def gathered(self, node: x.Gathered) -> tuple[Document, int]:
        if node.type.kind == "set":
            return put_in_brackets("{", [(self.plain(i), ": true") for i in node.items], "}"), ALONE
        if not node.spread:
            return put_in_brackets("[", [self.plain(i) for i in node.items], "]"), ALONE
        parts: list[Document] = []
        for n, item in enumerate(node.items):
            one: Document = self.strong(item, PLUS) if n in node.spread else ("[", self.plain(item), "]")
            parts += [one] if n == 0 else [" + ", one]
        return tuple(parts), PLUS

    def literal(self, node: x.Value) -> str:
        value = node.value
        if value is None or isinstance(value, bool | str):
            return json.dumps(value, ensure_ascii=False)
        if isinstance(value, float) and value in (float("inf"), float("-inf")):
            return "INF" if value > 0 else "-INF"
        return repr(float(str(value))) if node.type == x.FLOAT else repr(value)

    def formatted(self, node: x.Formatted) -> Document:
        """A pattern and a list: "%s is at %.2f s" % [name, at]."""
        text, given = "", []
        for part in node.parts:
            if isinstance(part, str):
                text += part.replace("%", "%%")
            else:
                exact = part[1] == ".3f"  # what keys a draw: engines differ in how they round halves
                usual = {"str": "%s", "int": "%d"}.get(part[0].type.kind, "%")
                text += "%s" if exact else usual if not part[1] else f"%{part[1]}"
                if exact:
                    self.helpers.add("Util")
                given.append(
                    ("Util.thousandths(", self.plain(part[0]), ")") if exact else self.plain(part[0])
                )
        pattern = json.dumps(text, ensure_ascii=False)
        return (pattern, " % ", put_in_brackets("[", given, "]"))
