"""Open and check a glTF 2.0 file; return its buffers, and accessors as arrays.

Nothing in the file is trusted: every index, length and range is checked before use, and `Gltf.spend` limits
the memory that a small file may take (zero-filled accessors, long resampled clips).
"""

from __future__ import annotations

import base64
import binascii
import struct
from functools import cached_property
from pathlib import Path
from typing import Any, NoReturn
from urllib.parse import unquote

import msgspec
import numpy as np
from numpy.typing import NDArray

from metagraph.common.budgets import MOTION_FILE, OUT_OF_PROPORTION, PATH_LENGTH, Allowance
from metagraph.common.files import read_file
from metagraph.common.network_paths import explain_refusal
from metagraph.common.wording import phrase
from metagraph.errors import FileError
from metagraph.formats.gltf.columns import WIDTHS, ChannelTable, PlainAccessors, decode_columns
from metagraph.formats.gltf.meshopt import MeshoptError, unpack_buffer
from metagraph.formats.gltf.values import Accessor, Buffer, BufferView, Document, PackedView, Sparse
from metagraph.formats.gltf.vrm_animation import VrmFace, find_vrm_face

Array = NDArray[Any]

DAMAGED = phrase("The file is damaged: export it again.")
_COMPONENTS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_DTYPES = {code: np.dtype(name) for code, name in _COMPONENTS.items()}
# Required extensions that change nothing we read, or that this reader supports.
_KNOWN = (
    "KHR_mesh_quantization",
    "EXT_meshopt_compression",
    "KHR_materials_",
    "KHR_texture_",
    "EXT_texture_",
    "KHR_lights_",
    "KHR_xmp",
    "VRM",
    "KHR_node_visibility",
    "KHR_animation_pointer",
)
DRACO = "KHR_draco_mesh_compression"
_REMEDIES = {
    DRACO: "Export it again without Draco compression, or unpack it with 'gltf-transform copy'.",
}


