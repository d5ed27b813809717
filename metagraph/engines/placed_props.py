"""Read the props of a project for an export."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from metagraph.common.network_paths import is_closed
from metagraph.common.wording import phrase
from metagraph.errors import FileError
from metagraph.formats.gltf.placed_props import PlacedProp
from metagraph.formats.props.reader import read_prop
from metagraph.graph.model import Project
from metagraph.graph.prop import make_turn
from metagraph.motion import rotation
from metagraph.motion.character_mesh import CharacterMesh
from metagraph.motion.prop_tops import find_tops
from metagraph.playback.posing.prop_contacts import measure_reach


def place_props(project: Project, base: Path | None) -> tuple[tuple[PlacedProp, ...], tuple[str, ...]]:
    """Return a project's props as they are exported, and what to say of those that cannot be. base: the
    folder that their paths are relative to, None to leave them out.
    """
    if base is None or project.skeleton is None:
        return (), ()
    meshes: dict[str, CharacterMesh] = {}
    out, notes = [], dict[str, None]()
    for prop in project.props.values():
        if prop.joint and prop.joint not in project.skeleton:
            words = phrase(
                "the prop '{name}' is left out: nothing carries it, the character has no joint '{joint}'",
                name=prop.name,
                joint=prop.joint,
            )
            notes[words] = None
            continue
        if is_closed(prop.path):
            notes[
                phrase("the prop '{name}' is left out: its file is on another computer", name=prop.name)
            ] = None
            continue
        if prop.path not in meshes:
            try:
                meshes[prop.path] = read_prop(base / prop.path)
            except FileError as error:
                notes[error.words] = None
                continue
        joint = project.skeleton.names.index(prop.joint) if prop.joint else -1
        x, y, z = prop.at
        turn = make_turn(prop)
        out.append(PlacedProp(prop.name, meshes[prop.path], (x, y, z), turn, prop.scale, joint))
    if any(_has_near_top(project, prop) for prop in out):
        notes[
            phrase(
                "in the engine hands do not rest on props, and feet do not stand on steps: it moves them as "
                "the clips do. Write a performance as GLB or BVH: its hands and feet rest there"
            )
        ] = None
    return tuple(out), tuple(notes)


def _has_near_top(project: Project, prop: PlacedProp) -> bool:
    """Return whether hands or feet of a character may rest on a prop."""
    if prop.joint >= 0:
        return False
    turned = rotation.rotate_vectors(np.array(prop.turn), np.asarray(prop.mesh.positions, float))
    reach = measure_reach(project)
    return any(top.distance <= reach for top in find_tops(turned * prop.scale + prop.at, prop.mesh.triangles))
