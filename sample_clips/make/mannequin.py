"""Builds the mannequin: sculpts its parts, thins them to triangles, binds them to the skeleton, writes
`mannequin.glb`.

    python -m sample_clips.make.mannequin

The face, for whoever animates it (degrees about the joints' own axes; the rest pose has eyes open and mouth
closed): eyes shut: UpperLid +X `UPPER_LID_CLOSED`, LowerLid +X `LOWER_LID_CLOSED`; a lid follows its eye's
pitch at 0.6 (upper) and 0.35 (lower). Jaw opens about +X: 4 a murmur, 10 an "ah", `JAW_OPEN` the widest.
Brows move by translation or turn about Z. All parts share one image: each row of it a colour, from shadow
(left) to light, so that the light that folds and corners lack is baked in and any engine shows it.
"""

from __future__ import annotations

import io
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.motion.character_mesh import Character, Material, Surface
from preview.mesh import lathe
from sample_clips.make import shapes
from sample_clips.make.mannequin_skeleton import ARM, FINGERS
from sample_clips.make.sculpt import Field, gradient, polygonise, project, remesh, union
from sample_clips.make.shapes import EYE_RADIUS, JOINT, LID_RADIUS, MOUTH_HALF, SKELETON, mouth_line, step

Array = NDArray[Any]

UPPER_LID_OPEN, LOWER_LID_OPEN = 26.0, -28.0  # degrees above the eye's axis at which the lids' edges rest
UPPER_LID_CLOSED, LOWER_LID_CLOSED = 40.0, -15.0  # the turn about X that brings both edges together
JAW_OPEN = 16.0

# Rows of the image, sRGB in full light. Neighbours may melt into each other: skin, lip, mouth.
COLORS = {
    "skin": (219, 208, 198),
    "lip": (203, 177, 167),
    "mouth": (70, 50, 48),
    "teeth": (232, 229, 222),
    "hair": (82, 76, 73),
    "lash": (58, 52, 50),
    "sweater": (146, 150, 158),
    "band": (112, 116, 124),
    "trousers": (98, 102, 112),
    "shoe": (72, 74, 80),
    "sole": (206, 204, 199),
    "white": (238, 237, 234),
    "iris": (104, 92, 80),
    "pupil": (26, 24, 24),
}
ROWS = {name: i for i, name in enumerate(COLORS)}
_GLOSSY = ("white", "iris", "pupil", "teeth")
_REACH = 0.05  # metres over which folds darken one another


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
    glossy: bool = False

    def mirrored(self) -> Piece:
        flip = np.array([-1.0, 1, 1])
        swap = {("Right" + n[4:] if n.startswith("Left") else n): w for n, w in self.weights.items()}
        return Piece(
            self.positions * flip, self.normals * flip, self.triangles[:, ::-1], self.rows, swap, self.glossy
        )


def _rigid(shape: tuple[Array, Array, Array], joint: str, row: str | Array) -> Piece:
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
        isinstance(row, str) and row in _GLOSSY,
    )


# --- pieces made ring by ring


def _eye() -> list[Piece]:
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
        out.append(_rigid((positions + JOINT["LeftEye"], normals, triangles), "LeftEye", row))
    return out


def _lid(joint: str, edge: float, back: float) -> Piece:
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
    return _rigid((positions, normals, triangles), joint, rows.ravel())


def _split_rows(piece: Piece) -> Piece:
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
        piece.glossy,
    )


def _tube(path: Array, wide: Array, tall: Array, across: Array, sides: int = 8) -> tuple[Array, Array, Array]:
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


def _brow(face: Field) -> Piece:
    t = np.linspace(0, 1, 11)
    path = np.stack(
        [0.0145 + 0.0365 * t, 1.6278 + 0.0068 * np.sin(np.pi * (0.13 + 0.74 * t)), np.full(11, 0.085)], 1
    )
    for _ in range(8):  # onto the face, straight back
        path[:, 2] -= face(path)
    normal = gradient(face, path)
    full = np.sin(np.pi * np.clip(0.10 + 0.90 * t, 0, 1)) ** 0.6
    return _rigid(
        _tube(
            path + normal * 0.0002,
            0.0030 * full + 1e-5,
            0.0016 * full + 1e-5,
            np.cross(normal, np.gradient(path, axis=0)),
        ),
        "LeftBrow",
        "hair",
    )


