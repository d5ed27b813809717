"""Vectors and rotations as plain tuples, for code that computes one pose at a time, the same in all
languages. Vectors are x, y, z; quaternions xyzw, of length 1.
"""

from __future__ import annotations

from math import sqrt

Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]


def times(a: Quaternion, b: Quaternion) -> Quaternion:
    """Return the product: rotate by `b`, then by `a`."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def rotated(q: Quaternion, v: Vector) -> Vector:
    """Return a vector rotated."""
    x, y, z, w = q
    vx, vy, vz = v
    tx, ty, tz = 2.0 * (y * vz - z * vy), 2.0 * (z * vx - x * vz), 2.0 * (x * vy - y * vx)
    return (
        vx + w * tx + y * tz - z * ty,
        vy + w * ty + z * tx - x * tz,
        vz + w * tz + x * ty - y * tx,
    )


def between(a: Vector, b: Vector) -> Quaternion:
    """Return the shortest rotation that takes one direction to another, both of length 1."""
    ax, ay, az = a
    bx, by, bz = b
    along = ax * bx + ay * by + az * bz
    if along < -0.999999999:  # half a turn about any axis across
        return unit_turn((0.0, az, -ay, 0.0) if abs(ax) < 0.9 else (-az, 0.0, ax, 0.0))
    return unit_turn((ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx, 1.0 + along))


def length(v: Vector) -> float:
    """Return the length of a vector."""
    x, y, z = v
    return sqrt(x * x + y * y + z * z)


def unit(v: Vector) -> Vector:
    """Return a vector of length 1 in the same direction; the zero vector stays as it is."""
    return scaled(v, 1.0 / max(length(v), 1e-12))


def unit_turn(q: Quaternion) -> Quaternion:
    """Return a quaternion of length 1."""
    x, y, z, w = q
    k = 1.0 / max(sqrt(x * x + y * y + z * z + w * w), 1e-12)
    return (x * k, y * k, z * k, w * k)


def back(q: Quaternion) -> Quaternion:
    """Return the inverse rotation."""
    x, y, z, w = q
    return (-x, -y, -z, w)


def plus(a: Vector, b: Vector) -> Vector:
    """Return the sum."""
    ax, ay, az = a
    bx, by, bz = b
    return (ax + bx, ay + by, az + bz)


def minus(a: Vector, b: Vector) -> Vector:
    """Return the difference."""
    ax, ay, az = a
    bx, by, bz = b
    return (ax - bx, ay - by, az - bz)


def scaled(a: Vector, k: float) -> Vector:
    """Return a vector times a number."""
    x, y, z = a
    return (x * k, y * k, z * k)


def dot(a: Vector, b: Vector) -> float:
    """Return the scalar product."""
    ax, ay, az = a
    bx, by, bz = b
    return ax * bx + ay * by + az * bz
