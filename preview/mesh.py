"""Define what the graphics card gets: vertices skinned to the matrices of a palette, and boxes and capsules
to build them from.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

VERTEX = np.dtype(
    [
        ("position", "<f4", 3),
        ("normal", "<f4", 3),
        ("uv", "<f4", 2),
        ("bones", "<u2", 4),
        ("weights", "<f4", 4),
        ("color", "u1", 4),  # sRGB; the fourth is shininess, odd for skin
    ]
)


@dataclass(frozen=True, eq=False)
class TriangleBatch:
    """Triangles `first .. first + count` that share a texture and are single-sided or double-sided.

    `grain` is their normal map in the mesh's `grain` coordinates, or None.
    """

    first: int
    count: int
    image: bytes | None = None
    double_sided: bool = False
    grain: bytes | None = None


@dataclass(frozen=True, eq=False)
class Morphs:
    """What a face moves, a fifth of a character's vertices. `moved` `[W]` holds their numbers, ascending;
    `offsets` what each target adds to their positions, `[K, W, 3]`.
    """

    moved: Array
    offsets: Array

    def __len__(self) -> int:
        return len(self.offsets)

    def of(self, used: Array) -> Morphs:
        """Return the morphs of a mesh that has only some of the vertices: `used [U]`, ascending."""
        _, here, there = np.intersect1d(used, self.moved, assume_unique=True, return_indices=True)
        return Morphs(here, np.take(self.offsets, there, 1))

    def positions(self, rest: Array, weights: Array) -> Array:
        """Return the vertices' positions `[V, 3]` for a face of `weights [K]`. `rest` holds the positions
        without it.
        """
        out = rest.copy()
        active = np.flatnonzero(np.abs(weights) > 1e-5)
        out[self.moved] += np.tensordot(weights[active], self.offsets[active], 1)
        return out


@dataclass(frozen=True, eq=False)
class SkinnedMesh:
    """Vertices in rest pose `[V]` of VERTEX, `triangles` `[N, 3]`, and the number of `matrices` in the
    palette.

    `morphs` is what a face moves, or None. `grain` `[V, 2]` are second texture coordinates, for batches with
    a grain, or None. Compared by identity: the renderer keeps one copy for each value.
    """

    vertices: Array
    triangles: Array
    batches: tuple[TriangleBatch, ...]
    matrices: int
    morphs: Morphs | None = None
    grain: Array | None = None


def arrange_vertices(mesh: SkinnedMesh) -> tuple[Array, Array]:
    """Return the best order of the vertices for a graphics card `[U]`, and the triangles `[N, 3]` with
    indices into it. Each batch keeps its place.

    Triangles that are near each other follow one another, so each vertex is skinned about once instead of
    twice.
    """
    place = mesh.vertices["position"]
    if not len(mesh.triangles):
        return np.arange(len(place)), mesh.triangles
    low, size = place.min(0), max(float(np.ptp(place, axis=0).max()), 1e-9)
    cell = ((place - low) / size * 1023).astype(np.int64)[mesh.triangles].sum(1) // 3
    # A curve through all cells that stays local (Morton's): the bits of x, y and z alternate.
    for shift, mask in ((16, 0x30000FF), (8, 0x300F00F), (4, 0x30C30C3), (2, 0x9249249)):
        cell = (cell | cell << shift) & mask
    code = cell[:, 0] | cell[:, 1] << 1 | cell[:, 2] << 2
    batch = np.zeros(len(code), np.int64)
    for n, b in enumerate(mesh.batches):
        batch[b.first : b.first + b.count] = n
    triangles = mesh.triangles[np.lexsort((code, batch))]
    used, first = np.unique(triangles, return_index=True)
    order = used[np.argsort(first)]
    number = np.zeros(len(place), np.uint32)
    number[order] = np.arange(len(order), dtype=np.uint32)
    return order, number[triangles]


def cut_at_bones(mesh: SkinnedMesh, length: float, margin: float) -> tuple[Array, Array]:
    """Cut a mesh at its bones, and the part of each bone along its longest side.

    Returns the matrix of each piece `[B]` and the corners of a box round it in rest pose `[B, 8, 3]`, with
    `margin` metres on all sides. `length` is about the length of a piece in metres. A triangle belongs to
    every bone that moves one of its vertices by a quarter or more.
    """
    if not len(mesh.triangles):
        return np.zeros(0, int), np.zeros((0, 8, 3))
    a, b, c = mesh.vertices["position"].astype(float)[mesh.triangles.T]
    weights = mesh.vertices["weights"]
    held = weights >= np.minimum(0.25, weights.max(-1, keepdims=True))
    place = np.flatnonzero(held[mesh.triangles])
    which, vertex, slot = place // 12, place // 4, place % 4
    matrix = mesh.vertices["bones"][mesh.triangles.reshape(-1)[vertex], slot].astype(np.int64)
    low, high = np.minimum(np.minimum(a, b), c)[which], np.maximum(np.maximum(a, b), c)[which]
    _, of, of_low, of_high = _bounds(matrix, low, high)
    axis = np.argmax(of_high - of_low, 1)[of]
    row = np.arange(len(axis))
    middle = (low[row, axis] + high[row, axis]) / 2
    step = ((middle - of_low[of, axis]) / length).astype(np.int64)
    key, _, *box = _bounds(matrix * (int(step.max()) + 1) + step, low, high)
    box = [box[0] - margin, box[1] + margin]
    corners = np.stack(
        [
            np.stack([box[side][:, n] for n, side in enumerate((k & 1, k >> 1 & 1, k >> 2))], 1)
            for k in range(8)
        ],
        1,
    )
    return key // (int(step.max()) + 1), corners


def _bounds(key: Array, low: Array, high: Array) -> tuple[Array, Array, Array, Array]:
    """Return the different keys `[B]`, the index into them for each row `[N]`, and the least `low` and the
    greatest `high` of the rows of each key `[B, 3]`.
    """
    small = key.astype(np.uint16) if key.max() < 1 << 16 else key  # sorting these is five times as fast
    order = np.argsort(small, kind="stable")
    found = key[order]
    first = np.flatnonzero(np.concatenate([[True], found[1:] != found[:-1]]))
    of = np.empty(len(key), np.int64)
    of[order] = np.repeat(np.arange(len(first)), np.diff(np.append(first, len(key))))
    return (
        found[first],
        of,
        np.minimum.reduceat(low[order], first),
        np.maximum.reduceat(high[order], first),
    )


def turn_profile(profile: Sequence[tuple[float, float]], sides: int) -> tuple[Array, Array, Array]:
    """Turn a profile of `(y, radius)` pairs, from low to high, round the Y axis. Return positions and normals
    `[V, 3]` and triangles.
    """
    p = np.asarray(profile, float)
    slope = np.gradient(p, axis=0)
    outward = np.stack([-slope[:, 1], slope[:, 0]], -1)  # (along y, along the radius)
    outward[0], outward[-1] = (
        ((-1.0, 0.0) if p[0, 1] < 1e-9 else outward[0]),
        ((1.0, 0.0) if p[-1, 1] < 1e-9 else outward[-1]),
    )
    outward /= np.maximum(np.linalg.norm(outward, axis=1, keepdims=True), 1e-12)
    angle = np.arange(sides) * (2 * math.pi / sides)
    circle = np.stack([np.sin(angle), np.cos(angle)], -1)
    positions = np.empty((len(p), sides, 3))
    normals = np.empty((len(p), sides, 3))
    positions[..., 1], normals[..., 1] = p[:, None, 0], outward[:, None, 0]
    positions[..., [0, 2]] = p[:, None, 1:] * circle
    normals[..., [0, 2]] = outward[:, None, 1:] * circle
    i, j = np.meshgrid(np.arange(len(p) - 1), np.arange(sides), indexing="ij")
    a, b = i * sides + j, i * sides + (j + 1) % sides
    c, d = a + sides, b + sides
    triangles = np.concatenate(
        [np.stack([a, b, d], -1).reshape(-1, 3), np.stack([a, d, c], -1).reshape(-1, 3)]
    )
    flat = positions.reshape(-1, 3)
    corner = flat[triangles]
    area = np.linalg.norm(np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]), axis=1)
    return flat, normals.reshape(-1, 3), triangles[area > 1e-12]


def make_capsule(
    length: float, low: float, high: float, sides: int = 10, rings: int = 3
) -> tuple[Array, Array, Array]:
    """Return a tapered bone along +Y from 0 to `length` with round ends of the radii `low` and `high`."""
    turn = np.linspace(-math.pi / 2, 0, rings + 1)
    first = [(low * math.sin(t), low * math.cos(t) if i else 0.0) for i, t in enumerate(turn)]
    last = [(length - high * math.sin(t), high * math.cos(t) if i else 0.0) for i, t in enumerate(turn)]
    return turn_profile(first + last[::-1], sides)


def make_ball(radius: float, sides: int = 12, rings: int = 8) -> tuple[Array, Array, Array]:
    """Return a sphere round the origin."""
    turn = np.linspace(-math.pi / 2, math.pi / 2, rings + 1)
    return turn_profile(
        [
            (radius * math.sin(t), 0.0 if i in (0, rings) else radius * math.cos(t))
            for i, t in enumerate(turn)
        ],
        sides,
    )


def make_egg(
    profile_height: float, radius: float, sides: int = 18, rings: int = 14
) -> tuple[Array, Array, Array]:
    """Return a head: from 0 to `profile_height` along +Y, narrower at the chin."""
    turn = np.linspace(0, math.pi, rings + 1)
    rows = []
    for i, t in enumerate(turn):
        y = (1 - math.cos(t)) / 2
        width = math.sin(t) * (0.78 + 0.30 * y - 0.06 * y * y)
        rows.append((y * profile_height, 0.0 if i in (0, rings) else radius * width))
    return turn_profile(rows, sides)
