"""Find where rays meet the triangles of a mesh."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[Any]

EDGE = 1e-9  # of a triangle: a ray through an edge meets both triangles


def find_hits(positions: Array, triangles: Array, origin: ArrayLike, direction: ArrayLike) -> Array:
    """Return how far along a ray it meets triangles, from either side, `[H]` in lengths of `direction`,
    nearest first (Möller and Trumbore, Fast, Minimum Storage Ray/Triangle Intersection, 1997).

    positions `[V, 3]`, triangles `[N, 3]`, origin and direction `[3]`.
    """
    start, way = np.asarray(origin, float), np.asarray(direction, float)
    a, b, c = (np.asarray(positions[triangles[:, n]], float) for n in range(3))
    first, second = b - a, c - a
    across = np.cross(way, second)
    volume = np.einsum("ij,ij->i", first, across)
    size = np.linalg.norm(first, axis=1) * np.linalg.norm(second, axis=1) * float(np.linalg.norm(way))
    seen = np.abs(volume) > 1e-12 * size  # not from its side
    a, first, second, across, volume = a[seen], first[seen], second[seen], across[seen], volume[seen]
    off = start - a
    u = np.einsum("ij,ij->i", off, across) / volume
    turned = np.cross(off, first)
    v = turned @ way / volume
    far = np.einsum("ij,ij->i", second, turned) / volume
    inside = (u >= -EDGE) & (v >= -EDGE) & (u + v <= 1 + EDGE) & (far >= 0)
    return np.sort(far[inside])