class Gltf:
    """An open file: `json`, and arrays on request. Every problem is a FileError that names the place."""

    def __init__(self, path: Path, document: Document, binary: memoryview | None, size: int) -> None:
        self.path, self.json = path, document
        self._binary = binary
        self._buffers: dict[int, memoryview] = {}
        self._named: dict[str, bytes] = {}  # files beside this one
        self._unpacked: dict[int, memoryview] = {}
        self._allowance = Allowance(size, lambda where: self.fail(OUT_OF_PROPORTION, where))
        for name in document.extensions_required:
            if not name.startswith(_KNOWN) and name != DRACO:
                self._fail_for(name)

    def require_meshes(self) -> None:
        """Refuse a file whose meshes are packed in a way that is not read; its motion may be read."""
        if DRACO in self.json.extensions_required:
            self._fail_for(DRACO)

    def _fail_for(self, extension: str) -> NoReturn:
        self.fail(
            phrase("it needs the glTF extension {name}, which is not supported", name=extension),
            phrase("its required extensions"),
            _REMEDIES.get(extension, "Export it again without it."),
        )

    def fail(self, cause: str, where: str, remedy: str = DAMAGED) -> NoReturn:
        raise FileError(self.path, cause, where, remedy)

    def spend(self, size: int, where: str) -> None:
        """Count `size` bytes that the file needs beyond its own. Raises FileError if the sum is out of
        proportion.
        """
        self._allowance.spend(size, where)

    def item(self, items: list[Any], index: int, kind: str, where: str) -> Any:
        """Return `items[index]`, or fail and name what refers to it."""
        if index >= len(items):
            self.fail(
                phrase(
                    "{kind} {index} does not exist (there are {count})",
                    kind=kind,
                    index=index,
                    count=len(items),
                ),
                where,
            )
        return items[index]

    def buffer(self, index: int, where: str) -> memoryview:
        """Return a buffer's bytes."""
        if index not in self._buffers:
            value: Buffer = self.item(self.json.buffers, index, "buffer", where)
            if value.uri is None:
                if index or self._binary is None:
                    self.fail(phrase("buffer {index} has no data", index=index), where)
                self._buffers[index] = self._binary
            else:
                self._buffers[index] = memoryview(self.resource(value.uri, f"buffer {index}"))
        return self._buffers[index]

    def resource(self, uri: str, where: str) -> bytes:
        """Return the bytes of a data URI or of a file beside this one. Raises FileError if it is missing or
        elsewhere.
        """
        if uri.startswith("data:"):
            self.spend(len(uri), where)
            head, comma, body = uri.partition(",")
            try:
                return (
                    base64.b64decode(body, validate=True)
                    if head.endswith(";base64") and comma
                    else unquote(body).encode("latin-1")
                )
            except (binascii.Error, ValueError) as error:
                self.fail(phrase("its data URI cannot be decoded ({error})", error=error), where)
        name = unquote(uri[:PATH_LENGTH])
        if name in self._named:
            return self._named[name]
        if (why := explain_refusal(name, self.path.parent)) is not None:  # never; its files are beside it
            self.fail(
                phrase("'{name}' was not opened: {why}", name=name[:80], why=why),
                where,
                phrase("Put that file beside the glTF file."),
            )
        try:
            folder = self.path.parent.resolve()
            target = (folder / name).resolve()
            inside = "://" not in name and target.is_relative_to(folder)
        except (OSError, ValueError):
            target, inside = self.path / name, True
        if not inside:
            self.fail(
                phrase("it points to '{name}', outside the file's own folder", name=name[:80]),
                where,
                phrase("Put that file beside the glTF file."),
            )
        try:
            data = self._named[name] = read_file(target, MOTION_FILE)
        except FileError as error:
            self.fail(
                phrase("'{name}' {cause}", name=name[:80], cause=error.cause),
                where,
                phrase("Put it beside the glTF file, or export one .glb file."),
            )
        self._allowance.add(len(data))
        return data

    def view(self, index: int, where: str) -> tuple[memoryview, BufferView]:
        """Return the bytes of a buffer view and its description."""
        view: BufferView = self.item(self.json.buffer_views, index, "buffer view", where)
        if view.packed is not None:
            return self._unpack(index, view, view.packed), view
        data = self.buffer(view.buffer, f"buffer view {index}")
        if view.byte_offset + view.byte_length > len(data):
            self.fail(
                phrase(
                    "buffer view {index} ends at byte {value} of {count}",
                    index=index,
                    value=view.byte_offset + view.byte_length,
                    count=len(data),
                ),
                where,
            )
        return data[view.byte_offset : view.byte_offset + view.byte_length], view

    def _unpack(self, index: int, view: BufferView, packed: PackedView) -> memoryview:
        if index not in self._unpacked:
            where = f"buffer view {index}"
            data = self.buffer(packed.buffer, where)
            end, size = packed.byte_offset + packed.byte_length, packed.count * packed.byte_stride
            if end > len(data) or size != view.byte_length:
                self.fail(
                    f"it is packed up to byte {end} of {len(data)}, {size} of {view.byte_length} bytes", where
                )
            self.spend(size, where)
            try:
                raw = unpack_buffer(
                    bytes(data[packed.byte_offset : end]),
                    packed.count,
                    packed.byte_stride,
                    packed.mode,
                    packed.filter,
                )
            except MeshoptError as error:
                self.fail(str(error), where)
            self._unpacked[index] = memoryview(raw)
        return self._unpacked[index]

    def array(self, index: int, where: str, kind: str = "") -> Array:
        """Return accessor `index` as `[count, n]`, or `[count]` for scalars; normalised integers become
        float32.

        `kind` is the type it must have ("VEC3"), if any. The array may be a view of the file's bytes: do not
        write to it.
        """
        accessor: Accessor = self.item(self.json.accessors, index, "accessor", where)
        dtype, width = _DTYPES.get(accessor.component_type), WIDTHS.get(accessor.type)
        if dtype is None or width is None or (width == 16 and accessor.component_type != 5126):
            self.fail(
                phrase(
                    "accessor {index} has component type {component_type} and type '{type}'",
                    index=index,
                    component_type=accessor.component_type,
                    type=accessor.type,
                ),
                where,
            )
        if kind and accessor.type != kind:
            self.fail(
                phrase(
                    "accessor {index} holds {type}, expected {kind}",
                    index=index,
                    type=accessor.type,
                    kind=kind,
                ),
                where,
            )
        if accessor.buffer_view is None:
            self.spend(accessor.count * width * dtype.itemsize, where)
            out = np.zeros((accessor.count, width), dtype)
        else:
            out = self._strided(accessor, index, dtype, width, where)
        if accessor.sparse is not None:
            self.spend(out.nbytes, where)
            out = self._with_sparse(out, accessor.sparse, dtype, width, f"{where}, accessor {index}")
        if accessor.normalized and dtype.kind != "f":
            out = np.maximum(out.astype(np.float32) / np.float32(np.iinfo(dtype).max), np.float32(-1))
        return out[:, 0] if width == 1 else out

    def numbers(self, where: str) -> Array:
        """Return the first buffer as float32 numbers, without remaining bytes at its end."""
        data = self.buffer(0, where)
        return np.frombuffer(data, "<f4", len(data) // 4)

    def starts(self, indices: Array, counts: Array | int, width: int, where: str) -> Array:
        """Return where accessors of contiguous float32 numbers in the first buffer begin among `numbers`, as
        `PlainAccessors` does.
        """
        return self.plain.starts(indices, counts, width, len(self.buffer(0, where)))

    @cached_property
    def vrm_face(self) -> VrmFace:
        """Return the nodes that are the face of a VRM animation."""
        return find_vrm_face(get_extras(self.json.extensions))

    @cached_property
    def channels(self) -> ChannelTable:
        """Return the channels of all animations."""
        return ChannelTable.of(self.json.animations)

    @cached_property
    def plain(self) -> PlainAccessors:
        """Return which accessors are contiguous float32 numbers in the first buffer."""
        return PlainAccessors.of(self.json)

    def _strided(self, accessor: Accessor, index: int, dtype: np.dtype[Any], width: int, where: str) -> Array:
        assert accessor.buffer_view is not None
        data, view = self.view(accessor.buffer_view, where)
        item = width * dtype.itemsize
        stride = view.byte_stride or item
        end = accessor.byte_offset + stride * (accessor.count - 1) + item if accessor.count else 0
        if stride < item or end > len(data):
            self.fail(
                phrase(
                    "accessor {index} ends at byte {end} of a buffer view of {count}",
                    index=index,
                    end=end,
                    count=len(data),
                ),
                where,
            )
        return np.ndarray(
            (accessor.count, width),
            dtype,
            data,
            accessor.byte_offset if accessor.count else 0,
            (stride, dtype.itemsize),
        )

    def _with_sparse(
        self, base: Array, sparse: Sparse, dtype: np.dtype[Any], width: int, where: str
    ) -> Array:
        places_type = _DTYPES.get(sparse.indices.component_type)
        if places_type is None or places_type.kind != "u":
            self.fail(phrase("its sparse indices are not unsigned integers"), where)
        data, _ = self.view(sparse.indices.buffer_view, where)
        values, _ = self.view(sparse.values.buffer_view, where)
        if sparse.indices.byte_offset + sparse.count * places_type.itemsize > len(
            data
        ) or sparse.values.byte_offset + sparse.count * width * dtype.itemsize > len(values):
            self.fail(phrase("its sparse values are beyond their buffer view"), where)
        places = np.frombuffer(data, places_type, sparse.count, sparse.indices.byte_offset)
        if sparse.count and int(places.max()) >= len(base):
            self.fail(
                phrase(
                    "its sparse index {int} is beyond its {count} elements",
                    int=int(places.max()),
                    count=len(base),
                ),
                where,
            )
        out = base.copy()
        out[places] = np.frombuffer(values, dtype, sparse.count * width, sparse.values.byte_offset).reshape(
            -1, width
        )
        return out


def open_gltf(path: str | Path) -> Gltf:
    """Open a .glb, .vrm or .gltf file. Raises FileError."""
    return parse_gltf(Path(path), read_file(path, MOTION_FILE))


def parse_gltf(path: Path, data: bytes) -> Gltf:
    """Open the bytes of a file. `path` names it in errors, and its buffers are beside it. Raises
    FileError.
    """
    text: bytes | memoryview = data
    binary = None
    if data[:4] == b"glTF":
        text, binary = _chunks(path, data)
    elif data[:3] == b"\xef\xbb\xbf":
        text = data[3:]
    elif data.lstrip()[:1] != b"{":
        raise FileError(
            path,
            phrase("it is neither a binary nor a text glTF file"),
            phrase("its first bytes"),
            phrase("Check that the file has the right extension."),
        )
    try:
        document = decode_columns(text)
    except (msgspec.MsgspecError, RecursionError, ValueError) as error:
        raise FileError(
            path,
            phrase("its JSON does not describe a glTF scene ({error})", error=error),
            phrase("its header"),
            phrase("Export it again."),
        ) from error
    return Gltf(path, document, binary, len(data))


def _chunks(path: Path, data: bytes) -> tuple[memoryview, memoryview | None]:
    """Return the JSON and binary chunks of a GLB file."""
    remedy = phrase("The file is cut off or damaged: copy or export it again.")
    if len(data) < 20:
        raise FileError(
            path, phrase("it ends after {count} bytes", count=len(data)), phrase("its header"), remedy
        )
    version, _, size, kind = struct.unpack_from("<IIII", data, 4)
    if version != 2:
        raise FileError(
            path,
            phrase("it is glTF version {version}", version=version),
            phrase("its header"),
            phrase("Export it as glTF 2.0."),
        )
    if kind != 0x4E4F534A or 20 + size > len(data):
        raise FileError(
            path,
            phrase(
                "its JSON chunk of {size} bytes does not fit its {count} bytes", size=size, count=len(data)
            ),
            phrase("its header"),
            remedy,
        )
    whole = memoryview(data)
    at, binary = 20 + size, None
    while at + 8 <= len(data):
        length, kind = struct.unpack_from("<II", data, at)
        if kind == 0x004E4942:
            if at + 8 + length > len(data):
                raise FileError(
                    path,
                    phrase(
                        "its binary chunk of {length} bytes is cut off after {value}",
                        length=length,
                        value=len(data) - at - 8,
                    ),
                    phrase("its binary chunk"),
                    remedy,
                )
            binary = whole[at + 8 : at + 8 + length]
            break
        at += 8 + length + (-length % 4)
    return whole[20 : 20 + size], binary


def get_extras(raw: msgspec.Raw) -> dict[str, Any]:
    """Return `extras` or `extensions` as a dictionary; empty if there are none or they have another form."""
    if not bytes(raw):
        return {}
    try:
        value = msgspec.json.decode(raw)
    except (msgspec.MsgspecError, RecursionError, ValueError):
        return {}
    return value if isinstance(value, dict) else {}
