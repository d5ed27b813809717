"""The openings of a face, made ring by ring on its form: lids that wrap the eyes, and lips that meet.

An opening is a loop of columns round it. Each column has rows from its rim to the skin about it, where the
patch lies on the face and hides the hole that the face has there. So rims are as crisp as they are fine, and
the loops run round eyes and mouth as muscles do.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sample_clips.make.face import front
from sample_clips.make.sculpt import Field, gradient
from sample_clips.make.shapes import EYE_RADIUS, JOINT, MOUTH_HALF, mouth_line, step

Array = NDArray[Any]

UPPER_LID_OPEN, LOWER_LID_OPEN = 26.0, -28.0  # degrees above the eye's axis at which the rims' middles rest
SHUT_AT = -13.5  # where they meet
LID_OVER = 0.0025  # metres a lid's outside is beyond the eyeball
INNER, OUTER = (-0.0150, -0.0034), (0.0152, 0.0012)  # corners of the left eye: across and up from its middle


@dataclass(frozen=True, eq=False)
class Patch:
    """Rows of a closed loop, from the rim outwards: positions and normals `[R, C, 3]`, and of each point how
    far it is from the rim, 0..1, `[R, C]`, and whether it is of the upper lid or lip `[C]`.
    """

    positions: Array
    normals: Array
    away: Array
    upper: Array

    @property
    def triangles(self) -> Array:
        """`[N, 3]`, facing outwards."""
        rows, columns = self.positions.shape[:2]
        i, j = np.meshgrid(np.arange(rows - 1), np.arange(columns), indexing="ij")
        a, b = (i * columns + j).ravel(), (i * columns + (j + 1) % columns).ravel()
        c, d = a + columns, b + columns
        return np.concatenate([np.stack([a, d, c], -1), np.stack([a, b, d], -1)])


def _patch(rows: list[Array], away: Array, upper: Array, face: Field, skin: Array) -> Patch:
    """Return a patch. skin `[R]`: how much the normals of each row are those of the face."""
    positions = np.stack(rows)
    whole = Patch(positions, positions, away, upper)
    flat, triangles = positions.reshape(-1, 3), whole.triangles
    corner = flat[triangles]
    facing = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    normals = np.zeros_like(flat)
    for k in range(3):
        np.add.at(normals, triangles[:, k], facing)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    normals = normals.reshape(positions.shape)
    smooth = gradient(face, flat).reshape(positions.shape)
    normals = normals + (smooth - normals) * np.asarray(skin)[:, None, None]
    normals /= np.maximum(np.linalg.norm(normals, axis=2, keepdims=True), 1e-12)
    return Patch(positions, normals, away, upper)


# --- eyes

_COLUMNS = 15  # of each lid, from corner to corner
_LID_ROWS = (0.0, 0.0, 0.10, 0.22, 0.34, 0.46, 0.62, 0.80, 1.0, 1.22)
_CREASE = 0.36  # how far out the upper lid folds
_LID_ABOUT = (-0.0212, 0.0262, 0.0178, -0.0172)  # of the skin that is a patch: inwards, outwards, up, down


def _bow(t: Array, top: float, round_: float) -> Array:
    bent = np.clip(t, 0, 1) ** (np.log(0.5) / np.log(top))
    return np.asarray(np.clip(4 * bent * (1 - bent), 0, 1) ** round_)


def rim_angles(t: Array, upper: bool, open_: float) -> Array:
    """Return the elevations of a lid's rim about the eye's axis, degrees, at shares `t [N]` of the way from
    the inner to the outer corner. open_: of its highest, or lowest, place.
    """
    # The upper rim is highest a little towards the nose, the lower one lowest a little away from it.
    top = 0.47 if upper else 0.57
    low, high = _corner_angle(INNER), _corner_angle(OUTER)
    chord = low + (high - low) * t
    return np.asarray(chord + (open_ - low - (high - low) * top) * _bow(t, top, 0.66 if upper else 0.74))


def shut_angles(t: Array) -> Array:
    """Return the elevations at which both rims meet, degrees, as `rim_angles`."""
    return rim_angles(t, False, SHUT_AT)


def _corner_angle(corner: tuple[float, float]) -> float:
    x, y = corner
    return float(np.degrees(np.arcsin(y / np.sqrt(EYE_RADIUS**2 - x * x))))


def _on_ball(across: Array, degrees: Array, radius: Array) -> Array:
    ring = np.sqrt(np.maximum(radius * radius - across * across, 1e-10))
    e = np.radians(degrees)
    return np.stack([across, ring * np.sin(e), ring * np.cos(e)], -1)


def lids(face: Field, open_: tuple[float, float] = (UPPER_LID_OPEN, LOWER_LID_OPEN)) -> Patch:
    """Return the left eye's lids and the skin about them. open_: the elevations of the rims' middles."""
    eye = JOINT["LeftEye"]
    t = 0.5 - 0.5 * np.cos(np.pi * np.linspace(0, 1, _COLUMNS))
    t = 0.6 * t + 0.4 * np.linspace(0, 1, _COLUMNS)
    t = np.concatenate([t, t[-2:0:-1]])
    upper = np.arange(len(t)) < _COLUMNS
    across = INNER[0] + (OUTER[0] - INNER[0]) * t
    angle = np.where(upper, rim_angles(t, True, open_[0]), rim_angles(t, False, open_[1]))
    bow = _bow(t, 0.5, 0.6)
    inner = _on_ball(across, angle, np.full(len(t), EYE_RADIUS + 0.0008))
    over = EYE_RADIUS + 0.0010 + (LID_OVER - 0.0010) * bow
    outside = _on_ball(across, angle + np.where(upper, 2.6, -2.6) * bow, over)
    turn = np.pi * np.where(upper, 1 - t, 1 + t)
    left, right, up, down = _LID_ABOUT
    middle, half = (left + right) / 2, (right - left) / 2
    skin = np.stack(
        [middle + half * np.cos(turn), np.where(upper, up, -down) * np.sin(turn) + 0.0008 * (2 * t - 1)], -1
    )
    rows = [inner + eye, outside + eye]
    for share in _LID_ROWS[2:]:
        xy = outside[:, :2] + share * (skin - outside[:, :2])
        on_face = front(face, xy + eye[:2]) - eye[2]
        square = (over + 0.0004) ** 2 - (xy**2).sum(1)
        on_ball = np.sqrt(np.maximum(square, (0.35 * over) ** 2))
        part = step(0.16, 0.92, np.full(len(t), share))
        z = on_ball + part * (on_face - on_ball)
        z = z - np.where(upper, 0.0016, 0.0005) * bow * np.exp(-(((share - _CREASE) / 0.10) ** 2))
        z = z + np.where(upper, 0.0012, 0.0) * bow * np.exp(-(((share - 0.60) / 0.14) ** 2))
        if share == 1:
            z = on_face + 0.00025
        if share > 1:  # under the face, which hides where it ends
            z = on_face - 0.0008
        rows.append(np.concatenate([xy, z[:, None]], 1) + eye)
    away = np.repeat(np.array(_LID_ROWS)[:, None], len(t), 1)
    smooth = step(0.55, 1.0, np.array(_LID_ROWS))
    return _patch(rows, away, upper, face, smooth)


def lid_shares(patch: Patch, open_: tuple[float, float] = (UPPER_LID_OPEN, LOWER_LID_OPEN)) -> Array:
    """Return how much each point `[R, C]` goes with its lid's joint, so that the rims meet along one line."""
    across = patch.positions[0, :, 0] - JOINT["LeftEye"][0]
    t = np.clip((across - INNER[0]) / (OUTER[0] - INNER[0]), 0, 1)
    shut = shut_angles(t)
    upper = (rim_angles(t, True, open_[0]) - shut) / (UPPER_LID_OPEN - SHUT_AT)
    lower = (shut - rim_angles(t, False, open_[1])) / (SHUT_AT - LOWER_LID_OPEN)
    rim = np.clip(np.where(patch.upper, upper, lower), 0, 1)
    crease = np.where(patch.upper, _CREASE + 0.06, 0.55)
    return np.asarray(rim * np.clip(1 - patch.away / crease, 0, 1))


