"""Pieces of a face that are made ring by ring: eyeballs, lids with lashes, brows, lips, and the inside of the
mouth.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from preview.mesh import turn_profile
from sample_clips.make import mannequin_weights as weights
from sample_clips.make import openings, shapes
from sample_clips.make.looks import ROWS, Look
from sample_clips.make.pieces import Piece, rigid, tube
from sample_clips.make.sculpt import Field, gradient
from sample_clips.make.shapes import EYE_RADIUS, JOINT, MOUTH_Y

Array = NDArray[Any]

EYE_SEEN = 105.0  # degrees from the eye's axis that the edge of its image is at
IRIS, PUPIL = 30.0, 12.5  # degrees from the eye's axis
_CORNEA = 0.0009  # metres it stands out of the ball
_RIM = 0.55  # how far the rim of a lid is from skin to lip


def lid_heights(look: Look) -> tuple[float, float]:
    """Return the elevations in degrees at which a look's lids rest."""
    return openings.UPPER_LID_OPEN - look.lids, openings.LOWER_LID_OPEN


def skin_rows(p: Array) -> Array:
    """Return the rows of skin `[V]`: redder on cheeks, nose, chin and ears, dark in the nostrils."""

    def spot(at: tuple[float, float, float], reach: float) -> Array:
        q = np.stack([np.abs(p[:, 0]), p[:, 1], p[:, 2]], 1)
        return np.exp(-(np.linalg.norm(q - np.array(at), axis=1) ** 2) / reach**2)

    blush = 0.62 * spot((0.0430, 1.5700, 0.0560), 0.021) + 0.6 * spot((0.0, 1.5740, 0.1050), 0.012)
    blush += 0.8 * spot((0.0800, 1.5975, -0.013), 0.018) + 0.3 * spot((0.0, 1.5080, 0.0860), 0.012)
    nostril = spot((0.0068, 1.5660, 0.0925), 0.0040)
    return np.asarray(ROWS["skin"] - np.clip(blush, 0, 1) * (1 - nostril) + 1.6 * nostril)


def eye() -> Piece:
    """The left eyeball with its cornea. `uvs` are of its own image: see `iris`."""
    degrees = np.array([98.0, 78.0, 60.0, 46.0, 36.0, 30.0, 23.0, 14.0, 6.0, 0.0])
    out = EYE_RADIUS + _CORNEA * np.cos(np.radians(np.clip(degrees / 34.0, 0, 1) * 90.0))
    a = np.radians(degrees)
    profile = [(r * np.cos(x), r * np.sin(x) if x > 0 else 0.0) for r, x in zip(out, a, strict=True)]
    positions, normals, triangles = turn_profile(profile, 18)
    positions, normals = (v[:, [0, 2, 1]] * [1, -1, 1] for v in (positions, normals))
    away = np.arctan2(np.hypot(positions[:, 0], positions[:, 1]), positions[:, 2])
    across = positions[:, :2] / np.maximum(np.hypot(positions[:, 0], positions[:, 1]), 1e-9)[:, None]
    uvs = 0.5 + across * [1, -1] * (np.degrees(away) / EYE_SEEN / 2)[:, None]
    made = rigid((positions + JOINT["LeftEye"], normals, triangles), "LeftEye", "white")
    return replace(made, material="eyeball", uvs=uvs)


def lids(face: Field, look: Look) -> list[Piece]:
    """The left eye's lids, the skin about them, and the upper lashes."""
    open_ = lid_heights(look)
    patch = openings.lids(face, open_)
    share = openings.lid_shares(patch, open_)
    rows = skin_rows(patch.positions.reshape(-1, 3)).reshape(patch.away.shape)
    rows[0] += _RIM
    rows[1] += 0.35 * _RIM
    upper = np.broadcast_to(patch.upper, share.shape)
    held = {
        "LeftUpperLid": np.where(upper, share, 0.0).ravel(),
        "LeftLowerLid": np.where(upper, 0.0, share).ravel(),
        "Head": 1 - share.ravel(),
    }
    flat = (patch.positions.reshape(-1, 3), patch.normals.reshape(-1, 3), patch.triangles)
    lid = Piece(*flat, rows.ravel(), held)
    return [lid, _lashes(patch, share, look)]