def _ring(
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
    return _rigid((positions.reshape(-1, 3), normals, triangles), "Hips", row)


def _hem() -> Piece:
    profile = [
        (0.034, -0.0030),
        (0.0335, 0.0018),
        (0.030, 0.0028),
        (0.004, 0.0030),
        (0.0, 0.0016),
        (-0.0005, -0.004),
        (0.004, -0.012),
    ]
    ring = _ring(
        shapes.torso(), np.array([0, shapes.HEM - 0.004, 0.0]), np.array([0.0, 1, 0]), profile, 40, "band"
    )
    return replace(ring, weights=_sweater_weights(ring.positions))


def _cuff() -> Piece:
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
    ring = _ring(rod, shapes.CUFF + ARM * 0.002, ARM, profile, 18, "band")
    return replace(ring, weights=_arm(ring.positions))


def _sole() -> Piece:
    profile = [
        (0.000, -0.006),
        (0.0, 0.0),
        (0.003, 0.0030),
        (0.015, 0.0036),
        (0.0185, 0.0028),
        (0.0195, 0.0005),
        (0.0195, -0.006),
    ]
    ring = _ring(
        shapes.sole_outline, np.array([0.1055, 0, 0.045]), np.array([0.0, 1, 0]), profile, 40, "sole"
    )
    return replace(ring, weights=_shoe_weights(ring.positions))


def _finger(name: str) -> Piece:
    """A tube that begins inside the palm; its normals are those of the whole hand, so that no seam shows."""
    points = shapes.finger_points(name)
    axis = (points[3] - points[0]) / np.linalg.norm(points[3] - points[0])
    one, two, tip = (float((q - points[0]) @ axis) for q in points[1:])
    end = shapes.finger_radius(name)
    heights = [-0.004, 0.5 * one, one - 0.0065, one + 0.0055, two - 0.0060, two + 0.0055]
    heights += [tip + end * h for h in (0.0, 0.55, 0.86, 0.995)]
    ring = _ring(shapes.finger(name), points[0], axis, [(h, 0.0) for h in heights], 8, "skin")
    return replace(
        ring, normals=gradient(shapes.hand(), ring.positions), weights=_hand_weights(ring.positions, (name,))
    )


def _collar() -> Piece:
    angle = np.linspace(0, 2 * np.pi, 29)
    at, up = shapes.COLLAR_AT, shapes.COLLAR_UP
    back = np.cross([1.0, 0, 0], up)
    out = np.cos(angle)[:, None] * [1.0, 0, 0] + np.sin(angle)[:, None] * back
    path = at + out * 0.0465
    shape = _tube(path, np.full(29, 0.0080), np.full(29, 0.0125), out, 10)
    return replace(_rigid(shape, "Neck", "band"), weights=_spine(shape[0]))


def _teeth() -> Piece:
    x = np.linspace(-0.0150, 0.0150, 9)
    path = np.stack([x, np.full(9, 1.5436), 0.0625 - 22.0 * x * x], 1)
    return _rigid(
        _tube(path, np.full(9, 0.0050), np.full(9, 0.0020), np.tile([0.0, 1, 0], (9, 1)), 6), "Head", "teeth"
    )


# --- weights


def _chain(
    p: Array, joints: tuple[str, ...], reach: tuple[float, ...], axes: tuple[Array, ...]
) -> dict[str, Array]:
    """Weights along a chain: each joint takes over from the one before across its plane, within `reach`
    metres.
    """
    out: dict[str, Array] = {}
    left = np.ones(len(p))
    passed = []
    for joint, half, axis in zip(joints[1:], reach, axes, strict=True):
        passed.append(step(-half, half, (p - JOINT[joint]) @ (axis / np.linalg.norm(axis))))
    for i, joint in enumerate(joints):
        here = left * (1 - passed[i]) if i < len(passed) else left
        out[joint] = here
        left = left * passed[i] if i < len(passed) else left
    return out


def _spine(p: Array) -> dict[str, Array]:
    up = np.array([0.0, 1, 0])
    return _chain(
        p,
        ("Hips", "Spine", "Chest", "UpperChest", "Neck"),
        (0.06, 0.07, 0.07, 0.035),
        (up, up, up, np.array([0, 1.0, 0.2])),
    )


def _arm(p: Array) -> dict[str, Array]:
    shoulder = np.array([1.0, 0.0, 0.0]) + ARM
    return _chain(
        p,
        ("LeftShoulder", "LeftUpperArm", "LeftLowerArm", "LeftHand"),
        (0.055, 0.042, 0.020),
        (shoulder, ARM, ARM),
    )


def _mixed(groups: list[tuple[Array, dict[str, Array]]], softness: float) -> dict[str, Array]:
    """Blend groups of weights by how near each one's own form is: `(distances [V], weights)`."""
    distance = np.stack([d for d, _ in groups])
    share = np.exp(-(distance - distance.min(0)) / softness)
    share /= share.sum(0)
    out: dict[str, Array] = {}
    for part, (_, weights) in zip(share, groups, strict=True):
        for name, w in weights.items():
            out[name] = out.get(name, 0) + part * w
    return out


def _other_side(f: Callable[[Array], dict[str, Array]], p: Array) -> dict[str, Array]:
    return {("Right" + n[4:] if n.startswith("Left") else n): w for n, w in f(p * [-1, 1, 1]).items()}


def _sweater_weights(p: Array) -> dict[str, Array]:
    flip = np.array([-1, 1, 1])
    arm = shapes.sleeve()
    spine = _spine(p)
    # The shoulder joint carries the top of the torso beside it.
    for s, name in ((1, "LeftShoulder"), (-1, "RightShoulder")):
        w = 0.75 * step(0.045, 0.150, s * p[:, 0]) * step(1.27, 1.385, p[:, 1])
        spine = {n: v * (1 - w) for n, v in spine.items()}
        spine[name] = w
    groups = [(shapes.torso()(p), spine), (arm(p), _arm(p)), (arm(p * flip), _other_side(_arm, p))]
    return _mixed(groups, 0.013)


def _leg(p: Array) -> dict[str, Array]:
    down = np.array([0.0, -1, 0])
    return _chain(p, ("LeftUpperLeg", "LeftLowerLeg", "LeftFoot"), (0.060, 0.030), (down, down))


def _trouser_weights(p: Array) -> dict[str, Array]:
    leg = shapes.leg()
    hips = {"Hips": np.ones(len(p))}
    # The leg takes over from the hips below the joint; a soft field keeps the crease of the hip round when
    # sitting.
    above = np.maximum(0, (p[:, 1] - 0.930) * 0.9)
    groups = [
        (shapes.pelvis()(p), hips),
        (leg(p) + above, _leg(p)),
        (leg(p * [-1, 1, 1]) + above, _other_side(_leg, p)),
    ]
    return _mixed(groups, 0.014)


def _shoe_weights(p: Array) -> dict[str, Array]:
    return _chain(
        p,
        ("LeftLowerLeg", "LeftFoot", "LeftToes"),
        (0.030, 0.035),
        (np.array([0.0, -1, 0.3]), np.array([0.0, 0, 1])),
    )


def _hand_weights(p: Array, fingers: tuple[str, ...] = FINGERS) -> dict[str, Array]:
    groups = [(shapes.palm()(p), _chain(p, ("LeftLowerArm", "LeftHand"), (0.022,), (ARM,)))]
    for name in fingers:
        points = shapes.finger_points(name)
        axis = points[2] - points[1]
        half = (0.010, 0.0065, 0.006)
        chain = _chain(p, ("LeftHand", *(f"Left{name}{i}" for i in (1, 2, 3))), half, (axis, axis, axis))
        # A finger begins at its knuckle: beyond it the palm has no say, however near it is.
        behind = np.maximum(0, -(p - points[0]) @ (axis / np.linalg.norm(axis)) - 0.004)
        groups.append((np.maximum(shapes.finger(name)(p), 0) + behind * 0.7, chain))
    return _mixed(groups, 0.0022)


def _head_weights(p: Array) -> dict[str, Array]:
    out = _chain(
        p,
        ("UpperChest", "Neck", "Head"),
        (0.030, 0.034),
        (np.array([0.0, 1, 0.15]), np.array([0.0, 1, -0.35])),
    )
    x, y, z = np.abs(p[:, 0]), p[:, 1], p[:, 2]
    face = step(0.022, 0.050, z)  # the neck has no say in the face: else a nod would part the lips
    out = {n: w * (1 - face) for n, w in out.items()}
    out["Head"] = out["Head"] + face
    below = mouth_line(x) - y
    soft = step(-0.016, 0.012, below)
    sharp = (below > 0).astype(float)
    # Where the two lips part: fully in the middle, less towards the corners, so that the open mouth is round.
    lips = np.sqrt(np.clip(1 - (x / (MOUTH_HALF + 0.0015)) ** 2, 0, 1)) * step(0.040, 0.055, z)
    jaw = (
        (soft * (1 - lips) + sharp * lips)
        * step(-0.010, 0.040, z + 0.35 * (1.545 - y))
        * step(1.478, 1.500, y + 0.35 * (z - 0.03))
    )
    jaw *= 1 - 0.5 * step(0.035, 0.060, x)
    out = {n: w * (1 - jaw) for n, w in out.items()}
    return {**out, "Jaw": jaw}


# --- colours and light


def _head_rows(p: Array) -> Array:
    """Skin, lips and the inside of the mouth."""
    x, y, z = np.abs(p[:, 0]), p[:, 1], p[:, 2]
    line = mouth_line(x)
    taper = np.sqrt(np.clip(1 - (x / 0.0235) ** 2, 0, 1))
    upper, lower = line + 0.0086 * taper * (0.88 + 0.12 * step(0, 0.006, x)), line - 0.0102 * taper
    lip = step(-0.0022, 0.0020, np.minimum(upper - y, y - lower)) * (x < 0.0235) * step(0.064, 0.070, z)
    inside = (
        step(0.0790, 0.0750, z + 12.0 * x * x)
        * (np.abs(y - line) < 0.0075)
        * (x < MOUTH_HALF + 0.001)
        * (z > 0.04)
    )
    return np.asarray(np.maximum(lip * ROWS["lip"], inside * ROWS["mouth"]))


def _open_light(positions: Array, normals: Array) -> Array:
    """How much of the light reaches each point `[V]`, 0..1: less where other forms are near along the
    normal.
    """
    whole = union(
        [part.field for part in shapes.PARTS if part.name in ("head", "hair", "sweater", "trousers")], 0.0
    )
    hand, shoe = shapes.hand(), shapes.shoe()

    def everything(p: Array) -> Array:
        q = np.stack([np.abs(p[:, 0]), p[:, 1], p[:, 2]], 1)
        return np.asarray(np.minimum(whole(p), np.minimum(hand(q), shoe(q))))

    shut, total = np.zeros(len(positions)), 0.0
    for i, h in enumerate(np.array([0.06, 0.16, 0.36, 0.64, 1.0]) * _REACH):
        weight = 0.62**i / h
        shut += weight * np.clip(h - everything(positions + normals * h), 0, h)
        total += weight * h
    return np.asarray(np.clip(1 - 1.0 * shut / total, 0, 1))


def _image() -> bytes:
    """The colour rows as PNG: 64 texels from shadow to light, eight texels a row. Shadows keep some
    warmth.
    """
    from PIL import Image

    u = np.linspace(0, 1, 64)[:, None]
    dark = np.array([0.30, 0.265, 0.26])
    rows = [np.repeat(((dark + (1 - dark) * u) * np.array(c))[None], 8, 0) for c in COLORS.values()]
    out = io.BytesIO()
    Image.fromarray(np.concatenate(rows).round().astype(np.uint8)).save(out, "PNG", optimize=True)
    return out.getvalue()


# --- the whole

_WEIGHTS: dict[str, Callable[[Array], dict[str, Array]]] = {
    "head": _head_weights, "palm": _hand_weights, "sweater": _sweater_weights, "trousers": _trouser_weights,
    "shoe": _shoe_weights, "hair": lambda p: {"Head": np.ones(len(p))},
}  # fmt: skip
_ROWS: dict[str, Callable[[Array], Array]] = {"head": _head_rows}


def _pieces(sculpt: Callable[[shapes.Part], tuple[Array, Array]]) -> list[Piece]:
    out: list[Piece] = []
    for part in shapes.PARTS:
        positions, triangles = sculpt(part)
        row = {"palm": "skin"}.get(part.name, part.name)
        rows = (
            _ROWS[part.name](positions) if part.name in _ROWS else np.full(len(positions), float(ROWS[row]))
        )
        normal_of = shapes.hand() if part.name == "palm" else part.field
        piece = Piece(
            positions, gradient(normal_of, positions), triangles, rows, _WEIGHTS[part.name](positions)
        )
        out += [piece, piece.mirrored()] if part.name in ("palm", "shoe") else [piece]
    left = [
        *_eye(),
        _split_rows(_lid("LeftUpperLid", UPPER_LID_OPEN, 128.0)),
        _split_rows(_lid("LeftLowerLid", LOWER_LID_OPEN, -110.0)),
        _brow(shapes.face_form()),
        _cuff(),
        *(_finger(name) for name in FINGERS),
        _sole(),
    ]
    return [*out, *left, *(p.mirrored() for p in left), _collar(), _hem(), _teeth()]


def sculpted(part: shapes.Part) -> tuple[Array, Array]:
    """Return a part's positions and triangles: finely polygonised, then thinned to the sizes it asks for."""
    positions, triangles = polygonise(part.field, part.low, part.high, part.cell)
    positions, triangles = remesh(part.field, positions, triangles, part.size)
    return project(part.field, positions), triangles


def mannequin_character(sculpt: Callable[[shapes.Part], tuple[Array, Array]] = sculpted) -> Character:
    """Build the mannequin from nothing (about half a minute; the same to the bit every time)."""
    pieces = _pieces(sculpt)
    pieces = [p for p in pieces if not p.glossy] + [p for p in pieces if p.glossy]
    counts = np.cumsum([0] + [len(p.positions) for p in pieces])
    positions, normals = (
        np.concatenate([getattr(p, n) for p in pieces]).astype(np.float32) for n in ("positions", "normals")
    )
    dense = np.zeros((len(positions), len(SKELETON)))
    for piece, start in zip(pieces, counts, strict=False):
        for joint, weight in piece.weights.items():
            dense[start : start + len(piece.positions), SKELETON.index(joint)] += weight
    joints = np.argsort(-dense, axis=1, kind="stable")[:, :4]
    weights = np.take_along_axis(dense, joints, 1)
    weights = np.where(
        weights < 0.03 * weights[:, :1], 0, weights
    )  # a whiff of the other leg only costs time
    weights /= weights.sum(1, keepdims=True)
    joints = np.where(weights > 0, joints, 0)
    light = _open_light(positions.astype(float), normals.astype(float))
    glossy = np.concatenate([np.full(len(p.positions), p.glossy) for p in pieces])
    light = np.where(glossy, np.maximum(light, 0.80), light)
    # Round the eyes the lids move: what they shade now they do not shade shut.
    eyes = np.minimum(*(np.linalg.norm(positions - JOINT[n], axis=1) for n in ("LeftEye", "RightEye")))
    light = np.maximum(light, 0.90 * step(0.030, 0.022, eyes))
    # The inside of the mouth is dark by its colour; its shade would blur over the lips.
    mouth = np.linalg.norm((positions - [0, shapes.MOUTH_Y, 0.082]) / [0.030, 0.014, 0.030], axis=1)
    light = np.maximum(light, 0.66 * step(1.2, 0.8, mouth))
    rows = np.concatenate([p.rows for p in pieces])
    uvs = np.stack([(0.5 + 63 * light) / 64, (rows + 0.5) / len(COLORS)], 1).astype(np.float32)
    triangles = np.concatenate(
        [p.triangles + start for p, start in zip(pieces, counts, strict=False)]
    ).astype(np.uint32)
    matt = sum(len(p.triangles) for p in pieces if not p.glossy)
    image = _image()
    return Character(
        "Mannequin",
        SKELETON,
        positions,
        normals,
        uvs,
        joints.astype(np.uint16),
        weights.astype(np.float32),
        triangles,
        (Material("body", (1, 1, 1, 1), image, 0.72), Material("eyes", (1, 1, 1, 1), image, 0.12)),
        (Surface(0, matt, 0), Surface(matt, len(triangles) - matt, 1)),
    )


def main() -> None:
    from metagraph.formats.gltf import write_glb

    write_glb(Path(__file__).parents[1] / "mannequin.glb", (), mannequin_character())


if __name__ == "__main__":
    main()
