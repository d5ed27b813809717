"""The mannequin's forms as distance fields on its skeleton's joints: head, hair, hands, sweater, trousers,
shoes.

Measures of the body are about the means of ANSUR II (Gordon and others, 2014), rounded to the centimetre and
scaled to the skeleton's 1.72 m: waist breadth 0.30 m, hip breadth 0.36, biacromial breadth 0.39; round the
neck 0.35, the thigh 0.64 and the calf 0.39; foot length 0.26; and some millimetres of cloth. Shoulders slope
by about 20 degrees from the neck.

`JOINT` are the joints' places in the rest pose (metres). The figure is 1.72 m tall, faces +Z, its left is at
+X. Left-hand parts are made at x > 0 and mirrored.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sample_clips.make.default_body.forms import foot, loft
from sample_clips.make.face import face_form
from sample_clips.make.folds import body_folds, sleeve_folds, trouser_folds
from sample_clips.make.mannequin_skeleton import ARM, FINGERS, mannequin_skeleton
from sample_clips.make.sculpt import (
    Field,
    common,
    cone,
    ellipsoid,
    mirrored,
    plane,
    rods,
    smooth_min,
    union,
)

Array = NDArray[Any]

SKELETON = mannequin_skeleton()
JOINT: dict[str, Array] = dict(zip(SKELETON.names, SKELETON.globals(SKELETON.rest)[1], strict=True))

EYE_RADIUS = 0.0166
MOUTH_Y, MOUTH_HALF = 1.5415, 0.0225  # the line between the lips and half its width


@dataclass(frozen=True)
class Part:
    """A field, the box and cell it is sampled with, and the edge length wanted at points."""

    name: str
    field: Field
    low: tuple[float, float, float]
    high: tuple[float, float, float]
    cell: float
    size: Callable[[Array], Array]


def step(low: float, high: float, x: Array) -> Array:
    """0 below `low`, 1 above `high`, smooth between; `low` may be the greater."""
    t = np.clip((np.asarray(x, float) - low) / (high - low), 0, 1)
    return np.asarray(t * t * (3 - 2 * t))


def mouth_line(x: Array) -> Array:
    """Height of the line between the lips: level, except for corners a hair above; a mood makes the smile."""
    return np.asarray(MOUTH_Y + 0.0019 * np.minimum(np.abs(x) / MOUTH_HALF, 1.3) ** 2)


# --- head


def head() -> Field:
    return face_form(ears=True)


def hair() -> Field:
    """A short cap, fuller over the forehead."""
    cap = union(
        [
            ellipsoid((0, 1.6470, -0.0140), (0.0830, 0.0900, 0.1000)),
            ellipsoid((0.010, 1.7020, 0.0330), (0.0560, 0.0340, 0.0560), _turned(0.0, 0.12, -0.20)),
        ],
        0.030,
    )
    return common(cap, _hairline, 0.009)


def _hairline(p: Array) -> Array:
    """From the forehead past the temple, in front of the ear and down to the nape: positive if there is no
    hair.
    """
    forehead, temple = (
        plane((0, 1.6730, 0.078), (0, -0.45, 1.0))(p),
        plane((0, 1.60, 0.010), (0, 0.10, 1.0))(p),
    )
    nape = plane((0, 1.5600, -0.060), (0, -1.0, 0.62))(p)
    return -smooth_min(-smooth_min(forehead, temple, 0.020), -nape, 0.020)


def _turned(yaw: float, roll: float = 0.0, pitch: float = 0.0) -> Array:
    """Rows are axes turned about Y, then Z, then X (radians)."""
    cy, sy, cr, sr, cp, sp = (
        np.cos(yaw),
        np.sin(yaw),
        np.cos(roll),
        np.sin(roll),
        np.cos(pitch),
        np.sin(pitch),
    )
    y = np.array([[cy, 0, -sy], [0, 1, 0], [sy, 0, cy]])
    z = np.array([[cr, sr, 0], [-sr, cr, 0], [0, 0, 1]])
    x = np.array([[1, 0, 0], [0, cp, sp], [0, -sp, cp]])
    return np.asarray(x @ z @ y)


# --- hands (left)

PALM_UP = np.array([np.sin(np.arccos(ARM[0])), ARM[0], 0.0])  # the back of the left hand
_RADII = {
    "Thumb": (0.0132, 0.0100, 0.0092, 0.0078),
    "Index": (0.0096, 0.0086, 0.0078, 0.0066),
    "Middle": (0.0098, 0.0088, 0.0080, 0.0068),
    "Ring": (0.0095, 0.0084, 0.0076, 0.0064),
    "Little": (0.0086, 0.0074, 0.0067, 0.0057),
}


def finger_points(finger: str) -> Array:
    """The three joints and the tip of a left finger `[4, 3]`."""
    j = [JOINT[f"Left{finger}{i}"] for i in (1, 2, 3)]
    last = (j[2] - j[1]) / np.linalg.norm(j[2] - j[1])
    length = 0.024 if finger == "Thumb" else 0.018 if finger == "Little" else 0.0205
    return np.stack([*j, j[2] + last * (length - _RADII[finger][3])])


def finger_radius(finger: str) -> float:
    """At the tip, metres."""
    return _RADII[finger][3]


def palm() -> Field:
    wrist = JOINT["LeftHand"]
    bones: list[Field] = []
    for finger in FINGERS[1:]:
        end = finger_points(finger)[0]
        start = wrist + ARM * 0.012 + (end - wrist) * [0, 0, 0.55]
        bones.append(cone(start, end - PALM_UP * 0.001, 0.0130, 0.0108))
    heel = ellipsoid(
        wrist + ARM * 0.040 - PALM_UP * 0.004, (0.036, 0.0135, 0.026), np.stack([ARM, PALM_UP, [0, 0, 1]])
    )
    thenar = cone(
        wrist + ARM * 0.012 + np.array([0, 0, 0.010]) - PALM_UP * 0.004,
        finger_points("Thumb")[0],
        0.0140,
        0.0132,
    )
    little = cone(
        wrist + ARM * 0.018 + np.array([0, 0, -0.020]),
        wrist + ARM * 0.064 + np.array([0, 0, -0.030]),
        0.0115,
        0.0100,
    )
    wrist_rod = cone(wrist - ARM * 0.060, wrist + ARM * 0.006, 0.0225, 0.0205, flat=(1, 1.12, 0.94))
    return union([union([*bones, heel, little], 0.012), thenar, wrist_rod], 0.020)


def finger(name: str) -> Field:
    return rods(list(finger_points(name)), list(_RADII[name]), 0.0)


def hand() -> Field:
    base = palm()
    fingers = [finger(name) for name in FINGERS]

    def field(p: Array) -> Array:
        flat = base(p)
        # Each finger grows out of the palm smoothly, but no web grows between two fingers.
        joined = [
            union([lambda _, d=flat: d, f], 0.014 if i == 0 else 0.009)(p) for i, f in enumerate(fingers)
        ]
        return np.asarray(np.min(joined, axis=0))

    return field


# --- clothes

WAIST, HEM = 0.985, 0.912
CUFF = JOINT["LeftHand"] - ARM * 0.008
COLLAR_AT, COLLAR_UP = np.array([0, 1.4560, -0.0290]), np.array([0, 0.966, 0.259])


def torso() -> Field:
    """The trunk in a sweater, from the seat to the pit of the neck."""
    rows = [  # height, half breadth, depth ahead and behind of the middle, and where that is
        (0.780, 0.150, 0.088, 0.100, -0.004),
        (0.840, 0.178, 0.110, 0.124, -0.006),
        (0.900, 0.184, 0.114, 0.126, -0.006),
        (0.950, 0.181, 0.112, 0.122, -0.005),
        (1.000, 0.168, 0.106, 0.110, -0.004),
        (1.060, 0.151, 0.099, 0.095, -0.003),
        (1.120, 0.141, 0.095, 0.087, -0.005),
        (1.180, 0.142, 0.096, 0.090, -0.009),
        (1.240, 0.151, 0.101, 0.098, -0.014),
        (1.300, 0.158, 0.105, 0.104, -0.019),
        (1.350, 0.156, 0.099, 0.103, -0.024),
        (1.390, 0.142, 0.084, 0.096, -0.028),
        (1.425, 0.110, 0.068, 0.082, -0.031),
        (1.455, 0.072, 0.056, 0.064, -0.033),
        (1.480, 0.052, 0.046, 0.050, -0.034),
    ]
    up, left, ahead = np.eye(3)[[1, 0, 2]]
    body = loft((0, 0, 0), (up, left, ahead), [(y, w, w, f, b, 0.0, m) for y, w, f, b, m in rows], 2.3)
    slope = mirrored(cone((0.034, 1.456, -0.046), (0.150, 1.402, -0.034), 0.0290, 0.0300))
    chest = mirrored(ellipsoid((0.070, 1.310, 0.040), (0.072, 0.058, 0.046)))
    blade = mirrored(ellipsoid((0.080, 1.330, -0.088), (0.060, 0.085, 0.036)))
    return union([union([body, chest, blade], 0.045), slope], 0.040)


def forearm() -> Field:
    elbow, wrist = JOINT["LeftLowerArm"], JOINT["LeftHand"] + ARM * 0.03
    rod = cone(elbow, wrist, 0.0390, 0.0310)
    return union([rod, ellipsoid(elbow + ARM * 0.070, (0.0420, 0.0420, 0.0410))], 0.020)


def sleeve(end: Array = CUFF) -> Field:
    """The left one, to a point on the arm. Its elbow stands out behind: skinning flattens what is bent."""
    start = JOINT["LeftUpperArm"] + [-0.004, -0.0075, 0.0]
    upper = union(
        [
            cone(start, JOINT["LeftLowerArm"], 0.0470, 0.0400),
            ellipsoid(start + ARM * 0.055, (0.0520, 0.0520, 0.0500)),
        ],
        0.020,
    )
    elbow = ellipsoid(JOINT["LeftLowerArm"] + [0, 0, -0.0095], (0.0385, 0.0385, 0.0370))
    arm = union([union([upper, forearm()], 0.008), elbow], 0.016)
    return common(arm, plane(end, ARM), 0.004)


def folded(cloth: Field, *folds: Callable[[Array], Array]) -> Field:
    """Return cloth with folds."""
    return lambda p: np.asarray(cloth(p) - sum(f(p) for f in folds))


def sweater(end: Array = CUFF, hem: float = HEM, bust: float = 0.0) -> Field:
    """A knitted sweater. end: of its left sleeve. hem: its height. bust: metres it stands out in front."""
    body = torso()
    if bust:
        breast = mirrored(ellipsoid((0.066, 1.280, 0.052), (0.062, 0.066, 0.040 + bust)))
        body = union([body, breast], 0.060)
    body = common(body, plane((0, hem, 0), (0, -1, 0)), 0.012)
    body = common(body, plane(COLLAR_AT + COLLAR_UP * 0.002, COLLAR_UP), 0.004)
    whole = union([body, mirrored(sleeve(end))], 0.044)
    return folded(whole, sleeve_folds, lambda p: body_folds(p, hem))


def pelvis() -> Field:
    rows = [  # height, half breadth, depth ahead and behind of the middle
        (0.840, 0.120, 0.070, 0.080),
        (0.880, 0.158, 0.092, 0.104),
        (0.920, 0.165, 0.097, 0.108),
        (0.960, 0.158, 0.095, 0.100),
        (1.000, 0.146, 0.090, 0.090),
        (1.030, 0.138, 0.086, 0.084),
    ]
    up, left, ahead = np.eye(3)[[1, 0, 2]]
    body = loft((0, 0, 0), (up, left, ahead), [(y, w, w, f, b, 0.0, -0.005) for y, w, f, b in rows], 2.3)
    seat = mirrored(ellipsoid((0.070, 0.895, -0.052), (0.076, 0.074, 0.062)))
    return common(union([body, seat], 0.05), plane((0, WAIST, 0), (0, 1, 0)), 0.01)


def leg() -> Field:
    """The left leg in trousers."""
    rows = [  # height, outwards, inwards, ahead, behind of the middle, and where that is, across and ahead
        (0.070, 0.047, 0.047, 0.052, 0.054, 0.1030, -0.014),
        (0.150, 0.048, 0.047, 0.050, 0.057, 0.1020, -0.018),
        (0.250, 0.053, 0.051, 0.051, 0.064, 0.1010, -0.019),
        (0.330, 0.058, 0.055, 0.053, 0.071, 0.1000, -0.017),
        (0.390, 0.059, 0.056, 0.054, 0.071, 0.1000, -0.013),
        (0.450, 0.058, 0.055, 0.057, 0.063, 0.0990, -0.006),
        (0.500, 0.058, 0.055, 0.061, 0.058, 0.0980, 0.002),
        (0.560, 0.062, 0.059, 0.065, 0.064, 0.0970, 0.003),
        (0.640, 0.071, 0.068, 0.074, 0.076, 0.0960, 0.002),
        (0.720, 0.080, 0.076, 0.082, 0.086, 0.0950, 0.000),
        (0.800, 0.087, 0.081, 0.089, 0.095, 0.0930, -0.002),
        (0.860, 0.089, 0.082, 0.092, 0.100, 0.0910, -0.004),
        (0.915, 0.083, 0.075, 0.086, 0.096, 0.0880, -0.006),
        (0.960, 0.069, 0.060, 0.072, 0.080, 0.0850, -0.006),
    ]
    up, left, ahead = np.eye(3)[[1, 0, 2]]
    return common(loft((0, 0, 0), (up, left, ahead), rows, 2.1), plane((0, 0.080, 0), (0, -1, 0.10)), 0.006)


def trousers() -> Field:
    one = leg()
    hips = pelvis()

    def field(p: Array) -> Array:
        body, left, right = hips(p), one(p), one(p * [-1, 1, 1])
        joined = [union([lambda _, d=body: d, lambda _, d=side: d], 0.045)(p) for side in (left, right)]
        return np.asarray(union([lambda _: joined[0], lambda _: joined[1]], 0.012)(p))

    return folded(field, trouser_folds)


def _last(p: Array) -> Array:
    """The foot's form in its shoe, floor not yet cut."""
    return union(
        [
            lambda q: foot()(q - [0.006, 0.004, 0.0]) - 0.0045,
            cone((0.102, 0.122, -0.030), (0.102, 0.070, -0.032), 0.0385, 0.0370),
        ],
        0.024,
    )(p)


