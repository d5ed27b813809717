"""From Python, as mypy has understood it, to the small typed tree.

mypy gives the type of every expression, which languages with types need and which says what a `+` or an
`in` means. What is outside the subset is refused with its place and a remedy.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from mypy import nodes as m
from mypy import types as t
from mypy.types import get_proper_type

from metagraph.engines.translation import tree as x
from metagraph.engines.translation.lowering_expressions import Expressions
from metagraph.engines.translation.scoping import declare_variables
from metagraph.engines.translation.source import SourceModule, list_defined, unwrap_docstring
from metagraph.engines.translation.typed import BITS


def convert_module(source: SourceModule) -> x.Module:
    """Return a module in the small tree. Raises SubsetError for what is outside the subset."""
    return _Lowering(source).module()


class _Lowering(Expressions):
    """One module being translated: what it holds."""

    def module(self) -> x.Module:
        parts: list[x.Constant | x.RecordClass | x.Function] = []
        last = 0
        for node in self.source.tree.defs:
            above = self.above(last, node.line)
            last = node.end_line or node.line
            if self.source.only and not set(list_defined(node)) & set(self.source.only):
                continue
            if isinstance(node, m.FuncDef):
                parts.append(self._function(node, above))
            elif isinstance(node, m.Decorator):
                raise self.refuse(node, "functions of a module have no decorators", "leave it out")
            elif isinstance(node, m.ClassDef):
                parts.append(self._record(node))
            elif isinstance(node, m.AssignmentStmt):
                found = self._constant(node, above)
                parts += [] if found is None else [found]
            elif not isinstance(node, m.Import | m.ImportFrom | m.ExpressionStmt | m.IfStmt):
                raise self.refuse(
                    node, f"{type(node).__name__} at a module's level", "have constants, records, functions"
                )
        return x.Module(self.name, unwrap_docstring(self.source.tree.defs), tuple(parts))

    def _constant(self, node: m.AssignmentStmt, above: tuple[str, ...]) -> x.Constant | None:
        (target,) = node.lvalues
        if (
            node.is_alias_def
            or isinstance(node.rvalue, m.TypeAliasExpr)
            or not isinstance(target, m.NameExpr)
        ):
            return None
        if isinstance(target.node, m.TypeAlias):
            return None
        value = self.fitted(self.expression(node.rvalue), self.declared(target.node, node))
        beside = self.source.beside.get(node.end_line or node.line, "")
        return x.Constant(target.name, value, not target.name.startswith("_"), beside, above)

    def _record(self, node: m.ClassDef) -> x.RecordClass:
        fields, methods = [], []
        self.owner = node.info
        for one in node.defs.body:
            if isinstance(one, m.AssignmentStmt) and isinstance(one.lvalues[0], m.NameExpr):
                name = one.lvalues[0]
                kind = self.declared(name.node, one)
                if isinstance(one.unanalyzed_type, t.UnboundType) and one.unanalyzed_type.name == BITS:
                    kind = x.BITS
                given = None if isinstance(one.rvalue, m.TempNode) else self.default(one.rvalue, kind)
                fields.append(x.Parameter(name.name, kind, given))
            elif isinstance(one, m.FuncDef):
                native = f"{node.name}.{one.name}" in self.source.without
                if (
                    not one.name.startswith("__") and not native
                ):  # records are checked where Python makes them
                    methods.append(self._function(one, ()))
            elif isinstance(one, m.Decorator):
                if one.func.name.startswith("__") or f"{node.name}.{one.func.name}" in self.source.without:
                    continue
                names = [d.name for d in one.original_decorators if isinstance(d, m.NameExpr)]
                if names != ["property"]:
                    raise self.refuse(one, "a decorator other than property", "make it a function")
                methods.append(self._function(one.func, (), is_property=True))
            elif not isinstance(one, m.ExpressionStmt | m.PassStmt):
                raise self.refuse(one, f"{type(one).__name__} in a class", "have fields and methods only")
        self.owner = None
        frozen = any(
            isinstance(d, m.CallExpr) and "frozen" in d.arg_names for d in node.decorators
        )  # @dataclass(frozen=True)
        return x.RecordClass(
            node.name, tuple(fields), tuple(methods), unwrap_docstring(node.defs.body), not frozen
        )

    def _function(self, node: m.FuncDef, above: tuple[str, ...], is_property: bool = False) -> x.Function:
        if node.is_generator or node.is_coroutine:
            raise self.refuse(node, f"'{node.name}' yields or awaits", "return a list")
        kind = get_proper_type(node.type)
        if not isinstance(kind, t.CallableType):
            raise self.refuse(node, f"'{node.name}' has no types", "say them")
        parameters = []
        written = node.unanalyzed_type
        assert isinstance(written, t.CallableType)
        for argument, argument_type, argument_kind, said in zip(
            node.arguments, kind.arg_types, node.arg_kinds, written.arg_types, strict=True
        ):
            name = argument.variable.name
            if name == "self":
                continue
            of = self.type(argument_type, node)
            if isinstance(said, t.UnboundType) and said.name == BITS:
                of = x.BITS
            if argument_kind is m.ARG_STAR:
                of = x.Type("list", (of,))
            elif argument_kind is m.ARG_STAR2:
                raise self.refuse(node, "** arguments", "name them")
            default = (
                None
                if argument.initializer is None
                else self.fitted(self.expression(argument.initializer), of)
            )
            parameters.append(x.Parameter(name, of, default, argument_kind is m.ARG_STAR))
        body = declare_variables(_Body(self, node).statements(), [p.name for p in parameters])
        back = written.ret_type
        returns = (
            x.BITS
            if isinstance(back, t.UnboundType) and back.name == BITS
            else self.type(kind.ret_type, node)
        )
        public = not node.name.startswith("_")
        return x.Function(
            node.name,
            tuple(parameters),
            returns,
            body,
            unwrap_docstring(node.body.body),
            public,
            is_property,
            above,
        )

    def above(self, last: int, line: int) -> tuple[str, ...]:
        return tuple(self.source.alone[n] for n in range(last + 1, line) if n in self.source.alone)


class _Body:
    """The statements of one function, its variables not declared yet (`scoping.py`)."""

    def __init__(self, lowering: _Lowering, function: m.FuncDef) -> None:
        self.lowering, self.function = lowering, function
        kind = get_proper_type(function.type)
        assert isinstance(kind, t.CallableType)
        self.returns = lowering.type(kind.ret_type, function)

    def statements(self) -> tuple[x.Statement, ...]:
        body = self.function.body.body
        if unwrap_docstring(body):
            body = body[1:]
        return self.block(body, self.function.line)

    def block(self, body: Sequence[m.Statement], last: int) -> tuple[x.Statement, ...]:
        out: list[x.Statement] = []
        for node in body:
            above = self.lowering.above(last, node.line)
            ends = node.line if isinstance(node, m.IfStmt | m.WhileStmt | m.ForStmt) else node.end_line
            beside = self.lowering.source.beside.get(ends or node.line, "")
            last = node.end_line or node.line
            found = self.statement(node)
            if found and above:
                found[0] = replace(found[0], comments=above)
            if found and beside:
                found[-1] = replace(found[-1], beside=beside)
            out += found
        return tuple(out)

    def statement(self, node: m.Statement) -> list[x.Statement]:
        low = self.lowering
        match node:
            case m.AssignmentStmt():
                return self._assignment(node)
            case m.OperatorAssignmentStmt():
                entry = node.lvalue
                if isinstance(entry, m.IndexExpr) and low.expression(entry.base).type.kind == "map":
                    raise low.refuse(node, "a change of a map's entry in place", "assign the entry anew")
                target, value = low.expression(node.lvalue), low.expression(node.rvalue)
                if target.type.kind == "list":
                    return [x.Do(x.Builtin(x.NONE, "list_extend", (target, value)))]
                return [x.Assign(target, low.fitted(value, target.type), node.op)]
            case m.ExpressionStmt():
                return [x.Do(low.expression(node.expr))]
            case m.ReturnStmt():
                return [
                    x.Return(
                        None if node.expr is None else low.fitted(low.expression(node.expr), self.returns)
                    )
                ]
            case m.RaiseStmt():
                assert isinstance(node.expr, m.CallExpr)
                return [x.Raise(low.expression(node.expr.args[0]))]
            case m.BreakStmt():
                return [x.Leave("break")]
            case m.ContinueStmt():
                return [x.Leave("continue")]
            case m.PassStmt():
                return []
            case m.IfStmt():
                other = () if node.else_body is None else self.block(node.else_body.body, node.else_body.line)
                return [x.If(low.truth(node.expr[0]), self.block(node.body[0].body, node.line), other)]
            case m.WhileStmt():
                return [x.While(low.truth(node.expr), self.block(node.body.body, node.line))]
            case m.ForStmt():
                names, over = low.names(node.index), low.one_by_one(low.expression(node.expr))
                return [x.ForEach(names, over, self.block(node.body.body, node.line))]
        raise low.refuse(node, f"{type(node).__name__} is outside the subset", "write it with simpler means")

    def _assignment(self, node: m.AssignmentStmt) -> list[x.Statement]:
        low = self.lowering
        if len(node.lvalues) != 1:
            raise low.refuse(node, "two targets of one value", "assign them one by one")
        (target,) = node.lvalues
        if isinstance(target, m.TupleExpr):
            return self._unpacked(node, target)
        goal = self._goal(target)
        return [x.Assign(goal, low.fitted(low.expression(node.rvalue), goal.type))]

    def _goal(self, target: m.Expression) -> x.Expression:
        """Return what is assigned to, as what it may hold."""
        if isinstance(target, m.NameExpr):
            return x.Local(self.lowering.declared(target.node, target), target.name)
        found = self.lowering.expression(target)
        return found.of if isinstance(found, x.KnownValue) else found

    def _unpacked(self, node: m.AssignmentStmt, target: m.TupleExpr) -> list[x.Statement]:
        """`a, b = 1, a` becomes one assignment after another where none reads what one before it wrote."""
        low = self.lowering
        goals = [self._goal(item) for item in target.items]
        if isinstance(node.rvalue, m.TupleExpr) and len(node.rvalue.items) == len(goals):
            values = low.expressions(node.rvalue.items)
            written = [{e for e in x.walk(g) if isinstance(e, x.Local | x.Member)} for g in goals]
            read = [{e for e in x.walk(v) if isinstance(e, x.Local | x.Member)} for v in values]
            if not any(written[k] & read[n] for n in range(len(goals)) for k in range(n)):
                return [x.Assign(g, low.fitted(v, g.type)) for g, v in zip(goals, values, strict=True)]
        return [x.Unpack(tuple(goals), low.expression(node.rvalue), False)]
