"""The measures that stray poses are told by, as a compiled loop: those of `stray_poses` to 1e-6. Importing
this imports numba.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from metagraph.compiling import compiler
from metagraph.motion import forward_kernels

Array = Any
KEPT, SOURCES = ("measure",), (forward_kernels,)

_exact = compiler(nogil=True, error_model="numpy")
_to_model = compiler(keep=False, nogil=True, error_model="numpy")(forward_kernels.to_model)


@_exact
def measure(
    parents: Array, rotations: Array, translations: Array, translated: Array, rest: Array, weights: Array,
    places: Array, sizes: Array, turned: Array, gone: Array,
) -> None:  # fmt: skip
    """Write where the joints of a take are, from their middle, `[F, J, 3]`, the weighted root mean squares of
    that, `[F]`, and of the ways from each frame to the next, and those of the middles, `[F - 1]`.

    rotations `[F, J, 4]`, translations `[F, T, 3]`: local, the latter of the joints `translated [T]`; others
    are where `rest [J, 3]` has them. weights `[J]`: how much joints count. A frame's numbers are each written
    once: two threads may have a frame in common.
    """
    joints = len(parents)
    turns, local, whole = np.empty((joints, 4), np.float32), rest.copy(), np.empty((joints, 3), np.float32)
    middle, before = np.zeros(3), np.zeros(3)
    for f in range(len(rotations)):
        for n in range(len(translated)):
            for i in range(3):
                local[translated[n], i] = translations[f, n, i]
        own = places[f]
        _to_model(parents, rotations[f], local, turns, whole)
        for i in range(3):
            total = 0.0
            for j in range(joints):
                total += np.float64(whole[j, i]) * weights[j]
            before[i], middle[i] = middle[i], total
        size = step = 0.0
        for j in range(joints):
            here = there = 0.0
            for i in range(3):
                own[j, i] = whole[j, i] - np.float32(middle[i])
                here += np.float64(own[j, i]) ** 2
                if f:
                    there += np.float64(own[j, i] - places[f - 1, j, i]) ** 2
            size += here * weights[j]
            step += there * weights[j]
        sizes[f] = math.sqrt(size)
        if f:
            turned[f - 1] = math.sqrt(step)
            far = (middle[0] - before[0]) ** 2 + (middle[1] - before[1]) ** 2 + (middle[2] - before[2]) ** 2
            gone[f - 1] = math.sqrt(far)


def warm() -> None:
    """Have ready what clips are measured with, whose arrays are not to be written to."""
    turns, ways = np.zeros((0, 1, 4), np.float32), np.zeros((0, 1, 3), np.float32)
    places, few = ways.copy(), np.zeros(0)
    for array in (turns, ways):
        array.setflags(write=False)
    one = np.zeros(1, np.int64)
    measure(one, turns, ways, one, places[:0, 0].copy(), few, places, few, few, few)
