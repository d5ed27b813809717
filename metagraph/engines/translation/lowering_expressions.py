"""Expressions in the small tree: names, operators, lists, comprehensions."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from mypy import nodes as m
from mypy import types as t
from mypy.types import get_proper_type

from metagraph.engines.translation import tree as x
from metagraph.engines.translation.lowering_calls import Calls


class Expressions(Calls):
    """One module being translated: its expressions."""

    def expression(self, node: m.Expression) -> x.Expression:
        match node:
            case m.IntExpr() | m.FloatExpr() | m.StrExpr():
                return self._literal(node)
            case m.NameExpr():
                return self._name(node)
            case m.MemberExpr():
                return self._member(node)
            case m.CallExpr():
                return self.call(node)
            case m.OpExpr():
                return self._operation(node)
            case m.ComparisonExpr():
                return self._comparison(node)
            case m.UnaryExpr():
                return self._negated(node)
            case m.ConditionalExpr():
                kind = self.of(node)
                then, other = self.expression(node.if_expr), self.expression(node.else_expr)
                return x.Either(
                    kind, self.truth(node.cond), self.fitted(then, kind), self.fitted(other, kind)
                )
            case m.IndexExpr():
                return self._index(node)
            case m.TupleExpr() | m.ListExpr() | m.SetExpr():
                return self._gathered(node)
            case m.DictExpr():
                return self._mapped(node)
            case m.ListComprehension() | m.SetComprehension() | m.GeneratorExpr():
                return self._comprehension(node)
            case m.DictionaryComprehension() if node.key is not None:
                clauses = self._clauses(node.sequences, node.indices, node.condlists)
                return x.Comprehension(
                    self.of(node), self.expression(node.value), clauses, self.expression(node.key)
                )
            case m.LambdaExpr():
                return self._lambda(node)
        raise self.refuse(node, f"{type(node).__name__} is outside the subset", "write it with simpler means")

    def _literal(self, node: m.IntExpr | m.FloatExpr | m.StrExpr) -> x.Expression:
        match node:
            case m.IntExpr():
                return x.Value(x.INT, node.value)
            case m.FloatExpr():
                return x.Value(x.FLOAT, node.value)
            case m.StrExpr():
                return x.Value(x.STR, node.value)

    def _negated(self, node: m.UnaryExpr) -> x.Expression:
        if node.op == "not":
            return x.Negated(x.BOOL, "not", self.truth(node.expr))
        return x.Negated(self.of(node), node.op, self.expression(node.expr))

    def _lambda(self, node: m.LambdaExpr) -> x.Expression:
        names = tuple(x.Local(self.declared(a.variable, node), a.variable.name) for a in node.arguments)
        (body,) = node.body.body
        assert isinstance(body, m.ReturnStmt) and body.expr is not None
        return x.Lambda(self.of(node), names, self.expression(body.expr))

    def _name(self, node: m.NameExpr) -> x.Expression:
        plain = {"True": (x.BOOL, True), "False": (x.BOOL, False), "None": (x.NONE, None)}
        if node.name in plain and node.fullname.startswith("builtins."):
            return x.Value(*plain[node.name])
        if node.name == "self":
            return x.This(self.of(node))
        if node.kind == m.GDEF or isinstance(node.node, m.FuncDef):
            module, _, name = node.fullname.rpartition(".")
            return x.Global(self.of(node), module, name)
        return self.narrowed(node, x.Local(self.declared(node.node, node), node.name))

    def narrowed(self, node: m.Expression, found: x.Expression) -> x.Expression:
        """Return a value as what it is known to be where it stands."""
        now = self.source.types.get(node)
        if found.type.kind != "optional" or now is None:
            return found
        here = self.type(now, node)
        if here.kind in ("optional", "none", "any"):
            return found
        return x.KnownValue(found.type.bare, found)

    def _member(self, node: m.MemberExpr) -> x.Expression:
        if node.kind == m.GDEF:
            if node.fullname == "math.inf":
                return x.Value(x.FLOAT, float("inf"))
            if node.fullname == "math.pi":
                return x.Builtin(x.FLOAT, "pi", ())
            module, _, name = node.fullname.rpartition(".")
            return x.Global(self.of(node), module, name)
        of = self.expression(node.expr)
        info = self.info(node.expr)
        symbol = info.get(node.name) if info else None
        if symbol is None:
            raise self.refuse(node, f"'{node.name}' of {of.type.kind}", "use what the subset has")
        if isinstance(symbol.node, m.Var) and symbol.node.type is not None:
            kind = self.type(symbol.node.type, node)
            return self.narrowed(node, x.Member(kind, of, node.name))
        if isinstance(symbol.node, m.Decorator):
            returned = get_proper_type(symbol.node.func.type)
            assert isinstance(returned, t.CallableType)
            return x.Member(self.type(returned.ret_type, node), of, node.name, computed=True)
        return x.Member(self.of(node), of, node.name)

    def truth(self, node: m.Expression) -> x.Expression:
        """Return whether something is true, as Python takes it."""
        found = self.expression(node)
        return self._true(found, node)

    def _true(self, found: x.Expression, node: m.Context) -> x.Expression:
        kind = found.type
        if kind.kind == "bool":
            return found
        if kind.kind in ("int", "float"):
            return x.Comparison(x.BOOL, "!=", found, x.Value(kind, 0 if kind == x.INT else 0.0))
        if kind.kind in ("list", "map", "set", "str"):
            return x.Builtin(x.BOOL, "some", (found,))
        if kind.kind == "optional" and kind.bare.kind in ("record", "tuple"):
            return x.Comparison(x.BOOL, "is not", found, x.Value(x.NONE, None))
        raise self.refuse(node, f"whether a {kind.kind} is true", "compare it with what you mean")

    def _operation(self, node: m.OpExpr) -> x.Expression:
        if node.op in ("and", "or"):
            kind = self.of(node)
            if kind == x.BOOL:
                parts = []
                for side in (node.left, node.right):
                    one = self.truth(side)
                    same = isinstance(one, x.Logic) and one.operator == node.op
                    parts += list(one.parts) if same and isinstance(one, x.Logic) else [one]
                return x.Logic(x.BOOL, node.op, tuple(parts))
            left, right = self.expression(node.left), self.expression(node.right)
            test = self._true(left, node.left)
            if node.op == "and":
                return x.Either(kind, test, right, left)
            known = (
                x.KnownValue(left.type.bare, left)
                if left.type.kind == "optional" and kind.kind != "optional"
                else left
            )
            return x.Either(kind, test, known, right)
        left, right = self.expression(node.left), self.expression(node.right)
        kind = self.of(node)
        if node.op in ("//", "%") and kind != x.INT:
            raise self.refuse(node, f"{node.op} of numbers with fractions", "use floor")
        if node.op == "+" and kind.kind == "list":
            return x.Gathered(kind, (left, right), frozenset((0, 1)))
        return x.Binary(kind, node.op, left, right)

    def _comparison(self, node: m.ComparisonExpr) -> x.Expression:
        values = self.expressions(node.operands)
        out: list[x.Expression] = []
        for operator, (left, right) in zip(node.operators, pairwise(values), strict=True):
            if operator in ("in", "not in"):
                one: x.Expression = x.Builtin(x.BOOL, "contains", (self.one_by_one(right), left))
                out.append(one if operator == "in" else x.Negated(x.BOOL, "not", one))
            else:
                bare = (
                    [self._unknown(v) for v in (left, right)]
                    if operator in ("is", "is not")
                    else [left, right]
                )
                out.append(x.Comparison(x.BOOL, operator, bare[0], bare[1]))
        return out[0] if len(out) == 1 else x.Logic(x.BOOL, "and", tuple(out))

    def _unknown(self, value: x.Expression) -> x.Expression:
        return value.of if isinstance(value, x.KnownValue) else value

    def _index(self, node: m.IndexExpr) -> x.Expression:
        of = self.expression(node.base)
        if isinstance(node.index, m.SliceExpr):
            if node.index.stride is not None:
                raise self.refuse(node, "a slice with a step", "use reversed, or a range")
            ends = [
                None if e is None else self.expression(e)
                for e in (node.index.begin_index, node.index.end_index)
            ]
            return x.Slice(of.type, of, ends[0], ends[1])
        place = self.expression(node.index)
        if node not in self.source.types and of.type.of:  # what is assigned to has no type of its own
            return x.ItemOf(of.type.of[-1], of, place)
        return x.ItemOf(self.of(node), of, place)

    def _gathered(self, node: m.TupleExpr | m.ListExpr | m.SetExpr) -> x.Expression:
        items, spread = [], set()
        for n, item in enumerate(node.items):
            if isinstance(item, m.StarExpr):
                spread.add(n)
                item = item.expr
            items.append(self.expression(item))
        known = node in self.source.types  # what is taken apart at once has no type as a whole
        kind = self.of(node) if known else x.Type("tuple", tuple(i.type for i in items))
        if kind.kind == "tuple" and (spread or not items):
            kind = x.Type("list", (items[0].type.of[0] if spread and items[0].type.of else x.ANY,))
        if kind.kind == "list" and kind.of and not spread:
            items = [self.fitted(i, kind.of[0]) for i in items]
        return x.Gathered(kind, tuple(items), frozenset(spread))

    def _mapped(self, node: m.DictExpr) -> x.Expression:
        pairs = []
        for key, value in node.items:
            if key is None:
                raise self.refuse(node, "** in a map", "copy it and set what is new")
            pairs.append((self.expression(key), self.expression(value)))
        return x.Mapped(self.of(node), tuple(pairs))

    def _comprehension(
        self, node: m.ListComprehension | m.SetComprehension | m.GeneratorExpr
    ) -> x.Expression:
        if isinstance(node, m.GeneratorExpr):
            made, kind = node, x.Type("list", (self.of(node.left_expr),))
        else:
            made, kind = node.generator, self.of(node)
        clauses = self._clauses(made.sequences, made.indices, made.condlists)
        return x.Comprehension(kind, self.expression(made.left_expr), clauses)

    def _clauses(
        self,
        sequences: Sequence[m.Expression],
        indices: Sequence[m.Expression],
        tests: Sequence[list[m.Expression]],
    ) -> tuple[x.ForClause, ...]:
        return tuple(
            x.ForClause(
                self.names(i), self.one_by_one(self.expression(s)), tuple(self.truth(c) for c in c_all)
            )
            for s, i, c_all in zip(sequences, indices, tests, strict=True)
        )

    def one_by_one(self, over: x.Expression) -> x.Expression:
        """Return what a loop goes over; of a tuple that is written down, a list."""
        if isinstance(over, x.Gathered) and over.type.kind == "tuple":
            return x.Gathered(x.Type("list", over.type.of[:1]), over.items)
        return over

    def names(self, node: m.Expression) -> tuple[x.Local, ...]:
        """Return what a loop gives its items to."""
        items = node.items if isinstance(node, m.TupleExpr) else [node]
        out = []
        for one in items:
            if isinstance(one, m.TupleExpr):
                raise self.refuse(
                    node, "tuples in tuples as what a loop gives", "take them apart in its body"
                )
            assert isinstance(one, m.NameExpr)
            out.append(x.Local(self.declared(one.node, one), one.name))
        return tuple(out)
