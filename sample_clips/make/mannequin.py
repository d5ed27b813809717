"""Builds our characters: sculpts its parts, thins them to triangles, binds them to the skeleton, writes
`mannequin.glb`;
and in the same way the two who talk, `ada.glb` and `ben.glb`: see `looks`.

    python -m sample_clips.make.mannequin

The face, for whoever animates it (degrees about the joints' own axes; the rest pose has eyes open and mouth
closed): eyes shut: UpperLid +X `UPPER_LID_CLOSED`, LowerLid +X `LOWER_LID_CLOSED`; a lid follows its eye's
pitch at 0.6 (upper) and 0.35 (lower). Jaw opens about +X: 4 a murmur, 10 an "ah", `JAW_OPEN` the widest.
Brows move by translation or turn about Z. All parts share one image: each row of it a colour, from shadow
(left) to light, so that the light that folds and corners lack is baked in and any engine shows it.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.motion.character_mesh import CharacterMesh, MeshMaterial, Surface
from sample_clips.make import face_targets, pieces, shapes, wardrobe
from sample_clips.make import mannequin_weights as weights
from sample_clips.make.build import built
from sample_clips.make.looks import LOOKS, MANNEQUIN, MATERIALS, NEUTRAL, ROWS, Look
from sample_clips.make.mannequin_skeleton import FINGERS
from sample_clips.make.pieces import LOWER_LID_OPEN, UPPER_LID_OPEN, Piece
from sample_clips.make.sculpt import gradient, polygonise, project, remesh, union
from sample_clips.make.shapes import JOINT, MOUTH_HALF, SKELETON, mouth_line, step

Array = NDArray[Any]

UPPER_LID_CLOSED, LOWER_LID_CLOSED = 40.0, -15.0  # the turn about X that brings both edges together
JAW_OPEN = 16.0
_REACH = 0.05  # metres over which folds darken one another
_BRIGHT = 0.80  # the least light that eyes and teeth have


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
    blush = 0.9 * _spot(p, (0.0430, 1.5680, 0.0560), 0.024) + 0.8 * _spot(p, (0.0, 1.5740, 0.1020), 0.014)
    blush += 0.8 * _spot(p, (0.0810, 1.5965, -0.013), 0.024)
    rows = ROWS["skin"] - np.clip(blush, 0, 1) * (1 - lip) + lip * (ROWS["lip"] - ROWS["skin"])
    return np.asarray(np.maximum(rows, inside * ROWS["mouth"]))


def _spot(p: Array, at: tuple[float, float, float], reach: float) -> Array:
    q = np.stack([np.abs(p[:, 0]), p[:, 1], p[:, 2]], 1)
    return np.asarray(np.exp(-(np.linalg.norm(q - np.array(at), axis=1) ** 2) / reach**2))


def _open_light(parts: tuple[shapes.Part, ...], positions: Array, normals: Array) -> Array:
    """How much of the light reaches each point `[V]`, 0..1: less where other forms are near along the
    normal.
    """
    whole = union([p.field for p in parts if p.name in ("head", "hair", "sweater", "trousers", "coat")], 0.0)
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


_WEIGHTS: dict[str, Callable[[Array], weights.Weights]] = {
    "head": weights.head_weights, "palm": weights.hand_weights, "sweater": weights.sweater_weights,
    "trousers": weights.trouser_weights, "shoe": weights.shoe_weights, "forearm": weights.arm,
    "beard": weights.head_weights, "coat": weights.sweater_weights,
    "hair": lambda p: {"Head": np.ones(len(p))},
}  # fmt: skip
_BOTH = ("palm", "shoe", "forearm")  # made for the left, and mirrored
_LOOSE = ("Eye", "UpperLid", "LowerLid")
_ROW_OF = {"palm": "skin", "forearm": "skin"}
Sculpt = Callable[[shapes.Part], tuple[Array, Array]]


def _rows(name: str, p: Array) -> Array:
    if name == "head":
        return _head_rows(p)
    return np.full(len(p), float(ROWS[_ROW_OF.get(name, name)]))


def _pieces(look: Look, sculpt: Sculpt) -> list[Piece]:
    out: list[Piece] = []
    for part in wardrobe.parts(look):
        positions, triangles = sculpt(part)
        normals = gradient(shapes.hand() if part.name == "palm" else part.field, positions)
        rows = _rows(part.name, positions)
        material = pieces.material_of(_ROW_OF.get(part.name, {"head": "skin"}.get(part.name, part.name)))
        piece = Piece(positions, normals, triangles, rows, _WEIGHTS[part.name](positions), material)
        out += [piece, piece.mirrored()] if part.name in _BOTH else [piece]
    left = [
        *pieces.eye(),
        pieces.split_rows(pieces.lid("LeftUpperLid", UPPER_LID_OPEN - look.lids, 128.0)),
        pieces.split_rows(pieces.lid("LeftLowerLid", LOWER_LID_OPEN, -110.0)),
        pieces.brow(shapes.face_form(), look.build.brows),
        pieces.cuff(look.sleeve),
        *(pieces.finger(name) for name in FINGERS),
        pieces.sole(),
        *([pieces.earring()] if look.earrings else []),
    ]
    worn = pieces.glasses() if look.glasses else []
    worn += [pieces.tongue()] if look.targets else []
    return [*out, *left, *(p.mirrored() for p in left), pieces.collar(), pieces.hem(), pieces.teeth(), *worn]


def sculpted(part: shapes.Part) -> tuple[Array, Array]:
    """Return a part's positions and triangles: finely polygonised, then thinned to the sizes it asks for."""
    positions, triangles = polygonise(part.field, part.low, part.high, part.cell)
    positions, triangles = remesh(part.field, positions, triangles, part.size)
    return project(part.field, positions), triangles


