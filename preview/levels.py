"""Make levels of detail: meshes with fewer triangles for figures that are small in the picture, and for
shadows.

They are kept in the user's cache folder, by the content of the mesh. Losing them costs a second or two.
METAGRAPH_MESH_CACHE names another folder; if it is empty, nothing is kept.
"""

from __future__ import annotations

import hashlib
import io
import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.disk_cache import DiskCache, cache_folder
from preview.mesh import SkinnedMesh
from preview.simplify import Fewer, simplify

Array = NDArray[Any]

ERRORS = (0.001, 0.0015, 0.002, 0.003, 0.004, 0.006, 0.008)  # of the figure's height
MADE = 1  # increase it when levels are made in another way
LEAST, LARGEST = 600, 400_000  # triangles; fewer are drawn unchanged, more would take minutes
WORTH = 0.85  # of the triangles of the previous level; a level with more is not kept
MOST = 64 * 1024 * 1024  # bytes on disk


@dataclass(frozen=True, eq=False)
class Level:
    """A mesh with fewer triangles. `error` is about how far its surface is off, in metres."""

    error: float
    mesh: SkinnedMesh


def find_levels_folder() -> Path | None:
    """Return the folder that levels are kept in, None if nothing is kept."""
    told = os.environ.get("METAGRAPH_MESH_CACHE")
    return cache_folder("meshes") if told is None else Path(told) if told else None


def make_levels(
    mesh: SkinnedMesh,
    height: float,
    cancelled: Callable[[], bool] = lambda: False,
    model: tuple[SkinnedMesh, float] | None = None,
) -> tuple[Level, ...]:
    """Return the levels of a mesh whose figure is `height` metres tall, finer ones first. None are returned
    if few triangles can be removed, or once it is `cancelled`.

    `model` is a mesh with the same triangles and its height, whose levels are taken: of a figure that comes
    in many shapes.
    """
    thinned = _thinned(*(model or (mesh, height)), cancelled)
    out, before = [], len(mesh.triangles)
    for share, fewer in zip(ERRORS, thinned, strict=False):
        if len(fewer.triangles) <= WORTH * before:
            out.append(Level(share * height, fewer.of(mesh)))
            before = len(fewer.triangles)
    return tuple(out)


def _thinned(mesh: SkinnedMesh, height: float, cancelled: Callable[[], bool]) -> list[Fewer]:
    """Return what is left of a mesh for each of ERRORS, made now or earlier; none if it has no levels."""
    if not LEAST <= len(mesh.triangles) <= LARGEST or not np.isfinite(mesh.vertices["position"]).all():
        return []
    errors = [share * height for share in ERRORS]
    cache, key = DiskCache(find_levels_folder(), MOST, ".npz"), _key(mesh, errors)
    content = cache.read(key)
    found = None if content is None else _read(content, mesh)
    if found is None:
        found = list(simplify(mesh, errors, cancelled))
        if len(found) < len(errors):
            return []
        cache.write(key, _written(found))
    return found


def _key(mesh: SkinnedMesh, errors: list[float]) -> str:
    out = hashlib.blake2b(repr((MADE, errors, mesh.matrices)).encode(), digest_size=20)
    out.update(repr([(b.first, b.count) for b in mesh.batches]).encode())
    for values in (mesh.vertices, mesh.triangles):
        out.update(np.ascontiguousarray(values).tobytes())
    return out.hexdigest()


def _written(levels: list[Fewer]) -> bytes:
    out = io.BytesIO()
    np.savez(
        out,
        **{
            f"{name}{n}": getattr(level, name).astype(np.uint32)
            for n, level in enumerate(levels)
            for name in ("used", "triangles", "counts")
        },
    )
    return out.getvalue()


def _read(content: bytes, mesh: SkinnedMesh) -> list[Fewer] | None:
    """Return the levels that were kept, None if the content is not valid for the mesh."""
    try:
        with np.load(io.BytesIO(content), allow_pickle=False) as held:
            found = [
                Fewer(held[f"used{n}"], held[f"triangles{n}"], held[f"counts{n}"].astype(np.int64))
                for n in range(len(ERRORS))
            ]
    except Exception:  # if anything is wrong with it, it is made again
        return None
    whole = all(
        f.used.ndim == 1
        and f.triangles.shape[1:] == (3,)
        and f.counts.shape == (len(mesh.batches),)
        and int(f.counts.sum()) == len(f.triangles)
        and (not len(f.used) or int(f.used.max()) < len(mesh.vertices))
        and (not len(f.triangles) or int(f.triangles.max()) < len(f.used))
        for f in found
    )
    return found if whole else None
