"""Read morph targets of a glTF file: their names, and their weights in its animations."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.wording import phrase
from metagraph.formats.gltf.file import Gltf, get_extras
from metagraph.formats.gltf.sampling import FrameGrid, sample_channels

Array = NDArray[Any]


def read_morph_names(gltf: Gltf, node: int) -> tuple[str, ...]:
    """Return the names of the morph targets of a node's mesh, from `targetNames`, else made from the mesh's
    name.
    """
    mesh_index = gltf.json.nodes[node].mesh
    if mesh_index is None:
        return ()
    mesh = gltf.item(gltf.json.meshes, mesh_index, "mesh", f"node {node}")
    count = max((len(p.targets) for p in mesh.primitives), default=0)
    if not count:
        return ()
    first = mesh.primitives[0]
    for raw in (mesh.extras, gltf.json.nodes[node].extras, first.extras):
        names = get_extras(raw).get("targetNames")
        if (
            isinstance(names, list)
            and len(names) >= count
            and all(isinstance(n, str) and n for n in names[:count])
        ):
            return tuple(names[:count])
    return tuple(f"{mesh.name or 'mesh'}_morph_{k}" for k in range(count))


def read_morph_weights(
    gltf: Gltf, channels: list[tuple[int, str, int, int]], keys: dict[int, Array], grid: FrameGrid, where: str
) -> tuple[tuple[str, ...], Array | None]:
    """Return morph names and weights `[F, K]`. Meshes that share a target's name share its weight.
    Expressions of a VRM animation keep their names.
    """
    columns: dict[str, Array] = {}
    for source, mode, node, output in channels:
        if node >= len(gltf.json.nodes):
            gltf.fail(phrase("its target node {node} does not exist", node=node), where)
        expression = gltf.vrm_face.expressions.get(node)
        if expression is None:
            names, values = read_morph_names(gltf, node), gltf.array(output, where, "SCALAR")
        else:
            names, values = (expression,), gltf.array(output, where, "VEC3")[:, 0]
        count = len(keys[source]) * (3 if mode == "CUBICSPLINE" else 1)
        if not names:
            continue
        if len(values) != count * len(names):
            gltf.fail(
                phrase(
                    "accessor {output} holds {count} weights, expected {count2} x {count3}",
                    output=output,
                    count=len(values),
                    count2=count,
                    count3=len(names),
                ),
                where,
            )
        gltf.spend(len(grid.times) * len(names) * 8, where)
        tracks = np.asarray(values, np.float64).reshape(count, len(names)).T[..., None]
        for name, track in zip(
            names, sample_channels(keys[source], tracks, grid, mode, False)[..., 0], strict=True
        ):
            columns.setdefault(name, track)
    if not columns:
        return (), None
    weights = np.stack(list(columns.values()), 1)
    if not np.isfinite(weights).all() or np.abs(weights).max() > 1e6:
        gltf.fail(phrase("a morph weight is not a plausible number"), where)
    return tuple(columns), weights
