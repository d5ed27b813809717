"""Write the binary chunk of a glTF file: its views and accessors, shared if possible, and packed
(EXT_meshopt_compression) on request.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass, field
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from metagraph.formats.gltf.meshopt import MeshoptFilter, MeshoptMode
from metagraph.formats.gltf.meshopt_encoding import (
    encode_exponential,
    encode_octahedral,
    encode_quaternions,
    pack_attributes,
    pack_indices,
)
from metagraph.motion import rotation

Array = NDArray[Any]

FLOAT, SHORT, USHORT, BYTE, UBYTE, UINT = 5126, 5122, 5123, 5120, 5121, 5125
ARRAY_BUFFER, ELEMENT_BUFFER = 34962, 34963
MESHOPT = "EXT_meshopt_compression"
_DTYPES = {FLOAT: "<f4", SHORT: "<i2", USHORT: "<u2", BYTE: "<i1", UBYTE: "<u1", UINT: "<u4"}
_TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4", 16: "MAT4"}


@dataclass(frozen=True)
class Packing:
    """How values are packed if files are.

    `mode` and `filter` are the extension's. `amount` is the number of bits of a component, or the exponent
    for floats, which become integers times 2 to that power (-16: their error in metres is 8 micrometres at
    most).
    """

    mode: MeshoptMode = "ATTRIBUTES"
    filter: MeshoptFilter = "NONE"
    amount: int = 0

    def rounded(self, values: Array) -> Array:
        """Return floats as they will be read back."""
        if self.filter != "EXPONENTIAL":
            return values
        whole = np.frombuffer(encode_exponential(values, self.amount), "<i4")
        floats: Array = np.ldexp((whole << 8 >> 8).astype(np.float32), whole >> 24)
        return floats.reshape(values.shape)

    def packed(self, raw: bytes, stride: int) -> bytes:
        """Return a view's bytes packed. Normals and turns are given in their unpacked form."""
        if self.mode != "ATTRIBUTES":
            return pack_indices(np.frombuffer(raw, "<u2" if stride == 2 else "<u4"))
        if self.filter == "EXPONENTIAL":
            raw = encode_exponential(np.frombuffer(raw, "<f4"), self.amount)
        elif self.filter == "QUATERNION":
            turns = np.frombuffer(raw, "<i2").reshape(-1, 4).astype(np.float64)
            raw = encode_quaternions(rotation.normalize(turns), self.amount)
        elif self.filter == "OCTAHEDRAL":
            raw = encode_octahedral(np.frombuffer(raw, "<i1").reshape(-1, 4)[:, :3], self.amount)
        return pack_attributes(raw, stride)


@dataclass
class _Pool:
    """Values of one kind, one after another in one view. An element has `stride` bytes."""

    stride: int
    packing: Packing | None
    data: bytearray = field(default_factory=bytearray)
    users: list[dict[str, Any]] = field(default_factory=list)


