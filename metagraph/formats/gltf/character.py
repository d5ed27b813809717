"""Merge the meshes of a glTF file into one character in its skeleton's rest pose."""

from __future__ import annotations

from collections.abc import Container
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.budgets import PICTURE_PIXELS, VERTICES
from metagraph.common.pictures import read_picture_size
from metagraph.errors import FileError
from metagraph.formats.gltf.file import Gltf
from metagraph.formats.gltf.morphs import read_morph_names
from metagraph.formats.gltf.placed_props import is_prop
from metagraph.formats.gltf.skeleton import GltfRig
from metagraph.formats.gltf.values import Primitive
from metagraph.motion.character_mesh import CharacterMesh, MeshMaterial, Surface

Array = NDArray[Any]

_VERTEX = 400  # bytes of a vertex while it is processed


@dataclass
class _Part:
    positions: Array
    normals: Array
    uvs: Array
    grain_uvs: Array | None
    joints: Array
    weights: Array
    mirrored: bool
    morphs: dict[str, Array] = field(default_factory=dict)
    held: int = -1  # the only joint that moves it


def read_character_mesh(gltf: Gltf, rig: GltfRig) -> CharacterMesh:
    """Return the default scene's meshes on the rig's skeleton. Raises FileError if there are none."""
    gltf.require_meshes()
    doc = gltf.json
    notes = [*rig.notes, *(repair.words for repair in rig.repairs)]
    parts: list[_Part] = []
    runs: list[
        tuple[int, Array, int, str]
    ] = []  # (part, triangles, material, mesh): primitives may share their vertices
    names_of: dict[str, None] = {}
    for node in _scene_nodes(gltf, rig):
        index = doc.nodes[node].mesh
        if index is None or is_prop(doc.nodes[node]):
            continue
        mesh = gltf.item(doc.meshes, index, "mesh", f"node {node} '{doc.nodes[node].name}'")
        called = _free(doc.nodes[node].name or mesh.name or f"mesh {index}", names_of)
        shared: dict[tuple[Any, ...], int | None] = {}
        for p, primitive in enumerate(mesh.primitives):
            where = f"mesh {index} '{mesh.name}', primitive {p}"
            if primitive.mode not in (4, 5, 6) or "POSITION" not in primitive.attributes:
                notes.append(f"{where} is not made of triangles and was left out")
                continue
            count = len(gltf.array(primitive.attributes["POSITION"], where, "VEC3"))
            triangles = _triangles(gltf, primitive, count, where)
            if not len(triangles):
                continue
            key = (
                *sorted(primitive.attributes.items()),
                *(tuple(sorted(t.items())) for t in primitive.targets),
            )
            if key not in shared or "NORMAL" not in primitive.attributes:
                part = _part(gltf, rig, node, primitive, triangles, where, notes)
                shared[key] = None if part is None else len(parts)
                if part is not None:
                    parts.append(part)
            place = shared[key]
            if place is not None:
                turned = triangles[:, ::-1] if parts[place].mirrored else triangles
                names_of[called] = None
                material = -1 if primitive.material is None else primitive.material
                runs.append((place, turned, material, called))
    if not parts:
        gltf.fail(
            "it holds no mesh", "its meshes", "Choose a file with a character, or import this one as clips."
        )
    names = tuple(dict.fromkeys(name for part in parts for name in part.morphs))
    starts = np.cumsum([0] + [len(p.positions) for p in parts])
    if int(starts[-1]) > VERTICES:
        gltf.fail(f"it has more than {VERTICES:,} vertices", "its meshes", "Export a simpler mesh.")
    morphs = None
    if names:
        places_of = {name: n for n, name in enumerate(names)}
        gltf.spend(len(names) * int(starts[-1]) * 12, "morph targets")
        morphs = np.zeros((len(names), int(starts[-1]), 3), np.float32)
        for part, start in zip(parts, starts, strict=False):
            for name, offsets in part.morphs.items():
                morphs[places_of[name], start : start + len(offsets)] = offsets
    materials, places = _materials(gltf, [material for _, _, material, _ in runs], notes)
    surfaces, first = [], 0
    for place, triangles, material, called in runs:
        surfaces.append(Surface(first, len(triangles), places[material], called, parts[place].held))
        first += len(triangles)
    return CharacterMesh(
        gltf.path.stem,
        rig.skeleton,
        np.concatenate([p.positions for p in parts]).astype(np.float32),
        np.concatenate([p.normals for p in parts]).astype(np.float32),
        np.concatenate([p.uvs for p in parts]).astype(np.float32),
        np.concatenate([p.joints for p in parts]).astype(np.uint16),
        np.concatenate([p.weights for p in parts]).astype(np.float32),
        np.concatenate([triangles + starts[place] for place, triangles, _, _ in runs]).astype(np.uint32),
        materials,
        tuple(surfaces),
        names,
        morphs,
        tuple(dict.fromkeys(notes)),
        tuple(names_of),
        _second_coordinates(parts) if any(m.grain is not None for m in materials) else None,
    )


