"""Remove triangles for figures that are small in the picture: edges are collapsed where that moves the
surface least.

The error is Garland and Heckbert's ("Surface simplification using quadric error metrics", 1997, and with
attributes 1998): the squared distance from the planes of all triangles that a point stands for. Here it is
measured in the space of positions, of the bones that move them and of texture coordinates, so that rings
round joints and painted edges stay. One end of each collapsed edge stays where it is: no point is new. All
edges of a round that are not neighbours are collapsed at once, as Python would take seconds one by one.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from preview.mesh import SkinnedMesh, TriangleBatch

Array = NDArray[Any]

MOVED = 0.03  # of the height; distance that being moved by another bone counts as
PAINTED = 0.06  # of the height; distance that the width of a texture counts as
BORDER = 3.0  # how much more the shape of a border counts than that of the surface
TURN = 0.3  # the least cosine between a triangle's directions before and after
SLIVER = 0.02  # the least share of an even triangle's area for the square of its longest side
STEPS = (0.15, 0.4, 1.0)  # of the error allowed: cheap collapses are made first
FEW = 0.01  # of the points left; a round that removes fewer ends its step


@dataclass(frozen=True, eq=False)
class Fewer:
    """What is left of a mesh. `used` holds its vertices `[U]`, `triangles` indices into those `[N, 3]`
    uint32, batch by batch, and `counts` the number of triangles in each batch `[B]`.
    """

    used: Array
    triangles: Array
    counts: Array

    def of(self, mesh: SkinnedMesh) -> SkinnedMesh:
        """Return it as a mesh, with its morph targets."""
        ends = np.cumsum(self.counts)
        batches = [
            TriangleBatch(int(end - count), int(count), b.image, b.double_sided)
            for b, end, count in zip(mesh.batches, ends, self.counts, strict=True)
        ]
        morphs = None if mesh.morphs is None else mesh.morphs.of(self.used)
        return SkinnedMesh(mesh.vertices[self.used], self.triangles, tuple(batches), mesh.matrices, morphs)


def simplify(
    mesh: SkinnedMesh, errors: Sequence[float], cancelled: Callable[[], bool] = lambda: False
) -> Iterator[Fewer]:
    """Yield for each error what is left of a mesh, fewer triangles each time. `errors` are ascending, in
    metres: how far the surface moves on average where it is simplified.

    Borders, seams of the texture and hard edges keep their shape. Ends early once it is `cancelled`.
    """
    faces = _Faces(mesh)
    for error in errors:
        for step in STEPS:
            faces.look_everywhere()
            while faces.collapse((error * step) ** 2) > FEW:
                if cancelled():
                    return
        yield faces.left()


class _Faces:
    """What is left of a mesh while it is simplified. A point is all vertices at one place."""

    def __init__(self, mesh: SkinnedMesh) -> None:
        self._mesh = mesh
        vertices = mesh.vertices
        place = np.ascontiguousarray(vertices["position"] + np.float32(0))  # no -0
        _, first, point = np.unique(place.view("V12").ravel(), return_index=True, return_inverse=True)
        self._point = point.ravel()
        corners = mesh.triangles.astype(np.int64)
        batch = np.full(len(corners), -1)
        for n, b in enumerate(mesh.batches):
            batch[b.first : b.first + b.count] = n
        p = self._point[corners]
        whole = (p[:, 0] != p[:, 1]) & (p[:, 1] != p[:, 2]) & (p[:, 2] != p[:, 0]) & (batch >= 0)
        self._corners, self._batch = corners[whole], batch[whole]
        self._place = place[first].astype(float)
        self._at = _spread(mesh, first)
        self._squares = _packed(_outer(np.concatenate([self._at, np.ones((len(self._at), 1))], 1)))
        self._quadrics, self._areas = self._begin()
        self.look_everywhere()

    def left(self) -> Fewer:
        """Return what is left."""
        order = np.argsort(self._batch, kind="stable")
        counts = np.bincount(self._batch, minlength=len(self._mesh.batches))
        used, corners = np.unique(self._corners[order], return_inverse=True)
        return Fewer(used, corners.reshape(-1, 3).astype(np.uint32), counts)

    def look_everywhere(self) -> None:
        """Consider all points in the next round; after that only those near a change."""
        self._looked_at = np.ones(len(self._at), bool)

    def _begin(self) -> tuple[Array, Array]:
        """Return each point's quadric, packed `[P, Q]`, and the area it stands for `[P]`."""
        p = self._point[self._corners]
        a, b, c = (self._at[p[:, k]] for k in range(3))
        along, area = _unit(b - a)
        across = (c - a) - ((c - a) * along).sum(1, keepdims=True) * along
        across, high = _unit(across)
        area = area * high / 2
        flat = np.eye(a.shape[1]) - _outer(along) - _outer(across)
        total, weight = np.zeros((len(self._at), *(2 * (a.shape[1] + 1,)))), np.zeros(len(self._at))
        quadric = _quadric(flat, a) * area[:, None, None]
        for k in range(3):
            np.add.at(total, p[:, k], quadric)
            np.add.at(weight, p[:, k], area)
        # A plane through each border, perpendicular to its triangle.
        _, _, count, of = _edges(p)
        corner = self._place[p]
        normal, _ = _unit(np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]))
        for k in range(3):
            open_ = count[of[:, k]] == 1
            start, end = p[open_, k], p[open_, (k + 1) % 3]
            edge = self._place[end] - self._place[start]
            away, length = _unit(np.cross(edge, normal[open_]))
            plane = np.zeros((len(start), a.shape[1]))
            plane[:, :3] = away
            border = _quadric(_outer(plane), self._at[start]) * (BORDER * length * length)[:, None, None]
            np.add.at(total, start, border)
            np.add.at(total, end, border)
        twice = 2 - np.eye(total.shape[1])
        return _packed(total * twice), np.maximum(weight, 1e-12)

    def collapse(self, most: float) -> float:
        """Collapse what can be collapsed at once within an error, metres squared. Return the removed share of
        the points.
        """
        if not len(self._corners):
            return 0.0
        p = self._point[self._corners]
        low, high, count, _ = _edges(p)
        start, end = np.concatenate([low, high]), np.concatenate([high, low])
        on = np.concatenate([count, count])
        size = len(self._at)
        # Points on a border move only along it. Where more than two triangles meet, nothing moves.
        border, knot = np.zeros(size, bool), np.zeros(size, bool)
        for points in (low, high):
            border[points[count == 1]] = True
            knot[points[count > 2]] = True
        goes = self._looked_at[start] & ~knot[start] & ((on == 1) | ~border[start])
        edge = np.flatnonzero(goes)
        error, cost = self._costs(start[edge], end[edge])
        within = error <= most
        edge, cost = edge[within], cost[within]
        self._looked_at = np.zeros(size, bool)
        self._looked_at[start[edge]] = True
        if not len(edge):
            return 0.0
        kept = self._keeps_seams(p, start[edge], end[edge])
        edge, cost = edge[kept], cost[kept]
        if not len(edge):
            return 0.0
        # The cheapest move for each point.
        order = np.lexsort((cost, start[edge]))
        edge, cost = edge[order], cost[order]
        first = np.flatnonzero(np.diff(start[edge], prepend=-1))
        edge, cost = edge[first], cost[first]
        sound = self._sound(p, start[edge], end[edge], on[edge], (low, high))
        edge, cost = edge[sound], cost[sound]
        if not len(edge):
            return 0.0
        # Moves that are the cheapest among all their neighbours do not touch each other.
        rank = np.empty(len(edge), np.int64)
        rank[np.argsort(cost, kind="stable")] = np.arange(len(edge))
        claim = np.full(size, len(edge))
        for points in (start[edge], end[edge]):
            np.minimum.at(claim, points, rank)
        least, near = claim[p].min(1), claim.copy()
        for k in range(3):
            np.minimum.at(near, p[:, k], least)
        edge = edge[(near[start[edge]] == rank) & (near[end[edge]] == rank)]
        changed = np.zeros(size, bool)
        changed[start[edge]] = changed[end[edge]] = True
        self._looked_at[p[changed[p].any(1)]] = True
        self._apply(start[edge], end[edge])
        return len(edge) / len(np.unique(low))

    def _costs(self, start: Array, end: Array) -> tuple[Array, Array]:
        """Return the cost of moving points to others: the mean squared error, and the same times its area."""
        gone = np.einsum("nq,nq->n", self._squares[end], self._quadrics[start])
        stays = np.einsum("nq,nq->n", self._squares, self._quadrics)[end]
        area, other = self._areas[start], self._areas[end]
        both = np.maximum(gone + stays, 0)
        error = np.maximum(both / (area + other), np.maximum(gone, 0) / area)
        length = ((self._place[start] - self._place[end]) ** 2).sum(1)
        return error, both + 1e-4 * length * area  # if two cost nothing, the shorter goes first

    def _keeps_seams(self, p: Array, start: Array, end: Array) -> Array:
        """Return which edges offer every vertex of the moved point a vertex to move to."""
        size = np.int64(len(self._at))
        seen = np.zeros(len(self._point), bool)
        seen[self._corners] = True
        vertices = np.bincount(self._point[seen], minlength=len(self._at))
        # From vertex to vertex, at points that have several.
        a, b = _ways(self._corners)
        order = np.lexsort((b, a, self._point[b], self._point[a]))
        a, b = a[order], b[order]
        self._ways, self._codes = (a, b), self._point[a] * size + self._point[b]
        run = np.flatnonzero(np.diff(self._codes, prepend=-1))
        pairs = np.diff(np.append(run, len(self._codes)))
        new = np.diff(a, prepend=-1) != 0
        new[run] = True
        from_ = np.add.reduceat(new.astype(np.int64), run)
        found = np.searchsorted(self._codes[run], start * size + end)
        return np.asarray((pairs[found] == from_[found]) & (from_[found] == vertices[start]))

    def _sound(self, p: Array, start: Array, end: Array, on: Array, edges: tuple[Array, Array]) -> Array:
        """Return which collapses neither pinch the surface nor turn a triangle over."""
        size = np.int64(len(self._at))
        low, high = edges
        codes = low * size + high  # sorted
        ends = np.concatenate([low, high]), np.concatenate([high, low])
        which, other = _gathered(ends[0], ends[1], start, len(self._at))
        a, b = np.minimum(other, end[which]), np.maximum(other, end[which])
        place = np.minimum(np.searchsorted(codes, a * size + b), len(codes) - 1)
        shared = np.bincount(which[codes[place] == a * size + b], minlength=len(start))
        sound = shared == on
        triangle = np.repeat(np.arange(len(p)), 3)
        which, t = _gathered(p.ravel(), triangle, start, len(self._at))
        left = ~(p[t] == end[which][:, None]).any(1)
        which, t = which[left], t[left]
        before = self._place[p[t]]
        after = np.where((p[t] == start[which][:, None])[..., None], self._place[end[which]][:, None], before)
        old, _ = _unit(np.cross(before[:, 1] - before[:, 0], before[:, 2] - before[:, 0]))
        new, area = _unit(np.cross(after[:, 1] - after[:, 0], after[:, 2] - after[:, 0]))
        longest = ((after - np.roll(after, 1, 1)) ** 2).sum(2).max(1)
        bad = ((old * new).sum(1) < TURN) | (area < SLIVER * longest)
        return np.asarray(sound & (np.bincount(which[bad], minlength=len(start)) == 0))

    def _apply(self, start: Array, end: Array) -> None:
        np.add.at(self._quadrics, end, self._quadrics[start])
        np.add.at(self._areas, end, self._areas[start])
        size = np.int64(len(self._at))
        moved = np.arange(len(self._mesh.vertices))
        wanted = np.sort(start * size + end)
        place = np.minimum(np.searchsorted(wanted, self._codes), len(wanted) - 1)
        a, b = (ends[wanted[place] == self._codes] for ends in self._ways)
        moved[a] = b
        corners = moved[self._corners]
        p = self._point[corners]
        left = (p[:, 0] != p[:, 1]) & (p[:, 1] != p[:, 2]) & (p[:, 2] != p[:, 0])
        self._corners, self._batch = corners[left], self._batch[left]


