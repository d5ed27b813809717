"""Find the tops of things: level upper faces, on which hands rest and feet stand."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import cos, radians
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

CELL = 0.02  # metres between the places at which a top's height is known
LEVEL = cos(radians(20))  # upper faces are tilted by no more; a lectern's by 15 degrees
LEAST = 7  # cells across: smaller faces are no tops
APART = 0.03  # metres between the heights of two tops, one above the other
AROUND = 3.0  # metres from the character up to which tops are found
BEYOND = 15  # cells round a top at which its height is known as well
EDGE = 3  # cells on both sides of the edge over which a place comes to be on a top
SPREAD = 4  # cells: triangles that are no larger are found all at once


@dataclass(frozen=True, eq=False)
class PropTop:
    """A level upper face. x, z: metres, the place of the first cell. heights `[X, Z]`: metres, of each cell
    and round the top those of its edge. inside `[X, Z]`: whether a cell is of the top.
    """

    x: float
    z: float
    heights: Array
    inside: Array

    @property
    def height(self) -> float:
        """Return the height of the middle of the cells, metres."""
        return float(np.median(self.heights[self.inside]))

    @property
    def distance(self) -> float:
        """Return how far it is from where the character stands, seen from above, metres."""
        i, k = np.nonzero(self.inside)
        return float(np.hypot(self.x + i * CELL, self.z + k * CELL).min())

    def find_heights(self, places: Array) -> Array:
        """Return the heights below places `[..., 3]`, metres; beside the top those of its edge."""
        wide, deep = self.heights.shape
        u = np.clip((places[..., 0] - self.x) / CELL, 0, wide - 1.001)
        v = np.clip((places[..., 2] - self.z) / CELL, 0, deep - 1.001)
        i, k = u.astype(np.int64), v.astype(np.int64)
        u, v = u - i, v - k
        low = self.heights[i, k] * (1 - u) + self.heights[i + 1, k] * u
        high = self.heights[i, k + 1] * (1 - u) + self.heights[i + 1, k + 1] * u
        return np.asarray(low * (1 - v) + high * v)

    def contains(self, places: Array) -> Array:
        """Return `[...]` whether places `[..., 3]` are on the top, above or below it, or a cell beside it."""
        i = np.rint((places[..., 0] - self.x) / CELL).astype(np.int64)
        k = np.rint((places[..., 2] - self.z) / CELL).astype(np.int64)
        wide, deep = self.inside.shape
        within = (i >= 0) & (k >= 0) & (i < wide) & (k < deep)
        return np.asarray(within & self._near[np.clip(i, 0, wide - 1), np.clip(k, 0, deep - 1)])

    def meet(self, x: float, z: float) -> tuple[float, float]:
        """Return the height below one place, metres, and how far it is on the top: 0 outside, 0.5 on the
        edge, 1 inside.
        """
        heights, inside = self._lists
        wide, deep = len(heights), len(heights[0])
        u = min(max((x - self.x) / CELL, 0.0), wide - 1.001)
        v = min(max((z - self.z) / CELL, 0.0), deep - 1.001)
        i, k = int(u), int(v)
        u, v = u - i, v - k
        a, b, c, d = (1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v
        near, far = heights[i], heights[i + 1]
        high = a * near[k] + b * far[k] + c * near[k + 1] + d * far[k + 1]
        near, far = inside[i], inside[i + 1]
        return high, a * near[k] + b * far[k] + c * near[k + 1] + d * far[k + 1]

    @cached_property
    def _near(self) -> Array:
        return _widen(self.inside, 1)

    @cached_property
    def _lists(self) -> tuple[list[list[float]], list[list[float]]]:
        soft = _sum_around(self.inside, EDGE) / (2 * EDGE + 1) ** 2
        return self.heights.tolist(), soft.tolist()


def find_tops(points: Array, triangles: Array, both: bool = False) -> tuple[PropTop, ...]:
    """Return the tops of a mesh near the character, the lowest first. points `[V, 3]`: metres, from the place
    between the character's feet, Y up; triangles `[N, 3]`. both: whether its surface has no underside.
    """
    corners = np.asarray(points, float)[triangles]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    rises = np.abs(across[:, 1]) if both else across[:, 1]
    flat = corners[..., [0, 2]]
    near = (flat.min(1) < AROUND).all(1) & (flat.max(1) > -AROUND).all(1)
    size = np.linalg.norm(across, axis=1)
    corners = corners[near & (rises >= LEVEL * size) & (size > 0)]
    if not len(corners):
        return ()
    cells, heights = _list_cells(corners)
    order = np.argsort(heights, kind="stable")
    cells, heights = cells[order], heights[order]
    ends = np.flatnonzero(np.diff(heights) > APART) + 1
    layers = zip(np.split(cells, ends), np.split(heights, ends), strict=True)
    return tuple(top for some, high in layers if (top := _make_top(some, high)) is not None)


def _list_cells(corners: Array) -> tuple[Array, Array]:
    """Return the cells `[M, 2]` whose middle is below each of some triangles `[N, 3, 3]`, and the heights
    there `[M]`.
    """
    corners = corners.copy()
    low = np.ceil(np.maximum(corners[..., [0, 2]].min(1), -AROUND) / CELL).astype(np.int64)
    high = np.floor(np.minimum(corners[..., [0, 2]].max(1), AROUND) / CELL).astype(np.int64)
    small = (high - low < SPREAD).all(1)
    steps = np.stack(np.meshgrid(*[np.arange(SPREAD)] * 2, indexing="ij"), -1).reshape(-1, 2)
    found = [_meet(corners[small, None], low[small, None] + steps)]
    for n in np.flatnonzero(~small & (high >= low).all(1)).tolist():
        sides = [np.arange(low[n, axis], high[n, axis] + 1) for axis in range(2)]
        found.append(_meet(corners[n], np.stack(np.meshgrid(*sides, indexing="ij"), -1).reshape(-1, 2)))
    return np.concatenate([cells for cells, _ in found]), np.concatenate([high for _, high in found])


def _meet(corners: Array, cells: Array) -> tuple[Array, Array]:
    """Return which of some cells `[..., 2]` are below triangles `[..., 3, 3]`, and the heights there."""
    a, b, c = (corners[..., n, :] for n in range(3))
    at = cells * CELL
    (ux, uz), (vx, vz), (wx, wz) = ((p[..., 0] - a[..., 0], p[..., -1] - a[..., 2]) for p in (b, c, at))
    area = ux * vz - uz * vx
    area = np.where(np.abs(area) > 1e-12, area, np.inf)
    s, t = (wx * vz - wz * vx) / area, (ux * wz - uz * wx) / area
    inside = (s >= -1e-6) & (t >= -1e-6) & (s + t <= 1 + 1e-6)
    heights = a[..., 1] + s * (b[..., 1] - a[..., 1]) + t * (c[..., 1] - a[..., 1])
    return np.broadcast_to(cells, (*inside.shape, 2))[inside], np.broadcast_to(heights, inside.shape)[inside]


def _make_top(cells: Array, heights: Array) -> PropTop | None:
    """Return the top of some cells `[M, 2]`, the lowest first; None if it is too small."""
    first = cells.min(0) - BEYOND
    shape = tuple(cells.max(0) - first + 1 + BEYOND)
    inside = np.zeros(shape, bool)
    grid = np.zeros(shape)
    places = tuple((cells - first).T)
    inside[places] = True
    grid[places] = heights  # the highest of a cell comes last
    known = inside
    inside = _shrink(_widen(inside, 1), 1) | inside  # between the boards of a bench
    inside &= _widen(_shrink(inside, LEAST // 2), LEAST // 2)
    if not inside.any():
        return None
    known = known & inside
    return PropTop(float(first[0] * CELL), float(first[1] * CELL), _fill(grid, known), inside)


def _sum_around(values: Array, by: int) -> Array:
    """Return for each cell the sum of those up to so many cells away, along both sides."""
    total = np.pad(values.astype(float), by).cumsum(0).cumsum(1)
    total = np.pad(total, ((1, 0), (1, 0)))
    wide = 2 * by + 1
    return np.asarray(
        total[wide:, wide:] - total[:-wide, wide:] - total[wide:, :-wide] + total[:-wide, :-wide]
    )


def _widen(inside: Array, by: int) -> Array:
    return np.asarray(_sum_around(inside, by) > 0.5)


def _shrink(inside: Array, by: int) -> Array:
    return np.asarray(_sum_around(inside, by) > (2 * by + 1) ** 2 - 0.5)


def _fill(heights: Array, known: Array) -> Array:
    """Return heights in which the cells that are not known have those of their neighbours."""
    out, known = np.where(known, heights, 0.0), known.copy()
    while not known.all():
        count = _sum_around(known, 1)
        new = ~known & (count > 0.5)
        out[new] = (_sum_around(out, 1)[new]) / count[new]
        known |= new
    return out
