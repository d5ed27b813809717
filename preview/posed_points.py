"""Measure what a figure looks like in a pose, on the processor."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from preview.figure import MeshFigure

Array = NDArray[Any]


def find_posed_points(figure: MeshFigure, rotations: Array, positions: Array) -> Array:
    """Return where the vertices of a figure's mesh are in one pose, `[V, 3]`, metres, without morph targets.
    rotations `[J, 4]` and positions `[J, 3]` are global.
    """
    vertices = figure.mesh.vertices
    palette = np.asarray(figure.palette(rotations, positions), float)
    bones, weights = vertices["bones"], vertices["weights"].astype(float)
    weights = weights / np.maximum(weights.sum(1, keepdims=True), 1e-9)
    points = np.concatenate([vertices["position"].astype(float), np.ones((len(vertices), 1))], 1)
    out = np.zeros((len(vertices), 3))
    for k in range(bones.shape[1]):
        out += weights[:, k, None] * np.einsum("vij,vj->vi", palette[bones[:, k]], points)
    return out
