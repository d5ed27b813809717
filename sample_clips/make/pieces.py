"""Parts of the mannequin that are made ring by ring: eyes, lids, brows, fingers, hems, glasses."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from preview.mesh import turn_profile
from sample_clips.make import mannequin_weights as weights
from sample_clips.make import shapes
from sample_clips.make.face import neck
from sample_clips.make.looks import MATERIALS, ROWS
from sample_clips.make.mannequin_skeleton import ARM
from sample_clips.make.sculpt import Field, gradient

Array = NDArray[Any]


@dataclass(frozen=True, eq=False)
class Piece:
    """Vertices `[V, 3]`, normals, triangles, the row each vertex takes its colour from (between rows: a mix),
    weights by joint.
    """

    positions: Array
    normals: Array
    triangles: Array
    rows: Array
    weights: dict[str, Array]
    material: str = "skin"
    tongue: bool = False
    uvs: Array | None = None  # of an image of its own, not of the rows
    shade: Array | None = None  # what its light is multiplied by
    grain: Array | None = None  # coordinates of a grain, `[V, 2]`
    part: str = ""  # the name of the sculpted part it is

    def mirrored(self) -> Piece:
        flip = np.array([-1.0, 1, 1])
        swap = {("Right" + n[4:] if n.startswith("Left") else n): w for n, w in self.weights.items()}
        return Piece(
            self.positions * flip,
            self.normals * flip,
            self.triangles[:, ::-1],
            self.rows,
            swap,
            self.material,
            uvs=None if self.uvs is None else (1 - self.uvs) * [1, 0] + self.uvs * [0, 1],
            shade=self.shade,
        )


def material_of(row: str) -> str:
    """Return the name of the material of a colour row."""
    return next(name for name, rows, _ in MATERIALS if row in rows)


def rigid(shape: tuple[Array, Array, Array], joint: str, row: str | Array) -> Piece:
    positions, normals, triangles = shape
    corner = positions[triangles]
    away = np.einsum(
        "ij,ij->i",
        np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]),
        normals[triangles].sum(1),
    )
    triangles = np.where(away[:, None] < 0, triangles[:, ::-1], triangles)
    rows = np.full(len(positions), float(ROWS[row])) if isinstance(row, str) else row
    return Piece(
        positions,
        normals,
        triangles,
        rows,
        {joint: np.ones(len(positions))},
        material_of(row) if isinstance(row, str) else "skin",
    )


def tube(path: Array, wide: Array, tall: Array, across: Array, sides: int = 8) -> tuple[Array, Array, Array]:
    """A tapered tube along `path [N, 3]`: half `wide` along `across`, half `tall` along the third direction;
    closed ends.
    """
    along = np.gradient(path, axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    side = across - along * np.einsum("ij,ij->i", across, along)[:, None]
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    up = np.cross(along, side)
    angle = np.arange(sides) * 2 * np.pi / sides
    c, s = np.cos(angle)[None, :, None], np.sin(angle)[None, :, None]
    positions = (
        path[:, None] + side[:, None] * c * wide[:, None, None] + up[:, None] * s * tall[:, None, None]
    )
    normals = (
        side[:, None] * c / np.maximum(wide, 1e-5)[:, None, None]
        + up[:, None] * s / np.maximum(tall, 1e-5)[:, None, None]
    )
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
    i, j = np.meshgrid(np.arange(len(path) - 1), np.arange(sides), indexing="ij")
    a, b = (i * sides + j).ravel(), (i * sides + (j + 1) % sides).ravel()
    triangles = np.concatenate([np.stack([a, b, b + sides], -1), np.stack([a, b + sides, a + sides], -1)])
    return positions.reshape(-1, 3), normals.reshape(-1, 3), triangles


def ring(
    field: Field, origin: Array, axis: Array, profile: list[tuple[float, float]], sides: int, row: str
) -> Piece:
    """A band round a form: `profile` are (height along `axis` from `origin`, distance outside the form),
    metres.

    The form must be star-shaped round the axis. Weights are left empty.
    """
    axis = axis / np.linalg.norm(axis)
    one = np.cross(axis, [0.0, 0, 1]) if abs(axis[2]) < 0.7 else np.cross(axis, [1.0, 0, 0])
    one /= np.linalg.norm(one)
    angle = np.arange(sides) * 2 * np.pi / sides
    out = np.cos(angle)[:, None] * one + np.sin(angle)[:, None] * np.cross(axis, one)
    rings = []
    for height, away in profile:
        base = np.broadcast_to(origin + axis * height, out.shape)
        low, high = np.zeros(sides), np.full(sides, 0.4)
        for _ in range(24):
            middle = (low + high) / 2
            inside = field(base + out * middle[:, None]) < 0
            low, high = np.where(inside, middle, low), np.where(inside, high, middle)
        rings.append(base + out * (low + away)[:, None])
    positions = np.stack(rings)
    around = np.roll(positions, -1, 1) - np.roll(positions, 1, 1)
    along = np.gradient(positions, axis=0)
    normals = np.cross(around, along).reshape(-1, 3)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    if np.einsum("ij,ij->i", normals, np.tile(out, (len(profile), 1))).mean() < 0:
        normals = -normals
    i, j = np.meshgrid(np.arange(len(profile) - 1), np.arange(sides), indexing="ij")
    a, b = (i * sides + j).ravel(), (i * sides + (j + 1) % sides).ravel()
    triangles = np.concatenate([np.stack([a, b, b + sides], -1), np.stack([a, b + sides, a + sides], -1)])
    return rigid((positions.reshape(-1, 3), normals, triangles), "Hips", row)


def hem() -> Piece:
    profile = [(0.040, -0.0040), (0.038, 0.0014), (0.010, 0.0016), (0.0, 0.0), (0.002, -0.010)]
    made = ring(
        shapes.torso(), np.array([0, shapes.HEM - 0.004, 0.0]), np.array([0.0, 1, 0]), profile, 64, "band"
    )
    shade = ribs(len(profile), 64)
    return replace(made, weights=weights.sweater_weights(made.positions), shade=shade)


def cuff(sleeve: float = 0.0) -> Piece:
    """The band at the end of the left sleeve, `sleeve` metres above the wrist."""
    profile = [(-0.0340, -0.003), (-0.0320, 0.0014), (-0.005, 0.0012), (0.0, -0.0006), (-0.004, -0.010)]
    rod = shapes.forearm()
    band = ring(rod, shapes.CUFF + ARM * (0.002 - sleeve), ARM, profile, 36, "band")
    return replace(band, weights=weights.arm(band.positions), shade=ribs(len(profile), 36))


def sole() -> Piece:
    profile = [
        (0.0, -0.006),
        (0.001, 0.0012),
        (0.004, 0.0030),
        (0.0170, 0.0034),
        (0.0200, 0.0010),
        (0.0200, -0.006),
    ]
    made = ring(shapes.sole_outline, np.array([0.1055, 0, 0.045]), np.array([0.0, 1, 0]), profile, 34, "sole")
    return replace(made, weights=weights.shoe_weights(made.positions))


def laces() -> list[Piece]:
    """Four laces across the left shoe."""
    shoe = shapes.shoe()
    out = []
    for ahead in (0.022, 0.042, 0.062, 0.082):
        x = np.linspace(-0.019, 0.019, 5)
        path = np.stack([0.103 + x, np.full(5, 0.12), np.full(5, ahead) - 0.004 * np.abs(x) / 0.019], 1)
        for _ in range(12):
            path[:, 1] -= shoe(path)
        full = np.full(5, 0.0026)
        made = rigid(
            tube(path + [0, 0.0006, 0], full, full * 0.7, np.tile([0.0, 0, 1], (5, 1)), 4), "LeftFoot", "sole"
        )
        out.append(replace(made, weights=weights.shoe_weights(made.positions)))
    return out


def finger(name: str) -> Piece:
    """A tube that begins inside the palm; its normals are those of the whole hand, so that no seam shows."""
    points = shapes.finger_points(name)
    axis = (points[3] - points[0]) / np.linalg.norm(points[3] - points[0])
    one, two, tip = (float((q - points[0]) @ axis) for q in points[1:])
    end = shapes.finger_radius(name)
    heights = [-0.004, 0.5 * one, one - 0.0065, one + 0.0055, two - 0.0060, two + 0.0055]
    heights += [tip + end * h for h in (0.0, 0.55, 0.86, 0.995)]
    made = ring(shapes.finger(name), points[0], axis, [(h, 0.0) for h in heights], 8, "skin")
    return replace(
        made,
        normals=gradient(shapes.hand(), made.positions),
        weights=weights.hand_weights(made.positions, (name,)),
    )


def ribs(count: int, columns: int) -> Array:
    """Return how light the ribs of a knitted band are, `[columns * count]`: of each column in each ring."""
    return np.tile(np.where(np.arange(columns) % 2 == 0, 1.0, 0.80), count)


def collar() -> Piece:
    """The band of a sweater round the neck."""
    profile = [(-0.016, 0.0030), (-0.010, 0.0085), (0.004, 0.0080), (0.0105, 0.0050), (0.0100, -0.0030)]
    made = ring(neck(), shapes.COLLAR_AT, shapes.COLLAR_UP, profile, 44, "band")
    return replace(made, weights=weights.spine(made.positions), shade=ribs(len(profile), 44))


def glasses() -> list[Piece]:
    """Frames on the nose, a rim round each eye, and temples to the ears."""
    angle = np.linspace(0, 2 * np.pi, 25)
    out = []
    for side in (1.0, -1.0):
        rim = np.stack(
            [
                side * (0.0325 + 0.0245 * np.cos(angle)),
                1.6005 + 0.0190 * np.sin(angle),
                0.0990 - 0.0060 * ((0.0325 + 0.0245 * np.cos(angle)) / 0.057) ** 2,
            ],
            1,
        )
        out.append(wire(rim, 0.0017))
        out.append(
            wire(
                [
                    (side * 0.0565, 1.6045, 0.0935),
                    (side * 0.0785, 1.6050, 0.045),
                    (side * 0.0830, 1.6020, -0.010),
                ],
                0.0015,
            )
        )
    out.append(wire([(-0.0085, 1.6050, 0.0990), (0, 1.6072, 0.1010), (0.0085, 1.6050, 0.0990)], 0.0015))
    return out


def wire(path: Array | Sequence[tuple[float, float, float]], radius: float) -> Piece:
    """A thin round tube along a path, carried by the head."""
    points = np.asarray(path, float)
    full = np.full(len(points), radius)
    return rigid(tube(points, full, full, np.tile([0.13, 0.31, 0.94], (len(points), 1)), 5), "Head", "frame")


def earring() -> Piece:
    """A stud in the left ear."""
    angle = np.linspace(-np.pi / 2, np.pi / 2, 6)
    positions, normals, triangles = turn_profile(
        [(0.0036 * np.cos(a), 0.0036 * np.sin(a)) for a in angle], 10
    )
    return rigid((positions + [0.0800, 1.5755, -0.010], normals, triangles), "Head", "metal")