def _second_coordinates(parts: list[_Part]) -> Array:
    """Return the second texture coordinates of all parts `[V, 2]`, 0 where a part has none."""
    held = [np.zeros_like(p.uvs) if p.grain_uvs is None else p.grain_uvs for p in parts]
    return np.concatenate(held).astype(np.float32)


def _free(name: str, taken: Container[str]) -> str:
    """Return a name that is not taken, because hidden meshes are identified by name."""
    number, found = 1, name
    while found in taken:
        number += 1
        found = f"{name} ({number})"
    return found


def _scene_nodes(gltf: Gltf, rig: GltfRig) -> list[int]:
    """Return the nodes of the default scene, depth first."""
    doc = gltf.json
    if not doc.scenes:
        return list(range(len(doc.nodes)))
    scene = gltf.item(doc.scenes, doc.scene, "scene", "its default scene")
    out: list[int] = []
    stack = list(reversed(scene.nodes))
    seen: set[int] = set()
    while stack:
        node = stack.pop()
        if node >= len(doc.nodes):
            gltf.fail(f"node {node} does not exist", f"scene {doc.scene}")
        if node in seen:
            continue
        seen.add(node)
        out.append(node)
        stack.extend(reversed(doc.nodes[node].children))
    return out


def _part(
    gltf: Gltf, rig: GltfRig, node: int, primitive: Primitive, triangles: Array, where: str, notes: list[str]
) -> _Part | None:
    """Return one primitive's vertices in the rest pose, in metres; None if they are scaled to zero size."""
    attributes = primitive.attributes
    gltf.spend(len(gltf.array(attributes["POSITION"], where, "VEC3")) * _VERTEX, where)
    positions = _floats(gltf, attributes["POSITION"], "VEC3", None, where)
    count = len(positions)
    normals = _floats(gltf, attributes["NORMAL"], "VEC3", count, where) if "NORMAL" in attributes else None
    uvs = (
        _floats(gltf, attributes["TEXCOORD_0"], "VEC2", count, where)
        if "TEXCOORD_0" in attributes
        else np.zeros((count, 2))
    )
    grain_uvs = (
        _floats(gltf, attributes["TEXCOORD_1"], "VEC2", count, where) if "TEXCOORD_1" in attributes else None
    )
    if grain_uvs is not None and not np.isfinite(grain_uvs).all():
        grain_uvs = None
    skin, held = gltf.json.nodes[node].skin, -1
    if skin is not None and "JOINTS_0" in attributes and "WEIGHTS_0" in attributes:
        matrices, joints, weights = _skinned(gltf, rig, skin, attributes, count, where)
    else:
        placed = _attached(gltf, rig, node)
        if placed is None:
            notes.append(f"{where} is scaled to nothing and was left out")
            return None
        matrix, held = placed
        matrices = np.broadcast_to(matrix, (count, 4, 4))
        joints = np.zeros((count, 4), np.int64)
        joints[:, 0] = held
        weights = np.tile([1.0, 0, 0, 0], (count, 1))
    linear = matrices[:, :3, :3]
    mirrored = bool(np.linalg.det(linear[0]) < 0)
    moved = np.einsum("vab,vb->va", linear, positions) + matrices[:, :3, 3]
    morphs = {}
    for name, target in zip(read_morph_names(gltf, node), primitive.targets, strict=False):
        if "POSITION" in target:
            gltf.spend(count * 48, where)
            offsets = _floats(gltf, target["POSITION"], "VEC3", count, f"{where}, target '{name}'")
            morphs[name] = np.einsum("vab,vb->va", linear, offsets)
    if normals is None:
        normals = _smooth_normals(moved, triangles[:, ::-1] if mirrored else triangles)
    else:
        # The cofactor matrix turns normals correctly under uneven scale and never needs an inverse.
        a, b, c = linear[:, :, 0], linear[:, :, 1], linear[:, :, 2]
        cofactor = np.stack([np.cross(b, c), np.cross(c, a), np.cross(a, b)], -1)
        normals = np.einsum("vab,vb->va", cofactor, normals) * (-1 if mirrored else 1)
        length = np.linalg.norm(normals, axis=-1, keepdims=True)
        normals = np.where(length > 1e-30, normals / np.maximum(length, 1e-30), [0.0, 1.0, 0.0])
    if (
        not all(np.isfinite(a).all() for a in (moved, normals, uvs, weights, *morphs.values()))
        or np.abs(moved).max() > 1e9
    ):
        gltf.fail("it holds a value that is not a sensible number", where)
    return _Part(moved, normals, uvs, grain_uvs, joints, weights, mirrored, morphs, held)


