"""Making something only when what it is made of has changed."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Generic, TypeVar

T = TypeVar("T")


class Once(Generic[T]):
    """What was made of some values and objects, as long as the values are equal and no object was
    replaced.
    """

    def __init__(self) -> None:
        self._made: T | None = None
        self._values: tuple[Any, ...] = ()
        self._objects: tuple[Any, ...] = ()

    def of(self, values: tuple[Any, ...], objects: tuple[Any, ...], make: Callable[[], T]) -> T:
        """Return what `make` returns. objects: large ones, compared by identity only."""
        same = values == self._values and all(a is b for a, b in zip(objects, self._objects, strict=False))
        if self._made is None or not same:
            self._made = make()
            self._values, self._objects = values, objects
        return self._made
