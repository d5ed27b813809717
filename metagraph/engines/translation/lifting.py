"""Comprehensions, lambdas and searches as loops, for languages that have none of them.

What is only looked at where something else allows it (`a and any(...)`) stays so.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields, replace
from typing import Any

from metagraph.engines.translation import tree as x

SEARCHES = ("any", "all", "first", "first_or")


def lift_comprehensions(function: x.Function) -> x.Function:
    """Return a function without comprehensions and lambdas."""
    return replace(function, body=_Lifting(function).block(function.body))


class _Lifting:
    def __init__(self, function: x.Function) -> None:
        self.taken = {p.name for p in function.parameters}
        self.taken |= {n.name for n in x.walk(function.body) if isinstance(n, x.Local)}
        self.bound = {p.name for p in function.parameters}
        for n in x.walk(function.body):
            if isinstance(n, x.Declare):
                self.bound.add(n.variable.name)
            elif isinstance(n, x.ForEach):
                self.bound |= {name.name for name in n.names}
            elif isinstance(n, x.Unpack):
                self.bound |= {t.name for t in n.targets if isinstance(t, x.Local)}

    def fresh(self, name: str, kind: x.Type) -> x.Local:
        found, n = name, 1
        while found in self.taken:
            n += 1
            found = f"{name}{n}"
        self.taken.add(found)
        return x.Local(kind, found)

    # --- statements

    def block(self, body: Sequence[x.Statement]) -> tuple[x.Statement, ...]:
        out: list[x.Statement] = []
        for node in body:
            out += self.statement(node)
        return tuple(out)

    def statement(self, node: x.Statement) -> list[x.Statement]:
        match node:
            case x.Declare(value=x.Comprehension() as made, variable=variable):
                return self._led(self.gathering(made, variable), node)
            case x.Do(value=x.Builtin(name="insort") as call):
                return self._led(self.inserting(call), node)
            case x.While():
                before, test = self.lift(node.test)
                if not before:
                    return [replace(node, test=test, body=self.block(node.body))]
                stop = x.If(x.Negated(x.BOOL, "not", test), (x.Leave("break"),), ())
                true = x.Value(x.BOOL, True)
                return [replace(node, test=true, body=(*before, stop, *self.block(node.body)))]
            case x.If():
                before, test = self.lift(node.test)
                done = replace(node, test=test, then=self.block(node.then), other=self.block(node.other))
                return self._led([*before, done], node)
            case x.ForEach():
                before, over = self.lift(node.over)
                return self._led([*before, replace(node, over=over, body=self.block(node.body))], node)
        before = []
        changes: dict[str, Any] = {}
        for f in fields(node):
            value = getattr(node, f.name)
            if isinstance(value, x.Expression):
                found, changes[f.name] = self.lift(value)
                before += found
        return self._led([*before, replace(node, **changes)], node)

    def _led(self, made: list[x.Statement], node: x.Statement) -> list[x.Statement]:
        """Give a statement's comments to the first of those it became."""
        if len(made) > 1 and node.comments:
            made = [
                replace(made[0], comments=node.comments),
                *(replace(s, comments=()) if s.comments == node.comments else s for s in made[1:]),
            ]
        return made

    # --- expressions

    def lift(self, node: x.Expression) -> tuple[list[x.Statement], x.Expression]:
        """Return what comes before an expression, and what is left of it."""
        match node:
            case x.Comprehension():
                made = self.fresh("found", node.type)
                return self.gathering(node, made), made
            case x.Builtin(name=name, arguments=(x.Comprehension() as found, *_)) if name in SEARCHES:
                return self.searching(node, found)
            case x.Builtin(name="sorted_by"):
                return self.sorting(node)
            case x.Logic():
                return self.logic(node)
            case x.Either():
                before, test = self.lift(node.test)
                then, other = self.lift(node.then), self.lift(node.other)
                if not then[0] and not other[0]:
                    return before, replace(node, test=test, then=then[1], other=other[1])
                made = self.fresh("either", node.type)
                chosen = x.If(
                    test, (*then[0], x.Assign(made, then[1])), (*other[0], x.Assign(made, other[1]))
                )
                return [*before, x.Declare(made, None), chosen], made
        before = []
        changes: dict[str, Any] = {}
        for f in fields(node):
            value = getattr(node, f.name)
            if isinstance(value, x.Expression):
                found_, changes[f.name] = self.lift(value)
                before += found_
            elif isinstance(value, tuple):
                changes[f.name] = tuple(self.inner(v, before) for v in value)
        return before, replace(node, **changes)

    def inner(self, value: object, before: list[x.Statement]) -> object:
        if isinstance(value, x.Expression):
            found, out = self.lift(value)
            before += found
            return out
        if isinstance(value, tuple):
            return tuple(self.inner(v, before) for v in value)
        return value

    def logic(self, node: x.Logic) -> tuple[list[x.Statement], x.Expression]:
        parts = [self.lift(p) for p in node.parts]
        if not any(before for before, _ in parts):
            return [], replace(node, parts=tuple(p for _, p in parts))
        last = max(n for n, (before, _) in enumerate(parts) if before)
        if last == 0:
            return parts[0][0], replace(node, parts=tuple(p for _, p in parts))
        made = self.fresh("holds", x.BOOL)
        first = [p for _, p in parts[: next(n for n, (b, _) in enumerate(parts) if b) or 1]]
        out: list[x.Statement] = [*parts[0][0]] if len(first) == 1 else []
        out.append(
            x.Declare(made, first[0] if len(first) == 1 else x.Logic(x.BOOL, node.operator, tuple(first)))
        )
        for before, part in parts[len(first) :]:
            test = made if node.operator == "and" else x.Negated(x.BOOL, "not", made)
            out.append(x.If(test, (*before, x.Assign(made, part)), ()))
        return out, made

    def gathering(self, node: x.Comprehension, made: x.Local) -> list[x.Statement]:
        """A list, set or map as a loop that adds to it."""
        empty: x.Expression = (
            x.Mapped(node.type, ()) if node.type.kind == "map" else x.Gathered(node.type, ())
        )
        if node.key is not None:
            add: x.Statement = x.Assign(x.ItemOf(node.item.type, made, node.key), node.item)
        else:
            word = "set_add" if node.type.kind == "set" else "list_append"
            add = x.Do(x.Builtin(x.NONE, word, (made, node.item)))
        return [x.Declare(made, empty), *self.looped(node.clauses, [add])]

    def looped(self, clauses: Sequence[x.ForClause], inner: Sequence[x.Statement]) -> list[x.Statement]:
        clause, *rest = clauses
        body: Sequence[x.Statement] = self.looped(rest, inner) if rest else inner
        if clause.tests:
            test = clause.tests[0] if len(clause.tests) == 1 else x.Logic(x.BOOL, "and", clause.tests)
            body = [x.If(test, tuple(body), ())]
        names, renamed = [], {}
        for name in clause.names:
            new = self.fresh(name.name, name.type) if name.name in self.bound else name
            names.append(new)
            renamed[name.name] = new.name
        loop = x.ForEach(tuple(names), clause.over, tuple(_renamed(tuple(body), renamed)))
        return self.statement(loop)

    def searching(self, node: x.Builtin, found: x.Comprehension) -> tuple[list[x.Statement], x.Expression]:
        """any, all and next as a loop that ends early."""
        if node.name in ("any", "all"):
            made = self.fresh("is_any" if node.name == "any" else "are_all", x.BOOL)
            begin = x.Value(x.BOOL, node.name == "all")
            test = found.item if node.name == "any" else x.Negated(x.BOOL, "not", found.item)
            stop: list[x.Statement] = [
                x.If(test, (x.Assign(made, x.Value(x.BOOL, node.name == "any")), x.Leave("break")), ())
            ]
            return [x.Declare(made, begin), *self.looped(found.clauses, stop)], made
        made = self.fresh("first", node.type)
        begin_ = node.arguments[1] if node.name == "first_or" else x.Value(x.NONE, None)
        before, other = self.lift(begin_)
        stop = [x.Assign(made, found.item), x.Leave("break")]
        return [*before, x.Declare(made, other), *self.looped(found.clauses, stop)], made

    def sorting(self, node: x.Builtin) -> tuple[list[x.Statement], x.Expression]:
        """An order by keys that are worked out before."""
        before, of = self.lift(node.arguments[0])
        item, key = self.keyed(node.arguments[1], node.type.of[0])
        keys = self.fresh("keys", x.Type("list", (key.type,)))
        made = self.gathering(x.Comprehension(keys.type, key, (x.ForClause((item,), of, ()),)), keys)
        return [*before, *made], x.Builtin(node.type, "sorted_by_keys", (of, keys))

    def keyed(self, key: x.Expression, item: x.Type) -> tuple[x.Local, x.Expression]:
        """Return what a key function calls an item, and what it gives."""
        if isinstance(key, x.Lambda):
            return key.names[0], key.body
        name = x.Local(item, "item")
        return name, x.Call(key.type.of[-1] if key.type.of else x.ANY, key, (name,))

    def inserting(self, node: x.Builtin) -> list[x.Statement]:
        """Put something into an ordered list, behind what is alike."""
        of, item, low, key = node.arguments
        name, made = self.keyed(key, item.type)

        def of_item(one: x.Expression) -> x.Expression:
            return _put(made, name.name, one)

        place = self.fresh("place", x.INT)
        own = self.fresh("own", made.type)
        last = x.ItemOf(item.type, of, x.Binary(x.INT, "-", place, x.Value(x.INT, 1)))
        inside = x.Comparison(x.BOOL, ">", place, low)
        before = x.Builtin(x.BOOL, "less", (own, of_item(last)))
        step = x.Assign(place, x.Value(x.INT, 1), "-")
        return [  # from the end on: most are the latest
            x.Declare(own, of_item(item)),
            x.Declare(place, x.Builtin(x.INT, "len", (of,))),
            x.While(x.Logic(x.BOOL, "and", (inside, before)), (step,)),
            x.Do(x.Builtin(x.NONE, "list_insert", (of, place, item))),
        ]


def _renamed(node: Any, names: dict[str, str]) -> Any:
    """Return a piece of tree in which local names are others."""
    return _mapped(
        node, lambda n: replace(n, name=names.get(n.name, n.name)) if isinstance(n, x.Local) else n
    )


def _put(node: x.Expression, name: str, value: x.Expression) -> x.Expression:
    out: x.Expression = _mapped(node, lambda n: value if isinstance(n, x.Local) and n.name == name else n)
    return out


def _mapped(node: Any, change: Any) -> Any:
    if isinstance(node, tuple):
        return tuple(_mapped(n, change) for n in node)
    if isinstance(node, x.Expression | x.Statement | x.ForClause):
        values = {f.name: _mapped(getattr(node, f.name), change) for f in fields(node)}
        return change(replace(node, **values))
    return node
