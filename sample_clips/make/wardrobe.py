"""Hair, beard and coat as distance fields, and which sculpted parts a look is made of."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sample_clips.make import shapes
from sample_clips.make.looks import Look
from sample_clips.make.mannequin_skeleton import ARM
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
from sample_clips.make.shapes import CUFF, HEM, JOINT, Part, step

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
    """To the chin, parted on the side, behind the ears."""
    whole = union(
        [
            ellipsoid((0, 1.6420, -0.0170), (0.0895, 0.0945, 0.1030)),
            mirrored(cone((0.0720, 1.6350, -0.0160), (0.0770, 1.5260, -0.0260), 0.0260, 0.0240)),
            ellipsoid((0, 1.5750, -0.0620), (0.0820, 0.0850, 0.0480)),
            cone((0.028, 1.7060, 0.045), (-0.058, 1.6500, 0.060), 0.026, 0.016),
            cone((0.028, 1.7060, 0.045), (0.066, 1.6600, 0.046), 0.022, 0.015),
        ],
        0.030,
    )
    face = union(
        [
            ellipsoid((0.0, 1.5800, 0.1000), (0.0640, 0.0980, 0.0900)),
            ellipsoid((0.018, 1.6500, 0.1050), (0.0300, 0.0330, 0.0420)),
            cone((0, 1.500, 0.02), (0, 1.440, 0.02), 0.062, 0.062),
        ],
        0.016,
    )
    hair = without(whole, face, 0.010)
    hair = common(hair, plane((0, 1.508, -0.02), (0, -1.0, 0.16)), 0.010)
    return _strands(hair, 19, 0.0010)


def _receding() -> Field:
    """Short, thin, far back at the temples."""
    cap = ellipsoid((0, 1.6375, -0.0185), (0.0790, 0.0885, 0.0950))
    sides = mirrored(ellipsoid((0.052, 1.625, -0.020), (0.0300, 0.0520, 0.0640)))

    def bare(p: Array) -> Array:
        forehead = plane((0, 1.6960, 0.050), (0, -0.45, 1.0))(p)
        temple = mirrored(plane((0.030, 1.66, 0.030), (0.75, 0.30, 1.0)))(p)
        ear = plane((0, 1.60, 0.008), (0, 0.10, 1.0))(p)
        nape = plane((0, 1.5640, -0.060), (0, -1.0, 0.62))(p)
        front = np.maximum(np.minimum(forehead, ear + 0.05), np.minimum(temple, ear + 0.02))
        return np.asarray(np.maximum(np.maximum(np.where(p[:, 1] > 1.640, front, ear), nape), -0.02))

    return _strands(common(union([cap, sides], 0.02), bare, 0.010), 19, 0.0004)


def _beard() -> Field:
    """Short, on jaw, chin and upper lip; round the mouth it leaves the lips free."""
    skin = shapes.face_form()
    cheek = mirrored(plane((0.046, 1.556, 0.050), (0.30, 1.0, -0.28)))
    mouth = ellipsoid((0, shapes.MOUTH_Y + 0.0005, 0.090), (0.0265, 0.0098, 0.050))
    neck = plane((0, 1.490, 0.030), (0, -1.0, -0.45))
    ear = mirrored(plane((0.0, 1.560, 0.012), (0.0, 0.20, -1.0)))

    out = common(grown(skin, 0.0042), cheek, 0.006)
    out = without(out, mouth, 0.003)
    return common(common(out, neck, 0.006), ear, 0.006)


def _opening(p: Array) -> Array:
    """Half the width the coat is open by, metres, at the heights of points."""
    height = (0.84, 0.94, 1.06, 1.14, 1.26, 1.40, 1.46)
    return np.interp(p[:, 1], height, (0.060, 0.034, 0.018, 0.020, 0.036, 0.054, 0.062))


def _coat() -> Field:
    """Open in front, with lapels, over the hips."""
    hips = ellipsoid((0, 0.900, -0.010), (0.160, 0.150, 0.110))
    body = union([shapes.torso(), hips], 0.05)
    body = common(body, plane((0, COAT_HEM, 0), (0, -1, 0)), 0.010)
    body = common(body, plane(shapes.COLLAR_AT + shapes.COLLAR_UP * -0.006, shapes.COLLAR_UP), 0.004)
    whole = union([body, mirrored(shapes.sleeve(CUFF - ARM * 0.012))], 0.050)

    def field(p: Array) -> Array:
        x, half = np.abs(p[:, 0]), _opening(p)
        lapel = step(0.054, 0.034, x - half) * step(1.10, 1.15, p[:, 1]) * step(0.0, 0.03, p[:, 2])
        cloth = whole(p) - CLOTH - 0.0050 * lapel
        gap = np.maximum(x - half, 0.010 - p[:, 2])  # negative in the gap
        return np.asarray(-smooth_min(-cloth, gap, 0.008))

    return field


def _sweater(sleeve: float) -> Field:
    body = common(shapes.torso(), plane((0, HEM, 0), (0, -1, 0)), 0.012)
    body = common(body, plane(shapes.COLLAR_AT + shapes.COLLAR_UP * 0.002, shapes.COLLAR_UP), 0.004)
    return union([body, mirrored(shapes.sleeve(CUFF - ARM * sleeve))], 0.050)


def _forearm() -> Field:
    """A bare left forearm, from inside its sleeve to inside the hand."""
    elbow, wrist = JOINT["LeftLowerArm"], JOINT["LeftHand"]
    return common(
        union(
            [
                cone(elbow + ARM * 0.11, wrist + ARM * 0.002, 0.0305, 0.0222, flat=(1, 1.0, 0.97)),
            ],
            0.02,
        ),
        plane(elbow + ARM * 0.125, -ARM),
        0.002,
    )


def _coat_size(p: Array) -> Array:
    """Fine along the edges of the opening and of the lapels, and round the elbows."""
    x = np.abs(p[:, 0])
    edge = np.minimum(np.abs(x - _opening(p)), np.abs(x - _opening(p) - 0.043))
    front = step(0.0, 0.02, p[:, 2]) * step(0.024, 0.008, edge)
    hem = step(0.03, 0.01, np.abs(p[:, 1] - COAT_HEM))
    return np.minimum(0.026 - 0.0175 * np.maximum(front, 0.5 * hem), shapes.elbow_size(p, 0.026))


def _hair_size(p: Array) -> Array:
    return np.full(len(p), 0.0085)


HAIR: dict[str, Callable[[], Field]] = {"short": _short, "bob": _bob, "receding": _receding}


def parts(look: Look) -> tuple[Part, ...]:
    """Return what of a look is sculpted, as `shapes.PARTS` for the mannequin."""
    known = {part.name: part for part in shapes.PARTS}
    if not look.colors:
        return shapes.PARTS
    box = ((-0.110, 1.480, -0.135), (0.110, 1.755, 0.120))
    out = [known["head"], Part("hair", HAIR[look.hair](), *box, 0.0028, _hair_size), known["palm"]]
    cloth = known["sweater"]
    out.append(Part("sweater", _sweater(look.sleeve), cloth.low, cloth.high, cloth.cell, cloth.size))
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
                (0.080, 1.575, 0.110),
                0.0022,
                lambda p: np.full(len(p), 0.0052),
            )
        )
    if look.coat:
        out.append(Part("coat", _coat(), (-0.590, 0.830, -0.160), (0.590, 1.490, 0.150), 0.0050, _coat_size))
    return tuple(out)
