"""Sculpting with distance fields: shapes, their smooth union, and a triangle mesh of the size each place
deserves.

A field is a function of points `[N, 3]` (metres) to signed distances `[N]`, negative inside. Everything is
deterministic.
"""

from __future__ import annotations

import heapq
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]
Field = Callable[[Array], Array]


def _v(x: Sequence[float] | Array) -> Array:
    return np.asarray(x, float)


def cone(
    a: Sequence[float] | Array,
    b: Sequence[float] | Array,
    ra: float,
    rb: float,
    flat: Sequence[float] | Array | None = None,
) -> Field:
    """A rod from `a` to `b` with round ends of radii `ra`, `rb`. flat: scale of the space across, such as (1,
    1, 1.2).
    """
    a, b = _v(a), _v(b)
    scale = np.ones(3) if flat is None else _v(flat)

    def field(p: Array) -> Array:
        ab = b - a
        q = p - a
        t = np.clip(q @ ab / max(float(ab @ ab), 1e-12), 0, 1)
        return np.asarray(np.linalg.norm((q - t[:, None] * ab) * scale, axis=1) - (ra + (rb - ra) * t))

    return field


def rods(points: Sequence[Sequence[float] | Array], radii: Sequence[float], k: float) -> Field:
    """A chain of `cone`s, melted into one another by `k`."""
    return union([cone(points[i], points[i + 1], radii[i], radii[i + 1]) for i in range(len(points) - 1)], k)


def ellipsoid(
    centre: Sequence[float] | Array, radii: Sequence[float] | Array, turn: Array | None = None
) -> Field:
    """turn: `[3, 3]` whose rows are the ellipsoid's axes."""
    c, r = _v(centre), _v(radii)

    def field(p: Array) -> Array:
        q = p - c if turn is None else (p - c) @ turn.T
        k0, k1 = np.linalg.norm(q / r, axis=1), np.linalg.norm(q / (r * r), axis=1)
        return np.asarray(np.where(k1 > 1e-9, k0 * (k0 - 1) / np.maximum(k1, 1e-9), -r.min()))

    return field


def box(
    centre: Sequence[float] | Array, half: Sequence[float] | Array, round_: float, turn: Array | None = None
) -> Field:
    """A box with edges rounded by `round_`; `half` sizes include the rounding."""
    c, h = _v(centre), _v(half) - round_

    def field(p: Array) -> Array:
        q = np.abs(p - c if turn is None else (p - c) @ turn.T) - h
        return np.asarray(np.linalg.norm(np.maximum(q, 0), axis=1) + np.minimum(q.max(1), 0) - round_)

    return field


def plane(point: Sequence[float] | Array, normal: Sequence[float] | Array) -> Field:
    """The half space behind the plane: positive on the side the normal points to."""
    c, n = _v(point), _v(normal) / np.linalg.norm(_v(normal))
    return lambda p: np.asarray((p - c) @ n)


def torus(
    centre: Sequence[float], normal: Sequence[float], radii: tuple[float, float], minor: float
) -> Field:
    """A ring; `radii` are its half widths along X and across it."""
    c, n = _v(centre), _v(normal) / np.linalg.norm(_v(normal))
    x = np.array([1.0, 0, 0])
    y = np.cross(n, x)

    def field(p: Array) -> Array:
        q = p - c
        u, v, h = q @ x / radii[0], q @ y / radii[1], q @ n
        rho = np.hypot(u, v)
        return np.asarray(np.hypot((rho - 1) * 0.5 * (radii[0] + radii[1]), h) - minor)

    return field


def smooth_min(a: Array, b: Array, k: float) -> Array:
    if k <= 0:
        return np.minimum(a, b)
    h = np.maximum(k - np.abs(a - b), 0) / k
    return np.asarray(np.minimum(a, b) - h * h * h * k / 6)


def union(fields: Sequence[Field], k: float) -> Field:
    def field(p: Array) -> Array:
        out = fields[0](p)
        for other in fields[1:]:
            out = smooth_min(out, other(p), k)
        return out

    return field


