"""The morph targets of our characters' faces, by ARKit's names: what each moves, and where to.

Eyes and lids are joints; so is the jaw for who has no targets. Places are those of the rest pose (metres).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.motion import rotation
from sample_clips.make.shapes import JOINT, MOUTH_HALF, MOUTH_Y, mouth_line, step

Array = NDArray[Any]
Target = Callable[["Face"], Array]

JAW_OPEN = 20.0  # degrees at 1
_CORNER = (MOUTH_HALF, MOUTH_Y + 0.001, 0.0745)
_CHEEK = (0.0370, 1.5720, 0.0600)
_NOSTRIL = (0.0120, 1.5740, 0.0900)
_BROW_INNER = (0.0165, 1.6300, 0.0860)  # angry brows slant: their inner ends go down
_BROW_OUTER = (0.0440, 1.6320, 0.0790)


class Face:
    """Points of a face `[V, 3]` at rest, and how much each is moved by the jaw `[V]`."""

    def __init__(self, p: Array, jaw: Array) -> None:
        self.p, self.jaw = p, jaw
        line = mouth_line(p[:, 0])
        front = step(0.045, 0.062, p[:, 2])
        across = step(MOUTH_HALF + 0.010, MOUTH_HALF - 0.004, np.abs(p[:, 0]))
        high = p[:, 1] - line
        lower = jaw > 0.5
        self.upper_lip = front * across * step(0.019, 0.004, np.abs(high)) * ~lower
        self.lower_lip = front * across * step(0.019, 0.004, np.abs(high)) * lower
        self.high = high
        self.lips = self.upper_lip + self.lower_lip

    def near(self, at: tuple[float, float, float], reach: float, side: float = 0.0) -> Array:
        """Return 1 at a place, less about it `[V]`; side: 1 the left, -1 the right, 0 in the middle."""
        place = np.array([at[0] * (side or 1.0), at[1], at[2]])
        return np.asarray(np.exp(-(np.linalg.norm(self.p - place, axis=1) ** 2) / reach**2))

    def half(self, side: float) -> Array:
        """Return 1 on a side of the face, 0 on the other, smooth over the middle `[V]`."""
        return step(-0.008, 0.008, side * self.p[:, 0])


def _moved(weight: Array, by: tuple[float, float, float]) -> Array:
    return weight[:, None] * np.array(by)


def _jaw(f: Face, degrees: float) -> Array:
    turn = rotation.from_axis_angle(np.array([1.0, 0, 0]), np.radians(degrees))
    away = f.p - JOINT["Jaw"]
    return np.asarray(f.jaw[:, None] * (rotation.rotate(np.tile(turn, (len(away), 1)), away) - away))


def _smile(f: Face, s: float) -> Array:
    corner = f.near(_CORNER, 0.015, s)
    return (
        _moved(corner, (0.0058 * s, 0.0090, -0.0036))
        + _moved(f.near((0.0290, 1.5580, 0.0700), 0.015, s), (0.0017 * s, 0.0036, 0.0010))
        + _moved(f.near(_CHEEK, 0.020, s), (0.0008 * s, 0.0032, 0.0022))
    )


def _frown(f: Face, s: float) -> Array:
    return _moved(f.near(_CORNER, 0.014, s), (0.0010 * s, -0.0080, -0.0010)) + _moved(
        f.near((0.0240, 1.5260, 0.0690), 0.013, s), (0.0, -0.0020, 0.0010)
    )


def _squint(f: Face, s: float) -> Array:
    return _moved(f.near((0.0330, 1.5860, 0.0740), 0.014, s), (0.0, 0.0034, 0.0012))


def _pucker(f: Face, forward: float, narrow: float, apart: float) -> Array:
    ring = f.near((0.0, MOUTH_Y, 0.084), 0.026)
    out = _moved(ring, (0.0, 0.0, forward))
    out[:, 0] -= narrow * ring * f.p[:, 0]
    out[:, 1] += apart * (f.upper_lip - f.lower_lip)
    return out


def _sided(make: Callable[[Face, float], Array]) -> dict[str, Target]:
    return {"Left": lambda f: make(f, 1.0), "Right": lambda f: make(f, -1.0)}


_PAIRS: dict[str, Callable[[Face, float], Array]] = {
    "mouthSmile": _smile,
    "mouthFrown": _frown,
    "mouthDimple": lambda f, s: _moved(f.near(_CORNER, 0.012, s), (0.0022 * s, 0.0006, -0.0042)),
    "mouthStretch": lambda f, s: _moved(f.near(_CORNER, 0.017, s), (0.0066 * s, -0.0012, -0.0030)),
    "mouthPress": lambda f, s: (
        f.half(s)[:, None] * (_moved(f.lips, (0, 0, -0.0016)) + _flat(f, 0.25))
    ),
    "mouthUpperUp": lambda f, s: _moved(f.upper_lip * f.half(s), (0.0, 0.0050, 0.0010)),
    "mouthLowerDown": lambda f, s: _moved(f.lower_lip * f.half(s), (0.0, -0.0056, 0.0006)),
    "cheekSquint": lambda f, s: (
        _moved(f.near(_CHEEK, 0.022, s), (0.0006 * s, 0.0044, 0.0028)) + _squint(f, s)
    ),
    "eyeSquint": _squint,
    "noseSneer": lambda f, s: _moved(f.near(_NOSTRIL, 0.013, s), (0.0010 * s, 0.0038, 0.0010)),
    "browDown": lambda f, s: (
        _moved(f.near(_BROW_INNER, 0.017, s), (-0.0030 * s, -0.0074, 0.0012))
        + _moved(f.near(_BROW_OUTER, 0.018, s), (-0.0010 * s, -0.0020, 0.0))
    ),
    "browOuterUp": lambda f, s: _moved(f.near(_BROW_OUTER, 0.020, s), (0.0, 0.0072, 0.0)),
}  # fmt: skip


def _flat(f: Face, share: float) -> Array:
    """Bring the lips towards the line between them."""
    out = np.zeros_like(f.p)
    out[:, 1] = -share * f.lips * np.clip(f.high, -0.010, 0.010)
    return out


TARGETS: dict[str, Target] = {
    "jawOpen": lambda f: _jaw(f, JAW_OPEN),
    "jawForward": lambda f: _moved(f.jaw, (0, 0, 0.0050)),
    "jawLeft": lambda f: _moved(f.jaw, (0.0050, 0, 0)),
    "jawRight": lambda f: _moved(f.jaw, (-0.0050, 0, 0)),
    "mouthClose": lambda f: -0.9 * _jaw(f, JAW_OPEN) * f.lips[:, None],
    "mouthFunnel": lambda f: _pucker(f, 0.0075, 0.24, 0.0038),
    "mouthPucker": lambda f: _pucker(f, 0.0090, 0.42, 0.0006),
    "mouthLeft": lambda f: _moved(f.near((0, MOUTH_Y, 0.08), 0.030), (0.0060, 0, 0)),
    "mouthRight": lambda f: _moved(f.near((0, MOUTH_Y, 0.08), 0.030), (-0.0060, 0, 0)),
    "mouthRollLower": lambda f: _moved(f.lower_lip, (0, 0.0026, -0.0046)),
    "mouthRollUpper": lambda f: _moved(f.upper_lip, (0, -0.0022, -0.0042)),
    "mouthShrugLower": lambda f: _moved(f.lower_lip, (0, 0.0036, 0.0016)),
    "mouthShrugUpper": lambda f: _moved(f.upper_lip, (0, 0.0030, 0.0010)),
    "browInnerUp": lambda f: _moved(
        f.near(_BROW_INNER, 0.017, 1.0) + f.near(_BROW_INNER, 0.017, -1.0),
        (0, 0.0080, 0),
    ),
    "cheekPuff": lambda f: (
        _moved(f.near((0.0400, 1.5450, 0.0560), 0.022, 1.0), (0.0068, 0, 0.0040))
        + _moved(f.near((0.0400, 1.5450, 0.0560), 0.022, -1.0), (-0.0068, 0, 0.0040))
    ),
    **{name + side: make for name, pair in _PAIRS.items() for side, make in _sided(pair).items()},
}


def offsets(p: Array, jaw: Array, chosen: Array) -> Array:
    """Return `[K, V, 3]` what each target moves points `[V, 3]` by, in the order of `TARGETS`. jaw: how much
    each is moved by the jaw. chosen `[V]`: which are of the face; the others stay.
    """
    face = Face(p, jaw)
    out = np.stack([target(face) for target in TARGETS.values()]) * chosen[None, :, None]
    out[np.abs(out).max(2) < 2e-5] = 0
    return np.asarray(out, np.float32)
