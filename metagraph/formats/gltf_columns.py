"""The long lists of a glTF file as columns of numbers: it may have ten thousand accessors and channels.

Columns come from values that were read, or, where compiled loops are there, from the text itself: then values
are made of what is asked for alone.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import Any, Generic, TypeVar, cast, overload

import msgspec
import numpy as np
from numpy.typing import NDArray

from metagraph.formats.gltf_loops import TEXT
from metagraph.formats.gltf_values import Accessor, Animation, BufferView, Channel, Document, Sampler
from metagraph.records import dataclass

Array = NDArray[Any]
Value = TypeVar("Value")

FLOAT = 5126
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
TRANSLATION, ROTATION, SCALE, WEIGHTS, UNKNOWN = range(5)
PATHS = {"translation": TRANSLATION, "rotation": ROTATION, "scale": SCALE, "weights": WEIGHTS}
LINEAR, STEP, SPLINE, NO_MODE = range(4)
MODES = {"LINEAR": LINEAR, "STEP": STEP, "CUBICSPLINE": SPLINE}
_MOST = 1 << 40  # bytes: what is more is beyond any file just as well, and sums of it are still numbers

# Fields as `json_kernels.rows` reads them: what each holds, and that there must be one.
_NUMBER, _TEXT, _TRUTH, _OBJECT, _NEEDED = *range(4), 4
_Fields = dict[str, int]
_ACCESSOR: _Fields = {
    "componentType": _NUMBER | _NEEDED, "count": _NUMBER | _NEEDED, "type": _TEXT | _NEEDED,
    "bufferView": _NUMBER, "byteOffset": _NUMBER, "normalized": _TRUTH, "sparse": _OBJECT,
}  # fmt: skip
_VIEW: _Fields = {
    "buffer": _NUMBER | _NEEDED, "byteLength": _NUMBER | _NEEDED, "byteOffset": _NUMBER,
    "byteStride": _NUMBER, "extensions": _OBJECT,
}  # fmt: skip
_CHANNEL: _Fields = {"sampler": _NUMBER | _NEEDED, "target": _OBJECT | _NEEDED}
_TARGET: _Fields = {"path": _TEXT | _NEEDED, "node": _NUMBER}
_SAMPLER: _Fields = {"input": _NUMBER | _NEEDED, "output": _NUMBER | _NEEDED, "interpolation": _TEXT}
_FACTOR = 0x9E3779B1  # as there
_SHORTEST = 20  # bytes that any of these takes at least


class Rows(Sequence[Value]):
    """A list of JSON objects of which values are made when they are asked for. numbers `[R, F]`: of fields,
    -1 where one is not there; of text the digest.
    """

    def __init__(
        self, text: msgspec.Raw, decoder: msgspec.json.Decoder[Value], numbers: Array, ends: Array
    ) -> None:
        """ends `[R, 2]`: where in the text each object begins and ends."""
        self.numbers = numbers
        self._text, self._ends, self._decoder = text, ends, decoder
        self._made: dict[int, Value] = {}

    def __len__(self) -> int:
        return len(self.numbers)

    @overload
    def __getitem__(self, which: int) -> Value: ...
    @overload
    def __getitem__(self, which: slice) -> Sequence[Value]: ...
    def __getitem__(self, which: int | slice) -> Value | Sequence[Value]:
        if isinstance(which, slice):
            return [self[n] for n in range(len(self))[which]]
        n = range(len(self))[which]
        if n not in self._made:
            begin, end = self._ends[n].tolist()
            self._made[n] = self._decoder.decode(memoryview(self._text)[begin:end])
        return self._made[n]


def _digest(text: str) -> int:
    """Return what `json_kernels.rows` makes of text."""
    digest = 1
    for byte in text.encode():
        digest = (digest * _FACTOR + byte) & 0xFFFFFFFFFFFF
    return digest


class _Form(Generic[Value]):
    """How a list of one kind of objects is read."""

    def __init__(self, kind: type[Value], fields: _Fields, inner: _Fields | None = None) -> None:
        """inner: fields of the object that the last field is."""
        whole = {**fields, **(inner or {})}
        self._decoder, self._within = msgspec.json.Decoder(kind), len(fields)
        self._names, self._kinds = np.array([*map(_digest, whole)]), np.array([*whole.values()])

    def read(self, text: msgspec.Raw) -> Rows[Value] | None:
        """Return the list that text is; None where it is not one of just such objects."""
        data = np.frombuffer(text, np.uint8)
        most = len(data) // _SHORTEST + 1
        numbers, ends = np.empty((most, len(self._names)), np.int64), np.empty((most, 2), np.int64)
        count = TEXT.now.rows(data, self._names, self._kinds, self._within, numbers, ends)
        return Rows(text, self._decoder, numbers[:count], ends) if count >= 0 else None


_CHANNELS, _SAMPLERS = _Form(Channel, _CHANNEL, _TARGET), _Form(Sampler, _SAMPLER)
_ACCESSORS, _VIEWS = _Form(Accessor, _ACCESSOR), _Form(BufferView, _VIEW)


class _Head(msgspec.Struct, gc=False):
    """An animation but for its lists."""

    channels: msgspec.Raw
    samplers: msgspec.Raw
    name: str = ""
    extras: msgspec.Raw = msgspec.Raw()


class _Heads(Document):
    """A document but for its long lists."""

    animations: list[_Head] = msgspec.field(default_factory=list)  # type: ignore[assignment]
    accessors: msgspec.Raw = msgspec.Raw(b"[]")  # type: ignore[assignment]
    buffer_views: msgspec.Raw = msgspec.Raw(b"[]")  # type: ignore[assignment]


_whole, _heads = msgspec.json.Decoder(Document), msgspec.json.Decoder(_Heads)


def decoded(text: bytes | memoryview) -> Document:
    """Return what a file's JSON says. Raises MsgspecError, RecursionError, ValueError."""
    if TEXT.now is not None:
        try:
            document = _by_rows(_heads.decode(text))
        except (msgspec.MsgspecError, RecursionError, ValueError):
            document = None  # what is wrong is told of the whole
        if document is not None:
            return document
    return _whole.decode(text)


