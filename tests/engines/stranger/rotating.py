"""Quaternions xyzw [..., 4] of unit length, as docs/reference uses them."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[np.floating[Any]]


def unit(q: Numbers) -> Numbers:
    return q / np.linalg.norm(q, axis=-1, keepdims=True)


def times(a: Numbers, b: Numbers) -> Numbers:
    """a * b: turns by b first and then by a."""
    ax, ay, az, aw = np.moveaxis(a, -1, 0)
    bx, by, bz, bw = np.moveaxis(b, -1, 0)
    return np.stack(
        [
            aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
            aw * bw - ax * bx - ay * by - az * bz,
        ],
        -1,
    )


def inverse(q: Numbers) -> Numbers:
    return q * np.array([-1.0, -1.0, -1.0, 1.0])


def turned(q: Numbers, v: Numbers) -> Numbers:
    """v turned by q."""
    twice = 2.0 * np.cross(q[..., :3], v)
    return v + q[..., 3:] * twice + np.cross(q[..., :3], twice)


def near(a: Numbers, b: Numbers) -> Numbers:
    """b or -b, whichever is on a's side."""
    return np.where(np.sum(a * b, -1, keepdims=True) < 0.0, -b, b)


def nlerp(a: Numbers, b: Numbers, share: Any) -> Numbers:
    return unit(a + share * (near(a, b) - a))


def slerp(a: Numbers, b: Numbers, share: Any) -> Numbers:
    b = near(a, b)
    angle = np.arccos(np.clip(np.sum(a * b, -1, keepdims=True), -1.0, 1.0))
    sine = np.sin(angle)
    small = sine < 1e-6
    by = np.where(small, 1.0, sine)
    first = np.where(small, 1.0 - share, np.sin((1.0 - share) * angle) / by)
    second = np.where(small, share, np.sin(share * angle) / by)
    return unit(first * a + second * b)


def power(q: Numbers, by: Any) -> Numbers:
    """The rotation about q's axis by `by` [...] times its angle, which is at most half a turn."""
    q = np.where(q[..., 3:] < 0.0, -q, q)
    length = np.linalg.norm(q[..., :3], axis=-1, keepdims=True)
    half = np.arctan2(length, q[..., 3:]) * np.asarray(by)[..., None]
    axis = q[..., :3] / np.where(length > 0.0, length, 1.0)
    return np.concatenate([axis * np.sin(half), np.cos(half)], -1)


def about(turn: Numbers) -> Numbers:
    """The rotation of a rotation vector [3]."""
    size = float(np.linalg.norm(turn))
    return np.array([*(turn / max(size, 1e-30) * np.sin(size / 2.0)), np.cos(size / 2.0)])
