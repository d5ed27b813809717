"""One body made another: wider, deeper, rounder, with another face; on the same joints.

Bodies change by how much each point follows each bone, so that nothing tears where parts meet; faces change
by where a point is.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from sample_clips.make.looks import Build
from sample_clips.make.shapes import JOINT, step

Array = NDArray[Any]

MIDDLE = -0.012  # metres ahead: where the trunk's depth is computed from
TRUNK = ("Hips", "Spine", "Chest", "UpperChest")
FACE = ("Head", "Jaw", *(s + n for s in ("Left", "Right") for n in ("Brow", "UpperLid", "LowerLid")))
LIMBS = {
    "arms": (("UpperArm", "LowerArm"), ("LowerArm", "Hand")),
    "legs": (("UpperLeg", "LowerLeg"), ("LowerLeg", "Foot")),
}


def built(p: Array, weights: dict[str, Array], build: Build) -> Array:
    """Return points `[V, 3]` of the rest pose as they are on a body. weights: of each point, by joint."""
    out = p.copy()
    share = sum((weights[n] for n in TRUNK if n in weights), np.zeros(len(p)))
    if build.trunk:
        height, wide, ahead, behind = np.array(build.trunk).T
        y = p[:, 1]
        deep = np.where(p[:, 2] > MIDDLE, np.interp(y, height, ahead), np.interp(y, height, behind))
        out[:, 0] += share * p[:, 0] * (np.interp(y, height, wide) - 1)
        out[:, 2] += share * (p[:, 2] - MIDDLE) * (deep - 1)
    for field, bones in LIMBS.items():
        scale = getattr(build, field)
        for side in ("Left", "Right"):
            for upper, lower in bones:
                w = weights.get(side + upper)
                if w is not None and scale != 1:
                    out += w[:, None] * (scale - 1) * _beside(p, JOINT[side + upper], JOINT[side + lower])
    if "Neck" in weights and build.neck != 1:
        out += weights["Neck"][:, None] * (build.neck - 1) * _beside(p, JOINT["Neck"], JOINT["Head"])
    if any(n in weights for n in FACE):
        skull = sum((weights[n] for n in FACE if n in weights), np.zeros(len(p)))
        out += skull[:, None] * (_face(p, build) - p)
    return out


def _beside(p: Array, a: Array, b: Array) -> Array:
    """Return how points lie beside a line, `[V, 3]`."""
    along = (b - a) / np.linalg.norm(b - a)
    away = p - a
    return np.asarray(away - (away @ along)[:, None] * along)


def _near(p: Array, at: tuple[float, float, float], reach: float) -> Array:
    """Return 1 at a place of either side, less about it, `[V]`. reach: metres."""
    q = np.stack([np.abs(p[:, 0]), p[:, 1], p[:, 2]], 1)
    return np.asarray(np.exp(-(np.linalg.norm(q - np.array(at), axis=1) ** 2) / (reach * reach)))


def _face(p: Array, b: Build) -> Array:
    out = p.copy()
    side = np.sign(p[:, 0])
    low = step(1.590, 1.535, p[:, 1]) * step(1.440, 1.500, p[:, 1])
    out[:, 0] += (b.jaw - 1) * p[:, 0] * low
    nose = np.exp(-((np.linalg.norm((p - [0, 1.580, 0.100]) / [0.016, 0.026, 0.022], axis=1)) ** 2))
    out += ((b.nose - 1) * nose)[:, None] * (p - [0, 1.592, 0.080])
    cheeks = _near(p, (0.042, 1.570, 0.055), 0.024)
    out[:, 0] += b.cheeks * cheeks * side
    out[:, 2] += b.cheeks * cheeks
    chin = np.exp(-(np.linalg.norm((p - [0, 1.512, 0.070]) / [0.040, 0.026, 0.050], axis=1) ** 2))
    out[:, 1] -= b.chin * chin
    return out
