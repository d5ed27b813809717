"""Long sequences that never change and that others are made of: what begins as one does and goes on
otherwise shares all but its end with it. So a plan of a hundred hours grows in the time that an hour's takes.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import chain
from typing import Any, Generic, TypeVar, cast, overload

T = TypeVar("T")

CHUNK = 1024  # elements that are shared together
LONG = 4 * CHUNK  # from so many on sharing is worth its while


class Strand(Sequence[T], Generic[T]):
    """Does what a tuple does, equal to any tuple or list of the same elements, in chunks of `CHUNK`; the last
    is shorter, or empty.
    """

    __slots__ = ("_chunks", "_count")

    def __init__(self, items: Iterable[T] = ()) -> None:
        every = tuple(items)
        self._count = len(every)
        self._chunks = tuple(every[n : n + CHUNK] for n in range(0, len(every), CHUNK))

    @staticmethod
    def _of(chunks: tuple[tuple[T, ...], ...], count: int) -> Strand[T]:
        out: Strand[T] = Strand()
        out._chunks, out._count = chunks, count
        return out

    def begun(self, count: int, more: Sequence[T] = ()) -> Strand[T]:
        """Return the first `count` elements with more behind them."""
        count = min(count, self._count)
        whole, part = divmod(count, CHUNK)
        rest = (*(self._chunks[whole][:part] if part else ()), *more)
        ends = tuple(rest[n : n + CHUNK] for n in range(0, len(rest), CHUNK))
        return self._of(self._chunks[:whole] + ends, count + len(more))

    def __len__(self) -> int:
        return self._count

    @overload
    def __getitem__(self, at: int) -> T: ...
    @overload
    def __getitem__(self, at: slice) -> Sequence[T]: ...
    def __getitem__(self, at: int | slice) -> T | Sequence[T]:
        if isinstance(at, slice):
            first, last, step = at.indices(self._count)
            if step != 1:
                return tuple(self)[at]
            if first == 0 and last >= LONG:
                return self.begun(last)
            begin, end = first // CHUNK, -(-last // CHUNK)
            near = tuple(chain.from_iterable(self._chunks[begin:end]))
            return near[first - begin * CHUNK : max(first, last) - begin * CHUNK]
        place = at + self._count if at < 0 else at
        if not 0 <= place < self._count:
            raise IndexError("no such element")
        return self._chunks[place // CHUNK][place % CHUNK]

    def __iter__(self) -> Iterator[T]:
        return chain.from_iterable(self._chunks)

    def __add__(self, more: Sequence[T]) -> Strand[T]:
        return self.begun(self._count, more)

    def __radd__(self, before: Sequence[T]) -> Strand[T]:
        return Strand((*before, *self))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Strand | tuple | list):
            return NotImplemented
        return len(self) == len(other) and all(a is b or a == b for a, b in zip(self, other, strict=True))

    def __hash__(self) -> int:
        return hash(tuple(self))

    def __repr__(self) -> str:
        return f"Strand({tuple(self)!r})"

    def __reduce__(self) -> Any:
        return Strand, (tuple(self),)


def join_sequence(before: Sequence[T], count: int, more: Sequence[T]) -> tuple[T, ...]:
    """Return the first `count` elements of a sequence with more behind them: a tuple, or where it would be
    long a `Strand`, which does all that is done with it.
    """
    if count + len(more) < LONG:
        return (*before[:count], *more)
    made = before if isinstance(before, Strand) else Strand(before)
    return cast("tuple[T, ...]", made.begun(count, more))