def mannequin_character(look: Look = MANNEQUIN, sculpt: Sculpt = sculpted) -> CharacterMesh:
    """Build a character from nothing (about half a minute; the same to the bit every time)."""
    parts = wardrobe.parts(look)
    order = [name for name, _, _ in MATERIALS]
    made = sorted(_pieces(look, sculpt), key=lambda p: order.index(p.material))
    positions, normals = (np.concatenate([getattr(p, n) for p in made]) for n in ("positions", "normals"))
    counts = np.cumsum([0] + [len(p.positions) for p in made])
    triangles = np.concatenate([p.triangles + start for p, start in zip(made, counts, strict=False)])
    light = _open_light(parts, positions, normals)
    light = np.where(_of(made, "cloth", "hair"), _evened(light, triangles), light)
    light = np.where(_of(made, "eyes"), np.maximum(light, _BRIGHT), light)
    # Round the eyes the lids move: what they shade now they do not shade shut.
    eyes = np.minimum(*(np.linalg.norm(positions - JOINT[n], axis=1) for n in ("LeftEye", "RightEye")))
    light = np.maximum(light, 0.90 * step(0.030, 0.022, eyes))
    # The inside of the mouth is dark by its colour; its shade would blur over the lips.
    mouth = np.linalg.norm((positions - [0, shapes.MOUTH_Y, 0.082]) / [0.030, 0.014, 0.030], axis=1)
    light = np.maximum(light, 0.66 * step(1.2, 0.8, mouth))
    rows = np.concatenate([p.rows for p in made])
    within = step(2.3, 2.9, rows) * (rows <= ROWS["mouth"])  # faces out, so that no rim of light is on it
    light = light * (1 - 0.5 * within)
    normals = normals * (1 - within[:, None]) + within[:, None] * np.array([0.0, 0.0, 1.0])
    uvs = np.stack([(0.5 + 63 * light) / 64, (rows + 0.5) / len(NEUTRAL)], 1).astype(np.float32)
    dense = np.zeros((len(positions), len(SKELETON)))
    for piece, start in zip(made, counts, strict=False):
        for joint, weight in piece.weights.items():
            dense[start : start + len(piece.positions), SKELETON.index(joint)] += weight
    joints, kept = _four(dense)
    targets = _targets(positions, dense, made) if look.targets else None
    body = np.concatenate([built(p.positions, p.weights, look.build) for p in made])
    normals = _turned_along(normals, positions, body, triangles)
    image = look.image()
    materials = tuple(MeshMaterial(name, (1, 1, 1, 1), image, rough) for name, _, rough in MATERIALS)
    sizes = [sum(len(p.triangles) for p in made if p.material == name) for name in order]
    firsts = np.cumsum([0, *sizes])
    return CharacterMesh(
        look.name,
        SKELETON,
        body.astype(np.float32),
        normals.astype(np.float32),
        uvs,
        joints.astype(np.uint16),
        kept.astype(np.float32),
        triangles.astype(np.uint32),
        materials,
        tuple(Surface(int(firsts[i]), size, i) for i, size in enumerate(sizes)),
        tuple(face_targets.TARGETS) if look.targets else (),
        targets,
    )