def _by_rows(heads: _Heads) -> Document | None:
    """Return the document with lists of which values are made when asked for; None where they are none."""
    out = cast(Any, heads)
    animations = []
    for head in heads.animations:
        channels = _CHANNELS.read(head.channels)
        samplers = _SAMPLERS.read(head.samplers)
        if channels is None or samplers is None:
            return None
        animations.append(Animation(cast(Any, channels), cast(Any, samplers), head.name, head.extras))
    accessors = _ACCESSORS.read(heads.accessors)
    views = _VIEWS.read(heads.buffer_views)
    if accessors is None or views is None:
        return None
    for rows in (accessors, views):
        for deeper in np.flatnonzero(rows.numbers[:, -1] >= 0).tolist():
            rows[deeper]  # what is within is looked at now
    out.animations, out.accessors, out.buffer_views = animations, accessors, views
    return cast(Document, out)


def column(numbers: list[int]) -> Array:
    """Return whole numbers as an array; the largest there is for larger ones."""
    try:
        return np.array(numbers, np.int64)
    except OverflowError:
        return np.array([min(number, (1 << 63) - 1) for number in numbers], np.int64)


def _coded(digests: Array, codes: Mapping[str, int], other: int, none: int) -> Array:
    """Return the codes of text: `other` for what is unknown, `none` for no text."""
    out = np.full(len(digests), other)
    out[digests == -1] = none
    for text, code in codes.items():
        out[digests == _digest(text)] = code
    return out


