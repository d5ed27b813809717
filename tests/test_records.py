"""Dataclasses made quickly are what `dataclasses` makes."""

from __future__ import annotations

import copy
import dataclasses
import inspect
import pickle
from dataclasses import FrozenInstanceError, field
from functools import cached_property

import pytest

from metagraph import records


@records.dataclass(frozen=True)
class Frozen:
    a: int
    b: tuple[str, ...] = ("x",)
    c: dict[str, int] = field(default_factory=dict, hash=False)
    d: object = field(default=None, compare=False, repr=False)

    @cached_property
    def twice(self) -> int:
        return self.a * 2


@records.dataclass(frozen=True, slots=True)
class Slotted:
    a: int
    b: float = 0.5


@records.dataclass
class Loose:
    a: int
    b: list[int] = field(default_factory=list)


@records.dataclass(frozen=True, eq=False)
class Itself:
    a: list[int]

    def __post_init__(self) -> None:
        object.__setattr__(self, "a", sorted(self.a))


@records.dataclass(frozen=True)
class Own:
    a: int

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Own) and self.a % 10 == other.a % 10

    def __hash__(self) -> int:
        return self.a % 10

    def __repr__(self) -> str:
        return "own"


def again(cls: type, **options: bool) -> type:
    """Return what `dataclasses` makes of the same notes."""
    body = {"__annotations__": cls.__annotations__, "__module__": __name__, "__qualname__": cls.__qualname__}
    for f in dataclasses.fields(cls):
        kept = {"hash": f.hash, "compare": f.compare, "repr": f.repr}
        if f.default is not dataclasses.MISSING:
            body[f.name] = field(default=f.default, **kept)
        elif f.default_factory is not dataclasses.MISSING:
            body[f.name] = field(default_factory=f.default_factory, **kept)
    return dataclasses.dataclass(**options)(type(cls.__name__, (), body))


ALIKE = {
    "frozen": (Frozen, again(Frozen, frozen=True)),
    "slotted": (Slotted, again(Slotted, frozen=True, slots=True)),
    "loose": (Loose, again(Loose)),
}


@pytest.mark.parametrize("ours, theirs", ALIKE.values(), ids=ALIKE)
def test_a_record_is_told_compared_and_made_as_a_dataclass_is(ours, theirs):
    assert repr(ours(3)) == repr(theirs(3))
    assert ours(3) == ours(3) != ours(4)
    assert (ours(3) == "3") is False
    assert ours.__match_args__ == theirs.__match_args__
    assert str(inspect.signature(ours)) == str(inspect.signature(theirs))
    assert ours.__init__.__annotations__ == theirs.__init__.__annotations__
    assert dataclasses.asdict(ours(3)) == dataclasses.asdict(theirs(3))
    assert dataclasses.replace(ours(3), a=4) == ours(4)
    assert str(ours.__dataclass_params__) == str(theirs.__dataclass_params__)
    for made in (ours, theirs):
        with pytest.raises(TypeError):
            made()
        with pytest.raises(TypeError):
            made(1, a=2)


def test_a_frozen_record_is_hashed_and_keeps_its_fields():
    assert hash(Slotted(1, 0.5)) == hash((1, 0.5)) and hash(Frozen(1, c={"u": 1})) == hash((1, ("x",)))
    for value in (Frozen(1), Slotted(1)):
        with pytest.raises(FrozenInstanceError, match="cannot assign to field 'a'"):
            value.a = 2
        with pytest.raises(FrozenInstanceError, match="cannot delete field 'a'"):
            del value.a
        with pytest.raises(FrozenInstanceError):
            value.other = 2
        assert pickle.loads(pickle.dumps(value)) == copy.copy(value) == value
    assert Frozen(2).twice == 4
    assert Frozen(1, d=1) == Frozen(1, d=2)


def test_what_may_change_has_no_hash_and_lists_of_its_own():
    one, other = Loose(1), Loose(1)
    one.b.append(3)
    assert other.b == [] and one != other
    with pytest.raises(TypeError, match="unhashable"):
        hash(one)


def test_a_record_may_be_equal_to_itself_alone_and_finish_what_it_is_given():
    assert Itself([2, 1]).a == [1, 2]
    assert Itself([1]) != Itself([1])
    assert len({Itself([1]), Itself([1])}) == 2


def test_methods_of_its_own_stay():
    assert Own(11) == Own(1) and hash(Own(11)) == 1 and repr(Own(1)) == "own"


def test_the_first_call_of_any_compiled_method_may_come_through_a_class_below():
    @records.dataclass(frozen=True)
    class Above:
        a: int

    class Below(Above):
        def __init__(self, a: int) -> None:
            super().__init__(a + 1)

    assert Below(1).a == Below(1).a == 2
    assert Below(1) == Below(1) != Above(2)


def test_a_value_within_itself_is_told_in_short():
    value = Loose(1)
    value.b.append(value)
    assert repr(value) == "Loose(a=1, b=[...])"


def test_what_is_rare_is_left_to_dataclasses():
    @records.dataclass(frozen=True)
    class Wider(Slotted):
        c: int = field(default=1, kw_only=True)

    @records.dataclass
    class Derived:
        a: int
        b: int = field(init=False, default=3)

    assert Wider(1, c=2) == Wider(1, 0.5, c=2) and isinstance(Wider(1), Slotted)
    assert Derived(1).b == 3


@pytest.mark.parametrize("options", [{"frozen": True}, {"frozen": True, "slots": True}, {}], ids=str)
def test_the_first_values_are_made_without_anything_compiled_and_are_as_the_later_ones(options):
    def finish(self) -> None:
        told.append(self.a)

    told: list[int] = []
    body = {"a": int, "b": tuple[str, ...], "c": list[int]}
    made = records.dataclass(**options)(
        type(
            "Made",
            (),
            {
                "__annotations__": body,
                "__module__": __name__,
                "b": ("x",),
                "c": field(default_factory=list),
                "__post_init__": finish,
            },
        )
    )
    wrong = [((), {}), ((1,), {"a": 2}), ((1, (), [], 3), {}), ((1,), {"d": 2}), ((), {"b": ()})]
    values, lists = [], set()
    for n in range(records.FEW + 4):
        values += [made(n), made(n, ("y",)), made(b=(), a=n), made(n, c=[4])]
        lists.add(id(values[-4].c))
    assert len(lists) == records.FEW + 4, "each has a list of its own"
    assert told == [v.a for v in values]
    for n in range(0, len(values), 4):
        assert [(v.a - values[n].a, v.b, v.c) for v in values[n : n + 4]] == [
            (0, ("x",), []),
            (0, ("y",), []),
            (0, (), []),
            (0, ("x",), [4]),
        ]
    fresh = records.dataclass(**options)(type("Fresh", (), {"__annotations__": body, "__module__": __name__}))
    for cls in (made, fresh):
        for given, named in wrong:
            with pytest.raises(TypeError):
                cls(*given, **named)
