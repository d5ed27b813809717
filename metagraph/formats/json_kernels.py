"""A compiled loop that reads a list of small JSON objects as rows of numbers. Importing this imports numba
(half a second).

The text is JSON already: what reads it into values has looked at all of it.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from metagraph.compiling import compiler

Array = Any
KEPT, SOURCES = ("rows",), ()

# What a field must hold. Of text its digest is told, of an object where it begins.
NUMBER, TEXT, TRUTH, OBJECT = range(4)
NEEDED = 4  # added for a field that must be there
DIGITS = 15  # of a number: more of them are not read

# Text is told by a polynomial of its bytes: of a factor below 128 names that differ in two letters have one.
FACTOR = 0x9E3779B1

_ENDS = np.isin(np.arange(256), [ord(c) for c in '"{}[],'])  # bytes that a value may begin or end with

_exact = compiler(nogil=True, error_model="numpy")
_inside = compiler(keep=False, nogil=True, error_model="numpy")


@_inside
def _past_blanks(data: Array, at: int) -> int:
    while at < len(data) and (data[at] == 32 or data[at] == 10 or data[at] == 13 or data[at] == 9):
        at += 1
    return at


@_inside
def _text(data: Array, at: int) -> tuple[int, int]:
    """Return the digest of the text that begins with the quote at `at`, -1 where it is not plain ASCII, and
    where it ends.
    """
    digest, bits, at = 1, 0, at + 1
    while data[at] != 34:
        if data[at] == 92:
            bits, at = 128, at + 1
        bits |= data[at]
        digest = digest * FACTOR + data[at]  # of which only the lowest bits are told: others may run over
        at += 1
    return (digest & 0xFFFFFFFFFFFF if bits < 128 else -1), at + 1


@_inside
def _value_end(data: Array, at: int) -> int:
    """Return where the value ends that begins at `at`."""
    depth = 0
    while True:
        while not _ENDS[data[at]]:
            at += 1
        c = data[at]
        if c == 34:
            at += 1
            while data[at] != 34:
                at += 2 if data[at] == 92 else 1
            at += 1
        elif c == 123 or c == 91:
            depth, at = depth + 1, at + 1
        elif depth == 0 and (c == 44 or c == 125 or c == 93):
            return at  # that of what it is in
        elif c == 125 or c == 93:
            depth, at = depth - 1, at + 1
        else:
            at += 1
            continue
        if depth == 0:
            return at


@_inside
def _held(data: Array, at: int, kind: int) -> tuple[int, int]:
    """Return what a value of that kind is as a number, -1 where it is of another, and where it ends."""
    c = data[at]
    if kind == TEXT:
        return _text(data, at) if c == 34 else (-1, at)
    if kind == OBJECT:
        return (at, _value_end(data, at)) if c == 123 else (-1, at)
    if kind == TRUTH:
        return (1, at + 4) if c == 116 else (0, at + 5) if c == 102 else (-1, at)
    value, begin = np.int64(0), at
    while 48 <= data[at] <= 57:
        value = value * 10 + (np.int64(data[at]) - 48)
        at += 1
    c = data[at]
    whole = 0 < at - begin <= DIGITS and c != 46 and c != 69 and c != 101
    return (int(value) if whole else -1), at


@_inside
def _object(data: Array, at: int, names: Array, kinds: Array, out: Array) -> int:
    """Write the fields of the object at `at`, -1 for those it does not have. Returns where it ends; -1 where
    it is none, or a field is not there or of another kind.
    """
    out[:] = -1
    if data[at] != 123:
        return -1
    at = _past_blanks(data, at + 1)
    while data[at] != 125:
        name, at = _text(data, at)
        if name < 0:
            return -1
        at = _past_blanks(data, at)
        at = _past_blanks(data, at + 1)
        which = -1
        for k in range(len(names)):
            if names[k] == name:
                which = k
        if which < 0:
            at = _value_end(data, at)
        else:
            out[which], at = _held(data, at, kinds[which] & ~NEEDED)
            if out[which] < 0:
                return -1
        at = _past_blanks(data, at)
        if data[at] == 44:
            at = _past_blanks(data, at + 1)
    for k in range(len(names)):
        if out[k] < 0 and kinds[k] & NEEDED:
            return -1
    return at + 1


@_exact
def rows(data: Array, names: Array, kinds: Array, within: int, out: Array, ends: Array) -> int:
    """Write the fields of each object in the list that JSON text `[N]` bytes is to out `[R, F]`, and where it
    begins and ends to ends `[R, 2]`. names, kinds `[F]`: the fields' digests, and what they hold. within: the
    first of those fields that are in the object which the field before is; F for none. Returns how many there
    are; -1 where it is no such list, or a field is not there, or of another kind, than told.
    """
    at = _past_blanks(data, 0)
    if at >= len(data) or data[at] != 91:
        return -1
    count, at = 0, _past_blanks(data, at + 1)
    while data[at] != 93:
        if count >= len(out):
            return -1
        ends[count, 0] = at
        row = out[count]
        row[:] = -1
        at = _object(data, at, names[:within], kinds[:within], row[:within])
        if at < 0:
            return -1
        inner = row[within - 1]
        if within < len(names) and inner >= 0:
            inner = _object(data, inner, names[within:], kinds[within:], row[within:])
            if inner < 0:
                return -1
        ends[count, 1] = at
        count += 1
        at = _past_blanks(data, at)
        if data[at] == 44:
            at = _past_blanks(data, at + 1)
    return count


def warm() -> None:
    """Have ready what files are read with."""
    whole = np.zeros(0, np.int64)
    none = np.zeros((0, 2), np.int64)
    rows(np.frombuffer(b"[]", np.uint8), whole, whole, 0, none, none)
