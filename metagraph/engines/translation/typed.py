"""What mypy's types are in the small tree."""

from __future__ import annotations

from mypy import nodes as m
from mypy import types as t
from mypy.types import get_proper_type

from metagraph.engines.translation import tree as x
from metagraph.engines.translation.source import SourceModule, SubsetError

BITS = "Bits"  # `hashing.Bits`: mypy takes it for what it stands for
LISTS = (
    "builtins.list", "builtins.tuple", "builtins.bytes", "typing.Sequence", "typing.Iterable",
    "typing.Iterator",
    "typing.Collection", "typing.Generator", "typing.Reversible", "builtins.range", "builtins.reversed",
    "builtins.enumerate", "builtins.zip", "_collections_abc.dict_keys", "_collections_abc.dict_values",
    "_collections_abc.dict_items", "typing.KeysView", "typing.ValuesView", "typing.ItemsView",
)  # fmt: skip
MAPS = ("builtins.dict", "typing.Mapping", "typing.MutableMapping")
SETS = ("builtins.set", "builtins.frozenset", "typing.AbstractSet")


# Values of several types, and maps, that each runtime has a record of its own for.
SPOT = x.Type("record", (), "Spot", "metagraph.playback.life.spots")  # a name or a point
VOICES = x.Type("record", (), "Voices", "metagraph.playback.life.voice")  # of lines, by their ids


class Typed:
    """One module being translated: its types."""

    def __init__(self, source: SourceModule) -> None:
        self.source = source
        self.name = source.tree.fullname
        self.owner: m.TypeInfo | None = None  # the record whose method is translated

    def refuse(self, node: m.Context, cause: str, remedy: str) -> SubsetError:
        return SubsetError(f"{self.source.path}, line {node.line}: {cause}; {remedy}")

    def type(self, of: t.Type | None, node: m.Context) -> x.Type:
        kind = get_proper_type(of)
        match kind:
            case None | t.AnyType() | t.UninhabitedType():
                return x.ANY
            case t.NoneType():
                return x.NONE
            case t.LiteralType():
                return self.type(kind.fallback, node)
            case t.UnionType():
                rest = [
                    self.type(i, node) for i in kind.items if not isinstance(get_proper_type(i), t.NoneType)
                ]
                same = list(dict.fromkeys(rest))
                if set(same) == {x.INT, x.FLOAT}:
                    same = [x.FLOAT]
                if set(same) == {x.STR, x.Type("list", (x.FLOAT,))}:
                    same = [SPOT]
                if len(same) > 1 and all(s.kind == "list" for s in same):
                    same = [s for s in same if s.of != (x.ANY,)][:1]
                if len(same) != 1:
                    raise self.refuse(node, f"'{kind}' is of several types", "have one, or one and None")
                return same[0] if len(rest) == len(kind.items) else x.Type("optional", (same[0].bare,))
            case t.TupleType():
                items = tuple(self.type(i, node) for i in kind.items)
                return x.Type("tuple", items)
            case t.CallableType():
                return x.Type("function", tuple(self.type(a, node) for a in (*kind.arg_types, kind.ret_type)))
            case t.Instance():
                return self._instance(kind, node)
        raise self.refuse(node, f"the type '{kind}'", "use numbers, texts, lists, maps, records")

    def _instance(self, kind: t.Instance, node: m.Context) -> x.Type:
        full = kind.type.fullname
        plain = {
            "builtins.int": x.INT,
            "builtins.float": x.FLOAT,
            "builtins.bool": x.BOOL,
            "builtins.str": x.STR,
        }
        if full in plain:
            return plain[full]
        of = tuple(self.type(a, node) for a in kind.args)
        if full in LISTS:
            pairs = ("enumerate", "items", "ItemsView")
            return x.Type("list", of[:1] if not full.endswith(pairs) else (x.Type("tuple", (x.INT, *of)),))
        if full in MAPS:
            return VOICES if of[1].name == "Voice" else x.Type("map", of[:2])
        if full in SETS:
            return x.Type("set", of[:1])
        if full.startswith(("builtins.", "typing.")):
            return x.ANY
        module, _, name = full.rpartition(".")
        return x.Type("record", (), name, module)

    def of(self, node: m.Expression) -> x.Type:
        """Return the type of an expression where it stands."""
        found = self.source.types.get(node)
        if found is None:
            raise self.refuse(node, "mypy does not know its type", "say it")
        return self.type(found, node)

    def declared(self, node: m.SymbolNode | None, context: m.Context) -> x.Type:
        if isinstance(node, m.Var) and node.type is not None:
            return self.type(node.type, context)
        raise self.refuse(context, "a name without a type", "say it")

    def info(self, node: m.Expression) -> m.TypeInfo | None:
        kind = get_proper_type(self.source.types.get(node))
        if isinstance(kind, t.UnionType):
            kind = next((k for i in kind.items if isinstance(k := get_proper_type(i), t.Instance)), None)
        return kind.type if isinstance(kind, t.Instance) else None
