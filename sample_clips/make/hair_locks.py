"""Hair in locks: strips along paths over the head, arched across, that lie over one another in layers.

Every number that varies from lock to lock comes from `_spread`, so that the same hair grows every time.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sample_clips.make.looks import ROWS, Look
from sample_clips.make.mannequin_weights import head_weights
from sample_clips.make.pieces import Piece
from sample_clips.make.sculpt import Field, gradient, project

Array = NDArray[Any]

MIDDLE = np.array([0.0, 1.6360, -0.0130])  # of the hair
_ACROSS = np.array([-1.0, -0.55, 0.0, 0.55, 1.0])  # of a lock's points, shares of half its width
_ARCH = np.array([-0.55, 0.62, 1.0, 0.62, -0.55])  # and how far out, of its height
_DARK = np.array([0.56, 0.90, 1.08, 0.90, 0.56])  # and how light
_SOFT = np.array([0.84, 0.96, 1.04, 0.96, 0.84])  # the same of tufts


def _spread(n: float, k: float = 0.0) -> float:
    """Return a number 0..1 for the n-th thing, unlike its neighbours' (the golden ratio's multiples)."""
    return float((n * 0.6180339887 + k * 0.7548776662) % 1.0)


def lock(
    path: Array,
    outward: Array,
    width: Array,
    high: Array,
    shade: Array,
    row: str = "hair",
    across: Array = _DARK,
) -> Piece:
    """Return a strip along `path [N, 3]`, arched towards `outward [N, 3]`. width: half of it `[N]`, high: of
    the arch `[N]`, metres. shade: how light it is along `[N]`, 1 as the hair.
    """
    along = np.gradient(path, axis=0)
    along /= np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-9)
    side = np.cross(outward, along)
    side /= np.maximum(np.linalg.norm(side, axis=1, keepdims=True), 1e-9)
    up = np.cross(along, side)
    wide, tall = width[:, None] * _ACROSS, high[:, None] * _ARCH
    positions = path[:, None] + side[:, None] * wide[..., None] + up[:, None] * tall[..., None]
    lean = np.clip(_ACROSS * np.abs(_ACROSS) ** 0.3, -1, 1)
    normals = (
        up[:, None] * (1 - 0.35 * np.abs(lean))[None, :, None] + side[:, None] * (0.85 * lean)[None, :, None]
    )
    normals /= np.linalg.norm(normals, axis=2, keepdims=True)
    count = len(_ACROSS)
    i, j = np.meshgrid(np.arange(len(path) - 1), np.arange(count - 1), indexing="ij")
    a = (i * count + j).ravel()
    b, c, d = a + 1, a + count, a + count + 1
    triangles = np.concatenate([np.stack([a, d, b], -1), np.stack([a, c, d], -1)])
    flat = positions.reshape(-1, 3)
    facing = np.cross(
        flat[triangles[0, 1]] - flat[triangles[0, 0]], flat[triangles[0, 2]] - flat[triangles[0, 0]]
    )
    if facing @ up[0] < 0:
        triangles = triangles[:, ::-1]
    return Piece(
        flat,
        normals.reshape(-1, 3),
        triangles,
        np.full(len(flat), float(ROWS[row])),
        {"Head": np.ones(len(flat))},
        "hair",
        shade=(shade[:, None] * across).ravel(),
    )


def joined(parts: list[Piece]) -> Piece:
    """Return pieces of one material as one."""
    starts = np.cumsum([0] + [len(p.positions) for p in parts])
    joints = sorted({n for p in parts for n in p.weights})
    zero = [np.zeros(len(p.positions)) for p in parts]
    return Piece(
        np.concatenate([p.positions for p in parts]),
        np.concatenate([p.normals for p in parts]),
        np.concatenate([p.triangles + s for p, s in zip(parts, starts, strict=False)]),
        np.concatenate([p.rows for p in parts]),
        {n: np.concatenate([p.weights.get(n, z) for p, z in zip(parts, zero, strict=True)]) for n in joints},
        parts[0].material,
        shade=np.concatenate(
            [z + 1 if p.shade is None else p.shade for p, z in zip(parts, zero, strict=True)]
        ),
    )


# --- a bob with a parting

_CROWN = np.array([0.0935, 0.1045, 0.1090])  # half the hair's size, metres
_PART_X = 0.0210


def _start(u: float) -> Array:
    """Return a direction along the parting, 0 at the forehead, 1 at the crown, from the hair's middle."""
    z = 0.0930 - 0.1400 * u
    x = _PART_X * (1 - 0.35 * u)
    y = np.sqrt(max(0.0, 1 - (x / _CROWN[0]) ** 2 - (z / _CROWN[2]) ** 2))
    return np.array([x / _CROWN[0], y, z / _CROWN[2]])


