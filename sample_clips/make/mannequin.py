"""Builds our characters: sculpts its parts, thins them to triangles, binds them to the skeleton, writes
`mannequin.glb`;
and in the same way the two who talk, `ada.glb` and `ben.glb`: see `looks`.

    python -m sample_clips.make.mannequin

A head is a sculpted form (`face`) with openings made ring by ring (`openings`: lids, lips), hair in locks
(`hair_locks`), eyes with an image of their own (`iris`). Clothes have folds (`folds`) and grains (`weave`).

The face, for whoever animates it (degrees about the joints' own axes; the rest pose has eyes open and mouth
closed): eyes shut: UpperLid +X `UPPER_LID_CLOSED`, LowerLid +X `LOWER_LID_CLOSED`; a lid follows its eye's
pitch at 0.6 (upper) and 0.35 (lower). Jaw opens about +X: 4 a murmur, 10 an "ah", `JAW_OPEN` the widest.
Brows move by translation or turn about Z. All parts share one image: each row of it a colour, from shadow
(left) to light, so that the light that folds and corners lack is baked in and any engine shows it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.motion.character_mesh import CharacterMesh, MeshMaterial, Surface
from sample_clips.make import face_pieces, face_targets, pieces, shapes, wardrobe
from sample_clips.make import mannequin_weights as weights
from sample_clips.make.build import built
from sample_clips.make.face import face_form
from sample_clips.make.hair_locks import hair_locks
from sample_clips.make.iris import eye_image
from sample_clips.make.looks import LOOKS, MANNEQUIN, MATERIALS, NEUTRAL, ROWS, Look
from sample_clips.make.mannequin_skeleton import FINGERS
from sample_clips.make.pieces import Piece
from sample_clips.make.sculpt import gradient, polygonise, project, remesh, union
from sample_clips.make.shapes import JOINT, SKELETON, step
from sample_clips.make.weave import TILE, grain_image, woven

Array = NDArray[Any]

UPPER_LID_CLOSED, LOWER_LID_CLOSED = 40.0, -15.0  # the turn about X that brings both edges together
JAW_OPEN = 16.0
_REACH = 0.05  # metres over which folds darken one another
_BRIGHT = 0.80  # the least light that eyes and teeth have


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
        return face_pieces.skin_rows(p)
    return np.full(len(p), float(ROWS[_ROW_OF.get(name, name)]))


def _pieces(look: Look, sculpt: Sculpt) -> list[Piece]:
    out: list[Piece] = []
    for part in wardrobe.parts(look):
        positions, triangles = sculpt(part)
        normals = gradient(wardrobe.bare_arm() if part.name in ("palm", "forearm") else part.field, positions)
        rows = _rows(part.name, positions)
        material = pieces.material_of(_ROW_OF.get(part.name, {"head": "skin"}.get(part.name, part.name)))
        piece = Piece(
            positions, normals, triangles, rows, _WEIGHTS[part.name](positions), material, part=part.name
        )
        if part.name == "head":
            piece = _opened(piece)
        out += [piece, piece.mirrored()] if part.name in _BOTH else [piece]
    out = [_uncovered(p, look) for p in out]
    face = face_form()
    left = [
        face_pieces.eye(),
        *face_pieces.lids(face, look),
        face_pieces.brow(face, look.build.brows),
        pieces.cuff(look.sleeve),
        *(pieces.finger(name) for name in FINGERS),
        pieces.sole(),
        *pieces.laces(),
        *wardrobe.lapels(look),
        *([pieces.earring()] if look.earrings else []),
    ]
    inside = [face_pieces.mouth_inside(), face_pieces.teeth(True), face_pieces.teeth(False)]
    worn = pieces.glasses() if look.glasses else []
    worn += [face_pieces.tongue()] if look.targets else []
    lips = face_pieces.lips(face, look)
    out += hair_locks(look, face)
    made = [*out, *left, *(p.mirrored() for p in left), lips, *inside, pieces.collar(), pieces.hem(), *worn]
    return [woven(p, p.material, _LIMBS[p.material]) if p.material in _LIMBS else p for p in made]


_LIMBS = {"knit": "arms", "denim": "legs", "wool": "arms"}  # what of cloth is wound about limbs
_COVERS = {"head": ("hair",), "trousers": ("sweater", "coat"), "sweater": ("coat",)}
_COVER = 0.0045  # metres under what covers it that a triangle is left out


def _uncovered(piece: Piece, look: Look) -> Piece:
    """Return a part without the triangles that lie whole under others of a look."""
    fields = {p.name: p.field for p in wardrobe.parts(look)}
    over = [fields[n] for n in _COVERS.get(piece.part, ()) if n in fields]
    if not over:
        return piece
    depth = np.min([f(piece.positions) for f in over], axis=0)
    return _kept(piece, ~(depth < -_COVER)[piece.triangles].all(1))


def _opened(head: Piece) -> Piece:
    """Return a head without the triangles that lie whole behind the lids' and the lips' patches."""
    p = head.positions
    x, y, ahead = np.abs(p[:, 0]) - JOINT["LeftEye"][0], p[:, 1] - JOINT["LeftEye"][1], p[:, 2]
    eye, front = np.stack([(x - 0.0025) / 0.0205, y / 0.0150], 1), ahead > 0.04
    mouth = np.stack([p[:, 0] / 0.0282, (p[:, 1] - shapes.MOUTH_Y) / 0.0146], 1)
    away = np.minimum(np.linalg.norm(eye, axis=1), np.linalg.norm(mouth, axis=1))
    away = np.where(front, away, np.inf)[head.triangles]  # of their edges, 1 where a patch is sure to cover
    return _kept(head, ~((away < 1).all(1) | (away < 0.62).any(1)))


def _kept(piece: Piece, which: Array) -> Piece:
    """Return a piece with some of its triangles, `which [N]`, and the points that those need."""
    used, triangles = np.unique(piece.triangles[which], return_inverse=True)
    return replace(
        piece,
        positions=piece.positions[used],
        normals=piece.normals[used],
        rows=piece.rows[used],
        triangles=triangles.reshape(-1, 3),
        weights={n: w[used] for n, w in piece.weights.items()},
    )


def sculpted(part: shapes.Part) -> tuple[Array, Array]:
    """Return a part's positions and triangles: finely polygonised, then thinned to the sizes it asks for."""
    positions, triangles = polygonise(part.field, part.low, part.high, part.cell)
    positions, triangles = remesh(part.field, positions, triangles, part.size)
    return project(part.field, positions), triangles


