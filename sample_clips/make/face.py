"""The form of our characters' heads as a distance field: skull, face, nose, ears and neck, without the
openings of eyes and mouth, which `openings` makes ring by ring.

Sizes are those of ANSUR II (Gordon and others, 2014, means of the women; men's in brackets) scaled from a
stature of 1.63 m to the skeleton's 1.72 m: head length 187 (197) mm, head breadth 146 (152), bizygomatic
breadth 130 (140), bigonial breadth 105 (115), menton to sellion 111 (122), interpupillary breadth 61 (64).
The head is 1/7.5 of the height. What these leave open (brow, lids, cheeks, lips) is by eye.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from sample_clips.make.default_body.forms import loft, spline
from sample_clips.make.sculpt import (
    Field,
    cone,
    ellipsoid,
    mirrored,
    rods,
    union,
    without,
)

Array = NDArray[Any]

Bump = tuple[tuple[float, float, float], tuple[float, float, float], float]

# Where the face stands out (plus) or in, of the left half: place, reach across, up and ahead, metres.
BUMPS: tuple[Bump, ...] = (
    ((0.0320, 1.6010, 0.0840), (0.0170, 0.0150, 0.0300), -0.0044),  # the socket
    ((0.0130, 1.6040, 0.0900), (0.0080, 0.0130, 0.0300), -0.0040),  # beside the bridge of the nose
    ((0.0260, 1.6290, 0.0860), (0.0160, 0.0080, 0.0300), 0.0012),  # the bone of the brow
    ((0.0480, 1.6240, 0.0700), (0.0130, 0.0110, 0.0300), 0.0018),  # its outer end
    ((0.0000, 1.6600, 0.0850), (0.0420, 0.0240, 0.0400), 0.0016),  # the forehead is round
    ((0.0500, 1.5790, 0.0560), (0.0190, 0.0120, 0.0280), 0.0020),  # the cheek bone
    ((0.0330, 1.5680, 0.0700), (0.0170, 0.0150, 0.0280), 0.0024),  # the apple of the cheek
    ((0.0460, 1.5440, 0.0440), (0.0180, 0.0160, 0.0300), -0.0016),  # below it
    ((0.0700, 1.6200, 0.0380), (0.0160, 0.0260, 0.0260), -0.0020),  # the temple
    ((0.0000, 1.5430, 0.0850), (0.0210, 0.0160, 0.0300), 0.0040),  # the teeth behind the lips
    ((0.0000, 1.5265, 0.0850), (0.0180, 0.0045, 0.0260), -0.0020),  # above the chin
    ((0.0000, 1.5140, 0.0800), (0.0140, 0.0085, 0.0300), 0.0026),  # the chin
    ((0.0000, 1.5570, 0.0950), (0.0034, 0.0080, 0.0200), -0.0010),  # the groove below the nose
)


def bumped(form: Field, bumps: tuple[Bump, ...]) -> Field:
    """Return a form that stands out by bumps: smooth hills over places of both sides."""

    def field(p: Array) -> Array:
        out = form(p)
        for at, reach, height in bumps:
            for side in (1.0, -1.0) if at[0] else (1.0,):
                away = (((p * [side, 1, 1] - np.array(at)) / np.array(reach)) ** 2).sum(1)
                out = out - height * np.exp(-away)
        return np.asarray(out)

    return field


def skull() -> Field:
    """The skull without the face."""
    return union(
        [
            ellipsoid((0, 1.6460, -0.0060), (0.0780, 0.0840, 0.0950)),
            ellipsoid((0, 1.6400, -0.0430), (0.0715, 0.0710, 0.0630)),
        ],
        0.030,
    )


def neck() -> Field:
    """The neck, with the muscles that run from behind the ears to the pit of the neck."""
    rod = union(
        [
            cone((0, 1.400, -0.042), (0, 1.470, -0.036), 0.0540, 0.0435),
            cone((0, 1.470, -0.036), (0, 1.560, -0.024), 0.0435, 0.0425),
        ],
        0.02,
    )
    slope = mirrored(cone((0.012, 1.535, -0.052), (0.046, 1.430, -0.048), 0.0240, 0.0270))
    strap = mirrored(cone((0.046, 1.560, -0.028), (0.014, 1.430, 0.000), 0.0110, 0.0090))
    return union([rod, strap, slope], 0.034)


def mask() -> Field:
    """The face below the brow: sections by height, from under the chin to the forehead."""
    rows = [  # height, half breadth, front, back, and where it is broadest
        (1.5041, 0.0250, 0.0810, 0.0280, 0.0510),
        (1.5084, 0.0315, 0.0840, 0.0220, 0.0480),
        (1.5170, 0.0385, 0.0865, 0.0110, 0.0400),
        (1.5273, 0.0450, 0.0870, -0.0020, 0.0300),
        (1.5402, 0.0515, 0.0875, -0.0160, 0.0180),
        (1.5560, 0.0568, 0.0880, -0.0240, 0.0120),
        (1.5740, 0.0622, 0.0880, -0.0300, 0.0100),
        (1.5920, 0.0660, 0.0865, -0.0400, 0.0080),
        (1.6100, 0.0688, 0.0865, -0.0500, 0.0040),
        (1.6300, 0.0705, 0.0885, -0.0500, 0.0000),
        (1.6500, 0.0690, 0.0870, -0.0500, -0.0040),
        (1.6700, 0.0620, 0.0790, -0.0500, -0.0060),
        (1.6900, 0.0480, 0.0600, -0.0500, -0.0060),
        (1.7050, 0.0200, 0.0200, -0.0300, -0.0060),
    ]
    up, left, ahead = np.eye(3)[[1, 0, 2]]
    sections = [(y, w, w, f - m, m - b, 0.0, m) for y, w, f, b, m in rows]
    chin = ellipsoid((0, 1.5105, 0.0610), (0.0270, 0.0145, 0.0245))
    return union([loft((0, 0, 0), (up, left, ahead), sections, 2.15), chin], 0.012)


def nose() -> Field:
    """Bridge, tip and wings, with nostrils."""
    form = union(
        [
            rods(
                [(0, 1.6120, 0.0815), (0, 1.5950, 0.0905), (0, 1.5780, 0.0990)],
                [0.0066, 0.0068, 0.0074],
                0.008,
            ),
            ellipsoid((0, 1.5740, 0.0995), (0.0092, 0.0080, 0.0085)),
            mirrored(ellipsoid((0.0092, 1.5714, 0.0885), (0.0064, 0.0066, 0.0100))),
            ellipsoid((0, 1.5680, 0.0940), (0.0050, 0.0050, 0.0080)),
        ],
        0.0105,
    )
    nostril = mirrored(ellipsoid((0.0066, 1.5652, 0.0930), (0.0034, 0.0040, 0.0056)))
    return without(form, nostril, 0.0030)


def ear() -> Field:
    """The left ear: a rim, an inner rim, a hollow and a lobe."""
    c, s = np.cos(0.50), np.sin(0.50)
    out, back = np.array([c, 0.0, -s]), np.array([-s * 0.4, 0.0, -1.0])  # it stands off the head behind
    back = back / np.linalg.norm(back)
    out = np.cross(back, [0.0, 1.0, 0.0])
    axes = np.stack([back, [0.0, 1.0, 0.0], out])
    at = np.array([0.0725, 1.5975, -0.0100])

    def along(points: list[tuple[float, float, float]], radii: list[float], k: float) -> Field:
        """A rod along a smooth line through points: back, up and out of the ear's middle, metres."""
        t, fine = np.arange(len(points)), np.linspace(0, len(points) - 1, 3 * len(points) - 2)
        line = np.stack([spline(t, np.array(points)[:, i], fine) for i in range(3)], 1)
        return rods(list(at + line @ axes), list(np.interp(fine, t, radii)), k)

    def lump(place: tuple[float, float, float], size: tuple[float, float, float]) -> Field:
        return ellipsoid(at + np.array(place) @ axes, size, axes)

    rim = along(
        [
            (-0.0060, 0.0020, 0.0000),
            (-0.0085, 0.0140, 0.0020),
            (-0.0030, 0.0240, 0.0045),
            (0.0070, 0.0265, 0.0062),
            (0.0150, 0.0190, 0.0072),
            (0.0160, 0.0060, 0.0070),
            (0.0110, -0.0080, 0.0050),
            (0.0040, -0.0180, 0.0030),
        ],
        [0.0020, 0.0025, 0.0027, 0.0027, 0.0027, 0.0026, 0.0026, 0.0026],
        0.002,
    )
    inner = along(
        [
            (0.0010, 0.0160, 0.0024),
            (0.0080, 0.0110, 0.0048),
            (0.0090, 0.0000, 0.0046),
            (0.0035, -0.0110, 0.0030),
        ],
        [0.0020, 0.0026, 0.0026, 0.0024],
        0.003,
    )
    plate = lump((0.0040, 0.0050, 0.0000), (0.0130, 0.0220, 0.0030))
    lobe = lump((0.0020, -0.0185, 0.0014), (0.0070, 0.0075, 0.0034))
    tragus = lump((-0.0075, -0.0030, 0.0020), (0.0034, 0.0052, 0.0030))
    form = union([union([plate, lobe, rim], 0.0050), inner, tragus], 0.0035)
    return without(form, lump((0.0010, -0.0010, 0.0040), (0.0050, 0.0078, 0.0046)), 0.0035)


def face_form(ears: bool = False) -> Field:
    """Head and neck without eyes and mouth."""
    form = union([skull(), mask()], 0.024)
    form = bumped(form, BUMPS)
    form = union([form, nose()], 0.0120)
    form = union([form, neck()], 0.020)
    return union([form, mirrored(ear())], 0.005) if ears else form


def front(field: Field, xy: Array) -> Array:
    """Return where a form's surface is in front of the head's middle: z `[N]`, metres, for `xy [N, 2]`."""
    low, high = np.zeros(len(xy)), np.full(len(xy), 0.14)
    for _ in range(26):
        middle = (low + high) / 2
        inside = field(np.concatenate([xy, middle[:, None]], 1)) < 0
        low, high = np.where(inside, middle, low), np.where(inside, high, middle)
    return np.asarray(low)