def _four(dense: Array) -> tuple[Array, Array]:
    """Return the four joints each point follows most and their weights, each `[V, 4]`."""
    joints = np.argsort(-dense, axis=1, kind="stable")[:, :4]
    kept = np.take_along_axis(dense, joints, 1)
    kept = np.where(kept < 0.03 * kept[:, :1], 0, kept)  # a whiff of the other leg only costs time
    kept /= kept.sum(1, keepdims=True)
    return np.where(kept > 0, joints, 0), kept


def _targets(positions: Array, dense: Array, made: list[Piece]) -> Array:
    """Return what the face's targets move each point by, `[K, V, 3]`."""
    of = {n: dense[:, SKELETON.index(n)] for n in ("Head", "Jaw", "LeftBrow", "RightBrow")}
    face = step(0.5, 0.9, sum(of.values(), np.zeros(len(positions))))
    still = _of(made, "hair", "eyes") & (of["Head"] > 0.5)  # but brows are hair that moves
    loose = {s + n: dense[:, SKELETON.index(s + n)] for s in ("Left", "Right") for n in _LOOSE}
    loose["Tongue"] = np.concatenate([np.full(len(p.positions), float(p.tongue)) for p in made])
    return face_targets.offsets(positions, of["Jaw"], np.where(still, 0.0, face), loose)


def _of(made: list[Piece], *materials: str) -> Array:
    """Return which points are of materials, `[V]`."""
    return np.concatenate([np.full(len(p.positions), p.material in materials) for p in made])


def _evened(light: Array, triangles: Array, rounds: int = 4) -> Array:
    """Return light `[V]` spread over neighbours: folds are darker, but not in beads."""
    ends = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    ends = np.concatenate([ends, ends[:, ::-1]])
    count = np.maximum(np.bincount(ends[:, 0], minlength=len(light)), 1)
    for _ in range(rounds):
        light = 0.4 * light + 0.6 * np.bincount(ends[:, 0], light[ends[:, 1]], len(light)) / count
    return light


def _turned_along(normals: Array, before: Array, after: Array, triangles: Array) -> Array:
    """Return normals `[V, 3]` turned as the surface turned from one set of places to another."""
    if np.array_equal(before, after):
        return normals

    def facing(p: Array) -> Array:
        corner = p[triangles]
        across = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
        out = np.zeros_like(p)
        for k in range(3):
            np.add.at(out, triangles[:, k], across)
        return out / np.maximum(np.linalg.norm(out, axis=1, keepdims=True), 1e-12)

    out = normals + facing(after) - facing(before)
    return np.asarray(out / np.maximum(np.linalg.norm(out, axis=1, keepdims=True), 1e-9))


def main() -> None:
    import sys

    from metagraph.formats.gltf.reader import write_glb

    folder = Path(__file__).parents[1]
    for look in LOOKS:
        if look.name.lower() in sys.argv[1:] or not sys.argv[1:]:
            write_glb(folder / look.file, (), mannequin_character(look))


if __name__ == "__main__":
    main()
