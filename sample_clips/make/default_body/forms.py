"""The forms of the default body as distance fields: what artists call a mannequin, without a face.

Sections of trunk and limbs are our own, by eye, about the breadths of ANSUR II's means (hip breadth 0.34 m,
waist 0.30, chest 0.32, biacromial 0.40, head 0.152 x 0.197 m) on a body of 1.75 m.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sample_clips.make.default_body.joints import (
    ARM,
    ELBOW,
    FOREARM,
    HAND,
    KNUCKLES,
    SHOULDER,
    THUMB_SIDE,
    WRIST,
    finger_points,
)
from sample_clips.make.sculpt import (
    Field,
    common,
    cone,
    ellipsoid,
    mirrored,
    plane,
    smooth_min,
    union,
    without,
)

Array = NDArray[Any]

UP = np.array([0.0, 1.0, 0.0])
LEFT = np.array([1.0, 0.0, 0.0])
AHEAD = np.array([0.0, 0.0, 1.0])


def loft(
    start: Sequence[float] | Array,
    axes: Sequence[Array],
    sections: Sequence[Sequence[float]],
    power: float = 2.0,
) -> Field:
    """A form through cross-sections. axes: along, and the two directions across. sections: rows of how far
    along, how far the form reaches in the first direction and against it, in the second and against it, and
    its middle in both, all in metres. power: 2 for ellipses, more for squarer sections.
    """
    along, u, v = (np.asarray(a, float) / np.linalg.norm(a) for a in axes)
    rows = np.array(sections, float)
    fine = np.linspace(rows[0, 0], rows[-1, 0], 240)
    table = np.stack([spline(rows[:, 0], rows[:, k], fine) for k in range(1, 7)], 1)

    def field(p: Array) -> Array:
        q = p - np.asarray(start, float)
        t = q @ along
        up, un, vp, vn, mu, mv = (np.interp(t, fine, table[:, k]) for k in range(6))
        x, y = q @ u - mu, q @ v - mv
        away = np.hypot(x, y)
        share = (
            np.abs(x / np.where(x > 0, up, un)) ** power + np.abs(y / np.where(y > 0, vp, vn)) ** power
        ) ** (1 / power)
        radius = np.where(away > 1e-9, away / np.maximum(share, 1e-9), np.minimum(up, vp))
        side = away - radius
        beyond = np.maximum(np.maximum(fine[0] - t, t - fine[-1]), 0)
        return np.asarray(
            np.hypot(np.maximum(side, 0), beyond) + np.where(beyond > 0, 0, np.minimum(side, 0))
        )

    return field


def spline(x: Array, y: Array, at: Array) -> Array:
    """Return the natural cubic spline through points, `[N]`."""
    h, count = np.diff(x), len(x)
    system, right = np.eye(count), np.zeros(count)
    for i in range(1, count - 1):
        system[i, i - 1 : i + 2] = h[i - 1], 2 * (h[i - 1] + h[i]), h[i]
        right[i] = 6 * ((y[i + 1] - y[i]) / h[i] - (y[i] - y[i - 1]) / h[i - 1])
    bend = np.linalg.solve(system, right)
    k = np.clip(np.searchsorted(x, at, "right") - 1, 0, count - 2)
    b = (at - x[k]) / h[k]
    a = 1 - b
    return np.asarray(
        a * y[k] + b * y[k + 1] + ((a**3 - a) * bend[k] + (b**3 - b) * bend[k + 1]) * h[k] ** 2 / 6
    )


def _round(*rows: Sequence[float]) -> list[tuple[float, ...]]:
    """Return sections that are alike on both sides: how far along, and the two half breadths."""
    return [(t, a, a, b, b, 0.0, 0.0) for t, a, b in rows]


def trunk() -> Field:
    """Pelvis to the base of the neck."""
    rows = [  # height, half breadth, depth ahead and behind, and its middle
        (0.835, 0.085, 0.060, 0.070, 0.000),
        (0.865, 0.128, 0.084, 0.094, -0.002),
        (0.900, 0.155, 0.096, 0.110, -0.004),
        (0.940, 0.166, 0.100, 0.113, -0.005),
        (0.985, 0.160, 0.099, 0.104, -0.004),
        (1.040, 0.142, 0.094, 0.088, -0.001),
        (1.095, 0.127, 0.088, 0.077, 0.002),
        (1.150, 0.128, 0.090, 0.080, -0.002),
        (1.210, 0.140, 0.098, 0.092, -0.009),
        (1.270, 0.154, 0.107, 0.102, -0.016),
        (1.330, 0.164, 0.110, 0.107, -0.022),
        (1.380, 0.161, 0.098, 0.103, -0.027),
        (1.420, 0.140, 0.078, 0.089, -0.031),
        (1.450, 0.110, 0.060, 0.074, -0.034),
        (1.480, 0.070, 0.050, 0.058, -0.036),
    ]
    body = loft((0, 0, 0), (UP, LEFT, AHEAD), [(y, a, a, f, b, 0.0, c) for y, a, f, b, c in rows], 2.3)
    chest = mirrored(ellipsoid((0.076, 1.322, 0.042), (0.080, 0.058, 0.052)))
    back = mirrored(ellipsoid((0.084, 1.345, -0.088), (0.066, 0.090, 0.042)))
    blade = mirrored(cone((0.062, 1.395, -0.112), (0.090, 1.310, -0.110), 0.014, 0.016))
    side = mirrored(cone((0.128, 1.340, -0.056), (0.104, 1.190, -0.050), 0.040, 0.028))
    seat = mirrored(ellipsoid((0.078, 0.895, -0.060), (0.078, 0.080, 0.066)))
    crest = mirrored(cone((0.118, 1.010, 0.044), (0.060, 0.935, 0.078), 0.022, 0.018))
    trapezius = mirrored(cone((0.020, 1.520, -0.046), (0.160, 1.450, -0.036), 0.036, 0.031))
    collar = mirrored(cone((0.020, 1.442, 0.020), (0.150, 1.452, -0.022), 0.022, 0.024))
    out = union([body, chest], 0.034)
    out = union([out, back, blade, side, seat, crest], 0.046)
    out = union([out, trapezius, collar], 0.045)
    furrow = cone((0.0, 1.400, -0.1425), (0.0, 1.080, -0.0905), 0.008, 0.008)
    middle = cone((0.0, 1.360, 0.1010), (0.0, 1.110, 0.1000), 0.007, 0.007)
    return without(without(out, furrow, 0.040), middle, 0.034)


def neck() -> Field:
    return loft(
        (0.0, 1.445, -0.048),
        ((0.0, 1.0, 0.20), LEFT, (0.0, -0.20, 1.0)),
        _round((0.0, 0.068, 0.062), (0.05, 0.058, 0.058), (0.10, 0.054, 0.056), (0.20, 0.054, 0.058)),
    )


def arm() -> Field:
    """From the shoulder to the wrist."""
    out = np.cross(AHEAD, ARM)  # away from the body
    upper = loft(
        SHOULDER,
        (ARM, AHEAD, out),
        [
            (-0.052, 0.020, 0.020, 0.014, 0.020, 0.0, -0.004),
            (-0.030, 0.042, 0.042, 0.032, 0.044, 0.0, -0.002),
            (0.000, 0.056, 0.055, 0.048, 0.057, 0.0, 0.0),
            (0.050, 0.058, 0.056, 0.054, 0.056, 0.0, 0.001),
            (0.100, 0.051, 0.049, 0.052, 0.050, 0.0, 0.002),
            (0.160, 0.047, 0.046, 0.044, 0.046, 0.002, 0.0),
            (0.220, 0.043, 0.044, 0.040, 0.043, 0.001, 0.0),
            (0.270, 0.038, 0.039, 0.038, 0.040, 0.0, 0.0),
            (0.300, 0.036, 0.037, 0.037, 0.038, 0.0, 0.0),
        ],
    )
    across = np.cross(THUMB_SIDE, FOREARM)
    lower = loft(
        ELBOW,
        (FOREARM, THUMB_SIDE, across),
        [
            (-0.012, 0.034, 0.036, 0.036, 0.036, 0.0, 0.0),
            (0.020, 0.040, 0.040, 0.038, 0.037, 0.0, 0.0),
            (0.060, 0.045, 0.042, 0.039, 0.038, 0.0, 0.0),
            (0.105, 0.042, 0.040, 0.036, 0.035, 0.0, 0.0),
            (0.160, 0.034, 0.034, 0.029, 0.028, 0.0, 0.0),
            (0.210, 0.028, 0.028, 0.0225, 0.022, 0.0, 0.0),
            (0.250, 0.0275, 0.0275, 0.0195, 0.0195, 0.0, 0.0),
            (0.264, 0.0210, 0.0210, 0.0140, 0.0140, 0.0, 0.0),
            (0.272, 0.0060, 0.0060, 0.0050, 0.0050, 0.0, 0.0),
        ],
    )
    return union([upper, lower], 0.016)


def palm() -> Field:
    body = loft(
        WRIST,
        HAND,
        [
            (-0.012, 0.0270, 0.0270, 0.0185, 0.0185, 0.0, 0.0),
            (0.012, 0.0305, 0.0290, 0.0175, 0.0180, 0.0, 0.0),
            (0.040, 0.0370, 0.0345, 0.0160, 0.0180, 0.0, -0.001),
            (0.070, 0.0400, 0.0400, 0.0140, 0.0150, -0.002, -0.001),
            (0.090, 0.0370, 0.0380, 0.0115, 0.0120, -0.002, -0.001),
            (0.100, 0.0300, 0.0320, 0.0085, 0.0090, -0.002, -0.002),
        ],
        2.5,
    )
    ball = WRIST + np.array([[0.020, 0.012, -0.010], [0.052, 0.034, -0.014]]) @ HAND
    heel = WRIST + np.array([[0.020, -0.018, -0.010], [0.055, -0.026, -0.010]]) @ HAND
    return union([body, cone(*ball, 0.0150, 0.0130), cone(*heel, 0.0125, 0.0110)], 0.016)


RADII = {
    "index": (0.0098, 0.0090, 0.0083, 0.0074),
    "middle": (0.0100, 0.0093, 0.0085, 0.0076),
    "ring": (0.0096, 0.0088, 0.0081, 0.0072),
    "little": (0.0086, 0.0077, 0.0071, 0.0064),
    "thumb": (0.0145, 0.0118, 0.0108, 0.0090),
}


def finger(name: str) -> Field:
    points, radii = finger_points(name), RADII[name]
    return union([cone(points[i], points[i + 1], radii[i], radii[i + 1]) for i in range(3)], 0.004)


def hand() -> Field:
    """The palm with fingers that melt into it and keep apart from each other."""
    fingers = [finger(name) for name in KNUCKLES]
    held, thumb = palm(), finger("thumb")

    def field(p: Array) -> Array:
        base = held(p)
        apart = fingers[0](p)
        for other in fingers[1:]:
            apart = np.minimum(apart, other(p))
        out = smooth_min(base, apart, 0.008)
        return np.asarray(smooth_min(out, thumb(p), 0.013))

    return field


def leg() -> Field:
    """From the hip to the ankle."""
    rows = [  # height, outwards, inwards, ahead, behind, and the middle aside and ahead
        (0.046, 0.012, 0.012, 0.014, 0.014, 0.096, -0.026),
        (0.060, 0.028, 0.028, 0.032, 0.030, 0.096, -0.026),
        (0.085, 0.034, 0.033, 0.036, 0.036, 0.096, -0.026),
        (0.115, 0.033, 0.031, 0.034, 0.036, 0.096, -0.025),
        (0.170, 0.037, 0.035, 0.036, 0.042, 0.096, -0.024),
        (0.240, 0.045, 0.043, 0.042, 0.054, 0.095, -0.022),
        (0.310, 0.053, 0.050, 0.047, 0.066, 0.095, -0.020),
        (0.370, 0.055, 0.052, 0.049, 0.068, 0.095, -0.018),
        (0.430, 0.051, 0.049, 0.049, 0.057, 0.095, -0.010),
        (0.475, 0.050, 0.048, 0.053, 0.049, 0.094, -0.002),
        (0.505, 0.051, 0.049, 0.055, 0.050, 0.094, 0.002),
        (0.545, 0.054, 0.052, 0.055, 0.054, 0.094, 0.002),
        (0.610, 0.061, 0.060, 0.063, 0.064, 0.094, 0.003),
        (0.690, 0.070, 0.068, 0.073, 0.074, 0.093, 0.002),
        (0.770, 0.078, 0.076, 0.081, 0.083, 0.092, 0.000),
        (0.840, 0.083, 0.080, 0.086, 0.090, 0.091, -0.003),
        (0.900, 0.082, 0.074, 0.084, 0.090, 0.088, -0.004),
        (0.950, 0.070, 0.060, 0.070, 0.076, 0.085, -0.004),
    ]
    out = loft((0, 0, 0), (UP, LEFT, AHEAD), rows)
    cap = ellipsoid((0.094, 0.503, 0.044), (0.026, 0.034, 0.015))
    calf = ellipsoid((0.108, 0.385, -0.050), (0.034, 0.085, 0.034))
    inner = ellipsoid((0.076, 0.370, -0.052), (0.032, 0.080, 0.034))
    thigh = ellipsoid((0.106, 0.720, 0.042), (0.046, 0.150, 0.036))
    return union([out, cap, calf, inner, thigh], 0.030)


def foot() -> Field:
    """A foot as lasts have it, its sole on the ground."""
    ahead, side = np.array([0.075, 0.0, 1.0]), np.array([1.0, 0.0, -0.075])
    rows = [  # how far ahead of the ankle, half breadth outwards and inwards, height of its back
        (-0.066, 0.014, 0.014, 0.044, 0.0),
        (-0.058, 0.024, 0.024, 0.058, 0.0),
        (-0.040, 0.032, 0.032, 0.074, 0.0),
        (-0.010, 0.035, 0.035, 0.094, 0.0),
        (0.025, 0.036, 0.035, 0.096, 0.001),
        (0.060, 0.041, 0.037, 0.078, 0.003),
        (0.095, 0.046, 0.042, 0.060, 0.004),
        (0.130, 0.049, 0.045, 0.046, 0.004),
        (0.160, 0.046, 0.045, 0.037, 0.002),
        (0.190, 0.036, 0.039, 0.030, -0.002),
        (0.206, 0.022, 0.026, 0.025, -0.004),
        (0.214, 0.008, 0.010, 0.017, -0.004),
    ]
    sections = [
        (t, o, i, h, 0.030, m, 0.012)
        for t, o, i, h, m in [(r[0], r[1], r[2], r[3] - 0.012, r[4]) for r in rows]
    ]
    body = loft((0.096, 0.0, -0.026), (ahead, side, UP), sections, 2.6)
    return common(body, plane((0, 0, 0), (0, -1, 0)), 0.014)


def head() -> Field:
    """A skull with the planes of a face."""
    skull = ellipsoid((0.0, 1.662, -0.015), (0.0755, 0.0900, 0.0960))
    face = ellipsoid((0.0, 1.606, 0.022), (0.0530, 0.0790, 0.0620))
    jaw = mirrored(cone((0.0420, 1.592, 0.000), (0.0100, 1.543, 0.058), 0.0185, 0.0170))
    cheek = mirrored(cone((0.0400, 1.622, 0.046), (0.0540, 1.634, 0.010), 0.0140, 0.0140))
    brow = mirrored(cone((0.0080, 1.656, 0.070), (0.0470, 1.654, 0.044), 0.0120, 0.0110))
    out = union([skull, face, jaw], 0.042)
    out = union([out, cheek, brow], 0.028)
    out = without(out, mirrored(ellipsoid((0.0320, 1.632, 0.0985), (0.0240, 0.0150, 0.0150))), 0.034)
    nose = cone((0, 1.650, 0.0760), (0, 1.612, 0.0860), 0.0060, 0.0078)
    mouth = ellipsoid((0.0, 1.576, 0.0650), (0.0210, 0.0240, 0.0135))
    chin = ellipsoid((0.0, 1.542, 0.066), (0.0190, 0.0140, 0.0130))
    out = union([union([out, mouth, chin], 0.026), nose], 0.024)
    ear = ellipsoid((0.0715, 1.628, -0.014), (0.0095, 0.0280, 0.0165), _leant(0.25))
    return union([out, mirrored(ear)], 0.014)


def _leant(angle: float) -> Array:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[1.0, 0, 0], [0, c, s], [0, -s, c]])


def whole() -> Field:
    """The body; made at x > 0 and mirrored."""
    middle, neck_, skull, arm_, hand_, leg_, foot_ = trunk(), neck(), head(), arm(), hand(), leg(), foot()

    def field(p: Array) -> Array:
        out = smooth_min(middle(p), leg_(p), 0.045)
        out = smooth_min(out, arm_(p), 0.060)
        out = smooth_min(out, neck_(p), 0.035)
        out = smooth_min(out, skull(p), 0.022)
        out = smooth_min(out, hand_(p), 0.012)
        return np.asarray(smooth_min(out, foot_(p), 0.024))

    return mirrored(field)


def edge_length(p: Array) -> Array:
    """Return how long edges are at points, metres: short where forms are small."""
    x, y, z = np.abs(p[:, 0]), p[:, 1], p[:, 2]
    out = np.full(len(p), 0.0190)
    along = (np.stack([x, y, z], 1) - WRIST) @ FOREARM
    arm_ = (x > 0.3) & (along > -0.2)
    out = np.where(arm_, np.interp(along, [-0.2, -0.03, 0.03, 0.09], [0.0170, 0.0120, 0.0090, 0.0050]), out)
    out = np.where(y > 1.50, np.interp(y, [1.50, 1.56], [0.0160, 0.0095]), out)
    out = np.where((y > 1.53) & (z > 0.055), 0.0062, out)
    out = np.where(y < 0.14, np.interp(y, [0.05, 0.14], [0.0095, 0.0170]), out)
    knee = np.exp(-(((y - 0.5) / 0.07) ** 2)) * (x < 0.3)
    elbow = np.exp(-((np.linalg.norm(np.stack([x, y, z], 1) - ELBOW, axis=1) / 0.06) ** 2))
    return np.asarray(out - 0.004 * np.maximum(knee, elbow) * (out > 0.012))
