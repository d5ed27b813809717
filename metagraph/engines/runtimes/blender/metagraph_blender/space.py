# SPDX-License-Identifier: GPL-3.0-or-later
"""Between joints (metres, Y up, quaternions xyzw) and Blender's bones (Z up, each with axes of its own).
Needs NumPy alone, which Blender brings along.

A bone that rests as R in the armature's space, for a joint that rests as G in the character's, differs from
it by a turn C that stays: R = A G C, where A turns Y up to Z up. What a bone adds to its rest pose is then
C^-1 q0^-1 q C for a joint's local rotation q and its rest q0, whatever stands above it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

UP = np.array([np.sqrt(0.5), 0.0, 0.0, np.sqrt(0.5)])  # turns Y up to Z up


def multiply(a: Array, b: Array) -> Array:
    """Return the products of quaternions `[..., 4]`, xyzw."""
    ax, ay, az, aw = np.moveaxis(np.asarray(a, float), -1, 0)
    bx, by, bz, bw = np.moveaxis(np.asarray(b, float), -1, 0)
    return np.stack(
        [
            aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
            aw * bw - ax * bx - ay * by - az * bz,
        ],
        -1,
    )


def inverse(q: Array) -> Array:
    """Return the inverse of unit quaternions."""
    return np.asarray(np.asarray(q, float) * [-1.0, -1.0, -1.0, 1.0])


def rotate(q: Array, v: Array) -> Array:
    """Return vectors `[..., 3]` turned by unit quaternions."""
    q, v = np.asarray(q, float), np.asarray(v, float)
    across = 2 * np.cross(q[..., :3], v)
    return np.asarray(v + q[..., 3:] * across + np.cross(q[..., :3], across))


def continuous(q: Array) -> Array:
    """Return rotations `[F, J, 4]` of which each is on the side of the one before."""
    flips = np.where((q[1:] * q[:-1]).sum(-1) < 0, -1.0, 1.0)
    signs = np.concatenate([np.ones((1, *q.shape[1:2])), np.cumprod(flips, 0)])
    return np.asarray(q * signs[..., None])


class Figure:
    """The joints of an export. names: `[J]`, parents first. parents: `[J]`, -1 for none. rest_rotations,
    rest_translations: local, `[J, 4]`, `[J, 3]`.
    """

    def __init__(self, joints: Sequence[Mapping[str, Any]]) -> None:
        self.names = [str(joint["name"]) for joint in joints]
        place = {name: n for n, name in enumerate(self.names)}
        self.parents = [-1 if joint["parent"] is None else place[joint["parent"]] for joint in joints]
        self.rest_rotations = np.array([joint["rotation"] for joint in joints], float)
        self.rest_translations = np.array([joint["translation"] for joint in joints], float)

    def globals(self, rotations: Array, translations: Array) -> tuple[Array, Array]:
        """Return rotations and places in the character's space of local poses `[..., J, n]`."""
        turns, places = np.array(rotations, float), np.array(translations, float)
        for joint, parent in enumerate(self.parents):
            if parent >= 0:
                places[..., joint, :] = places[..., parent, :] + rotate(
                    turns[..., parent, :], places[..., joint, :]
                )
                turns[..., joint, :] = multiply(turns[..., parent, :], turns[..., joint, :])
        return turns, places

    def locals(self, turns: Array, places: Array) -> tuple[Array, Array]:
        """Return local rotations and translations of poses in the character's space."""
        rotations, translations = np.array(turns, float), np.array(places, float)
        for joint, parent in enumerate(self.parents):
            if parent >= 0:
                back = inverse(turns[..., parent, :])
                rotations[..., joint, :] = multiply(back, turns[..., joint, :])
                translations[..., joint, :] = rotate(back, places[..., joint, :] - places[..., parent, :])
        return rotations, translations

    def corrections(self, bones: Array) -> Array:
        """Return C of each joint `[J, 4]`. bones: how its bone rests in the armature's space."""
        turns, _ = self.globals(self.rest_rotations, self.rest_translations)
        return multiply(inverse(multiply(UP, turns)), bones)

    def to_bones(self, corrections: Array, rotations: Array, translations: Array) -> tuple[Array, Array]:
        """Return what bones add to their rest pose, rotations and locations, for local poses of joints."""
        back = multiply(inverse(corrections), inverse(self.rest_rotations))
        turns = multiply(multiply(back, rotations), corrections)
        return turns, rotate(back, np.asarray(translations) - self.rest_translations)

    def from_bones(self, corrections: Array, turns: Array, places: Array) -> tuple[Array, Array]:
        """Return local poses of joints. turns, places: of bones, in the armature's space, whatever moves
        them, `[..., J, n]`.
        """
        back = inverse(UP)
        own = multiply(multiply(back, turns), inverse(corrections))
        return self.locals(own, rotate(back, np.asarray(places, float)))