def common(a: Field, b: Field, k: float) -> Field:
    """What both hold; the new edge is rounded by `k`."""
    return lambda p: -smooth_min(-a(p), -b(p), k)


def without(a: Field, b: Field, k: float) -> Field:
    """`a` with `b` cut out."""
    return lambda p: -smooth_min(-a(p), b(p), k)


def grown(a: Field, by: float) -> Field:
    return lambda p: a(p) - by


def mirrored(field: Field) -> Field:
    """The same on both sides of the plane x = 0, made for x > 0."""
    return lambda p: field(np.stack([np.abs(p[:, 0]), p[:, 1], p[:, 2]], 1))


def gradient(field: Field, points: Array, step: float = 4e-4) -> Array:
    """Unit outward directions `[N, 3]`."""
    out = np.empty_like(points)
    for axis in range(3):
        shift = np.zeros(3)
        shift[axis] = step
        out[:, axis] = field(points + shift) - field(points - shift)
    return np.asarray(out / np.maximum(np.linalg.norm(out, axis=1, keepdims=True), 1e-12))


def polygonise(field: Field, low: Sequence[float], high: Sequence[float], cell: float) -> tuple[Array, Array]:
    """Return positions `[V, 3]` and triangles `[N, 3]` of the zero surface: one vertex in each cell it passes
    (surface nets).

    Only blocks near the surface are evaluated finely.
    """
    low_, high_ = _v(low), _v(high)
    block = 4
    count = np.ceil((high_ - low_) / (cell * block)).astype(int)
    shape = count * block + 1
    values = np.full(shape, np.inf, np.float32)
    centres = np.stack(
        np.meshgrid(*[low_[i] + (np.arange(count[i]) + 0.5) * cell * block for i in range(3)], indexing="ij"),
        -1,
    )
    coarse = field(centres.reshape(-1, 3)).reshape(tuple(count))
    values[:-1, :-1, :-1] = np.repeat(np.repeat(np.repeat(np.sign(coarse), block, 0), block, 1), block, 2)
    values[~np.isfinite(values)] = 1
    near = np.argwhere(np.abs(coarse) < cell * block * 2.0)
    inner = np.stack(np.meshgrid(*[np.arange(block + 1)] * 3, indexing="ij"), -1).reshape(-1, 3)
    index = np.unique((near[:, None] * block + inner).reshape(-1, 3) @ [shape[1] * shape[2], shape[2], 1])
    where = np.stack(np.unravel_index(index, tuple(shape)), -1)
    flat = values.reshape(-1)
    for start in range(0, len(index), 200_000):
        part = slice(start, start + 200_000)
        flat[index[part]] = field(low_ + where[part] * cell)

    inside = values < 0
    corners = np.stack(np.meshgrid(*[[0, 1]] * 3, indexing="ij"), -1).reshape(-1, 3)
    total = sum(
        inside[c[0] : shape[0] - 1 + c[0], c[1] : shape[1] - 1 + c[1], c[2] : shape[2] - 1 + c[2]].astype(
            np.int8
        )
        for c in corners
    )
    cells = np.argwhere((total > 0) & (total < 8))
    at = np.full(shape - 1, -1, np.int64)
    at[tuple(cells.T)] = np.arange(len(cells))
    summed, hits = np.zeros((len(cells), 3)), np.zeros(len(cells))
    for a in range(8):
        for axis in range(3):
            if corners[a][axis]:
                continue
            one = cells + corners[a]
            two = one.copy()
            two[:, axis] += 1
            va, vb = values[tuple(one.T)].astype(float), values[tuple(two.T)].astype(float)
            crossed = (va < 0) != (vb < 0)
            t = np.where(crossed, va / np.where(crossed, va - vb, 1), 0)
            place = one.astype(float)
            place[:, axis] += t
            summed += np.where(crossed[:, None], place, 0)
            hits += crossed
    positions = low_ + summed / np.maximum(hits, 1)[:, None] * cell
    triangles = []
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        first = np.moveaxis(inside, axis, 0)
        edges = np.argwhere(np.moveaxis(first[:-1] != first[1:], 0, axis))
        edges = edges[
            (edges[:, u] > 0)
            & (edges[:, v] > 0)
            & (edges[:, u] < shape[u] - 1)
            & (edges[:, v] < shape[v] - 1)
        ]
        quad = []
        for du, dv in ((-1, -1), (0, -1), (0, 0), (-1, 0)):
            c = edges.copy()
            c[:, u] += du
            c[:, v] += dv
            quad.append(at[tuple(c.T)])
        q = np.stack(quad, -1)
        q = np.where(inside[tuple(edges.T)][:, None], q, q[:, ::-1])
        triangles += [q[:, [0, 1, 2]], q[:, [0, 2, 3]]]
    # Where the box cuts the form, cells at its sides have a vertex but no triangle.
    used, corners_of = np.unique(np.concatenate(triangles), return_inverse=True)
    return positions[used], corners_of.reshape(-1, 3)


