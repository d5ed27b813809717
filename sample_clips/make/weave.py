"""Grains of cloth as tangent-space normal maps that repeat, made from heights by numbers, and where on
cloth each point lies.
"""

from __future__ import annotations

import io
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sample_clips.make.folds import SHOULDER
from sample_clips.make.mannequin_skeleton import ARM
from sample_clips.make.pieces import Piece

Array = NDArray[Any]

SIZE = 64  # pixels of each map
TILE = {"knit": 0.0150, "denim": 0.0090, "wool": 0.0120}  # metres that a map covers


def _grid() -> tuple[Array, Array]:
    at = (np.arange(SIZE) + 0.5) / SIZE
    x, y = np.meshgrid(at, at)
    return x, y


def _knit() -> Array:
    """Two columns of stitches, three rows: each stitch is a V of two strands."""
    x, y = _grid()
    out = np.zeros((SIZE, SIZE))
    column = (2 * x) % 1.0 - 0.5
    for side in (-1.0, 1.0):
        for shift in (-1.0, 0.0, 1.0):
            row = (3 * y + 0.9 * np.abs(column)) % 1.0 - 0.5 + shift
            away = np.hypot((column - side * 0.24) / 0.25, row / 0.62)
            out = np.maximum(out, np.sqrt(np.clip(1 - away**2, 0, 1)))
    return out * 0.14


def _denim() -> Array:
    """Twill: threads over two, under one, each row a step further."""
    x, y = _grid()
    diagonal = (4 * x + 4 * y) % 1.0
    thread = (8 * y) % 1.0
    return 0.030 * np.sin(np.pi * diagonal) ** 1.5 + 0.012 * np.sin(np.pi * thread)


def _wool() -> Array:
    """Herringbone: twill that turns back at each half."""
    x, y = _grid()
    fold = np.abs(((2 * x) % 1.0) - 0.5)
    return 0.022 * np.sin(np.pi * ((4 * fold + 4 * y) % 1.0)) ** 1.5


_HEIGHTS = {"knit": _knit, "denim": _denim, "wool": _wool}


def grain_image(name: str) -> bytes:
    """Return the normal map of a grain as PNG. Green is up the picture, as in glTF."""
    from PIL import Image

    high = _HEIGHTS[name]() * SIZE  # in pixels, as slopes are
    across = (np.roll(high, -1, 1) - np.roll(high, 1, 1)) / 2
    down = (np.roll(high, -1, 0) - np.roll(high, 1, 0)) / 2
    normal = np.stack([-across, down, np.ones_like(high)], -1)
    normal /= np.linalg.norm(normal, axis=2, keepdims=True)
    out = io.BytesIO()
    Image.fromarray(np.round(127.5 + 127.5 * normal).astype(np.uint8)).save(out, "PNG", optimize=True)
    return out.getvalue()


# Axes that cloth is wound about: a place, the direction along, and metres of its mean radius.
_UP = np.array([0.0, 1.0, 0.0])
_TRUNK = (np.array([0.0, 1.0, -0.012]), _UP, 0.140)
_ARM = (SHOULDER, ARM, 0.044)
_LEG = (np.array([0.096, 0.5, -0.004]), _UP, 0.070)


def _wound(p: Array, axis: tuple[Array, Array, float], tile: float) -> tuple[Array, float]:
    """Return coordinates `[V, 2]` of points round an axis, and how many tiles a whole turn has. Its seam is
    behind, or under an arm.
    """
    at, along, radius = axis
    ahead = np.array([0.0, 0.0, 1.0])
    side = np.cross(along, ahead)
    q = p - at
    turns = np.round(2 * np.pi * radius / tile)
    way = np.arctan2(q @ side, q @ ahead) / (2 * np.pi)
    return np.stack([way * turns, -(q @ along) / tile], 1), float(turns)


def woven(piece: Piece, grain: str, limbs: str = "") -> Piece:
    """Return cloth with coordinates of its grain. limbs: "arms" or "legs" where parts of it are wound about
    those. Points are doubled at seams.
    """
    tile = TILE[grain]
    p, triangles = piece.positions, piece.triangles
    middle = p[triangles].mean(1)
    side = np.sign(middle[:, 0])
    flip = np.stack([side, np.ones(len(side)), np.ones(len(side))], 1)
    chart = np.zeros(len(triangles), int)
    if limbs == "arms":
        away = middle * flip - SHOULDER
        along = away @ ARM
        beside = np.linalg.norm(away - along[:, None] * ARM, axis=1)
        chart = np.where((along > 0.0) & (beside < 0.080), 1 + (side < 0), 0)
    if limbs == "legs":
        chart = np.where(middle[:, 1] < 0.86, 1 + (side < 0), 0)
    corners, uvs, old = [], [], []
    count = 0
    for number in np.unique(chart):
        axis = _TRUNK if number == 0 else _ARM if limbs == "arms" else _LEG
        own = triangles[chart == number]
        mirror = np.array([-1.0, 1, 1]) if number == 2 else np.ones(3)
        coordinates, turns = _wound(p * mirror, axis, tile)
        if number == 2:
            coordinates = coordinates * [-1, 1]
        place = coordinates[own].copy()  # [N, 3, 2]
        over = place[:, :, 0].max(1, keepdims=True) - place[:, :, 0] > turns / 2
        key = own * 2 + over
        used, first, corner = np.unique(key, return_index=True, return_inverse=True)
        place[:, :, 0] += turns * over
        uvs.append(place.reshape(-1, 2)[first])
        old.append(used // 2)
        corners.append(corner.reshape(-1, 3) + count)
        count += len(used)
    which = np.concatenate(old)
    return Piece(
        p[which],
        piece.normals[which],
        np.concatenate(corners),
        piece.rows[which],
        {n: w[which] for n, w in piece.weights.items()},
        piece.material,
        shade=None if piece.shade is None else piece.shade[which],
        part=piece.part,
        grain=np.concatenate(uvs),
    )
