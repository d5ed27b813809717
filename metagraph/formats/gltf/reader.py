"""Read and write glTF 2.0: .glb, .gltf, .vrm. All results are in metres, Y up, on one skeleton per file."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path

import numpy as np

from metagraph.common.files import guard_reader
from metagraph.common.wording import phrase
from metagraph.errors import FileError
from metagraph.formats.gltf.character import read_character_mesh
from metagraph.formats.gltf.clips import read_animations
from metagraph.formats.gltf.file import get_extras, open_gltf
from metagraph.formats.gltf.morphs import read_morph_names
from metagraph.formats.gltf.skeleton import build_rig
from metagraph.formats.gltf.vrm_animation import find_humanoid_bones
from metagraph.formats.gltf.writer import write_glb
from metagraph.formats.takes import make_takes_unique
from metagraph.motion.character_mesh import CharacterMesh
from metagraph.motion.clip import Clip

# Numbers of a broken file may overflow before a check refuses them; that is no reason for a warning.
_QUIET = np.errstate(all="ignore")

__all__ = ["has_skinned_mesh", "read_character", "read_gltf_clips", "read_vrm_roles", "write_glb"]


@guard_reader
@_QUIET
def read_gltf_clips(path: str | Path, as_is: Collection[str] = ()) -> list[Clip]:
    """Return every animation of a file as a clip; all share one Skeleton.

    Keys are resampled to the constant frame rate on which they lie (30 if any rate fits). The rest pose comes
    from the skin's inverse bind matrices if they are valid, else from the nodes. `as_is` names repairs
    (`takes.REPAIRS`) not to make. Raises FileError, also if there is no animation of the skeleton.
    """
    gltf = open_gltf(path)
    if not gltf.json.animations:
        raise FileError(
            path,
            phrase("it holds no animation"),
            phrase("its animations"),
            phrase("Export it with its animation, or open it as a character."),
        )
    rig = build_rig(gltf, as_is)
    clips = read_animations(gltf, rig, as_is)
    if not clips:
        raise FileError(
            path,
            phrase("none of its animations moves the skeleton"),
            phrase("its animations"),
            phrase("Export it with its animation."),
        )
    return make_takes_unique(clips)


@guard_reader
@_QUIET
def read_character(path: str | Path) -> CharacterMesh:
    """Return all meshes of the default scene as one skinned character in its skeleton's rest pose. Raises
    FileError.
    """
    gltf = open_gltf(path)
    return read_character_mesh(gltf, build_rig(gltf))


@guard_reader
def has_skinned_mesh(path: str | Path) -> bool:
    """Return whether a file has a mesh on a skeleton, which can be drawn. Raises FileError."""
    nodes = open_gltf(path).json.nodes
    return any(node.mesh is not None and node.skin is not None for node in nodes)


@guard_reader
def read_morph_targets(path: str | Path) -> tuple[str, ...]:
    """Return the names of a character's morph targets, as in `read_character`. Raises FileError."""
    gltf = open_gltf(path)
    nodes = [n for n, node in enumerate(gltf.json.nodes) if node.mesh is not None]
    return tuple(dict.fromkeys(name for n in nodes for name in read_morph_names(gltf, n)))


@guard_reader
@_QUIET
def read_vrm_roles(path: str | Path) -> dict[str, str]:
    """Return role -> joint name as a VRM 0.x, VRM 1.0 or VRM animation file states it; empty for other files.
    Raises FileError.
    """
    gltf = open_gltf(path)
    bones = find_humanoid_bones(get_extras(gltf.json.extensions))
    if not bones:
        return {}
    rig = build_rig(gltf)
    return {
        "".join(f"_{c.lower()}" if c.isupper() else c for c in bone): rig.skeleton.names[rig.places[node]]
        for bone, node in bones.items()
        if node in rig.places
    }