def remesh(
    field: Field, positions: Array, triangles: Array, size: Callable[[Array], Array], rounds: int = 3
) -> tuple[Array, Array]:
    """Thin a fine mesh out to edges of about `size(points)` metres, then even it on the surface."""
    positions, triangles = _collapse(positions, triangles, size(positions))
    for _ in range(rounds):
        triangles = _flip(positions, triangles)
        positions = _relax(field, positions, triangles)
    positions, triangles = _collapse(positions, triangles, size(positions) * 0.8)
    triangles = _flip(positions, triangles)
    positions = _relax(field, positions, triangles)
    return positions, triangles


def project(field: Field, positions: Array, steps: int = 4) -> Array:
    """Move points onto the zero surface."""
    for _ in range(steps):
        d = field(positions)
        positions = positions - gradient(field, positions) * np.clip(d, -0.004, 0.004)[:, None]
    return positions


def _relax(field: Field, positions: Array, triangles: Array) -> Array:
    """Move vertices along the surface to the middle of their neighbours."""
    corner = positions[triangles]
    area = np.linalg.norm(np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]), axis=1) + 1e-12
    middle = corner.mean(1) * area[:, None]
    total, weight = np.zeros_like(positions), np.zeros(len(positions))
    for k in range(3):
        np.add.at(total, triangles[:, k], middle)
        np.add.at(weight, triangles[:, k], area)
    goal = total / np.maximum(weight, 1e-12)[:, None]
    normal = gradient(field, positions)
    move = goal - positions
    move -= normal * np.einsum("ij,ij->i", move, normal)[:, None]
    return project(field, positions + 0.6 * move)