def shoe() -> Field:
    cut = plane((0, 0.010, 0), (0, -1, 0))
    body = common(_last, cut, 0.006)
    return common(body, plane((0.102, 0.118, -0.026), (0, 1, 0)), 0.004)


def sole_outline(p: Array) -> Array:
    """The shoe's outline seen from above, whatever the height of `p`."""
    return _last(np.stack([p[:, 0], np.full(len(p), 0.026), p[:, 2]], 1))


# --- the parts and how finely each is made


def _head_size(p: Array) -> Array:
    """Fine round mouth, eyes and nose, coarser towards the back."""
    q = np.stack([np.abs(p[:, 0]), p[:, 1], p[:, 2]], 1)
    mouth = np.linalg.norm((q - [0, MOUTH_Y, 0.082]) / [0.028, 0.013, 0.020], axis=1)
    eye = np.linalg.norm(q - JOINT["LeftEye"], axis=1) / 0.022
    nose = np.linalg.norm((q - [0, 1.573, 0.097]) / [0.017, 0.014, 0.02], axis=1)
    ear = np.linalg.norm((q - [0.074, 1.5975, -0.012]) / [0.014, 0.026, 0.020], axis=1)
    out = 0.0115 + 0.009 * step(0.03, -0.05, p[:, 2])
    for near, fine in ((mouth, 0.0050), (eye, 0.0052), (nose, 0.0040), (ear, 0.0042)):
        out = np.minimum(out, fine + (0.0124 - fine) * step(0.9, 2.8, near))
    return np.asarray(out)


