"""Pack buffer views by EXT_meshopt_compression, with the filters that make them smaller.

Follows the specification of the extension (Khronos Group, "EXT_meshopt_compression", appendices A and B).
"""

from __future__ import annotations

from math import ceil
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.formats.gltf.meshopt import GROUP, count_block_elements

Array = NDArray[Any]


def pack_attributes(raw: bytes, stride: int) -> bytes:
    """Return elements of `stride` bytes, a multiple of 4 up to 256, packed without loss."""
    values = np.frombuffer(raw, np.uint8).reshape(-1, stride)
    first = values[0] if len(values) else np.zeros(stride, np.uint8)
    deltas = np.diff(values, axis=0, prepend=first[None])
    coded = np.where(deltas & 0x80, ~(deltas << 1), deltas << 1).astype(np.uint8)
    size = count_block_elements(stride)
    whole = len(coded) // size * size
    parts = [_blocks(coded[:whole].reshape(-1, size, stride))] if whole else []
    if whole < len(coded):
        rest = np.zeros((ceil((len(coded) - whole) / GROUP) * GROUP, stride), np.uint8)
        rest[: len(coded) - whole] = coded[whole:]
        parts.append(_blocks(rest[None]))
    return b"".join((b"\xa0", *parts, bytes(max(0, 32 - stride)), first.tobytes()))


def _blocks(coded: Array) -> bytes:
    """Return blocks `[B, n x 16, stride]` of deltas as they are stored."""
    blocks, elements, stride = coded.shape
    count = elements // GROUP
    groups = coded.transpose(0, 2, 1).reshape(blocks, stride, count, GROUP)
    lengths = np.stack(
        [
            np.where(groups.any(-1), 99, 0),
            4 + (groups >= 3).sum(-1),
            8 + (groups >= 15).sum(-1),
            np.full(groups.shape[:-1], 16),
        ]
    )
    modes = lengths.argmin(0)
    # Each row begins with what is stored of a group; a row before them has the modes of all groups.
    rows = np.zeros((blocks, stride, count + 1, 24), np.uint8)
    sizes = np.zeros((blocks, stride, count + 1), np.int64)
    heads = np.zeros((blocks, stride, ceil(count / 4) * 4), np.uint8)
    heads[..., :count] = modes
    shifts = np.array([0, 2, 4, 6], np.uint8)
    head = (heads.reshape(blocks, stride, -1, 4) << shifts).sum(-1).astype(np.uint8)
    rows[:, :, 0, : head.shape[2]] = head
    sizes[:, :, 0] = head.shape[2]
    sizes[:, :, 1:] = lengths.min(0)
    stored = rows[:, :, 1:]
    stored[modes == 3, :GROUP] = groups[modes == 3]
    for mode, bits in ((1, 2), (2, 4)):
        own = groups[modes == mode]
        most, width = (1 << bits) - 1, 4 * mode
        places = np.arange(8 - bits, -1, -bits, dtype=np.uint8)
        short = np.minimum(own, most).reshape(-1, width, 8 // bits)
        row = np.zeros((len(own), 24), np.uint8)
        row[:, :width] = (short << places).sum(-1).astype(np.uint8)
        later = own >= most
        where = np.nonzero(later)
        row[where[0], width + (np.cumsum(later, 1) - 1)[where]] = own[where]
        stored[modes == mode] = row
    return rows[np.arange(24) < sizes[..., None]].tobytes()


def pack_indices(indices: Array) -> bytes:
    """Return indices packed, in their order, each by its distance from one of the two before."""
    last = [0, 0]
    out = bytearray(b"\xd1")
    for index in np.asarray(indices, np.int64).tolist():
        base = int(abs(index - last[1]) < abs(index - last[0]))
        delta = index - last[base]
        last[base] = index
        value = ((delta << 1) ^ (delta >> 63)) << 1 | base
        while value > 127:
            out.append(value & 127 | 128)
            value >>= 7
        out.append(value)
    return bytes(out + bytes(4))


def encode_exponential(values: Array, exponent: int) -> bytes:
    """Return floats `[..]` as integers times 2 ** exponent, -100..100. Floats too large for 24 bits get an
    exponent of their own.
    """
    numbers = np.asarray(values, np.float64)
    _, needed = np.frexp(np.abs(numbers))
    exponents = np.clip(np.maximum(exponent, needed - 23), -100, 100)
    whole = np.clip(np.rint(np.ldexp(numbers, -exponents)), -(1 << 23), (1 << 23) - 1).astype(np.int64)
    both: Array = (exponents.astype(np.int64) << 24) | (whole & 0xFFFFFF)
    return both.astype("<u4").tobytes()


def encode_quaternions(values: Array, bits: int) -> bytes:
    """Return unit quaternions `[N, 4]` as three components of `bits`, 4..16, without the largest."""
    q = np.asarray(values, np.float64)
    largest = np.abs(q).argmax(1)
    turned = np.take_along_axis(q, (largest[:, None] + np.arange(1, 5)) & 3, 1)
    turned *= np.where(turned[:, 3:] < 0, -1, 1)
    most = (1 << (bits - 1)) - 1
    out = np.empty((len(q), 4), "<i2")
    out[:, :3] = np.rint(np.clip(turned[:, :3] * np.sqrt(2), -1, 1) * most)
    out[:, 3] = most & ~3 | largest
    return out.tobytes()


def encode_octahedral(vectors: Array, bits: int) -> bytes:
    """Return unit vectors `[N, 3]` as two numbers of `bits`, 4..8, in 4 bytes each."""
    v = np.asarray(vectors, np.float64)
    v = v / np.maximum(np.abs(v).sum(1, keepdims=True), 1e-12)
    folded = np.where(v[:, :2] >= 0, 1, -1) * (1 - np.abs(v[:, 1::-1]))
    flat = np.where(v[:, 2:] < 0, folded, v[:, :2])
    most = (1 << (bits - 1)) - 1
    out = np.zeros((len(v), 4), "<i1")
    out[:, :2] = np.rint(flat * most)
    out[:, 2] = most
    return out.tobytes()