def mannequin_character(look: Look = MANNEQUIN, sculpt: Sculpt = sculpted) -> CharacterMesh:
    """Build a character from nothing (about two minutes; the same to the bit every time)."""
    parts = wardrobe.parts(look)
    order = [name for name, _, _ in MATERIALS]
    made = sorted(_pieces(look, sculpt), key=lambda p: order.index(p.material))
    positions, normals = (np.concatenate([getattr(p, n) for p in made]) for n in ("positions", "normals"))
    counts = np.cumsum([0] + [len(p.positions) for p in made])
    triangles = np.concatenate([p.triangles + start for p, start in zip(made, counts, strict=False)])
    light = _open_light(parts, positions, normals)
    light = np.where(_of(made, *TILE, "hair"), _evened(light, positions, triangles), light)
    light = np.where(_of(made, "eyes"), np.maximum(light, _BRIGHT), light)
    # Round the eyes the lids move: what they shade now they do not shade shut.
    eyes = np.minimum(*(np.linalg.norm(positions - JOINT[n], axis=1) for n in ("LeftEye", "RightEye")))
    light = np.maximum(light, 0.90 * step(0.030, 0.022, eyes))
    # The inside of the mouth is dark by its colour; its shade would blur over the lips.
    mouth = np.linalg.norm((positions - [0, shapes.MOUTH_Y, 0.086]) / [0.030, 0.016, 0.016], axis=1)
    light = np.maximum(light, 0.86 * step(1.2, 0.8, mouth))
    rows = np.concatenate([p.rows for p in made])
    within = step(2.3, 2.9, rows) * (rows <= ROWS["mouth"])  # faces out, so that no rim of light is on it
    light = light * (1 - 0.5 * within)
    normals = normals * (1 - within[:, None]) + within[:, None] * np.array([0.0, 0.0, 1.0])
    light = np.where(rows == ROWS["band"], np.maximum(light, 0.66), light)
    light = light * np.concatenate([np.ones(len(p.positions)) if p.shade is None else p.shade for p in made])
    uvs = np.stack([(0.5 + 63 * np.clip(light, 0, 1)) / 64, (rows + 0.5) / len(NEUTRAL)], 1)
    own = np.concatenate([np.full((len(p.positions), 2), np.nan) if p.uvs is None else p.uvs for p in made])
    uvs = np.where(np.isnan(own), uvs, own).astype(np.float32)
    dense = np.zeros((len(positions), len(SKELETON)))
    for piece, start in zip(made, counts, strict=False):
        for joint, weight in piece.weights.items():
            dense[start : start + len(piece.positions), SKELETON.index(joint)] += weight
    joints, kept = _four(dense)
    targets = _targets(positions, dense, made) if look.targets else None
    body = np.concatenate([built(p.positions, p.weights, look.build) for p in made])
    normals = _turned_along(normals, positions, body, triangles)
    grain = np.concatenate([np.zeros((len(p.positions), 2)) if p.grain is None else p.grain for p in made])
    image, eyes = look.image(), eye_image(look.colors.get("iris", NEUTRAL["iris"]))
    materials = tuple(
        MeshMaterial(
            name,
            (1, 1, 1, 1),
            eyes if name == "eyeball" else image,
            rough,
            double_sided=name == "hair",  # locks are sheets: one side of one, seen along it, is a dotted line
            grain=grain_image(name) if name in TILE else None,
        )
        for name, _, rough in MATERIALS
    )
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
        grain_uvs=grain.astype(np.float32),
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
    rows = np.concatenate([p.rows for p in made])
    still = (rows == ROWS["hair"]) | _of(made, "eyes", "eyeball")
    still &= of["Head"] > 0.5  # but brows are hair that moves
    loose = {s + n: dense[:, SKELETON.index(s + n)] for s in ("Left", "Right") for n in _LOOSE}
    loose["Tongue"] = np.concatenate([np.full(len(p.positions), float(p.tongue)) for p in made])
    return face_targets.offsets(positions, of["Jaw"], np.where(still, 0.0, face), loose)


def _of(made: list[Piece], *materials: str) -> Array:
    """Return which points are of materials, `[V]`."""
    return np.concatenate([np.full(len(p.positions), p.material in materials) for p in made])


def _evened(light: Array, positions: Array, triangles: Array, rounds: int = 4) -> Array:
    """Return light `[V]` spread over neighbours: folds are darker, but not in beads. Points at one place are
    one, so that seams stay unseen.
    """
    _, first, place = np.unique(positions.round(6), axis=0, return_index=True, return_inverse=True)
    place = place.reshape(-1)
    corners, light = place[triangles], light[first]
    ends = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
    ends = np.concatenate([ends, ends[:, ::-1]])
    count = np.maximum(np.bincount(ends[:, 0], minlength=len(light)), 1)
    for _ in range(rounds):
        light = 0.4 * light + 0.6 * np.bincount(ends[:, 0], light[ends[:, 1]], len(light)) / count
    return light[place]


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
