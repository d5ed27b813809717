"""`python -m sample_clips.make.default_body`: write `preview/default_body/body.glb`, the same every time."""

from __future__ import annotations

from pathlib import Path

import numpy as np

import preview
from metagraph.formats.gltf.writer import write_glb
from metagraph.motion.character_mesh import CharacterMesh, MeshMaterial, Surface
from sample_clips.make.default_body.make import sculpt_body
from sample_clips.make.default_body.weights import SKELETON, skin

PATH = Path(preview.__file__).with_name("default_body") / "body.glb"


def default_character() -> CharacterMesh:
    """Make the body (about a minute)."""
    positions, normals, triangles = sculpt_body()
    dense = skin(positions, triangles)
    joints = np.argsort(-dense, axis=1, kind="stable")[:, :4]
    weights = np.take_along_axis(dense, joints, 1)
    weights = np.where(weights < 0.02, 0, weights)
    weights /= weights.sum(1, keepdims=True)
    return CharacterMesh(
        "Default body",
        SKELETON,
        positions.astype(np.float32),
        normals.astype(np.float32),
        np.zeros((len(positions), 2), np.float32),
        np.where(weights > 0, joints, 0).astype(np.uint16),
        weights.astype(np.float32),
        triangles.astype(np.uint32),
        (MeshMaterial("body", (0.40, 0.38, 0.36, 1.0), None, 0.72),),
        (Surface(0, len(triangles), 0),),
    )


if __name__ == "__main__":
    write_glb(PATH, (), default_character(), compress=True)