def _spread(mesh: SkinnedMesh, which: Array) -> Array:
    """Return vertices in the space that errors are measured in `[N, 8]`: position, bones, texture."""
    vertices = mesh.vertices[which]
    place = vertices["position"].astype(float)
    height = max(float(np.ptp(place, axis=0).max()), 1e-9) if len(place) else 1.0
    # A direction for each bone, far from those of its neighbours: a spiral round the sphere.
    n = np.arange(mesh.matrices) + 0.5
    up, turn = 1 - 2 * n / max(mesh.matrices, 1), n * 2.39996323
    flat = np.sqrt(1 - up * up)
    ways = np.stack([flat * np.cos(turn), up, flat * np.sin(turn)], 1)
    moved = (ways[vertices["bones"]] * np.nan_to_num(vertices["weights"])[..., None].astype(float)).sum(1)
    return np.concatenate(
        [place, MOVED * height * moved, PAINTED * height * np.clip(np.nan_to_num(vertices["uv"]), -8, 8)], 1
    )


def _unit(v: Array) -> tuple[Array, Array]:
    """Return directions `[N, D]` and lengths `[N]`."""
    length = np.sqrt((v * v).sum(1))
    return v / np.maximum(length, 1e-20)[:, None], length


def _outer(v: Array) -> Array:
    return np.asarray(v[:, :, None] * v[:, None, :])


