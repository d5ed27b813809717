# SPDX-License-Identifier: GPL-3.0-or-later
"""A GLB of clips on a skeleton, written by hand: Blender's own exporter writes bones with Blender's axes, so
that clips would come back on another skeleton. Needs NumPy alone.
"""

from __future__ import annotations

import json
import struct
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .space import Figure, inverse, rotate

Array = NDArray[Any]

_FLOAT, _USHORT = 5126, 5123


class Take(NamedTuple):
    """A clip. rotations `[F, J, 4]`, translations `[F, J, 3]`: local. weights `[F, M]`: of morph targets."""

    name: str
    fps: float
    rotations: Array
    translations: Array
    morphs: tuple[str, ...] = ()
    weights: Array | None = None


def glb(figure: Figure, takes: Sequence[Take]) -> bytes:
    """Return the file's content: joints, skin, an animation for each clip, and, where morph targets move, a
    triangle of no size that has them.
    """
    file = _File()
    nodes = _joints(figure)
    roots = [n for n, parent in enumerate(figure.parents) if parent < 0]
    document: dict[str, Any] = {
        "asset": {"version": "2.0", "generator": "Metagraph for Blender"}, "scene": 0, "nodes": nodes
    }  # fmt: skip
    if len(roots) > 1:
        nodes.append({"name": "Armature", "children": roots})
        roots = [len(figure.names)]
    morphs = tuple(dict.fromkeys(name for take in takes for name in take.morphs))
    if morphs:
        document["skins"] = [_skin(file, figure)]
        document["meshes"] = [_mesh(file, morphs)]
        roots = [*roots, len(nodes)]
        nodes.append({"name": "morphs", "mesh": 0, "skin": 0})
    document["scenes"] = [{"nodes": roots}]
    document["animations"] = [_animation(file, figure, take, morphs, len(nodes) - 1) for take in takes]
    return file.content(document)


class _File:
    """A file while it is put together."""

    def __init__(self) -> None:
        self.body = bytearray()
        self.accessors: list[dict[str, Any]] = []
        self.views: list[dict[str, Any]] = []

    def add(self, values: Array, kind: str, component: int = _FLOAT, bounds: bool = False) -> int:
        """Add numbers, and return the accessor they are read by."""
        data = np.ascontiguousarray(values, "<f4" if component == _FLOAT else "<u2")
        self.views.append({"buffer": 0, "byteOffset": len(self.body), "byteLength": data.nbytes})
        accessor = {
            "bufferView": len(self.views) - 1, "componentType": component, "count": len(data), "type": kind
        }  # fmt: skip
        if bounds:
            flat = data.reshape(len(data), -1)
            accessor |= {"min": flat.min(0).tolist(), "max": flat.max(0).tolist()}
        self.body.extend(data.tobytes() + b"\0" * (-data.nbytes % 4))
        self.accessors.append(accessor)
        return len(self.accessors) - 1

    def content(self, document: dict[str, Any]) -> bytes:
        """Return the bytes of a document and of what was added for it."""
        body = bytes(self.body)
        buffers = {
            "accessors": self.accessors, "bufferViews": self.views, "buffers": [{"byteLength": len(body)}]
        }  # fmt: skip
        head = json.dumps({**document, **buffers}, ensure_ascii=False, separators=(",", ":")).encode()
        head += b" " * (-len(head) % 4)
        size = 28 + len(head) + len(body)
        return b"".join(
            (
                struct.pack("<4sIIII", b"glTF", 2, size, len(head), 0x4E4F534A),
                head,
                struct.pack("<II", len(body), 0x004E4942),
                body,
            )
        )


def _joints(figure: Figure) -> list[dict[str, Any]]:
    nodes: list[dict[str, Any]] = [
        {
            "name": name,
            "rotation": figure.rest_rotations[n].tolist(),
            "translation": figure.rest_translations[n].tolist(),
        }
        for n, name in enumerate(figure.names)
    ]
    for n, parent in enumerate(figure.parents):
        if parent >= 0:
            nodes[parent].setdefault("children", []).append(n)
    return nodes


def _skin(file: _File, figure: Figure) -> dict[str, Any]:
    """Return the skin; readers take the rest pose from how it is bound."""
    count = len(figure.names)
    turns, places = figure.globals(figure.rest_rotations, figure.rest_translations)
    back = inverse(turns)
    bind = np.tile(np.eye(4), (count, 1, 1))
    bind[:, :3, :3] = rotate(back[:, None], np.eye(3))  # row n: where axis n goes, as columns are stored
    bind[:, 3, :3] = -rotate(back, places)
    return {"joints": list(range(count)), "inverseBindMatrices": file.add(bind.reshape(-1, 16), "MAT4")}


def _mesh(file: _File, morphs: tuple[str, ...]) -> dict[str, Any]:
    """Return a triangle of no size with morph targets."""
    corner = file.add(np.zeros((3, 3)), "VEC3", bounds=True)
    attributes = {
        "POSITION": corner,
        "JOINTS_0": file.add(np.zeros((3, 4)), "VEC4", _USHORT),
        "WEIGHTS_0": file.add(np.tile([1.0, 0, 0, 0], (3, 1)), "VEC4"),
    }
    primitive = {"attributes": attributes, "targets": [{"POSITION": corner} for _ in morphs]}
    return {"name": "morphs", "primitives": [primitive], "extras": {"targetNames": list(morphs)}}


def _animation(
    file: _File, figure: Figure, take: Take, morphs: tuple[str, ...], mesh_node: int
) -> dict[str, Any]:
    """Return a take as an animation. mesh_node: what carries the morph targets, where there are any."""
    times = file.add(np.arange(len(take.rotations)) / take.fps, "SCALAR", bounds=True)
    channels: list[dict[str, Any]] = []
    samplers: list[dict[str, Any]] = []

    def move(node: int, path: str, values: int) -> None:
        samplers.append({"input": times, "output": values, "interpolation": "LINEAR"})
        channels.append({"sampler": len(samplers) - 1, "target": {"node": node, "path": path}})

    away = np.abs(take.translations - figure.rest_translations).max((0, 2))
    for n in range(len(figure.names)):
        move(n, "rotation", file.add(take.rotations[:, n], "VEC4"))
        if n == 0 or away[n] > 1e-5:
            move(n, "translation", file.add(take.translations[:, n], "VEC3"))
    if take.weights is not None and take.morphs:
        table = np.zeros((len(take.rotations), len(morphs)))
        table[:, [morphs.index(name) for name in take.morphs]] = take.weights
        move(mesh_node, "weights", file.add(table.reshape(-1), "SCALAR"))
    return {"name": take.name, "channels": channels, "samplers": samplers, "extras": {"fps": take.fps}}
