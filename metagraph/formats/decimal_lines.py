"""Many decimal numbers as text at once: what an animation file is made of, where it is text.

Every number has room for all the digits it could have in a table of bytes, a row a line; digits come three at
a time from a list of a thousand. What a number does not need is zero bytes, which are dropped at the end.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate, pairwise
from operator import add
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

DIGITS = 6  # at most, behind the point
_WHOLE = 6  # before it
_SLOT = 16  # bytes: sign and thousands, ones and point, and twice three digits with nothing behind them
_SURE = 0.499  # up to how far from a whole number, less than the half, what was scaled is rounded as exact


def _words(texts: Sequence[bytes]) -> Array:
    """Return texts of four bytes as numbers that lie in memory as they do."""
    return np.frombuffer(b"".join(texts), np.uint32)


_EACH = range(1000)
_MINUS, _DOT = _words([b"-\0\0\0", b"\0\0\0."])
# Three digits in front of the point, behind a sign's room or not, without zeros at their beginning and with
# them. Behind the point, with all zeros and without those at the end.
_THOUSANDS = _words([b"\0" + (b"%d" % n if n else b"").rjust(3, b"\0") for n in _EACH])
_ONES = _words([(b"%d" % n).rjust(3, b"\0") + b"\0" for n in _EACH])
_PADDED = _words([b"%03d\0" % n for n in _EACH])
_LAST = _words([(b"%03d" % n).rstrip(b"0").ljust(4, b"\0") for n in _EACH])


def number(value: float, digits: int = DIGITS) -> str:
    """Return a number with at most so many digits (1 or more) behind the point, none needless, and without an
    exponent.
    """
    short = f"{value:.{digits}f}".rstrip("0").rstrip(".")
    return "0" if short == "-0" else short


def _split(numbers: Array, by: int) -> tuple[Array, Array]:
    """Return quotients and remainders: NumPy is quicker at it in two steps."""
    quotients = numbers // by
    return quotients, numbers - quotients * by


class Lines:
    """A text of lines that differ in their numbers alone.

    between: what stands before, between and behind the n numbers of a line, n + 1 texts without zero bytes.
    digits `[n]`: how many each has behind the point, 1 to 6.
    """

    def __init__(self, between: Sequence[str], digits: Sequence[int]) -> None:
        self._between, self._digits = tuple(between), tuple(digits)
        line = bytearray(between[0].encode())
        self._at: list[slice] = []
        for text in between[1:]:
            self._at.append(slice(len(line), len(line) + _SLOT))
            line += bytes(_SLOT) + text.encode()
        self._line = np.frombuffer(bytes(line), np.uint8)
        self._scales = 10.0 ** np.array(self._digits)
        self._missing = 10 ** (DIGITS - np.array(self._digits))

    def write(self, numbers: Array, counts: Sequence[int]) -> list[str]:
        """Return texts of so many lines each, of numbers `[sum of counts, n]` float64, each as `number`
        writes it.
        """
        edges = [0, *accumulate(counts)]
        if not (np.abs(numbers) < 10.0**_WHOLE - 1).all():  # no room, or not even a number
            lines = [self._one(row) for row in numbers.tolist()]
            return ["".join(lines[a:b]) for a, b in pairwise(edges)]
        page = np.empty((len(numbers), len(self._line)), np.uint8)
        page[:] = self._line
        slots = self._slots(numbers)
        for column, at in enumerate(self._at):
            page[:, at] = slots[:, column]
        words, width = page.tobytes(), len(self._line)
        return [words[a * width : b * width].translate(None, b"\0").decode() for a, b in pairwise(edges)]

    def _one(self, row: Sequence[float]) -> str:
        written = map(number, row, self._digits)
        return self._between[0] + "".join(map(add, written, self._between[1:]))

    def _slots(self, numbers: Array) -> Array:
        """Return the digits of numbers `[N, n]` as bytes `[N, n, 16]`."""
        scaled = np.abs(numbers) * self._scales
        rounded = np.rint(scaled)
        unsure = np.abs(scaled - rounded) > _SURE
        exact = (rounded.astype(np.int64) * self._missing).ravel()
        whole, part = _split(exact, 10**DIGITS)
        thousands, ones = _split(whole.astype(np.int32), 1000)
        front, back = _split(part.astype(np.int32), 1000)
        out = np.empty((len(exact), 4), np.uint32)
        out[:, 0] = _THOUSANDS[thousands] + _MINUS * ((numbers.ravel() < 0) & (exact > 0))
        out[:, 1] = np.where(thousands > 0, _PADDED[ones], _ONES[ones]) + _DOT * (part > 0)
        out[:, 2] = np.where(back > 0, _PADDED[front], _LAST[front])
        out[:, 3] = _LAST[back]
        slots = out.view(np.uint8).reshape(*numbers.shape, _SLOT)
        for row, column in zip(*unsure.nonzero(), strict=True):
            short = number(float(numbers[row, column]), self._digits[column]).encode()
            slots[row, column] = np.frombuffer(short.ljust(_SLOT, b"\0"), np.uint8)
        return slots