def _fall(
    u: float, way: float, out: float, low: float, lift: float, curl: float, phase: float
) -> tuple[Array, Array]:
    """Return the path `[N, 3]` of a lock and its outward directions. u: where on the parting it begins; way:
    degrees from the front that it falls at, to the left if plus; out: metres beyond the crown; low: height of
    its end; lift: metres that its root rises; curl: metres its end turns in.
    """
    first = _start(u)
    end = np.array([np.sin(np.radians(way)), -0.05, np.cos(np.radians(way))])
    cosine = np.clip(first @ end / np.linalg.norm(end), -1, 1)
    whole = np.arccos(cosine)
    points, outs = [], []
    for t in np.linspace(0, 1, 6):
        d = (np.sin((1 - t) * whole) * first + np.sin(t * whole) * end) / np.sin(whole)
        d = d / np.linalg.norm(d)
        size = _CROWN + out - 0.0020 * (t == 0) + lift * np.exp(-(((t - 0.24) / 0.22) ** 2))
        points.append(MIDDLE + d * size)
        outs.append(d / size / np.linalg.norm(d / size))
    last, flat = points[-1], np.array([end[0], 0.0, end[2]])
    for t in np.linspace(0, 1, 5)[1:]:
        y = last[1] + (low - last[1]) * t
        wave = 0.0030 * np.sin(2 * np.pi * (0.9 * t + phase))
        inwards = -0.010 * t - curl * t**3 + wave + 0.006 * np.sin(np.pi * t)
        points.append(np.array([last[0], y, last[2]]) + flat * inwards + [0, 0, 0.004 * t])
        outs.append(flat + [0, 0.25 * t**2, 0])
    return np.array(points), np.array(outs)


def bob(_skin: Field) -> list[Piece]:
    """To the jaw, parted on the left, swept over the forehead, its ends uneven and turned in."""
    made: list[Piece] = []
    n = 0
    for out, every, wide, shade in ((0.0006, 19, 0.0150, 0.98), (0.0032, 2, 0.0056, 1.12)):
        for side in (1.0, -1.0):
            for k in range(every):
                n += 1
                t = (k + 0.5 + 0.5 * (_spread(n) - 0.5)) / every
                u = np.clip(1.08 * t**0.85 + 0.06 * (_spread(n, 1) - 0.5), 0.0, 1.0)
                way = side * (64.0 + (184.0 - 64.0) * t**0.95)
                low = 1.5080 - 0.010 * (1 - t) + 0.022 * (_spread(n, 2) - 0.5)
                lift = (0.0034 if side < 0 else 0.0028) * (1 - 0.6 * t) + 0.001 * (_spread(n, 3) - 0.5)
                curl = 0.014 + 0.010 * _spread(n, 4)
                path, outs = _fall(
                    u, way, out + 0.0012 * (_spread(n, 5) - 0.5), low, lift, curl, _spread(n, 6)
                )
                along = np.linspace(0, 1, len(path))
                width = wide * np.interp(along, [0, 0.12, 0.45, 0.8, 1.0], [0.28, 0.85, 1.15, 1.05, 0.22])
                width *= 0.8 + 0.4 * _spread(n, 7)
                high = 0.30 * width
                light = (
                    shade
                    * (0.88 + 0.24 * _spread(n, 8))
                    * np.interp(along, [0, 0.1, 0.4, 1.0], [0.62, 0.86, 1.06, 0.98])
                )
                made.append(lock(path, outs, width, high, light))
    return [joined(made)]


# --- short hair and a beard, in tufts