def _palm_size(p: Array) -> Array:
    along = (p - JOINT["LeftHand"]) @ ARM
    return np.asarray(0.0088 + 0.0040 * step(0.04, 0.0, along))


def elbow_size(p: Array, elsewhere: float) -> Array:
    """So many rings round an elbow that it is round when it is bent."""
    away = np.stack([np.abs(p[:, 0]), p[:, 1], p[:, 2]], 1) - JOINT["LeftLowerArm"]
    along = np.abs(away @ ARM) + 4 * np.maximum(np.linalg.norm(away, axis=1) - 0.09, 0)
    return np.asarray(elsewhere - (elsewhere - 0.0125) * step(0.085, 0.040, along))


def sweater_size(p: Array) -> Array:
    """Fine where it folds: over the hem, at armpits, elbows and cuffs."""
    shoulder = JOINT["LeftUpperArm"]
    q = np.stack([np.abs(p[:, 0]), p[:, 1], p[:, 2]], 1)
    edge = np.minimum(np.abs((q - CUFF) @ ARM) / 0.03, np.abs(p[:, 1] - HEM) / 0.03)
    edge = np.minimum(edge, np.linalg.norm((q - COLLAR_AT) / [0.07, 0.03, 0.07], axis=1))
    out = 0.0290 - 0.0125 * step(1.2, 0.5, np.linalg.norm(q - shoulder, axis=1) / 0.10)
    chest = np.linalg.norm((q - [0.065, 1.275, 0.10]) / [0.08, 0.08, 0.08], axis=1)
    out = np.minimum(out, 0.0290 - 0.0090 * step(1.2, 0.7, chest))
    out = np.minimum(out, elbow_size(p, 0.0290))
    folds = np.exp(-(((p[:, 1] - HEM - 0.055) / 0.050) ** 2)) + 0.8 * np.exp(
        -(np.linalg.norm((q - [0.120, 1.285, 0.0]) / [0.05, 0.07, 0.12], axis=1) ** 2)
    )
    out = out - (out - 0.0150) * np.clip(folds * (q[:, 0] < 0.22), 0, 1)
    return np.asarray(out - (out - 0.0165) * step(1.2, 0.6, edge))


