"""Write the materials and pictures of meshes into a GLB."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from metagraph.common.pictures import holds_flat_colors, read_picture_size
from metagraph.formats.gltf.binary import BinaryChunk
from metagraph.motion.character_mesh import MeshMaterial

LINEAR = 9729
LARGE = 4096  # pixels, taken where a picture does not say
# Without mipmaps, which would mix the colours of a palette: seen from afar, skin turned brown.
FLAT = {"magFilter": LINEAR, "minFilter": LINEAR}


def add_materials(
    document: dict[str, Any], body: BinaryChunk, materials: Sequence[MeshMaterial], grain: bool
) -> int:
    """Add materials, and their pictures once each; return the number of the first. grain: whether the mesh
    has the texture coordinates of normal maps.
    """
    images: list[dict[str, Any]] = document.get("images", [])
    known: dict[bytes, int] = {}
    added: list[dict[str, Any]] = []
    flat: set[int] = {n for n, one in enumerate(document.get("textures", ())) if "sampler" in one}

    def texture(image: bytes) -> int:
        if image not in known:
            known[image] = len(images)
            kind = "image/png" if image[:4] == b"\x89PNG" else "image/jpeg"
            images.append({"bufferView": body.view(image), "mimeType": kind})
        return known[image]

    for material in materials:
        pbr: dict[str, Any] = {
            "baseColorFactor": list(material.color),
            "metallicFactor": 0.0,
            "roughnessFactor": material.roughness,
        }
        if material.image is not None:
            pbr["baseColorTexture"] = {"index": texture(material.image)}
            if holds_flat_colors(read_picture_size(material.image) or (LARGE, LARGE)):
                flat.add(known[material.image])
        value: dict[str, Any] = {"name": material.name, "pbrMetallicRoughness": pbr}
        if material.grain is not None and grain:
            value["normalTexture"] = {"index": texture(material.grain), "texCoord": 1}
        if material.double_sided:
            value["doubleSided"] = True
        added.append(value)
    first = len(document.get("materials", ()))
    if added:
        document.setdefault("materials", []).extend(added)
    if images:
        document["images"] = images
        document["textures"] = [
            {"source": i, "sampler": 0} if i in flat else {"source": i} for i in range(len(images))
        ]
    if flat:
        document["samplers"] = [FLAT]
    return first
