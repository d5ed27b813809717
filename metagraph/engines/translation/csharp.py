"""Prints modules as C# 7.3: records as classes, functions and constants as members of a static class."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from collections.abc import Set as AbstractSet
from types import MappingProxyType

from metagraph.engines.translation import tree as x
from metagraph.engines.translation.braces import Braces
from metagraph.engines.translation.layout import Document, Group, LineBreak, Nest, put_in_brackets
from metagraph.engines.translation.printing import (
    ALONE,
    CHOICE,
    COMPARE,
    NOT,
    PLUS,
    TIMES,
    UNARY,
    TranslationError,
    make_camel_case,
    make_pascal_case,
)  # fmt: skip

VALUES = ("int", "bits", "float", "bool", "tuple")
PLAIN = {"int": "int", "bits": "uint", "float": "double", "bool": "bool", "str": "string", "none": "void"}


EXTERNAL = {  # records that are not translated, as they are called here
    "Settings": "PlannerSettings", "Life": "LifeSettings", "Project": "Graph",
    "MetaGraph": "LayerGraph", "Action": "GraphAction",
}  # fmt: skip


class CSharp(Braces):
    """One module, `Name.cs`; its static class is `NameRules`."""

    STEP = "    "
    WIDTH = 130
    LANGUAGE = "csharp"
    OWN_LINE = True
    THROW = ("throw new InvalidOperationException(", ")")

    def text(self) -> str:
        self.depth = 1
        records = [p for p in self.module.parts if isinstance(p, x.RecordClass)]
        rest = [p for p in self.module.parts if not isinstance(p, x.RecordClass)]
        for record in records:
            self.record(record)
        if rest:
            self.out.append("")
            if not records:
                self.documented(self.module.about)
            self.line(f"public static class {self.rules(self.module.name)}")
            self.line("{")
            self.depth += 1
            for n, part in enumerate(rest):
                if isinstance(part, x.Constant):
                    self.constant(part)
                elif isinstance(part, x.Function):
                    if n:
                        self.out.append("")
                    self.function(part)
            self.depth -= 1
            self.line("}")
        head = [
            f"// {self.source()}",
            "using System;",
            "using System.Collections.Generic;",
            "using System.Linq;",
        ]
        body = self.out[1:] if self.out and not self.out[0] else self.out
        return "\n".join([*head, "", "namespace Metagraph", "{", *body, "}"]) + "\n"

    def rules(self, module: str) -> str:
        """Return the static class of a module's functions and constants."""
        return make_pascal_case(self.known(module)) + "Rules"

    # --- declarations

    def constant(self, node: x.Constant) -> None:
        self.comments(node.comments)
        kind = node.value.type
        word = "const" if isinstance(node.value, x.Value) else "static readonly"
        access = "public" if node.public else "private"
        self.line(
            (f"{access} {word} {self.type(kind)} {self.shared(node.name)} = ", self.plain(node.value), ";"),
            node.beside,
        )

    serial = 0  # of values taken apart in a function
    taken: AbstractSet[str] = frozenset()  # names of a function's variables
    aliases: Mapping[str, str] = MappingProxyType(
        {}
    )  # names that comprehensions bring, and how they are reached
    in_record = False  # else functions and constants of the module are near

    def record(self, node: x.RecordClass) -> None:
        self.in_record = True
        self.out.append("")
        self.documented(node.about)
        self.line(f"public sealed class {node.name}")
        self.line("{")
        self.depth += 1
        for f in node.fields:
            self.line(
                f"public {'' if node.changes else 'readonly '}{self.type(f.type)} {make_pascal_case(f.name)};"
            )
        self.out.append("")
        self.line(
            (f"public {node.name}", put_in_brackets("(", [self.parameter(f) for f in node.fields], ")"))
        )
        self.line("{")
        self.depth += 1
        for f in node.fields:
            name = self.word(make_camel_case(f.name))
            made = self.made_later(f)
            self.line((f"{make_pascal_case(f.name)} = ", (f"{name} ?? ", made) if made else name, ";"))
        self.depth -= 1
        self.line("}")
        for method in node.methods:
            self.out.append("")
            self.function(method, "public ")
        self.depth -= 1
        self.line("}")
        self.in_record = False

    def made_later(self, node: x.Parameter) -> Document | None:
        """Return a default that is no constant of the language, and so is made where it is needed."""
        default = node.default
        if default is None or isinstance(default, x.Value | x.Negated):
            return None
        if isinstance(default, x.Global) and node.type.kind in ("int", "float", "str", "bool"):
            return None
        return self.plain(default)

    def function(self, node: x.Function, access: str = "") -> None:
        self.serial = 0
        self.taken = {make_camel_case(n.name) for n in x.walk(node.body) if isinstance(n, x.Local)}
        self.comments(node.comments)
        self.documented(node.about)
        access = access or ("public static " if node.public else "private static ")
        head = f"{access}{self.type(node.returns)} {make_pascal_case(node.name)}"
        if node.property:
            self.line(head)
            self.line("{")
            self.depth += 1
            self.braced("get", node.body)
            self.depth -= 1
            self.line("}")
            return
        self.line((head, put_in_brackets("(", [self.parameter(p) for p in node.parameters], ")")))
        late = [
            (self.word(make_camel_case(p.name)), made)
            for p in node.parameters
            if (made := self.made_later(p))
        ]
        self.line("{")
        self.depth += 1
        for name, made in late:
            self.line((f"{name} = {name} ?? ", made, ";"))
        self.depth -= 1
        self.block(node.body)
        self.line("}")

    def parameter(self, node: x.Parameter) -> Document:
        name = f"{self.type(node.type)} {self.word(make_camel_case(node.name))}"
        if node.rest:
            return f"params {self.type(node.type.of[0])}[] {self.word(make_camel_case(node.name))}"
        if node.default is None:
            return name
        if self.made_later(node):
            return f"{name} = null"
        if isinstance(node.default, x.Value) and node.default.value is None:
            return f"{name} = null"
        return (f"{name} = ", self.plain(node.default))

    def documented(self, about: str) -> None:
        if not about:
            return
        told = about.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
        found = self.wrapped(told, "/// ")
        if len(found) == 1 and len(found[0]) < self.WIDTH - 30:
            self.line(f"/// <summary>{found[0][4:]}</summary>")
            return
        self.line("/// <summary>")
        for one in found:
            self.line(one)
        self.line("/// </summary>")

    def type(self, kind: x.Type) -> str:
        match kind.kind:
            case "optional":
                return self.type(kind.bare) + ("?" if kind.bare.kind in VALUES else "")
            case "list":
                return f"List<{self.type(kind.of[0])}>"
            case "tuple":
                return "(" + ", ".join(self.type(o) for o in kind.of) + ")"
            case "map":
                return f"Dictionary<{self.type(kind.of[0])}, {self.type(kind.of[1])}>"
            case "set":
                return f"HashSet<{self.type(kind.of[0])}>"
            case "record":
                return EXTERNAL.get(kind.name, kind.name)
            case "function":
                return "Func<" + ", ".join(self.type(o) for o in kind.of) + ">"
        if kind.kind in PLAIN:
            return PLAIN[kind.kind]
        raise TranslationError(f"{self.module.name}: a type that is not known")

    # --- statements

    def declaration(self, node: x.Declare) -> None:
        """`var`, where the value tells its type."""
        kind, value = self.type(node.variable.type), node.value
        name = self.local(node.variable)
        if value is None:
            self.line(f"{kind} {name} = default({kind});", node.beside)
            return
        nothing = isinstance(value, x.Value) and value.value is None
        told = not nothing and value.type in (node.variable.type, x.BITS)
        self.line((f"{'var' if told else kind} {name} = ", self.plain(value), ";"), node.beside)

    def unpacked(self, node: x.Unpack) -> None:
        """One by one: compilers differ in what they take apart at once."""
        self.serial += 1
        word = "found" if "found" not in self.taken else "both"
        name = word if self.serial == 1 else f"{word}{self.serial}"
        self.line((f"var {name} = ", self.plain(node.value), ";"), node.beside)
        for n, target in enumerate(node.targets, 1):
            kind = f"{self.type(target.type)} " if node.new else ""
            self.line((kind, self.target(target), f" = {name}.Item{n};"))

    def each(self, node: x.ForEach) -> None:
        words = [self.local(n) for n in node.names]
        over = node.over
        if isinstance(over, x.Builtin) and over.name == "range":
            given = [self.plain(a) for a in over.arguments]
            first, last = ("0", given[0]) if len(given) == 1 else given[:2]
            head: Document = (f"for (int {words[0]} = ", first, f"; {words[0]} < ", last, f"; {words[0]}++)")
            self.braced(head, node.body, node.beside)
            return
        if len(words) == 1:
            kind = self.type(node.names[0].type)
            self.braced((f"foreach ({kind} {words[0]} in ", self.items(over), ")"), node.body, node.beside)
            return
        parts = ["Item1", "Item2"]
        if isinstance(over, x.Builtin) and over.name == "map_items":
            parts, over = ["Key", "Value"], over.arguments[0]
        one = next(w for w in ("one", "pair", "entry", "each") if w not in self.taken)
        first_lines = [f"var {word} = {one}.{part};" for word, part in zip(words, parts, strict=True)]
        head = (f"foreach (var {one} in ", self.items(over, keys=over is node.over), ")")
        self.braced(head, node.body, node.beside, first_lines)

    def items(self, over: x.Expression, keys: bool = True) -> Document:
        """Return what gives the items of something one by one. keys: of a map, those."""
        given = over.arguments if isinstance(over, x.Builtin) else ()
        match over:
            case x.Builtin(name="enumerate"):
                return (self.strong(given[0], ALONE), ".Select((item, n) => (n, item))")
            case x.Builtin(name="map_items"):
                return (self.strong(given[0], ALONE), ".Select(entry => (entry.Key, entry.Value))")
            case x.Builtin(name="zip"):
                return ("PlainLists.Pairs(", self.plain(given[0]), ", ", self.plain(given[1]), ")")
            case _ if over.type.kind == "map" and keys:
                return (self.strong(over, ALONE), ".Keys")
        return self.plain(over)

    # --- expressions

    def local(self, node: x.Local) -> str:
        return self.aliases.get(node.name) or self.word(make_camel_case(node.name))

    def shared(self, name: str) -> str:
        return make_pascal_case(name.lower()) if name.isupper() else make_pascal_case(name)

    def operation(self, node: x.Builtin) -> tuple[Document, int]:
        if node.name in ("any", "all", "first", "first_or") and isinstance(
            node.arguments[0], x.Comprehension
        ):
            return self.searched(node, node.arguments[0])
        if node.name == "insort":
            of, item, low, key = node.arguments
            return (
                "PlainLists.Insert",
                put_in_brackets("(", [*(self.plain(a) for a in (of, item, low)), self.keyed(key)], ")"),
            ), ALONE
        if node.name in ("sorted_by", "sorted"):
            return self.ordered(node), ALONE
        if node.name in ("map", "set") and node.arguments:
            return (f"new {self.type(node.type)}(", self.plain(node.arguments[0]), ")"), ALONE
        return super().operation(node)

    def keyed(self, key: x.Expression) -> Document:
        """A function as a lambda: compilers do not find the types of its name alone."""
        return self.plain(key) if isinstance(key, x.Lambda) else ("item => ", self.plain(key), "(item)")

    def ordered(self, node: x.Builtin) -> Document:
        """A stable order by what a key gives, item by item."""
        of = self.strong(node.arguments[0], ALONE)
        key = node.arguments[1] if len(node.arguments) > 1 else None
        if key is None:
            return (of, ".OrderBy(x => x).ToList()")
        if not isinstance(key, x.Lambda):
            return ("PlainLists.By(", self.plain(node.arguments[0]), ", ", self.keyed(key), ")")
        name = self.local(key.names[0])
        body = key.body
        parts = body.items if isinstance(body, x.Gathered) and body.type.kind == "tuple" else (body,)
        out: list[Document] = [of]
        for n, part in enumerate(parts):
            ordinal = ", PlainText.Order" if part.type.kind == "str" else ""
            out += [".OrderBy(" if n == 0 else ".ThenBy(", f"{name} => ", self.plain(part), f"{ordinal})"]
        return (*out, ".ToList()")

    def searched(self, node: x.Builtin, found: x.Comprehension) -> tuple[Document, int]:
        (clause,) = found.clauses
        name, undo = self.bound(clause)
        over = self.items(clause.over)
        tests = list(clause.tests)
        if node.name in ("any", "all"):
            if node.name == "all" and tests:
                over = (over, f".Where({name} => ", self.both(tests), ")")
                tests = []
            word = "Any" if node.name == "any" else "All"
            out: Document = (over, f".{word}({name} => ", self.both([*tests, found.item]), ")")
        else:
            if tests:
                over = (over, f".Where({name} => ", self.both(tests), ")")
            if found.item not in clause.names:
                over = (over, f".Select({name} => ", self.plain(found.item), ")")
            other = node.arguments[1] if node.name == "first_or" else None
            missing = isinstance(other, x.Value) and other.value is None
            if other is not None and not missing:
                out = (over, ".DefaultIfEmpty(", self.plain(other), ").First()")
            elif missing and node.type.bare.kind in VALUES:
                out = (over, f".Select(item => ({self.type(node.type)})item).FirstOrDefault()")
            else:
                out = (over, ".FirstOrDefault()" if missing else ".First()")
        undo()
        return out, ALONE

    def bound(self, clause: x.ForClause) -> tuple[str, Callable[[], None]]:
        """Return what a lambda calls an item of a clause; names of a tuple's items are reached through it."""
        before = dict(self.aliases)
        if len(clause.names) == 1:
            self.aliases = {k: v for k, v in before.items() if k != clause.names[0].name}
            name = self.local(clause.names[0])
        else:
            name = "pair"
            self.aliases = {**before, **{n.name: f"pair.Item{k}" for k, n in enumerate(clause.names, 1)}}

        def undo() -> None:
            self.aliases = before

        return name, undo

    def both(self, tests: list[x.Expression]) -> Document:
        return self.plain(tests[0] if len(tests) == 1 else x.Logic(x.BOOL, "and", tuple(tests)))

    def expression(self, node: x.Expression) -> tuple[Document, int]:
        if isinstance(node, x.Named):
            return self.named(node)
        match node:
            case x.Call():
                return (self.strong(node.function, ALONE), put_in_brackets("(", self.given(node), ")")), ALONE
            case x.New():
                return (
                    f"new {node.type.name}",
                    put_in_brackets("(", [self.plain(a) for a in node.arguments], ")"),
                ), ALONE
            case x.Replaced():
                return self.replaced(node), ALONE
            case x.Comparison():
                return self.compared(node)
            case x.Either():
                kind = node.type
                then, other = (self.branch(b, kind) for b in (node.then, node.other))
                return Group(
                    Nest(
                        (self.strong(node.test, NOT), LineBreak(" "), "? ", then, LineBreak(" "), ": ", other)
                    )
                ), CHOICE
            case x.ItemOf():
                return self.item(node), ALONE
            case x.Slice():
                ends = ["0" if node.first is None else self.plain(node.first)]
                ends += [] if node.last is None else [self.plain(node.last)]
                return ("PlainLists.Part", put_in_brackets("(", [self.plain(node.of), *ends], ")")), ALONE
            case x.Gathered():
                return self.gathered(node), ALONE
            case x.Mapped():
                pairs: list[Document] = [
                    ("{ ", self.plain(k), ", ", self.plain(v), " }") for k, v in node.items
                ]
                return (
                    f"new {self.type(node.type)}",
                    put_in_brackets(" { ", pairs, " }") if pairs else "()",
                ), ALONE
            case x.Comprehension():
                return self.comprehension(node), ALONE
            case x.Lambda():
                names = ", ".join(self.local(n) for n in node.names)
                return (
                    f"{names if len(node.names) == 1 else f'({names})'} => ",
                    self.plain(node.body),
                ), CHOICE
            case x.Formatted():
                return self.formatted(node)
        return super().expression(node)

    def named(self, node: x.Named) -> tuple[Document, int]:
        match node:
            case x.Value():
                return self.literal(node), ALONE if not str(node.value).startswith("-") else UNARY
            case x.Local():
                return self.local(node), ALONE
            case x.Global():
                name = self.shared(node.name)
                here = node.module == self.module.name and not self.in_record
                return (name if here else f"{self.rules(node.module)}.{name}"), ALONE
            case x.This():
                return "this", ALONE
            case x.KnownValue():
                of = self.strong(node.of, ALONE)
                return ((of, ".Value") if node.type.kind in VALUES else of), ALONE
            case x.Member():
                if isinstance(node.of, x.This):
                    return make_pascal_case(node.name), ALONE
                return (self.strong(node.of, ALONE), f".{make_pascal_case(node.name)}"), ALONE

    def given(self, node: x.Call) -> list[Document]:
        *first, last = node.arguments or (None,)
        if node.rest and isinstance(last, x.Gathered) and not last.spread:
            return [self.plain(a) for a in (*first, *last.items) if a is not None]
        return [self.plain(a) for a in node.arguments]

    def branch(self, node: x.Expression, kind: x.Type) -> Document:
        if isinstance(node, x.Value) and node.value is None and kind.bare.kind in VALUES:
            return f"({self.type(kind)})null"
        return self.strong(node, CHOICE)

    def literal(self, node: x.Value) -> str:
        value = node.value
        if value is None or isinstance(value, bool | str):
            return json.dumps(value, ensure_ascii=False)
        if isinstance(value, float) and value in (float("inf"), float("-inf")):
            return "double.PositiveInfinity" if value > 0 else "double.NegativeInfinity"
        if node.type == x.FLOAT:
            return repr(float(str(value))) if "e" not in repr(value) else repr(value)
        return repr(value)

    def compared(self, node: x.Comparison) -> tuple[Document, int]:
        left, right = node.left, node.right
        kind = left.type.bare.kind
        word = {"is": "==", "is not": "!="}.get(node.operator, node.operator)
        if kind in ("list", "tuple", "map", "set", "record") and node.operator in ("==", "!="):
            raise TranslationError(
                f"{self.module.name}: whether two {kind}s are equal; compare what tells them apart"
            )
        if kind == "str" and node.operator in ("<", "<=", ">", ">="):
            return ("PlainText.Compare(", self.plain(left), ", ", self.plain(right), f") {word} 0"), COMPARE
        parts = self.strong(left, PLUS), LineBreak(" "), f"{word} ", self.strong(right, PLUS)
        return Group(Nest(parts)), COMPARE

    def item(self, node: x.ItemOf) -> Document:
        of = self.strong(node.of, ALONE)
        if node.of.type.bare.kind == "tuple":
            assert isinstance(node.place, x.Value)
            return (of, f".Item{int(str(node.place.value)) + 1}")
        if isinstance(node.place, x.Negated) and isinstance(node.place.of, x.Value):
            return (of, "[", of, f".Count - {node.place.of.value}]")
        return (of, "[", self.plain(node.place), "]")

    def replaced(self, node: x.Replaced) -> Document:
        """The record made again, with all its fields."""
        record = self.record_of(node.type)
        changes = dict(node.changes)
        of = self.strong(node.of, ALONE)
        given: list[Document] = []
        for f in record.fields:
            given.append(
                self.plain(changes[f.name]) if f.name in changes else (of, f".{make_pascal_case(f.name)}")
            )
        return (f"new {node.type.name}", put_in_brackets("(", given, ")"))

    def gathered(self, node: x.Gathered) -> Document:
        if node.type.kind == "tuple":
            return put_in_brackets("(", [self.plain(i) for i in node.items], ")")
        kind = self.type(node.type)
        if node.spread:
            parts: list[Document] = []
            for n, item in enumerate(node.items):
                one = (
                    self.strong(item, ALONE)
                    if n in node.spread
                    else (f"new {kind} {{ ", self.plain(item), " }")
                )
                parts.append(one if n == 0 else (".Concat(", one, ")"))
            return (*parts, ".ToList()")
        inner = put_in_brackets(" { ", [self.plain(i) for i in node.items], " }") if node.items else "()"
        return (f"new {kind}", inner)

    def comprehension(self, node: x.Comprehension) -> Document:
        if node.key is not None:
            pair = x.Gathered(x.Type("tuple", (node.key.type, node.item.type)), (node.key, node.item))
            inner = self.chained(x.Comprehension(x.Type("list", (pair.type,)), pair, node.clauses))
            return (inner, ".ToMap()")
        out = self.chained(node)
        return (f"new {self.type(node.type)}(", out, ")") if node.type.kind == "set" else (out, ".ToList()")

    def chained(self, node: x.Comprehension) -> Document:
        clause, *rest = node.clauses
        over = clause.over
        if (
            isinstance(over, x.Builtin)
            and over.name in ("enumerate", "zip")
            and not clause.tests
            and not rest
        ):
            a, b = (self.local(n) for n in clause.names)
            if over.name == "enumerate":
                return (
                    self.strong(over.arguments[0], ALONE),
                    f".Select(({b}, {a}) => ",
                    self.plain(node.item),
                    ")",
                )
            first, second = over.arguments
            return (
                self.strong(first, ALONE),
                ".Zip(",
                self.plain(second),
                f", ({a}, {b}) => ",
                self.plain(node.item),
                ")",
            )
        base = self.items(over)
        name, undo = self.bound(clause)
        if clause.tests:
            base = (base, f".Where({name} => ", self.both(list(clause.tests)), ")")
        if rest:
            base = (
                base,
                f".SelectMany({name} => ",
                self.chained(x.Comprehension(node.type, node.item, tuple(rest))),
                ")",
            )
        elif len(clause.names) != 1 or node.item != clause.names[0]:
            base = (base, f".Select({name} => ", self.plain(node.item), ")")
        undo()
        return base

    def formatted(self, node: x.Formatted) -> tuple[Document, int]:
        out: list[Document] = []
        for n, part in enumerate(node.parts):
            out += [LineBreak(" "), "+ "] if n else []
            if isinstance(part, str):
                out.append(json.dumps(part, ensure_ascii=False))
            elif part[1]:
                out += ["PlainText.Fixed(", self.plain(part[0]), f", {part[1].strip('.f')})"]
            elif part[0].type.kind == "str":
                out.append(self.strong(part[0], TIMES))
            else:
                out += ["PlainText.Of(", self.plain(part[0]), ")"]
        return Group(Nest(tuple(out))), PLUS
