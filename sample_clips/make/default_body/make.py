"""Sculpt the default body, half of it and its mirror image."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from sample_clips.make.default_body.forms import edge_length, whole
from sample_clips.make.sculpt import Field, gradient, polygonise, project, remesh

Array = NDArray[Any]

CELL = 0.0042
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


def mend(positions: Array, triangles: Array) -> Array:
    """Return the triangles of a half without folds that share an edge with others, and without gaps in its
    border.
    """
    for _ in range(20):
        edges, faces = np.unique(_edges(triangles), axis=0, return_counts=True)
        crowded = edges[faces > 2]
        if not len(crowded):
            break
        to = np.arange(len(positions))
        for a, b in crowded:  # the longer way round stays: its ends become one
            to[to == to[b]] = to[a]
        triangles = to[triangles]
        a, b, c = triangles.T
        triangles = triangles[(a != b) & (b != c) & (c != a)]
        _, first, count = np.unique(np.sort(triangles, 1), axis=0, return_inverse=True, return_counts=True)
        triangles = triangles[count[first.ravel()] == 1]
    edges, faces = np.unique(_edges(triangles), axis=0, return_counts=True)
    middle = positions[:, 0] == 0
    border = {tuple(e) for e in edges[faces == 1].tolist() if not middle[e].all()}
    ring = [(a, b) for tri in triangles.tolist() for a, b in zip(tri, [*tri[1:], tri[0]], strict=True)]
    after = {a: b for a, b in ring if (min(a, b), max(a, b)) in border}
    gaps = [
        [after[after[a]], after[a], a] for a in after if middle[a] and middle[after.get(after[a], after[a])]
    ]
    return np.concatenate([triangles, np.array(gaps, int).reshape(-1, 3)])


def _edges(triangles: Array) -> Array:
    return np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), 1)


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
    triangles = mend(positions, triangles)
    used, triangles = np.unique(triangles, return_inverse=True)
    positions, triangles = positions[used], triangles.reshape(-1, 3)
    middle = positions[:, 0] == 0
    positions = project(field, positions)
    positions[middle, 0] = 0
    positions, triangles = mirror_half(positions, triangles)
    return positions, gradient(field, positions), triangles
