"""The small typed tree between Python and the languages: what the printers print.

Values are immutable and hold what they are of: numbers, texts, lists, maps, and records with named fields.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, fields, is_dataclass
from typing import Literal

TypeKind = Literal[
    "int", "bits", "float", "bool", "str", "none", "any", "optional", "list", "tuple", "map", "set", "record",
    "function",
]  # fmt: skip


@dataclass(frozen=True)
class Type:
    """of: the item of a list, set or optional; key and value of a map; a tuple's items; a function's
    arguments and then what it returns. name: a record's class. module: if that is.
    """

    kind: TypeKind
    of: tuple[Type, ...] = ()
    name: str = ""
    module: str = ""

    @property
    def bare(self) -> Type:
        """Without being optional."""
        return self.of[0] if self.kind == "optional" else self


INT, FLOAT, BOOL, STR, NONE, ANY = (Type(k) for k in ("int", "float", "bool", "str", "none", "any"))
BITS = Type("bits")  # 32 of them, without a sign


# --- expressions


@dataclass(frozen=True)
class Expression:
    """type: what it gives."""

    type: Type


@dataclass(frozen=True)
class Value(Expression):
    """A number, a text, True, False or None; infinity as a float."""

    value: object


@dataclass(frozen=True)
class Local(Expression):
    """A parameter or variable."""

    name: str


@dataclass(frozen=True)
class Global(Expression):
    """A constant or function of a module."""

    module: str
    name: str


@dataclass(frozen=True)
class This(Expression):
    """The record whose method this is in."""


@dataclass(frozen=True)
class Member(Expression):
    """A record's field; computed: it is a property, which is worked out."""

    of: Expression
    name: str
    computed: bool = False


@dataclass(frozen=True)
class Call(Expression):
    """A call of a function or, with `Member`, of a method. rest: the last argument is a list of any
    number of them.
    """

    function: Expression
    arguments: tuple[Expression, ...]
    rest: bool = False


@dataclass(frozen=True)
class Builtin(Expression):
    """What the language or its library does, by a name of ours (`operations.py`)."""

    name: str
    arguments: tuple[Expression, ...]


@dataclass(frozen=True)
class New(Expression):
    """A record, all its fields given, in order; defaults at the end left out."""

    arguments: tuple[Expression, ...]


@dataclass(frozen=True)
class Replaced(Expression):
    """A record with some fields changed."""

    of: Expression
    changes: tuple[tuple[str, Expression], ...]


@dataclass(frozen=True)
class Binary(Expression):
    """operator: + - * / // % ** & | ^ << >>."""

    operator: str
    left: Expression
    right: Expression


@dataclass(frozen=True)
class Comparison(Expression):
    """operator: == != < <= > >=, is and is not (only with None)."""

    operator: str
    left: Expression
    right: Expression


@dataclass(frozen=True)
class Logic(Expression):
    """operator: and, or; of truth values only."""

    operator: str
    parts: tuple[Expression, ...]


@dataclass(frozen=True)
class Negated(Expression):
    """operator: not, -."""

    operator: str
    of: Expression


@dataclass(frozen=True)
class Either(Expression):
    """`then if test else other`."""

    test: Expression
    then: Expression
    other: Expression


@dataclass(frozen=True)
class ItemOf(Expression):
    """An item of a list by its place, of a map by its key; -1 the last. Of a tuple by a number."""

    of: Expression
    place: Expression


@dataclass(frozen=True)
class Slice(Expression):
    """A part of a list: from first (None: from the beginning) to before last (None: to the end)."""

    of: Expression
    first: Expression | None
    last: Expression | None


@dataclass(frozen=True)
class Gathered(Expression):
    """A list, set or tuple of items; spread: places of those that are lists whose items are meant."""

    items: tuple[Expression, ...]
    spread: frozenset[int] = frozenset()


@dataclass(frozen=True)
class Mapped(Expression):
    """A map of keys and values."""

    items: tuple[tuple[Expression, Expression], ...]


@dataclass(frozen=True)
class ForClause:
    """`for names in over if all tests`."""

    names: tuple[Local, ...]
    over: Expression
    tests: tuple[Expression, ...]


