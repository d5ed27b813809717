"""Turn the long lists of a glTF file into columns of numbers: it may have ten thousand accessors and
channels.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from metagraph.formats.gltf.values import Animation, Document

Array = NDArray[Any]

FLOAT = 5126
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
TRANSLATION, ROTATION, SCALE, WEIGHTS, UNKNOWN = range(5)
PATHS = {"translation": TRANSLATION, "rotation": ROTATION, "scale": SCALE, "weights": WEIGHTS}
LINEAR, STEP, SPLINE, NO_MODE = range(4)
MODES = {"LINEAR": LINEAR, "STEP": STEP, "CUBICSPLINE": SPLINE}
_MOST = 1 << 40  # bytes: more is beyond any file, and sums of it do not overflow

_decoder = msgspec.json.Decoder(Document)


def decode_columns(text: bytes | memoryview) -> Document:
    """Return the document in a file's JSON. Raises MsgspecError, RecursionError, ValueError."""
    return _decoder.decode(text)


def make_column(numbers: list[int]) -> Array:
    """Return integers as an array; those that are too large become the largest possible."""
    try:
        return np.array(numbers, np.int64)
    except OverflowError:
        return np.array([min(number, (1 << 63) - 1) for number in numbers], np.int64)


@dataclass(frozen=True, eq=False)
class PlainAccessors:
    """The accessors that are contiguous float32 numbers in the first buffer.

    `begins` `[A]` is the byte where each begins, -1 for other accessors. `counts` and `widths` `[A]` are the
    number of its elements, and of numbers in each.
    """

    begins: Array
    counts: Array
    widths: Array

    @classmethod
    def of(cls, document: Document) -> PlainAccessors:
        accessors, views = document.accessors, document.buffer_views
        if not accessors or not views:
            none = np.zeros(len(accessors), np.int64)
            return cls(none - 1, none, none)
        rows = [
            (a.buffer_view, a.byte_offset, a.count, WIDTHS.get(a.type, 0))
            if a.component_type == FLOAT and a.sparse is None and a.buffer_view is not None
            else (0, 0, 0, 0)
            for a in accessors
        ]
        lying = [(v.buffer, v.byte_offset, v.byte_length, v.byte_stride) for v in views]
        view, offset, count, width = (make_column([*some]) for some in zip(*rows, strict=True))
        buffer, view_begin, length, stride = (make_column([*some]) for some in zip(*lying, strict=True))
        packed = np.array([v.packed is not None for v in views])
        offset, count, view_begin, length = (
            np.minimum(a, _MOST) for a in (offset, count, view_begin, length)
        )
        there = (width > 0) & (view < len(views))
        view = np.where(there, view, 0)
        begin, size = view_begin[view] + offset, 4 * width
        there &= (buffer[view] == 0) & ~packed[view] & (begin & 3 == 0)
        there &= (offset + size * count <= length[view]) & ((stride[view] == 0) | (stride[view] == size))
        return cls(np.where(there, begin, -1), count, width)

    def starts(self, indices: Array, counts: Array | int, width: int, size: int) -> Array:
        """Return the index in a first buffer of `size` bytes, as numbers, at which accessors begin that hold
        at least `counts` elements of `width` numbers; -1 for all others.
        """
        if not len(self.begins):
            return np.full(len(indices), -1)
        there = indices < len(self.begins)
        which = np.where(there, indices, 0)
        begins = self.begins[which]
        fits = there & (begins >= 0) & (self.widths[which] == width) & (self.counts[which] >= counts)
        return np.where(fits & (begins <= size - 4 * width * counts), begins // 4, -1)


@dataclass(frozen=True, eq=False)
class ChannelTable:
    """The channels of all animations, one after another.

    `begins` `[A + 1]` says where each animation's channels are. `samplers`, `nodes`, `paths` `[C]` are what
    each channel names; -1 for no node. `inputs`, `modes`, `outputs` `[C]` are those of its sampler; -1 if
    that does not exist, and `NO_MODE` for an unknown mode.
    """

    begins: Array
    samplers: Array
    nodes: Array
    paths: Array
    inputs: Array
    modes: Array
    outputs: Array

    @cached_property
    def odd(self) -> frozenset[int]:
        """Return the animations with channels that are invalid, move no joint, or are unknown."""
        odd = (self.inputs < 0) | (self.modes == NO_MODE) | (self.nodes < 0) | (self.paths > SCALE)
        return frozenset((np.searchsorted(self.begins, np.flatnonzero(odd), "right") - 1).tolist())

    @classmethod
    def of(cls, animations: Sequence[Animation]) -> ChannelTable:
        counts = [len(animation.channels) for animation in animations]
        sampler_counts = np.array([len(animation.samplers) for animation in animations], int)
        every = [c for animation in animations for c in animation.channels]
        samplers = [s for animation in animations for s in animation.samplers]
        which = make_column([c.sampler for c in every])
        targets = [c.target if c.target.extensions is None else c.target.resolved for c in every]
        nodes = make_column([-1 if t.node is None else t.node for t in targets])
        paths = make_column([PATHS.get(t.path, UNKNOWN) for t in targets])
        inputs, outputs = make_column([s.input for s in samplers]), make_column([s.output for s in samplers])
        modes = make_column([MODES.get(s.interpolation, NO_MODE) for s in samplers])
        of = np.repeat(np.arange(len(animations)), counts)
        there = which < sampler_counts[of]
        place = np.where(there, (np.cumsum(sampler_counts) - sampler_counts)[of] + which, 0)
        none = np.full(len(which), -1)
        some = [np.where(there, a[place], -1) if len(a) else none for a in (inputs, modes, outputs)]
        return cls(np.cumsum([0, *counts]), which, nodes, paths, *some)
