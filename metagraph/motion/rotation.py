"""Compute with rotations as quaternions: `xyzw`, float, unit length, arrays with free leading dimensions
`[..., 4]`.

`multiply(a, b)` applies `b` first, then `a`, as matrices do. Angles are radians.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]
Numbers = Any  # anything that numpy.asarray takes: arrays, nested sequences, numbers

IDENTITY: Array = np.array([0.0, 0.0, 0.0, 1.0])

# `multiply` computes up to so many numbers as rows of products, because NumPy takes longer to begin than to
# compute them: 20 instead of 57 us for 52 joints. Products and sums are the same, and so is each bit.
FEW = 4096
_W_X_Y_Z = np.array([3, 0, 1, 2])
_OTHERS = np.array(
    [[0, 1, 2, 3], [3, 2, 1, 0], [2, 3, 0, 1], [1, 0, 3, 2]]
)  # which of b these are multiplied with
_SIGNS = np.array([[1, 1, 1, 1], [1, -1, 1, -1], [1, 1, -1, -1], [-1, 1, 1, -1]], np.float32)


def make_identity_rotations(shape: tuple[int, ...] = (), dtype: Any = np.float64) -> Array:
    """Return unit rotations `[*shape, 4]`."""
    out = np.zeros((*shape, 4), dtype)
    out[..., 3] = 1
    return out


def normalize(q: Numbers) -> Array:
    """Scale to unit length `[..., 4]`; a zero quaternion becomes the identity."""
    q = np.asarray(q)
    length = np.sqrt(np.einsum("...i,...i->...", q, q))[..., None]
    if length.min(initial=1) > 1e-12:
        return np.asarray(q / length)
    safe = np.where(length > 1e-12, length, 1)
    return np.asarray(
        np.where(length > 1e-12, q / safe, np.asarray(IDENTITY, q.dtype if q.dtype.kind == "f" else float))
    )


def conjugate(q: Numbers) -> Array:
    """Return the inverse of unit quaternions `[..., 4]`."""
    q = np.asarray(q)
    return np.asarray(q * np.array([-1, -1, -1, 1], q.dtype))


def multiply(a: Numbers, b: Numbers) -> Array:
    """Return the product `[..., 4]`: rotate by `b`, then by `a`."""
    a, b = np.asarray(a), np.asarray(b)
    if a.size <= FEW and b.size <= FEW:
        each = b.take(_OTHERS, -1) * _SIGNS * a.take(_W_X_Y_Z, -1)[..., None]
        return np.asarray(((each[..., 0, :] + each[..., 1, :]) + each[..., 2, :]) + each[..., 3, :])
    ax, ay, az, aw = a[..., 0], a[..., 1], a[..., 2], a[..., 3]
    bx, by, bz, bw = b[..., 0], b[..., 1], b[..., 2], b[..., 3]
    out = np.empty((*np.broadcast_shapes(a.shape, b.shape)[:-1], 4), np.result_type(a, b))
    out[..., 0] = aw * bx + ax * bw + ay * bz - az * by
    out[..., 1] = aw * by - ax * bz + ay * bw + az * bx
    out[..., 2] = aw * bz + ax * by - ay * bx + az * bw
    out[..., 3] = aw * bw - ax * bx - ay * by - az * bz
    return out


def rotate_vectors(q: Numbers, v: Numbers) -> Array:
    """Rotate vectors `v [..., 3]` by `q [..., 4]`."""
    q, v = np.asarray(q), np.asarray(v)
    x, y, z, w = q[..., 0], q[..., 1], q[..., 2], q[..., 3]
    vx, vy, vz = v[..., 0], v[..., 1], v[..., 2]
    tx, ty, tz = 2 * (y * vz - z * vy), 2 * (z * vx - x * vz), 2 * (x * vy - y * vx)
    out = np.empty((*np.broadcast_shapes(q.shape[:-1], v.shape[:-1]), 3), np.result_type(q, v))
    out[..., 0] = vx + w * tx + y * tz - z * ty
    out[..., 1] = vy + w * ty + z * tx - x * tz
    out[..., 2] = vz + w * tz + x * ty - y * tx
    return out


def from_axis_angle(axis: Numbers, angle: Numbers) -> Array:
    """Return rotations `[..., 4]` of `angle [...]` radians about `axis [..., 3]` (any length but zero)."""
    axis, angle = np.asarray(axis, float), np.asarray(angle, float)
    axis = axis / np.maximum(np.linalg.norm(axis, axis=-1, keepdims=True), 1e-12)
    half = angle[..., None] / 2
    return np.concatenate([axis * np.sin(half), np.cos(half) + 0 * axis[..., :1]], -1)


def from_euler(angles: Numbers, order: str) -> Array:
    """Return rotations `[..., 4]` from intrinsic Euler `angles [..., 3]` (radians). In an `order` like "ZXY",
    the first axis is the outermost rotation.
    """
    angles = np.asarray(angles)
    half = angles * 0.5
    s, c = np.sin(half), np.cos(half)
    out: Array | None = None
    for i, axis in enumerate(order.upper()):
        q = np.zeros((*angles.shape[:-1], 4), angles.dtype)
        q[..., "XYZ".index(axis)] = s[..., i]
        q[..., 3] = c[..., i]
        out = q if out is None else multiply(out, q)
    assert out is not None
    return out


def to_euler(q: Numbers, order: str = "ZXY") -> Array:
    """Return intrinsic Euler angles `[..., 3]` (radians) of unit `q [..., 4]` for an `order` of three
    different axes.
    """
    m = to_matrix(q)
    i, j, k = ("XYZ".index(a) for a in order.upper())
    sign = 1.0 if (i, j, k) in ((0, 1, 2), (1, 2, 0), (2, 0, 1)) else -1.0
    middle = np.arcsin(np.clip(sign * m[..., i, k], -1, 1))
    locked = np.abs(m[..., i, k]) > 1 - 1e-9
    first = np.where(
        locked, np.arctan2(sign * m[..., k, j], m[..., j, j]), np.arctan2(-sign * m[..., j, k], m[..., k, k])
    )
    last = np.where(locked, 0.0, np.arctan2(-sign * m[..., i, j], m[..., i, i]))
    return np.stack([first, middle, last], -1)


def to_matrix(q: Numbers) -> Array:
    """Return rotation matrices `[..., 3, 3]` of unit quaternions."""
    q = np.asarray(q)
    x, y, z, w = q[..., 0], q[..., 1], q[..., 2], q[..., 3]
    out = np.empty((*q.shape[:-1], 3, 3), q.dtype)
    out[..., 0, 0] = 1 - 2 * (y * y + z * z)
    out[..., 0, 1] = 2 * (x * y - w * z)
    out[..., 0, 2] = 2 * (x * z + w * y)
    out[..., 1, 0] = 2 * (x * y + w * z)
    out[..., 1, 1] = 1 - 2 * (x * x + z * z)
    out[..., 1, 2] = 2 * (y * z - w * x)
    out[..., 2, 0] = 2 * (x * z - w * y)
    out[..., 2, 1] = 2 * (y * z + w * x)
    out[..., 2, 2] = 1 - 2 * (x * x + y * y)
    return out


def from_matrix(m: Numbers) -> Array:
    """Return quaternions `[..., 4]` of proper rotation matrices `[..., 3, 3]`, with `w >= 0`."""
    m = np.asarray(m, float)
    xx, yy, zz = m[..., 0, 0], m[..., 1, 1], m[..., 2, 2]
    rows = np.empty((*m.shape[:-2], 4, 4))  # four times the products of the quaternion's components
    rows[..., 0, 0], rows[..., 1, 1] = 1 + xx - yy - zz, 1 - xx + yy - zz
    rows[..., 2, 2], rows[..., 3, 3] = 1 - xx - yy + zz, 1 + xx + yy + zz
    for a, b, c in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        ab, ba = m[..., a, b], m[..., b, a]
        rows[..., a, b] = rows[..., b, a] = ab + ba
        rows[..., c, 3] = rows[..., 3, c] = ba - ab
    flat = rows.reshape(-1, 4, 4)
    best = np.argmax(flat.reshape(-1, 16)[:, ::5], -1)
    q = normalize(flat[np.arange(len(flat)), best].reshape(*m.shape[:-2], 4))
    return np.where(q[..., 3:] < 0, -q, q)


def log(q: Numbers) -> Array:
    """Return rotation vectors `[..., 3]` (axis times angle, at most pi) of unit quaternions."""
    q = np.asarray(q)
    q = np.where(q[..., 3:] < 0, -q, q)
    s = np.sqrt(np.einsum("...i,...i->...", q[..., :3], q[..., :3]))[..., None]
    factor = np.where(s > 1e-8, 2 * np.arctan2(s, q[..., 3:]) / np.where(s > 1e-8, s, 1), 2.0)
    return np.asarray(q[..., :3] * factor)


def exp(v: Numbers) -> Array:
    """Return unit quaternions `[..., 4]` of rotation vectors `[..., 3]`."""
    v = np.asarray(v)
    angle = np.sqrt(np.einsum("...i,...i->...", v, v))[..., None]
    factor = np.where(angle > 1e-8, np.sin(angle / 2) / np.where(angle > 1e-8, angle, 1), 0.5)
    return np.concatenate([v * factor, np.cos(angle / 2)], -1)


def scale_rotation(q: Numbers, weight: Numbers) -> Array:
    """Return `q [..., 4]` with its angle multiplied by `weight [...]`, the short way; 0 gives the identity, 1
    gives `q`.
    """
    return exp(log(q) * np.asarray(weight)[..., None])


def nlerp(a: Numbers, b: Numbers, weight: Numbers) -> Array:
    """Blend `a` to `b [..., 4]` by `weight [...]` in 0..1 along the shorter arc: a normalised straight
    line.
    """
    a, b = np.asarray(a), np.asarray(b)
    w = np.asarray(weight)[..., None].astype(a.dtype)
    dot = np.einsum("...i,...i->...", a, b)[..., None]
    mixed = a * (1 - w) + b * np.where(dot < 0, -w, w)
    return np.asarray(
        mixed / np.sqrt(np.maximum(np.einsum("...i,...i->...", mixed, mixed), 1e-20))[..., None]
    )


def slerp(a: Numbers, b: Numbers, weight: Numbers) -> Array:
    """Blend `a` to `b [..., 4]` by `weight [...]` in 0..1 at constant speed along the shorter arc."""
    a, b = np.asarray(a), np.asarray(b)
    return multiply(a, scale_rotation(multiply(conjugate(a), b), weight))


def measure_angle_between(a: Numbers, b: Numbers) -> Array:
    """Return the angle `[...]` in radians, 0..pi, between two rotations."""
    d = multiply(conjugate(a), b)
    return np.asarray(2 * np.arctan2(np.linalg.norm(d[..., :3], axis=-1), np.abs(d[..., 3])))


def make_continuous(q: Numbers) -> Array:
    """Flip signs along the first axis of `q [F, ..., 4]` so that neighbours are on the same side."""
    q = np.asarray(q)
    if len(q) < 2:
        return np.asarray(q)
    flips = np.einsum("...i,...i->...", q[1:], q[:-1]) < 0
    odd = np.concatenate([np.zeros((1, *flips.shape[1:]), bool), np.cumsum(flips, 0) % 2 == 1])
    return np.asarray(np.where(odd[..., None], -q, q))


def find_rotation_between(a: Numbers, b: Numbers) -> Array:
    """Return the shortest rotation `[..., 4]` from direction `a [..., 3]` to direction `b [..., 3]`."""
    a, b = np.asarray(a, float), np.asarray(b, float)
    a = a / np.maximum(np.linalg.norm(a, axis=-1, keepdims=True), 1e-12)
    b = b / np.maximum(np.linalg.norm(b, axis=-1, keepdims=True), 1e-12)
    dot = np.einsum("...i,...i->...", a, b)[..., None]
    # Opposite directions: rotate by half a turn about any perpendicular axis.
    side = np.where(np.abs(a[..., :1]) < 0.9, np.array([1.0, 0, 0]), np.array([0, 1.0, 0]))
    axis = np.where(dot < -1 + 1e-9, np.cross(a, side), np.cross(a, b))
    return normalize(np.concatenate([axis, np.where(dot < -1 + 1e-9, 0.0, 1 + dot)], -1))
