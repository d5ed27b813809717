"""Parse decimal numbers from text, all at once: a motion file consists mostly of numbers.

Eight digits become a number by three multiplications of the 64 bits they occupy, for all numbers of a piece
of text together. A number of up to 15 digits is one division away from exact, which rounds as `float` does.
Anything else (more digits, no number at all) is left to NumPy, word by word.
"""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

_PIECE = 1 << 18  # bytes parsed at once: the data stays in a processor's cache
_THREADS_FROM = (
    2 << 20
)  # bytes from which two threads pay; arrays are worked on without the interpreter's lock
_DIGITS = 15  # digits that a double always holds
_TENS = 10.0 ** np.arange(23)  # the powers of ten that are exact
_SPACE, _PLUS, _MINUS, _DOT, _ZERO, _E = b" +-.0e"


def read_decimals(data: bytes, start: int) -> Array:
    """Return every number after `start` as float64. Raises ValueError for a word that is no number, as
    `float` would. The first words must be at least 8 bytes from the beginning of the data.
    """
    edges = [start]
    while edges[-1] < len(data):
        end = data.find(b"\n", edges[-1] + _PIECE)
        edges.append(len(data) if end < 0 else end)
    pieces = list(pairwise(edges))
    if len(data) - start < _THREADS_FROM:
        return np.concatenate([np.zeros(0), *(_piece(data, a, b) for a, b in pieces)])
    with ThreadPoolExecutor(2) as pool:
        return np.concatenate(list(pool.map(lambda piece: _piece(data, *piece), pieces)))


def _piece(data: bytes, start: int, end: int) -> Array:
    text = np.frombuffer(data, np.uint8, end - start, start)
    part = (text == _SPACE) | (text - np.uint8(9) <= 4)
    edge = np.flatnonzero(part[1:] != part[:-1]) + 1
    first, last = _ends(edge, bool(part[0]), bool(part[-1]), len(text))
    count = len(first)
    if not count:
        return np.zeros(0)
    # Eight bytes from any place on, as one number in little-endian order.
    words = np.ndarray((len(data) - 7,), "<u8", data, 0, (1,))
    odd = np.zeros(count, bool)
    minus = text[first] == _MINUS
    dots = np.flatnonzero(text == _DOT)
    known = part | (text - np.uint8(_ZERO) <= 9)
    known[first[minus]] = True
    known[dots] = True
    others = np.flatnonzero(~known)
    until, exponent = last, np.zeros(count, np.int64)
    if len(others):
        until, exponent = _exponents(text, words, start, first, last, others, odd)
    dot = _dots(first, until, dots, odd)
    whole, behind = dot - first - minus, np.maximum(until - dot - 1, 0)
    digits = whole + behind
    less = behind - exponent  # by how many powers of ten it is less than its digits as an integer
    odd |= (digits > _DIGITS) | (digits <= 0) | (dot > until) | (abs(less) >= len(_TENS))
    out: Array = _digits(words, start + dot, whole) * _TENS[np.minimum(behind, _DIGITS)]
    out += _digits(words, start + until, behind)
    out /= _TENS[np.clip(less, 0, len(_TENS) - 1)]
    if len(others):
        out *= _TENS[np.clip(-less, 0, len(_TENS) - 1)]
    np.negative(out, where=minus, out=out)
    if odd.any():
        places = np.flatnonzero(odd)
        raw = [data[start + a : start + b] for a, b in zip(first[places], last[places], strict=True)]
        out[places] = np.array(raw, np.float64)
    return out


def _exponents(
    text: Array, words: Array, start: int, first: Array, last: Array, others: Array, odd: Array
) -> tuple[Array, Array]:
    """Return where each word's digits end, and its exponent. Words with anything else in them are marked as
    odd.
    """
    of = np.searchsorted(first, others, "right") - 1
    marks = (text[others] | 0x20) == _E
    places, at = of[marks], others[marks]
    sign = text[np.minimum(at + 1, len(text) - 1)]
    signed = (sign == _MINUS) | (sign == _PLUS)
    digits = last[places] - at - 1 - signed
    # The mark and its sign are the unusual letters in such a word.
    strange = np.bincount(of, minlength=len(first))
    strange[places] -= 1 + signed
    wrong = (digits < 1) | (digits > 3)
    odd[places[wrong]] = True
    odd |= strange != 0
    until, exponent = last.copy(), np.zeros(len(first), np.int64)
    until[places] = at
    size = _eight(words, start + last[places], np.clip(digits, 0, 3)).astype(np.int64)
    exponent[places] = np.where(sign == _MINUS, -size, size)
    return until, exponent


def _ends(edge: Array, parts_first: bool, parts_last: bool, length: int) -> tuple[Array, Array]:
    """Return where words begin and end."""
    if not parts_first:
        edge = np.concatenate([[0], edge])
    if not parts_last:
        edge = np.concatenate([edge, [length]])
    return edge[::2], edge[1::2]


def _dots(first: Array, last: Array, dots: Array, odd: Array) -> Array:
    """Return where each word's decimal point is, or its end if it has none. A word with several is odd."""
    if len(dots) == len(first) and bool((dots >= first).all()) and bool((dots < last).all()):
        return dots
    out = last.copy()
    words = np.searchsorted(first, dots, "right") - 1
    out[words] = dots
    odd |= np.bincount(words, minlength=len(first)) > 1
    return out


def _digits(words: Array, ends: Array, count: Array) -> Array:
    """Return the number made of the last `count` digits before each end, float64; undefined for
    more than 15.
    """
    out = _eight(words, ends, np.minimum(count, 8)).astype(np.float64)
    long = np.flatnonzero(count > 8)
    if len(long):
        out[long] += 1e8 * _eight(words, ends[long] - 8, np.minimum(count[long] - 8, 8))
    return out


def _eight(words: Array, ends: Array, count: Array) -> Array:
    """Return the number made of up to 8 digits before each end."""
    found: Array = words[np.maximum(ends - 8, 0)]
    found &= np.uint64(0x0F0F0F0F0F0F0F0F)
    gone = (8 * (8 - count)).astype(np.uint64)
    half = gone >> np.uint64(1)  # shifting by 64 is undefined
    found = found >> half >> (gone - half) << half << (gone - half)
    found = (found * np.uint64(10) + (found >> np.uint64(8))) & np.uint64(0x00FF00FF00FF00FF)
    found = (found * np.uint64(100) + (found >> np.uint64(16))) & np.uint64(0x0000FFFF0000FFFF)
    found = found * np.uint64(10000) + (found >> np.uint64(32))
    return found & np.uint64(0xFFFFFFFF)
