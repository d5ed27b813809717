"""Measures that distinguish stances: differences between keypoints, seen from the torso (arms) or upright
(body, head), in torso lengths.

A measure is a weighted sum of points that adds up to a direction, so that neither place nor size nor picture
matters. `scale` says how far it may be off, in torso lengths, before that counts as 1; they are ours: about
twice what people of other proportions and the jitter of pose estimators make of it, `inf` where an axis says
nothing.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import atan2, cos, inf, sin, sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph.words import Layer
from metagraph.mimicry.keypoint_layouts import PLACE, POINTS

Array = NDArray[Any]
Terms = Mapping[str, float]

SHOULDERS: Terms = {"left_shoulder": 0.5, "right_shoulder": 0.5}
HIPS: Terms = {"left_hip": 0.5, "right_hip": 0.5}
ANKLES: Terms = {"left_ankle": 0.5, "right_ankle": 0.5}
EARS: Terms = {"left_ear": 0.5, "right_ear": 0.5}
EARS_UP = 0.4  # torso lengths the ears are above the shoulders
LEAST_UPRIGHT = 0.5  # cosine of how far a torso may lean from upright; lying down is no stance
LEAST_EVIDENCE = 0.4  # share of a layer's measures, by weight, without which nothing is said of it


@dataclass(frozen=True)
class PoseMeasure:
    """plus - minus. scale: along x, y, z, see above. weight: how much it counts beside the others. slant: by
    how much perspective alone may raise it in a picture of somebody seen from the side, torso lengths.
    """

    plus: Terms
    minus: Terms
    scale: tuple[float, float, float]
    weight: float = 1.0
    slant: float = 0.0


def _one(name: str) -> Terms:
    return {name: 1.0}


def _beside_shoulders(part: str, share: float) -> tuple[Terms, Terms]:
    """Return the line from right to left of the head beside a share of that of the shoulders. The share is
    three quarters of what would make them as long: perspective slants both, but an arm in motion only that of
    the shoulders.
    """
    return {f"left_{part}": 1.0, "right_shoulder": share}, {f"right_{part}": 1.0, "left_shoulder": share}


_HAND, _ELBOW, _APART, _NEAR = (0.16, 0.16, 0.3), (0.16, 0.16, 0.3), (0.2, 0.2, 0.4), (0.2, 0.2, 0.4)
MEASURES: Mapping[Layer, tuple[PoseMeasure, ...]] = {
    "arms": (
        *(PoseMeasure(_one(f"{side}_wrist"), SHOULDERS, _HAND) for side in ("left", "right")),
        *(PoseMeasure(_one(f"{side}_elbow"), SHOULDERS, _ELBOW, 0.6) for side in ("left", "right")),
        PoseMeasure(_one("left_wrist"), _one("right_wrist"), _APART, 0.6),
        *(PoseMeasure(_one(f"{side}_wrist"), _one("nose"), _NEAR, 0.4) for side in ("left", "right")),
        *(PoseMeasure(_one(f"{side}_wrist"), _one(f"{side}_hip"), _NEAR, 0.4) for side in ("left", "right")),
    ),
    "body": (
        PoseMeasure(HIPS, ANKLES, (0.04, inf, 0.12), 1.0),
        PoseMeasure(SHOULDERS, HIPS, (0.03, inf, 0.06), 1.0),
        PoseMeasure(_one("left_hip"), _one("right_hip"), (inf, 0.02, inf), 0.7, 0.05),
        PoseMeasure(_one("left_shoulder"), _one("right_shoulder"), (inf, 0.03, inf), 0.4, 0.09),
    ),
    "head": (
        PoseMeasure(_one("left_ear"), _one("right_ear"), (0.12, inf, 0.12)),
        PoseMeasure(*_beside_shoulders("ear", 0.32), (inf, 0.03, inf), 1.0, 0.02),
        PoseMeasure(*_beside_shoulders("eye", 0.135), (inf, 0.018, inf), 1.0, 0.01),
        PoseMeasure(_one("nose"), EARS, (0.12, 0.08, 0.12)),
    ),
}
# What must hold still for a layer to be in a stance.
STILL: Mapping[Layer, tuple[tuple[Terms, Terms], ...]] = {
    "arms": ((_one("left_wrist"), SHOULDERS), (_one("right_wrist"), SHOULDERS)),
    "body": ((HIPS, ANKLES), (SHOULDERS, HIPS)),
    "head": ((_one("nose"), SHOULDERS), (EARS, SHOULDERS)),
}
UPRIGHT: Mapping[Layer, bool] = {"body": True, "arms": False, "head": True}  # else seen from the torso


def _rows(sums: Sequence[tuple[Terms, Terms]]) -> Array:
    out = np.zeros((len(sums), len(POINTS)))
    for row, (plus, minus) in zip(out, sums, strict=True):
        for terms, sign in ((plus, 1.0), (minus, -1.0)):
            for name, share in terms.items():
                row[PLACE[name]] += sign * share
    return out


# Layer -> `[N, 17]` what turns points into measures; `[N, 3]` weight / scale^2; `[N]` weight.
ROWS: Mapping[Layer, Array] = {
    layer: _rows([(m.plus, m.minus) for m in some]) for layer, some in MEASURES.items()
}
MOVING: Mapping[Layer, Array] = {layer: _rows(some) for layer, some in STILL.items()}
SHARP: Mapping[Layer, Array] = {
    layer: np.array([[m.weight / s**2 for s in m.scale] for m in some]) for layer, some in MEASURES.items()
}
SCALE: Mapping[Layer, Array] = {
    layer: np.array([[s if s < inf else 0.0 for s in m.scale] for m in some])
    for layer, some in MEASURES.items()
}
COUNT: Mapping[Layer, Array] = {
    layer: np.array([[m.weight if s < inf else 0.0 for s in m.scale] for m in some])
    for layer, some in MEASURES.items()
}


_SLANT: Mapping[Layer, Array] = {
    layer: np.array([[m.weight, m.scale[1] ** 2, m.slant**2] for m in some])
    for layer, some in MEASURES.items()
}


def weigh_in_picture(layer: Layer, turn: float) -> Array:
    """Return `[N, 2]` weight / scale^2 of measures in a picture of somebody turned by an angle from the
    camera.
    """
    out = SHARP[layer][:, :2].copy()
    weight, scale, slant = _SLANT[layer].T
    out[:, 1] = weight / (scale + slant * sin(turn) ** 2)
    return out


USED: Mapping[Layer, Array] = {layer: rows != 0 for layer, rows in ROWS.items()}


MOVED: Mapping[Layer, Array] = {layer: rows != 0 for layer, rows in MOVING.items()}


def measure_trust(layer: Layer, confidence: Array) -> Array:
    """Return how far each measure `[N]` can be trusted: as far as the least certain of its points, of
    `confidence [17]`.
    """
    return np.asarray(np.where(USED[layer], confidence, 1.0).min(1))


@dataclass(frozen=True, eq=False)
class MeasuredFrame:
    """How a person stands in the picture: torso length in its units, its up in the picture `[3]`, heading in
    radians about y, 0 towards the camera (known from three dimensions only), the shoulders' width in torso
    lengths. upright: of the whole figure, always (0, 1, 0).
    """

    size: float
    up: Array
    heading: float
    width: float


_LS, _RS, _LH, _RH, _LE, _RE = (
    PLACE[f"{side}_{part}"] for part in ("shoulder", "hip", "ear") for side in ("left", "right")
)


def turn_about_y(vectors: Array, angle: float) -> Array:
    """Return `vectors [..., 3]` turned about y by an angle, which takes z to x."""
    c, s = cos(angle), sin(angle)
    out = vectors.copy()
    out[..., 0] = c * vectors[..., 0] + s * vectors[..., 2]
    out[..., 2] = c * vectors[..., 2] - s * vectors[..., 0]
    return out


def straighten(vectors: Array, up: Array) -> Array:
    """Return `vectors [..., 3]` turned the shortest way that takes the direction `up [3]` (unit, not straight
    down) to y.
    """
    x, y, z = up
    k = 1.0 / (1.0 + max(y, -0.99))
    m = np.array([[1 - k * x * x, -x, -k * x * z], [x, y, z], [-k * x * z, -z, 1 - k * z * z]])
    return np.asarray(vectors @ m.T)


def measure_body_frame(
    points: Array, confidence: Array, dims: int, usual_width: float
) -> MeasuredFrame | None:
    """Return how a person stands whose POINTS are `points [17, 3]`; None if the shoulders do not say.

    Without hips, as at a desk, the torso is taken to be upright, and its length is given from the shoulders'
    width, of which `usual_width` torso lengths are usual, and the ears' height above them; the more of both,
    since turning away hides the first.
    """
    sure = confidence.tolist()
    if min(sure[_LS], sure[_RS]) <= 0:
        return None
    left, right = points[_LS], points[_RS]
    across, middle = left - right, (left + right) * 0.5
    heading, up, size = 0.0, np.array([0.0, 1.0, 0.0]), 0.0
    if min(sure[_LH], sure[_RH]) > 0:
        spine = middle - (points[_LH] + points[_RH]) * 0.5
        size = sqrt(float(spine @ spine))
        if size > 0:
            up = spine / size
        beside = across + points[_LH] - points[_RH]
    else:
        beside = across
        size = sqrt(float(across @ across)) / usual_width
        if min(sure[_LE], sure[_RE]) > 0:
            size = max(size, float(points[_LE, 1] + points[_RE, 1] - 2 * middle[1]) / (2 * EARS_UP))
    if size <= 0 or up[1] < LEAST_UPRIGHT:
        return None
    if dims == 3:
        heading = atan2(-float(beside[2]), float(beside[0]))
        up = turn_about_y(up, -heading)
    return MeasuredFrame(size, up, heading, float(across[0]) / size)


def measure_pose(layer: Layer, points: Array, frame: MeasuredFrame) -> Array:
    """Return a layer's measures `[N, 3]` of a person, as if facing the camera; along x and y alone in two
    dimensions.
    """
    vectors = ROWS[layer] @ points / frame.size
    if frame.heading:
        vectors = turn_about_y(vectors, -frame.heading)
    return vectors if UPRIGHT[layer] else straighten(vectors, frame.up)
