"""Define the JSON of a glTF 2.0 file as typed values."""

from __future__ import annotations

import re
from typing import Annotated

import msgspec

from metagraph.formats.gltf.meshopt import MeshoptFilter, MeshoptMode

_POINTER = re.compile(r"/nodes/(\d{1,9})/(translation|rotation|scale|weights)")  # KHR_animation_pointer's
Index = Annotated[int, msgspec.Meta(ge=0)]
Vec3 = tuple[float, float, float]
Vec4 = tuple[float, float, float, float]


class _Value(msgspec.Struct, rename="camel", gc=False):
    pass


class SparseIndices(_Value):
    buffer_view: Index
    component_type: int
    byte_offset: Index = 0


class SparseValues(_Value):
    buffer_view: Index
    byte_offset: Index = 0


class Sparse(_Value):
    count: Index
    indices: SparseIndices
    values: SparseValues


class Accessor(_Value):
    component_type: int
    count: Index
    type: str
    buffer_view: Index | None = None
    byte_offset: Index = 0
    normalized: bool = False
    sparse: Sparse | None = None


class PackedView(_Value):
    """The EXT_meshopt_compression extension of a view."""

    buffer: Index
    byte_length: Index
    byte_stride: Index
    count: Index
    mode: MeshoptMode
    byte_offset: Index = 0
    filter: MeshoptFilter = "NONE"


class ViewExtensions(msgspec.Struct, gc=False):
    packed: PackedView | None = msgspec.field(name="EXT_meshopt_compression", default=None)


class BufferView(_Value):
    buffer: Index
    byte_length: Index
    byte_offset: Index = 0
    byte_stride: Index = 0
    extensions: ViewExtensions | None = None

    @property
    def packed(self) -> PackedView | None:
        return self.extensions.packed if self.extensions is not None else None


class Buffer(_Value):
    byte_length: Index
    uri: str | None = None


class Node(_Value):
    name: str = ""
    children: list[Index] = []
    translation: Vec3 | None = None
    rotation: Vec4 | None = None
    scale: Vec3 | None = None
    matrix: list[float] | None = None
    mesh: Index | None = None
    skin: Index | None = None
    camera: Index | None = None
    weights: list[float] | None = None
    extras: msgspec.Raw = msgspec.Raw()


class Skin(_Value):
    joints: list[Index]
    inverse_bind_matrices: Index | None = None
    skeleton: Index | None = None


class PointerTarget(_Value):
    """The KHR_animation_pointer extension of a target: a JSON pointer to what moves."""

    pointer: str


class TargetExtensions(msgspec.Struct, gc=False):
    pointed: PointerTarget | None = msgspec.field(name="KHR_animation_pointer", default=None)


class GltfTarget(_Value):
    path: str
    node: Index | None = None
    extensions: TargetExtensions | None = None

    @property
    def resolved(self) -> GltfTarget:
        """Return what a pointer to a node's own transform or weights says in glTF 2.0's words; of another
        pointer, a target without a node whose path is the pointer.
        """
        if self.path != "pointer" or self.extensions is None or self.extensions.pointed is None:
            return self
        pointer = self.extensions.pointed.pointer
        found = _POINTER.fullmatch(pointer)
        return GltfTarget(found[2], int(found[1])) if found is not None else GltfTarget(pointer)


class Channel(_Value):
    sampler: Index
    target: GltfTarget


class Sampler(_Value):
    input: Index
    output: Index
    interpolation: str = "LINEAR"


class Animation(_Value):
    channels: list[Channel]
    samplers: list[Sampler]
    name: str = ""
    extras: msgspec.Raw = msgspec.Raw()


class Primitive(_Value):
    attributes: dict[str, Index]
    indices: Index | None = None
    material: Index | None = None
    mode: int = 4
    targets: list[dict[str, Index]] = []
    extras: msgspec.Raw = msgspec.Raw()


class Mesh(_Value):
    primitives: list[Primitive]
    name: str = ""
    weights: list[float] | None = None
    extras: msgspec.Raw = msgspec.Raw()


class TextureInfo(_Value):
    index: Index
    tex_coord: int = 0


class Pbr(_Value):
    base_color_factor: Vec4 = (1.0, 1.0, 1.0, 1.0)
    base_color_texture: TextureInfo | None = None
    roughness_factor: float = 1.0


class MaterialValue(_Value):
    name: str = ""
    pbr_metallic_roughness: Pbr | None = None
    double_sided: bool = False
    normal_texture: TextureInfo | None = None


class Texture(_Value):
    source: Index | None = None


class Image(_Value):
    uri: str | None = None
    buffer_view: Index | None = None


class GltfScene(_Value):
    nodes: list[Index] = []


class Document(_Value):
    scene: Index = 0
    scenes: list[GltfScene] = []
    nodes: list[Node] = []
    skins: list[Skin] = []
    animations: list[Animation] = []
    meshes: list[Mesh] = []
    materials: list[MaterialValue] = []
    textures: list[Texture] = []
    images: list[Image] = []
    accessors: list[Accessor] = []
    buffer_views: list[BufferView] = []
    buffers: list[Buffer] = []
    extensions: msgspec.Raw = msgspec.Raw()
    extensions_required: list[str] = []
