"""Meshes for tests: balls round the joints of a skeleton."""

from __future__ import annotations

import numpy as np

from metagraph.motion import rotation
from metagraph.motion.character_mesh import CharacterMesh, MeshMaterial, Surface
from metagraph.motion.skeleton import Skeleton
from preview.mesh import make_ball

LENGTH = 0.35


def column(joints: int = 6) -> Skeleton:
    """A chain of joints standing up."""
    offsets = np.tile([0, LENGTH, 0.0], (joints, 1))
    offsets[0] = [0, 0.1, 0]
    return Skeleton(
        tuple(f"j{n}" for n in range(joints)),
        np.arange(-1, joints - 1),
        rotation.make_identity_rotations((joints,)),
        offsets,
    )


def body(
    skeleton: Skeleton, balls: dict[int, float], at: dict[int, list[float]] | None = None
) -> CharacterMesh:
    """Balls of some radii round joints, metres; `at` puts a joint's ball elsewhere."""
    _, rest = skeleton.globals(skeleton.rest)
    points, corners, joints, surfaces = [], [], [], []
    count = first = 0
    for joint, radius in balls.items():
        p, _, t = make_ball(radius)
        points.append(p + (at or {}).get(joint, rest[joint]))
        corners.append(t + count)
        joints += [[joint, 0, 0, 0]] * len(p)
        surfaces.append(Surface(first, len(t), 0, f"ball {joint}", joint))
        count, first = count + len(p), first + len(t)
    positions = np.concatenate(points).astype(np.float32)
    return CharacterMesh(
        "someone",
        skeleton,
        positions,
        np.tile(np.float32([0, 1, 0]), (count, 1)),
        np.zeros((count, 2), np.float32),
        np.array(joints),
        np.tile(np.float32([1, 0, 0, 0]), (count, 1)),
        np.concatenate(corners),
        (MeshMaterial("plain"),),
        tuple(surfaces),
        meshes=tuple(s.mesh for s in surfaces),
    )


def everywhere(skeleton: Skeleton, radius: float = 0.15) -> CharacterMesh:
    return body(skeleton, dict.fromkeys(range(len(skeleton)), radius))