def _packed(square: Array) -> Array:
    """Return the upper halves `[N, D (D + 1) / 2]` of symmetric matrices `[N, D, D]`."""
    row, column = np.triu_indices(square.shape[1])
    return np.ascontiguousarray(square[:, row, column])


def _quadric(flat: Array, at: Array) -> Array:
    """Return `[N, D + 1, D + 1]`: the square of the distance from `at` within `flat [N, D, D]`."""
    beside = -np.einsum("nij,nj->ni", flat, at)
    out = np.empty((len(at), *(2 * (at.shape[1] + 1,))))
    out[:, :-1, :-1] = flat
    out[:, :-1, -1] = out[:, -1, :-1] = beside
    out[:, -1, -1] = -np.einsum("ni,ni->n", beside, at)
    return out


def _edges(p: Array) -> tuple[Array, Array, Array, Array]:
    """Return the ends of all edges, the lower first and sorted, how many triangles each has, and each
    triangle's three edges `[N, 3]`.
    """
    size = np.int64(p.max() + 1 if len(p) else 1)
    a, b = p, np.roll(p, -1, 1)
    code = (np.minimum(a, b) * size + np.maximum(a, b)).ravel()
    order = np.argsort(code, kind="stable")
    new = np.diff(code[order], prepend=-1) != 0
    first = np.flatnonzero(new)
    of = np.empty(len(code), np.int64)
    of[order] = np.cumsum(new) - 1
    count = np.diff(np.append(first, len(code)))
    code = code[order[first]]
    return code // size, code % size, count, of.reshape(p.shape)


def _ways(corners: Array) -> tuple[Array, Array]:
    """Return every vertex with each vertex that it shares a triangle with, once."""
    a = np.concatenate([corners, corners], 1).ravel()
    b = np.concatenate([np.roll(corners, -1, 1), np.roll(corners, 1, 1)], 1).ravel()
    size = np.int64(corners.max() + 1)
    code = np.sort(a * size + b)
    code = code[np.diff(code, prepend=-1) != 0]
    return code // size, code % size


def _gathered(keys: Array, values: Array, wanted: Array, size: int) -> tuple[Array, Array]:
    """Return for all values whose key is in `wanted` the index into `wanted`, and the value."""
    order = np.argsort(keys, kind="stable")
    begins = np.searchsorted(keys[order], np.arange(size + 1))
    first, count = begins[wanted], begins[wanted + 1] - begins[wanted]
    which = np.repeat(np.arange(len(wanted)), count)
    within = np.arange(len(which)) - np.repeat(np.cumsum(count) - count, count)
    return which, values[order][first[which] + within]
