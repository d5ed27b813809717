"""Make plain furniture for a sitting figure: it stands still and has one joint, the middle of the top of its
seat. The stool is in a module of its own.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from metagraph.motion import rotation
from metagraph.motion.skeleton import Skeleton
from preview.figure import MeshFigure, join_parts
from preview.mesh import turn_profile
from preview.scene import Actor

Array = NDArray[Any]
Shape = tuple[Array, Array, Array]  # positions, normals, corners of triangles

SEAT_COLOR, LEG_COLOR = (116, 119, 126), (84, 87, 94)  # neutral: in the window colours stand for kinds
RUG_COLOR = (96, 99, 107)
RUG = 0.004  # metres: how thick a rug is
BACK = 1.35  # of its radius: how far behind its middle a chair's back stands
TALL = 0.92  # of a seat's height: how far the back rises above it
LEAN = math.radians(8.0)  # of the back


class Furniture(MeshFigure):
    """Rigid parts, each a shape in metres from the middle of the top of the seat, and its sRGB colour."""

    def __init__(self, parts: list[tuple[Shape, tuple[int, int, int]]]) -> None:
        one = Skeleton(("Seat",), np.array([-1]), np.array([[0.0, 0, 0, 1]]), np.zeros((1, 3)))
        joined = [(shape, 0, np.zeros(3), color) for shape, color in parts]
        super().__init__(one, join_parts(joined, 1), np.zeros(1, int))

    def palette(self, rotations: Array, positions: Array) -> Array:
        turn = np.asarray(rotations, np.float32)
        out = np.empty((*turn.shape[:-1], 3, 4), np.float32)
        out[..., :3] = rotation.to_matrix(turn)
        out[..., 3] = positions
        return out


class Chair(Furniture):
    """A chair of a height and a radius in metres, whose back is towards -Z."""

    def __init__(self, height: float, radius: float) -> None:
        thick, post = 0.07 * height, 0.07 * height
        rear, wide = BACK * radius, radius * 1.1
        front = radius * 1.1
        middle, half = (front - rear) / 2, (front + rear) / 2
        parts = [(make_box((0, -thick / 2, middle), (wide, thick / 2, half)), SEAT_COLOR)]
        leg = (height - thick) / 2
        for side in (-1, 1):
            for z in (front - post, -rear + post):
                at = (side * (wide - post / 2), -thick - leg, z)
                parts.append((make_box(at, (post / 2, leg, post / 2)), LEG_COLOR))
            rise = TALL * height / 2
            upright = make_box((side * (wide - post / 2), rise, 0), (post / 2, rise, post / 2))
            parts.append((_lean(upright, -rear + post / 2), LEG_COLOR))
        for part in (0.55, 0.88):
            slat = make_box((0, part * TALL * height, 0), (wide - post, 0.075 * height, post / 4))
            parts.append((_lean(slat, -rear + post / 2), SEAT_COLOR))
        super().__init__(parts)


class Rug(Furniture):
    """A round rug that lies on the ground, of a radius in metres."""

    def __init__(self, radius: float) -> None:
        rim = [(0.0, 0.0), (0.0, radius), (RUG, radius - RUG), (RUG, 0.0)]
        super().__init__([(turn_profile(rim, 48), RUG_COLOR)])


def make_box(middle: ArrayLike, half: ArrayLike) -> Shape:
    """Return a box with flat sides. `middle` and `half` are its middle and half its size, `[3]`, metres."""
    positions: list[Array] = []
    normals: list[Array] = []
    corners: list[tuple[int, int, int]] = []
    for axis in range(3):
        for sign in (-1.0, 1.0):
            normal = sign * np.eye(3)[axis]
            first = np.eye(3)[(axis + 1) % 3]
            second = np.cross(normal, first)
            count = len(positions)
            positions += [normal + x * first + y * second for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
            normals += [normal] * 4
            corners += [(count, count + 1, count + 2), (count, count + 2, count + 3)]
    shape = np.asarray(positions) * np.asarray(half, float) + np.asarray(middle, float)
    return shape, np.asarray(normals), np.asarray(corners)


def make_chair(at: tuple[float, float, float], radius: float, turn: float) -> Actor:
    """Return a chair that stands on the ground. `at` is the middle of the top of its seat, in metres, `turn`
    where who sits on it faces, radians about +Y.
    """
    return _place(_chair(round(max(at[1], 0.05), 3), round(radius, 3)), at, turn)


def make_rug(at: tuple[float, float, float], radius: float) -> Actor:
    """Return a rug under `at`, in metres."""
    return _place(_rug(round(radius, 3)), (at[0], 0.0, at[2]), 0.0)


def _lean(shape: Shape, z: float) -> Shape:
    """Return a part of a chair's back, leaning backwards from the seat at z."""
    turn = rotation.from_axis_angle(np.array([1.0, 0, 0]), np.array(-LEAN))
    positions, normals, corners = shape
    return (
        rotation.rotate_vectors(turn, positions) + [0, 0, z],
        rotation.rotate_vectors(turn, normals),
        corners,
    )


def _place(figure: Furniture, at: tuple[float, float, float], turn: float) -> Actor:
    facing = rotation.from_axis_angle(np.array([0.0, 1, 0]), np.array(turn))
    return Actor(figure, np.asarray(facing, np.float32)[None], np.array([at], np.float32))


@lru_cache(maxsize=8)
def _chair(height: float, radius: float) -> Chair:
    return Chair(height, radius)


@lru_cache(maxsize=8)
def _rug(radius: float) -> Rug:
    return Rug(radius)
