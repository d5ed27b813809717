"""Make a plain stool for a sitting figure: a round seat on four legs that lean outwards a little."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np

from metagraph.motion import rotation
from preview.furniture import LEG_COLOR, SEAT_COLOR, Furniture
from preview.mesh import make_capsule, turn_profile
from preview.scene import Actor


class Stool(Furniture):
    """A stool of a height and a radius in metres."""

    def __init__(self, height: float, radius: float) -> None:
        thick, edge = 0.07 * height, 0.02 * height
        rim = [
            (-thick, 0.0),
            (-thick, radius - edge),
            (-thick + edge, radius),
            (-edge, radius),
            (0.0, radius - edge),
            (0.0, 0.0),
        ]
        parts: list[Any] = [(turn_profile(rim, 36), SEAT_COLOR)]
        for angle in np.radians([45, 135, 225, 315]):
            way = np.array([np.cos(angle), 0.0, np.sin(angle)])
            top, foot = way * 0.62 * radius - [0, thick, 0], way * 0.95 * radius - [0, height, 0]
            length, width = float(np.linalg.norm(top - foot)), 0.035 * height
            positions, normals, triangles = make_capsule(length - width, width, width, 10, 3)
            turn = rotation.find_rotation_between(np.array([0.0, 1, 0]), top - foot)
            shape = (
                rotation.rotate_vectors(turn, positions) + foot + [0, width, 0],
                rotation.rotate_vectors(turn, normals),
                triangles,
            )
            parts.append((shape, LEG_COLOR))
        super().__init__(parts)
        self.height = height


@lru_cache(maxsize=8)
def _stool(height: float, radius: float) -> Stool:
    return Stool(height, radius)


def make_stool(at: tuple[float, float, float], radius: float) -> Actor:
    """Return a stool that stands on the ground. `at` is the middle of the top of its seat, in metres."""
    figure = _stool(round(max(at[1], 0.05), 3), round(radius, 3))
    return Actor(figure, np.array([[0.0, 0, 0, 1]], np.float32), np.array([at], np.float32))