def _tufts(form: Field, starts: Array, ways: Array, sizes: Array, row: str) -> Piece:
    """Return short locks that lie on a form. starts, ways `[T, 3]`: near where each grows, and which way.
    sizes `[T, 4]`: length, metres its middle stands off, half its width, and how light it is.
    """
    at, ways = project(form, starts, 10), ways.astype(float)
    points, outs = [], []
    for off in (0.2, 0.8, 1.0, 0.6):
        at = project(form, at)
        normal = gradient(form, at)
        ways = ways - normal * np.einsum("ij,ij->i", ways, normal)[:, None]
        ways /= np.linalg.norm(ways, axis=1, keepdims=True)
        points.append(at + normal * off * sizes[:, 1:2])
        outs.append(normal)
        at = at + ways * sizes[:, :1] / 3
        ways = ways + [0, -0.12, 0]
    made = []
    for path, outward, (_, _, wide, shade) in zip(np.stack(points, 1), np.stack(outs, 1), sizes, strict=True):
        width = wide * np.array([0.5, 1.0, 0.8, 0.06])
        light = shade * np.array([0.82, 0.94, 1.04, 1.08])
        made.append(lock(path, outward, width, 0.20 * width, light, row, _SOFT))
    return joined(made)


def receding(skin: Field) -> list[Piece]:
    """Short, on the sides and the back of the head alone."""
    starts, ways, sizes = [], [], []
    rings = (  # height, how many tufts, and degrees from the front at which they begin
        (1.676, 9, 128.0),
        (1.662, 14, 112.0),
        (1.647, 18, 92.0),
        (1.632, 20, 80.0),
        (1.616, 19, 82.0),
        (1.600, 16, 106.0),
    )
    for level, (y, count, far) in enumerate(rings):
        for k in range(count):
            n = len(starts) + 1
            way = far + (360 - 2 * far) * (k + 0.5 * (level % 2) + 0.3 * (_spread(n) - 0.5)) / (count - 0.5)
            c, s = np.cos(np.radians(way)), np.sin(np.radians(way))
            starts.append((0.078 * s, y + 0.006 * (_spread(n, 1) - 0.5), -0.012 + 0.092 * c))
            ways.append((-0.25 * s, -0.75, -0.9 * max(0.0, c + 0.45)))
            sizes.append(
                (
                    0.040 + 0.012 * _spread(n, 2),
                    0.0040 + 0.0016 * _spread(n, 3),
                    0.0066 + 0.003 * _spread(n, 4),
                    0.82 + 0.34 * _spread(n, 5),
                )
            )
    return [_tufts(skin, np.array(starts), np.array(ways), np.array(sizes), "hair")]


def beard(skin: Field) -> list[Piece]:
    """Short tufts over jaw, chin and upper lip."""
    places: list[tuple[float, float, float, float]] = []  # across, height, length, how far it leans outwards
    for i, x in enumerate(np.linspace(0.0, 0.0600, 12)):
        top = np.interp(
            x, [0, 0.020, 0.030, 0.044, 0.052, 0.060], [1.5270, 1.5290, 1.5440, 1.5540, 1.5660, 1.5860]
        )
        low = np.interp(x, [0, 0.020, 0.044, 0.060], [1.5010, 1.5040, 1.5200, 1.5440])
        for j, y in enumerate(np.linspace(low, top, 4)):
            places.append((x, y + 0.003 * ((i + j) % 2), 0.0180, 0.25 * x / 0.05))
    for x in np.linspace(0.002, 0.0280, 9):
        places.append((x, float(np.interp(x, [0, 0.012, 0.028], [1.5595, 1.5585, 1.5490])), 0.0135, 0.9))
    starts, ways, sizes = [], [], []
    for x, y, length, lean in places:
        for side in (1.0, -1.0) if x > 0.001 else (1.0,):
            n = len(starts) + 1
            starts.append((side * x, y, 0.085 - 1.2 * max(0.0, x - 0.018)))
            ways.append((side * lean, -1.0, 0.10))
            sizes.append(
                (
                    length * (0.9 + 0.3 * _spread(n, 1)),
                    0.0028 + 0.0014 * _spread(n, 2),
                    0.0043 + 0.0014 * _spread(n, 3),
                    0.80 + 0.36 * _spread(n, 4),
                )
            )
    made = _tufts(skin, np.array(starts), np.array(ways), np.array(sizes), "beard")
    return [replace(made, weights=head_weights(made.positions))]


HAIRS = {"bob": bob, "receding": receding}


def hair_locks(look: Look, skin: Field) -> list[Piece]:
    """Return the locks of a look's hair and beard on a form of the head."""
    make = HAIRS.get(look.hair)
    return [*([] if make is None else make(skin)), *(beard(skin) if look.beard else [])]