def _lashes(patch: openings.Patch, share: Array, look: Look) -> Piece:
    """A line along the upper rim that grows into lashes towards the outer corner."""
    count = int(patch.upper.sum())
    inner, outside = patch.positions[0, :count], patch.positions[1, :count]
    t = np.linspace(0, 1, count)
    long = look.lashes * np.sin(np.pi * np.clip(0.06 + 0.86 * t, 0, 1)) ** 0.7 * (0.45 + 0.75 * t)
    many = 4 if look.lashes > 0.002 else 2
    fine = np.linspace(0, count - 1, many * (count - 1) + 1)

    def between(values: Array) -> Array:
        values = values.reshape(count, -1)
        return np.stack([np.interp(fine, np.arange(count), v) for v in values.T], 1)

    rim, over, length = between(0.75 * inner + 0.25 * outside), between(outside), between(long)
    ball = over - JOINT["LeftEye"]
    ball = ball / np.linalg.norm(ball, axis=1, keepdims=True)
    rising = np.stack([np.zeros(len(fine)), ball[:, 2], -ball[:, 1]], 1)  # along the lid, away from the rim
    way = rising + 0.70 * ball  # steeper, they would be seen edge on from in front
    way[:, 0] += 0.55 * (np.linspace(0, 1, len(fine)) - 0.35)
    way /= np.linalg.norm(way, axis=1, keepdims=True)
    tooth = np.where(np.arange(len(fine)) % 4 == 2, 1.0, np.where(np.arange(len(fine)) % 2 == 1, 0.62, 0.34))
    tip = over + way * (length * tooth[:, None]) + [0, 0.0, 0.0004]
    lift = np.array([0, 0.0007, 0.0007])
    strip = np.stack([rim + lift * 0.3, over + lift, tip])
    rows, columns = strip.shape[:2]
    i, j = np.meshgrid(np.arange(rows - 1), np.arange(columns - 1), indexing="ij")
    a = (i * columns + j).ravel()
    held = np.tile(np.interp(fine, np.arange(count), share[0, :count]), rows)
    return Piece(
        strip.reshape(-1, 3),
        np.tile(np.array([0.0, -0.6, 0.8]), (rows * columns, 1)),
        np.concatenate(
            [np.stack([a, a + 1, a + columns + 1], -1), np.stack([a, a + columns + 1, a + columns], -1)]
        ),
        np.full(rows * columns, float(ROWS["lash"])),
        {"LeftUpperLid": held, "Head": 1 - held},
        "hair",
    )


def brow(face: Field, full: float = 1.0) -> Piece:
    """The left brow on the face: full at its inner end, arched, and thin outside. full: of its thickness."""
    t = np.linspace(0, 1, 12)
    x = 0.0125 + 0.0415 * t
    y = 1.6290 + 0.0062 * np.sin(np.pi * np.clip(0.06 + 0.76 * t, 0, 1)) - 0.0050 * t**2
    path = np.stack([x, y, np.full(12, 0.085)], 1)
    path[:, 2] = openings.front(face, path[:, :2])
    normal = gradient(face, path)
    thick = full * np.interp(t, [0, 0.04, 0.14, 0.5, 0.8, 1.0], [0.15, 0.72, 1.0, 0.86, 0.5, 0.08])
    made = tube(
        path + normal * 0.0001,
        0.0034 * thick + 1e-5,
        0.0010 * thick**0.5 + 1e-5,
        np.cross(normal, np.gradient(path, axis=0)),
        5,
    )
    return rigid(made, "LeftBrow", "hair")


def lips(face: Field, look: Look) -> Piece:
    """Lips, closed, and what is seen just inside them."""
    patch = openings.mouth(face, look.build.lips)
    rows = np.full(patch.away.shape, float(ROWS["lip"]))
    rows[:2] = ROWS["mouth"]
    rows[2] = 0.5 * (ROWS["lip"] + ROWS["mouth"])
    rows[6] = 0.25 * ROWS["skin"] + 0.75 * ROWS["lip"]
    rows[7] = 0.75 * ROWS["skin"] + 0.25 * ROWS["lip"]
    rows[8:] = skin_rows(patch.positions[8:].reshape(-1, 3)).reshape(rows[8:].shape)
    ends = np.abs(patch.positions[2, :, 0]) > 0.92 * shapes.MOUTH_HALF
    rows[3:7, ends] = 0.5 * (ROWS["skin"] + ROWS["lip"])
    lower = np.broadcast_to(~patch.upper, rows.shape).ravel()
    flat = patch.positions.reshape(-1, 3)
    held = weights.head_weights(flat, lower.astype(float), np.tile(patch.positions[2, :, 0], len(rows)))
    return Piece(flat, patch.normals.reshape(-1, 3), patch.triangles, rows.ravel(), held)


