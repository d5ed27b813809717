"""Prints modules as JavaScript (ES 2020 modules with JSDoc)."""

from __future__ import annotations

import json

from metagraph.engines.translation import tree as x
from metagraph.engines.translation.braces import Braces
from metagraph.engines.translation.layout import Document, Group, LineBreak, Nest, put_in_brackets
from metagraph.engines.translation.printing import (
    ALONE,
    CHOICE,
    COMPARE,
    NOT,
    PLUS,
    UNARY,
    TranslationError,
    make_camel_case,
)  # fmt: skip


class JavaScript(Braces):
    """One module, `name.js`."""

    STEP = "  "
    WIDTH = 125
    LANGUAGE = "javascript"
    THROW = ("throw new Error(", ")")

    def text(self) -> str:
        for part in self.module.parts:
            if isinstance(part, x.Constant):
                self.constant(part)
            elif isinstance(part, x.RecordClass):
                self.record(part)
            else:
                self.out.append("")
                self.function(part)
        body = self.out
        self.out = []
        about = [f" * {line}".rstrip() for line in self.wrapped(self.module.about, "", 3)]
        self.out += ["/**", *about, " *", f" * {self.source()}", " */", ""]
        here = self.known(self.module.name)
        for module, names in sorted(self.used.items()):
            if self.known(module) != here:
                self.line(
                    (
                        "import ",
                        put_in_brackets("{", sorted(names), "}", ","),
                        f' from "./{self.known(module)}.js";',
                    )
                )
        if self.helpers:
            helpers = sorted(self.helpers)
            self.line(("import ", put_in_brackets("{", helpers, "}", ","), ' from "./basics.js";'))
        head = [o.replace("{", "{ ").replace("}", " }") if o.startswith("import {") else o for o in self.out]
        gap = [] if not body or body[0] == "" or not (self.used or self.helpers) else [""]
        return "\n".join([*head, *gap, *body]).strip() + "\n"

    # --- declarations

    def constant(self, node: x.Constant) -> None:
        self.comments(node.comments)
        export = "export " if node.public else ""
        self.line(
            (f"{export}const {self.constant_name(node.name)} = ", self.plain(node.value), ";"), node.beside
        )

    def record(self, node: x.RecordClass) -> None:
        self.out.append("")
        fields = "; ".join(f"{make_camel_case(f.name)}: {self.type(f.type)}" for f in node.fields)
        self.documented(f"{node.about}\n\n{fields}.")
        self.line(f"export class {node.name} {{")
        self.depth += 1
        given = [self.parameter(f) for f in node.fields]
        self.line(("constructor", put_in_brackets("(", given, ")", ","), " {"))
        self.depth += 1
        for f in node.fields:
            self.line(f"this.{make_camel_case(f.name)} = {self.word(make_camel_case(f.name))};")
        self.depth -= 1
        self.line("}")
        for method in node.methods:
            self.out.append("")
            self.method(method)
        self.depth -= 1
        self.line("}")

    def method(self, node: x.Function) -> None:
        self.documented(node.about)
        given = put_in_brackets("(", [self.parameter(p) for p in node.parameters], ")", ",")
        self.line((("get " if node.property else "") + make_camel_case(node.name), given, " {"))
        self.block(node.body)
        self.line("}")

    def function(self, node: x.Function) -> None:
        self.comments(node.comments)
        types = [
            f"@param {{{self.documented_type(p)}}} {self.word(make_camel_case(p.name))}"
            for p in node.parameters
        ]
        back = [] if node.returns == x.NONE else [f"@returns {{{self.type(node.returns)}}}"]
        self.documented(node.about, [*types, *back])
        given: list[Document] = []
        for p in node.parameters:
            given.append(self.parameter(p))
        export = "export " if node.public else ""
        self.line(
            (f"{export}function {self.function_name(node.name)}", put_in_brackets("(", given, ")", ","), " {")
        )
        self.block(node.body)
        self.line("}")

    def parameter(self, node: x.Parameter) -> Document:
        name = self.word(make_camel_case(node.name))
        if node.rest:
            return f"...{name}"
        return name if node.default is None else (f"{name} = ", self.plain(node.default))

    def documented(self, about: str, tags: list[str] | None = None) -> None:
        found = self.wrapped(about, " * ") if about else []
        found += [one for tag in tags or [] for one in self.wrapped(tag, " * ")]
        if len(found) == 1:
            self.line(f"/** {found[0][3:]} */")
        elif found:
            self.line("/**")
            for one in found:
                self.line(one)
            self.line(" */")

    def documented_type(self, node: x.Parameter) -> str:
        return f"...{self.type(node.type.of[0])}" if node.rest else self.type(node.type)

    def type(self, kind: x.Type) -> str:
        """Return a type as JSDoc writes it."""
        match kind.kind:
            case "int" | "float" | "bits":
                return "number"
            case "str":
                return "string"
            case "bool":
                return "boolean"
            case "optional":
                return f"?{self.type(kind.bare)}"
            case "list":
                inner = self.type(kind.of[0]) if kind.of else "*"
                return f"({inner})[]" if inner[:1] in "?(" else f"{inner}[]"
            case "tuple":
                return "[" + ", ".join(self.type(o) for o in kind.of) + "]"
            case "map":
                return f"Map<{self.type(kind.of[0])}, {self.type(kind.of[1])}>"
            case "set":
                return f"Set<{self.type(kind.of[0])}>"
            case "record":
                return kind.name
        return "*"

    # --- statements

    def declaration(self, node: x.Declare) -> None:
        word = "let" if node.changes or node.value is None else "const"
        value: Document = "" if node.value is None else (" = ", self.plain(node.value))
        self.line((f"{word} {self.local(node.variable)}", value, ";"), node.beside)

    def assignment(self, node: x.Assign) -> None:
        item = node.target
        if isinstance(item, x.ItemOf) and item.of.type.bare.kind == "map":
            given = [self.plain(item.place), self.plain(node.value)]
            self.line((self.strong(item.of, ALONE), put_in_brackets(".set(", given, ")"), ";"), node.beside)
        else:
            super().assignment(node)

    def unpacked(self, node: x.Unpack) -> None:
        places = [(f"{n}: ", self.target(t)) for n, t in enumerate(node.targets) if self.target(t)]
        names, value = put_in_brackets("{ ", places, " }"), self.plain(node.value)
        if node.new:
            self.line(("let " if node.changes else "const ", names, " = ", value, ";"), node.beside)
        else:
            self.line(("(", names, " = ", value, ");"), node.beside)

    def taken(self, names: list[str]) -> str:
        """Return what takes the items of an array apart, by their places: `[a, b]` would make an object for
        each.
        """
        return "{ " + ", ".join(f"{n}: {name}" for n, name in enumerate(names) if name) + " }"

    def each(self, node: x.ForEach) -> None:
        words = [self.local(n) for n in node.names]
        name = words[0] if len(words) == 1 else self.taken(words)
        over, of = node.over, f"for (const {name} of "
        given = over.arguments if isinstance(over, x.Builtin) else ()
        match over:
            case x.Builtin(name="range"):
                ends = [self.plain(a) for a in given]
                first, last = ("0", ends[0]) if len(ends) == 1 else ends[:2]
                head: Document = (f"for (let {name} = ", first, f"; {name} < ", last, f"; {name}++)")
            case x.Builtin(name="enumerate"):
                head = (of, self.strong(given[0], ALONE), ".entries())")
            case x.Builtin(name="map_items"):
                head = (of, self.plain(given[0]), ")")
            case _ if over.type.kind == "map":
                head = (of, self.strong(over, ALONE), ".keys())")
            case _:
                head = (of, self.plain(over), ")")
        self.braced(head, node.body, node.beside)

    # --- expressions

    def local(self, node: x.Local) -> str:
        return self.word(make_camel_case(node.name))

    def function_name(self, name: str) -> str:
        """A module's own functions keep their underscore, so that variables may be called as they are."""
        return "_" * name.startswith("_") + self.word(make_camel_case(name))

    def constant_name(self, name: str) -> str:
        return name if name.isupper() or name.strip("_").isupper() else make_camel_case(name)

    def operation(self, node: x.Builtin) -> tuple[Document, int]:
        if node.name in ("any", "all", "first", "first_or") and isinstance(
            node.arguments[0], x.Comprehension
        ):
            return self.searched(node, node.arguments[0])
        return super().operation(node)

    def searched(self, node: x.Builtin, found: x.Comprehension) -> tuple[Document, int]:
        """any, all, next: of what a comprehension gives."""
        (clause,) = found.clauses
        names = self.names(clause.names)
        over = (
            self.strong(clause.over, ALONE)
            if clause.over.type.kind != "map"
            else ("[...", self.strong(clause.over, ALONE), ".keys()]")
        )
        tests = list(clause.tests)
        if node.name in ("any", "all"):
            if node.name == "all" and tests:
                over = (over, ".filter(", self.arrow(names, tests), ")")
                tests = []
            word = "some" if node.name == "any" else "every"
            return (over, f".{word}(", self.arrow(names, [*tests, found.item]), ")"), ALONE
        if found.item in clause.names and len(clause.names) == 1:
            one: Document = (over, ".find(", self.arrow(names, tests), ")") if tests else (over, "[0]")
        else:
            one = (self.strong(found, ALONE), "[0]")
        if node.name == "first":
            return one, ALONE
        return (one, " ?? ", self.strong(node.arguments[1], NOT)), CHOICE

    def names(self, names: tuple[x.Local, ...]) -> str:
        words = [self.local(n) for n in names]
        return f"({words[0]})" if len(words) == 1 else f"({self.taken(words)})"

    def arrow(self, names: str, tests: list[x.Expression]) -> Document:
        body = tests[0] if len(tests) == 1 else x.Logic(x.BOOL, "and", tuple(tests))
        return Group((f"{names} =>", Nest((LineBreak(" "), self.plain(body)))))

    def expression(self, node: x.Expression) -> tuple[Document, int]:
        if isinstance(node, x.Named):
            return self.named(node)
        match node:
            case x.Call():
                return (
                    self.strong(node.function, ALONE),
                    put_in_brackets("(", self.given(node), ")", ","),
                ), ALONE
            case x.New():
                self.used.setdefault(node.type.module, set()).add(node.type.name)
                return (
                    f"new {node.type.name}",
                    put_in_brackets("(", [self.plain(a) for a in node.arguments], ")", ","),
                ), ALONE
            case x.Replaced():
                self.helpers.add("but")
                changes = [(f"{make_camel_case(n)}: ", self.plain(v)) for n, v in node.changes]
                pairs = Group(
                    ("{ ", *[d for n, c in enumerate(changes) for d in ((", ", c) if n else (c,))], " }")
                )
                return ("but(", self.plain(node.of), ", ", pairs, ")"), ALONE
            case x.Comparison():
                return self.compared(node)
            case x.Either():
                parts = (
                    self.strong(node.test, NOT),
                    LineBreak(" "),
                    "? ",
                    self.strong(node.then, NOT),
                    LineBreak(" "),
                    ": ",
                    self.plain(node.other),
                )
                return Group(Nest(parts)), CHOICE
            case x.ItemOf():
                return self.item(node), ALONE
            case x.Slice():
                ends = [e for e in (node.first, node.last) if e is not None]
                first: list[Document] = ["0"] if node.first is None and node.last is not None else []
                return (
                    self.strong(node.of, ALONE),
                    put_in_brackets(".slice(", [*first, *(self.plain(e) for e in ends)], ")"),
                ), ALONE
            case x.Gathered():
                inner = put_in_brackets(
                    "[",
                    [
                        ("...", self.plain(i)) if n in node.spread else self.plain(i)
                        for n, i in enumerate(node.items)
                    ],
                    "]",
                    ",",
                )
                return (inner if node.type.kind != "set" else ("new Set(", inner, ")")), ALONE
            case x.Mapped():
                pairs_ = [put_in_brackets("[", [self.plain(k), self.plain(v)], "]") for k, v in node.items]
                return ("new Map(", put_in_brackets("[", pairs_, "]", ",") if pairs_ else "", ")"), ALONE
            case x.Comprehension():
                return self.comprehension(node), ALONE
            case x.Lambda():
                names = (
                    self.names(node.names).strip("()")
                    if len(node.names) == 1
                    else ", ".join(self.local(n) for n in node.names)
                )
                return (f"({names}) => ", self.plain(node.body)), CHOICE
            case x.Formatted():
                return self.formatted(node), ALONE
        return super().expression(node)

    def named(self, node: x.Named) -> tuple[Document, int]:
        match node:
            case x.Value():
                return self.literal(node), ALONE if not str(node.value).startswith("-") else UNARY
            case x.Local():
                return self.local(node), ALONE
            case x.Global():
                is_function = node.type.kind == "function"
                name = self.function_name(node.name) if is_function else self.constant_name(node.name)
                self.used.setdefault(node.module, set()).add(name)
                return name, ALONE
            case x.This():
                return "this", ALONE
            case x.KnownValue():
                return self.expression(node.of)
            case x.Member():
                return (self.strong(node.of, ALONE), f".{make_camel_case(node.name)}"), ALONE

    def given(self, node: x.Call) -> list[Document]:
        if not node.rest:
            return [self.plain(a) for a in node.arguments]
        *first, last = node.arguments
        if isinstance(last, x.Gathered) and not last.spread:
            return [self.plain(a) for a in (*first, *last.items)]
        return [*(self.plain(a) for a in first), ("...", self.plain(last))]

    def literal(self, node: x.Value) -> str:
        value = node.value
        if value is None or isinstance(value, bool | str):
            return json.dumps(value, ensure_ascii=False)
        if isinstance(value, float) and value in (float("inf"), float("-inf")):
            return "Infinity" if value > 0 else "-Infinity"
        return (
            repr(int(value))
            if isinstance(value, float) and value == int(value) and abs(value) < 1e15
            else repr(value)
        )

    def compared(self, node: x.Comparison) -> tuple[Document, int]:
        left, right = node.left, node.right
        kind = left.type.bare.kind
        words = {"==": "===", "!=": "!==", "is": "===", "is not": "!=="}
        word = words.get(node.operator, node.operator)
        if kind in ("list", "tuple", "map", "set", "record") and node.operator in ("==", "!="):
            raise TranslationError(
                f"{self.module.name}: whether two {kind}s are equal; compare what tells them apart"
            )
        if kind == "str" and node.operator not in words:
            self.helpers.add("compareText")
            return ("compareText(", self.plain(left), ", ", self.plain(right), f") {word} 0"), COMPARE
        parts = self.strong(left, PLUS), LineBreak(" "), f"{word} ", self.strong(right, PLUS)
        return Group(Nest(parts)), COMPARE

    def item(self, node: x.ItemOf) -> Document:
        of = self.strong(node.of, ALONE)
        if node.of.type.bare.kind == "map":
            return (of, ".get(", self.plain(node.place), ")")
        if isinstance(node.place, x.Negated) and isinstance(node.place.of, x.Value):
            if isinstance(node.of, x.Local | x.Member):
                return (of, "[", of, f".length - {node.place.of.value}]")
            self.helpers.add("fromEnd")
            return ("fromEnd(", of, f", {node.place.of.value})")
        return (of, "[", self.plain(node.place), "]")

    def comprehension(self, node: x.Comprehension) -> Document:
        if node.key is not None:
            pair = x.Gathered(x.Type("tuple", (node.key.type, node.item.type)), (node.key, node.item))
            return (
                "new Map(",
                self.comprehension(x.Comprehension(x.Type("list", (pair.type,)), pair, node.clauses)),
                ")",
            )
        if node.type.kind == "set":
            return (
                "new Set(",
                self.comprehension(x.Comprehension(x.Type("list", node.type.of), node.item, node.clauses)),
                ")",
            )
        clause, *rest = node.clauses
        names = self.names(clause.names)
        over = clause.over
        if isinstance(over, x.Builtin) and over.name == "enumerate" and not clause.tests and not rest:
            place, one = (self.local(n) for n in clause.names)
            return (
                self.strong(over.arguments[0], ALONE),
                ".map(",
                Group((f"({one}, {place}) =>", Nest((LineBreak(" "), self.returned(node.item))))),
                ")",
            )
        base: Document = (
            ("[...", self.strong(over, ALONE), ".keys()]")
            if over.type.kind == "map"
            else self.strong(over, ALONE)
        )
        if clause.tests:
            base = (base, ".filter(", self.arrow(names, list(clause.tests)), ")")
        if rest:
            inner = x.Comprehension(node.type, node.item, tuple(rest))
            return (
                base,
                ".flatMap(",
                Group((f"{names} =>", Nest((LineBreak(" "), self.comprehension(inner))))),
                ")",
            )
        if len(clause.names) == 1 and node.item == clause.names[0]:
            return base if clause.tests or over.type.kind == "map" else ("[...", base, "]")
        return (base, ".map(", Group((f"{names} =>", Nest((LineBreak(" "), self.returned(node.item))))), ")")

    def returned(self, node: x.Expression) -> Document:
        return self.plain(node)

    def formatted(self, node: x.Formatted) -> Document:
        out: list[Document] = ["`"]
        for part in node.parts:
            if isinstance(part, str):
                out.append(part.replace("\\", "\\\\").replace("`", "\\`").replace("${", "\\${"))
            elif not part[1]:
                out += ["${", self.plain(part[0]), "}"]
            elif part[1] == ".3f":  # what keys a draw: `toFixed` rounds halves up
                self.helpers.add("thousandths")
                out += ["${thousandths(", self.plain(part[0]), ")}"]
            else:
                out += ["${", self.strong(part[0], ALONE), f".toFixed({part[1].strip('.f')})", "}"]
        return (*out, "`")


__all__ = ["JavaScript"]
