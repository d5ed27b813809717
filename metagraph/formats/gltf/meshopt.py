"""Read buffer views packed by EXT_meshopt_compression: attributes, triangles and indices, and the filters.

Follows the specification of the extension (Khronos Group, "EXT_meshopt_compression", appendices A and B).
"""

from __future__ import annotations

from math import ceil
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]
MeshoptMode = Literal["ATTRIBUTES", "TRIANGLES", "INDICES"]
MeshoptFilter = Literal["NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"]

GROUP = 16  # elements in a group
_BLOCK_BYTES, _BLOCK = 8192, 256
_BITS = (0, 2, 4, 8)  # bits of a delta, by a group's mode
# How many values in a byte mean that a byte of their own follows, by mode.
_LATER = (
    (0,) * 256,
    tuple(sum(b >> s & 3 == 3 for s in (0, 2, 4, 6)) for b in range(256)),
    tuple((b & 15 == 15) + (b >> 4 == 15) for b in range(256)),
    (0,) * 256,
)


class MeshoptError(ValueError):
    """Raised if packed data is damaged; the message says how."""


def count_block_elements(stride: int) -> int:
    """Return the largest number of elements of `stride` bytes in a block."""
    return min(_BLOCK_BYTES // stride & ~(GROUP - 1), _BLOCK)


def unpack_buffer(
    data: bytes, count: int, stride: int, mode: MeshoptMode, kind: MeshoptFilter = "NONE"
) -> bytes:
    """Return `count` elements of `stride` bytes. Raises MeshoptError if the data does not hold them, or mode,
    filter and stride do not fit each other.
    """
    if mode == "ATTRIBUTES":
        if stride <= 0 or stride % 4 or stride > 256:
            raise MeshoptError(f"elements of {stride} bytes cannot be attributes")
        return _unfiltered(_attributes(data, count, stride), kind).tobytes()
    if stride not in (2, 4) or kind != "NONE":
        raise MeshoptError(f"elements of {stride} bytes with the filter {kind} cannot be indices")
    if mode == "TRIANGLES" and count % 3:
        raise MeshoptError(f"{count} indices are no triangles")
    if mode not in ("TRIANGLES", "INDICES"):
        raise MeshoptError(f"there is no mode {mode}")
    try:
        found = _triangles(data, count) if mode == "TRIANGLES" else _indices(data, count)
    except IndexError:
        raise MeshoptError("its indices are cut short") from None
    return np.array(found, np.uint32).astype("<u2" if stride == 2 else "<u4").tobytes()


def _attributes(data: bytes, count: int, stride: int) -> Array:
    """Return the bytes `[count, stride]` of attributes."""
    tail = max(32, stride)
    if len(data) < 1 + tail or data[0] != 0xA0:
        raise MeshoptError("its attributes are cut short or of another version")
    starts, modes = _groups(data[: len(data) - tail], count, stride)
    deltas = _deltas(np.frombuffer(data + bytes(GROUP), np.uint8), starts, modes)
    signed = np.where(deltas & 1, ~(deltas >> 1), deltas >> 1).astype(np.uint8)
    out = np.empty((count, stride), np.uint8)
    size, at = count_block_elements(stride), 0
    for first in range(0, count, size):
        some = min(size, count - first)
        groups = ceil(some / GROUP)
        part = signed[at : at + groups * stride].reshape(stride, groups * GROUP)
        out[first : first + some] = part[:, :some].T
        at += groups * stride
    out[:1] += np.frombuffer(data[len(data) - stride :], np.uint8)
    return np.add.accumulate(out, axis=0, dtype=np.uint8)


def _groups(data: bytes, count: int, stride: int) -> tuple[Array, Array]:
    """Return where each group's deltas begin, and their modes, in order: block by block, byte by byte."""
    size = count_block_elements(stride)
    starts: list[int] = []
    modes: list[int] = []
    at, end = 1, len(data)
    try:
        for first in range(0, count, size):
            groups = ceil(min(size, count - first) / GROUP)
            for _ in range(stride):
                head, at = at, at + ceil(groups / 4)
                for n in range(groups):
                    mode = data[head + (n >> 2)] >> (n & 3) * 2 & 3
                    starts.append(at)
                    modes.append(mode)
                    if mode == 3:
                        at += 16
                    elif mode:
                        later, width = _LATER[mode], 4 * mode
                        at += width + sum([later[b] for b in data[at : at + width]])
    except IndexError:
        at = end + 1
    if at != end:
        raise MeshoptError("its attributes are cut short" if at > end else "its attributes end too early")
    return np.array(starts, np.int64), np.array(modes, np.uint8)


def _deltas(data: Array, starts: Array, modes: Array) -> Array:
    """Return the deltas of groups `[G, 16]` as they are stored."""
    out = np.zeros((len(starts), GROUP), np.uint8)
    whole = modes == 3
    out[whole] = data[starts[whole, None] + np.arange(GROUP)]
    for mode in (1, 2):
        own = np.flatnonzero(modes == mode)
        bits, width = _BITS[mode], 4 * mode
        packed = data[starts[own, None] + np.arange(width)]
        shifts = np.arange(8 - bits, -1, -bits, dtype=np.uint8)
        values = (packed[:, :, None] >> shifts & ((1 << bits) - 1)).reshape(-1, GROUP)
        later = values == (1 << bits) - 1
        place = starts[own, None] + width + np.cumsum(later, 1) - 1
        out[own] = np.where(later, data[np.where(later, place, 0)], values)
    return out


def _unfiltered(raw: Array, kind: MeshoptFilter) -> Array:
    """Return attributes `[count, stride]` with a filter undone."""
    stride = raw.shape[1]
    if kind == "NONE":
        return raw
    if kind == "EXPONENTIAL":
        whole = raw.view("<i4")
        floats: Array = np.ldexp((whole << 8 >> 8).astype(np.float32), whole >> 24)
        return floats.astype("<f4")
    if kind == "QUATERNION" and stride == 8:
        values = raw.view("<i2").astype(np.int32)
        one = (values[:, 3] | 3).astype(np.float64)[:, None]
        small = values[:, :3] / np.where(one > 0, one, 1) * np.sqrt(0.5)
        large = np.sqrt(np.maximum(0, 1 - (small**2).sum(1)))
        places = (values[:, 3:] + np.array([1, 2, 3, 0])) & 3
        out = np.empty((len(raw), 4), "<i2")
        np.put_along_axis(out, places, np.rint(np.column_stack([small, large]) * 32767).astype("<i2"), 1)
        return out
    if kind == "OCTAHEDRAL" and stride in (4, 8):
        most, form = (127, "<i1") if stride == 4 else (32767, "<i2")
        values = raw.view(form).astype(np.float64)
        x, y = (values[:, :2] / np.maximum(values[:, 2:3], 1)).T
        z = 1 - np.abs(x) - np.abs(y)
        fold = np.minimum(z, 0)
        vector = np.column_stack([x - np.copysign(fold, x), y - np.copysign(fold, y), z])
        length = np.sqrt((vector**2).sum(1, keepdims=True))
        return np.column_stack([np.rint(vector / np.maximum(length, 1e-12) * most), values[:, 3]]).astype(
            form
        )
    raise MeshoptError(f"the filter {kind} does not go with elements of {stride} bytes")


class _Bytes:
    """Bytes that are read one after another. Raises IndexError after the last."""

    def __init__(self, data: bytes, at: int) -> None:
        self.data, self.at = data, at

    def byte(self) -> int:
        self.at += 1
        return self.data[self.at - 1]

    def number(self) -> int:
        """Return an integer with 7 bits in each byte, the lowest first."""
        out = shift = 0
        while True:
            byte = self.byte()
            out |= (byte & 127) << shift
            if byte < 128 or shift > 28:
                return out
            shift += 7


def _zigzag(value: int) -> int:
    return ~(value >> 1) if value & 1 else value >> 1


def _indices(data: bytes, count: int) -> list[int]:
    if len(data) < 5 or data[0] != 0xD1:
        raise MeshoptError("its indices are cut short or of another version")
    source, last = _Bytes(data[:-4], 1), [0, 0]
    out: list[int] = []
    for _ in range(count):
        value = source.number()
        last[value & 1] = (last[value & 1] + _zigzag(value >> 1)) & 0xFFFFFFFF
        out.append(last[value & 1])
    return out


def _triangles(data: bytes, count: int) -> list[int]:
    triangles = count // 3
    if len(data) < 17 + triangles or data[0] != 0xE1:
        raise MeshoptError("its triangles are cut short or of another version")
    table, source = data[len(data) - 16 :], _Bytes(data[: len(data) - 16], 1 + triangles)
    edges: list[tuple[int, int]] = [(0, 0)] * 16  # the latest is the last
    recent: list[int] = [0] * 16
    following = last = 0
    out: list[int] = []

    def told() -> int:
        nonlocal last
        last = (last + _zigzag(source.number())) & 0xFFFFFFFF
        return last

    def fresh() -> int:
        nonlocal following
        following += 1
        return following - 1

    for code in data[1 : 1 + triangles]:
        high, low = code >> 4, code & 15
        if high < 15:
            a, b = edges[-1 - high]
            if 0 < low < 13:
                c = recent[-1 - low]
            else:
                if low == 0:
                    c = fresh()
                elif low == 15:
                    c = told()
                else:
                    c = last = (last + (1 if low == 14 else -1)) & 0xFFFFFFFF
                recent.append(c)
            edges += [(c, b), (a, c)]
        else:
            extra = table[low] if low < 14 else source.byte()
            if low >= 14 and extra == 0:
                following = 0
            a = told() if low == 15 else fresh()
            both = []
            for place in (extra >> 4, extra & 15):
                if place == 0:
                    both.append(fresh())
                elif place == 15 and low >= 14:
                    both.append(told())
                else:
                    both.append(recent[-place])
            b, c = both
            recent.append(a)
            recent += [x for x, place in ((b, extra >> 4), (c, extra & 15)) if place in (0, 15)]
            edges += [(b, a), (c, b), (a, c)]
        edges, recent = edges[-16:], recent[-16:]
        out += [a, b, c]
    return out
