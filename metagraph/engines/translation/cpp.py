"""Prints modules as C++17 headers: records as shared structures, functions in a namespace a module."""

from __future__ import annotations

import json
from collections.abc import Sequence

from metagraph.engines.translation import tree as x
from metagraph.engines.translation.braces import Braces
from metagraph.engines.translation.layout import Document, Group, LineBreak, Nest, put_in_brackets
from metagraph.engines.translation.lifting import lift_comprehensions
from metagraph.engines.translation.printing import (
    ALONE,
    CHOICE,
    COMPARE,
    NOT,
    PLUS,
    UNARY,
    TranslationError,
)

PLAIN = {
    "int": "int",
    "bits": "std::uint32_t",
    "float": "double",
    "bool": "bool",
    "str": "std::string",
    "none": "void",
}
SMALL = ("int", "bits", "float", "bool")
CHANGING = ("list_append", "list_extend", "list_insert", "list_pop", "set_add")


NATIVE = {  # records that are not translated: their headers
    "Project": "project", "MetaGraph": "project", "Life": "life", "Manner": "life", "Spot": "spots",
    "Voices": "voice",
}  # fmt: skip


class Cpp(Braces):
    """One module, `name.hpp`. Records are given by `Ref`, which may be nothing."""

    STEP = "    "
    WIDTH = 120
    LANGUAGE = "cpp"
    THROW = ("lang::fail(", ")")  # exceptions may be off
    serial = 0  # of values taken apart in a function

    def text(self) -> str:
        self.native: set[str] = set()
        records = [p for p in self.module.parts if isinstance(p, x.RecordClass)]
        constants = [p for p in self.module.parts if isinstance(p, x.Constant)]
        functions = [p for p in self.module.parts if isinstance(p, x.Function)]
        for record in records:
            self.line(f"struct {record.name};")
        if constants or functions:
            self.out.append("")
            self.line(f"namespace {self.space(self.module.name)} {{")
            self.out.append("")
            for constant in constants:
                self.constant(constant)
            for function in functions:
                self.line((*self.signature(function), ";"))
            self.out.append("")
            self.line(f"}}  // namespace {self.space(self.module.name)}")
        for record in records:
            self.record(record)
        for record in records:
            for method in record.methods:
                self.out.append("")
                self.line((*self.signature(method, record, False, f"{record.name}::"), " {"))
                self.body(method)
        if functions:
            self.out.append("")
            self.line(f"namespace {self.space(self.module.name)} {{")
            for function in functions:
                self.out.append("")
                self.function(function)
            self.out.append("")
            self.line(f"}}  // namespace {self.space(self.module.name)}")
        body = self.out
        self.out = []
        for one in self.wrapped(self.module.about, "// "):
            self.line(one)
        self.line("//")
        self.line(f"// {self.source()}")
        self.line("#pragma once")
        self.out.append("")
        for module in sorted(m for m in self.used if m != self.module.name):
            self.line(f'#include "{self.known(module)}.hpp"')
        for name in sorted(self.native):
            self.line(f'#include "{name}.hpp"')
        self.line('#include "language.hpp"')
        return (
            "\n".join([*self.out, "", "namespace metagraph {", "", *body, "", "}  // namespace metagraph"])
            + "\n"
        )

    def space(self, module: str) -> str:
        """Return the namespace of a module's functions and constants."""
        return self.word(self.known(module))

    # --- declarations

    def constant(self, node: x.Constant) -> None:
        self.comments(node.comments)
        plain = isinstance(node.value, x.Value | x.Negated) and node.value.type.kind in SMALL
        lead = "inline constexpr" if plain else "inline const"
        kind = self.type(node.value.type)
        self.line((f"{lead} {kind} {self.word(node.name)} = ", self.plain(node.value), ";"), node.beside)

    def record(self, node: x.RecordClass) -> None:
        self.out.append("")
        self.documented(node.about)
        base = f" : std::enable_shared_from_this<{node.name}>" if self.tells_itself(node) else ""
        self.line(f"struct {node.name}{base} {{")
        self.depth += 1
        for f in node.fields:
            self.line(f"{self.type(f.type)} {self.word(f.name)};")
        self.out.append("")
        explicit = "explicit " if sum(f.default is None for f in node.fields) <= 1 else ""
        given = [self.parameter(f, "_") for f in node.fields]
        self.line((f"{explicit}{node.name}", put_in_brackets("(", given, ")")))
        values = [f"{self.word(f.name)}({self.moved(f)})" for f in node.fields]
        self.depth += 1
        self.line((": ", Group(Nest(_commas(values))), " {}"))
        self.depth -= 1
        for method in node.methods:
            self.out.append("")
            self.documented(method.about)
            self.line((*self.signature(method, node), ";"))
        self.depth -= 1
        self.line("};")

    def tells_itself(self, node: x.RecordClass) -> bool:
        """Whether a record gives itself to others, and not only its parts."""
        every = [one for method in node.methods for one in x.walk(method.body)]
        own = [one for one in every if isinstance(one, x.This)]
        parts = [
            one for one in every if isinstance(one, x.Member | x.Replaced) and isinstance(one.of, x.This)
        ]
        return len(own) > len(parts)

    def moved(self, node: x.Parameter) -> str:
        return f"{node.name}_" if node.type.bare.kind in SMALL else f"std::move({node.name}_)"

    def signature(
        self, node: x.Function, record: x.RecordClass | None = None, defaults: bool = True, of: str = ""
    ) -> tuple[Document, ...]:
        """of: the structure a method is defined outside of, "Name::"."""
        set_anew = {
            e.target.name
            for e in x.walk(node.body)
            if isinstance(e, x.Assign) and isinstance(e.target, x.Local)
        }
        changed = {
            e.arguments[0].name
            for e in x.walk(node.body)
            if isinstance(e, x.Builtin) and e.name in CHANGING and isinstance(e.arguments[0], x.Local)
        } | {
            e.target.of.name
            for e in x.walk(node.body)
            if isinstance(e, x.Assign) and isinstance(e.target, x.ItemOf) and isinstance(e.target.of, x.Local)
        }
        given = [
            self.parameter(
                p, "", "own" if p.name in set_anew else "changed" if p.name in changed else "", defaults
            )
            for p in node.parameters
        ]
        tail = " const" if record is not None and not record.changes else ""
        lead = "" if record is not None and not of else "inline "
        return (
            f"{lead}{self.type(node.returns)} {of}{self.word(node.name)}",
            put_in_brackets("(", given, ")"),
            tail,
        )

    def function(self, node: x.Function) -> None:
        self.comments(node.comments)
        self.documented(node.about)
        self.line((*self.signature(node, None, False), " {"))
        self.body(node)

    def body(self, node: x.Function) -> None:
        self.serial = 0
        node = lift_comprehensions(node)
        self.block(node.body)
        self.line("}")

    def parameter(self, node: x.Parameter, tail: str, use: str = "", defaults: bool = True) -> Document:
        """use: "own", it is given another value; "changed", its items are; "" neither."""
        kind = self.type(node.type)
        if not tail and node.type.kind not in SMALL:
            kind = {"own": kind, "changed": f"{kind}&", "": f"const {kind}&"}[use]
        name = f"{kind} {node.name}_" if tail else f"{kind} {self.word(node.name)}"
        if node.default is None or not defaults:
            return name
        return (f"{name} = ", self.plain(node.default))

    def documented(self, about: str) -> None:
        for one in self.wrapped(about, "/// ") if about else []:
            self.line(one)

    def type(self, kind: x.Type) -> str:
        match kind.kind:
            case "optional":
                inner = self.type(kind.bare)
                return inner if kind.bare.kind == "record" else f"std::optional<{inner}>"
            case "list":
                return f"List<{self.type(kind.of[0])}>"
            case "tuple":
                return "std::tuple<" + ", ".join(self.type(o) for o in kind.of) + ">"
            case "map":
                return f"Map<{self.type(kind.of[0])}, {self.type(kind.of[1])}>"
            case "set":
                return f"Set<{self.type(kind.of[0])}>"
            case "record":
                if kind.name in NATIVE:
                    self.native.add(NATIVE[kind.name])
                elif kind.module != self.module.name:
                    self.used.setdefault(kind.module, set()).add(kind.name)
                return f"Ref<{kind.name}>"
        if kind.kind in PLAIN:
            return PLAIN[kind.kind]
        raise TranslationError(f"{self.module.name}: a type that is not known")

    # --- statements

    def declaration(self, node: x.Declare) -> None:
        kind, name = self.type(node.variable.type), self.word(node.variable.name)
        value = node.value
        nothing = isinstance(value, x.Value) and value.value is None
        if value is None:
            self.line(f"{kind} {name}{{}};", node.beside)
        elif nothing or (isinstance(value, x.Gathered | x.Mapped) and not value.items):
            self.line(f"{kind} {name};", node.beside)
        else:
            self.line((f"{kind} {name} = ", self.plain(value), ";"), node.beside)

    def unpacked(self, node: x.Unpack) -> None:
        names = [self.plain(t) for t in node.targets]
        lead = (
            ("auto ", put_in_brackets("[", names, "]"))
            if node.new
            else ("std::tie", put_in_brackets("(", names, ")"))
        )
        self.line((*lead, " = ", self.plain(node.value), ";"), node.beside)

    def each(self, node: x.ForEach) -> None:
        words = [self.word(n.name) for n in node.names]
        over = node.over
        name = over.name if isinstance(over, x.Builtin) else ""
        given = over.arguments if isinstance(over, x.Builtin) else ()
        if name == "range":
            ends = [self.plain(a) for a in given]
            first, last = ("0", ends[0]) if len(ends) == 1 else ends[:2]
            head: Document = (f"for (int {words[0]} = ", first, f"; {words[0]} < ", last, f"; {words[0]}++)")
            self.braced(head, node.body, node.beside)
            return
        if name in ("enumerate", "zip"):
            place = words[0] if name == "enumerate" else "n" if "n" not in words else "place"
            lists = given if name == "zip" else given[:1]
            taken = words if name == "zip" else words[1:]
            head = (f"for (int {place} = 0; {place} < lang::len(", self.plain(lists[0]), f"); {place}++)")
            first_lines: list[Document] = [
                (f"const auto& {word} = lang::at(", self.plain(of), f", {place});")
                for word, of in zip(taken, lists, strict=True)
            ]
            self.braced(head, node.body, node.beside, first_lines)
            return
        target = words[0] if len(words) == 1 else f"[{', '.join(words)}]"
        source: Document = self.plain(given[0]) if name == "map_items" else self.plain(over)
        if over.type.kind == "map" and name != "map_items":
            source = ("lang::keys(", source, ")")
        self.braced((f"for (const auto& {target} : ", source, ")"), node.body, node.beside)

    def target(self, node: x.Expression) -> Document:
        if isinstance(node, x.ItemOf) and node.of.type.bare.kind == "map":
            return (self.strong(node.of, ALONE), "[", self.plain(node.place), "]")
        return self.plain(node)

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
                self.type(node.type)
                given = put_in_brackets("(", [self.plain(a) for a in node.arguments], ")")
                return (f"lang::made<{node.type.name}>", given), ALONE
            case x.Replaced():
                return self.replaced(node), ALONE
            case x.Comparison():
                return self.compared(node)
            case x.Either():
                test, kind = self.strong(node.test, NOT), node.type
                then, other = self.branch(node.then, kind), self.branch(node.other, kind)
                return Group(Nest((test, LineBreak(" "), "? ", then, LineBreak(" "), ": ", other))), CHOICE
            case x.ItemOf():
                return self.item(node), ALONE
            case x.Slice():
                ends = ["0" if node.first is None else self.plain(node.first)]
                ends += [] if node.last is None else [self.plain(node.last)]
                return ("lang::part", put_in_brackets("(", [self.plain(node.of), *ends], ")")), ALONE
            case x.Gathered():
                return self.gathered(node), ALONE
            case x.Mapped():
                pairs: list[Document] = [
                    ("{", self.plain(k), ", ", self.plain(v), "}") for k, v in node.items
                ]
                return (self.type(node.type), put_in_brackets("{", pairs, "}")), ALONE
            case x.Formatted():
                return ("lang::text", put_in_brackets("(", [self.piece(p) for p in node.parts], ")")), ALONE
        return super().expression(node)

    def named(self, node: x.Named) -> tuple[Document, int]:
        match node:
            case x.Value():
                return self.literal(node), ALONE if not str(node.value).startswith("-") else UNARY
            case x.Local():
                return self.word(node.name), ALONE
            case x.Global():
                return self.reached(node.module, node.name), ALONE
            case x.This():
                return "lang::self(this)", ALONE
            case x.KnownValue():
                if node.type.kind == "record":
                    return self.expression(node.of)
                return ("*", self.strong(node.of, ALONE)), UNARY
            case x.Member():
                call = "()" if node.computed else ""
                if isinstance(node.of, x.This):
                    return f"this->{self.word(node.name)}{call}", ALONE
                return (self.strong(node.of, ALONE), f"->{self.word(node.name)}{call}"), ALONE

    def reached(self, module: str, name: str) -> str:
        if module == self.module.name:
            return f"{self.space(module)}::{self.word(name)}"
        self.used.setdefault(module, set()).add(name)
        return f"{self.space(module)}::{self.word(name)}"

    def branch(self, node: x.Expression, kind: x.Type) -> Document:
        """Both sides of a choice must be of one type."""
        found = self.strong(node, CHOICE)
        if kind.kind == "optional" and kind.bare.kind != "record" and node.type.kind != "optional":
            return (f"{self.type(kind)}(", found, ")")
        if node.type.kind == "str" and isinstance(node, x.Value):
            return ("std::string(", found, ")")
        return found

    def piece(self, part: str | tuple[x.Expression, str]) -> Document:
        if isinstance(part, str):
            return json.dumps(part, ensure_ascii=False)
        if part[1]:
            return ("lang::fixed(", self.plain(part[0]), f", {part[1].strip('.f')})")
        return self.plain(part[0])

    def literal(self, node: x.Value) -> str:
        value = node.value
        if value is None:
            return "nullptr" if node.type.bare.kind in ("record", "none") else "std::nullopt"
        if isinstance(value, bool | str):
            return json.dumps(value, ensure_ascii=False)
        if isinstance(value, float) and value in (float("inf"), float("-inf")):
            return "INFINITY" if value > 0 else "-INFINITY"
        return repr(float(str(value))) if node.type == x.FLOAT else repr(value)

    def compared(self, node: x.Comparison) -> tuple[Document, int]:
        left, right = node.left, node.right
        kind = left.type.bare.kind
        if node.operator in ("is", "is not"):
            if not isinstance(right, x.Value):  # the same record, not one alike
                word = "==" if node.operator == "is" else "!="
                return (self.strong(left, PLUS), f" {word} ", self.strong(right, PLUS)), COMPARE
            if left.type.bare.kind == "record":
                return (
                    self.strong(left, PLUS),
                    " == nullptr" if node.operator == "is" else " != nullptr",
                ), COMPARE
            there = (self.strong(left, ALONE), ".has_value()")
            return (there, ALONE) if node.operator == "is not" else (("!", there), UNARY)
        if kind in ("list", "tuple", "map", "set", "record") and node.operator in ("==", "!="):
            raise TranslationError(
                f"{self.module.name}: whether two {kind}s are equal; compare what tells them apart"
            )
        parts = self.strong(left, PLUS), LineBreak(" "), f"{node.operator} ", self.strong(right, PLUS)
        return Group(Nest(parts)), COMPARE

    def item(self, node: x.ItemOf) -> Document:
        kind = node.of.type.bare.kind
        if kind == "tuple":
            assert isinstance(node.place, x.Value)
            return (f"std::get<{node.place.value}>(", self.plain(node.of), ")")
        if kind == "map":
            return (self.strong(node.of, ALONE), ".at(", self.plain(node.place), ")")
        return ("lang::at(", self.plain(node.of), ", ", self.plain(node.place), ")")

    def replaced(self, node: x.Replaced) -> Document:
        """The record made again, with all its fields."""
        changes = dict(node.changes)
        of: Document = "this" if isinstance(node.of, x.This) else self.strong(node.of, ALONE)
        given: list[Document] = [
            self.plain(changes[f.name]) if f.name in changes else (of, f"->{self.word(f.name)}")
            for f in self.record_of(node.type).fields
        ]
        return (f"lang::made<{node.type.name}>", put_in_brackets("(", given, ")"))

    def gathered(self, node: x.Gathered) -> Document:
        kind = self.type(node.type)
        if not node.spread:
            return (kind, put_in_brackets("{", [self.plain(i) for i in node.items], "}"))
        parts: list[Document] = [
            self.plain(item) if n in node.spread else (f"{kind}{{", self.plain(item), "}")
            for n, item in enumerate(node.items)
        ]
        return ("lang::together", put_in_brackets("(", parts, ")"))


def _commas(parts: Sequence[str]) -> Document:
    out: list[Document] = []
    for n, part in enumerate(parts):
        out += [part] if n == 0 else [",", LineBreak(" "), part]
    return tuple(out)
