"""Parts of the mannequin that are made ring by ring: eyes, lids, brows, fingers, hems, glasses."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from preview.mesh import lathe
from sample_clips.make import mannequin_weights as weights
from sample_clips.make import shapes
from sample_clips.make.looks import MATERIALS, ROWS
from sample_clips.make.mannequin_skeleton import ARM
from sample_clips.make.sculpt import Field, gradient
from sample_clips.make.shapes import EYE_RADIUS, JOINT, LID_RADIUS

Array = NDArray[Any]

UPPER_LID_OPEN, LOWER_LID_OPEN = 26.0, -28.0  # degrees above the eye's axis at which the lids' edges rest


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


def eye() -> list[Piece]:
    """The left eyeball looking along +Z; each colour has its own triangles, so that the iris has a crisp
    edge.
    """
    out = []
    for row, first, last, rings in (
        ("pupil", 0.0, 13.5, 2),
        ("iris", 13.5, 30.0, 2),
        ("white", 30.0, 80.0, 4),
    ):
        angles = np.radians(np.linspace(last, first, rings + 1))
        profile = [(EYE_RADIUS * np.cos(a), EYE_RADIUS * np.sin(a) if a > 0 else 0.0) for a in angles]
        positions, _, triangles = lathe(profile, 18)
        positions = positions[:, [0, 2, 1]] * [1, -1, 1]
        normals = positions / EYE_RADIUS
        out.append(rigid((positions + JOINT["LeftEye"], normals, triangles), "LeftEye", row))
    return out


def lid(joint: str, edge: float, back: float) -> Piece:
    """A shell round the eye between the angles `edge` and `back` (degrees up from forwards, about X), with a
    dark rim.
    """
    along = np.radians(np.linspace(4, 176, 12))  # from corner to corner
    turn = np.radians(
        np.concatenate([[edge, edge, edge + 0.04 * (back - edge)], np.linspace(edge, back, 6)[1:]])
    )
    radius = np.concatenate([[EYE_RADIUS + 0.0001, LID_RADIUS + 0.0001], np.full(len(turn) - 2, LID_RADIUS)])
    shape = np.stack(
        [
            np.broadcast_to(np.cos(along)[None], (len(turn), len(along))),
            np.sin(turn)[:, None] * np.sin(along)[None],
            np.cos(turn)[:, None] * np.sin(along)[None],
        ],
        -1,
    )
    normals = shape.reshape(-1, 3).copy()
    rim = np.sign(edge) * np.stack([0 * along, -np.cos(turn[0]) + 0 * along, np.sin(turn[0]) + 0 * along], -1)
    normals[: len(along)] = rim
    i, j = np.meshgrid(np.arange(len(turn) - 1), np.arange(len(along) - 1), indexing="ij")
    a = (i * len(along) + j).ravel()
    b, c, d = a + 1, a + len(along), a + len(along) + 1
    triangles = np.concatenate([np.stack([a, b, d], -1), np.stack([a, d, c], -1)])
    rows = np.full((len(turn), len(along)), float(ROWS["skin"]))
    rows[:2] = ROWS["lash"] if edge > 0 else ROWS["lip"]
    positions = (shape * radius[:, None, None]).reshape(-1, 3) + JOINT["LeftEye"]
    # Rows melt only between neighbours: the rim has vertices of its own.
    return rigid((positions, normals, triangles), joint, rows.ravel())


def split_rows(piece: Piece) -> Piece:
    """Give triangles whose corners have rows far apart corners of their own, in the row nearest the rim."""
    corner = piece.rows[piece.triangles]
    far = np.flatnonzero(np.ptp(corner, axis=1) > 2.5)
    if not len(far):
        return piece
    extra = piece.triangles[far].ravel()
    positions, normals = (
        np.concatenate([piece.positions, piece.positions[extra]]),
        np.concatenate([piece.normals, piece.normals[extra]]),
    )
    rows = np.concatenate([piece.rows, np.repeat(corner[far].max(1), 3)])
    triangles = piece.triangles.copy()
    triangles[far] = len(piece.positions) + np.arange(len(extra)).reshape(-1, 3)
    return Piece(
        positions,
        normals,
        triangles,
        rows,
        {n: np.concatenate([w, w[extra]]) for n, w in piece.weights.items()},
        piece.material,
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


def brow(face: Field, full: float = 1.0) -> Piece:
    """The left brow on the face; full: scale of its thickness."""
    t = np.linspace(0, 1, 11)
    path = np.stack(
        [0.0145 + 0.0365 * t, 1.6278 + 0.0068 * np.sin(np.pi * (0.13 + 0.74 * t)), np.full(11, 0.085)], 1
    )
    for _ in range(8):  # onto the face, straight back
        path[:, 2] -= face(path)
    normal = gradient(face, path)
    thick = full * np.sin(np.pi * np.clip(0.10 + 0.90 * t, 0, 1)) ** 0.6
    return rigid(
        tube(
            path + normal * 0.0002,
            0.0030 * thick + 1e-5,
            0.0016 * thick + 1e-5,
            np.cross(normal, np.gradient(path, axis=0)),
        ),
        "LeftBrow",
        "hair",
    )


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
    profile = [
        (0.034, -0.0030),
        (0.0335, 0.0018),
        (0.030, 0.0028),
        (0.004, 0.0030),
        (0.0, 0.0016),
        (-0.0005, -0.004),
        (0.004, -0.012),
    ]
    made = ring(
        shapes.torso(), np.array([0, shapes.HEM - 0.004, 0.0]), np.array([0.0, 1, 0]), profile, 40, "band"
    )
    return replace(made, weights=weights.sweater_weights(made.positions))


def cuff(sleeve: float = 0.0) -> Piece:
    """The band at the end of the left sleeve, `sleeve` metres above the wrist."""
    profile = [
        (-0.0305, -0.003),
        (-0.030, 0.0014),
        (-0.027, 0.0022),
        (-0.004, 0.0022),
        (0.0, 0.0010),
        (0.0005, -0.004),
        (-0.004, -0.010),
    ]
    rod = shapes.forearm()
    band = ring(rod, shapes.CUFF + ARM * (0.002 - sleeve), ARM, profile, 18, "band")
    return replace(band, weights=weights.arm(band.positions))


def sole() -> Piece:
    profile = [
        (0.000, -0.006),
        (0.0, 0.0),
        (0.003, 0.0030),
        (0.015, 0.0036),
        (0.0185, 0.0028),
        (0.0195, 0.0005),
        (0.0195, -0.006),
    ]
    made = ring(shapes.sole_outline, np.array([0.1055, 0, 0.045]), np.array([0.0, 1, 0]), profile, 40, "sole")
    return replace(made, weights=weights.shoe_weights(made.positions))


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


def collar() -> Piece:
    angle = np.linspace(0, 2 * np.pi, 29)
    at, up = shapes.COLLAR_AT, shapes.COLLAR_UP
    back = np.cross([1.0, 0, 0], up)
    out = np.cos(angle)[:, None] * [1.0, 0, 0] + np.sin(angle)[:, None] * back
    path = at + out * 0.0465
    shape = tube(path, np.full(29, 0.0080), np.full(29, 0.0125), out, 10)
    return replace(rigid(shape, "Neck", "band"), weights=weights.spine(shape[0]))


def teeth() -> Piece:
    x = np.linspace(-0.0150, 0.0150, 9)
    path = np.stack([x, np.full(9, 1.5474), 0.0625 - 22.0 * x * x], 1)
    return rigid(
        tube(path, np.full(9, 0.0050), np.full(9, 0.0020), np.tile([0.0, 1, 0], (9, 1)), 6), "Head", "teeth"
    )


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
    made = rigid((ball * radii + [0.0, 1.5382, 0.0560], normals, triangles), "Jaw", "lip")
    return replace(made, tongue=True)


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
    return rigid(tube(points, full, full, np.tile([0.13, 0.31, 0.94], (len(points), 1)), 6), "Head", "frame")


def earring() -> Piece:
    """A stud in the left ear."""
    angle = np.linspace(-np.pi / 2, np.pi / 2, 6)
    positions, normals, triangles = lathe([(0.0036 * np.cos(a), 0.0036 * np.sin(a)) for a in angle], 10)
    return rigid((positions + [0.0800, 1.5755, -0.010], normals, triangles), "Head", "metal")
