"""Dataclasses that are made quickly.

`dataclasses.dataclass` writes each method of a class as text and compiles it at once: half a millisecond for
a frozen class, and nearly two hundred are made before the window's first picture, few of which have a value
by then, and most of those a single one. Here what has to be quick when it is called often is compiled when it
is, and the rest is shared.
The class is one of `dataclasses` all the same, to `fields`, `replace`, `asdict`, and to whoever checks types.
What is rare (a base that is a dataclass, fields given by keyword alone or not given at all) is left to
`dataclasses`.
"""

# ruff: noqa: N807  # functions that become methods of Python's own names

from __future__ import annotations

import dataclasses
import inspect
import sys
from collections.abc import Callable, Collection, Iterable
from types import MemberDescriptorType as Slot
from typing import TYPE_CHECKING, Any, cast

FEW = 8  # values of a class that are made without anything compiled
_FACTORY = dataclasses._HAS_DEFAULT_FACTORY  # type: ignore[attr-defined]  # what signatures show


def _text(
    fields: tuple[dataclasses.Field[Any], ...], frozen: bool, slots: Collection[str], post_init: bool
) -> str:
    """Return the source of a function that makes what is called often, as `dataclasses` would write it.
    slots: names of fields that have one each, which is written to straight away.
    """
    heads, body, puts = ["self"], [], []
    for f in fields:
        value = f.name
        if f.default_factory is not dataclasses.MISSING:
            heads.append(f"{f.name}=_factory")
            value = f"_of[{f.name!r}].default_factory() if {f.name} is _factory else {f.name}"
        elif f.default is not dataclasses.MISSING:
            heads.append(f"{f.name}=_of[{f.name!r}].default")
        else:
            heads.append(f.name)
        if not frozen:
            body.append(f"self.{f.name} = {value}")
        elif f.name in slots:
            puts.append(f" _put_{f.name} = _slots[{f.name!r}].__set__")
            body.append(f"_put_{f.name}(self, {value})")
        else:
            body.append(f"_set(self, {f.name!r}, {value})")
    if post_init:
        body.append("self.__post_init__()")
    compared = [f.name for f in fields if f.compare]
    hashed = [f.name for f in fields if (f.compare if f.hash is None else f.hash)]
    return "\n".join(
        [
            "def _make(_of, _set, _slots, _factory):",
            *puts,
            f" def __init__({', '.join(heads)}):",
            *(f"  {line}" for line in body or ["pass"]),
            " def __eq__(self, other):",
            "  if other.__class__ is self.__class__:",
            f"   return {_tuple('self', compared)} == {_tuple('other', compared)}",
            "  return NotImplemented",
            " def __hash__(self):",
            f"  return hash({_tuple('self', hashed)})",
            " return __init__, __eq__, __hash__",
        ]
    )


def _tuple(of: str, names: list[str]) -> str:
    return f"({''.join(f'{of}.{name},' for name in names)})"


def _fills(self: Any, fields: tuple[dataclasses.Field[Any], ...], given: Any, named: dict[str, Any]) -> bool:
    """Give a new value its fields without anything compiled. Return whether that was possible: what is given
    wrongly is not.
    """
    values = {f.name: value for f, value in zip(fields, given, strict=False)}
    none = dataclasses.MISSING
    lacking = [f for f in fields if f.name not in values and f.name not in named]
    if (
        len(given) > len(fields)
        or values.keys() & named.keys()
        or len(values) + len(named) + len(lacking) > len(fields)
    ):
        return False
    if any(f.default is none and f.default_factory is none for f in lacking):
        return False
    values |= named
    for f in fields:
        if f.name in values:
            value = values[f.name]
        else:
            value = f.default if f.default_factory is none else f.default_factory()
        object.__setattr__(self, f.name, value)
    if hasattr(self, "__post_init__"):
        self.__post_init__()
    return True