def mouth_inside() -> Piece:
    """The dark inside of the mouth, seen from within."""
    around, along = np.linspace(0, 2 * np.pi, 15)[:-1], np.linspace(0, np.pi, 8)
    a, b = np.meshgrid(along, around, indexing="ij")
    ball = np.stack([np.sin(a) * np.cos(b), np.sin(a) * np.sin(b), np.cos(a)], -1).reshape(-1, 3)
    positions = ball * [0.0255, 0.0150, 0.0310] + [0.0, MOUTH_Y + 0.0005, 0.0540]
    i, j = np.meshgrid(np.arange(len(along) - 1), np.arange(len(around)), indexing="ij")
    first, beside = (i * 14 + j).ravel(), (i * 14 + (j + 1) % 14).ravel()
    triangles = np.concatenate(
        [np.stack([first, beside, beside + 14], -1), np.stack([first, beside + 14, first + 14], -1)]
    )
    open_ = positions[triangles][:, :, 2].mean(1) > 0.0800
    used, triangles = np.unique(triangles[~open_], return_inverse=True)
    positions, ball = positions[used], ball[used]
    jaw = shapes.step(0.004, -0.004, positions[:, 1] - MOUTH_Y)
    rows = np.full(len(positions), float(ROWS["mouth"]))
    return Piece(positions, -ball, triangles.reshape(-1, 3), rows, {"Head": 1 - jaw, "Jaw": jaw})


def teeth(upper: bool) -> Piece:
    """A row of teeth: an arch with a groove between each two."""
    columns, cut = 25, np.linspace(-1, 1, 25)
    angle = cut * 1.15
    x, z = 0.0185 * np.sin(angle), 0.0818 - 0.0250 * (1 - np.cos(angle))
    groove = np.where(np.arange(columns) % 2 == 0, 0.0007, 0.0)
    out = np.stack([np.sin(angle), np.zeros(columns), np.cos(angle)], 1)
    sign = 1.0 if upper else -1.0
    base = MOUTH_Y + (0.0042 if upper else -0.0062)
    tall = (0.0088 if upper else 0.0070) - 0.0016 * np.abs(cut) - groove * 0.8
    back = 0.0 if upper else 0.0022
    line = np.stack([x, np.full(columns, base), z - back], 1) - out * groove[:, None]
    rows = [
        line + np.stack([np.zeros(columns), sign * 0.0015 + 0 * tall, np.zeros(columns)], 1) - out * 0.0012,
        line,
        line + np.stack([0 * tall, -sign * 0.6 * tall, 0 * tall], 1) + out * 0.0003,
        line + np.stack([0 * tall, -sign * tall, 0 * tall], 1) - out * 0.0008,
        line + np.stack([0 * tall, -sign * 0.9 * tall, 0 * tall], 1) - out * 0.0040,
    ]
    positions = np.stack(rows).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(len(rows) - 1), np.arange(columns - 1), indexing="ij")
    a = (i * columns + j).ravel()
    triangles = np.concatenate(
        [np.stack([a, a + 1, a + columns + 1], -1), np.stack([a, a + columns + 1, a + columns], -1)]
    )
    normals = np.tile(out, (len(rows), 1))
    normals[-2 * columns :, 1] -= sign
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return rigid((positions, normals, triangles), "Head" if upper else "Jaw", "teeth")


def tongue() -> Piece:
    """Flat on the floor of the mouth, behind the lips while they are shut."""
    around, along = np.linspace(0, 2 * np.pi, 13)[:-1], np.linspace(0, np.pi, 9)
    a, b = np.meshgrid(along, around, indexing="ij")
    ball = np.stack([np.sin(a) * np.cos(b), np.sin(a) * np.sin(b), np.cos(a)], -1).reshape(-1, 3)
    radii = np.array([0.0125, 0.0030, 0.0150])
    i, j = np.meshgrid(np.arange(len(along) - 1), np.arange(len(around)), indexing="ij")
    first, beside = (i * 12 + j).ravel(), (i * 12 + (j + 1) % 12).ravel()
    triangles = np.concatenate(
        [np.stack([first, beside, beside + 12], -1), np.stack([first, beside + 12, first + 12], -1)]
    )
    normals = ball / radii
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    made = rigid((ball * radii + [0.0, 1.5382, 0.0620], normals, triangles), "Jaw", "lip")
    return replace(made, tongue=True)
