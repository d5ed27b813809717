"""Forward kinematics as a compiled loop: the same to the bit as `forward.Forward`. Importing this imports
numba.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from metagraph.compiling import compiler

Array = Any
KEPT, SOURCES = ("globals_of",), ()

_exact = compiler(nogil=True, error_model="numpy")
# Kept as part of what calls it alone: numba would take this one for one with other options, and the other way
# round.
_inside = compiler(keep=False, nogil=True, error_model="numpy")


def to_model(parents: Array, local_r: Array, local_t: Array, out_r: Array, out_p: Array) -> None:
    """Write model-space rotations `[J, 4]` and positions `[J, 3]` of one pose. The order of the sums is that
    of `Forward`.
    """
    for j in range(len(parents)):
        p = parents[j]
        a, b, e, s = local_r[j, 0], local_r[j, 1], local_r[j, 2], local_r[j, 3]
        vx, vy, vz = local_t[j, 0], local_t[j, 1], local_t[j, 2]
        if p < 0:
            out_r[j, 0], out_r[j, 1], out_r[j, 2], out_r[j, 3] = a, b, e, s
            out_p[j, 0], out_p[j, 1], out_p[j, 2] = vx, vy, vz
            continue
        x, y, z, w = out_r[p, 0], out_r[p, 1], out_r[p, 2], out_r[p, 3]
        tx, ty, tz = y * vz - z * vy, z * vx - x * vz, x * vy - y * vx
        tx, ty, tz = tx + tx, ty + ty, tz + tz
        out_p[j, 0] = w * tx + vx + y * tz - z * ty + out_p[p, 0]
        out_p[j, 1] = w * ty + vy + z * tx - x * tz + out_p[p, 1]
        out_p[j, 2] = w * tz + vz + x * ty - y * tx + out_p[p, 2]
        out_r[j, 0] = w * a + x * s + y * e - z * b
        out_r[j, 1] = w * b - x * e + y * s + z * a
        out_r[j, 2] = w * e + x * b - y * a + z * s
        out_r[j, 3] = w * s - x * a - y * b - z * e


_one = _inside(to_model)


@_exact
def globals_of(parents: Array, local_r: Array, local_t: Array, out_r: Array, out_p: Array) -> None:
    """Write model-space rotations `[F, J, 4]` and positions `[F, J, 3]` of poses."""
    for f in range(len(local_r)):
        _one(parents, local_r[f], local_t[f], out_r[f], out_p[f])


def warm() -> None:
    """Have ready what is called with float32."""
    turns, places = np.zeros((0, 1, 4), np.float32), np.zeros((0, 1, 3), np.float32)
    globals_of(np.zeros(1, np.int64), turns, places, turns, places)
