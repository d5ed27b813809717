"""Hair, beard and coat as distance fields, and which sculpted parts a look is made of."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sample_clips.make import shapes
from sample_clips.make.face import face_form, skull
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
            grown(skull(), 0.0050),
            mirrored(cone((0.0660, 1.6300, -0.0250), (0.0680, 1.5400, -0.0350), 0.0170, 0.0150)),
            ellipsoid((0, 1.5850, -0.0560), (0.0760, 0.0700, 0.0420)),
        ],
        0.026,
    )
    return common(whole, _hairline, 0.006)


def _hairline(p: Array) -> Array:
    """Positive where no hair grows: the face, from the forehead past the temples to before the ears."""
    x, y, z = np.abs(p[:, 0]), p[:, 1], p[:, 2]
    edge = np.interp(y, [1.500, 1.560, 1.605, 1.640, 1.665, 1.690, 1.720], [-0.022, -0.012, 0.010, 0.034, 0.050, 0.064, 0.090])
    edge = edge + 0.35 * np.maximum(0.050 - x, 0) * step(1.630, 1.680, y)
    return np.asarray(0.8 * (z - edge))


def _receding() -> Field:
    """What lies under short hair on the sides and the back: it ends flat on the skin."""

    def bare(p: Array) -> Array:
        x, y, z = np.abs(p[:, 0]), p[:, 1], p[:, 2]
        edge = np.interp(y, [1.555, 1.580, 1.605, 1.640, 1.660, 1.690], [-0.070, -0.034, 0.004, 0.006, -0.030, -0.080])
        return np.asarray(0.7 * (z - edge) + 0.0 * x)

    return common(grown(skull(), 0.0026), bare, 0.012)


def _beard() -> Field:
    """What lies under a short beard on jaw, chin and upper lip; it leaves the lips free."""
    mouth = ellipsoid((0, shapes.MOUTH_Y - 0.001, 0.090), (0.0265, 0.0098, 0.050))
    ear = mirrored(plane((0.0, 1.560, 0.008), (0.0, 0.20, -1.0)))

    def cheek(p: Array) -> Array:
        x, y = np.abs(p[:, 0]), p[:, 1]
        top = np.interp(x, [0, 0.012, 0.026, 0.034, 0.048, 0.060], [1.5570, 1.5580, 1.5540, 1.5500, 1.5560, 1.5760])
        low = np.interp(x, [0, 0.020, 0.045, 0.060], [1.4960, 1.4980, 1.5120, 1.5300])
        return np.asarray(np.maximum(0.7 * (y - top), 0.7 * (low - y)))

    out = common(grown(face_form(), 0.0016), cheek, 0.004)
    return common(without(out, mouth, 0.003), ear, 0.006)


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
    """Fine along the edges of the opening and of the lapels, and round the elbows."""
    x = np.abs(p[:, 0])
    edge = np.minimum(np.abs(x - _opening(p)), np.abs(x - _opening(p) - 0.043))
    front = step(0.0, 0.02, p[:, 2]) * step(0.024, 0.008, edge)
    hem = step(0.03, 0.01, np.abs(p[:, 1] - COAT_HEM))
    return np.minimum(0.026 - 0.0175 * np.maximum(front, 0.5 * hem), shapes.elbow_size(p, 0.026))


def _hair_size(p: Array) -> Array:
    return np.full(len(p), 0.0120)


HAIR: dict[str, Callable[[], Field]] = {"short": _short, "bob": _bob, "receding": _receding}


def parts(look: Look) -> tuple[Part, ...]:
    """Return what of a look is sculpted, as `shapes.PARTS` for the mannequin."""
    known = {part.name: part for part in shapes.PARTS}
    if not look.colors:
        return shapes.PARTS
    box = ((-0.110, 1.480, -0.135), (0.110, 1.755, 0.120))
    out = [known["head"], Part("hair", HAIR[look.hair](), *box, 0.0028, _hair_size), known["palm"]]
    cloth = known["sweater"]
    out.append(Part("sweater", shapes.sweater(CUFF - ARM * look.sleeve, bust=look.build.bust), cloth.low, cloth.high, cloth.cell, cloth.size))
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
                lambda p: np.full(len(p), 0.0070),
            )
        )
    if look.coat:
        out.append(Part("coat", _coat(), (-0.590, 0.830, -0.160), (0.590, 1.490, 0.150), 0.0050, _coat_size))
    return tuple(out)
