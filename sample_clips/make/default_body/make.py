"""Sculpt the default body, half of it and its mirror image."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from sample_clips.make.default_body.forms import edge_length, whole
from sample_clips.make.sculpt import Field, gradient, polygonise, project, remesh

Array = NDArray[Any]

CELL = 0.0048
NEAR = 0.004  # metres from the middle; points nearer are put into it


def sculpt_half(field: Field, cell: float = CELL) -> tuple[Array, Array]:
    """Return positions and triangles of the left half, its border at x = 0."""
    low, high = (-6 * cell, -0.012, -0.16), (0.76, 1.78, 0.24)
    positions, triangles = polygonise(field, low, high, cell)
    positions, triangles = remesh(field, positions, triangles, edge_length)
    return positions, triangles


def cut_in_middle(positions: Array, triangles: Array) -> tuple[Array, Array]:
    """Return what lies at x >= 0: triangles across the middle are cut there."""
    positions = positions.copy()
    size = edge_length(positions) * 0.35
    positions[np.abs(positions[:, 0]) < size, 0] = 0
    side = np.sign(positions[:, 0]).astype(int)
    out: list[list[int]] = []
    places = [tuple(p) for p in positions]
    made: dict[tuple[int, int], int] = {}

    def between(a: int, b: int) -> int:
        key = (min(a, b), max(a, b))
        if key not in made:
            t = positions[a, 0] / (positions[a, 0] - positions[b, 0])
            p = positions[a] + t * (positions[b] - positions[a])
            made[key] = len(places)
            places.append((0.0, p[1], p[2]))
        return made[key]

    for tri in triangles.tolist():
        signs = [side[v] for v in tri]
        if min(signs) >= 0:
            if max(signs) > 0:
                out.append(tri)
            continue
        if max(signs) <= 0:
            continue
        ring: list[int] = []
        for k in range(3):
            a, b = tri[k], tri[(k + 1) % 3]
            if side[a] >= 0:
                ring.append(a)
            if side[a] * side[b] < 0:
                ring.append(between(a, b))
        out += [[ring[0], ring[k], ring[k + 1]] for k in range(1, len(ring) - 1)]
    used, corners = np.unique(np.array(out), return_inverse=True)
    return np.array(places)[used], corners.reshape(-1, 3)


def mirror_half(positions: Array, triangles: Array) -> tuple[Array, Array]:
    """Return the whole of a half whose border has x = 0."""
    middle = positions[:, 0] == 0
    other = np.where(middle, np.arange(len(positions)), len(positions) + np.cumsum(~middle) - 1)
    both = np.concatenate([positions, positions[~middle] * [-1, 1, 1]])
    return both, np.concatenate([triangles, other[triangles][:, ::-1]])


def sculpt_body(cell: float = CELL) -> tuple[Array, Array, Array]:
    """Return positions and normals `[V, 3]` and triangles `[N, 3]` of the body, the same on both sides."""
    field = whole()
    positions, triangles = cut_in_middle(*sculpt_half(field, cell))
    middle = positions[:, 0] == 0
    positions = project(field, positions)
    positions[middle, 0] = 0
    positions, triangles = mirror_half(positions, triangles)
    return positions, gradient(field, positions), triangles
