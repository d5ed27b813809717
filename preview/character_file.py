"""Make the figure for a character's file: its mesh, or a stick figure if the mesh cannot be used."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path

from metagraph.formats.gltf.reader import read_character
from metagraph.motion.character_mesh import explain_no_character
from metagraph.motion.skeleton import Skeleton
from preview.figure import MeshFigure, SkinnedFigure, StickFigure


def figure_from_file(path: Path | None, skeleton: Skeleton, hidden: Collection[str] = ()) -> MeshFigure:
    """Return the figure that is drawn for a skeleton. If it is not the file's mesh, its `instead` says why.

    `path` is the character's file, None for a project without one. `hidden` holds names of meshes that are
    not drawn. Raises FileError.
    """
    if path is None:
        return StickFigure(skeleton)
    body = read_character(path)
    why = explain_no_character(body, skeleton)
    shown = body.without(hidden)
    if why is None and not len(shown.triangles):
        why = "is hidden"
    if why is None:
        return SkinnedFigure(shown, skeleton)
    figure = StickFigure(skeleton)
    figure.instead, figure.meshes = f"the mesh of {path.name} {why}", body.meshes
    return figure
