"""Write props into a GLB: nodes with their meshes, below the joints that carry them or beside the figure."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from metagraph.formats.gltf.binary import ARRAY_BUFFER, ELEMENT_BUFFER, FLOAT, UINT, USHORT, BinaryChunk
from metagraph.formats.gltf.file import get_extras
from metagraph.formats.gltf.materials import add_materials
from metagraph.formats.gltf.values import Node
from metagraph.motion.character_mesh import CharacterMesh


@dataclass(frozen=True, eq=False)
class PlacedProp:
    """A prop and where it is. joint: the number of the joint that carries it, -1 if it stands. at: metres
    `[3]`, turn: a quaternion xyzw `[4]`, both in the joint's space or the scene's.
    """

    name: str
    mesh: CharacterMesh
    at: tuple[float, float, float]
    turn: tuple[float, float, float, float]
    scale: float
    joint: int = -1


def is_prop(node: Node) -> bool:
    """Return whether a node of a GLB is a prop that `add_props` wrote, and no part of the character."""
    return get_extras(node.extras).get("prop") is True


def add_props(document: dict[str, Any], body: BinaryChunk, props: tuple[PlacedProp, ...]) -> None:
    """Add props to a document that has its joints as its first nodes, and a scene. Props of one mesh share
    it.
    """
    nodes, roots = document["nodes"], document["scenes"][0]["nodes"]
    known: dict[int, int] = {}
    for prop in props:
        if id(prop.mesh) not in known:
            known[id(prop.mesh)] = _add_mesh(document, body, prop)
        node = {
            "name": prop.name,
            "mesh": known[id(prop.mesh)],
            "translation": list(prop.at),
            "rotation": list(prop.turn),
            "scale": [prop.scale] * 3,
            "extras": {"prop": True},
        }
        nodes.append(node)
        if prop.joint < 0:
            roots.append(len(nodes) - 1)
        else:
            nodes[prop.joint].setdefault("children", []).append(len(nodes) - 1)


def _add_mesh(document: dict[str, Any], body: BinaryChunk, prop: PlacedProp) -> int:
    """Add the mesh of a prop with its materials; return its number."""
    mesh = prop.mesh
    first = add_materials(document, body, mesh.materials, False)
    attributes = {
        "POSITION": body.array(mesh.positions, FLOAT, target=ARRAY_BUFFER, bounds=True),
        "NORMAL": body.array(np.asarray(mesh.normals, np.float32), FLOAT, target=ARRAY_BUFFER),
        "TEXCOORD_0": body.array(mesh.uvs, FLOAT, target=ARRAY_BUFFER),
    }
    primitives = []
    for surface in mesh.surfaces:
        order = np.asarray(mesh.triangles[surface.first : surface.first + surface.count]).reshape(-1)
        kind = USHORT if int(order.max()) < 65535 else UINT
        primitives.append(
            {
                "attributes": attributes,
                "indices": body.array(order, kind, target=ELEMENT_BUFFER),
                "material": first + surface.material,
            }
        )
    meshes = document.setdefault("meshes", [])
    meshes.append({"name": prop.name, "primitives": primitives})
    return len(meshes) - 1
