"""Make the figure for a character's file: its mesh, or the default body if the mesh cannot be used; a stick
figure for a skeleton that is no person's.
"""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path

from metagraph.formats.gltf.reader import read_character
from metagraph.motion.fitting.fit_character import put_on_skeleton
from metagraph.motion.fitting.footing import Footing
from metagraph.motion.skeleton import Skeleton
from preview.default_body.figure import DefaultBody
from preview.figure import MeshFigure, SkinnedFigure, StickFigure


def load_mesh_figure(
    path: Path | None,
    skeleton: Skeleton,
    hidden: Collection[str] = (),
    footing: Footing | None = None,
    sticks: bool = False,
) -> MeshFigure:
    """Return the figure that is drawn for a skeleton. If it is not the file's mesh, its `instead` says why.

    `path` is the character's file, None for a project without one. `hidden` holds names of meshes that are
    not drawn. `footing` says how the skeleton stands, for the default body. `sticks` draws a stick figure in
    place of that. Raises FileError.
    """
    if path is None:
        return _without_mesh(skeleton, footing, sticks)
    body = read_character(path)
    body, why = put_on_skeleton(body, skeleton, footing)
    shown = body.without(hidden)
    if why is None and not len(shown.triangles):
        why = "is hidden"
    if why is None:
        return SkinnedFigure(shown, skeleton)
    figure = _without_mesh(skeleton, footing, sticks)
    reasons = [f"the mesh of {path.name} {why}", figure.instead]
    figure.instead, figure.meshes = ", and ".join(filter(None, reasons)), body.meshes
    return figure


def _without_mesh(skeleton: Skeleton, footing: Footing | None, sticks: bool) -> MeshFigure:
    """Return the default body; a stick figure where it is wanted, or where the skeleton is no person's."""
    if sticks:
        return StickFigure(skeleton)
    try:
        return DefaultBody(skeleton, footing)
    except ValueError as reason:
        figure = StickFigure(skeleton)
        figure.instead = str(reason)
        return figure