# --- mouth

_MOUTH_COLUMNS = 19
_MOUTH_ABOUT = 0.0090, 0.0165, 0.0180  # metres of skin beside the corners, above and below


def lip_heights(x: Array, upper: bool, full: float = 1.0) -> Array:
    """Return how far the red of a lip reaches from the line between them, metres, at places across."""
    share = np.clip(1 - (x / MOUTH_HALF) ** 2, 0, 1)
    if upper:
        bow = 0.0068 + 0.0009 * np.exp(-(((np.abs(x) - 0.0052) / 0.0030) ** 2))
        bow = bow - 0.0010 * np.exp(-((x / 0.0022) ** 2))
        return np.asarray(full * bow * share**0.75)
    return np.asarray(full * 0.0089 * share**0.62)


def mouth(face: Field, full: float = 1.0) -> Patch:
    """Return the lips, what is seen inside them, and the skin about them."""
    t = np.linspace(0, 1, _MOUTH_COLUMNS)
    t = np.concatenate([t, t[-2:0:-1]])
    upper = np.arange(len(t)) < _MOUTH_COLUMNS
    turn = np.pi * np.where(upper, 1 - t, 1 + t)
    x = MOUTH_HALF * np.cos(turn)
    line = mouth_line(x)
    sign = np.where(upper, 1.0, -1.0)
    height = np.where(upper, lip_heights(x, True, full), lip_heights(x, False, full))
    taper = np.clip(1 - (x / MOUTH_HALF) ** 2, 0, 1) ** 0.6
    beside, above, below = _MOUTH_ABOUT
    skin = np.stack(
        [(MOUTH_HALF + beside) * np.cos(turn), line + np.where(upper, above, below) * np.sin(turn) * sign], -1
    )
    skin[:, 1] = line + np.where(upper, above, -below) * np.abs(np.sin(turn)) ** 0.9
    dip = -0.0010 - 0.0006 * (1 - taper)

    def at(share: float, out: Array | float) -> Array:
        """A place in the red, by its share of the height, and how far before the face it is."""
        y = line + sign * share * height
        xy = np.stack([x, y], -1)
        return np.concatenate([xy, (front(face, xy) + out)[:, None]], 1)

    contact = at(0.0, dip)
    rows = [
        contact + np.stack([-0.12 * x, sign * 0.0105, np.full(len(x), -0.0070)], -1),
        contact + np.stack([-0.05 * x, sign * 0.0042 * taper, np.full(len(x), -0.0046)], -1),
        contact,
        at(0.16, np.where(upper, 0.0009, 0.0010) * taper + dip * (1 - taper)),
        at(0.48, np.where(upper, 0.0022, 0.0031) * taper * (0.75 + 0.25 * full)),
        at(0.80, np.where(upper, 0.0017, 0.0024) * taper),
        at(1.0, np.where(upper, 0.0010, 0.0005) * taper),
        at(1.0, np.where(upper, 0.0010, 0.0005) * taper),
    ]
    border = rows[-1]
    for share in (0.14, 0.40, 0.72, 1.0, 1.22):
        xy = border[:, :2] + share * (skin - border[:, :2])
        z = (
            front(face, xy)
            + np.where(upper, 0.0006, -0.0004) * taper * (1 - share) ** 2
            + {1.0: 0.00025, 1.22: -0.0008}.get(share, 0.0)
        )
        rows.append(np.concatenate([xy, z[:, None]], 1))
    away = np.repeat(
        np.array([0, 0, 0, 0.1, 0.3, 0.4, 0.5, 0.5, 0.6, 0.7, 0.9, 1.0, 1.0])[:, None], len(x), 1
    )
    smooth = np.array([0, 0, 0, 0, 0, 0, 0.1, 0.2, 0.5, 1, 1, 1, 1.0])
    return _patch(rows, away, upper, face, smooth)
