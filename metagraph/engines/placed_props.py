"""Read the props of a project for an export."""

from __future__ import annotations

from pathlib import Path

from metagraph.common.network_paths import is_closed
from metagraph.common.wording import phrase
from metagraph.errors import FileError
from metagraph.formats.gltf.placed_props import PlacedProp
from metagraph.formats.props.reader import read_prop
from metagraph.graph.model import Project
from metagraph.graph.prop import make_turn
from metagraph.motion.character_mesh import CharacterMesh


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
    return tuple(out), tuple(notes)
