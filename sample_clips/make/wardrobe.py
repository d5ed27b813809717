"""Hair, beard and coat as distance fields, and which sculpted parts a look is made of."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sample_clips.make import shapes
from sample_clips.make.face import face_form, front, skull
from sample_clips.make.folds import body_folds, sleeve_folds
from sample_clips.make.looks import Look
from sample_clips.make.mannequin_skeleton import ARM
from sample_clips.make.mannequin_weights import sweater_weights
from sample_clips.make.pieces import Piece, rigid
from sample_clips.make.sculpt import (
    Field,
    common,
    cone,
    ellipsoid,
    grown,
    mirrored,
    plane,
    smooth_min,
    union,
    without,
)
from sample_clips.make.shapes import CUFF, JOINT, Part, step

Array = NDArray[Any]

COAT_HEM = 0.845
CLOTH = 0.0095  # metres a coat stands off what is under it


def _strands(hair: Field, waves: int, deep: float) -> Field:
    """Hair in locks that run down from the crown. waves: of them round the head. deep: metres."""

    def field(p: Array) -> Array:
        way = np.arctan2(p[:, 0] - 0.012, p[:, 2] + 0.030)
        sway = 0.5 * np.sin(18.0 * p[:, 1] + 2.0 * way)
        near = step(0.020, 0.055, np.hypot(p[:, 0] - 0.012, p[:, 2] + 0.030))
        return np.asarray(hair(p) + deep * near * (1 - np.cos(waves * way + sway)))

    return field


def _short() -> Field:
    return _strands(shapes.hair(), 17, 0.0008)


def _bob() -> Field:
    """What lies under the locks: a cap from the hairline to the nape."""
    whole = union(
        [
            grown(skull(), 0.0085),
            mirrored(cone((0.0660, 1.6300, -0.0250), (0.0660, 1.5300, -0.0350), 0.0190, 0.0160)),
            ellipsoid((0, 1.5750, -0.0560), (0.0780, 0.0720, 0.0430)),
        ],
        0.026,
    )
    return common(whole, _hairline, 0.006)


def _hairline(p: Array) -> Array:
    """Positive where no hair grows: the face, from the forehead past the temples to before the ears."""
    x, y, z = np.abs(p[:, 0]), p[:, 1], p[:, 2]
    edge = np.interp(
        y,
        [1.500, 1.560, 1.605, 1.640, 1.665, 1.690, 1.720],
        [-0.022, -0.012, 0.010, 0.034, 0.050, 0.064, 0.090],
    )
    edge = edge + 0.35 * np.maximum(0.050 - x, 0) * step(1.630, 1.680, y)
    return np.asarray(0.8 * (z - edge))


def _receding() -> Field:
    """What lies under short hair on the sides and the back: it ends flat on the skin."""

    def bare(p: Array) -> Array:
        x, y, z = np.abs(p[:, 0]), p[:, 1], p[:, 2]
        edge = np.interp(
            y, [1.555, 1.580, 1.605, 1.640, 1.660, 1.690], [-0.070, -0.034, 0.004, 0.006, -0.030, -0.080]
        )
        return np.asarray(0.7 * (z - edge) + 0.0 * x)

    return common(grown(skull(), 0.0026), bare, 0.012)


def _beard() -> Field:
    """What lies under a short beard on jaw, chin and upper lip; it leaves the lips free."""
    mouth = ellipsoid((0, shapes.MOUTH_Y - 0.001, 0.090), (0.0265, 0.0098, 0.050))
    ear = mirrored(plane((0.0, 1.560, 0.008), (0.0, 0.20, -1.0)))

    def cheek(p: Array) -> Array:
        x, y = np.abs(p[:, 0]), p[:, 1]
        top = np.interp(
            x, [0, 0.012, 0.026, 0.034, 0.048, 0.060], [1.5570, 1.5580, 1.5540, 1.5500, 1.5560, 1.5760]
        )
        low = np.interp(x, [0, 0.020, 0.045, 0.060], [1.4960, 1.4980, 1.5120, 1.5300])
        return np.asarray(np.maximum(0.7 * (y - top), 0.7 * (low - y)))

    out = common(grown(face_form(), 0.0016), cheek, 0.004)
    return common(without(out, mouth, 0.003), ear, 0.006)


def _opening(p: Array) -> Array:
    """Half the width the coat is open by, metres, at the heights of points."""
    height = (0.84, 0.94, 1.06, 1.14, 1.26, 1.40, 1.46)
    return np.interp(p[:, 1], height, (0.060, 0.034, 0.018, 0.020, 0.036, 0.054, 0.062))


def _coat(opened: bool = True) -> Field:
    """Open in front, over the hips. opened: else as if it were closed."""
    hips = ellipsoid((0, 0.900, -0.010), (0.166, 0.150, 0.114))
    body = union([shapes.torso(), hips], 0.05)
    body = common(body, plane((0, COAT_HEM, 0), (0, -1, 0)), 0.010)
    body = common(body, plane(shapes.COLLAR_AT + shapes.COLLAR_UP * -0.006, shapes.COLLAR_UP), 0.004)
    whole = union([body, mirrored(shapes.sleeve(CUFF - ARM * 0.012))], 0.050)
    whole = shapes.folded(whole, sleeve_folds, lambda p: 0.6 * body_folds(p, COAT_HEM))

    def field(p: Array) -> Array:
        cloth = whole(p) - CLOTH
        if not opened:
            return np.asarray(cloth)
        gap = np.maximum(np.abs(p[:, 0]) - _opening(p), 0.010 - p[:, 2])  # negative in the gap
        return np.asarray(-smooth_min(-cloth, gap, 0.006))

    return field


def _forearm() -> Field:
    """A bare left forearm, from inside its sleeve to inside the hand."""
    elbow, wrist = JOINT["LeftLowerArm"], JOINT["LeftHand"]
    return common(
        union(
            [
                cone(elbow + ARM * 0.11, wrist + ARM * 0.002, 0.0315, 0.0205, flat=(1, 1.0, 0.95)),
            ],
            0.02,
        ),
        plane(elbow + ARM * 0.125, -ARM),
        0.002,
    )


def bare_arm() -> Field:
    """The left hand and forearm as one form, whose normals both take."""
    return union([shapes.hand(), _forearm()], 0.020)


def _coat_size(p: Array) -> Array:
    """Fine along the edges of the opening, at the hem and round the elbows."""
    x = np.abs(p[:, 0])
    front = step(0.0, 0.02, p[:, 2]) * step(0.020, 0.006, np.abs(x - _opening(p)))
    hem = step(0.03, 0.01, np.abs(p[:, 1] - COAT_HEM))
    return np.minimum(0.0330 - 0.0190 * np.maximum(front, 0.5 * hem), shapes.elbow_size(p, 0.033) * 1.2)


def lapels(look: Look) -> list[Piece]:
    """The left edge of a coat turned back: a lapel from the neck to the waist, and a facing below it."""
    if not look.coat:
        return []
    coat = _coat(opened=False)
    heights = np.array(
        [0.850, 0.90, 0.96, 1.02, 1.08, 1.12, 1.15, 1.19, 1.24, 1.29, 1.34, 1.375, 1.40, 1.43, 1.452]
    )
    broad = np.interp(
        heights,
        [0.84, 1.10, 1.13, 1.36, 1.375, 1.39, 1.46],
        [0.011, 0.012, 0.020, 0.060, 0.062, 0.044, 0.032],
    )
    at = np.stack([np.zeros(len(heights)), heights, np.zeros(len(heights))], 1)
    inner = _opening(at) - 0.0015
    columns = []
    for share, off in (
        (0.0, -0.010),
        (0.0, 0.0022),
        (0.12, 0.0040),
        (0.5, 0.0046),
        (0.92, 0.0040),
        (1.0, 0.0022),
        (1.0, -0.003),
    ):
        xy = np.stack([inner + share * broad, heights + (0.012 * share if off > -0.005 else 0.0)], 1)
        z = front(coat, xy)
        columns.append(np.concatenate([xy, (z + off)[:, None]], 1))
    grid = np.stack(columns)
    across, along = np.gradient(grid, axis=0), np.gradient(grid, axis=1)
    normals = np.cross(across, along)
    normals /= np.maximum(np.linalg.norm(normals, axis=2, keepdims=True), 1e-9)
    rows, count = grid.shape[:2]
    i, j = np.meshgrid(np.arange(rows - 1), np.arange(count - 1), indexing="ij")
    a = (i * count + j).ravel()
    triangles = np.concatenate(
        [np.stack([a, a + count, a + count + 1], -1), np.stack([a, a + count + 1, a + 1], -1)]
    )
    flat = grid.reshape(-1, 3)
    made = rigid((flat, normals.reshape(-1, 3), triangles), "Hips", "coat")
    return [replace(made, weights=sweater_weights(flat))]


def _plain(p: Array) -> Array:
    """Less fine: a coat hides most of it."""
    return shapes.sweater_size(p) * 1.35


def _hair_size(p: Array) -> Array:
    return np.full(len(p), 0.0165)


HAIR: dict[str, Callable[[], Field]] = {"short": _short, "bob": _bob, "receding": _receding}


def parts(look: Look) -> tuple[Part, ...]:
    """Return what of a look is sculpted, as `shapes.PARTS` for the mannequin."""
    known = {part.name: part for part in shapes.PARTS}
    if not look.colors:
        return shapes.PARTS
    box = ((-0.110, 1.480, -0.135), (0.110, 1.755, 0.120))
    out = [known["head"], Part("hair", HAIR[look.hair](), *box, 0.0028, _hair_size), known["palm"]]
    cloth = known["sweater"]
    out.append(
        Part(
            "sweater",
            shapes.sweater(CUFF - ARM * look.sleeve, bust=look.build.bust),
            cloth.low,
            cloth.high,
            cloth.cell,
            _plain if look.coat else cloth.size,
        )
    )
    out += [known["trousers"], known["shoe"]]
    if look.sleeve > 0:
        out.append(
            Part(
                "forearm",
                _forearm(),
                (0.330, 0.980, -0.090),
                (0.580, 1.260, 0.045),
                0.0030,
                lambda p: np.full(len(p), 0.0130),
            )
        )
    if look.beard:
        out.append(
            Part(
                "beard",
                _beard(),
                (-0.080, 1.480, -0.030),
                (0.080, 1.585, 0.110),
                0.0022,
                lambda p: np.full(len(p), 0.0110),
            )
        )
    if look.coat:
        out.append(Part("coat", _coat(), (-0.590, 0.830, -0.160), (0.590, 1.490, 0.150), 0.0050, _coat_size))
    return tuple(out)