def _floats(gltf: Gltf, accessor: int, kind: str, count: int | None, where: str) -> Array:
    values = np.asarray(gltf.array(accessor, where, kind), np.float64)
    if count is not None and len(values) != count:
        gltf.fail(f"accessor {accessor} holds {len(values)} elements for {count} vertices", where)
    return values


def _triangles(gltf: Gltf, primitive: Primitive, count: int, where: str) -> Array:
    """Return vertex numbers `[N, 3]`; strips and fans become triangles."""
    asked = count if primitive.indices is None else len(gltf.array(primitive.indices, where, "SCALAR"))
    gltf.spend(asked * (16 if primitive.mode == 4 else 64), where)
    if primitive.indices is None:
        order = np.arange(count)
    else:
        order = np.asarray(gltf.array(primitive.indices, where, "SCALAR"))
        if order.dtype.kind != "u":
            gltf.fail("its indices are not unsigned integers", where)
        order = order.astype(np.int64)
        if len(order) and int(order.max()) >= count:
            gltf.fail(f"a triangle names vertex {int(order.max())} of {count}", where)
    if primitive.mode == 4:
        return order[: len(order) // 3 * 3].reshape(-1, 3)
    if len(order) < 3:
        return np.zeros((0, 3), np.int64)
    if primitive.mode == 6:
        return np.stack([np.broadcast_to(order[0], len(order) - 2), order[1:-1], order[2:]], 1)
    strip = np.stack([order[:-2], order[1:-1], order[2:]], 1)
    strip[1::2] = strip[1::2, [1, 0, 2]]
    return strip


def _skinned(
    gltf: Gltf, rig: GltfRig, skin_index: int, attributes: dict[str, int], count: int, where: str
) -> tuple[Array, Array, Array]:
    """Return each vertex's matrix to the rest pose `[V, 4, 4]`, its joints and its weights `[V, 4]`."""
    skin = gltf.item(gltf.json.skins, skin_index, "skin", where)
    own = np.array([rig.places[j] for j in skin.joints], np.int64)
    if not len(own):
        gltf.fail(f"skin {skin_index} has no joints", where)
    bind = rig.rest_matrices[own]
    if skin.inverse_bind_matrices is not None:
        inverse = np.asarray(
            gltf.array(skin.inverse_bind_matrices, f"skin {skin_index}", "MAT4"), np.float64
        )[: len(own)]
        if len(inverse) < len(own):
            gltf.fail(f"{len(inverse)} inverse bind matrices for {len(own)} joints", f"skin {skin_index}")
        bind = bind @ inverse.reshape(-1, 4, 4).transpose(0, 2, 1)
    places, weights = [], []
    for s in range(4):
        if f"JOINTS_{s}" not in attributes or f"WEIGHTS_{s}" not in attributes:
            break
        index = np.asarray(gltf.array(attributes[f"JOINTS_{s}"], where, "VEC4"))
        if index.dtype.kind != "u" or len(index) != count:
            gltf.fail(f"its joint numbers do not fit its {count} vertices", where)
        places.append(index.astype(np.int64))
        weights.append(_floats(gltf, attributes[f"WEIGHTS_{s}"], "VEC4", count, where))
    place, weight = np.concatenate(places, 1), np.maximum(np.concatenate(weights, 1), 0)
    place = np.where(weight > 0, place, 0)
    if count and int(place.max()) >= len(own):
        gltf.fail(f"a vertex names joint {int(place.max())} of {len(own)}", where)
    if weight.shape[1] > 4:  # keep the four strongest
        strongest = np.argsort(-weight, 1)[:, :4]
        place, weight = np.take_along_axis(place, strongest, 1), np.take_along_axis(weight, strongest, 1)
    total = weight.sum(1, keepdims=True)
    weight = np.where(total > 0, weight / np.where(total > 0, total, 1), [1.0, 0, 0, 0])
    matrices = np.einsum("vk,vkab->vab", weight, bind[place])
    return matrices, own[place], weight


def _attached(gltf: Gltf, rig: GltfRig, node: int) -> tuple[Array, int] | None:
    """Return the matrix of a mesh without a skin, and the joint that carries it; None if it is scaled to zero
    size.
    """
    at = node
    while at >= 0 and at not in rig.places:
        at = rig.parents[at]
    world = rig.worlds[node]
    if abs(np.linalg.det(world[:3, :3])) < 1e-18:
        return None
    if at < 0:
        scaled = world.copy()
        scaled[:3] *= rig.unit
        return scaled, 0
    if abs(np.linalg.det(rig.worlds[at][:3, :3])) < 1e-18:
        return None
    joint = rig.places[at]
    return rig.rest_matrices[joint] @ np.linalg.inv(rig.worlds[at]) @ world, joint


def _smooth_normals(positions: Array, triangles: Array) -> Array:
    a, b, c = (positions[triangles[:, k]] for k in range(3))
    face = np.cross(b - a, c - a)
    normals = np.zeros_like(positions)
    for k in range(3):
        np.add.at(normals, triangles[:, k], face)
    length = np.linalg.norm(normals, axis=-1, keepdims=True)
    return np.where(length > 1e-30, normals / np.maximum(length, 1e-30), [0.0, 1.0, 0.0])


def _materials(
    gltf: Gltf, used: list[int], notes: list[str]
) -> tuple[tuple[MeshMaterial, ...], dict[int, int]]:
    """Return the used materials, and the new index of each of the file's; -1 is glTF's default material."""
    out: list[MeshMaterial] = []
    places: dict[int, int] = {}
    images: dict[int, bytes | None] = {}
    for index in used:
        if index in places:
            continue
        places[index] = len(out)
        if index < 0:
            out.append(MeshMaterial("default"))
            continue
        value = gltf.item(gltf.json.materials, index, "material", "a primitive")
        name = value.name or f"material_{index}"
        pbr = value.pbr_metallic_roughness
        if pbr is None:
            out.append(MeshMaterial(name, (1.0, 1.0, 1.0, 1.0), None, 1.0, value.double_sided))
            continue
        maps: list[bytes | None] = []
        grain = value.normal_texture
        for info in (pbr.base_color_texture, grain if grain is not None and grain.tex_coord == 1 else None):
            maps.append(None)
            if info is None:
                continue
            texture = gltf.item(gltf.json.textures, info.index, "texture", f"material '{name}'")
            if texture.source is not None:
                if texture.source not in images:
                    images[texture.source] = _image(gltf, texture.source, notes)
                maps[-1] = images[texture.source]
            else:
                notes.append(f"the texture of material '{name}' is in a format that is not read")
        color = tuple(float(np.clip(c, 0, 1)) for c in pbr.base_color_factor)
        out.append(
            MeshMaterial(
                name,
                (color[0], color[1], color[2], color[3]),
                maps[0],
                float(np.clip(pbr.roughness_factor, 0, 1)),
                value.double_sided,
                maps[1],
            )
        )
    return tuple(out), places


def _image(gltf: Gltf, index: int, notes: list[str]) -> bytes | None:
    """Return PNG or JPEG bytes. A texture that cannot be read becomes a note, not an error."""
    value = gltf.item(gltf.json.images, index, "image", "a texture")
    try:
        if value.buffer_view is not None:
            view = gltf.view(value.buffer_view, f"image {index}")[0]
            gltf.spend(len(view), f"image {index}")
            data = bytes(view)
        elif value.uri is not None:
            data = gltf.resource(value.uri, f"image {index}")
        else:
            return None
    except FileError as error:
        notes.append(f"texture left out: {error.cause}")
        return None
    why = _no_picture(data)
    if why:
        notes.append(f"texture left out: image {index} {why}")
        return None
    return data


def _no_picture(data: bytes) -> str:
    """Return why bytes are no picture that can be drawn, "" if they are one. Other data must not get into an
    export.
    """
    if data[:8] != b"\x89PNG\r\n\x1a\n" and data[:3] != b"\xff\xd8\xff":
        return "is neither PNG nor JPEG"
    size = read_picture_size(data)
    if size is None:
        return "is damaged"
    return f"is {size[0]} x {size[1]} pixels, too many" if size[0] * size[1] > PICTURE_PIXELS else ""