def _trouser_size(p: Array) -> Array:
    q = np.stack([np.abs(p[:, 0]), p[:, 1], p[:, 2]], 1)
    knee = np.abs(p[:, 1] - JOINT["LeftLowerLeg"][1]) / 0.10
    crotch = np.linalg.norm((q - [0.04, 0.85, 0.02]) / [0.09, 0.06, 0.12], axis=1)
    shoe = np.abs(p[:, 1] - 0.125) / 0.06
    fold = np.maximum(np.maximum(step(1.1, 0.5, knee), step(1.3, 0.6, crotch)), step(1.2, 0.6, shoe))
    return np.asarray(0.0330 - 0.0165 * fold)


def _shoe_size(p: Array) -> Array:
    return np.full(len(p), 0.0150)


def _hair_size(p: Array) -> Array:
    edge = np.abs(_hairline(p))
    return np.asarray(0.0085 + 0.0060 * step(0.006, 0.030, edge))


PARTS: tuple[Part, ...] = (
    Part("head", head(), (-0.100, 1.405, -0.120), (0.100, 1.740, 0.120), 0.0020, _head_size),
    Part("hair", hair(), (-0.095, 1.510, -0.125), (0.095, 1.750, 0.110), 0.0035, _hair_size),
    Part("palm", palm(), (0.490, 0.900, -0.095), (0.670, 1.110, 0.045), 0.0025, _palm_size),
    Part("sweater", sweater(), (-0.580, 0.890, -0.150), (0.580, 1.490, 0.140), 0.0055, sweater_size),
    Part("trousers", trousers(), (-0.210, 0.060, -0.145), (0.210, 1.010, 0.130), 0.0065, _trouser_size),
    Part("shoe", shoe(), (0.045, -0.010, -0.100), (0.170, 0.140, 0.185), 0.0035, _shoe_size),
)
