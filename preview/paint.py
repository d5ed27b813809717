"""Put the colours of a texture on a mesh's vertices if a triangle looks the same without the texture.

Many figures are painted from a palette: each triangle has one colour, or one colour fading into another.
Looking up colours in a texture takes the processor a twentieth of the time of a picture.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from preview.mesh import SkinnedMesh

Array = NDArray[Any]

OFF = 3.0 / 255  # how far a colour may be off, of the range written to the screen
LEAST = 0.5  # of a batch's triangles; fewer that look the same are not worth another draw call
_GAMMA = 2.2
_LINEAR = ((np.arange(256) / 255) ** _GAMMA).astype(np.float32)  # what the shader makes of a vertex's colours


def remove_invisible_texture(
    mesh: SkinnedMesh, decoded: Callable[[bytes], tuple[tuple[int, int], bytes]]
) -> tuple[SkinnedMesh, Array]:
    """Return a mesh that looks the same with fewer textured triangles, and for each of its vertices the
    vertex of `mesh` it comes from.

    Triangles stay in their batch or in the batches it is split into. If batches follow one another, so do
    these. `decoded` returns the size and the RGBA pixels of an image.
    """
    vertices, triangles = [mesh.vertices], mesh.triangles.copy()
    origins, batches = [np.arange(len(mesh.vertices))], []
    count = len(mesh.vertices)
    for batch in mesh.batches:
        part = triangles[batch.first : batch.first + batch.count]
        plain = np.zeros(len(part), bool)
        if batch.image is not None:
            size, pixels = decoded(batch.image)
            image = np.frombuffer(pixels, np.uint8).reshape(size[1], size[0], 4)
            used, corners = np.unique(part, return_inverse=True)
            seen = mesh.vertices[used]
            linear = _own(seen) * _linear(_sampled(image, seen["uv"]))
            colors = np.round(255 * np.nan_to_num(linear) ** (1 / _GAMMA)).astype(np.uint8)
            plain = _same(seen, colors, corners.reshape(-1, 3), image)
        if not plain.any() or plain.mean() < LEAST:
            batches.append(batch)
            continue
        kept = np.unique(part[plain])
        more = mesh.vertices[kept].copy()
        more["color"][:, :3] = colors[np.searchsorted(used, kept)]
        part[plain] = count + np.searchsorted(kept, part[plain])
        part[:] = np.concatenate([part[plain], part[~plain]])
        first, rest = int(plain.sum()), int((~plain).sum())
        batches.append(replace(batch, count=first, image=None))
        if rest:
            batches.append(replace(batch, first=batch.first + first, count=rest))
        vertices.append(more)
        origins.append(kept)
        count += len(kept)
    if len(vertices) == 1:
        return mesh, origins[0]
    # Morphs and grain are not copied: the origins say to which vertices they belong.
    return (
        SkinnedMesh(np.concatenate(vertices), triangles, tuple(batches), mesh.matrices),
        np.concatenate(origins),
    )


def _own(vertices: Array) -> Array:
    """Return the linear colours of vertices, 0..1, that those of a texture are multiplied with."""
    return np.asarray(_LINEAR[vertices["color"][:, :3]])


def _same(vertices: Array, colors: Array, corners: Array, image: Array) -> Array:
    """Return `[N]`: whether each of the triangles `corners [N, 3]` looks the same with `colors [V, 3]` uint8
    at its vertices as with the image.
    """
    out = np.ones(len(corners), bool)
    # For each corner of a triangle: its place in the image, and the roots of its own colour and of the new
    # one. The shader fades roots of colours from corner to corner.
    told = np.concatenate([vertices["uv"], np.sqrt(_own(vertices)), np.sqrt(_LINEAR[colors])], 1)
    a, b, c = (told.take(corner, 0) for corner in corners.T)
    for inside in ((a + b + c) / 3, (a + b) / 2, (b + c) / 2, (c + a) / 2):  # middles of triangle and sides
        at, own, instead = inside[:, :2], inside[:, 2:5], inside[:, 5:]
        off = np.abs(np.sqrt(_linear(_sampled(image, at))) * own - instead)
        out &= off.max(1, initial=0.0) <= OFF
    return out


def _linear(texel: Array) -> Array:
    """Return what the shader makes of a texture's colours, 0..1."""
    return np.asarray(texel * texel * (0.7 * texel + 0.3))


def _sampled(image: Array, uv: Array) -> Array:
    """Return colours `[N, 3]`, 0..1, of `image [H, W, 4]` uint8 between its pixels. The image repeats."""
    high, wide = image.shape[:2]
    at = uv * np.array([wide, high], np.float32) - np.float32(0.5)
    low = np.floor(at)
    along, across = (at - low).T[..., None]
    x, y = np.nan_to_num(low).astype(np.int64).T
    x, right, y, above = x % wide, (x + 1) % wide, y % high * wide, (y + 1) % high * wide
    texels = image.reshape(-1, 4)

    def between(row: Array) -> Array:
        here, there = (texels.take(row + column, 0)[:, :3].astype(np.float32) for column in (x, right))
        return np.asarray(here + (there - here) * along)

    here = between(y)
    return np.asarray((here + (between(above) - here) * across) / np.float32(255))
