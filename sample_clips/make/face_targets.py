"""The morph targets of our characters' faces, by ARKit's names, all 52: what each moves, and where to.

Eyes and lids are joints too, which is what moves them here; their targets are for programs that drive a face
by its targets alone. So is the jaw, for who has no targets. Places are those of the rest pose (metres).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.motion import rotation
from sample_clips.make.shapes import JOINT, MOUTH_HALF, MOUTH_Y, mouth_line, step

Array = NDArray[Any]
Target = Callable[["Face"], Array]

JAW_OPEN = 20.0  # degrees at 1
LOOK = 30.0  # degrees an eye turns at 1, and what the lids do with it
LOOK_UPPER, LOOK_LOWER = 18.0, 10.5
UPPER_SHUT, LOWER_SHUT = 40.0, -15.0  # degrees of the lids about the eye, to the left: as their joints
UPPER_WIDE, LOWER_WIDE = -10.0, 4.0
_BULGE = 0.06  # of its radius a shut lid is farther out: half way there it goes straight, through the eye
_TONGUE_OUT = (0.0, 0.0070, 0.0350)  # over the lower lip
_CORNER = (MOUTH_HALF, MOUTH_Y + 0.001, 0.0745)
_CHEEK = (0.0370, 1.5720, 0.0600)
_NOSTRIL = (0.0120, 1.5740, 0.0900)
_BROW_INNER = (0.0165, 1.6300, 0.0860)  # angry brows slant: their inner ends go down
_BROW_OUTER = (0.0440, 1.6320, 0.0790)


class Face:
    """Points of a face `[V, 3]` at rest, how much each is moved by the jaw `[V]`, and how much it is `of`
    eyes, lids and the tongue, each `[V]` by name.
    """

    def __init__(self, p: Array, jaw: Array, of: Mapping[str, Array] | None = None) -> None:
        self.p, self.jaw, self.of = p, jaw, of or {}
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
    return np.asarray(f.jaw[:, None] * (rotation.rotate_vectors(np.tile(turn, (len(away), 1)), away) - away))


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


def _turned(f: Face, name: str, axis: int, degrees: float, bulge: float = 0.0) -> Array:
    """Return what points of an eye or a lid are moved by, turned about the eye; bulge: and farther from it,
    of their distance.
    """
    away = f.p - JOINT[("Left" if name.startswith("Left") else "Right") + "Eye"]
    turn = np.tile(rotation.from_axis_angle(np.eye(3)[axis], np.radians(degrees)), (len(away), 1))
    share = f.of.get(name, np.zeros(len(away)))
    return np.asarray(share[:, None] * ((1 + bulge) * rotation.rotate_vectors(turn, away) - away))


def _lids(f: Face, s: float, upper: float, lower: float, bulge: float = 0.0) -> Array:
    side = "Left" if s > 0 else "Right"
    return _turned(f, f"{side}UpperLid", 0, upper, bulge) + _turned(f, f"{side}LowerLid", 0, lower, bulge)


def _look(f: Face, s: float, axis: int, degrees: float) -> Array:
    out = _turned(f, ("Left" if s > 0 else "Right") + "Eye", axis, degrees)
    if axis == 0:
        out = out + _lids(f, s, degrees / LOOK * LOOK_UPPER, degrees / LOOK * LOOK_LOWER)
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


# Of eyes and lids, which no other target moves.
_EYES: dict[str, Callable[[Face, float], Array]] = {
    "eyeBlink": lambda f, s: _lids(f, s, UPPER_SHUT, LOWER_SHUT, _BULGE),
    "eyeWide": lambda f, s: _lids(f, s, UPPER_WIDE, LOWER_WIDE),
    "eyeLookUp": lambda f, s: _look(f, s, 0, -LOOK),
    "eyeLookDown": lambda f, s: _look(f, s, 0, LOOK),
    "eyeLookIn": lambda f, s: _look(f, s, 1, -s * LOOK),
    "eyeLookOut": lambda f, s: _look(f, s, 1, s * LOOK),
}


def _tongue_out(f: Face) -> Array:
    share = f.of.get("Tongue", np.zeros(len(f.p))) * step(0.042, 0.062, f.p[:, 2])
    return _moved(share, _TONGUE_OUT) + _moved(share * step(0.060, 0.071, f.p[:, 2]), (0.0, -0.0026, 0.0))


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
    **{name + side: make for name, pair in _EYES.items() for side, make in _sided(pair).items()},
    "tongueOut": _tongue_out,
}


def offsets(p: Array, jaw: Array, chosen: Array, of: Mapping[str, Array] | None = None) -> Array:
    """Return `[K, V, 3]` what each target moves points `[V, 3]` by, in the order of `TARGETS`. jaw: how much
    each is moved by the jaw. chosen `[V]`: which are of the face; the others stay. of: how much each is of
    LeftEye, LeftUpperLid, LeftLowerLid, the same of the right, and Tongue.
    """
    face = Face(p, jaw, of)
    free = [name.startswith(tuple(_EYES)) for name in TARGETS]  # what these move is not of the face
    out = np.stack([target(face) for target in TARGETS.values()])
    out *= np.where(np.array(free)[:, None], 1.0, chosen)[:, :, None]
    out[np.abs(out).max(2) < 2e-5] = 0
    return np.asarray(out, np.float32)
