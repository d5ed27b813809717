"""The character's mesh as targets write it."""

from __future__ import annotations

from pathlib import Path

from metagraph.engines.targets.target import ExportOrder
from metagraph.motion.character_mesh import Character


def mesh_of(order: ExportOrder) -> tuple[Character | None, tuple[str, ...]]:
    """Return the mesh that goes with an order, and what there is to say about it. Raises FileError."""
    from metagraph.formats.gltf import read_character

    given = order.character
    body = read_character(given) if isinstance(given, Path) else given
    if body is not None and given is not None and body.skeleton != order.project.skeleton:
        return None, (f"the mesh of '{given.name}' is left out: it has another skeleton than the clips",)
    shown = body.without(order.project.hidden) if body is not None else None
    return shown if shown is not None and len(shown.triangles) else None, ()
