"""Pictures of materials in written files: palettes must not be mixed by whoever draws them from afar."""

from __future__ import annotations

import struct
from typing import Any

from metagraph.formats.gltf.binary import BinaryChunk
from metagraph.formats.gltf.materials import add_materials
from metagraph.motion.character_mesh import MeshMaterial


def png(width: int, height: int) -> bytes:
    """Return the head of a PNG of a size."""
    return b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR" + struct.pack(">II", width, height) + b"\x08\x02" + b"\0" * 9


def find_sampler(document: dict[str, Any], material: int) -> dict[str, int] | None:
    place = document["materials"][material]["pbrMetallicRoughness"]["baseColorTexture"]["index"]
    sampler = document["textures"][place].get("sampler")
    return None if sampler is None else document["samplers"][sampler]


def test_palettes_are_drawn_without_mipmaps_and_pictures_with_them() -> None:
    document: dict[str, Any] = {}
    palette = MeshMaterial("palette", image=png(64, 19), grain=png(64, 64))
    photo, strip = MeshMaterial("photo", image=png(1024, 512)), MeshMaterial("strip", image=png(2048, 16))
    add_materials(document, BinaryChunk(), [palette, photo, strip], True)
    for n in (0, 2):
        assert find_sampler(document, n) == {"magFilter": 9729, "minFilter": 9729}
    assert find_sampler(document, 1) is None
    grain = document["materials"][0]["normalTexture"]["index"]
    assert "sampler" not in document["textures"][grain], "a weave that repeats needs them"


def test_what_is_added_later_keeps_the_samplers_of_what_was_there() -> None:
    document: dict[str, Any] = {}
    body = BinaryChunk()
    add_materials(document, body, [MeshMaterial("palette", image=png(64, 19))], False)
    first = add_materials(document, body, [MeshMaterial("photo", image=png(512, 512))], False)
    assert first == 1 and find_sampler(document, 0) is not None and find_sampler(document, 1) is None


def test_a_picture_that_does_not_say_its_size_has_no_sampler() -> None:
    document: dict[str, Any] = {}
    add_materials(document, BinaryChunk(), [MeshMaterial("odd", image=b"\xff\xd8\xff\xe0")], False)
    assert "samplers" not in document
