"""Where variables are declared: at their first value, or before the innermost block that holds
all their uses.

Python's variables belong to their function; most languages' to a block.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterator, Sequence
from dataclasses import fields, is_dataclass, replace

from metagraph.engines.translation import tree as x


def declare_variables(body: Sequence[x.Statement], parameters: Collection[str]) -> tuple[x.Statement, ...]:
    """Return a function's statements with its variables declared."""
    times: Counter[str] = Counter()
    for node in x.walk(tuple(body)):
        if isinstance(node, x.Assign) and isinstance(node.target, x.Local):
            times[node.target.name] += 1
        elif isinstance(node, x.Unpack):
            times.update(t.name for t in node.targets if isinstance(t, x.Local))
    return _block(body, set(parameters), times)


def _block(body: Sequence[x.Statement], known: set[str], times: Counter[str]) -> tuple[x.Statement, ...]:
    known = set(known)
    out: list[x.Statement] = []
    for n, node in enumerate(body):
        match node:
            case x.Assign(target=x.Local() as target, operator="") if target.name not in known:
                known.add(target.name)
                changes = times[target.name] > 1
                out.append(x.Declare(target, node.value, changes, comments=node.comments, beside=node.beside))
            case x.Unpack():
                new = [isinstance(t, x.Local) and t.name not in known for t in node.targets]
                if all(new):
                    again = any(isinstance(t, x.Local) and times[t.name] > 1 for t in node.targets)
                    out.append(replace(node, new=True, changes=again))
                else:
                    out += [
                        x.Declare(t, None)
                        for t, is_new in zip(node.targets, new, strict=True)
                        if is_new and isinstance(t, x.Local)
                    ]
                    out.append(node)
                known |= {t.name for t in node.targets if isinstance(t, x.Local)}
            case x.If() | x.While() | x.ForEach():
                later = {local.name for local in _free(tuple(body[n + 1 :]))}
                bound = {name.name for name in node.names} if isinstance(node, x.ForEach) else set()
                early: dict[str, x.Local] = {}
                for local in _given(node):
                    # In a loop what is read before it is written comes from the round before.
                    if local.name not in known | bound and (
                        local.name in later or _carried(node, local.name)
                    ):
                        early[local.name] = local
                out += [x.Declare(local, None) for local in early.values()]
                known |= set(early)
                inner = known | bound
                if isinstance(node, x.If):
                    out.append(
                        replace(
                            node, then=_block(node.then, inner, times), other=_block(node.other, inner, times)
                        )
                    )
                else:
                    out.append(replace(node, body=_block(node.body, inner, times)))
            case _:
                out.append(node)
    return tuple(out)


def _given(node: object) -> Iterator[x.Local]:
    """Yield the variables that statements give a value to."""
    for one in x.walk(node):
        if isinstance(one, x.Assign) and isinstance(one.target, x.Local):
            yield one.target
        elif isinstance(one, x.Unpack):
            yield from (t for t in one.targets if isinstance(t, x.Local))


def _carried(node: x.If | x.While | x.ForEach, name: str) -> bool:
    """Whether a loop reads a variable before it gives it a value."""
    if isinstance(node, x.If):
        return False
    for one in node.body:
        if isinstance(one, x.Assign) and isinstance(one.target, x.Local) and one.target.name == name:
            return any(local.name == name for local in _free(one.value))
        if any(local.name == name for local in _free(one)):
            return not any(local.name == name for local in _given(one))
    return False


def _free(node: object, bound: frozenset[str] = frozenset()) -> Iterator[x.Local]:
    """Yield the variables in a piece of tree but those that comprehensions and lambdas bring themselves."""
    if isinstance(node, tuple):
        for one in node:
            yield from _free(one, bound)
    elif isinstance(node, x.Local):
        if node.name not in bound:
            yield node
    elif isinstance(node, x.Comprehension):
        inner = bound | {n.name for c in node.clauses for n in c.names}
        yield from _free(node.clauses[0].over, bound)
        for f in fields(node):
            yield from _free(getattr(node, f.name), inner)
    elif isinstance(node, x.Lambda):
        yield from _free(node.body, bound | {n.name for n in node.names})
    elif is_dataclass(node) and not isinstance(node, x.Type):
        for f in fields(node):
            yield from _free(getattr(node, f.name), bound)