def _collapse(positions: Array, triangles: Array, size: Array) -> tuple[Array, Array]:
    """Merge the ends of edges shorter than 0.8 of the size there, the relatively shortest first."""
    place = [tuple(x) for x in positions.tolist()]
    wanted = size.tolist()
    corners: list[list[int] | None] = triangles.tolist()
    around: list[set[int]] = [set() for _ in place]
    for t, tri in enumerate(corners):
        for v in tri or ():
            around[v].add(t)

    def ratio(a: int, b: int) -> float:
        pa, pb = place[a], place[b]
        length = ((pa[0] - pb[0]) ** 2 + (pa[1] - pb[1]) ** 2 + (pa[2] - pb[2]) ** 2) ** 0.5
        return float(length / (0.5 * (wanted[a] + wanted[b])))

    def neighbours(v: int) -> set[int]:
        return {x for t in around[v] for x in (corners[t] or ())} - {v}

    def normal(a: Any, b: Any, c: Any) -> tuple[float, float, float]:
        ux, uy, uz, vx, vy, vz = b[0] - a[0], b[1] - a[1], b[2] - a[2], c[0] - a[0], c[1] - a[1], c[2] - a[2]
        return uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx

    limit = 0.8
    heap = []
    for tri in corners:
        for a, b in ((0, 1), (1, 2), (2, 0)):
            u, v = tri[a], tri[b]  # type: ignore[index]
            if u < v and (r := ratio(u, v)) < limit:
                heap.append((r, u, v))
    heapq.heapify(heap)
    gone = [False] * len(place)
    while heap:
        r, u, v = heapq.heappop(heap)
        if gone[u] or gone[v]:
            continue
        shared = around[u] & around[v]
        if len(shared) != 2 or abs(ratio(u, v) - r) > 1e-12:
            continue
        nu, nv = neighbours(u), neighbours(v)
        if len(nu & nv) != 2 or len(nu | nv) < 6:
            continue
        pu, pv = place[u], place[v]
        middle = ((pu[0] + pv[0]) / 2, (pu[1] + pv[1]) / 2, (pu[2] + pv[2]) / 2)
        turned = False
        for x in (u, v):
            for t in around[x] - shared:
                a, b, c = corners[t]  # type: ignore[misc]
                old = normal(place[a], place[b], place[c])
                new = normal(*(middle if w == x else place[w] for w in (a, b, c)))
                dot = old[0] * new[0] + old[1] * new[1] + old[2] * new[2]
                if (
                    dot
                    <= 0.35
                    * ((old[0] ** 2 + old[1] ** 2 + old[2] ** 2) * (new[0] ** 2 + new[1] ** 2 + new[2] ** 2))
                    ** 0.5
                ):
                    turned = True
                    break
            if turned:
                break
        if turned:
            continue
        place[u], wanted[u], gone[v] = middle, 0.5 * (wanted[u] + wanted[v]), True
        for t in shared:
            for w in corners[t] or ():
                around[w].discard(t)
            corners[t] = None
        for t in around[v]:
            corners[t] = [u if w == v else w for w in corners[t] or ()]
            around[u].add(t)
        around[v] = set()
        for w in sorted(neighbours(u)):
            if (r := ratio(u, w)) < limit:
                heapq.heappush(heap, (r, min(u, w), max(u, w)))
    kept, left = np.unique(np.array([t for t in corners if t is not None]), return_inverse=True)
    return np.array(place)[kept], left.reshape(-1, 3)


def _flip(positions: Array, triangles: Array) -> Array:
    """Turn edges whose opposite angles sum to more than half a turn (Delaunay), where the surface is flat
    enough.
    """
    tris = triangles.tolist()
    for _ in range(4):
        edges: dict[tuple[int, int], int] = {}
        for t, (a, b, c) in enumerate(tris):
            edges[(a, b)] = edges[(b, c)] = edges[(c, a)] = t
        touched: set[int] = set()
        changed = 0
        for (a, b), t in sorted(edges.items()):
            s = edges.get((b, a))
            if a > b or s is None or t in touched or s in touched:
                continue
            c = next(x for x in tris[t] if x not in (a, b))
            d = next(x for x in tris[s] if x not in (a, b))
            if c == d or (c, d) in edges or (d, c) in edges:
                continue
            pa, pb, pc, pd = positions[a], positions[b], positions[c], positions[d]
            n1, n2 = np.cross(pb - pa, pc - pa), np.cross(pa - pb, pd - pb)
            if n1 @ n2 < 0.8 * np.sqrt((n1 @ n1) * (n2 @ n2)):
                continue
            angle_c, angle_d = _angle(pa - pc, pb - pc), _angle(pa - pd, pb - pd)
            m1, m2 = np.cross(pd - pc, pb - pc), np.cross(pc - pd, pa - pd)
            if angle_c + angle_d > np.pi + 1e-6 and m1 @ n1 > 0 and m2 @ n1 > 0:
                tris[t], tris[s] = [c, d, b], [d, c, a]
                touched |= {t, s}
                changed += 1
        if not changed:
            break
    return np.array(tris)


def _angle(a: Array, b: Array) -> float:
    return float(np.arccos(np.clip(a @ b / np.sqrt((a @ a) * (b @ b) + 1e-30), -1, 1)))
