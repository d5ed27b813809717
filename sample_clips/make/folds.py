"""Folds of cloth, as metres by which it stands out (plus) or in at points of the left or the right side.

Cloth folds where it is pushed together: over a hem, inside an elbow, behind a knee, over a shoe; and where
it is drawn: from the armpit, from the crotch. Waves are by eye; each bends, so that no two folds are alike.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from sample_clips.make.mannequin_skeleton import ARM

Array = NDArray[Any]

SHOULDER, ELBOW, WRIST = (
    np.array([0.172, 1.392, -0.030]) + ARM * along for along in (0.0, 0.272, 0.272 + 0.246)
)


def _hill(x: Array, middle: float, reach: float) -> Array:
    return np.asarray(np.exp(-(((x - middle) / reach) ** 2)))


def _wave(phase: Array) -> Array:
    """A wave with round tops and narrow valleys, -1..1."""
    s = np.sin(phase)
    return np.asarray(1 - 2 * np.sqrt(0.5 - 0.5 * s + 0.02) / np.sqrt(1.02))


def sleeve_folds(p: Array) -> Array:
    """Return the folds of sleeves at points `[V, 3]`."""
    q = np.stack([np.abs(p[:, 0]), p[:, 1], p[:, 2]], 1) - SHOULDER
    along, up = q @ ARM, q @ np.array([-ARM[1], ARM[0], 0.0])
    way = np.arctan2(q[:, 2] + 0.0, up)
    elbow = 0.272
    inside = 0.35 + 0.65 * (0.5 + 0.5 * np.cos(way - 1.35))  # an elbow bends forwards
    ring = _wave(2 * np.pi * along / 0.031 + 1.3 * np.sin(way) + 0.7 * np.sin(2 * way + 1.0))
    out = 0.0030 * inside * _hill(along, elbow, 0.062) * ring
    end = _wave(2 * np.pi * along / 0.027 + 1.6 * np.sin(way + 0.6))
    out = out + 0.0024 * _hill(along, 0.272 + 0.150, 0.045) * end
    top = _wave(2 * np.pi * (along + 0.35 * q[:, 2]) / 0.045 + 0.8 * np.sin(way * 2))
    out = out + 0.0022 * _hill(along, 0.085, 0.055) * top * (0.5 - 0.5 * np.sin(way - 1.2))
    return np.asarray(out)


def body_folds(p: Array, hem: float) -> Array:
    """Return the folds of a sweater's or a shirt's body at points `[V, 3]`. hem: the height of its end."""
    x, y, z = p[:, 0], p[:, 1], p[:, 2]
    way = np.arctan2(x, z + 0.012)
    bunch = _wave(2 * np.pi * y / 0.056 + 0.9 * np.sin(way + 0.4) + 0.8 * np.sin(2 * way + 1.1))
    broken = 0.55 + 0.45 * np.sin(3 * way + 40 * y)
    out = 0.0042 * _hill(y, hem + 0.075, 0.045) * bunch * broken
    side = np.abs(x)
    draw = _wave(2 * np.pi * (y * 0.80 - 0.62 * side) / 0.052 + 2.0 * z / 0.05)
    armpit = np.exp(-(((side - 0.120) / 0.042) ** 2 + ((y - 1.285) / 0.060) ** 2))
    out = out + 0.0036 * armpit * draw
    waist = _wave(2 * np.pi * (y + 0.25 * side) / 0.060 + 1.2 * np.sin(2 * way + x * 9))
    out = out + 0.0032 * _hill(y, 1.080, 0.060) * waist * _hill(np.abs(way), 1.55, 0.75)
    return np.asarray(out)


def trouser_folds(p: Array) -> Array:
    """Return the folds of trousers at points `[V, 3]`."""
    x, y, z = np.abs(p[:, 0]), p[:, 1], p[:, 2]
    way = np.arctan2(x - 0.099, z)
    shoe = _wave(2 * np.pi * y / 0.038 + 1.4 * np.sin(way + 0.5) + 0.6 * np.sin(2 * way))
    out = 0.0036 * _hill(y, 0.128, 0.045) * shoe
    behind = 0.35 + 0.65 * (0.5 - 0.5 * np.cos(way))
    knee = _wave(2 * np.pi * y / 0.046 + 1.1 * np.sin(way) + 0.5 * np.sin(3 * way))
    out = out + 0.0032 * behind * _hill(y, 0.485, 0.070) * knee
    whisker = _wave(2 * np.pi * (y + 0.55 * x) / 0.046 + 6.0 * z)
    out = out + 0.0034 * _hill(y, 0.850, 0.040) * _hill(x, 0.055, 0.045) * whisker * (z > -0.2)
    return np.asarray(out)