@dataclass(frozen=True)
class Comprehension(Expression):
    """A list, set or map of items; key: of a map's."""

    item: Expression
    clauses: tuple[ForClause, ...]
    key: Expression | None = None


@dataclass(frozen=True)
class Lambda(Expression):
    names: tuple[Local, ...]
    body: Expression


@dataclass(frozen=True)
class Formatted(Expression):
    """A text of texts and values, each value with how it is written: "" or ".2f"."""

    parts: tuple[str | tuple[Expression, str], ...]


@dataclass(frozen=True)
class KnownValue(Expression):
    """An optional value where it is known to be there."""

    of: Expression


# --- statements


Named = Value | Local | Global | This | KnownValue | Member  # what stands there, or has a name


@dataclass(frozen=True)
class Statement:
    """comments: lines above it. beside: a comment at its end."""

    comments: tuple[str, ...] = field(default=(), kw_only=True)
    beside: str = field(default="", kw_only=True)


@dataclass(frozen=True)
class Declare(Statement):
    """A variable, with or without its first value. changes: it is assigned again later."""

    variable: Local
    value: Expression | None
    changes: bool = True


@dataclass(frozen=True)
class Assign(Statement):
    """operator: "" or that of `+=`."""

    target: Expression
    value: Expression
    operator: str = ""


@dataclass(frozen=True)
class Unpack(Statement):
    """`a, b = value`, of a tuple. new: the variables are declared here. changes: one of them is assigned
    again later.
    """

    targets: tuple[Expression, ...]
    value: Expression
    new: bool
    changes: bool = False


@dataclass(frozen=True)
class Do(Statement):
    value: Expression


@dataclass(frozen=True)
class Return(Statement):
    value: Expression | None


@dataclass(frozen=True)
class Raise(Statement):
    message: Expression


@dataclass(frozen=True)
class Leave(Statement):
    """word: break, continue."""

    word: str


@dataclass(frozen=True)
class If(Statement):
    test: Expression
    then: tuple[Statement, ...]
    other: tuple[Statement, ...]


@dataclass(frozen=True)
class While(Statement):
    test: Expression
    body: tuple[Statement, ...]


@dataclass(frozen=True)
class ForEach(Statement):
    """names: of an item, or of a tuple's items."""

    names: tuple[Local, ...]
    over: Expression
    body: tuple[Statement, ...]


# --- what a module holds


@dataclass(frozen=True)
class Parameter:
    """rest: it takes all arguments that are left, as a list."""

    name: str
    type: Type
    default: Expression | None = None
    rest: bool = False


@dataclass(frozen=True)
class Function:
    """public: others may call it. property: a method that is read as a field is."""

    name: str
    parameters: tuple[Parameter, ...]
    returns: Type
    body: tuple[Statement, ...]
    about: str
    public: bool
    property: bool = False
    comments: tuple[str, ...] = ()


@dataclass(frozen=True)
class Constant:
    name: str
    value: Expression
    public: bool
    beside: str = ""
    comments: tuple[str, ...] = ()


@dataclass(frozen=True)
class RecordClass:
    """A class of fields and methods. changes: its fields are assigned to; else it is a value."""

    name: str
    fields: tuple[Parameter, ...]
    methods: tuple[Function, ...]
    about: str
    changes: bool


@dataclass(frozen=True)
class Module:
    """name: of the Python module, dotted. parts: in order."""

    name: str
    about: str
    parts: tuple[Constant | RecordClass | Function, ...]

    @property
    def word(self) -> str:
        """The last part of its name."""
        return self.name.rpartition(".")[2]


def walk(node: object) -> Iterator[Expression | Statement]:
    """Yield every expression and statement in a piece of tree, itself first."""
    if isinstance(node, tuple):
        for one in node:
            yield from walk(one)
        return
    kind = type(node)
    names = _HELD.get(kind)
    if names is None:
        names = ()
        if is_dataclass(node) and not isinstance(node, Type):
            names = tuple(f.name for f in fields(node))
        _HELD[kind] = names
    if names and isinstance(node, Expression | Statement):
        yield node
    for name in names:
        yield from walk(getattr(node, name))


_HELD: dict[type, tuple[str, ...]] = {}  # what a piece of tree of a class has pieces in