def _waiting(cls: type, frozen: bool) -> dict[str, Any]:
    """Return what stands for the methods that are compiled: whichever is called first has all compiled."""
    stubs: dict[str, Any] = {}
    fields = dataclasses.fields(cls)
    made_by_hand = 0

    def compiled(name: str) -> Any:
        if vars(cls).get(name) is stubs[name]:
            made: dict[str, Any] = {}
            of = {f.name: f for f in fields}
            slots = {name: slot for name, slot in vars(cls).items() if name in of and isinstance(slot, Slot)}
            text = _text(fields, frozen, slots, hasattr(cls, "__post_init__"))
            exec(text, vars(sys.modules[cls.__module__]), made)
            methods = made["_make"](of, object.__setattr__, slots, _FACTORY)
            for method in methods:
                stub = stubs[method.__name__]
                method.__qualname__, method.__annotations__ = stub.__qualname__, stub.__annotations__
                if vars(cls).get(method.__name__) is stub:
                    setattr(cls, method.__name__, method)
        return getattr(cls, name)

    def __init__(self: Any, /, *given: Any, **named: Any) -> None:
        nonlocal made_by_hand
        made_by_hand += 1
        if made_by_hand > FEW or not _fills(self, fields, given, named):
            compiled("__init__")(self, *given, **named)

    def __eq__(self: Any, other: object) -> Any:
        return compiled("__eq__")(self, other)

    def __hash__(self: Any) -> Any:
        return compiled("__hash__")(self)

    stubs.update(__init__=__init__, __eq__=__eq__, __hash__=__hash__)
    __init__.__annotations__ = {**{f.name: f.type for f in fields}, "return": None}
    return stubs


def _guards(cls: Any, names: frozenset[str]) -> tuple[Callable[..., None], Callable[..., None]]:
    """Return what keeps fields from being set or deleted."""

    def __setattr__(self: Any, name: str, value: object) -> None:
        if type(self) is cls or name in names:
            raise dataclasses.FrozenInstanceError(f"cannot assign to field {name!r}")
        super(cls, self).__setattr__(name, value)

    def __delattr__(self: Any, name: str) -> None:
        if type(self) is cls or name in names:
            raise dataclasses.FrozenInstanceError(f"cannot delete field {name!r}")
        super(cls, self).__delattr__(name)

    return __setattr__, __delattr__


_being_told: set[int] = set()  # what is within itself is told in short


def _told(self: Any) -> str:
    if id(self) in _being_told:
        return "..."
    _being_told.add(id(self))
    try:
        told = (f"{f.name}={getattr(self, f.name)!r}" for f in dataclasses.fields(self) if f.repr)
        return f"{self.__class__.__qualname__}({', '.join(told)})"
    finally:
        _being_told.discard(id(self))


def _state(self: Any) -> list[object]:
    return [getattr(self, f.name) for f in dataclasses.fields(self)]


def _restored(self: Any, state: Iterable[object]) -> None:
    for f, value in zip(dataclasses.fields(self), state, strict=True):
        object.__setattr__(self, f.name, value)


def _rare(cls: type) -> bool:
    """Return whether a class wants what only `dataclasses` does."""
    if any(hasattr(base, "__dataclass_fields__") for base in cls.__bases__):
        return True
    own = (v for v in vars(cls).values() if isinstance(v, dataclasses.Field))
    notes = inspect.get_annotations(cls).values()
    return any(f.kw_only is True or not f.init for f in own) or any(
        "KW_ONLY" in str(note) or "InitVar" in str(note) for note in notes
    )


def _made(cls: type, frozen: bool, eq: bool, slots: bool) -> type:
    if _rare(cls):
        return dataclasses.dataclass(frozen=frozen, eq=eq, slots=slots)(cls)
    own = dict(vars(cls))
    if cls.__doc__ is None:
        cls.__doc__ = cls.__name__  # `dataclasses` would look for the signature, which takes as long again
    made: Any = dataclasses.dataclass(init=False, repr=False, eq=False, slots=slots)(cls)
    params = made.__dataclass_params__
    params.init, params.repr, params.eq, params.frozen = True, True, eq, frozen
    methods = dict(_waiting(made, frozen))
    for name, method in methods.items():
        method.__qualname__ = f"{made.__qualname__}.{name}"
    methods["__repr__"] = _told
    if not eq:
        del methods["__eq__"], methods["__hash__"]
    elif not frozen:
        methods["__hash__"] = None  # what changes is in no set
    if frozen:
        methods["__setattr__"], methods["__delattr__"] = _guards(made, frozenset(made.__dataclass_fields__))
        if slots:  # how what cannot be set is unpickled
            methods["__getstate__"], methods["__setstate__"] = _state, _restored
    for name, method in methods.items():
        # Python itself puts a hash of None beside an `__eq__` of the class's own.
        if name not in own or (name == "__hash__" and own[name] is None):
            setattr(made, name, method)
    return cast(type, made)


if TYPE_CHECKING:
    from dataclasses import dataclass as dataclass
else:

    def dataclass(cls=None, /, *, frozen=False, eq=True, slots=False):
        """Make a class a dataclass, as `dataclasses.dataclass` does, in a tenth of its time."""
        if cls is None:
            return lambda cls: _made(cls, frozen, eq, slots)
        return _made(cls, frozen, eq, slots)
