"""A skinned mesh on a skeleton, as read from a GLB: what the preview draws."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.motion.skeleton import Skeleton

Array = NDArray[Any]


@dataclass(frozen=True, eq=False)
class Material:
    """color: linear RGBA 0..1. image: encoded PNG or JPEG bytes of the base colour texture, or None."""

    name: str
    color: tuple[float, float, float, float] = (0.8, 0.8, 0.8, 1.0)
    image: bytes | None = None
    roughness: float = 0.8
    double_sided: bool = False


@dataclass(frozen=True, eq=False)
class Surface:
    """A run of triangles with one material: `first` and `count` are in triangles."""

    first: int
    count: int
    material: int


@dataclass(frozen=True, eq=False)
class Character:
    """positions, normals `[V, 3]` in model space in the skeleton's rest pose, metres; uvs `[V, 2]`;
    joints `[V, 4]` and weights `[V, 4]` summing to 1; triangles `[N, 3]`;
    morph_positions `[K, V, 3]` are offsets for the morph targets named in `morphs`.
    """

    name: str
    skeleton: Skeleton
    positions: Array
    normals: Array
    uvs: Array
    joints: Array
    weights: Array
    triangles: Array
    materials: tuple[Material, ...]
    surfaces: tuple[Surface, ...]
    morphs: tuple[str, ...] = ()
    morph_positions: Array | None = None
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        count = len(self.positions)
        shapes = {
            "positions": (count, 3),
            "normals": (count, 3),
            "uvs": (count, 2),
            "joints": (count, 4),
            "weights": (count, 4),
        }
        for field, shape in shapes.items():
            if getattr(self, field).shape != shape:
                raise ValueError(
                    f"character '{self.name}': {field} are {getattr(self, field).shape}, expected {shape}"
                )
        if len(self.triangles) and int(np.max(self.triangles)) >= count:
            raise ValueError(
                f"character '{self.name}': a triangle names vertex {int(np.max(self.triangles))} of {count}"
            )
        if count and int(np.max(self.joints)) >= len(self.skeleton):
            raise ValueError(
                f"character '{self.name}': a vertex names joint {int(np.max(self.joints))} of "
                f"{len(self.skeleton)}"
            )
