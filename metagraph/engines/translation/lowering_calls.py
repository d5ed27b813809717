"""Calls of functions, methods, records and builtins in the small tree."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

from mypy import nodes as m
from mypy import types as t
from mypy.types import get_proper_type

from metagraph.engines.translation import tree as x
from metagraph.engines.translation.source import join_full_name
from metagraph.engines.translation.typed import BITS, Typed

PLAIN = {
    "builtins.len": "len", "builtins.abs": "abs", "builtins.sum": "sum", "builtins.any": "any",
    "builtins.all": "all", "builtins.str": "text", "builtins.enumerate": "enumerate",
    "builtins.zip": "zip", "builtins.range": "range", "builtins.reversed": "reversed",
    "builtins.list": "list", "builtins.tuple": "list", "builtins.dict": "map", "builtins.set": "set",
    "builtins.frozenset": "set", "math.log": "log", "math.log1p": "log1p", "math.exp": "exp",
    "math.sqrt": "sqrt", "math.cos": "cos", "math.sin": "sin", "math.floor": "floor",
    "math.isfinite": "is_finite", "math.ceil": "ceil", "bisect.bisect_right": "bisect_right",
    "bisect.bisect_left": "bisect_left", "builtins.round": "round",
}  # fmt: skip
METHODS = {
    ("list", "append"), ("list", "extend"), ("list", "pop"), ("list", "index"), ("map", "keys"),
    ("map", "values"), ("map", "items"), ("str", "split"), ("str", "strip"), ("str", "join"),
    ("str", "startswith"), ("str", "rpartition"), ("str", "lower"), ("str", "isdigit"),
    ("str", "casefold"), ("set", "add"),
}  # fmt: skip
AT_BLANKS = ("split", "strip")  # which languages only know without what to split or strip by


class Calls(Typed):
    """One module being translated: its calls."""

    def expression(self, node: m.Expression) -> x.Expression:
        raise NotImplementedError

    def expressions(self, nodes: Iterable[m.Expression]) -> tuple[x.Expression, ...]:
        return tuple(self.expression(n) for n in nodes)

    def call(self, node: m.CallExpr) -> x.Expression:
        formatted = self._formatted(node)
        if formatted is not None:
            return formatted
        callee = node.callee
        full = join_full_name(callee)
        kind = self.of(node)
        if full in PLAIN:
            plain = [
                a for a, n in zip(node.args, node.arg_names, strict=True) if n is None
            ]  # strict=True is given by zip
            given = self.expressions(plain)
            if "key" in node.arg_names:
                given = (self._keys(node, given[0]), given[1])
            if PLAIN[full] == "text" and given[0].type == x.STR:
                return given[0]
            if PLAIN[full] == "list" and given and isinstance(given[0], x.Comprehension | x.Slice):
                return given[0]  # a list already, and nobody else's
            if PLAIN[full] in ("list", "map", "set") and not given:
                return x.Mapped(kind, ()) if kind.kind == "map" else x.Gathered(kind, ())
            if PLAIN[full] == "set" and isinstance(given[0], x.Gathered) and not given[0].spread:
                return x.Gathered(kind, given[0].items)
            return x.Builtin(kind, PLAIN[full], given)
        special = {
            "builtins.float": self._float, "builtins.int": self._int, "builtins.max": self._most,
            "builtins.min": self._most, "builtins.next": self._next, "builtins.sorted": self._sorted,
            "dataclasses.replace": self._replaced, "bisect.insort": self._insort,
        }  # fmt: skip
        if full in special:
            return special[full](node, kind)
        if isinstance(callee, m.MemberExpr) and callee.kind != m.GDEF:
            return self._method(node, callee, kind)
        if isinstance(callee, m.RefExpr) and isinstance(callee.node, m.TypeInfo):
            return self._new(node, callee.node, kind)
        if isinstance(callee, m.RefExpr) and isinstance(callee.node, m.FuncDef):
            rest = m.ARG_STAR in callee.node.arg_kinds
            written = callee.node.unanalyzed_type
            if isinstance(written, t.CallableType) and isinstance(written.ret_type, t.UnboundType):
                kind = x.BITS if written.ret_type.name == BITS else kind
            return x.Call(kind, self.expression(callee), self.arguments(node, callee.node, skip=0), rest)
        if isinstance(callee, m.NameExpr) and isinstance(callee.node, m.Var):
            return x.Call(kind, self.expression(callee), self.expressions(node.args))
        raise self.refuse(node, f"a call of '{full or type(callee).__name__}'", "use what the subset has")

    def _keys(self, node: m.CallExpr, of: x.Expression) -> x.Expression:
        """Return what a key gives for each item: a place among items is found among these."""
        key = self.expression(node.args[node.arg_names.index("key")])
        if not isinstance(key, x.Lambda):
            raise self.refuse(node, "a key that is no lambda", "write a lambda")
        clause = x.ForClause(key.names, of, ())
        return x.Comprehension(x.Type("list", (key.body.type,)), key.body, (clause,))

    def _formatted(self, node: m.CallExpr) -> x.Expression | None:
        """Return an f-string: mypy has it as `"".join([..., "{:{}}".format(value, how), ...])`."""
        callee = node.callee
        if not isinstance(callee, m.MemberExpr) or not isinstance(callee.expr, m.StrExpr):
            return None
        if callee.name == "format" and callee.expr.value == "{:{}}":
            return x.Formatted(x.STR, (self._piece(node),))
        if callee.name != "join" or callee.expr.value or not isinstance(node.args[0], m.ListExpr):
            return None
        parts: list[str | tuple[x.Expression, str]] = []
        for item in node.args[0].items:
            if isinstance(item, m.StrExpr):
                parts.append(item.value)
            else:
                assert isinstance(item, m.CallExpr)
                parts.append(self._piece(item))
        return x.Formatted(x.STR, tuple(parts))

    def _piece(self, node: m.CallExpr) -> tuple[x.Expression, str]:
        value, how = node.args
        if not isinstance(how, m.StrExpr) or how.value not in ("", ".1f", ".2f", ".3f"):
            raise self.refuse(node, "a way to write a number", "use nothing, .1f, .2f or .3f")
        found = self.expression(value)
        if found.type.kind not in ("str", "int") and not how.value:
            raise self.refuse(node, f"a {found.type.kind} in a text", "say with how many places (.2f)")
        return found, how.value

    def _float(self, node: m.CallExpr, kind: x.Type) -> x.Expression:
        (given,) = node.args
        if isinstance(given, m.StrExpr):
            return x.Value(x.FLOAT, float(given.value))
        return x.Builtin(x.FLOAT, "number", (self.expression(given),))

    def _int(self, node: m.CallExpr, kind: x.Type) -> x.Expression:
        return x.Builtin(x.INT, "whole", self.expressions(node.args))

    def _most(self, node: m.CallExpr, kind: x.Type) -> x.Expression:
        """max and min: of two or more values, or of a list, with what an empty one gives."""
        word = join_full_name(node.callee).rpartition(".")[2]
        given = self.expressions(node.args)
        if len(node.args) > 1:
            if set(node.arg_names) != {None}:
                raise self.refuse(node, f"{word} with a key", "sort, or loop")
            return x.Builtin(kind, word, tuple(self.fitted(g, kind) for g in given))
        return x.Builtin(kind, f"{word}_of", given)

    def _next(self, node: m.CallExpr, kind: x.Type) -> x.Expression:
        found = self.expressions(node.args)
        if not isinstance(found[0], x.Comprehension):
            raise self.refuse(node, "next of anything but a generator", "use it with `x for x in`")
        return x.Builtin(kind, "first" if len(found) == 1 else "first_or", found)

    def _sorted(self, node: m.CallExpr, kind: x.Type) -> x.Expression:
        if not set(node.arg_names) <= {None, "key"}:
            raise self.refuse(node, "sorted in reverse", "sort by what is negative, or reverse the list")
        return x.Builtin(kind, "sorted" if len(node.args) == 1 else "sorted_by", self.expressions(node.args))

    def _insort(self, node: m.CallExpr, kind: x.Type) -> x.Expression:
        given = {n or str(k): a for k, (n, a) in enumerate(zip(node.arg_names, node.args, strict=True))}
        order = [given.get(k) for k in ("0", "1", "lo", "key")]
        if None in order:
            raise self.refuse(node, "insort without lo and key", "give both")
        return x.Builtin(kind, "insort", self.expressions(a for a in order if a is not None))

    def _replaced(self, node: m.CallExpr, kind: x.Type) -> x.Expression:
        of = self.expression(node.args[0])
        info = self.info(node.args[0])
        changes = []
        for name, value in zip(node.arg_names[1:], node.args[1:], strict=True):
            assert name is not None and info is not None
            symbol = info.get(name)
            wanted = self.declared(symbol.node if symbol else None, node)
            changes.append((name, self.fitted(self.expression(value), wanted)))
        return x.Replaced(of.type, of, tuple(changes))

    def _method(self, node: m.CallExpr, callee: m.MemberExpr, kind: x.Type) -> x.Expression:
        of = self.expression(callee.expr)
        given = self.expressions(node.args)
        if of.type.kind == "map" and callee.name == "get":
            if len(given) == 1:
                return x.Builtin(kind, "get", (of, *given))
            return x.Builtin(kind, "get_or", (of, given[0], self.fitted(given[1], of.type.of[1])))
        if of.type.kind == "str" and callee.name in AT_BLANKS and given:
            raise self.refuse(node, f"'.{callee.name}()' at something else than blanks", "go by the letters")
        if (of.type.kind, callee.name) in METHODS:
            return x.Builtin(kind, f"{of.type.kind}_{callee.name}", (of, *given))
        info = self.info(callee.expr)
        symbol = info.get(callee.name) if info else None
        if symbol is None or not isinstance(symbol.node, m.FuncDef) or of.type.kind != "record":
            raise self.refuse(node, f"'.{callee.name}()' of a {of.type.kind}", "use what the subset has")
        member = x.Member(self.of(callee), of, callee.name)
        return x.Call(kind, member, self.arguments(node, symbol.node, skip=1))

    def arguments(self, node: m.CallExpr, function: m.FuncDef, skip: int) -> tuple[x.Expression, ...]:
        """Return what is given for each parameter, defaults at the end left out."""
        kind = get_proper_type(function.type)
        assert isinstance(kind, t.CallableType)
        names = [a.variable.name for a in function.arguments][skip:]
        wanted = [self.type(a, node) for a in kind.arg_types[skip:]]
        defaults = [a.initializer for a in function.arguments][skip:]
        star = next((n for n, k in enumerate(function.arg_kinds[skip:]) if k is m.ARG_STAR), None)
        return self._placed(node, names, wanted, defaults, star)

    def _placed(
        self, node: m.CallExpr, names: Sequence[str], wanted: Sequence[x.Type],
        defaults: Sequence[m.Expression | None], star: int | None = None,
    ) -> tuple[x.Expression, ...]:  # fmt: skip
        given: dict[int, x.Expression] = {}
        rest: list[x.Expression] = []
        spread: set[int] = set()
        for n, (value, name, kind) in enumerate(zip(node.args, node.arg_names, node.arg_kinds, strict=True)):
            if kind is m.ARG_STAR:
                spread.add(len(rest))
            if name is None and star is not None and n >= star:
                rest.append(self.expression(value))
            else:
                place = n if name is None else names.index(name)
                given[place] = self.fitted(self.expression(value), wanted[place])
        if star is not None:
            of = x.Type("list", (wanted[star],))
            whole = (
                rest[0]
                if spread == {0} and len(rest) == 1
                else x.Gathered(of, tuple(rest), frozenset(spread))
            )
            given[star] = whole
        last = max(given, default=-1)
        out = []
        for n in range(last + 1):
            default = defaults[n] if n < len(defaults) else None
            if n in given:
                out.append(given[n])
            elif default is not None:
                out.append(self.default(default, wanted[n]))
            else:
                raise self.refuse(node, f"'{names[n]}' is not given", "give it")
        return tuple(out)

    def _new(self, node: m.CallExpr, info: m.TypeInfo, kind: x.Type) -> x.Expression:
        names, wanted, defaults = [], [], []
        for one in info.defn.defs.body:
            if isinstance(one, m.AssignmentStmt) and isinstance(one.lvalues[0], m.NameExpr):
                names.append(one.lvalues[0].name)
                wanted.append(self.declared(one.lvalues[0].node, one))
                defaults.append(None if isinstance(one.rvalue, m.TempNode) else one.rvalue)
        return x.New(kind, self._placed(node, names, wanted, defaults))

    def fitted(self, value: x.Expression, wanted: x.Type) -> x.Expression:
        """Return a value as a certain type: what is empty gets its items' type, a whole number becomes one
        with a fraction if that is written down.
        """
        if isinstance(value, x.Gathered | x.Mapped) and wanted.bare.kind in ("list", "map", "set"):
            return replace(value, type=wanted.bare)
        if isinstance(value, x.Gathered) and value.type.kind == "tuple" and wanted.bare.kind == "tuple":
            items = tuple(self.fitted(v, w) for v, w in zip(value.items, wanted.bare.of, strict=True))
            return x.Gathered(wanted.bare, items)
        if isinstance(value, x.Value) and value.type == x.INT and wanted.bare == x.FLOAT:
            return x.Value(x.FLOAT, float(str(value.value)))
        if value.type == x.INT and wanted.bare == x.FLOAT:
            return x.Builtin(x.FLOAT, "number", (value,))
        if isinstance(value, x.Value) and value.type == x.NONE and wanted.kind == "optional":
            return x.Value(wanted, None)
        return value

    def default(self, node: m.Expression, kind: x.Type) -> x.Expression:
        if isinstance(node, m.CallExpr) and join_full_name(node.callee) == "dataclasses.field":
            if "default" in node.arg_names:
                return self.default(node.args[node.arg_names.index("default")], kind)
            (factory,) = node.args
            none = x.Gathered(kind, ())
            empty = {"builtins.dict": x.Mapped(kind, ()), "builtins.list": none, "builtins.set": none}
            full = join_full_name(factory)
            if full not in empty:
                raise self.refuse(
                    node, "a default made by a function", "use an empty list, map or set, or a value"
                )
            return empty[full]
        return self.fitted(self.expression(node), kind)