@dataclass(frozen=True, eq=False)
class PlainAccessors:
    """Which accessors are float32 numbers one after another in the first buffer. begins `[A]`: the byte where
    each begins, -1 where it is not so. counts, widths `[A]`: its elements, and how many numbers each has.
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
        if isinstance(accessors, Rows) and isinstance(views, Rows):
            component, count, kind, view, offset, _, sparse = accessors.numbers.T
            plain = (component == FLOAT) & (sparse < 0) & (view >= 0)
            offset, width = np.maximum(offset, 0), _coded(kind, WIDTHS, 0, 0)
            buffer, length, view_begin, stride, extensions = views.numbers.T
            view_begin, stride = np.maximum(view_begin, 0), np.maximum(stride, 0)
            packed = np.zeros(len(views), bool)
            packed[[n for n in np.flatnonzero(extensions >= 0).tolist() if views[n].packed is not None]] = (
                True
            )
        else:
            width_of = WIDTHS.get
            rows = [
                (a.buffer_view, a.byte_offset, a.count, width_of(a.type, 0))
                if a.component_type == FLOAT and a.sparse is None and a.buffer_view is not None
                else (0, 0, 0, 0)
                for a in accessors
            ]
            lying = [(v.buffer, v.byte_offset, v.byte_length, v.byte_stride) for v in views]
            view, offset, count, width = (column([*some]) for some in zip(*rows, strict=True))
            buffer, view_begin, length, stride = (column([*some]) for some in zip(*lying, strict=True))
            plain, packed = width > 0, np.array([v.packed is not None for v in views])
        offset, count, view_begin, length = (
            np.minimum(a, _MOST) for a in (offset, count, view_begin, length)
        )
        there = plain & (width > 0) & (view < len(views))
        view = np.where(there, view, 0)
        begin, size = view_begin[view] + offset, 4 * width
        there &= (buffer[view] == 0) & ~packed[view] & (begin & 3 == 0)
        there &= (offset + size * count <= length[view]) & ((stride[view] == 0) | (stride[view] == size))
        return cls(np.where(there, begin, -1), count, width)

    def starts(self, indices: Array, counts: Array | int, width: int, size: int) -> Array:
        """Return where among a first buffer of `size` bytes, as numbers, accessors begin that hold `counts`
        elements of `width` numbers, or more; -1 for all that do not, or lie in other ways.
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
    """Channels of all animations, one after another. begins `[A + 1]`: where each animation's are. samplers,
    nodes, paths `[C]`: what each names; -1 for no node. inputs, modes, outputs `[C]`: of the sampler; of one
    that does not exist -1, of a mode that is unknown `NO_MODE`.
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
        """Animations with channels that make no sense, that move no joint or that nothing is known of."""
        odd = (self.inputs < 0) | (self.modes == NO_MODE) | (self.nodes < 0) | (self.paths > SCALE)
        return frozenset((np.searchsorted(self.begins, np.flatnonzero(odd), "right") - 1).tolist())

    @classmethod
    def of(cls, animations: Sequence[Animation]) -> ChannelTable:
        counts = [len(animation.channels) for animation in animations]
        sampler_counts = np.array([len(animation.samplers) for animation in animations], int)
        if animations and all(isinstance(a.channels, Rows) for a in animations):
            channels = [cast(Any, a.channels).numbers for a in animations]
            own = [cast(Any, a.samplers).numbers for a in animations]
            which, _, kinds, nodes = np.concatenate(channels).T
            inputs, outputs, said = np.concatenate(own).T
            paths, modes = _coded(kinds, PATHS, UNKNOWN, UNKNOWN), _coded(said, MODES, NO_MODE, LINEAR)
        else:
            every = [c for animation in animations for c in animation.channels]
            samplers = [s for animation in animations for s in animation.samplers]
            path_of, mode_of = PATHS.get, MODES.get
            which = column([c.sampler for c in every])
            nodes = column([-1 if c.target.node is None else c.target.node for c in every])
            paths = column([path_of(c.target.path, UNKNOWN) for c in every])
            inputs, outputs = column([s.input for s in samplers]), column([s.output for s in samplers])
            modes = column([mode_of(s.interpolation, NO_MODE) for s in samplers])
        of = np.repeat(np.arange(len(animations)), counts)
        there = which < sampler_counts[of]
        place = np.where(there, (np.cumsum(sampler_counts) - sampler_counts)[of] + which, 0)
        none = np.full(len(which), -1)
        some = [np.where(there, a[place], -1) if len(a) else none for a in (inputs, modes, outputs)]
        return cls(np.cumsum([0, *counts]), which, nodes, paths, *some)