class BinaryChunk:
    """The growing binary chunk, with its views and accessors. Equal arrays are stored once. With `compress`,
    arrays that have a packing are packed.
    """

    def __init__(self, compress: bool = False) -> None:
        self.data = bytearray()
        self.views: list[dict[str, Any]] = []
        self.accessors: list[dict[str, Any]] = []
        self.compress = compress
        self.unpacked = 0  # bytes that packed views take when unpacked
        self._known: dict[tuple[Any, ...], int] = {}
        self._pools: dict[tuple[Any, ...], _Pool] = {}

    def view(
        self,
        raw: bytes,
        target: int | None = None,
        stride: int = 0,
        packing: Packing | None = None,
        size: int = 0,
    ) -> int:
        """Add bytes and return their view's index. `stride` is that of vertex attributes; `size` is the
        number of bytes of an element.
        """
        view: dict[str, Any] = {"byteLength": len(raw)}
        if target:
            view["target"] = target
        if stride:
            view["byteStride"] = stride
        stored, place = raw, view
        if self.compress and packing is not None and raw:
            stored = packing.packed(raw, size)
            view |= {"buffer": 1, "byteOffset": self.unpacked}
            self.unpacked += len(raw) + -len(raw) % 4
            place = {
                "byteLength": len(stored),
                "byteStride": size,
                "count": len(raw) // size,
                "mode": packing.mode,
            }
            if packing.filter != "NONE":
                place["filter"] = packing.filter
            view["extensions"] = {MESHOPT: place}
        self.data += b"\0" * (-len(self.data) % 4)
        place |= {"buffer": 0, "byteOffset": len(self.data)}
        self.data += stored
        self.views.append(view)
        return len(self.views) - 1

    def array(
        self,
        values: Array,
        component: int,
        *,
        target: int | None = None,
        normalized: bool = False,
        bounds: bool = False,
        packing: Packing | None = None,
        shared: str = "",
    ) -> int:
        """Add `[count]` or `[count, n]` values and return the accessor's index. `shared` names a view that
        has all such values one after another; without it, they have their own view.
        """
        if self.compress and packing is not None:
            values = packing.rounded(np.asarray(values, _DTYPES[component]))
        values = np.ascontiguousarray(values, _DTYPES[component])
        key = (values.tobytes(), component, values.shape, target, normalized)
        if key in self._known:
            return self._known[key]
        width = 1 if values.ndim == 1 else values.shape[1]
        size = width * values.itemsize
        stride = 0
        raw = values.tobytes()
        if target == ARRAY_BUFFER and size % 4:  # vertex attributes must begin at multiples of four
            padded = np.zeros((len(values), size + (-size % 4)), np.uint8)
            padded[:, :size] = values.view(np.uint8).reshape(len(values), size)
            raw, stride = padded.tobytes(), padded.shape[1]
        accessor: dict[str, Any] = {}
        if shared:
            self._share(shared, raw, size, packing, accessor)
        else:
            accessor["bufferView"] = self.view(raw, target, stride, packing, stride or size)
        accessor |= {"componentType": component, "count": len(values), "type": _TYPES[width]}
        if normalized:
            accessor["normalized"] = True
        if bounds:
            flat = values.reshape(len(values), width).astype(float)
            accessor["min"], accessor["max"] = flat.min(0).tolist(), flat.max(0).tolist()
        self.accessors.append(accessor)
        self._known[key] = len(self.accessors) - 1
        return self._known[key]

    def _share(self, name: str, raw: bytes, size: int, packing: Packing | None, user: dict[str, Any]) -> None:
        pool = self._pools.setdefault((name, size), _Pool(size, packing))
        if pool.data:
            user["byteOffset"] = len(pool.data)
        pool.data += raw
        pool.users.append(user)

    def sparse(self, offsets: Array, packing: Packing | None = None) -> int:
        """Add offsets `[count, 3]` of a morph target and return the accessor's index. Only the offsets that
        are not zero are stored, if that is smaller, in views of their own: Godot reads no others.
        """
        if self.compress and packing is not None:
            offsets = packing.rounded(np.asarray(offsets, np.float32))
        moved = np.flatnonzero(np.abs(offsets).max(1))
        if not len(moved) or 2 * len(moved) > len(offsets):
            return self.array(offsets, FLOAT, target=ARRAY_BUFFER, bounds=True, packing=packing)
        kind = (USHORT, "<u2") if moved[-1] < 65535 else (UINT, "<u4")
        kept = np.ascontiguousarray(offsets[moved], "<f4")
        low, high = np.minimum(kept.min(0), 0).astype(float), np.maximum(kept.max(0), 0).astype(float)
        size = int(kind[1][2])
        places = self.view(moved.astype(kind[1]).tobytes(), packing=Packing("INDICES"), size=size)
        values = self.view(kept.tobytes(), packing=packing, size=12)
        self.accessors.append(
            {
                "componentType": FLOAT,
                "count": len(offsets),
                "type": "VEC3",
                "min": low.tolist(),
                "max": high.tolist(),
                "sparse": {
                    "count": len(moved),
                    "indices": {"bufferView": places, "componentType": kind[0]},
                    "values": {"bufferView": values},
                },
            }
        )
        return len(self.accessors) - 1

    def close(self) -> None:
        """Make the views of shared values."""
        for pool in self._pools.values():
            place = self.view(bytes(pool.data), packing=pool.packing, size=pool.stride)
            for user in pool.users:
                user["bufferView"] = place
        self._pools = {}


def make_glb_bytes(document: dict[str, Any], body: BinaryChunk) -> bytes:
    """Return the file: header, JSON and binary chunk. The accessors, views and buffers of `body` are added to
    `document`.
    """
    body.close()
    document["accessors"], document["bufferViews"] = body.accessors, body.views
    body.data += b"\0" * (-len(body.data) % 4)
    document["buffers"] = [{"byteLength": len(body.data)}]
    if body.unpacked:
        # A buffer without data, for the unpacked content of packed views.
        document["buffers"].append({"byteLength": body.unpacked, "extensions": {MESHOPT: {"fallback": True}}})
        for name in ("extensionsUsed", "extensionsRequired"):
            document[name] = sorted({*document.get(name, ()), MESHOPT})
    head = msgspec.json.encode(document)
    head += b" " * (-len(head) % 4)
    size = 12 + 8 + len(head) + 8 + len(body.data)
    start = struct.pack("<4sIIII", b"glTF", 2, size, len(head), 0x4E4F534A)
    return b"".join((start, head, struct.pack("<II", len(body.data), 0x004E4942), body.data))
