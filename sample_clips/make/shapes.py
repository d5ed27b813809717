"""The mannequin's forms as distance fields on its skeleton's joints: head, hair, hands, sweater, trousers,
shoes.

`JOINT` are the joints' places in the rest pose (metres). The figure is 1.72 m tall, faces +Z, its left is at
+X. Left-hand parts are made at x > 0 and mirrored.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

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
    without,
)

Array = NDArray[Any]

SKELETON = mannequin_skeleton()
JOINT: dict[str, Array] = dict(zip(SKELETON.names, SKELETON.globals(SKELETON.rest)[1], strict=True))

EYE_RADIUS = 0.0154
LID_RADIUS = 0.0165
MOUTH_Y, MOUTH_HALF = 1.5415, 0.0215  # the line between the lips and half its width


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
    return np.asarray(MOUTH_Y + 0.0007 * np.minimum(np.abs(x) / MOUTH_HALF, 1.3) ** 2)


# --- head


def _skull() -> Field:
    return ellipsoid((0, 1.634, -0.008), (0.0745, 0.0855, 0.0955))


def _mouth_slit(p: Array) -> Array:
    """The gap between the lips and a shallow pocket behind it."""
    across = np.maximum(np.abs(p[:, 0]) - MOUTH_HALF, 0)
    gap = np.hypot(np.abs(p[:, 1] - mouth_line(p[:, 0])), across) - 0.0009
    gap = np.maximum(gap, 0.066 - p[:, 2])
    pocket = ellipsoid((0, MOUTH_Y + 0.001, 0.058), (0.018, 0.0060, 0.0150))(p)
    return np.asarray(np.minimum(gap, pocket))


def face_form() -> Field:
    """Head and neck without eyes, mouth opening and ears."""
    form = union(
        [
            _skull(),
            ellipsoid((0, 1.577, 0.024), (0.0580, 0.0740, 0.0610)),  # the mask of the face
            ellipsoid((0, 1.5165, 0.0620), (0.0200, 0.0150, 0.0190)),  # chin
            mirrored(cone((0.046, 1.556, 0.002), (0.013, 1.513, 0.058), 0.0140, 0.0130)),  # jaw
            mirrored(ellipsoid((0.0340, 1.5700, 0.0570), (0.0230, 0.0230, 0.0215))),  # cheeks
        ],
        0.034,
    )
    form = without(
        form,
        mirrored(ellipsoid(JOINT["LeftEye"] + [0.0010, 0.0010, 0.0220], (0.0210, 0.0140, 0.0140))),
        0.018,
    )
    nose = union(
        [
            cone((0, 1.6100, 0.0835), (0, 1.5765, 0.1005), 0.0046, 0.0078),
            ellipsoid((0, 1.5735, 0.1005), (0.0088, 0.0080, 0.0082)),
            mirrored(ellipsoid((0.0088, 1.5700, 0.0925), (0.0060, 0.0055, 0.0072))),
        ],
        0.012,
    )
    form = union([form, nose], 0.014)
    neck = union(
        [
            cone((0, 1.395, -0.034), (0, 1.460, -0.025), 0.056, 0.0420),
            cone((0, 1.460, -0.025), (0, 1.550, -0.012), 0.0420, 0.0410),
        ],
        0.02,
    )
    return union([form, neck], 0.024)


def front(field: Field, x: float, y: float) -> float:
    """Where a form's surface is in front of the head's middle, z in metres."""
    low, high = 0.0, 0.14
    for _ in range(24):
        middle = (low + high) / 2
        low, high = (middle, high) if field(np.array([[x, y, middle]]))[0] < 0 else (low, middle)
    return low


def head() -> Field:
    form = face_form()

    def lip(points: list[tuple[float, float]], radii: list[float], out: float) -> Field:
        """A rod along (x, y) points, standing `out` metres out of the face."""
        return mirrored(
            rods(
                [(x, y, front(form, x, y) - r + out) for (x, y), r in zip(points, radii, strict=True)],
                radii,
                0.002,
            )
        )

    lips = union(
        [
            lip([(0.0, 1.5468), (0.0070, 1.5474), (0.0205, 1.5460)], [0.0050, 0.0050, 0.0030], 0.0022),
            lip([(0.0, 1.5358), (0.0090, 1.5366), (0.0205, 1.5444)], [0.0058, 0.0054, 0.0030], 0.0024),
        ],
        0.005,
    )
    face = union([form, lips], 0.006)
    ear = without(
        ellipsoid((0.0770, 1.5965, -0.013), (0.0080, 0.0270, 0.0170), _turned(0.32, -0.10)),
        ellipsoid((0.0860, 1.5985, -0.008), (0.0055, 0.0165, 0.0090), _turned(0.32, -0.10)),
        0.008,
    )
    face = union([face, mirrored(ear)], 0.008)
    # The lids' shells come through the face: their crease is cut by the depth buffer, crisper than by
    # triangles.
    return without(face, _mouth_slit, 0.003)


def hair() -> Field:
    """A short cap, fuller over the forehead."""
    cap = union(
        [
            ellipsoid((0, 1.6400, -0.0160), (0.0815, 0.0910, 0.0965)),
            ellipsoid((0.010, 1.6980, 0.0360), (0.0560, 0.0330, 0.0540), _turned(0.0, 0.12, -0.20)),
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
COLLAR_AT, COLLAR_UP = np.array([0, 1.4500, -0.0260]), np.array([0, 0.966, 0.259])


def torso() -> Field:
    return union(
        [
            ellipsoid((0, 1.285, -0.014), (0.143, 0.165, 0.096)),
            cone((-0.122, 1.374, -0.030), (0.122, 1.374, -0.030), 0.052, 0.052),
            mirrored(cone((0.0, 1.440, -0.030), (0.130, 1.396, -0.030), 0.048, 0.040)),
            mirrored(ellipsoid((0.060, 1.300, 0.028), (0.070, 0.062, 0.044))),
            ellipsoid((0, 1.120, -0.006), (0.124, 0.170, 0.088)),
            ellipsoid((0, 0.930, -0.004), (0.160, 0.150, 0.108)),
        ],
        0.075,
    )


def forearm() -> Field:
    return cone(JOINT["LeftLowerArm"], JOINT["LeftHand"] + ARM * 0.03, 0.0410, 0.0325)


def sleeve(end: Array = CUFF) -> Field:
    """The left one, to a point on the arm. Its elbow stands out behind: skinning flattens what is bent."""
    upper = cone(JOINT["LeftUpperArm"] + ARM * 0.004, JOINT["LeftLowerArm"], 0.0515, 0.0410)
    elbow = ellipsoid(JOINT["LeftLowerArm"] + [0, 0, -0.0095], (0.0390, 0.0390, 0.0370))
    arm = union([union([upper, forearm()], 0.008), elbow], 0.016)
    return common(arm, plane(end, ARM), 0.004)


def sweater() -> Field:
    body = common(torso(), plane((0, HEM, 0), (0, -1, 0)), 0.012)
    body = common(body, plane(COLLAR_AT + COLLAR_UP * 0.002, COLLAR_UP), 0.004)
    return union([body, mirrored(sleeve())], 0.050)


def pelvis() -> Field:
    body = union(
        [
            ellipsoid((0, 0.965, -0.004), (0.132, 0.100, 0.092)),
            mirrored(ellipsoid((0.064, 0.900, -0.036), (0.070, 0.075, 0.062))),
        ],
        0.05,
    )
    return common(body, plane((0, WAIST, 0), (0, 1, 0)), 0.01)


def leg() -> Field:
    hip, knee, ankle = JOINT["LeftUpperLeg"], JOINT["LeftLowerLeg"], JOINT["LeftFoot"]
    rod = rods(
        [hip + [-0.008, 0.0, 0.0], knee + [0, 0, 0.002], ankle + [0, -0.03, 0.004]],
        [0.0770, 0.0560, 0.0450],
        0.010,
    )
    calf = ellipsoid(knee * 0.70 + ankle * 0.30 + [0.002, 0, -0.010], (0.050, 0.130, 0.053))
    return common(union([rod, calf], 0.03), plane((0, 0.080, 0), (0, -1, 0.10)), 0.006)


def trousers() -> Field:
    one = leg()
    hips = pelvis()

    def field(p: Array) -> Array:
        body, left, right = hips(p), one(p), one(p * [-1, 1, 1])
        joined = [union([lambda _, d=body: d, lambda _, d=side: d], 0.045)(p) for side in (left, right)]
        return np.asarray(union([lambda _: joined[0], lambda _: joined[1]], 0.012)(p))

    return field


def _last(p: Array) -> Array:
    """The foot's form, floor not yet cut."""
    ankle = JOINT["LeftFoot"]
    return union(
        [
            cone((0.102, 0.110, -0.026), (0.102, 0.060, -0.030), 0.0400, 0.0400),
            cone((0.102, 0.038, -0.042), (0.106, 0.034, 0.080), 0.0370, 0.0420),
            cone((0.106, 0.030, 0.085), (0.111, 0.020, 0.136), 0.0420, 0.0350, flat=(1, 1.1, 1)),
            cone(ankle + [0, -0.010, 0.02], (0.107, 0.042, 0.085), 0.0340, 0.0280),
        ],
        0.030,
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
    ear = np.linalg.norm((q - [0.078, 1.5965, -0.013]) / [0.02, 0.034, 0.026], axis=1)
    out = 0.0108 + 0.009 * step(0.03, -0.05, p[:, 2])
    for near, fine in ((mouth, 0.0031), (eye, 0.0070), (nose, 0.0052), (ear, 0.0070)):
        out = np.minimum(out, fine + (0.0108 - fine) * step(0.9, 2.8, near))
    return np.asarray(out)


def _palm_size(p: Array) -> Array:
    along = (p - JOINT["LeftHand"]) @ ARM
    return np.asarray(0.0088 + 0.0040 * step(0.04, 0.0, along))


def elbow_size(p: Array, elsewhere: float) -> Array:
    """So many rings round an elbow that it is round when it is bent."""
    away = np.stack([np.abs(p[:, 0]), p[:, 1], p[:, 2]], 1) - JOINT["LeftLowerArm"]
    along = np.abs(away @ ARM) + 4 * np.maximum(np.linalg.norm(away, axis=1) - 0.09, 0)
    return np.asarray(elsewhere - (elsewhere - 0.0125) * step(0.085, 0.040, along))


def _sweater_size(p: Array) -> Array:
    shoulder = JOINT["LeftUpperArm"]
    q = np.stack([np.abs(p[:, 0]), p[:, 1], p[:, 2]], 1)
    edge = np.minimum(np.abs((q - CUFF) @ ARM) / 0.03, np.abs(p[:, 1] - HEM) / 0.03)
    edge = np.minimum(edge, np.linalg.norm((q - COLLAR_AT) / [0.07, 0.03, 0.07], axis=1))
    out = 0.0320 - 0.0135 * step(1.2, 0.5, np.linalg.norm(q - shoulder, axis=1) / 0.09)
    out = np.minimum(out, elbow_size(p, 0.0320))
    return np.asarray(out - (out - 0.0165) * step(1.2, 0.6, edge))


def _trouser_size(p: Array) -> Array:
    q = np.stack([np.abs(p[:, 0]), p[:, 1], p[:, 2]], 1)
    knee = np.linalg.norm(q - JOINT["LeftLowerLeg"], axis=1) / 0.09
    crotch = np.linalg.norm((q - [0, 0.84, 0]) / [0.05, 0.06, 0.12], axis=1)
    return np.asarray(0.0340 - 0.0160 * step(1.1, 0.6, knee) - 0.012 * step(1.3, 0.6, crotch))


def _shoe_size(p: Array) -> Array:
    return np.full(len(p), 0.0170)


def _hair_size(p: Array) -> Array:
    edge = np.abs(_hairline(p))
    return np.asarray(0.0085 + 0.0060 * step(0.006, 0.030, edge))


PARTS: tuple[Part, ...] = (
    Part("head", head(), (-0.100, 1.405, -0.115), (0.100, 1.735, 0.120), 0.0016, _head_size),
    Part("hair", hair(), (-0.095, 1.510, -0.125), (0.095, 1.750, 0.110), 0.0035, _hair_size),
    Part("palm", palm(), (0.490, 0.900, -0.095), (0.670, 1.110, 0.045), 0.0025, _palm_size),
    Part("sweater", sweater(), (-0.580, 0.900, -0.140), (0.580, 1.480, 0.130), 0.0055, _sweater_size),
    Part("trousers", trousers(), (-0.210, 0.060, -0.135), (0.210, 1.010, 0.130), 0.0065, _trouser_size),
    Part("shoe", shoe(), (0.045, -0.010, -0.100), (0.170, 0.140, 0.185), 0.0035, _shoe_size),
)
