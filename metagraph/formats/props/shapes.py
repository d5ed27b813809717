"""Mend the shapes of props: triangles without an area, too many of them, and normals."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

MOST_TRIANGLES = 200_000  # of a prop; more take longer to draw than the character
CREASE = 0.766  # cosine of 40 degrees: edges sharper than that are drawn as edges
FINEST, COARSEST = 9, 3  # the grid that points are gathered on has 2 to the power of this many cells along
WIDEST = 2048  # pixels of a picture; larger ones are reduced
_PIXELS = 64  # width and height of a picture of colours


def find_drawable(positions: Array, triangles: Array) -> Array:
    """Return which of triangles `[N, 3]` can be drawn `[N]`: not those without an area, with a point that is
    no number, or with one that positions `[V, 3]` have not.
    """
    there = ((triangles >= 0) & (triangles < len(positions))).all(1)
    a, b, c = (positions[np.where(there, triangles[:, n], 0)] for n in range(3))
    with np.errstate(invalid="ignore", over="ignore"):
        area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    return np.asarray(there & np.isfinite(area) & (area > 0))


def has_inside(positions: Array, triangles: Array) -> bool:
    """Return whether a surface has an inside: each edge of its triangles is there once in each direction.
    Points at one place are one point.
    """
    where = _find_once(positions.round(7))[1][triangles]
    edges = np.concatenate([where[:, [0, 1]], where[:, [1, 2]], where[:, [2, 0]]])
    key = (edges[:, 0].astype(np.int64) << 32) | edges[:, 1]
    back = (edges[:, 1].astype(np.int64) << 32) | edges[:, 0]
    return bool(np.array_equal(np.sort(key), np.sort(back)))


def measure_volume(positions: Array, triangles: Array) -> float:
    """Return how much a closed surface holds, cubic metres; negative if it is inside out."""
    a, b, c = (positions[triangles[:, n]] - positions.mean(0) for n in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)


def thin_out(positions: Array, triangles: Array, most: int) -> tuple[Array, Array]:
    """Return positions and at most `most` triangles of nearly the same shape: points in one cell of a grid
    become their middle. The grid is as fine as it may be.
    """
    used, corners = np.unique(triangles, return_inverse=True)
    points, corners = positions[used], corners.reshape(-1, 3)
    low, size = points.min(0), max(float(np.ptp(points, axis=0).max()), 1e-9)
    for power in range(FINEST, COARSEST - 1, -1):
        cell = np.minimum((points - low) / size * 2**power, 2**power - 1).astype(np.int64)
        key = (cell[:, 0] << 40) | (cell[:, 1] << 20) | cell[:, 2]
        _, group, count = np.unique(key, return_inverse=True, return_counts=True)
        fewer = group[corners]
        fewer = fewer[
            (fewer[:, 0] != fewer[:, 1]) & (fewer[:, 1] != fewer[:, 2]) & (fewer[:, 2] != fewer[:, 0])
        ]
        chosen = fewer[np.sort(_find_once(np.sort(fewer, axis=1))[0])]
        if len(chosen) <= most or power == COARSEST:
            break
    middles = np.stack([np.bincount(group, points[:, n]) for n in range(3)], 1) / count[:, None]
    return middles, chosen[:most]


def make_normals(
    positions: Array, triangles: Array, uvs: Array | None = None
) -> tuple[Array, Array, Array, Array]:
    """Return positions, normals, texture coordinates and triangles of a mesh that is smooth but for its
    creases: points on a crease are there once for each side.

    uvs: `[V, 2]` of the points, or `[N, 3, 2]` of the triangles' corners; zeros if None.
    """
    corners = triangles.reshape(-1)
    a, b, c = (positions[triangles[:, n]] for n in range(3))
    faces = np.cross(b - a, c - a)
    flat = faces / np.maximum(np.linalg.norm(faces, axis=1, keepdims=True), 1e-30)
    # Points that the file has twice, at a seam of its picture, are one point of the surface.
    places = _find_once(positions.round(7))[1][corners]
    order = np.argsort(places, kind="stable")
    starts = np.flatnonzero(np.diff(places[order], prepend=-1))
    lengths = np.diff(np.append(starts, len(order)))
    normals = np.zeros((len(corners), 3))
    for valence in np.unique(lengths):
        rows = order[starts[lengths == valence][:, None] + np.arange(valence)]  # corners of one point each
        near = flat[rows // 3]
        together = (
            np.einsum("pik,pjk->pij", near, near) > CREASE if valence <= 64 else np.ones((1, 1, 1), bool)
        )
        summed = np.einsum(
            "pij,pjk->pik", np.broadcast_to(together, (len(rows), valence, valence)), faces[rows // 3]
        )
        normals[rows] = summed
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    normals = np.where(
        length > 1e-30, normals / np.maximum(length, 1e-30), flat[np.arange(len(corners)) // 3]
    )
    if uvs is None:
        at = np.zeros((len(corners), 2))
    else:
        at = uvs[corners] if uvs.ndim == 2 else uvs.reshape(-1, 2)
    all_rows = np.concatenate([positions[corners], normals, at], 1)
    first, where = _find_once(all_rows.round(6))
    once = all_rows[first]
    return once[:, :3], once[:, 3:6], once[:, 6:], where.reshape(-1, 3)


def _find_once(rows: Array) -> tuple[Array, Array]:
    """Return the places of rows `[N, D]` that differ, and for each row the number of its like among those.
    Rows are compared by a hash of 64 bits, which is many times as fast as comparing them.
    """
    words = np.ascontiguousarray(rows + 0.0, np.float64).view(np.uint64)  # 0.0: -0 is 0
    key = np.zeros(len(rows), np.uint64)
    with np.errstate(over="ignore"):
        for column in words.T:
            key = (key ^ column) * np.uint64(0x9E3779B97F4A7C15)
            key ^= key >> np.uint64(29)
    _, first, where = np.unique(key, return_index=True, return_inverse=True)
    return first, where.reshape(-1)


def make_colour_picture(colours: Array) -> tuple[bytes, Array]:
    """Return a PNG that has the colours `[N, 3]` uint8 of triangles, one pixel each, and the texture
    coordinates `[N, 3, 2]` of their corners. Colours are rounded where there are too many.
    """
    from PIL import Image

    for bits in range(8, 0, -1):
        rounded = colours >> (8 - bits) << (8 - bits)
        once, which = np.unique(rounded, axis=0, return_inverse=True)
        if len(once) <= _PIXELS * _PIXELS:
            break
    picture = np.zeros((_PIXELS * _PIXELS, 3), np.uint8)
    picture[: len(once)] = once
    which = which.reshape(-1)
    at = np.stack([which % _PIXELS + 0.5, which // _PIXELS + 0.5], 1) / _PIXELS
    return encode_picture(Image.fromarray(picture.reshape(_PIXELS, _PIXELS, 3))), np.repeat(at[:, None], 3, 1)


def encode_picture(picture: Any) -> bytes:
    """Return a picture of Pillow's as PNG, at most `WIDEST` pixels wide and high."""
    import io

    if picture.mode not in ("RGB", "RGBA"):
        picture = picture.convert("RGBA")
    if max(picture.size) > WIDEST:
        picture = picture.copy()
        picture.thumbnail((WIDEST, WIDEST))
    out = io.BytesIO()
    picture.save(out, "PNG")
    return out.getvalue()
